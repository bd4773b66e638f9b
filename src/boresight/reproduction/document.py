"""The page's contents, before it becomes HTML or Markdown: sections of text, tables, figures and statements."""

from __future__ import annotations

from dataclasses import dataclass

from boresight.plots import look
from boresight.reproduction import prose
from boresight.reproduction.further_figures import further_figures
from boresight.reproduction.further_tables import (
    ambiguity_table,
    assumptions_table,
    beside_table,
    configurations_table,
    runs_table,
    statements_table,
    strategy_table,
)
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.paper_figures import paper_figures
from boresight.reproduction.paper_tables import paper_tables
from boresight.reproduction.pictures import Picture
from boresight.reproduction.pose_statements import position
from boresight.reproduction.setting import CASES
from boresight.reproduction.spread import plain
from boresight.reproduction.statements import Judged, judge
from boresight.reproduction.tables import Table
from boresight.reproduction.variants import NOMINAL
from boresight.reproduction.verdicts import Verdict


@dataclass(frozen=True, slots=True)
class Text:
    """A paragraph; `code` is marked by backticks."""

    words: str


@dataclass(frozen=True, slots=True)
class Card:
    """A headline number.

    Attributes:
        title: what it is.
        before: where it starts.
        after: where it ends.
        words: beneath.
    """

    title: str
    before: str
    after: str
    words: str


@dataclass(frozen=True, slots=True)
class Points:
    """A list of short paragraphs."""

    words: tuple[str, ...]


Block = Text | Points | Table | Picture


@dataclass(frozen=True)
class Section:
    """A heading and what is under it."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Document:
    """The whole page.

    Attributes:
        lead: what it is, in a few sentences.
        cards: headline numbers.
        judged: the statements.
        sections: the rest.
        runs: every run of every seed.
        modern: whether modern differential evolution could be compared.
        seeds: how many.
        first_seed: the first of them.
        command: that makes it again.
    """

    lead: tuple[str, ...]
    cards: tuple[Card, ...]
    judged: tuple[Judged, ...]
    sections: tuple[Section, ...]
    runs: Table
    modern: bool
    seeds: int
    first_seed: int
    command: str

    @property
    def counts(self) -> tuple[tuple[Verdict, int], ...]:
        """How many statements stand how."""
        return tuple((verdict, sum(j.finding.verdict is verdict for j in self.judged)) for verdict in Verdict)

    @property
    def tables(self) -> tuple[Table, ...]:
        """Every table, the statements' first and the single runs' last."""
        own = [block for section in self.sections for block in section.blocks if isinstance(block, Table)]
        return (statements_table(self.judged), *own, self.runs)

    @property
    def pictures(self) -> tuple[Picture, ...]:
        """Every figure."""
        return tuple(block for section in self.sections for block in section.blocks if isinstance(block, Picture))


def compose(found: Measurements, command: str) -> Document:
    """Returns the page of some measurements.

    Args:
        found: everything measured.
        command: that makes it again.
    """
    with look():
        sections = _sections(found)
    seeds = len(found.trials)
    return Document(
        lead=(
            "Section 4 of Liu, Ni, Liu & Xu, “Enhancing pose accuracy of space robot by improved differential "
            "evolution” (J. Cent. South Univ. 19, 2012, 933–943), done again in simulation, every number over many "
            "seeds.",
            f"{seeds} seeds. A seed decides the configurations, the noise and the search's random numbers; the preset "
            "errors are the same for all. Numbers are medians, with the range of nine seeds in ten in brackets. A "
            "statement holds if at least 95 % of the seeds say so, and does not if fewer than half do on every count.",
        ),
        cards=_cards(found),
        judged=judge(found),
        sections=sections,
        runs=runs_table(found),
        modern=found.modern,
        seeds=seeds,
        first_seed=found.trials[0].seed,
        command=command,
    )


def _cards(found: Measurements) -> tuple[Card, ...]:
    cards = []
    for case, rows in CASES.items():
        before, after = (found.spread(lambda run: run.range_max_mm, m, rows) for m in (NOMINAL, "trade-off"))
        cards.append(
            Card(
                f"Largest range error, case {case}",
                f"{plain(before.median)} mm",
                f"{plain(after.median)} mm",
                f"{rows} configurations × 10 readings. The paper: over 30 mm → under 0.2 mm",
            )
        )
    for case, rows in CASES.items():
        before, after = (found.spread(position, m, rows) for m in (NOMINAL, "trade-off"))
        cards.append(
            Card(
                f"Position in validation, case {case}",
                f"{plain(before.median)} mm",
                f"{plain(after.median)} mm",
                f"RMS over 20 other configurations; nine seeds in ten: {plain(after.low)} to {plain(after.high)} mm",
            )
        )
    return tuple(cards)


def _sections(found: Measurements) -> tuple[Section, ...]:
    tables, figures = paper_tables(found), paper_figures(found)
    lost, ambiguous, more, others = further_figures(found)
    return (
        Section("What was assumed", (Points(prose.ASSUMED),)),
        Section(
            "Does it depend on what was assumed?",
            (Text(prose.sensitivity(found)), assumptions_table(found)),
        ),
        Section("The paper's figures", tuple(figures)),
        Section("The paper's tables", tables),
        Section("The lost equation (16)", (Text(prose.equation(found)), lost, strategy_table(found))),
        Section(
            "θ1 and n_x: what no range can tell",
            (*map(Text, prose.AMBIGUITY), Text(prose.turned(found)), ambiguous, ambiguity_table(found)),
        ),
        Section("More configurations", (more, configurations_table(found))),
        Section(
            "Beside it: other methods, and the sister paper",
            (*map(Text, prose.beside(found)), others, beside_table(found)),
        ),
    )
