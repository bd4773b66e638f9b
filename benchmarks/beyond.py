"""What gravity, harmonics and learned standard deviations buy, and what it costs to be wrong about them.

- *Real arm*: the shipped UR10 campaigns, and 60 of the rows drawn at random again and again. Errors are lengths of
  position errors on the campaign's validation rows, which no choice sees. `geometry` is the geometric fit as it was;
  in the other models standard deviations are learned. `set free` are harmonics with nothing that holds them.
- *Light arms*: MuJoCo's, with masses, centres of mass and springs of their own, from the tests.
- *False alarms*: an arm with neither, whose readings are worse than their stated noise, so that both are tried.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from boresight.calibration.frames import find_frames

from benchmarks.parallel import on_all_cores
from benchmarks.report import Figure, Report, Table, percent
from boresight.calibration import Campaign
from boresight.calibration.beyond import fitted_with, go_beyond
from boresight.calibration.campaign import TERMS, Term
from boresight.calibration.freedom import freedoms_of
from boresight.calibration.holdout import error_sizes
from boresight.calibration.problem import Problem
from boresight.calibration.robust import Fit, continued, fit
from boresight.files import load_campaign

ROOT = Path(__file__).parents[1]
UR10 = ROOT / "examples" / "ur10-laser-tracker"
MODELS: dict[str, tuple[Term, ...]] = {
    "learned": (),
    "gravity": ("gravity",),
    "harmonics": ("harmonics",),
    "both": TERMS,
}
UNMODELLED_M = 2.5e-4
"""Standard deviation of the errors that no model explains, in the study of false alarms [m]."""


@dataclass(frozen=True)
class Outcome:
    """What each model's held-out errors are.

    Attributes:
        errors: RMS and worst [m] by model; `chosen` is what `calibrate` does.
        chosen: the terms it adds.
    """

    errors: dict[str, tuple[float, float]]
    chosen: str


def judged(campaign: Campaign, models: bool = True) -> Outcome:
    """Returns the held-out errors of a campaign's models."""
    geometry = geometric_fit(campaign)
    chosen, beyond = go_beyond(geometry, TERMS, True, 0)
    fits = {"geometry": geometry}
    if models:
        fits |= {name: fitted_with(geometry, terms, True)[0] for name, terms in MODELS.items()}
        fits["set free"] = set_free(fits["harmonics"])
    fits["chosen"] = chosen
    added = "nothing to explain" if beyond is None else " and ".join(beyond.chosen) or "geometry alone"
    return Outcome({name: sizes(campaign, each) for name, each in fits.items()}, added)


def geometric_fit(campaign: Campaign) -> Fit:
    """Returns the fit that `calibrate` makes before it looks beyond geometry, by least squares."""
    nominal = find_frames(campaign.cell, campaign.readings, campaign.unknown, 0)
    nominal = nominal if campaign.gravity is None else nominal.under(campaign.gravity)
    freedoms = freedoms_of(replace(campaign, cell=nominal), nominal)
    return fit(Problem(nominal, campaign.readings, freedoms), np.zeros(len(freedoms)))


def set_free(held: Fit) -> Fit:
    """Returns the fit when nothing holds the parameters but what was believed."""
    freedoms = tuple(replace(freedom, learned_std=None) for freedom in held.problem.freedoms)
    return continued(replace(held.problem, freedoms=freedoms), held.x)


def sizes(campaign: Campaign, found: Fit) -> tuple[float, float]:
    """Returns RMS and worst held-out error [m]."""
    off = error_sizes(found.problem.fitted(found.x), campaign.validation)
    return float(np.sqrt(np.mean(off**2))), float(np.max(off))


def ur10(file: str, rows: int | None, seed: int | None = None) -> Outcome:
    """Returns the outcome of a shipped campaign, from its first rows, or as many drawn at random."""
    campaign = load_campaign(UR10 / file)
    count = len(campaign.readings)
    order = np.arange(count) if seed is None else np.random.default_rng(seed).permutation(count)
    return judged(replace(campaign, readings=campaign.readings.chosen(order[: rows or count])))


def light(arguments: dict) -> Outcome:
    """Returns the outcome of an arm in MuJoCo."""
    sys.path[:0] = [str(ROOT / "tests" / "oracles"), str(ROOT / "tests")]
    from light_arms import light_campaign

    return judged(light_campaign(**arguments), models=False)


def false_alarm(seed: int, rows: int) -> str:
    """Returns what is added for an arm with neither gravity nor harmonics."""
    sys.path[:0] = [str(ROOT / "tests" / "oracles"), str(ROOT / "tests")]
    from light_arms import light_campaign

    campaign = light_campaign("ur10", seed=seed, rows=rows, held=1, weight=0.0)
    worse = np.random.default_rng(seed).normal(0.0, UNMODELLED_M, campaign.readings.values.shape)
    readings = replace(campaign.readings, values=campaign.readings.values + worse)
    _, beyond = go_beyond(geometric_fit(replace(campaign, readings=readings)), TERMS, True, seed)
    return "nothing" if beyond is None or not beyond.chosen else " and ".join(beyond.chosen)


def run(quick: bool) -> Report:
    """Returns what each addition buys."""
    again, alarms = (2, 6) if quick else (8, 24)
    splits: dict[str, Callable[[], Outcome]] = {
        "random poses, 400 rows": partial(ur10, "campaign.yaml", None),
        "grid, 600 rows": partial(ur10, "grid.yaml", None),
        "random poses, first 60 rows": partial(ur10, "campaign.yaml", 60),
    }
    whole = dict(zip(splits, on_all_cores(_called, list(splits.values())), strict=True))
    drawn = {
        f"{name}, {again} times 60 rows": on_all_cores(partial(ur10, file, 60), range(again))
        for name, file in (("random poses", "campaign.yaml"), ("grid", "grid.yaml"))
    }
    arms = [
        {"name": name, "rows": rows, "weight": 0.2, "seed": 1}
        for name in ("iiwa14", "panda", "ur10", "puma560")
        for rows in (60, 200)
    ]
    arms += [
        {"name": "iiwa14", "rows": 100, "weight": 0.2, "ranger": True},
        {"name": "iiwa14", "rows": 200, "weight": 0.2, "waves": 1e-4},
    ]
    found = on_all_cores(light, arms)
    added = {rows: Counter(on_all_cores(partial(false_alarm, rows=rows), range(alarms))) for rows in (60, 200)}
    return Report(
        "beyond",
        "See the module's docstring. RMS / worst, mm.",
        _figures(whole, added, alarms),
        (
            Table(
                "Real arm", ("rows", *_names(whole), "added"), tuple(_row(name, [each]) for name, each in whole.items())
            ),
            Table(
                "Real arm, few rows", ("rows", *_names(whole), "added"), tuple(_row(*each) for each in drawn.items())
            ),
            Table(
                "Light arms in MuJoCo",
                ("arm", "geometry", "chosen", "added"),
                tuple(_row(_arm(each), [o]) for each, o in zip(arms, found, strict=True)),
            ),
            Table(
                f"False alarms, {alarms} campaigns each",
                ("rows", "nothing", "gravity", "harmonics", "both"),
                tuple(
                    (str(rows), *(str(count[k]) for k in ("nothing", "gravity", "harmonics", "gravity and harmonics")))
                    for rows, count in added.items()
                ),
            ),
        ),
    )


def _called(judge: Callable[[], Outcome]) -> Outcome:
    return judge()


def _names(whole: dict[str, Outcome]) -> tuple[str, ...]:
    return tuple(next(iter(whole.values())).errors)


def _arm(arguments: dict) -> str:
    kind = "ranger" if arguments.get("ranger") else "tracker"
    waves = ", harmonics of 0.1 mrad too" if arguments.get("waves") else ""
    return f"{arguments['name']}, {kind}, {arguments['rows']} rows{waves}"


def _row(name: str, outcomes: list[Outcome]) -> tuple[str, ...]:
    """Returns a line: mean RMS and worst row over outcomes by model, and what was added how often."""
    cells = []
    for model in outcomes[0].errors:
        errors = np.array([outcome.errors[model] for outcome in outcomes])
        cells.append(f"{1e3 * errors[:, 0].mean():.3f} / {1e3 * errors[:, 1].max():.2f}")
    added = Counter(outcome.chosen for outcome in outcomes)
    said = [f"{what} {count} times" if len(outcomes) > 1 else what for what, count in added.most_common()]
    return (name, *cells, ", ".join(said))


def _figures(whole: dict[str, Outcome], added: dict[int, Counter], alarms: int) -> tuple[Figure, ...]:
    limits = dict(zip(whole, (0.50, 0.44, 0.56), strict=True))
    figures = []
    for name, outcome in whole.items():
        size, worst = (1e3 * value for value in outcome.errors["chosen"])
        figures.append(Figure(f"UR10, {name}", f"{size:.3f} mm", f"<= {limits[name]:.2f} mm", size <= limits[name]))
        figures.append(Figure(f"UR10, {name}: worst row", f"{worst:.2f} mm", "<= 1.6 mm", worst <= 1.6))
    for rows, count in added.items():
        share = 1.0 - count["nothing"] / alarms
        figures.append(Figure(f"false alarms, {rows} rows", percent(share), "<= 5 %", share <= 0.05))
    return tuple(figures)
