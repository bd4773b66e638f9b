"""A result on a terminal, to be read in ten seconds."""

from __future__ import annotations

import math
from pathlib import Path

from rich.console import Console, Group, RenderableType
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from boresight.calibration.result import Outlier, Residuals, Result
from boresight.units import in_millimetres

_FEW = 5
_DIRECTIONS = 3

_KINDS = {
    "laser_ranger": "range error",
    "draw_wire": "length error",
    "pose": "pose error",
    "plane_contact": "contact error",
    "point_contact": "contact error",
    "distances": "distance error",
}


def print_summary(console: Console, result: Result, folder: Path) -> None:
    """Prints verdict, before and after, what was not seen, how the search went, and where the files are."""
    accepted = result.verdict.accepted
    word, colour = ("ACCEPTED", "bold green") if accepted else ("REJECTED", "bold red")
    console.print(Text.assemble((word, colour), "  ", (result.name, "bold")))
    console.print(_indented(Group(*(Text(reason) for reason in result.verdict.reasons))))
    console.print(_errors_table(result))
    console.print(_indented(Group(*_facts(result))))
    for warning in result.warnings:
        console.print(f"[yellow]Warning:[/] {escape(warning)}")
    for note in result.notes:
        console.print(f"Note: {escape(note)}")
    console.print(f"Files: [bold]{escape(str(folder))}/[/]  (open report.html)", soft_wrap=True)


def _errors_table(result: Result) -> Table:
    kinds = {
        "laser_ranger": "range error",
        "draw_wire": "length error",
        "plane_contact": "contact error",
        "point_contact": "contact error",
        "distances": "distance error",
        "pose": "pose error",
    }
    types = {sensor.type for sensor in result.cell.sensors.values()}
    kind = "error" if len(types) > 1 else kinds.get(next(iter(types)), "position error")
    table = Table(box=None, padding=(0, 2) if len(result.by_sensor) == 1 else (0, 1), pad_edge=True)
    table.add_column(kind, style="bold", no_wrap=True)
    table.add_column("rows", justify="right")
    for when in ("before", "after"):
        table.add_column(f"{when}: RMS", justify="right")
        table.add_column("max", justify="right")
    table.add_row("held out", *_error_cells(result.validation))
    table.add_row("calibration", *_error_cells(result.calibration))
    if len(result.by_sensor) > 1:
        for each in result.by_sensor:
            sizes = (each.before.rms, each.before.max, each.after.rms, each.after.max)
            name = each.what if len(result.cell.sensors) == 1 else f"{each.sensor} {each.what}"
            table.add_row(name, str(each.rows), *(_amount(size, each.unit) for size in sizes))
    return table


def _amount(size: float, unit: str) -> str:
    return in_millimetres(size) if unit == "m" else in_millimetres(size).replace("mm", "mrad")


def _error_cells(residuals: Residuals) -> tuple[str, ...]:
    sizes = (residuals.before.rms, residuals.before.max, residuals.after.rms, residuals.after.max)
    return (str(residuals.count), *(in_millimetres(size) for size in sizes))


def _facts(result: Result) -> list[RenderableType]:
    facts = [_seen(result), _known(result), _searched(result)]
    prior = [e.name for e in result.estimates if e.source == "prior" and e.name not in result.priors]
    gauge = [e.name for e in result.estimates if e.source == "gauge"]
    if gauge:
        facts.append(f"Gauge, held where it was: {_some(gauge)}; no reading and no number below depends on it.")
    if prior:
        facts.append(f"Prior-dominated: {_some(prior)}; the readings say little about them.")
    if result.outliers:
        facts.append(f"Outliers: {_some([_outlier(each) for each in result.outliers])} do not fit with the other rows.")
    if result.set_aside:
        rows = [f"{row.file} line {row.line} ({row.reason})" for row in result.set_aside]
        facts.append(f"Set aside: {_some(rows)}.")
    return [Text(fact) for fact in facts]


def _outlier(outlier: Outlier) -> str:
    size = in_millimetres(outlier.residual_m) if math.isfinite(outlier.residual_m) else "its beam misses"
    return f"line {outlier.line} ({size})"


def _seen(result: Result) -> str:
    if not result.unseen:
        held = f"; assumed known: {_some(list(result.assumed))}" if result.assumed else ""
        others = f"; not estimated, prior counted: {_some(list(result.priors))}" if result.priors else ""
        return f"Identifiable: rank {result.rank} of {result.free}{others}{held}."
    words = "; ".join(unseen.words for unseen in result.unseen[:_DIRECTIONS])
    more = len(result.unseen) - _DIRECTIONS
    others = f" (and {more} more, in result.json)" if more > 0 else ""
    return f"Not identifiable: {result.free - result.rank} of {result.free} directions. {words}{others}."


def _known(result: Result) -> str:
    absolute, relative = result.accuracy.absolute, result.accuracy.relative
    said = [
        f"{_within(each.median)} and {_turned(each.median_turn)} {name}"
        for name, each in (("absolute", absolute), ("relative", relative))
    ]
    beam = "; orientation is the beam's, without the spin about it" if absolute.pose.beam_alone else ""
    return f"Tool pose over the work space, 95 %, median: {'; '.join(said)}{beam}."


def _turned(radius: float) -> str:
    return f"{1e3 * radius:.3g} mrad" if math.isfinite(radius) else "not determined"


def _within(radius: float) -> str:
    return in_millimetres(radius) if math.isfinite(radius) else "not determined"


def _searched(result: Result) -> str:
    solution = result.solution
    ran = ", then ".join(f"{stage.name} ({stage.seconds:.2f} s: {stage.outcome})" for stage in solution.stages)
    said = f"Search: {ran}."
    if solution.nominal_suffices is None or result.solver.name == "least-squares":
        return said
    also = "would have found the same" if solution.nominal_suffices else "would have ended elsewhere, with a worse fit"
    return f"{said} Least squares from the nominal model alone {also}."


def _some(items: list[str]) -> str:
    shown = ", ".join(items[:_FEW])
    return shown if len(items) <= _FEW else f"{shown} and {len(items) - _FEW} more"


def _indented(content: RenderableType) -> Padding:
    return Padding(content, (0, 0, 0, 2))
