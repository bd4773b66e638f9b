"""A result.json whose parts are not what they should be is told in a sentence, never by a traceback."""

import contextlib
import copy
import json
from pathlib import Path

import pytest

from boresight.arm import catalogue
from boresight.errors import InputError
from boresight.files import dump_robot
from boresight.report.export import FORMATS, export
from boresight.report.stored import load_result

ARM = catalogue.load("ur10")
ORIGIN = {"xyz": [0.0, 0.0, 0.1], "rpy": [0.0, 0.0, 0.0]}


def document():
    parameters = [
        {"name": f"{joint.name}.{number}", "nominal": value, "correction": 0.0}
        for joint in ARM.joints
        for number, value in joint.numbers.items()
    ]
    return copy.deepcopy({
        "schema": "boresight-result/1",
        "name": "arm",
        "verdict": {"accepted": True, "reasons": ["fine"]},
        "parameters": parameters,
        "frames": {"base": ORIGIN, "mount": ORIGIN},
        "urdf": {"origins": [{"joint": "a", "type": "revolute", "nominal": ORIGIN, "identified": ORIGIN}]},
    })  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    def written(content):
        (tmp_path / "robot-calibrated.yaml").write_text(dump_robot(ARM))
        (tmp_path / "robot-calibrated.urdf").write_text("<robot/>")
        (tmp_path / "result.json").write_text(content if isinstance(content, str) else json.dumps(content))
        return tmp_path

    return written


def refusal(folder):
    with pytest.raises(InputError) as caught:
        load_result(folder)
    (problem,) = caught.value.problems
    return problem.removeprefix(f"{folder}/")


def test_a_good_one_is_read(folder):
    stored = load_result(folder(document()))
    assert stored.nominal.joints == ARM.joints
    for to in FORMATS:
        assert export(stored, to).content


def paths(value, at=()):
    """Every place of a document that the reader looks at."""
    yield at
    if isinstance(value, dict):
        for key in value:
            yield from paths(value[key], (*at, key))
    if isinstance(value, list) and value:
        yield from paths(value[0], (*at, 0))


def replaced(at, value):
    changed = document()
    inner = changed
    for key in at[:-1]:
        inner = inner[key]
    inner[at[-1]] = value
    return changed


WRONG = ["x", None, True, [], {}, [1, 2], 1e300, -1, 10**400, [[[]]], {"xyz": "x"}, ["a", "b", "c"]]


@pytest.mark.parametrize("at", [at for at in paths(document()) if at], ids=str)
def test_any_part_of_another_kind_is_told_or_harmless(folder, at):
    for value in WRONG:
        try:
            stored = load_result(folder(replaced(at, value)))
        except InputError as error:
            (problem,) = error.problems
            assert problem.startswith(str(folder(document()) / "result.json")), problem
            continue
        for to in FORMATS:
            with contextlib.suppress(InputError):  # in a sentence: without origins, say, there are no deltas
                assert export(stored, to).content


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity"])
def test_constants_that_json_does_not_have(folder, word):
    content = json.dumps(document()).replace("0.1273", word)
    assert word in content
    assert refusal(folder(content)) == f"result.json: not valid JSON: {word} is no number of JSON"


def test_what_is_wrong_is_named(folder):
    said = refusal(folder(replaced(("parameters", 0, "nominal"), "x")))
    assert said == (
        "result.json: not a result of this version of Boresight: parameters[0].nominal is 'x'; calibrate again"
    )
    changed = document()
    del changed["verdict"]["accepted"]
    assert "verdict.accepted is missing; calibrate again" in refusal(folder(changed))


def test_a_parameter_that_is_not_there(folder):
    changed = document()
    del changed["parameters"][0]
    said = refusal(folder(changed))
    assert said.startswith(
        "result.json: it does not belong to robot-calibrated.yaml beside it ('shoulder_pan_joint.theta')"
    )


@pytest.mark.parametrize("depth", [2_000, 200_000])
def test_nesting_beyond_all_measure(folder, depth):
    assert refusal(folder("[" * depth)).startswith("result.json: not valid JSON")


def test_names_that_no_file_can_have(boresight_command):
    for name in ("x" * 5000, "a/" * 3000):
        for arguments in (("export", name, "--to", "dh"), ("calibrate", name), ("compensate", name, name)):
            said = boresight_command(*arguments)
            assert said.returncode == 1
            assert said.stderr.startswith("Error: ")
            assert len(said.stderr.splitlines()) == 1
            assert "defect" not in said.stderr


@pytest.fixture
def boresight_command(tmp_path):
    import subprocess
    import sys

    def run(*arguments):
        return subprocess.run(
            [sys.executable, "-m", "boresight", *arguments], cwd=tmp_path, capture_output=True, text=True, check=False,
            env={**__import__("os").environ, "PYTHONPATH": str(Path(__file__).parents[2] / "src")},
        )  # fmt: skip

    return run
