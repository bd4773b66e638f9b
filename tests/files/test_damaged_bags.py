"""Bags cut short and bags with holes: what can be read is read, what is lost is told, and nothing else happens."""

import contextlib
import random
import sqlite3
import struct

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import ros_bags as bags
from boresight.errors import InputError
from boresight.files.bags import mcap, read_bag
from boresight.files.recorded import read_recorded
from boresight.files.topics import Choice
from ros_bags import T0

FUZZ = settings(max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
KINDS = [("mcap", None), ("mcap", "storage"), ("sqlite3", None)]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The bytes of the one file of a bag of a run, by storage and compression."""
    script, _ = bags.run(4, rate=50.0, range_rate=20.0)
    found = {}
    for storage, compression in KINDS:
        path = script.write(tmp_path_factory.mktemp("bags") / "run", storage, compression)
        (file,) = [f for f in path.iterdir() if f.suffix != ".yaml"]
        found[storage, compression] = file.read_bytes()
    return found


@pytest.fixture
def read(tmp_path):
    def read(content, storage="mcap"):
        file = tmp_path / f"run.{'mcap' if storage == 'mcap' else 'db3'}"
        file.write_bytes(content)
        return read_bag(file, file.name)

    return read


def total(bag):
    return sum(topic.count for topic in bag.topics.values())


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_file_cut_within_a_chunk_gives_the_messages_before_the_cut(files, read, share):
    content = files["mcap", None]
    whole = total(read(content))
    (start,) = mcap_chunks(content)
    (length,) = struct.unpack_from("<Q", content, start + 1)
    bag = read(content[: start + int(share * length)])
    assert total(bag) == pytest.approx(share * whole, abs=0.05 * whole)
    (loss,) = bag.losses
    assert loss.startswith("run.mcap: it ends in the middle of a chunk; ")
    assert loss.endswith(f"{total(bag):,} messages were read up to there")


def test_a_cut_in_compressed_data_costs_no_more_than_its_last_block(tmp_path, read):
    """A zstd stream inflates block by block, 128 kB each; this one holds about 400 kB."""
    script, _ = bags.run(12)
    content = (script.write(tmp_path / "long", compression="storage") / "long.mcap").read_bytes()
    (start,) = mcap_chunks(content)
    (length,) = struct.unpack_from("<Q", content, start + 1)
    whole = total(read(content))
    bag = read(content[: start + int(0.6 * length)])
    assert 0.2 * whole < total(bag) < 0.7 * whole
    assert bag.losses[0].startswith("run.mcap: it ends in the middle of a chunk; ")


def test_a_file_without_its_end_loses_nothing(files, read):
    content = files["mcap", None]
    bag = read(content[:-8])
    assert total(bag) == total(read(content))
    assert bag.losses == ()
    for cut in (60, 300):
        assert total(read(content[:-cut])) == total(read(content))


def test_a_recording_that_broke_off_between_chunks_is_told(tmp_path, read):
    content = chunked(tmp_path, 6)
    places = mcap_chunks(content)
    bag = read(content[: places[3]])
    assert total(bag) == 3 * 20
    assert bag.losses == ("run.mcap: it has no end mark, the recording broke off; 60 messages were read up to there",)


def chunked(tmp_path, count, each=20, checked=False):
    """An MCAP of several chunks: rosbags closes one only after a MiB, so it is told to."""
    from rosbags.rosbag2 import StoragePlugin, Writer

    with Writer(tmp_path / "chunked", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        topic = writer.add_connection("/joint_states", "sensor_msgs/msg/JointState", typestore=bags.STORE)
        for k in range(count * each):
            message = bags.joint_state(T0 + 0.01 * k, ["a"], [float(k)])
            writer.write(topic, round((T0 + 0.01 * k) * 1e9), bags.STORE.serialize_cdr(message, message.__msgtype__))
            if k % each == each - 1:
                writer.storage.close_chunk()
    content = (tmp_path / "chunked" / "chunked.mcap").read_bytes()
    return with_checksums(content) if checked else content


def mcap_chunks(content):
    found, place = [], 8
    while place < len(content) - 8:
        kind, length = struct.unpack_from("<BQ", content, place)
        if kind == 6:
            found.append(place)
        place += 9 + length
    return found


def with_checksums(content):
    from binascii import crc32

    content = bytearray(content)
    for place in mcap_chunks(content):
        (length,) = struct.unpack_from("<Q", content, place + 1)
        struct.pack_into("<I", content, place + 9 + 24, crc32(content[place + 9 + 40 : place + 9 + length]))
    return bytes(content)


def test_a_chunk_whose_checksum_is_wrong_is_left_out_alone(tmp_path, read):
    content = bytearray(chunked(tmp_path, 5, checked=True))
    assert total(read(bytes(content))) == 100
    content[mcap_chunks(content)[2] + 200] ^= 0x10
    bag = read(bytes(content))
    assert total(bag) == 80
    (loss,) = bag.losses
    assert "does not have the checksum it states, so none of it is used; 40 messages were read up to there" in loss


def test_after_a_record_that_makes_no_sense_reading_goes_on_at_the_next_chunk(tmp_path, read):
    content = bytearray(chunked(tmp_path, 5))
    place = mcap_chunks(content)[1]
    content[place : place + 9] = b"\0" * 9
    bag = read(bytes(content))
    assert total(bag) == 80
    (loss,) = bag.losses
    assert "there is no record at byte" in loss
    assert "reading went on at the next chunk" in loss


def test_messages_whose_channel_is_named_in_a_damaged_chunk_are_read(tmp_path, read):
    content = bytearray(chunked(tmp_path, 5, checked=True))
    content[mcap_chunks(content)[0] + 200] ^= 0x10
    bag = read(bytes(content))
    assert len(bag.messages["/joint_states"]) == 80


def test_a_chunk_that_claims_to_be_huge_is_not_inflated(tmp_path, read):
    content = bytearray(chunked(tmp_path, 3))
    struct.pack_into("<Q", content, mcap_chunks(content)[1] + 9 + 16, 2**40)
    bag = read(bytes(content))
    assert total(bag) == 40
    assert "claims 1,048,576 MiB" in bag.losses[0]


def test_a_bomb_is_not_inflated_beyond_what_it_says(tmp_path, read, monkeypatch):
    from backports import zstd

    monkeypatch.setattr(mcap, "LARGEST_CHUNK", 2**20)
    bomb = zstd.compress(b"\0" * 2**27)
    record = struct.pack("<QQQI", 0, 0, 2**19, 0) + struct.pack("<I", 4) + b"zstd" + struct.pack("<Q", len(bomb)) + bomb
    content = mcap.MCAP + b"\x06" + struct.pack("<Q", len(record)) + record
    assert total(read(content)) == 0


@pytest.mark.parametrize("kind", KINDS)
@FUZZ
@given(cut=st.floats(0.0, 1.0))
def test_a_cut_anywhere_never_gives_more_than_a_sentence(files, tmp_path, kind, cut):
    content = files[kind]
    path = tmp_path / ("run.mcap" if kind[0] == "mcap" else "run.db3")
    path.write_bytes(content[: int(cut * len(content))])
    with contextlib.suppress(InputError):
        read_recorded(path, "run", Choice())


@pytest.mark.parametrize("kind", KINDS)
@FUZZ
@given(seed=st.integers(0, 2**32))
def test_damage_anywhere_never_gives_more_than_a_sentence(files, tmp_path, kind, seed):
    draw, content = random.Random(seed), bytearray(files[kind])
    for _ in range(draw.choice([1, 3, 30])):
        # Half of it near the beginning, where the structure is.
        place = draw.randrange(min(len(content), draw.choice([400, 10**9])))
        content[place : place + draw.choice([1, 1, 8, 64])] = draw.randbytes(draw.choice([1, 1, 8, 64]))
    path = tmp_path / ("run.mcap" if kind[0] == "mcap" else "run.db3")
    path.write_bytes(bytes(content))
    with contextlib.suppress(InputError):
        read_recorded(path, "run", Choice())


def test_a_database_cut_short_gives_what_lies_before_the_cut(files, read):
    content = files["sqlite3", None]
    whole = total(read(content, "sqlite3"))
    bag = read(content[: int(0.7 * len(content))], "sqlite3")
    assert 0.5 * whole < total(bag) < whole
    (loss,) = bag.losses
    assert loss.startswith("run.db3: the database is damaged (")
    assert loss.endswith(f"rows that can be read have been, {total(bag):,} in all")


def test_a_hole_in_a_database_costs_the_rows_in_it(files, read):
    content = bytearray(files["sqlite3", None])
    whole = total(read(bytes(content), "sqlite3"))
    middle = len(content) // 2 // 4096 * 4096
    content[middle : middle + 4096] = b"\xff" * 4096
    bag = read(bytes(content), "sqlite3")
    assert 0.85 * whole < total(bag) < whole
    assert bag.losses


def test_a_database_of_something_else(tmp_path):
    with contextlib.closing(sqlite3.connect(tmp_path / "run.db3")) as database:
        database.execute("CREATE TABLE pets (name TEXT)")
        database.commit()
    with pytest.raises(InputError, match="this database is not a ROS 2 bag"):
        read_bag(tmp_path / "run.db3", "run.db3")


def test_a_view_in_place_of_the_messages_is_not_run(tmp_path):
    endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)"
    with contextlib.closing(sqlite3.connect(tmp_path / "run.db3")) as database:
        database.execute("CREATE TABLE topics (id INTEGER, name, type, serialization_format)")
        database.execute(
            f"CREATE VIEW messages AS {endless} SELECT i AS id, 1 AS topic_id, 1 AS timestamp, '' AS data FROM n"
        )
        database.commit()
    with pytest.raises(InputError, match="this database is not a ROS 2 bag"):
        read_bag(tmp_path / "run.db3", "run.db3")


def test_a_missing_file_of_several_is_told_and_the_others_are_read(tmp_path):
    script, _ = bags.run(4)
    path = script.write(tmp_path / "run", pieces=4)
    (path / "run_2.mcap").unlink()
    bag = read_bag(path, "run")
    assert bag.losses == ("run: metadata.yaml lists run_2.mcap, which is not there",)
    assert total(bag) == pytest.approx(0.75 * len(script.messages), rel=0.01)


def test_a_file_of_several_that_is_ruined_is_told_and_the_others_are_read(tmp_path):
    script, _ = bags.run(4)
    path = script.write(tmp_path / "run", pieces=4)
    (path / "run_1.mcap").write_bytes(b"")
    bag = read_bag(path, "run")
    assert bag.losses[0].startswith("run/run_1.mcap: the file is empty")
    assert total(bag) == pytest.approx(0.75 * len(script.messages), rel=0.01)


@pytest.mark.parametrize("content", [None, b"", b"[", b"rosbag2_bagfile_information: 3\n", b"\xff\xfe"])
def test_metadata_that_is_missing_or_makes_no_sense_is_done_without(tmp_path, content):
    script, _ = bags.run(3)
    path = script.write(tmp_path / "run")
    (path / "metadata.yaml").unlink()
    if content is not None:
        (path / "metadata.yaml").write_bytes(content)
    bag = read_bag(path, "run")
    assert total(bag) == len(script.messages)
    (loss,) = bag.losses
    assert "metadata.yaml" in loss


def test_metadata_cannot_point_out_of_the_folder(tmp_path):
    script, _ = bags.run(3)
    path = script.write(tmp_path / "run")
    (tmp_path / "other.mcap").write_bytes(b"secret")
    text = (path / "metadata.yaml").read_text()
    (path / "metadata.yaml").write_text(text.replace("run.mcap", "../other.mcap"))
    assert read_bag(path, "run").losses == ("run: metadata.yaml lists other.mcap, which is not there",)


def test_messages_that_are_not_what_their_type_says_are_counted(tmp_path):
    from rosbags.rosbag2 import Writer

    with Writer(tmp_path / "run", version=9) as writer:
        topic = writer.add_connection("/r", "sensor_msgs/msg/Range", typestore=bags.STORE)
        good = bags.STORE.serialize_cdr(bags.range_message(T0, 1.0), "sensor_msgs/msg/Range")
        for data in (good, b"", bytes(good)[:20], b"\0\1\0\0" + b"\xff" * 40, good):
            writer.write(topic, 10**9, data)
    bag = read_bag(tmp_path / "run", "run")
    assert len(bag.messages["/r"]) == 2
    assert bag.losses == ("run: 3 messages of /r could not be decoded",)


def test_a_damaged_bag_still_becomes_rows(tmp_path):
    script, at = bags.run(6)
    path = script.write(tmp_path / "run") / "run.mcap"
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    recorded = read_recorded(path, "run.mcap", Choice())
    assert len(recorded.rows) == 3
    assert abs(recorded.rows.joints - at[:3]).max() < 1e-5
    assert recorded.bag.losses


def test_a_file_compressed_and_cut_is_read_to_the_cut(tmp_path):
    script, _ = bags.run(14)
    path = script.write(tmp_path / "run", "mcap", "file")
    (file,) = [f for f in path.iterdir() if f.suffix == ".zstd"]
    content = file.read_bytes()
    file.write_bytes(content[: int(len(content) * 0.5)])
    bag = read_bag(path, "run")
    assert bag.losses[0] == (
        "run/run.mcap.zstd: the compressed file breaks off or is damaged; what came before was read"
    )
    assert total(bag) > 1000


@pytest.mark.parametrize("table", ["topics", "messages"])
@pytest.mark.parametrize("kept", ["STORED", "VIRTUAL"])
def test_computed_columns_are_refused_before_they_are_computed(tmp_path, table, kept):
    import sqlite3

    columns = {
        "topics": "id INTEGER PRIMARY KEY, type, serialization_format, name",
        "messages": "id INTEGER PRIMARY KEY, topic_id, timestamp, data",
    }
    columns[table] += f" GENERATED ALWAYS AS (printf('%.*c', 1000, 'x')) {kept}"
    connection = sqlite3.connect(tmp_path / "run.db3")
    for name, inside in columns.items():
        connection.execute(f"CREATE TABLE {name} ({inside})")
    connection.commit()
    connection.close()
    with pytest.raises(InputError, match=f"of table {table} is computed; expected one that a recorder wrote"):
        read_bag(tmp_path / "run.db3", "run.db3")
