"""What a campaign could know: on a terminal, to be read in ten seconds, and as JSON."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Any

from rich.console import Console, RenderableType
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from boresight.calibration.inspect import Inspection, Prediction
from boresight.calibration.left_out import left_out_in_words
from boresight.units import in_millimetres

SCHEMA = "boresight-inspection/1"
"""Name and version of the layout; the number grows when a key changes its meaning or goes."""

_FEW = 5
"""Unseen or faint directions, and parameters, shown on a terminal; `--json` has all."""


def inspection_document(inspection: Inspection, version: str) -> dict[str, Any]:
    """Returns an inspection as dictionaries, lists, numbers and strings; lengths in m, angles in rad.

    Args:
        inspection: the inspection.
        version: of the software that made it.
    """
    return {
        "schema": SCHEMA,
        "name": inspection.name,
        "version": version,
        "seed": inspection.seed,
        "configurations": {
            "count": inspection.rows,
            "drawn": inspection.drawn,
            "values": inspection.values,
            "missed": inspection.missed,
            "targets": list(inspection.targets),
        },
        "noise": {"unit": "m", "stated_std": inspection.noise_std},
        "identifiability": {
            "free": len(inspection.free),
            "parameters": list(inspection.free),
            "rank": inspection.rank,
            "condition": _number(inspection.condition),
            "singular_values": list(inspection.singular_values),
            "observability": asdict(inspection.observability),
            "everett_count": inspection.everett,
            "arm_rank": inspection.arm_rank,
            "unseen": [asdict(unseen) for unseen in inspection.unseen],
            "hardly_seen": [asdict(faint) for faint in inspection.hardly],
        },
        "left_out": [asdict(out) for out in inspection.left_out],
        "parameters": [
            {
                "name": prediction.parameter,
                "unit": prediction.unit,
                "prior_std": prediction.prior_std,
                "std": _number(prediction.std),
                "source": prediction.source,
            }
            for prediction in inspection.predictions
        ],
        "warnings": list(inspection.warnings),
        "notes": list(inspection.notes),
    }


def inspection_json(inspection: Inspection, version: str) -> str:
    """Returns the text that `boresight inspect --json` prints."""
    document = inspection_document(inspection, version)
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def print_inspection(console: Console, inspection: Inspection) -> None:
    """Prints how much is seen, what is not and the mend, and how well the parameters will be known."""
    free, rank = len(inspection.free), inspection.rank
    colour = "bold green" if rank == free and not inspection.hardly else "bold yellow"
    console.print(Text.assemble((f"SEES {rank} of {free}", colour), "  ", (inspection.name, "bold")))
    console.print(_indented(_facts(inspection)))
    _print_directions(console, "Not seen", [(each.words, each.mend) for each in inspection.unseen])
    _print_directions(console, "Hardly seen", [(each.words, each.mend) for each in inspection.hardly])
    console.print(_predictions_table(inspection))
    for warning in inspection.warnings:
        console.print(f"[yellow]Warning:[/] {escape(warning)}")
    for note in (*inspection.notes, *left_out_in_words(inspection.left_out)):
        console.print(f"Note: {escape(note)}", highlight=False)


def _facts(inspection: Inspection) -> Table:
    of, indices = inspection, inspection.observability
    where = "drawn within the joints' limits" if of.drawn else "of the campaign"
    against = f" against {', '.join(of.targets)}" if of.targets else ""
    facts = Table.grid(padding=(0, 2))
    facts.add_column(style="bold", no_wrap=True)
    facts.add_row("configurations", f"{of.rows} {where}{escape(against)}; {in_millimetres(of.noise_std)} noise a value")
    facts.add_row("free, rank", f"{len(of.free)}, {of.rank}; condition number {of.condition:.3g}")
    facts.add_row("the whole arm", f"{of.arm_rank} of {of.everett} independent parameters (4R + 2P + 6) could be seen")
    facts.add_row(
        "observability",
        f"O1 {indices.o1:.3g}, O2 {indices.o2:.3g}, O3 {indices.o3:.3g}, O4 {indices.o4:.3g}, O5 {indices.o5:.3g}",
    )
    return facts


def _print_directions(console: Console, title: str, said: list[tuple[str, str]]) -> None:
    if not said:
        return
    console.print(Text(f"{title}:", style="bold"))
    for words, mend in said[:_FEW]:
        sentence = words[0].upper() + words[1:] if words.split()[0].isalpha() else words
        console.print(_indented(Text(f"{sentence}.")))
        console.print(_indented(_indented(Text.assemble(("mend: ", "green"), mend, "."))))
    if len(said) > _FEW:
        console.print(f"  and {len(said) - _FEW} more; --json has all of them")


def _predictions_table(inspection: Inspection) -> Table:
    """Returns the parameters that will be known worst, of those that the data tell anything about."""
    worst = sorted(inspection.predictions, key=_remaining, reverse=True)[:_FEW]
    table = Table(box=None, padding=(0, 2), pad_edge=True)
    table.add_column("least certain", style="bold")
    for column in ("before", "after (1 std)"):
        table.add_column(column, justify="right")
    table.add_column("value from")
    for prediction in worst:
        prior = "unknown" if prediction.prior_std is None else _amount(prediction.prior_std, prediction.unit)
        table.add_row(prediction.parameter, prior, _amount(prediction.std, prediction.unit), prediction.source)
    return table


def _remaining(prediction: Prediction) -> float:
    """Returns the share of what was not known that will still not be; of unknown numbers, of 20 mm or mrad."""
    return prediction.std / (prediction.prior_std or 0.02)


def _amount(value: float, unit: str) -> str:
    """Returns an amount [m, rad or 1] in mm, mrad or as it is, with three digits; an infinite one is not known."""
    if not math.isfinite(value):
        return "unknown"
    if unit == "1":
        return f"{value:.3g}"
    return f"{value * 1e3:.3g} {'mm' if unit == 'm' else 'mrad'}"


def _number(value: float) -> float | None:
    """Returns a number that JSON has: infinities and NaN have none."""
    return float(value) if math.isfinite(value) else None


def _indented(content: RenderableType) -> Padding:
    return Padding(content, (0, 0, 0, 2))
