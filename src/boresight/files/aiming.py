"""The sensor, marker and target that a row of an observations file names, as one of the cell's aims."""

from __future__ import annotations

from boresight.errors import did_you_mean
from boresight.files.problems import Problems, listed, shown
from boresight.sensing import Aim, Cell

_FIELDS = {"sensor": "sensor", "marker": "mount", "target": "target"}


class AimsByName:
    """Looks up the aim that a row's names mean, each combination judged once.

    Attributes:
        keys: the columns of names that the file has, in the order of a row's names.
    """

    def __init__(self, cell: Cell, keys: tuple[str, ...]) -> None:
        self.keys = keys
        self._aims = cell.aims
        self._known: dict[tuple[str, ...], int] = {}

    def place(self, names: tuple[str, ...], where: str, problems: Problems) -> int:
        """Returns the index of the aim, or -1 where a name that it needs is empty.

        Args:
            names: a row's, in the order of `keys`.
            where: the row's place, as the beginning of a sentence.
            problems: where names that do not exist are added; such rows are not remembered, so each is told.
        """
        found = self._known.get(names)
        if found is None:
            found = self._judged(names, where, problems)
        return found

    def empty(self, names: tuple[str, ...]) -> list[str]:
        """Returns the columns whose names are empty though the row needs them."""
        return [key for key, name in zip(self.keys, names, strict=True) if not name]

    def _judged(self, names: tuple[str, ...], where: str, problems: Problems) -> int:
        left = list(enumerate(self._aims))
        for key, name in zip(self.keys, names, strict=True):
            field = _FIELDS[key]
            possible = tuple(dict.fromkeys(getattr(aim, field) for _, aim in left))
            if possible == (None,):  # this sensor is aimed at nothing
                continue
            if not name and len(possible) > 1:
                self._known[names] = -1
                return -1
            if not name and key == "target":
                self._known[names] = -1
                return -1
            if name and name not in possible:
                problems.add(f"{where}{self._no_such(key, name, possible, left[0][1], problems)}")
                return -1
            left = [(place, aim) for place, aim in left if not name or getattr(aim, field) == name]
        self._known[names] = left[0][0]
        return left[0][0]

    def _no_such(self, key: str, name: str, possible: tuple[str, ...], aim: Aim, problems: Problems) -> str:
        near = "" if problems.full else did_you_mean(name[:60], possible)
        of = f" for sensor {aim.sensor}" if "sensor" in self.keys and key != "sensor" else ""
        return f"there is no {key} {shown(name)}{of}{near}; the {key}s are {listed(possible)}"
