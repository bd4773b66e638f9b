"""Copies of the examples, to be spoiled by the tests."""

from dataclasses import dataclass
from pathlib import Path

EXAMPLES = Path(__file__).parents[2] / "examples"


@dataclass(frozen=True)
class Files:
    """A copy of an example, to be spoiled."""

    folder: Path

    @property
    def campaign(self):
        return self.folder / "campaign.yaml"

    def swap(self, file, *pairs):
        text = (self.folder / file).read_text()
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        (self.folder / file).write_text(text)
        return self

    def rows(self, change, file="observations.csv"):
        """Passes the rows of cells, the header's first, through a function."""
        lines = (self.folder / file).read_text().splitlines()
        cells = change([line.split(",") for line in lines])
        (self.folder / file).write_text("".join(",".join(row) + "\n" for row in cells))
        return self

    def shuffle_ranges(self):
        """Ranges that have nothing to do with their configurations: nothing can be learnt."""
        return self.rows(lambda rows: [rows[0], *([*row[:6], other[6], row[7]] for row, other in shifted(rows[1:]))])


def shifted(rows):
    return zip(rows, [*rows[37:], *rows[:37]], strict=True)


def content(folder):
    """Every file's bytes, by its path in the folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
