"""Bags as rosbags writes them, in every storage and compression: what comes out is what went in."""

import random
import shutil
import struct
import sys

import lz4.frame
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ros_bags as bags
from boresight.errors import InputError
from boresight.files.bags import bag as bag_module
from boresight.files.bags import is_bag, read_bag, tape
from boresight.files.bags.messages import decode
from ros_bags import T0, Script

WRITTEN = [
    ("mcap", None),
    ("mcap", "storage"),
    ("mcap", "message"),
    ("mcap", "file"),
    ("sqlite3", None),
    ("sqlite3", "message"),
    ("sqlite3", "file"),
]


def script():
    said = Script()
    for k in range(40):
        t = T0 + 0.01 * k
        said.say(t + 0.002, "/joint_states", bags.joint_state(t, ["a", "b"], [0.1 * k, -0.2 * k]))
        said.say(t + 0.003, "/ranger", bags.range_message(t, 1.0 + 0.01 * k))
        said.say(t + 0.004, "/depth", bags.number(0.5 * k))
    said.say(T0, "/target", bags.word("deck"))
    said.say(T0, "/tracker", bags.point(T0, [1.0, 2.0, 3.0]))
    said.say(T0, "/tf", bags.TYPES["std_msgs/msg/Int32"](data=3))
    return said


def check(bag):
    counts = {name: (topic.type, topic.count) for name, topic in bag.topics.items()}
    assert counts == {
        "/depth": ("std_msgs/msg/Float64", 40),
        "/joint_states": ("sensor_msgs/msg/JointState", 40),
        "/ranger": ("sensor_msgs/msg/Range", 40),
        "/target": ("std_msgs/msg/String", 1),
        "/tf": ("std_msgs/msg/Int32", 1),
        "/tracker": ("geometry_msgs/msg/PointStamped", 1),
    }
    joints = bag.messages["/joint_states"]
    assert [names for names, _ in joints.values] == [("a", "b")] * 40
    np.testing.assert_array_equal([p for _, p in joints.values], [[0.1 * k, -0.2 * k] for k in range(40)])
    np.testing.assert_allclose(joints.stamp, T0 + 0.01 * np.arange(40), rtol=0, atol=5e-7)
    np.testing.assert_allclose(joints.received, T0 + 0.01 * np.arange(40) + 0.002, rtol=0, atol=5e-7)
    ranges = np.array(bag.messages["/ranger"].values)
    np.testing.assert_allclose(ranges[:, 0], 1.0 + 0.01 * np.arange(40), atol=1e-7)
    np.testing.assert_allclose(ranges[0, 1:], [0.05, 5.0], rtol=1e-7)
    assert bag.messages["/depth"].stamp is None
    assert bag.messages["/target"].values == ["deck"]
    assert bag.messages["/tracker"].values == [(1.0, 2.0, 3.0)]
    assert "/tf" not in bag.messages


@pytest.mark.parametrize(("storage", "compression"), WRITTEN)
def test_a_bag_holds_what_was_recorded(tmp_path, storage, compression):
    path = script().write(tmp_path / "run", storage, compression)
    assert is_bag(path)
    bag = read_bag(path, "run")
    check(bag)
    assert bag.losses == ()


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_one_file_of_a_bag_is_a_bag(tmp_path, storage):
    path = script().write(tmp_path / "run", storage)
    (file,) = [f for f in path.iterdir() if f.suffix != ".yaml"]
    assert is_bag(file)
    check(read_bag(file, file.name))


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_in_several_files_is_one(tmp_path, storage):
    path = script().write(tmp_path / "run", storage, pieces=12)
    bag = read_bag(path, "run")
    check(bag)
    assert bag.losses == ()


def pieces(content):
    """The beginning of an uncompressed MCAP up to its only chunk, the chunk's head, and the records in it."""
    start = content.index(b"\x06", 8 + 9)
    (length,) = struct.unpack_from("<Q", content, start + 1)
    chunk = content[start + 9 : start + 9 + length]
    return content[:start], chunk[:28], chunk[40:]


def test_chunks_compressed_by_lz4_are_read(tmp_path):
    """rosbags writes none, but ROS's recorder does: a chunk is swapped for its lz4 form."""
    path = script().write(tmp_path / "run") / "run.mcap"
    beginning, head, records = pieces(path.read_bytes())
    packed = lz4.frame.compress(records)
    record = head + struct.pack("<I", 3) + b"lz4" + struct.pack("<Q", len(packed)) + packed
    path.write_bytes(beginning + b"\x06" + struct.pack("<Q", len(record)) + record + b"\x0f" + struct.pack("<QI", 4, 0))
    check(read_bag(path, "run.mcap"))


def test_a_file_without_chunks_is_read_and_so_is_the_beginning_of_one(tmp_path):
    path = script().write(tmp_path / "run") / "run.mcap"
    beginning, _, records = pieces(path.read_bytes())
    path.write_bytes(beginning + records + b"\x0f" + struct.pack("<QI", 4, 0))
    bag = read_bag(path, "run.mcap")
    check(bag)
    assert bag.losses == ()
    path.write_bytes(beginning + records[:-5])
    bag = read_bag(path, "run.mcap")
    assert sum(topic.count for topic in bag.topics.values()) == 122
    assert bag.losses == ("run.mcap: it ends in the middle of a record; 122 messages were read up to there",)


def test_messages_of_humble_whose_range_has_no_variance_are_read(tmp_path):
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    types = store.types
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](1, 500_000_000), "frame")
    with Writer(tmp_path / "run", version=8) as writer:
        topic = writer.add_connection("/r", "sensor_msgs/msg/Range", typestore=store)
        message = types["sensor_msgs/msg/Range"](header, 1, 0.1, 0.2, 4.0, 1.5)
        writer.write(topic, 10**9, store.serialize_cdr(message, "sensor_msgs/msg/Range"))
    found = read_bag(tmp_path / "run", "run").messages["/r"]
    np.testing.assert_allclose(found.values, [(1.5, 0.2, 4.0)], rtol=1e-6)
    assert found.stamp.tolist() == [1.5]


def test_stamps_left_at_zero_are_none(tmp_path):
    said = Script()
    said.say(T0, "/r", bags.range_message(0.0, 1.0))
    assert read_bag(said.write(tmp_path / "run"), "run").messages["/r"].stamp is None


def test_a_bag_of_nothing_has_no_topics(tmp_path):
    said = Script()
    said.say(T0, "/tf", bags.TYPES["std_msgs/msg/Int32"](data=3))
    assert read_bag(said.write(tmp_path / "run"), "run").messages == {}


def test_the_digest_changes_with_any_file(tmp_path):
    path = script().write(tmp_path / "run", pieces=3)
    before = read_bag(path, "run").sha256
    with open(path / "run_1.mcap", "ab") as file:
        file.write(b"\0")
    assert read_bag(path, "run").sha256 != before


def test_what_the_bag_brings_as_definitions_is_never_made_code(tmp_path):
    path = script().write(tmp_path / "run") / "run.mcap"
    content = path.read_bytes()
    evil = content.replace(b"string[] name", b"int8[2**9] x;")
    assert evil != content
    path.write_bytes(evil)
    check(read_bag(path, "run.mcap"))
    assert "rosbags.usertypes" not in sys.modules


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32))
def test_reading_by_the_layout_of_the_last_message_gives_what_the_decoder_gives(seed):
    """Names, frames, lengths and byte order change on the way, and stay as they are for a while."""
    draw, rng = random.Random(seed), np.random.default_rng(seed)
    messages = []
    for _ in range(4):
        names = [draw.choice(["j", "shoulder", ""]) + str(k) for k in range(draw.randint(0, 5))]
        frame, little = draw.choice(["", "b", "base_link"]), draw.random() < 0.8
        for _ in range(3):
            message = bags.joint_state(rng.uniform(1.0, 2e9), names, rng.choice([0.0, np.nan, 1.5, -2.0], len(names)))
            message.header.frame_id = frame
            message.velocity = rng.normal(size=draw.choice([0, len(names)]))
            messages.append(bytes(bags.STORE.serialize_cdr(message, message.__msgtype__, little_endian=little)))
    found = decode("sensor_msgs/msg/JointState", [(0, data) for data in messages])
    assert (len(found), found.unreadable) == (len(messages), 0)
    for data, (names, positions), stamp in zip(messages, found.values, found.stamp, strict=True):
        expected = bags.STORE.deserialize_cdr(data, "sensor_msgs/msg/JointState")
        assert list(names) == list(expected.name)
        np.testing.assert_array_equal(positions, expected.position)
        assert stamp == pytest.approx(expected.header.stamp.sec + 1e-9 * expected.header.stamp.nanosec, abs=1e-6)


def test_too_much_to_keep_is_an_error_that_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(tape, "LIMIT_MIB", 0.005)
    with pytest.raises(InputError, match="name the topics to read, or split the bag"):
        read_bag(script().write(tmp_path / "run"), "run")


def test_only_named_topics_are_kept(tmp_path):
    bag = read_bag(script().write(tmp_path / "run"), "run", ["/ranger"])
    assert set(bag.messages) == {"/ranger"}
    assert bag.topics["/joint_states"].count == 40


@pytest.mark.parametrize("name", ["nothing", "nothing.mcap"])
def test_a_bag_that_is_not_there(tmp_path, name):
    with pytest.raises(InputError, match="there is no such file or folder"):
        read_bag(tmp_path / name, name)


def test_a_folder_without_a_bag(tmp_path):
    (tmp_path / "notes.txt").write_text("x")
    with pytest.raises(InputError, match=r"there is no \.mcap or \.db3 file in this folder"):
        read_bag(tmp_path, "run")


@pytest.mark.parametrize(
    ("content", "told"),
    [(b"", "the file is empty"), (b"j1,range\n", "neither MCAP nor SQLite"), (b"SQLite format 3\0" * 9, "cannot be")],
)
def test_a_file_that_is_no_bag(tmp_path, content, told):
    (tmp_path / "run.mcap").write_bytes(content)
    with pytest.raises(InputError, match=told):
        read_bag(tmp_path / "run.mcap", "run.mcap")


def test_without_rosbags_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(bag_module, "find_spec", lambda name: None)
    with pytest.raises(InputError) as caught:
        read_bag(tmp_path, "run")
    assert str(caught.value) == "run: reading ROS bags needs rosbags: pip install 'boresight[ros]'"


def test_nothing_of_rosbags_is_imported_for_csv_files():
    import subprocess

    code = "import sys, boresight.files, boresight.cli.importing; print([m for m in sys.modules if 'rosbags' in m])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_what_a_recorder_that_died_left_beside_its_database_is_taken_in(tmp_path):
    """SQLite keeps the newest messages in a file beside: without it they would be missing."""
    import sqlite3

    path = script().write(tmp_path / "run", "sqlite3") / "run.db3"
    writer = sqlite3.connect(path)
    writer.execute("PRAGMA journal_mode = WAL")
    writer.execute("PRAGMA wal_autocheckpoint = 0")
    writer.execute("INSERT INTO messages (topic_id, timestamp, data) SELECT topic_id, timestamp, data FROM messages")
    writer.commit()
    left = tmp_path / "left"
    left.mkdir()
    for file in path.parent.iterdir():
        if not file.name.endswith("-shm"):
            shutil.copy(file, left / file.name)
    writer.close()
    before = {file.name: file.read_bytes() for file in left.iterdir()}
    assert len(before["run.db3-wal"]) > 0
    bag = read_bag(left, "left")
    assert bag.topics["/joint_states"].count == 80
    assert {file.name: file.read_bytes() for file in left.iterdir()} == before


def test_more_messages_than_a_file_of_its_size_holds_are_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr(tape, "ALWAYS", 5)
    monkeypatch.setattr(tape, "BYTES_EACH", 10**6)
    with pytest.raises(InputError, match="there are more than 5 messages"):
        read_bag(script().write(tmp_path / "run"), "run")


@pytest.mark.parametrize(
    ("limit", "told"), [("MOST_TOPICS", "more than 1 topics"), ("LONGEST_TOPIC", "of more than 1 ch")]
)
def test_more_topics_than_a_robot_has_are_an_error(tmp_path, monkeypatch, limit, told):
    monkeypatch.setattr(tape, limit, 1)
    with pytest.raises(InputError, match=told):
        read_bag(script().write(tmp_path / "run"), "run")
