"""Runs kept in a file, a JSON object a line, so that an interrupted benchmark goes on where it was."""

from __future__ import annotations

import hashlib
import json
import tempfile
from dataclasses import fields
from pathlib import Path

import boresight
from benchmarks.trust.running import Record

DEFAULT = Path(tempfile.gettempdir()) / "boresight-trust.jsonl"


class Records:
    """Runs of this very code; lines of another version are left where they are, and not read.

    Attributes:
        path: of the file.
        code: digest of the package and of this benchmark.
        found: by scenario and seed.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.code = path, code_digest()
        self.found: dict[tuple[str, int], Record] = {}
        for line in path.read_text().splitlines() if path.exists() else ():
            kept = json.loads(line)
            if kept.pop("code") == self.code:
                record = _record(kept)
                self.found[record.scenario, record.seed] = record

    def add(self, record: Record) -> None:
        """Appends a run."""
        self.found[record.scenario, record.seed] = record
        with self.path.open("a") as file:
            file.write(json.dumps({"code": self.code, **record.as_json()}) + "\n")


def code_digest() -> str:
    """Returns what changes with any line of the package or of this benchmark."""
    digest = hashlib.sha256()
    for folder in (Path(boresight.__file__).parent, Path(__file__).parent):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def _record(kept: dict) -> Record:
    lists = {field.name for field in fields(Record) if str(field.type).startswith("tuple")}
    return Record(**{name: tuple(value) if name in lists else value for name, value in kept.items()})
