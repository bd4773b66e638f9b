"""The folder of a reproduction: page, figures, tables; each file whole or not at all, nothing foreign overwritten."""

from __future__ import annotations

import os
from pathlib import Path

from boresight.errors import OutputError
from boresight.files.folders import check_folder, staged
from boresight.plots import save
from boresight.reproduction.document import Document
from boresight.reproduction.page import as_html, as_markdown

PAGE = "index.html"
_MARK = "reproduction.md"
_OURS = (PAGE, _MARK, "figures", "tables")
_FIRST_LINE = "# The paper, done again"


def check_writable(folder: Path) -> None:
    """Checks that a reproduction can be written to a folder, before anyone waits for it.

    Raises:
        OutputError: it cannot, or the folder holds files of the same names that are not a reproduction.
    """
    check_folder(folder, "reproduction", _OURS, _is_ours, "reproduction")


def write_reproduction(page: Document, folder: Path, version: str) -> Path:
    """Returns the page's file; figures and tables lie in folders beside it.

    Everything is written to a temporary folder and moved, file by file, the page last.

    Args:
        page: the contents.
        folder: where to write; created if need be.
        version: of the software.

    Raises:
        OutputError: the folder cannot be written, or holds files of the same names that are not a reproduction.
    """
    check_writable(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with staged(folder) as staging:
            for file in _stage(page, staging, version):
                (folder / file).parent.mkdir(exist_ok=True)
                os.replace(staging / file, folder / file)
    except OSError as error:
        raise OutputError(f"{folder}: cannot write the reproduction: {error.strerror or error}") from error
    return folder / PAGE


def _stage(page: Document, staging: Path, version: str) -> list[Path]:
    """Writes everything to a folder; returns its files, the page last."""
    figures, tables = staging / "figures", staging / "tables"
    figures.mkdir()
    tables.mkdir()
    for picture in page.pictures:
        save(picture.figure, figures / picture.name)
        (figures / f"{picture.name}.csv").write_text(picture.csv, encoding="utf-8", newline="\n")
    for table in page.tables:
        (tables / f"{table.name}.csv").write_text(table.as_csv(), encoding="utf-8", newline="\n")
    (staging / _MARK).write_text(as_markdown(page, version), encoding="utf-8", newline="\n")
    (staging / PAGE).write_text(as_html(page, version), encoding="utf-8", newline="\n")
    files = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
    return [*(file for file in files if str(file) != PAGE), Path(PAGE)]


def _is_ours(folder: Path) -> bool:
    try:
        with (folder / _MARK).open(encoding="utf-8") as file:
            return file.readline().rstrip("\n") == _FIRST_LINE
    except (OSError, UnicodeDecodeError):
        return False
