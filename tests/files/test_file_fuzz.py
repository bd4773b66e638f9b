"""Whatever is in the files, an `InputError` is the worst that happens."""

import contextlib
import random

import pytest
from campaign_texts import CAMPAIGN, OBSERVATIONS, ROBOT
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from boresight.errors import InputError
from boresight.files import load_campaign, load_robot

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
