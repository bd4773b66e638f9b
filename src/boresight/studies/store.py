"""Outcomes in one sqlite file, a row a run, each kept as soon as it is known.

The file is in WAL mode: several processes of one machine may write and read it at once, and a killed process loses
nothing it had written. A run's key is the point's content and the seed, so nothing is ever made twice, an extended
study goes on where it was, and a changed one keeps what still holds. (On a network's file system WAL does not
work: shards on several machines write files of their own, and are put together with `absorb`.)
"""

from __future__ import annotations

import contextlib
import json
import sqlite3
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any
from urllib.parse import quote

from boresight.errors import InputError, OutputError
from boresight.studies.grid import AXES, Point
from boresight.studies.outcome import Outcome

APPLICATION, VERSION = 0x42524553, 1
"""How sqlite's header tells our files from others, and which tables they have."""

PATIENCE_S = 60.0
"""How long a writer waits for another one."""

_COLUMNS = tuple(field.name for field in fields(Outcome))
_KINDS = tuple(str(field.type) for field in fields(Outcome))
_ACCEPTED: dict[str, tuple[type, ...]] = {"str": (str,), "int": (int,), "float": (float, int, type(None))}
_TYPES = {"str": "TEXT", "int": "INTEGER", "float": "REAL"}


_LONGEST = 2**24
"""Bytes of the longest value or statement that is read."""

_STRANGE = (
    "SELECT type, name FROM sqlite_master WHERE type IN ('view', 'trigger') OR (type = 'table' "
    "AND (name NOT IN ('points', 'runs') AND name NOT LIKE 'sqlite_stat%' OR sql LIKE '%VIRTUAL%' "
    "OR sql LIKE '%GENERATED%' OR sql LIKE '% AS (%')) LIMIT 1"
)


def _shown(value: object) -> str:
    """Returns a value out of a database as a short phrase for a message."""
    return ascii(value)[:60]


class Store:
    """The file of a study's outcomes.

    Attributes:
        path: where it is.
    """

    def __init__(self, path: Path, connection: sqlite3.Connection) -> None:
        self.path = path
        self._file = connection

    @classmethod
    @contextlib.contextmanager
    def open(cls, path: Path, *, create: bool = True) -> Iterator[Store]:
        """Yields the store in a file, made if need be.

        Args:
            path: the file; its folder exists.
            create: whether to make it where it is missing.

        Raises:
            InputError: there is none, or it is another kind of file, which is left as it is.
            OutputError: it cannot be written.
        """
        if not create and not path.exists():
            raise InputError(f"{path}: there are no results yet; run the study without --summary first")
        try:
            connection = sqlite3.connect(
                f"file:{quote(str(path))}?mode={'rwc' if create else 'rw'}",
                uri=True,
                timeout=PATIENCE_S,
                isolation_level=None,
            )
        except sqlite3.Error as error:
            raise OutputError(f"{path}: it cannot be opened: {error}") from None
        with contextlib.closing(connection), _explained(path):
            _prepare(connection, path)
            yield cls(path, connection)

    def add(self, point: Point, seed: int, outcome: Outcome) -> None:
        """Keeps one outcome; where that run is there already, nothing changes."""
        with _explained(self.path), self._at_once():
            self._describe(point)
            self._insert([(point.key, seed, *_stored(outcome))])

    def add_many(self, outcomes: Iterable[tuple[Point, int, Outcome]]) -> None:
        """Keeps several outcomes, all or none."""
        with _explained(self.path), self._at_once():
            for point, seed, outcome in outcomes:
                self._describe(point)
                self._insert([(point.key, seed, *_stored(outcome))])

    def seeds(self, point: Point) -> set[int]:
        """Returns the seeds of a point that are done."""
        with _explained(self.path):
            return {seed for (seed,) in self._file.execute("SELECT seed FROM runs WHERE point = ?", (point.key,))}

    def outcomes(self, point: Point, seeds: int) -> dict[int, Outcome]:
        """Returns a point's outcomes by seed, in their order, below a number of seeds."""
        wanted = f"SELECT seed, {', '.join(_COLUMNS)} FROM runs WHERE point = ? AND seed < ? ORDER BY seed"
        with _explained(self.path):
            rows = self._file.execute(wanted, (point.key, seeds)).fetchall()
        return {seed: _restored(row, self.path) for seed, *row in rows}

    def count(self, points: Collection[Point], seeds: int) -> int:
        """Returns how many runs of some points are done, below a number of seeds."""
        wanted = "SELECT count(*) FROM runs WHERE point = ? AND seed < ?"
        with _explained(self.path):
            return sum(self._file.execute(wanted, (point.key, seeds)).fetchone()[0] for point in points)

    def absorb(self, other: Path) -> int:
        """Returns how many outcomes another store had that this one had not, and keeps them.

        Raises:
            InputError: the other is missing, or another kind of file.
        """
        with Store.open(other, create=False) as source, _explained(self.path):
            with _explained(other):
                points = source._file.execute("SELECT point, settings FROM points").fetchall()
                runs = source._file.execute(f"SELECT point, seed, {', '.join(_COLUMNS)} FROM runs").fetchall()
            _check_runs(points, runs, other)
            before = self._file.execute("SELECT count(*) FROM runs").fetchone()[0]
            with self._at_once():
                self._file.executemany("INSERT OR IGNORE INTO points VALUES (?, ?)", points)
                self._insert(runs)
            return int(self._file.execute("SELECT count(*) FROM runs").fetchone()[0] - before)

    @contextlib.contextmanager
    def _at_once(self) -> Iterator[None]:
        self._file.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            self._file.execute("ROLLBACK")
            raise
        self._file.execute("COMMIT")

    def _insert(self, rows: Iterable[tuple[Any, ...]]) -> None:
        places = ", ".join("?" for _ in range(2 + len(_COLUMNS)))
        self._file.executemany(f"INSERT OR IGNORE INTO runs VALUES ({places})", rows)

    def _describe(self, point: Point) -> None:
        settings = json.dumps({axis: point.label(axis) for axis in AXES})
        self._file.execute("INSERT OR IGNORE INTO points VALUES (?, ?)", (point.key, settings))


def _prepare(connection: sqlite3.Connection, path: Path) -> None:
    """Makes the tables of a new file, and refuses a file that is not ours."""
    connection.execute("PRAGMA trusted_schema = OFF")
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LONGEST)
    connection.execute("BEGIN")  # one view of the file, which another process may be making just now
    application, version = (connection.execute(f"PRAGMA {n}").fetchone()[0] for n in ("application_id", "user_version"))
    tables = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0]
    strange = connection.execute(_STRANGE).fetchone()
    connection.execute("COMMIT")
    if application == APPLICATION:
        if version != VERSION:
            raise InputError(
                f"{path}: these results have format {version} and this Boresight reads format {VERSION}; "
                "use the version that made them, or another file"
            )
        if strange is not None:
            raise InputError(
                f"{path}: holds the {strange[0]} {_shown(strange[1])}; expected the tables points and runs alone: "
                "give another file, or make the runs again"
            )
    elif tables or application or version:
        raise InputError(f"{path}: this is a database of something else; expected one of boresight study")
    connection.execute("PRAGMA journal_mode = WAL")
    # In WAL mode this is safe against the death of the process; only that of the power may cost the last few runs.
    connection.execute("PRAGMA synchronous = NORMAL")
    if application == APPLICATION:
        return
    columns = ", ".join(f"{field.name} {_TYPES[str(field.type)]}" for field in fields(Outcome))
    connection.execute("BEGIN IMMEDIATE")
    connection.execute("CREATE TABLE IF NOT EXISTS points (point TEXT PRIMARY KEY, settings TEXT) WITHOUT ROWID")
    columns = f"point TEXT, seed INTEGER, {columns}, PRIMARY KEY (point, seed)"
    connection.execute(f"CREATE TABLE IF NOT EXISTS runs ({columns}) WITHOUT ROWID")
    connection.execute(f"PRAGMA application_id = {APPLICATION}")
    connection.execute(f"PRAGMA user_version = {VERSION}")
    connection.execute("COMMIT")


def _stored(outcome: Outcome) -> tuple[Any, ...]:
    return astuple(outcome)


def _check_runs(points: Sequence[tuple[Any, ...]], runs: Sequence[tuple[Any, ...]], path: Path) -> None:
    """Raises an `InputError` for rows that are not of a study."""
    if not all(isinstance(value, str) for row in points for value in row):
        raise InputError(f"{path}: a point of the study is not text; the database is damaged: make the runs again")
    for point, seed, *row in runs:
        if not isinstance(point, str) or not isinstance(seed, int):
            raise InputError(f"{path}: a run has no point or no seed; the database is damaged: make the runs again")
        _restored(row, path)


def _restored(row: Sequence[Any], path: Path) -> Outcome:
    """Returns an outcome; sqlite keeps NaN as NULL.

    Raises:
        InputError: a value is of another kind: sqlite keeps any in any column.
    """
    for name, kind, value in zip(_COLUMNS, _KINDS, row, strict=True):
        if not isinstance(value, _ACCEPTED[kind]):
            wanted = "text" if kind == "str" else "a whole number" if kind == "int" else "a number"
            raise InputError(
                f"{path}: {name}: got {_shown(value)}; expected {wanted}: the database is damaged, make the runs again"
            )
    values: list[Any] = [float("nan") if value is None else value for value in row]
    return Outcome(*values)


@contextlib.contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Says what sqlite's errors mean."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        name = getattr(error, "sqlite_errorname", "")
        if name.startswith(("SQLITE_NOTADB", "SQLITE_CORRUPT")):
            raise InputError(
                f"{path}: this is no sqlite file, or a damaged one ({error}); it was left as it is: "
                "give another with -o, or move it away"
            ) from None
        raise OutputError(f"{path}: results cannot be kept there: {error}") from None
