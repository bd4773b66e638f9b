"""The front door: what it names is there, and opening it costs little."""

import subprocess
import sys

import pytest

import boresight

HEAVY = ("numpy", "scipy", "numba", "pydantic", "ruamel.yaml", "jinja2")


def loaded_after(statement):
    """Which heavy packages a fresh process has imported after a statement."""
    report = f"print('LOADED', *(n for n in {HEAVY} if n in sys.modules))"
    code = f"import sys\ntry:\n    {statement}\nexcept SystemExit:\n    pass\n{report}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    return done.stdout.splitlines()[-1].split()[1:]


@pytest.mark.parametrize("name", boresight.__all__)
def test_every_public_name_can_be_imported(name):
    assert getattr(boresight, name).__name__ == name


def test_the_front_door_names_what_the_documents_use():
    assert {"Arm", "Campaign", "Result", "Solver", "calibrate", "load_campaign", "write_result"} <= set(
        boresight.__all__
    )
    assert set(boresight.__all__) <= set(dir(boresight))


def test_a_name_that_is_not_public_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'calibrrate'"):
        _ = boresight.calibrrate


def test_importing_the_package_imports_nothing_heavy():
    assert loaded_after("import boresight") == []


@pytest.mark.parametrize(
    "arguments", [["--help"], ["--version"], ["calibrate", "--help"], ["calibrate", "--solver", "x"]]
)
def test_help_and_usage_errors_import_nothing_heavy(arguments):
    argv = f"sys.argv = ['boresight', *{arguments!r}]"
    assert loaded_after(f"{argv}; from boresight.cli import main; main()") == []
