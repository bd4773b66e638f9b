"""Outcomes are kept as soon as they are known, once, in a file that is nobody else's."""

import sqlite3
from dataclasses import replace

import pytest
from small_studies import point

from boresight.errors import InputError, OutputError
from boresight.studies import Store, run
from boresight.studies.outcome import Outcome


@pytest.fixture(scope="module")
def outcome():
    return run(point(), 0)


def test_an_outcome_comes_back_to_the_bit(tmp_path, outcome):
    with Store.open(tmp_path / "runs.sqlite") as store:
        store.add(point(), 7, outcome)
        store.add(point(), 8, Outcome.failed("no plane in sight", 24))
    with Store.open(tmp_path / "runs.sqlite", create=False) as store:
        kept = store.outcomes(point(), 100)
        assert kept[7] == outcome
        assert kept[8].failure == "no plane in sight"
        assert store.seeds(point()) == {7, 8}
        assert list(store.outcomes(point(), 8)) == [7]
        assert store.count([point(), point(rows=50)], 100) == 2


def test_the_first_outcome_of_a_run_stays(tmp_path, outcome):
    with Store.open(tmp_path / "runs.sqlite") as store:
        store.add(point(), 0, outcome)
        store.add(point(), 0, replace(outcome, position_rms=1.0))
        assert store.outcomes(point(), 1) == {0: outcome}


def test_two_writers_share_a_file(tmp_path, outcome):
    path = tmp_path / "runs.sqlite"
    with Store.open(path) as one, Store.open(path) as two:
        for seed in range(0, 20, 2):
            one.add(point(), seed, outcome)
            two.add(point(), seed + 1, outcome)
        assert one.seeds(point()) == two.seeds(point()) == set(range(20))


def test_the_file_is_in_wal_mode_and_names_itself(tmp_path):
    with Store.open(tmp_path / "runs.sqlite"):
        pass
    with sqlite3.connect(tmp_path / "runs.sqlite") as file:
        assert file.execute("PRAGMA journal_mode").fetchone()[0] == "wal"
        assert file.execute("PRAGMA application_id").fetchone()[0] == 0x42524553
    file.close()


def test_absorbing_adds_what_is_missing(tmp_path, outcome):
    with Store.open(tmp_path / "a.sqlite") as a, Store.open(tmp_path / "b.sqlite") as b:
        a.add(point(), 0, outcome)
        b.add(point(), 0, replace(outcome, position_rms=1.0))
        b.add(point(), 1, outcome)
        b.add(point(rows=50), 1, outcome)
        assert a.absorb(tmp_path / "b.sqlite") == 2
        assert a.absorb(tmp_path / "b.sqlite") == 0
        assert a.outcomes(point(), 9)[0] == outcome


def refused(path, content):
    path.write_bytes(content)
    with pytest.raises(InputError) as caught, Store.open(path):
        pass
    assert path.read_bytes() == content
    return str(caught.value)


def test_a_file_that_is_no_database_is_refused_and_left_alone(tmp_path):
    said = refused(tmp_path / "notes.txt", b"my notes, which are long enough to be a header\n" * 20)
    assert "this is no sqlite file, or a damaged one" in said


def test_a_damaged_file_is_refused_and_left_alone(tmp_path, outcome):
    path = tmp_path / "runs.sqlite"
    with Store.open(path) as store:
        for seed in range(200):
            store.add(point(), seed, outcome)
    content = bytearray(path.read_bytes())
    content[100:] = b"\xff" * (len(content) - 100)
    assert "damaged" in refused(path, bytes(content))


def test_a_database_of_something_else_is_refused_and_left_alone(tmp_path):
    path = tmp_path / "shop.sqlite"
    with sqlite3.connect(path) as file:
        file.execute("CREATE TABLE orders (number)")
    file.close()
    assert "a database of something else" in refused(path, path.read_bytes())


def test_a_newer_format_is_refused(tmp_path):
    path = tmp_path / "runs.sqlite"
    with Store.open(path):
        pass
    with sqlite3.connect(path) as file:
        file.execute("PRAGMA user_version = 99")
    file.close()
    with pytest.raises(InputError, match="have format 99 and this Boresight reads format 1"), Store.open(path):
        pass


def test_no_file_is_told_where_one_is_needed(tmp_path):
    with pytest.raises(InputError, match="there are no results yet"), Store.open(tmp_path / "no", create=False):
        pass
    with pytest.raises(OutputError, match="cannot be opened"), Store.open(tmp_path / "no" / "runs.sqlite"):
        pass


def changed(path, outcome, *statements):
    with Store.open(path) as store:
        store.add(point(), 0, outcome)
    connection = sqlite3.connect(path)
    for statement in statements:
        connection.execute(statement)
    connection.commit()
    connection.close()


@pytest.mark.parametrize(
    ("statement", "told"),
    [
        ("UPDATE runs SET position_rms = 'x'", "position_rms: got 'x'; expected a number"),
        ("UPDATE runs SET free = 1.5", "free: got 1.5; expected a whole number"),
        ("UPDATE runs SET free = x'00'", "free: got b"),
        ("UPDATE runs SET failure = NULL", "failure: got None; expected text"),
    ],
)
def test_values_of_another_kind_are_told(tmp_path, outcome, statement, told):
    changed(tmp_path / "runs.sqlite", outcome, statement)
    with Store.open(tmp_path / "runs.sqlite") as store, pytest.raises(InputError) as caught:
        store.outcomes(point(), 1)
    assert told in str(caught.value)
    with Store.open(tmp_path / "new.sqlite") as store, pytest.raises(InputError):
        store.absorb(tmp_path / "runs.sqlite")


@pytest.mark.parametrize(
    "statements",
    [
        ["CREATE TRIGGER t AFTER INSERT ON runs BEGIN DELETE FROM runs; END"],
        ["ALTER TABLE points RENAME TO p", "CREATE VIEW points AS SELECT * FROM p"],
        ["ALTER TABLE points ADD COLUMN more TEXT GENERATED ALWAYS AS (hex(point))"],
    ],
)
def test_views_triggers_and_computed_columns_are_refused(tmp_path, outcome, statements):
    changed(tmp_path / "runs.sqlite", outcome, *statements)
    with (
        pytest.raises(InputError, match="expected the tables points and runs alone"),
        Store.open(tmp_path / "runs.sqlite"),
    ):
        pass
