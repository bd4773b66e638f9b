"""rosbag2's SQLite storage, read row by row, so that damage costs the rows it lies on."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from itertools import islice
from pathlib import Path
from shutil import copyfile
from tempfile import TemporaryDirectory

from boresight.errors import InputError
from boresight.files.bags.tape import LARGEST_MESSAGE, MOST_TOPICS, Tape, TooMuch
from boresight.files.problems import printable

_BESIDE = ("-wal", "-journal")
"""What a recorder that died leaves beside its database: without it the last messages are missing."""

_LOWEST, _FARTHEST_LEAP = -(2**62), 2**40
_SMALLEST_ROW = 8
"""Bytes of a file that a row takes at least."""
_COMPUTED = (2, 3)
_TABLES = "SELECT name, type, sql FROM sqlite_master WHERE name IN ('topics', 'messages')"


def read_database(path: Path, name: str, tape: Tape) -> None:
    """Returns nothing; the tape gets what the database holds, and a sentence on what is lost.

    Args:
        path: of the database; neither it nor its folder is written to.
        name: of the file, for the sentence.
        tape: where messages go.

    Raises:
        InputError: the database is none, or not that of a bag.
    """
    beside = [Path(f"{path}{end}") for end in _BESIDE if Path(f"{path}{end}").is_file()]
    if not any(file.stat().st_size for file in beside):
        return _read(f"{path.absolute().as_uri()}?immutable=1", name, tape, path.stat().st_size)
    # SQLite takes such files in by writing; a copy is written to, not the user's bag.
    with TemporaryDirectory() as folder:
        copy = Path(folder) / "bag.db3"
        for end, file in (("", path), *((str(file)[len(str(path)) :], file) for file in beside)):
            copyfile(file, f"{copy}{end}")
        return _read(copy.as_uri(), name, tape, sum(file.stat().st_size for file in (path, *beside)))


def _read(uri: str, name: str, tape: Tape, size: int) -> None:
    most = tape.total + size // _SMALLEST_ROW
    try:
        with closing(sqlite3.connect(uri, uri=True)) as connection:
            connection.text_factory = lambda text: text.decode("utf-8", "replace")
            connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, 256 * 2**20)
            connection.execute("PRAGMA trusted_schema = OFF")
            # Without this, SQLite refuses a file that is shorter than its header says.
            connection.execute("PRAGMA writable_schema = ON")
            topics = _topics(connection, name, tape)
            for number, received, length, data in _messages(connection, name, topics, tape, most):
                topic = topics.get(number, "")
                if isinstance(data, bytes) and isinstance(received, int) and length <= LARGEST_MESSAGE:
                    tape.keep(topic, received, data)
                else:
                    tape.count(topic)
    except sqlite3.Error as error:
        raise InputError(f"{name}: the database cannot be read: {error}") from None


def _topics(connection: sqlite3.Connection, name: str, tape: Tape) -> dict[object, str]:
    """Returns the topics by the numbers that messages have for them, and announces them."""
    tables = {row[0]: row for row in connection.execute(_TABLES)}
    # A view or a virtual table could compute for ever.
    plain = [
        row for row in tables.values() if row[1] == "table" and not str(row[2]).upper().startswith("CREATE VIRTUAL")
    ]
    if len(plain) != 2:
        raise InputError(f"{name}: this database is not a ROS 2 bag; expected the tables topics and messages")
    for table in tables:
        # Hidden columns of these kinds are computed from others, to any length.
        computed = [row[1] for row in connection.execute(f"PRAGMA table_xinfo({table})") if row[6] in _COMPUTED]
        if computed:
            raise InputError(
                printable(
                    f"{name}: column {computed[0]} of table {table} is computed; expected one that a recorder wrote"
                )
            )
    topics: dict[object, str] = {}
    rows = connection.execute("SELECT id, name, type, serialization_format FROM topics")
    for number, topic, kind, encoding in islice(rows, MOST_TOPICS + 1):
        topics[number] = str(topic)
        tape.announce(str(topic), str(kind), str(encoding))
    if next(rows, None) is not None:
        raise TooMuch(f"{name}: there are more than {MOST_TOPICS:,} topics; record those of the arm alone")
    return topics


def _messages(
    connection: sqlite3.Connection, name: str, topics: dict[object, str], tape: Tape, most: int
) -> Iterator[tuple[object, object, int, object]]:
    """Yields (topic number, received [ns], length, data or None) of every row that can be read, in order.

    Where the database is damaged, rows are leapt over: one, then two, then four, until one can be read again.
    """
    wanted = [number for number, topic in topics.items() if tape.wants(topic)]
    query = (
        "SELECT id, topic_id, timestamp, length(data), "
        f"CASE WHEN topic_id IN ({','.join('?' * len(wanted))}) AND length(data) <= {LARGEST_MESSAGE} THEN data END "
        "FROM messages WHERE id > ? ORDER BY id"
    )
    last, before, leap, damaged = _LOWEST, _LOWEST, 1, ""
    while leap < _FARTHEST_LEAP and tape.total < most:
        try:
            for number, topic, received, length, data in connection.execute(query, (*wanted, last)):
                if number <= last or tape.total >= most:
                    # Pages that lead back to one another would be read for ever, and a number that is far too high
                    # would hide all that follow.
                    last = before
                    raise sqlite3.DatabaseError("rows out of order")
                before, last, leap = last, number, 1
                yield topic, received, length or 0, data
            break
        except sqlite3.DatabaseError as error:
            damaged = damaged or f"{name}: the database is damaged ({error}) after {tape.total:,} messages"
            last, leap = max(last, 0) + leap, leap * 2
    if damaged:
        tape.lose(f"{damaged}; rows that can be read have been, {tape.total:,} in all")
