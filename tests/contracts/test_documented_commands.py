"""Every command and every piece of Python that the documents show runs as it stands."""

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(document):
    """(language, text) of every fenced block."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", document.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def commands(document):
    """Every line that begins with `$ boresight ` in a console block, and every block of Python, in order."""
    for language, text in blocks(document):
        if language == "console":
            for line in text.replace("\\\n", " ").splitlines():
                if line.startswith("$ boresight "):
                    yield [sys.executable, "-m", *shlex.split(line[2:])]
        elif language == "python":
            yield [sys.executable, "-W", "error", "-c", text]


@pytest.mark.long
@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_what_a_document_shows_runs(document, tmp_path):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    for command in commands(document):
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
        assert "Traceback" not in done.stderr


def test_the_readme_shows_commands():
    assert len(list(commands(ROOT / "README.md"))) >= 5


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_links_within_the_project_lead_somewhere(document):
    targets = re.findall(r"\]\((?!https?:)([^)#]+)(?:#[^)]*)?\)", document.read_text(encoding="utf-8"))
    assert [target for target in targets if not (document.parent / target).exists()] == []
