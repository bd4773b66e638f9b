"""Observations in Parquet are read, and refused, as the same rows in CSV are."""

from __future__ import annotations

import builtins
import shutil
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from boresight.errors import InputError
from boresight.files import load_campaign

pa = pytest.importorskip("pyarrow")
csv = pytest.importorskip("pyarrow.csv")
pq = pytest.importorskip("pyarrow.parquet")

EXAMPLE = Path(__file__).parents[2] / "examples" / "space-arm-one-plane"


@pytest.fixture
def folder(tmp_path):
    """A campaign whose observations are rows.parquet, and its rows as a table."""
    shutil.copytree(EXAMPLE, tmp_path / "campaign")
    campaign = tmp_path / "campaign" / "campaign.yaml"
    text = campaign.read_text()
    assert "observations: observations.csv" in text
    campaign.write_text(text.replace("observations: observations.csv", "observations: rows.parquet"))
    return tmp_path / "campaign"


def table():
    return csv.read_csv(EXAMPLE / "observations.csv")


def load(folder, rows=None, content=None, **options):
    if rows is not None:
        pq.write_table(rows, folder / "rows.parquet", **options)
    if content is not None:
        (folder / "rows.parquet").write_bytes(content)
    return load_campaign(folder / "campaign.yaml", need_readings=True)


@pytest.mark.parametrize("options", [{}, {"compression": "gzip", "row_group_size": 7}, {"use_dictionary": False}])
def test_it_holds_what_the_csv_holds_to_the_bit(folder, options):
    found, expected = load(folder, table(), **options), load_campaign(EXAMPLE / "campaign.yaml", need_readings=True)
    for name in ("joints", "values", "std", "target", "line"):
        np.testing.assert_array_equal(getattr(found.readings, name), getattr(expected.readings, name))


def test_rows_that_cannot_be_used_are_set_aside_with_their_lines(folder):
    rows = table()
    ranges = rows["range"].to_pylist()
    ranges[2], ranges[4] = None, float("nan")
    found = load(folder, rows.set_column(rows.column_names.index("range"), "range", pa.array(ranges)))
    assert [aside.line for aside in found.set_aside] == [4, 6]
    assert len(found.readings) == len(ranges) - 2


def test_text_where_numbers_belong_is_told_of_as_in_csv(folder):
    rows = table()
    words = ["far"] + [str(each) for each in rows["range"].to_pylist()[1:]]
    with pytest.raises(InputError, match=r"rows\.parquet, line 2: range: got 'far'; expected a number"):
        load(folder, rows.set_column(rows.column_names.index("range"), "range", pa.array(words)))


def test_a_column_that_is_missing_is_named(folder):
    with pytest.raises(InputError, match=r"rows\.parquet.*j3"):
        load(folder, table().drop_columns(["j3"]))


def test_columns_that_no_csv_could_hold_are_refused(folder):
    nested = table().append_column("extra", pa.array([[1.0]] * table().num_rows))
    with pytest.raises(InputError, match=r"extra \(list"):
        load(folder, nested)


@pytest.mark.parametrize(
    "spoil", [lambda b: b"range\n1\n", lambda b: b"", lambda b: b[:-9], lambda b: b[:40] + b[200:]]
)
def test_what_is_no_parquet_or_damaged_is_refused(folder, spoil):
    pq.write_table(table(), folder / "rows.parquet")
    with pytest.raises(InputError, match=r"rows\.parquet: this is no Parquet file, or a damaged one"):
        load(folder, content=spoil((folder / "rows.parquet").read_bytes()))


def test_a_small_file_that_unpacks_to_a_large_one_is_refused(folder, monkeypatch):
    monkeypatch.setattr("boresight.files.observations.LIMIT_MIB", 1)
    same = pa.table({name: np.full(2_000_000, 0.5) for name in table().column_names})
    with pytest.raises(InputError, match="at most 1 MiB"):
        load(folder, same, compression="zstd", use_dictionary=False)
    assert (folder / "rows.parquet").stat().st_size < 2**20


def test_without_pyarrow_it_says_what_to_install(folder, monkeypatch):
    pq.write_table(table(), folder / "rows.parquet")
    real = builtins.__import__

    def without(name, *rest, **named):
        if name.startswith("pyarrow"):
            raise ImportError(name)
        return real(name, *rest, **named)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"boresight\[parquet\]"):
        load(folder)


def test_its_first_bytes_tell_it_whatever_it_is_called(folder):
    campaign = folder / "campaign.yaml"
    campaign.write_text(campaign.read_text().replace("rows.parquet", "rows.dat"))
    pq.write_table(table(), folder / "rows.dat")
    assert len(load(folder).readings) == table().num_rows


def test_large_words_named_by_many_rows_take_no_memory(folder):
    """Half a MiB, named by every row: as CSV it would be 16 GiB."""
    rows = 32_768
    joints = {name: np.full(rows, 0.5) for name in table().column_names if name != "target"}
    words = pa.DictionaryArray.from_arrays(pa.array(np.zeros(rows, np.int32)), pa.array(["x" * 2**19]))
    same = pa.table({**joints, "target": words})
    pq.write_table(same, folder / "rows.parquet")
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match="there is no target 'xxx"):
            load(folder)
        assert tracemalloc.get_traced_memory()[1] < 200 * 2**20
    finally:
        tracemalloc.stop()


def test_many_rows_that_pack_to_nothing_are_refused(folder, monkeypatch):
    monkeypatch.setattr("boresight.files.observations.LIMIT_MIB", 1)
    same = pa.table({name: np.full(200_000, 0.5) for name in table().column_names})
    with pytest.raises(InputError, match="at most 1 MiB"):
        load(folder, same)
    assert (folder / "rows.parquet").stat().st_size < 2**16


def test_a_cell_is_a_cell_whatever_is_written_in_it(folder):
    """In CSV a hash begins a comment; here it is a name's own."""
    rows = table()
    found = load(folder, rows.append_column("session", pa.array(['#1, "a"\nb'] * rows.num_rows)))
    assert set(found.readings.session) == {'#1, "a"\\nb'}  # what no terminal shows is written as an escape


@pytest.mark.parametrize("kind", [pa.float32(), pa.decimal128(12, 6)])
def test_numbers_of_other_types_are_read_as_they_are_written(folder, kind):
    rows = table()
    short = pa.array([round(value, 3) for value in rows["range"].to_pylist()]).cast(kind)
    found = load(folder, rows.set_column(rows.column_names.index("range"), "range", short))
    np.testing.assert_array_equal(found.readings.values[:, 0], np.round(rows["range"].to_numpy(), 3))


def test_text_that_is_not_utf8_is_told(folder):
    rows = table()
    raw = pa.array([b"\xff" + word.encode() for word in rows["target"].to_pylist()], pa.binary())
    text = pa.Array.from_buffers(pa.string(), len(raw), raw.buffers())
    pq.write_table(rows.set_column(rows.schema.get_field_index("target"), "target", text), folder / "rows.parquet")
    with pytest.raises(InputError, match="it holds text that is not UTF-8; write it again"):
        load_campaign(folder / "campaign.yaml")


def test_a_file_that_stands_for_many_times_its_size_is_refused(folder, monkeypatch):
    monkeypatch.setattr("boresight.files.parquet.ALWAYS_MIB", 1)
    same = pa.table({name: np.full(200_000, 0.5) for name in table().column_names})
    with pytest.raises(InputError, match="times its size unpacked; expected at most 20 times"):
        load(folder, same)
