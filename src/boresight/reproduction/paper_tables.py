"""Tables 1 to 5 in the paper's own arrangement."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from boresight.reproduction import setting
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.spread import Spread, plain
from boresight.reproduction.tables import Cell, Column, Table
from boresight.reproduction.trials import Run
from boresight.reproduction.variants import NOMINAL, Variant

_SIGN = {"theta": "θ", "alpha": "α", "beta": "β"}


def paper_tables(found: Measurements) -> tuple[Table, ...]:
    """Returns tables 1 to 5."""
    return (
        nominal_table(),
        preset_table(),
        *(identified_table(found, case) for case in setting.CASES),
        pose_table(found),
    )


def nominal_table() -> Table:
    """Returns table 1: the nominal arm."""
    rows = tuple(
        (joint.name, math.degrees(joint.theta), 1e3 * joint.d, 1e3 * joint.a, math.degrees(joint.alpha), 0.0)
        for joint in setting.ARM.joints
    )
    return Table(
        "table-1",
        "Table 1. Nominal geometric parameters",
        (
            Column("joint", "joint"),
            Column("θ, °", "theta_deg", decimals=0),
            Column("d, mm", "d_mm", decimals=0),
            Column("a, mm", "a_mm", decimals=0),
            Column("α, °", "alpha_deg", decimals=0),
            Column("β, °", "beta_deg", decimals=0),
        ),
        rows,
        "The paper's is an image and lost; this is the project's PUMA-like arm. Plane (23), normalised: n = (0, "
        f"{setting.DECK.normal[1]:.5f}, {setting.DECK.normal[2]:.5f}), f = {plain(1e3 * setting.DECK.offset, 5)} mm, "
        "with the signs of eq. (7).",
    )


def preset_table() -> Table:
    """Returns table 2: the errors that were put in."""
    rows = tuple((_symbol(name), _thousandths(error), _unit(name)) for name, error in setting.PRESET.items())
    return Table(
        "table-2",
        "Table 2. Preset errors (real minus nominal)",
        (Column("parameter", "parameter"), Column("preset error", "preset", decimals=1), Column("unit", "unit")),
        rows,
        "The paper's is lost but for n_x and n_z (section 4.3). Link errors were drawn once for this project and "
        "rounded. θ1 defines azimuth and has none, except where it is free as a 26th parameter: "
        f"{1e3 * setting.PRESET_AZIMUTH:.1f} mrad.",
    )


def identified_table(found: Measurements, case: int) -> Table:
    """Returns table 3 or 4: the identified errors of case 1 or 2, beside the preset ones."""
    variant = Variant("trade-off", setting.CASES[case])
    typical = found.typical.runs[variant]
    runs = found.runs(variant.method, variant.rows)
    place = {name: i for i, name in enumerate(typical.names)}
    rows: list[tuple[Cell, ...]] = []
    for name in setting.PRESET:
        spread = Spread.of([_thousandths(run.x[place[name]]) for run in runs])
        preset, identified = (_thousandths(values[place[name]]) for values in (typical.real, typical.x))
        rows.append((_symbol(name), preset, identified, spread, _unit(name)))
    return Table(
        f"table-{2 + case}",
        f"Table {2 + case}. Identified errors, case {case} ({variant.rows} configurations, trade-off)",
        (
            Column("parameter", "parameter"),
            Column("preset", "preset", decimals=1),
            Column(f"identified, seed {found.typical.seed}", "identified", decimals=2),
            Column("identified, all seeds", "identified_all", decimals=2),
            Column("unit", "unit"),
        ),
        tuple(rows),
        "All seeds: median, and the range of nine seeds in ten.",
    )


def pose_table(found: Measurements) -> Table:
    """Returns table 5: pose errors in the validation configurations."""
    columns = [("nominal", found.runs(NOMINAL, setting.CASES[1]))]
    columns += [(f"case {case}", found.runs("trade-off", count)) for case, count in setting.CASES.items()]
    rows: list[tuple[Cell, ...]] = [
        (words, *(Spread.of([number(run) for run in runs]) for _, runs in columns)) for words, number in _STATISTICS
    ]
    return Table(
        "table-5",
        "Table 5. Pose errors in the validation configurations",
        (Column("error", "error"), *(Column(name, name.replace(" ", "_")) for name, _ in columns)),
        tuple(rows),
        f"Each statistic over the {setting.VALIDATION_ROWS} validation configurations of a seed; then median, and the "
        "range of nine seeds in ten.",
    )


_STATISTICS: tuple[tuple[str, Callable[[Run], float]], ...] = (
    ("position, mean, mm", lambda run: float(np.mean(run.validation.position_mm))),
    ("position, RMS, mm", lambda run: run.validation.position_rms_mm),
    ("position, max, mm", lambda run: float(np.max(run.validation.position_mm))),
    ("orientation, mean, mrad", lambda run: float(np.mean(run.validation.orientation_mrad))),
    ("orientation, RMS, mrad", lambda run: run.validation.orientation_rms_mrad),
    ("orientation, max, mrad", lambda run: float(np.max(run.validation.orientation_mrad))),
)


def _symbol(name: str) -> str:
    owner, number = name.split(".")
    if owner == "deck":
        return f"Δn_{number[-1]}"
    return f"Δ{_SIGN.get(number, number)}{owner[1:]}"


def _unit(name: str) -> str:
    if name.startswith("deck"):
        return "10⁻³"
    return "mm" if name.split(".")[1] in ("d", "a") else "mrad"


def _thousandths(value: float) -> float:
    """Returns a correction in mrad, mm or thousandths."""
    return 1e3 * float(value)


def numbers_of(run: Run) -> dict[str, float]:
    """Returns the scalars of a run, as `runs.csv` has them."""
    return {
        "cost_mm2": run.cost_mm2,
        "optimum_mm2": run.optimum_mm2,
        "range_rms_mm": run.range_rms_mm,
        "range_max_mm": run.range_max_mm,
        "calibration_position_rms_mm": run.calibration.position_rms_mm,
        "calibration_orientation_rms_mrad": run.calibration.orientation_rms_mrad,
        "validation_position_rms_mm": run.validation.position_rms_mm,
        "validation_orientation_rms_mrad": run.validation.orientation_rms_mrad,
        "turned_position_rms_mm": run.validation_turned.position_rms_mm,
        "turned_orientation_rms_mrad": run.validation_turned.orientation_rms_mrad,
        "evaluations": run.evaluations,
    }
