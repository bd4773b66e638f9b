"""Whatever is in the files, an `InputError` is the worst that happens."""

import contextlib
import json
import random

import pytest
from campaign_texts import CAMPAIGN, OBSERVATIONS, ROBOT
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from boresight.errors import InputError
from boresight.files import load_campaign, load_robot
from boresight.files.documents import read_document

FUZZ = settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
SPLICES = [
    *"[]{}:,-#&*!|>'\"%@`?\n\t 0.\x00\x85\u2028\ufeffé",
    "!!python/object:os.system ",
    "&a ",
    "*a",
    "<<: ",
    "---\n",
]
SPLICES += ["1e999", ".nan", "null", "-1", "true", "unknown", "9" * 50, "%YAML 9.9\n", "%TAG ! x\n", "../", "{}", "[]"]


def mutated(text, seed):
    """The text with a few places cut, doubled or spliced."""
    draw = random.Random(seed)
    for _ in range(draw.randint(1, 4)):
        start = draw.randrange(len(text) + 1)
        stop = min(len(text), start + draw.choice([0, 0, 1, 3, 12]))
        text = text[:start] + draw.choice(["", text[start:stop] * 2, *SPLICES]) + text[stop:]
    return text


@FUZZ
@given(content=st.binary(max_size=300))
def test_random_bytes_are_never_a_traceback(folder, content):
    for file in ("campaign.yaml", "robot.yaml", "observations.csv"):
        folder.write(**({file: content}))
        with contextlib.suppress(InputError):
            load_campaign("campaign.yaml")
        with contextlib.suppress(InputError):
            load_robot("robot.yaml")


@FUZZ
@given(content=st.text(alphabet="".join(sorted({*"".join(SPLICES), *"abj12"})), max_size=120))
def test_random_yaml_marks_are_never_a_traceback(folder, content):
    folder.write(campaign=content.encode("utf-8"))
    with contextlib.suppress(InputError):
        load_campaign("campaign.yaml")


@FUZZ
@pytest.mark.parametrize("file", ["campaign", "robot", "observations"])
@given(seed=st.integers(0, 2**32))
def test_mutated_files_are_never_a_traceback(folder, file, seed):
    text = {"campaign": CAMPAIGN, "robot": ROBOT, "observations": OBSERVATIONS}[file]
    folder.write(**{file: mutated(text, seed).encode("utf-8")})
    with contextlib.suppress(InputError):
        load_campaign("campaign.yaml")


ODD_NUMBERS = [None, True, 0, -1, 2**70, 1e308, -1e-320]
ODD_WORDS = ["", "x", "*", "[", "unknown", "j1.*", "/", "\x00"]
VALUES = st.sampled_from([*ODD_NUMBERS, *ODD_WORDS, [], {}, [0, 0], [1e308] * 3])


def respelt(value, draw):
    """The same data with some part put in place of another."""
    if draw(st.integers(0, 14)) == 0:
        return draw(VALUES)
    if isinstance(value, dict):
        return {key: respelt(item, draw) for key, item in value.items()}
    return [respelt(item, draw) for item in value] if isinstance(value, list) else value


@FUZZ
@given(data=st.data())
def test_values_of_any_kind_in_any_place_are_never_a_traceback(folder, data):
    for file in ("campaign", "robot"):
        good = read_document(folder.write().path / f"{file}.yaml").data
        frame = {"base": {"xyz": "unknown", "rpy": [0, 0, 1]}} if file == "campaign" else {}
        spoilt = json.dumps(respelt(good | frame, data.draw))
        folder.write(**{file: spoilt})
        with contextlib.suppress(InputError):
            load_campaign("campaign.yaml")
