"""What is claimed, beside what was measured. Medians, unless the machine only has to be able to."""

from __future__ import annotations

from collections.abc import Callable

from benchmarks.report import Figure
from benchmarks.speed import identification, monte_carlo, start_up
from benchmarks.speed.end_to_end import EndToEnd
from benchmarks.speed.lines import Line, duration
from benchmarks.speed.roofline import Roof

MOST_BYTES = 2_000_000_000


def figures(lines: list[Line], roofs: list[Roof], ended: list[EndToEnd]) -> tuple[Figure, ...]:
    """Returns every claim whose measurement is there."""
    found = [
        _time(lines, identification.workload(1), "Boresight, trade-off", "case 1, one core", 0.020),
        _ratio(lines, "SciPy DE, vectorised, NumPy cost", 100.0),
        _ratio(lines, "SciPy DE, scalar, compiled cost", 100.0),
        _ratio(lines, "pygmo de, compiled cost", 10.0),
        *(_roof(roof) for roof in roofs if (roof.readings, roof.precision) == (1_000, "double")),
        _cores(lines),
        _time(lines, "process", start_up.HELP, "--help", 0.3),
        _time(lines, "process", start_up.WARM, f"{start_up.WARM}, warm", 2.0),
        _time(lines, "process", start_up.COLD, start_up.COLD, 15.0),
        _time(lines, "least squares, 100 readings", "Boresight, refine", "least squares, 100 readings", 0.010),
        *_memory(ended),
    ]
    return tuple(figure for figure in found if figure is not None)


def _of(lines: list[Line], workload: str, who: str) -> Line | None:
    return next((line for line in lines if (line.workload, line.who) == (workload, who)), None)


def _if(line: Line | None, claim: Callable[[Line], Figure]) -> Figure | None:
    return None if line is None else claim(line)


def _time(lines: list[Line], workload: str, who: str, name: str, most: float) -> Figure | None:
    return _if(
        _of(lines, workload, who),
        lambda line: Figure(name, duration(line.median), f"<= {duration(most)}", line.median <= most),
    )


def _ratio(lines: list[Line], who: str, least: float) -> Figure | None:
    """Returns how many times faster case 1 is than a peer's."""
    line = _of(lines, identification.workload(1), who)
    if line is None or line.ratio is None:
        return None
    return Figure(f"case 1, times faster than {who}", f"{line.ratio:.3g}", f">= {least:g}", line.ratio >= least)


def _roof(roof: Roof) -> Figure:
    name = f"share of the measured peak, {roof.readings:,} configurations"
    return Figure(name, f"{100 * roof.fraction:.0f} %", ">= 50 %", roof.fraction >= 0.5)


def _cores(lines: list[Line]) -> Figure | None:
    of_study = [line for line in lines if line.workload == monte_carlo.TITLE]
    if len(of_study) != 2:
        return None
    gain = monte_carlo.gain(of_study)
    return Figure("Monte Carlo, two cores over one", f"{gain:.2f}", ">= 1.9", gain >= 1.9)


def _memory(ended: list[EndToEnd]) -> list[Figure]:
    return [
        Figure(
            f"{each.readings:,} readings in {each.kind}, memory",
            f"{each.peak / 1e9:.2f} GB",
            f"<= {MOST_BYTES / 1e9:g} GB",
            each.peak <= MOST_BYTES,
        )
        for each in ended
        if each.readings >= 1_000_000
    ]
