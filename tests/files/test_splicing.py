"""A calibrated URDF is the user's own file: only numbers of changed origins are new."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from urdf_texts import URDF, swapped

from boresight.files.sources import Source
from boresight.files.splicing import calibrated_urdf
from boresight.files.urdf import robot_file_of
from published_urdfs import pinocchio_poses

CORRECTIONS = {"j1.theta": 0.01, "j1.d": 0.002, "j1.alpha": 0.003, "j2.theta": -0.02, "j2.alpha": 0.001, "j2.a": 0.001}
JOINTS = np.random.default_rng(0).uniform(-2.0, 2.0, (10, 2))


def robot(content, tip="tool"):
    content = content if isinstance(content, bytes) else content.encode()
    return robot_file_of(Source(Path("arm.urdf"), "arm.urdf", content), tip=tip)


def calibrated(content, corrections, tip="tool"):
    """Returns the calibrated file, once read again it moves as the identified arm does."""
    before = robot(content, tip)
    arm = before.chain.arm
    text = calibrated_urdf(before, arm, arm.corrected(corrections))
    again = robot(text, tip).chain
    expected = arm.corrected(corrections).forward_kinematics(JOINTS)
    np.testing.assert_allclose(again.screws.forward_kinematics(JOINTS), expected, rtol=0, atol=1e-12)
    return text


def without_numbers(content):
    """Returns the file with every origin's numbers, and origins that were put in, taken out."""
    return re.sub(rb"""((xyz|rpy)\s*=\s*)(["'])[^"']*\3""", rb"\1\3\3", content)


def test_no_correction_gives_the_same_bytes():
    assert calibrated(URDF, {}) == URDF.encode()


def test_the_numbers_of_one_joint_change_and_nothing_else():
    text = calibrated(URDF, {"j1.d": 0.002}).decode()
    assert text == URDF.replace("0  0\t0.3", "0  0\t0.302")
    text = calibrated(URDF, {"j1.theta": -0.01}).decode()
    assert text == URDF.replace('rpy = "0 0 0"', 'rpy = "0 0 -0.01"')


def test_missing_attributes_are_put_in_behind_those_that_are_there():
    text = calibrated(URDF, {"j2.theta": 0.01}).decode()
    assert text == URDF.replace('<origin xyz="0.1 0 0"/>', '<origin xyz="0.1 0 0" rpy="0.0 0.01 0.0"/>')


def test_a_missing_origin_is_put_in_with_the_files_own_indentation():
    text = calibrated(URDF, {"j2.alpha": 0.001}).decode()
    (new,) = re.findall(r"\n\t<origin [^>]*/>(?=\n\t<parent)", text)
    assert text.replace(new, "") == URDF


@pytest.mark.parametrize(
    "content",
    [
        URDF.encode(),
        URDF.replace("\n", "\r\n").encode(),
        URDF.replace("\n", "\r").encode(),
        b"\xef\xbb\xbf" + URDF.encode(),
        swapped(("utf-8", "iso-8859-1"), ("made by hand", "fait à la main")).encode("iso-8859-1"),
        swapped(("made by hand", "手作り 🤖")).encode(),
        swapped(('<origin xyz="0.1 0 0"/>', "<origin\n  xyz\n=\n'0.1&#32;0 0' \n></origin >")).encode(),
        swapped(("<!-- no rpy -->", '<![CDATA[ <origin xyz="1 1 1"/> ]]><?tool <origin xyz="2 2 2"/>?>')).encode(),
        swapped(('<joint name="j2" type', "<joint note='a > b' name='j2' type")).encode(),
        re.sub(r">\s+<", "><", URDF).encode(),
    ],
    ids=["lf", "crlf", "cr", "bom", "latin-1", "utf-8", "odd", "cdata", "greater than", "one line"],
)
def test_every_other_byte_stays(content):
    text = calibrated(content, CORRECTIONS)
    put_in = re.findall(
        rb"""\s*<origin xyz="[^"]*" rpy="[^"]*"/>(?=\s*<parent link="two"/>\s*<child link="tool"/>)""", text
    )
    assert len(put_in) == 1
    rest = without_numbers(text.replace(put_in[0], b"", 1)).replace(b' rpy=""', b"").replace(b" rpy=''", b"")
    assert rest == without_numbers(content).replace(b' rpy=""', b"")


def test_the_tip_of_a_bare_arm_stays_where_its_joint_is():
    text = calibrated(URDF, {"j1.alpha": 0.01, "j2.theta": 0.01}, tip="two")
    assert text.count(b"<origin") == URDF.count("<origin")


def test_pinocchio_reads_what_was_identified():
    before = robot(swapped(("0\t0.3", "0 0.3")))  # urdfdom knows no tabs between numbers
    arm = before.chain.arm
    text = calibrated_urdf(before, arm, arm.corrected(CORRECTIONS))
    expected = arm.corrected(CORRECTIONS).forward_kinematics(JOINTS)
    np.testing.assert_allclose(pinocchio_poses(text, before.chain, JOINTS), expected, rtol=0, atol=1e-12)


NUMBERS = st.floats(-0.05, 0.05)
SPACE = st.sampled_from([" ", "  ", "\t", "\n", "\r\n  "])


@given(
    st.tuples(*[st.floats(-1.0, 1.0)] * 3), st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    st.sampled_from(["'", '"']), SPACE, SPACE, st.tuples(*[NUMBERS] * 6),
)  # fmt: skip
def test_any_origin_in_any_dress_is_corrected(xyz, rpy, quote, gap, around, corrections):
    numbers = [gap.join(map(repr, part)) for part in (xyz, rpy)]
    dressed = f"<origin{around}xyz{around}={around}{quote}{numbers[0]}{quote}{gap}rpy={quote}{gap}{numbers[1]}{quote}/>"
    content = swapped(('<origin xyz="0.1 0 0"/>', dressed)).encode()
    text = calibrated(content, dict(zip(CORRECTIONS, corrections, strict=True)))
    assert len(re.findall(rb"<!--.*?-->", text)) == 2


@pytest.mark.parametrize("before", ["\n", "\r\n", " \n\t\n", "\ufeff\n", "\ufeff", "   "])
def test_what_stands_before_the_declaration_keeps_its_bytes(before):
    text = calibrated(before + URDF, {"j1.d": 0.002}).decode()
    assert text == before + URDF.replace("0  0\t0.3", "0  0\t0.302")


@pytest.mark.parametrize("comment", [b"-- arm --", b"M\xfcller", b"--\r\n<origin xyz='1 2 3'/>--", b"-"])
def test_comments_as_other_readers_take_them_keep_their_bytes(comment):
    content = URDF.encode().replace(b'  <joint name="j2"', b"<!--%s-->\n" % comment + b'  <joint name="j2"')
    assert b"<!--" + comment in content
    text = calibrated(content, {"j2.theta": 0.01, "j1.d": 0.002})
    expected = content.replace(b"0  0\t0.3", b"0  0\t0.302")
    assert text == expected.replace(b'<origin xyz="0.1 0 0"/>', b'<origin xyz="0.1 0 0" rpy="0.0 0.01 0.0"/>')
