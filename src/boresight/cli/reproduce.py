"""`boresight reproduce`."""

from __future__ import annotations

from pathlib import Path

from rich.markup import escape
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table

from boresight import __version__
from boresight.cli.codes import LARGEST_SEED
from boresight.cli.compiling import told_of_compiling
from boresight.cli.consoles import PipedConsole
from boresight.errors import InputError
from boresight.kernels.linearising import linearise_rows
from boresight.reproduction import Document, compose, reproduce, write_reproduction
from boresight.reproduction.folder import check_writable
from boresight.reproduction.reproduce import QUICK_SEEDS, SEEDS
from boresight.reproduction.verdicts import Verdict
from boresight.search import CPU

MOST_SEEDS, MOST_WORKERS = 100_000, 1024

_COLOURS = {Verdict.HOLDS: "green", Verdict.PARTLY: "yellow", Verdict.FAILS: "red"}


def run_reproduce(output: Path, *, quick: bool, seeds: int | None, seed: int, workers: int | None) -> int:
    """Returns the exit code of a reproduction, its page written and its statements shown."""
    _check(seeds, seed, workers)
    check_writable(output)
    count = seeds or (QUICK_SEEDS if quick else SEEDS)
    errors = PipedConsole(stderr=True)
    told_of_compiling(linearise_rows, evolves=CPU)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("seeds"))
    with Progress(
        *columns,
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=errors,
        transient=True,
        disable=not errors.is_terminal,
    ) as progress:
        task = progress.add_task("Identifying", total=count)
        found = reproduce(
            count, seed=seed, workers=workers, on_progress=lambda done: progress.update(task, completed=done)
        )
        progress.update(task, description="Drawing figures")
        page = compose(found, _command(quick, seeds, seed))
        written = write_reproduction(page, output, __version__)
    _show(PipedConsole(), page, written)
    return 0


def _check(seeds: int | None, seed: int, workers: int | None) -> None:
    problems = [
        f"{option}: expected {expected}, got {given}"
        for option, given, expected, wrong in (
            ("--seeds", seeds, f"1 to {MOST_SEEDS}", seeds is not None and not 1 <= seeds <= MOST_SEEDS),
            ("--seed", seed, f"a whole number from 0 to {LARGEST_SEED}", not 0 <= seed <= LARGEST_SEED - MOST_SEEDS),
            ("--workers", workers, f"1 to {MOST_WORKERS}", workers is not None and not 1 <= workers <= MOST_WORKERS),
        )
        if wrong
    ]
    if problems:
        raise InputError(problems)


def _command(quick: bool, seeds: int | None, seed: int) -> str:
    """Returns the command that makes the same numbers again."""
    options = [*(["--quick"] if quick and not seeds else []), *([f"--seeds {seeds}"] if seeds else [])]
    return " ".join(["boresight reproduce", *options, *([f"--seed {seed}"] if seed else [])])


def _show(console: PipedConsole, page: Document, written: Path) -> None:
    """Prints every statement with its verdict, and where the page lies."""
    table = Table(box=None, padding=(0, 2, 0, 0), show_header=True, header_style="bold")
    table.add_column("the paper says")
    table.add_column("", no_wrap=True)
    table.add_column("seeds that agree")
    for each in page.judged:
        verdict = each.finding.verdict
        answers = "; ".join(answer.text() for answer in each.finding.answers)
        table.add_row(escape(each.statement.says), f"[{_COLOURS[verdict]}]{verdict.value}[/]", escape(answers))
    console.print(table)
    tally = ", ".join(verdict.counted(count) for verdict, count in page.counts)
    seeds = "1 seed" if page.seeds == 1 else f"{page.seeds} seeds"
    console.print(f"\n{seeds}. Of {len(page.judged)} statements: {tally}.")
    if not page.modern:
        console.print('L-SHADE and jSO were left out: pip install "boresight\\[benchmark]"')
    console.print(f"Page: [bold]{escape(str(written))}[/]", soft_wrap=True, highlight=False)
