"""The command line as a user meets it: a folder of their own, commands, what is said, and what lies there after."""

import shutil
from dataclasses import dataclass

import pytest
from example_files import EXAMPLES, Files

from boresight.cli.main import main


@dataclass(frozen=True)
class Said:
    code: int
    out: str
    err: str


@pytest.fixture
def boresight(tmp_path, monkeypatch, capsys):
    """Runs a command in a folder of its own, on a machine that has compiled the search before."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("BORESIGHT_TRACEBACK", "1")
    monkeypatch.setattr("boresight.cli.compiling.first_compile_ahead", lambda *called: False)

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["boresight", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        captured = capsys.readouterr()
        assert "Traceback" not in captured.out + captured.err
        return Said(ended.value.code, captured.out, captured.err)

    return run


@pytest.fixture
def one_plane(tmp_path):
    shutil.copytree(EXAMPLES / "space-arm-one-plane", tmp_path / "mine")
    return Files(tmp_path / "mine")


@pytest.fixture
def example(tmp_path):
    """Copies an example by name."""

    def copied(name):
        shutil.copytree(EXAMPLES / name, tmp_path / name)
        return Files(tmp_path / name)

    return copied
