"""What a benchmark found, and results.md, where each benchmark has a section of its own."""

from __future__ import annotations

import platform
import re
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

RESULTS = Path(__file__).with_name("results.md")
PACKAGES = ("boresight", "numpy", "scipy", "numba", "pygmo", "pymoo", "minionpy", "pyarrow")


@dataclass(frozen=True)
class Figure:
    """A number with a target.

    Attributes:
        name: what it is.
        value: as measured.
        target: in words: `<= 1.05`, `93 to 97 %`.
        met: whether it is reached.
    """

    name: str
    value: str
    target: str
    met: bool


@dataclass(frozen=True)
class Table:
    """Measured numbers, as text."""

    title: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def as_markdown(self) -> str:
        """Returns the table under its title."""
        wide = [max(3, *map(len, column)) for column in zip(self.header, *self.rows, strict=True)]
        lines = [self.header, tuple("-" * width for width in wide), *self.rows]
        cells = ((cell.ljust(width) for cell, width in zip(line, wide, strict=True)) for line in lines)
        return f"**{self.title}**\n\n" + "\n".join(f"| {' | '.join(line)} |" for line in cells)


@dataclass(frozen=True)
class Report:
    """A benchmark's outcome.

    Attributes:
        name: the benchmark's.
        about: what was measured, and how, in a few sentences.
        figures: numbers with targets.
        tables: the rest.
        notes: what a reader should know.
        values: what the tables show, as numbers; for JSON alone.
    """

    name: str
    about: str
    figures: tuple[Figure, ...]
    tables: tuple[Table, ...]
    notes: tuple[str, ...] = ()
    values: dict[str, object] = field(default_factory=dict)

    def as_markdown(self) -> str:
        """Returns the section of results.md."""
        parts = [f"## {self.name}", f"{datetime.now(UTC):%Y-%m-%d}, {machine()}.", self.about]
        if self.figures:
            rows = tuple((f.name, f.value, f.target, "yes" if f.met else "**no**") for f in self.figures)
            parts.append(Table("Targets", ("figure", "measured", "target", "met"), rows).as_markdown())
        parts += [table.as_markdown() for table in self.tables]
        if self.notes:
            parts.append("\n".join(f"- {note}" for note in self.notes))
        return "\n\n".join(parts) + "\n"

    def as_json(self) -> dict[str, object]:
        """Returns everything as plain values."""
        return {"date": f"{datetime.now(UTC):%Y-%m-%d}", "machine": machine(), **asdict(self)}

    def write(self) -> None:
        """Replaces this benchmark's section of results.md, or appends it, and leaves the others alone."""
        text = (
            RESULTS.read_text()
            if RESULTS.exists()
            else "# Results\n\nWritten by `python -m benchmarks [NAME]`; without a name, speed.\n"
        )
        head, *sections = re.split(r"(?m)^(?=## )", text)
        kept = {section.split("\n", 1)[0]: section.rstrip() + "\n" for section in sections}
        kept[f"## {self.name}"] = self.as_markdown()
        RESULTS.write_text("\n".join([head.rstrip() + "\n", *kept.values()]))


def machine() -> str:
    """Returns the processor, Python and the packages' versions."""
    import os

    found = [f"{platform.machine()} ({processor()}, {os.cpu_count()} cores)", f"Python {platform.python_version()}"]
    for package in PACKAGES:
        try:
            found.append(f"{package} {version(package)}")
        except PackageNotFoundError:
            continue
    return ", ".join(found)


def processor() -> str:
    """Returns the processor's name, where the system tells it."""
    told = Path("/proc/cpuinfo")
    named = re.search(r"model name\s*:\s*(.+)", told.read_text()) if told.exists() else None
    return named.group(1) if named else platform.processor() or "unknown"


def spread(value: float, error: float, digits: int = 3) -> str:
    """Returns a value with its own Monte-Carlo standard error."""
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def percent(share: float, digits: int = 1) -> str:
    """Returns a share in per cent."""
    return f"{100 * share:.{digits}f} %"
