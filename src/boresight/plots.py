"""Figures in one look, on Matplotlib alone: PNG to look at, SVG to print, the same bytes every time.

    figure, axes = panels(1, 2)
    axes[0, 0].plot(x, y, color=COLOURS[0])
    save(figure, folder / "figure-3")

Figures are made without pyplot, so nothing is kept globally and no window system is needed.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#0b5cad", "#d1495b", "#2a9d5c", "#c77d0a", "#6d4fa3", "#4d5a66")
"""Told apart in print and by the colour-blind, in this order."""

PANEL = (4.2, 2.9)
"""Width and height of one panel [inch]."""

_LOOK: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 9.5,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#4d5a66",
    "axes.labelcolor": "#22303c",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e3e7eb",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.0,
    "xtick.color": "#4d5a66",
    "ytick.color": "#4d5a66",
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "savefig.dpi": 160,
    "svg.hashsalt": "boresight",
    "svg.fonttype": "none",
    "text.parse_math": False,  # names that a user gives are names, whatever is in them
}


@contextlib.contextmanager
def look() -> Iterator[None]:
    """Has everything that is drawn meanwhile take the house's look: titles and legends take it when they are made."""
    import matplotlib

    with matplotlib.rc_context(_LOOK):
        yield


def panels(rows: int = 1, columns: int = 1, panel: tuple[float, float] = PANEL) -> tuple[Figure, np.ndarray]:
    """Returns a figure in the house's look and its (rows, columns) axes.

    Args:
        rows: of panels.
        columns: of panels.
        panel: width and height of each [inch].
    """
    from matplotlib.figure import Figure

    with look():
        figure = Figure(figsize=(panel[0] * columns, panel[1] * rows), layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False)
    for each in axes.flat:
        each.set_prop_cycle(color=COLOURS)
    return figure, axes


def _take_names_as_they_are(figure: Figure) -> None:
    """Has no text of a figure read as a formula: names are names, whatever a user calls things.

    Logarithmic axes write their ticks as formulas by themselves; they get plain numbers in the same places.
    """
    from matplotlib.text import Text
    from matplotlib.ticker import FuncFormatter, LogFormatter

    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            for which in ("major", "minor"):
                own = getattr(axis, f"get_{which}_formatter")()
                if isinstance(own, LogFormatter):
                    number = FuncFormatter(lambda value, place, own=own: f"{value:g}" if own(value, place) else "")
                    getattr(axis, f"set_{which}_formatter")(number)
    for text in figure.findobj(Text):
        text.set_parse_math(False)


def save(figure: Figure, stem: Path) -> tuple[Path, Path]:
    """Returns the PNG and the SVG file of a figure, written to a temporary name and renamed.

    Args:
        figure: the figure.
        stem: path without its ending; its folder exists.
    """
    written = []
    _take_names_as_they_are(figure)
    with look():
        for ending, metadata in (("png", {"Software": None}), ("svg", {"Date": None})):
            path = stem.with_name(f"{stem.name}.{ending}")
            unfinished = stem.with_name(f".{stem.name}.{os.getpid()}.{ending}")
            figure.savefig(unfinished, metadata=metadata)
            os.replace(unfinished, path)
            written.append(path)
    return written[0], written[1]
