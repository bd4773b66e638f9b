"""`boresight study`."""

from __future__ import annotations

import re
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from boresight import __version__
from boresight.cli.codes import INTERRUPTED
from boresight.cli.compiling import told_of_compiling
from boresight.cli.consoles import PipedConsole, print_plain
from boresight.cli.devices import chosen_device
from boresight.errors import InputError, OutputError
from boresight.files import load_study
from boresight.files.study_schemas import MOST_SEEDS
from boresight.kernels.linearising import linearise_rows
from boresight.report.study import print_study, study_json, write_study
from boresight.search.devices import DeviceName, Precision
from boresight.studies import Store, Study, run, study, summarise
from boresight.studies.study import Shard

RESULTS = "runs.sqlite"
"""The file of outcomes in a study's folder."""

MOST_WORKERS = 1024

_WINDOW_S = 60.0
"""Time left is told from what was done in the last minute."""


def run_study(
    path: Path,
    output: Path | None,
    *,
    workers: int | None,
    scheduler: str | None,
    shard: str | None,
    device: DeviceName,
    precision: Precision,
    seeds: int | None,
    merge: list[Path],
    summary: bool,
    as_json: bool,
) -> int:
    """Returns the exit code of a study, what was missing made and the summary written and shown."""
    part = _checked(workers, scheduler, shard, seeds, merge, summary)
    asked = load_study(path, seeds=seeds)
    asked = asked.on(chosen_device(device, precision, evolves=any(point.evolves for point in asked.points)))
    folder = output or Path(f"{asked.name}-study")
    file = folder / RESULTS
    if not summary:
        _make_folder(folder)
    errors = PipedConsole(stderr=True)
    for other in merge:
        with Store.open(file) as store:
            added = store.absorb(other / RESULTS if other.is_dir() else other)
        errors.print(f"{other}: {added:,} runs that were not here", highlight=False, markup=False, soft_wrap=True)
    if summary:
        with Store.open(file, create=False) as store:
            found = summarise(asked, store)
    else:
        interrupted, found = _run(asked, file, workers, scheduler, part, errors, quiet=as_json)
        if interrupted:
            return INTERRUPTED
    assert found is not None
    write_study(found, folder, __version__)
    if as_json:
        print_plain(study_json(found, __version__))
    else:
        print_study(PipedConsole(), found, folder)
    return 0


def _run(asked: Study, file: Path, workers, scheduler, part: Shard, errors: Console, *, quiet: bool):
    """Returns whether the study was interrupted, and its summary if not."""
    on_card = any(point.on_card for point in asked.points)
    evolving = next((point for point in asked.points if point.evolves), None)
    evolves = evolving.settings.device if evolving else None
    if scheduler is None and not on_card and told_of_compiling(linearise_rows, evolves=evolves):
        run(evolving or asked.points[0], 0)  # here, so that the workers find it on disk and need not each do it
    with _progress(asked.name, errors, hidden=quiet) as show, _one_interrupt():
        try:
            return False, study(asked, file, workers=workers, scheduler=scheduler, shard=part, on_progress=show)
        except KeyboardInterrupt:
            pass
    with Store.open(file, create=False) as store:
        done = store.count(asked.points, asked.seeds)
    errors.print(
        f"Interrupted; {done:,} of {len(asked):,} runs are kept in {file}. The same command goes on from there.",
        highlight=False,
        markup=False,
        soft_wrap=True,
    )
    return True, None


@contextmanager
def _progress(name: str, console: Console, *, hidden: bool) -> Iterator:
    """Yields what shows progress: a bar where someone watches, nothing else."""
    with Progress(
        TextColumn(name, markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("runs, {task.fields[rate]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=hidden or not console.is_terminal,
        speed_estimate_period=_WINDOW_S,
    ) as progress:
        task = None

        def show(done: int, asked: int) -> None:
            nonlocal task
            if task is None:
                task = progress.add_task(name, total=asked, completed=done, rate="starting workers")
                return
            speed = progress.tasks[0].speed
            progress.update(task, completed=done, rate=f"{speed:.1f} a second" if speed else "")

        yield show


@contextmanager
def _one_interrupt() -> Iterator[None]:
    """Lets a second Ctrl-C not disturb what the first one set off: workers need a moment to end."""
    before = signal.getsignal(signal.SIGINT)

    def first(number, frame):
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, first)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: no folder can be made there: {error.strerror}") from None


def _checked(
    workers: int | None, scheduler: str | None, shard: str | None, seeds: int | None, merge: list[Path], summary: bool
) -> Shard:
    """Returns the shard that is asked for, once all options make sense."""
    problems = []
    if workers is not None and not 1 <= workers <= MOST_WORKERS:
        problems.append(f"--workers: expected 1 to {MOST_WORKERS} processes, got {workers}")
    if workers is not None and scheduler is not None:
        problems.append("--workers counts processes of this machine and --scheduler has its own; expected one of them")
    if seeds is not None and not 1 <= seeds <= MOST_SEEDS:
        problems.append(f"--seeds: expected 1 to {MOST_SEEDS}, got {seeds}")
    if summary and (shard or workers or scheduler or merge):
        problems.append("--summary runs nothing; expected it without --workers, --scheduler, --shard and --merge")
    match = re.fullmatch(r"([0-9]{1,6})/([0-9]{1,6})", shard or "1/1")
    number, count = (int(match[1]), int(match[2])) if match else (0, 0)
    if not 1 <= number <= count:
        problems.append(f"--shard: expected i/n such as 2/4, the second of four parts, got {shard}")
    if problems:
        raise InputError(problems)
    return Shard(number, count)
