"""The page of a result: one self-contained HTML file that an engineer reads in half a minute, then digs into."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from boresight.calibration.result import Estimate, Residuals, Result
from boresight.inference import PoseUncertainty
from boresight.inference.pose import COVERAGE
from boresight.report.charts import convergence_chart, correction_charts, errors_chart
from boresight.sensing import Pose
from boresight.units import in_millimetres

if TYPE_CHECKING:
    from jinja2 import Environment

MOST_LISTED = 50
"""Rows of a list that may be as long as the data; `residuals.csv` and `result.json` have them all."""

_NOTHING = "–"

_SIGNIFICANT = 2
"""Digits of the smallest standard deviation that are shown, and so how many decimals a table has."""


@dataclass(frozen=True, slots=True)
class Group:
    """The free parameters that share a unit, and how many decimals their values deserve.

    Attributes:
        unit: m, rad or 1.
        estimates: the parameters.
        std: their smallest standard deviation.
    """

    unit: str
    estimates: tuple[Estimate, ...]
    std: float

    @property
    def has_unknown(self) -> bool:
        """Whether the files left a value open."""
        return any(estimate.nominal is None for estimate in self.estimates)

    def text(self, value: float | None, factor: float = 1.0) -> str:
        """Returns a value times a factor, to the decimals that the smallest standard deviation has there."""
        decimals = 6
        if self.std > 0.0 and math.isfinite(self.std):
            decimals = _SIGNIFICANT - 1 - math.floor(math.log10(self.std * factor))
        return number(value, factor, min(max(decimals, 1), 9))


def render_page(result: Result, version: str) -> str:
    """Returns a result as an HTML page without scripts or anything from elsewhere, every name in it escaped.

    Args:
        result: what a calibration found.
        version: of the software, for the page's foot.
    """
    channels = result.cell.channels
    return (
        _environment()
        .get_template("page.html.jinja")
        .render(
            result=result,
            version=version,
            errors=errors_chart(result),
            convergence=convergence_chart(result.solution.history),
            corrections=correction_charts(result.estimates),
            groups=tuple(groups(result.estimates)),
            held=tuple(e for e in result.estimates if e.source == "prior" and e.name not in result.priors),
            gauge=tuple(estimate for estimate in result.estimates if estimate.source == "gauge"),
            fixed=tuple(estimate for estimate in result.estimates if estimate.source == "fixed"),
            poses=(
                pose("these rows, absolute", result.at_rows),
                pose("work space, absolute", result.accuracy.absolute.pose),
                pose("work space, relative", result.accuracy.relative.pose),
            ),
            channels=channels,
            noise=result.readings.usual_row_std,
            error_words=error_words(result),
            evolved=bool(len(result.solution.history)),
            most=MOST_LISTED,
        )
    )


def error_words(result: Result) -> str:
    """Returns what an error of a row is, as sentences."""
    sensors = result.cell.sensors
    levers = [
        f"{millimetres(sensor.lever)}{f' ({name})' if len(sensors) > 1 else ''}"
        for name, sensor in sensors.items()
        if isinstance(sensor, Pose)
    ]
    turned = f" An orientation counts as the arc on a lever of {' or '.join(levers)}." if levers else ""
    if result.cell.channels == 1:
        return "An error is predicted minus measured."
    words = "An error is the length of the difference between predicted and measured position"
    return (
        f"{words}, or of a single value predicted minus measured.{turned}" if len(sensors) > 1 else f"{words}.{turned}"
    )


def amount(value: float, unit: str) -> str:
    """Returns a length [m] in mm or an angle [rad] in mrad, with three digits that matter."""
    return millimetres(value) if unit == "m" else millimetres(value).replace("mm", "mrad")


@dataclass(frozen=True, slots=True)
class PoseFigures:
    """Uncertainty of the tool's pose over some configurations, as the page shows it.

    Attributes:
        where: which configurations.
        count: how many.
        standard, expanded: of the position [m], root mean square over them, k = 1 and k = 2.
        median, worst: radius [m] that holds the true position with 95 % probability.
        turn_median, turn_worst: the same of the orientation [rad].
    """

    where: str
    count: int
    standard: float
    expanded: float
    median: float
    worst: float
    turn_median: float
    turn_worst: float


def pose(where: str, found: PoseUncertainty) -> PoseFigures:
    """Returns the figures of some configurations."""
    standard = float(np.sqrt(np.mean(found.position_std**2)))
    radius, angle = found.position_95, found.orientation_95
    return PoseFigures(
        where,
        len(found.joints),
        standard,
        COVERAGE * standard,
        float(np.median(radius)),
        float(np.max(radius)),
        float(np.median(angle)),
        float(np.max(angle)),
    )


def groups(estimates: Sequence[Estimate]) -> Iterable[Group]:
    """Returns the estimates that are not fixed by unit: angles, lengths, numbers."""
    for unit in ("rad", "m", "1"):
        free = tuple(estimate for estimate in estimates if estimate.unit == unit and estimate.source != "fixed")
        if free:
            known = [estimate.std for estimate in free if estimate.std > 0.0 and math.isfinite(estimate.std)]
            yield Group(unit, free, min(known, default=0.0))


def number(value: float | None, factor: float = 1.0, decimals: int = 3) -> str:
    """Returns a value times a factor with a real minus sign, and a dash where there is none."""
    if value is None or not math.isfinite(value):
        return _NOTHING
    text = f"{value * factor:,.{decimals}f}"
    return text.replace("-", "−") if text.strip("-0.,") else text.lstrip("-")


def millimetres(value_m: float) -> str:
    """Returns a length [m] in mm with three digits that matter, and a dash where there is none."""
    return in_millimetres(value_m).replace("-", "−") if math.isfinite(value_m) else _NOTHING


def change(residuals: Residuals) -> str:
    """Returns by how much the RMS changed, in words; empty where it cannot be said."""
    before, after = residuals.before.rms, residuals.after.rms
    if not (math.isfinite(before) and math.isfinite(after) and before > 0.0 and after > 0.0):
        return ""
    smaller = before / after
    if 0.99 < smaller < 1.01:
        return "unchanged"
    return f"{_times(smaller)}× smaller" if smaller > 1.0 else f"{_times(1.0 / smaller)}× larger"


def duration(seconds: float) -> str:
    """Returns a time in the unit that a person would say it in."""
    if not math.isfinite(seconds):
        return _NOTHING
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:,.1f} s"


def cost(value: float) -> str:
    """Returns a cost with five digits that matter."""
    return f"{value:,.0f}" if 1e4 <= value < 1e12 else f"{value:.5g}"


def _times(ratio: float) -> str:
    return f"{ratio:.2f}" if ratio < 2.0 else f"{ratio:.1f}" if ratio < 10.0 else f"{ratio:,.0f}"


def page_environment(*packages: str) -> Environment:
    """Returns what fills the templates of packages, the first that has one; all that is inserted is escaped."""
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined  # only a report needs it

    return Environment(
        loader=ChoiceLoader([PackageLoader(package) for package in packages]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _environment() -> Environment:
    environment = page_environment("boresight.report")
    environment.filters |= {
        "length": millimetres,
        "amount": amount,
        "length_of": len,
        "change": change,
        "duration": duration,
        "degrees": partial(number, factor=180.0 / math.pi, decimals=4),
        "number": number,
        "count": "{:,}".format,
        "cost": cost,
    }
    return environment
