"""`boresight calibrate`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from boresight import __version__
from boresight.calibration import Campaign, Solver, calibrate
from boresight.calibration.solve import EVOLUTION
from boresight.cli.codes import LARGEST_SEED, REJECTED
from boresight.cli.compiling import told_of_compiling
from boresight.cli.consoles import PipedConsole, print_json
from boresight.cli.devices import chosen_device
from boresight.cli.doing import Doing
from boresight.errors import InputError
from boresight.files import load_campaign
from boresight.kernels.evolving import evolve_generations
from boresight.kernels.linearising import linearise_rows
from boresight.report.folder import RESULT_FILE, check_writable, write_result
from boresight.report.summary import print_summary
from boresight.search import STRATEGIES, DifferentialEvolution, Stops
from boresight.search.devices import DeviceName, Precision
from boresight.sensing.linear import is_compiled

MOST_MEMBERS, MOST_GENERATIONS = 1_000_000, 1_000_000_000
"""Beyond these memory or patience would end first."""


def run_calibrate(
    path: Path,
    output: Path | None,
    *,
    solver: str,
    strategy: str,
    population: int | None,
    generations: int,
    device: DeviceName,
    precision: Precision,
    seed: int,
    as_json: bool,
) -> int:
    """Returns the exit code of a calibration, its result written and shown."""
    settings = _solver(solver, strategy, population, generations, seed)
    settings = replace(settings, device=chosen_device(device, precision, evolves=solver != "least-squares"))
    with Doing(silent=as_json) as doing:
        doing.begin(f"reading {path.name}")
        campaign = load_campaign(path, need_readings=True)
        folder = output or Path(f"{campaign.name}-result")
        check_writable(folder)
        _tell_of_compiling(settings, campaign)
        values = campaign.readings.count if campaign.readings else 1

        def step(what: str) -> None:
            doing.begin(what, total=generations if what == EVOLUTION else None)

        def show(generation: int, cost: float) -> None:
            best = f"{1e3 * (cost / values) ** 0.5:.3f} mm RMS"
            doing.advance(generation, f"{generation}/{generations} generations, best {best}")

        result = calibrate(campaign, settings, show, step)
        doing.begin(f"writing {folder.name}")
        written = write_result(result, folder, __version__)
    if as_json:
        print_json((written / RESULT_FILE).read_text(encoding="utf-8"))
    else:
        print_summary(PipedConsole(), result, written)
    return 0 if result.verdict.accepted else REJECTED


def _tell_of_compiling(settings: Solver, campaign: Campaign) -> None:
    """Tells the user where something has to be compiled first."""
    needed = [linearise_rows] if is_compiled(campaign.cell) else []
    if campaign.unknown:  # unknown frames are sought on this processor, in double precision
        needed.append(evolve_generations)
    told_of_compiling(*needed, evolves=None if settings.name == "least-squares" else settings.device)


def _solver(solver: str, strategy: str, population: int | None, generations: int, seed: int) -> Solver:
    problems = []
    if population is not None and not 5 <= population <= MOST_MEMBERS:
        problems.append(f"--population: expected 5 to {MOST_MEMBERS} members, got {population}; the paper uses 150")
    if not 1 <= generations <= MOST_GENERATIONS:
        problems.append(f"--generations: expected 1 to {MOST_GENERATIONS}, got {generations}; the paper uses 500")
    if not 0 <= seed <= LARGEST_SEED:
        problems.append(f"--seed: expected a whole number from 0 to {LARGEST_SEED}, got {seed}")
    if problems:
        raise InputError(problems)
    evolution = DifferentialEvolution(STRATEGIES[strategy], population or STRATEGIES[strategy].population)
    return Solver(solver, evolution, Stops(generations), seed)  # type: ignore[arg-type]
