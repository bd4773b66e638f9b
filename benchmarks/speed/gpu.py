"""Case-1 identifications a second on an NVIDIA card, in single and in double precision.

Campaigns are drawn once (35 readings, 25 parameters, squared range errors) and searched again and again under seeds
of their own, 150 members through 500 generations. Three times are told: *whole*, from the tasks to the found
evolutions on the host; *card*, the kernel alone, its arrays on the card before and after; *host*, arrays put together
before any transfer. Compiling is the first launch less the second. The processor's median for one identification on
one core stands beside.

Then the card's answers: of the same seeds, median and 95th percentile of the final RMS on card and processor, and how
long a search in double precision takes the processor's path: the generation at which the histories of best costs part
by more than 1e-9 of their value. Rounding parts them, for the card multiplies and adds in one operation.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.report import Report, Table
from benchmarks.speed.cases import CASES, GENERATIONS, MEMBERS, believed, plain, rms_mm
from benchmarks.speed.gpu_claims import figures
from benchmarks.speed.gpu_refining import refining
from benchmarks.speed.lines import duration
from benchmarks.speed.timing import say
from boresight.errors import BoresightError
from boresight.kernels.cuda.batches import Task
from boresight.search import Device, DifferentialEvolution, Evolved, Stops, evolve
from boresight.search.devices import Precision
from boresight.sensing.on_card import evolve_on_card, task_of

SAME = 1e-9
"""Relative difference of best costs beyond which two searches have parted."""


@dataclass(frozen=True)
class Size:
    """How much is run."""

    runs: int
    campaigns: int
    compared: int
    rounds: int
    members: int = MEMBERS
    generations: int = GENERATIONS
    readings: int = CASES[1]

    @property
    def settings(self) -> DifferentialEvolution:
        """The search."""
        return DifferentialEvolution(population=self.members)

    @property
    def stops(self) -> Stops:
        """Its end: no early one."""
        return Stops(self.generations, cost=0.0, patience=10**9)


FULL, QUICK = Size(10_000, 50, 200, 5), Size(1_000, 10, 20, 2)
SIMULATED = Size(3, 2, 2, 1, members=8, generations=2, readings=4)
"""Thread by thread in Python, a search takes seconds."""


@dataclass(frozen=True)
class Launched:
    """What a card did in one precision.

    Attributes:
        precision: single or double.
        runs: identifications of a launch.
        compile: time that compiling took [s].
        whole: (rounds,) time from tasks to evolutions on the host [s].
        card: (rounds,) time of the kernel alone [s].
        host: (rounds,) time of putting arrays together [s].
        rms: (compared,) final RMS [mm] on the card.
        parted: (compared,) generation at which a search left the processor's path; the last one if it never did.
        same: share that never did.
    """

    precision: Precision
    runs: int
    compile: float
    whole: np.ndarray
    card: np.ndarray
    host: np.ndarray
    rms: np.ndarray
    parted: np.ndarray
    same: float

    def rate(self, seconds: np.ndarray) -> float:
        """Identifications a second, median of rounds."""
        return self.runs / float(np.median(seconds))

    def as_values(self) -> dict[str, Any]:
        """Returns it as plain values."""
        return {name: np.asarray(value).tolist() for name, value in vars(self).items()}


def run(quick: bool) -> Report:
    """Returns throughput and answers of the card.

    Raises:
        BoresightError: there is no card, or what it needs is not installed.
    """
    from boresight.kernels.cuda.devices import require_card

    try:
        card = require_card()
    except BoresightError as error:
        raise BoresightError(f"--gpu measures a card, and nothing was measured: {error}") from None
    size = SIMULATED if card == "simulated card" else QUICK if quick else FULL
    tasks = [_task(size, run) for run in range(size.runs)]
    here, seconds = _on_processor(size)
    found = [_launched(size, tasks, precision, here) for precision in ("single", "double")]
    tables, claims = (_throughput(found, seconds),), ()
    if card != "simulated card":  # where a block's many barriers would take minutes
        problems = [believed(size.readings, campaign) for campaign in range(size.campaigns)]
        table, refined = refining(problems, size.runs, size.rounds)
        tables, claims = (*tables, table), (refined,)
    notes = (
        "A simulated card: it shows that this runs, and its times mean nothing."
        if card == "simulated card"
        else f"Processor, one core: {duration(seconds)} an identification, median of {size.compared}."
    )
    rms = np.array([_rms(size, run, evolved) for run, evolved in enumerate(here)])
    return Report(
        "speed-gpu",
        f"{card}. {size.runs:,} identifications a launch on {size.campaigns} campaigns, {size.members} members, "
        f"{size.generations} generations, {size.readings} readings. See the docstring of benchmarks/speed/gpu.py.",
        () if card == "simulated card" else (*figures(found, rms), *claims),
        (*tables, _answers(found, rms)),
        (notes,),
        {"card": card, "launched": [each.as_values() for each in found], "processor_rms_mm": rms.tolist()},
    )


def _problem(size: Size, run: int):
    return plain(size.readings, run % size.campaigns)


def _task(size: Size, run: int) -> Task:
    problem = _problem(size, run)
    return task_of(problem.cost, problem.box, size.settings, run)


def _rms(size: Size, run: int, evolved: Evolved) -> float:
    return rms_mm(evolved.cost, _problem(size, run))


def _on_processor(size: Size) -> tuple[list[Evolved], float]:
    """Returns the first runs as the processor makes them, and the median time of one [s]."""
    say(f"gpu: {size.compared} identifications on the processor, to compare with")
    found = []
    for run in range(size.compared):
        problem = _problem(size, run)
        problem.cost.load(size.settings, problem.box)
        found.append(evolve(problem.cost, problem.box, size.settings, size.stops, seed=run))
    return found, float(np.median([each.seconds for each in found]))


def _launched(size: Size, tasks: list[Task], precision: Precision, here: list[Evolved]) -> Launched:
    from benchmarks.speed.gpu_launch import card_seconds, host_seconds

    device = Device("cuda", precision)
    say(f"gpu: {precision} precision, compiling")
    began = time.perf_counter()
    evolve_on_card(tasks[:1], device, size.stops)
    first = time.perf_counter() - began
    began = time.perf_counter()
    evolve_on_card(tasks[:1], device, size.stops)
    later = time.perf_counter() - began
    there = evolve_on_card(tasks[: size.compared], device, size.stops)
    whole, card, host = [], [], []
    for round_ in range(size.rounds):
        say(f"gpu: {precision} precision, round {round_ + 1} of {size.rounds}, {size.runs:,} identifications")
        began = time.perf_counter()
        evolve_on_card(tasks, device, size.stops)
        whole.append(time.perf_counter() - began)
        host.append(host_seconds(tasks, device.real))
        card.append(card_seconds(tasks, device.real, size.generations))
    parted = np.array([parting(a.history, b.history) for a, b in zip(there, here, strict=True)])
    return Launched(
        precision=precision,
        runs=size.runs,
        compile=max(first - later, 0.0),
        whole=np.array(whole),
        card=np.array(card),
        host=np.array(host),
        rms=np.array([_rms(size, run, evolved) for run, evolved in enumerate(there)]),
        parted=parted,
        same=float(np.mean(parted > size.generations)),
    )


def parting(there: np.ndarray, here: np.ndarray) -> int:
    """Returns the first generation whose best costs differ by more than `SAME`, or one beyond the last."""
    assert there.shape == here.shape
    apart = np.abs(there[:, 0] - here[:, 0]) > SAME * np.abs(here[:, 0])
    return int(np.argmax(apart)) if apart.any() else len(here)


def _throughput(found: list[Launched], seconds: float) -> Table:
    header = (
        "precision", "a second, whole", "a second, card alone", "host assembly", "whole launch", "compiling",
        "times one core",
    )  # fmt: skip
    rows = tuple(
        (
            each.precision, f"{each.rate(each.whole):,.0f}", f"{each.rate(each.card):,.0f}",
            duration(float(np.median(each.host))), duration(float(np.median(each.whole))), duration(each.compile),
            f"{each.rate(each.whole) * seconds:.3g}",
        )
        for each in found
    )  # fmt: skip
    return Table("Identifications on the card, medians", header, rows)


def _answers(found: list[Launched], rms: np.ndarray) -> Table:
    header = (
        "where", "RMS, median, mm", "RMS, 95 %, mm", "parts from the processor, median generation", "earliest",
        "never parts",
    )  # fmt: skip
    rows = [("processor", f"{np.median(rms):.5f}", f"{np.quantile(rms, 0.95):.5f}", "", "", "")]
    rows += [
        (
            f"card, {each.precision}", f"{np.median(each.rms):.5f}", f"{np.quantile(each.rms, 0.95):.5f}",
            f"{np.median(each.parted):.0f}", f"{each.parted.min()}", f"{100 * each.same:.0f} %",
        )
        for each in found
    ]  # fmt: skip
    return Table(f"Answers of the same {len(rms)} seeds", header, tuple(rows))
