"""A figure with the numbers that are drawn in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Picture:
    """A figure, ready to be saved.

    Attributes:
        name: of its files.
        title: what it is.
        caption: what is to be seen, in words; also for those who cannot see it.
        figure: Matplotlib's.
        csv: the numbers.
    """

    name: str
    title: str
    caption: str
    figure: Figure
    csv: str
