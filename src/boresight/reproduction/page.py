"""The page as HTML and as Markdown, from the same contents."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from boresight.report.page import page_environment
from boresight.reproduction.document import Block, Document, Points, Text
from boresight.reproduction.pictures import Picture
from boresight.reproduction.verdicts import Verdict

if TYPE_CHECKING:
    from jinja2 import Environment

_MARKS = {Verdict.HOLDS: "✓", Verdict.PARTLY: "◐", Verdict.FAILS: "✗"}


def as_html(page: Document, version: str) -> str:
    """Returns the page as HTML: no scripts, nothing from elsewhere; figures lie beside it."""
    return _environment().get_template("paper.html.jinja").render(page=page, version=version)


def as_markdown(page: Document, version: str) -> str:
    """Returns the page as Markdown; figures lie beside it."""
    lines = ["# The paper, done again", *page.lead]
    lines.append(", ".join(f"{_MARKS[verdict]} {verdict.counted(count)}" for verdict, count in page.counts))
    lines.append("## The paper's statements, beside what was measured")
    rows = [
        (
            f"{_MARKS[each.finding.verdict]} {each.finding.verdict.value}",
            f"{each.statement.says} ({each.statement.place})",
            f"{each.finding.found} Seeds that agree: {'; '.join(answer.text() for answer in each.finding.answers)}.",
        )
        for each in page.judged
    ]
    lines.append(_rows(["", "the paper says", "measured"], rows))
    for section in page.sections:
        lines.append(f"## {section.title}")
        for block in section.blocks:
            lines += _markdown(block)
    lines.append(
        f"Boresight {version}, seeds {page.first_seed} to {page.first_seed + page.seeds - 1}: `{page.command}`."
    )
    return "\n\n".join(lines) + "\n"


def _markdown(block: Block) -> list[str]:
    if isinstance(block, Text):
        return [block.words]
    if isinstance(block, Points):
        return ["\n".join(f"- {words}" for words in block.words)]
    if isinstance(block, Picture):
        return [f"**{block.title}**", f"![{block.title}](figures/{block.name}.png)", block.caption]
    table = _rows([column.heading for column in block.columns], block.texts)
    return [f"**{block.title}**", table, *([block.note] if block.note else [])]


def _rows(header: list[str], rows: list) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(str(cell).replace('|', '¦') for cell in line)} |" for line in lines)


def _environment() -> Environment:
    from markupsafe import Markup, escape

    def inline(words: str) -> Markup:
        """Returns text with what stands in backticks as code, and numbers kept with their units."""
        text = re.sub(r"(?<=\d) (?=%|mm|mrad)", "\u00a0", str(escape(words)))
        return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", text))

    environment = page_environment("boresight.reproduction", "boresight.report")
    environment.filters |= {
        "inline": inline,
        "kind": lambda block: type(block).__name__,
        "mark": _MARKS.__getitem__,
    }
    return environment
