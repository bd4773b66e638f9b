"""What a command is doing, told on one line while it does it; nothing where nobody watches."""

from __future__ import annotations

from types import TracebackType

from rich.progress import BarColumn, Progress, SpinnerColumn, Task, TextColumn, TimeRemainingColumn
from rich.text import Text

from boresight.cli.consoles import PipedConsole


class _TimeLeft(TimeRemainingColumn):
    """The time left, where it is known how much there is to do."""

    def render(self, task: Task) -> Text:
        return Text("") if task.total is None else super().render(task)


class Doing:
    """A line on stderr, gone when the work is done.

    Args:
        silent: whether to say nothing even on a terminal.
    """

    def __init__(self, *, silent: bool = False) -> None:
        console = PipedConsole(stderr=True)
        self._progress = Progress(
            SpinnerColumn(),
            TextColumn("{task.description}"),
            BarColumn(bar_width=16),
            TextColumn("{task.fields[said]}"),
            _TimeLeft(),
            console=console,
            transient=True,
            disable=silent or not console.is_terminal,
        )
        self._task = self._progress.add_task("", total=None, said="")

    def __enter__(self) -> Doing:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()

    def begin(self, what: str, total: int | None = None) -> None:
        """Says what is done from now on.

        Args:
            what: in words.
            total: how many steps it has, where that is known.
        """
        self._progress.remove_task(self._task)
        self._task = self._progress.add_task(what, total=total, said="")

    def advance(self, done: int, said: str = "") -> None:
        """Says how many of the steps are done, and how things stand."""
        self._progress.update(self._task, completed=done, said=said)
