"""Frames that were estimated beside the arm: every format has them or says what the tool misses without them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from boresight.arm import catalogue
from boresight.geometry import Frame, rotation_angle
from boresight.report.converting import configurations
from boresight.report.export import FORMATS, export
from boresight.report.frames_beside import EstimatedFrame, estimated_frames, in_words
from boresight.report.stored import StoredResult
from random_cells import random_frame

ARM = catalogue.load("ur10")


def document(name, before, shift, turn, listed=("x", "y", "z", "roll", "pitch", "yaw")):
    """What a result says of a frame that was moved, of whose numbers some were estimated."""
    after = before.moved(shift, turn)
    corrections = dict(zip(("x", "y", "z", "roll", "pitch", "yaw"), (*shift, *turn), strict=True))
    return {
        "frames": {name: {"xyz": list(after.xyz), "rpy": list(after.rpy)}},
        "parameters": [{"name": f"{name}.{part}", "correction": corrections[part]} for part in listed],
    }


@pytest.mark.parametrize("seed", range(10))
def test_where_a_frame_stood_before_is_found_again(seed):
    rng = np.random.default_rng(seed)
    before = random_frame(rng)
    shift, turn = (tuple(map(float, rng.uniform(-0.02, 0.02, 3))) for _ in range(2))
    (frame,) = estimated_frames(document("base", before, shift, turn))
    np.testing.assert_allclose(frame.stated.matrix, before.matrix, rtol=0, atol=1e-12)
    np.testing.assert_allclose(frame.identified.matrix, before.moved(shift, turn).matrix, rtol=0, atol=1e-15)


def test_frames_that_were_not_estimated_are_not_told():
    assert estimated_frames(document("base", Frame(), (0.0,) * 3, (0.0,) * 3, listed=())) == ()
    assert estimated_frames(document("base", Frame(), (0.0,) * 3, (0.0,) * 3)) == ()


def test_an_unknown_frame_was_stated_nowhere():
    said = document("mount", Frame(), (0.01, 0.0, 0.0), (0.0,) * 3)
    for parameter in said["parameters"]:
        parameter["correction"] = None
    (frame,) = estimated_frames(said)
    assert frame.stated is None
    assert frame.identified == Frame((0.01, 0.0, 0.0))


def test_what_the_tool_misses_is_the_largest_error_without_the_frame():
    base = EstimatedFrame("base", Frame((0.0, 0.0, 0.001), (0.0, 0.01, 0.01)), Frame())
    poses = ARM.forward_kinematics(configurations(ARM))
    moved = base.identified.matrix @ poses
    far = np.linalg.norm(moved[:, :3, 3] - poses[:, :3, 3], axis=1).max()
    turn = rotation_angle(moved[:, :3, :3], poses[:, :3, :3]).max()
    (said,) = in_words((base,), ARM)
    assert said == (
        "`base` was estimated too and is not in this format: it stands in the world at xyz [0.0, 0.0, 0.001] (m), rpy "
        f"[0.0, 0.01, 0.01] (rad). Where the campaign states it, the tool would be off by {1e3 * far:.1f} mm and "
        f"{1e3 * turn:.1f} mrad."
    )


@pytest.mark.parametrize("to", [name for name in FORMATS if name != "pal"])
def test_every_format_tells_of_the_base_or_has_it(to):
    base = EstimatedFrame("base", Frame((0.0, 0.0, 0.001)), Frame())
    stored = StoredResult(Path("r"), "arm", True, (), ARM, ARM, None, (), (base,))
    exported = export(stored, to)
    if to == "json":
        assert '"stated"' in exported.content
        assert exported.notes == ()
        return
    assert any("`base` was estimated too" in note and "off by 1.00 mm" in note for note in exported.notes)
    assert "`base` was estimated too" in exported.content
    assert "`base`" not in export(replace(stored, frames=()), to).content


def test_a_table_says_it_below_its_rows():
    base = EstimatedFrame("base", Frame((0.0, 0.0, 0.001)), Frame())
    table = export(StoredResult(Path("r"), "arm", True, (), ARM, ARM, None, (), (base,)), "dh", table=True)
    assert table.content.splitlines()[-1].startswith("# `base` was estimated too")
    assert table.content.startswith("joint,type,")
