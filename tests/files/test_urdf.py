"""URDF: what is read of it, and what is refused, in words."""

import math
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from urdf_texts import URDF, joint, swapped, urdf

from boresight.errors import InputError
from boresight.files import load_robot
from boresight.files.elements import DEEPEST, MOST_ELEMENTS
from boresight.files.sources import Source
from boresight.files.urdf import robot_file_of


def read(text, base=None, tip=None):
    content = text if isinstance(text, bytes) else text.encode()
    return robot_file_of(Source(Path("arm.urdf"), "arm.urdf", content), base, tip).chain


def problems(text, base=None, tip=None):
    with pytest.raises(InputError) as caught:
        read(text, base, tip)
    return list(caught.value.problems)


def test_a_chain_is_read_whole():
    chain = read(URDF, "base", "tool")
    assert (chain.name, chain.base, chain.tip) == ("two", "base", "tool")
    j1, j2, end = chain.joints
    assert (j1.type, j1.origin.xyz, j1.origin.rpy, j1.axis, j1.limits) == (
        "revolute", (0.0, 0.0, 0.3), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 2.0),
    )  # fmt: skip
    assert (j2.type, j2.origin.xyz, j2.axis) == ("revolute", (0.1, 0.0, 0.0), (0.0, 1.0, 0.0))
    assert j2.limits == (-math.inf, math.inf)
    assert (end.name, end.type, end.origin.xyz) == ("end", "fixed", (0.0, 0.0, 0.0))


def test_joints_off_the_chain_are_ignored_whatever_they_are():
    spoiled = swapped(('<joint name="grip" type="prismatic">', '<joint name="grip.1" type="floating">'))
    assert read(spoiled, tip="tool") == read(URDF, tip="tool")


def test_base_and_tip_are_found_where_there_is_one_of_each():
    text = urdf(joint("j1", "base", "a") + joint("j2", "a", "b", kind="fixed") + joint("j3", "b", "c"))
    assert (read(text).base, read(text).tip) == ("base", "c")
    assert [j.name for j in read(text, "a").joints] == ["j2", "j3"]


def test_several_tips_are_listed():
    assert problems(URDF) == [
        "arm.urdf: 2 links could be the tip, tool, finger; name one that carries the sensor: tip: tool"
    ]


def test_several_bases_are_listed():
    assert problems(urdf(joint("j1", "base", "a"))) == [
        "arm.urdf: 3 links could be the base, base, b, c; name one: base: base"
    ]


@pytest.mark.parametrize(
    ("base", "tip", "said"),
    [
        (
            "bas",
            "tool",
            "arm.urdf: there is no link 'bas' for the base (did you mean base?); the links are base, one, ",
        ),
        ("base", "tol", "arm.urdf: there is no link 'tol' for the tip (did you mean tool?); the links are base, one, "),
        ("tool", "base", "arm.urdf: no joints lead from base tool to tip base (base and tip the other way round?)"),
        ("finger", "tool", "arm.urdf: no joints lead from base finger to tip tool; the links behind tool are base, "),
        ("tool", "tool", "arm.urdf: base and tip are both tool; expected two links with joints between"),
        ("two", "tool", "arm.urdf: no joint from two to tool moves; expected an arm between base and tip"),
    ],
)
def test_ends_that_no_chain_joins_are_told(base, tip, said):
    (problem,) = problems(URDF, base, tip)
    assert problem.startswith(said)


@pytest.mark.parametrize("limit", ["", '<limit lower="0" upper="0"/>', '<limit lower="-1e16" upper="1e+16"/>'])
def test_a_turning_joint_without_limits_worth_the_name_has_none(limit):
    assert read(urdf(joint("j1", "base", "a", limit)), "base", "a").joints[0].limits == (-math.inf, math.inf)


def test_an_axis_is_normalised_and_along_x_by_default():
    chain = read(urdf(joint("j1", "base", "a", '<axis xyz="0 3 4"/>') + joint("j2", "a", "b")), "base", "b")
    assert chain.joints[0].axis == (0.0, 0.6, 0.8)
    assert chain.joints[1].axis == (1.0, 0.0, 0.0)


MIMICS = (
    joint("j1", "base", "a")
    + joint("j2", "a", "b", '<mimic joint="j1" multiplier="2" offset="0.5"/>')
    + joint("j3", "b", "c", '<mimic joint="j2" multiplier="-3" offset="0.1"/>')
)


def test_a_joint_that_mimics_a_mimic_follows_the_one_that_is_read():
    _, j2, j3 = read(urdf(MIMICS)).joints
    assert (j2.follows, j2.ratio, j2.offset) == ("j1", 2.0, 0.5)
    assert (j3.follows, j3.ratio, j3.offset) == ("j1", -6.0, pytest.approx(-1.4))


def test_what_mimics_a_joint_off_the_chain_is_read_itself():
    _, j3 = read(urdf(MIMICS), "a").joints
    assert j3.follows is None or j3.follows == "j2"
    assert [j.name for j in read(urdf(MIMICS), "a").joints if j.follows is None] == ["j2", "j3"]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (joint("j1", "base", "a", "<mimic joint='j2'/>"), "line 1: joint j1: mimic: there is no joint 'j2' (did you"),
        (
            joint("j1", "base", "a", "<mimic joint='j2'/>") + joint("j2", "a", "b", "<mimic joint='j1'/>"),
            "line 1: joint j2: mimic: j1 mimics itself, round about",
        ),
        (joint("j1", "base", "a", "<mimic joint='j1'/>"), "line 1: joint j1: mimic: j1 mimics itself, round about"),
        (joint("j1", "base", "a", '<axis xyz="0 0 0"/>'), "line 1: joint j1: the axis has no direction; expected one"),
        (joint("j1", "base", "a", '<axis xyz="0 0"/>'), "joint j1: axis xyz: got '0 0'; expected 3 finite numbers"),
        (joint("j1", "base", "a", '<origin xyz="0 0 nan"/>'), "origin xyz: got '0 0 nan'; expected 3 finite numbers"),
        (joint("j1", "base", "a", '<origin xyz="0 0 1e999"/>'), "origin xyz: got '0 0 1e999'; expected 3 finite num"),
        (joint("j1", "base", "a", '<origin rpy="1_0 0 0"/>'), "origin rpy: got '1_0 0 0'; expected 3 finite numbers"),
        (joint("j1", "base", "a", '<origin xyz="${x} 0 0"/>'), "origin xyz: got '${x} 0 0'; expected 3 finite"),
        (joint("j1", "base", "a", "<origin/><origin/>"), "joint j1: there are 2 elements <origin>; expected one"),
        (joint("j1", "base", "a", '<limit lower="low"/>'), "limit lower: got 'low'; expected a finite number"),
        (joint("j1", "base", "a", kind="floating"), "joint j1: got type 'floating'; expected one of fixed, revolute, "),
        (joint("j1", "base", "a", kind="revolut"), "joint j1: got type 'revolut' (did you mean revolute?); expected"),
        (joint("j1", "base", "a", kind="prismatic"), "joint j1: a prismatic joint needs limits; expected <limit lower"),
        (joint("j.1", "base", "a"), "joint j.1: parameters are called after joints; expected a name that is not empty"),
        (joint("base", "base", "a"), "joint base: parameters are called after joints; expected a name other than base"),
        (joint("j1", "base", "z"), "joint j1: there is no child link 'z'"),
        (joint("j1", "basse", "a"), "joint j1: there is no parent link 'basse' (did you mean base?)"),
        (joint("j1", "base", "a") + joint("j1", "a", "b"), "line 1: joint j1 is there already, on line 1"),
        ('<link name="a"/>' + joint("j1", "base", "a"), "link a is there already, on line 1"),
        (joint("j1", "base", "a") + joint("j2", "b", "a"), "joint j2: link a has a parent already, by joint j1; "),
        (joint("j1", "base", "a") + joint("j2", "b", "c") + joint("j3", "c", "b"), "leads back to itself; expected a"),
        (joint("j1", "a", "a"), "link a leads back to itself; expected a tree"),
        ('<joint type="fixed"/>', "line 1: a joint without a name; expected <joint name=...>"),
        ('<joint name="j1" type="fixed"/>', "joint j1: 0 elements <parent>; expected one: <parent link=.../>"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told(body, said):
    tip = "b" if 'child link="b"' in body else "a"
    assert any(said in problem for problem in problems(urdf(body), "base", tip)), problems(urdf(body), "base", tip)


def test_all_faults_of_a_chain_are_told_at_once():
    body = joint("j.1", "base", "a", '<axis xyz="0 0 0"/><origin xyz="1"/>') + joint("j2", "a", "b", kind="planar")
    assert len(problems(urdf(body), "base", "b")) == 4


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "arm.urdf, line 1: not valid XML: no element found"),
        ("robot", "not valid XML: syntax error"),
        ("<robot>\n<link></robot>", "arm.urdf, line 2: not valid XML: mismatched tag"),
        ('<robot a="1" a="2"/>', "not valid XML: duplicate attribute"),
        ("<mujoco/>", "arm.urdf, line 1: <mujoco> is not URDF; expected <robot>"),
        ("<robot/>", "arm.urdf: there are no links; expected <link name=...> and joints between them"),
        (
            '<robot xmlns:xacro="x"><xacro:macro name="a"/></robot>',
            "<xacro:macro> is xacro, which URDF is made from; expand it first: xacro arm.urdf > arm.urdf",
        ),
        (b"<robot name='\xff'/>", "not valid XML: not well-formed (invalid token)"),
        ('<?xml version="1.0" encoding="utf-16"?><robot/>', "the encoding 'utf-16' is not read; save"),
        ('<?xml version="1.0" encoding="shift_jis"?><robot/>', "the encoding 'shift_jis' is not read; save"),
        ('<?xml version="1.0" encoding="nothing"?><robot/>', "the encoding 'nothing' is not read; save the file"),
        ("<robot>&lol;</robot>", "not valid XML: undefined entity"),
        ("<robot>\x1b[31m</robot>", "not valid XML: not well-formed"),
    ],
)  # fmt: skip
def test_what_is_no_urdf_is_refused(text, said):
    (problem,) = problems(text)
    assert said in problem


LAUGHS = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 10))

HOSTILE = {
    "billion laughs": f'<!DOCTYPE robot [<!ENTITY l0 "lol">{LAUGHS}]><robot>&l9;</robot>',
    "external entity": '<!DOCTYPE robot [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot>&x;</robot>',
    "external document type": '<!DOCTYPE robot SYSTEM "http://example.com/evil.dtd"><robot/>',
    "default attributes": '<!DOCTYPE robot [<!ATTLIST joint type CDATA "fixed">]><robot/>',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_document_type_ends_the_reading(name):
    (problem,) = problems(HOSTILE[name])
    assert problem.startswith("arm.urdf, line 1: a document type (<!DOCTYPE>) begins here")


def test_deep_nesting_is_refused_at_once():
    started = time.perf_counter()
    (problem,) = problems("<robot>" + "<a>" * 1_000_000)
    assert (
        problem == f"arm.urdf, line 1: elements are nested more than {DEEPEST} deep; expected a description of a robot"
    )
    assert time.perf_counter() - started < 5.0


def test_too_many_elements_are_refused():
    (problem,) = problems("<robot>" + "<a/>" * (MOST_ELEMENTS + 1) + "</robot>")
    assert "more than 200,000 elements" in problem


LINKS = 20_000
MANY = {
    "bad links": ("j", lambda i: (f"x{i}", f"l{i + 1}"), "there is no parent link 'x0'"),
    "a long chain": ("k", lambda i: (f"l{i}", f"l{i + 1}"), "more than 64 joints move between l0 and l"),
    "a wide tree": ("k", lambda i: (f"l{i // 2}", f"l{i + 1}"), "links could be the tip, l"),
    "a loop": ("k", lambda i: (f"l{i}", f"l{(i + 1) % LINKS}"), "leads back to itself"),
}


@pytest.mark.parametrize("name", MANY)
def test_thousands_of_faults_take_seconds(name):
    letter, ends, said = MANY[name]
    links = "".join(f'<link name="l{i}"/>' for i in range(LINKS))
    count = LINKS if name == "a loop" else LINKS - 1
    body = "".join(joint(f"{letter}{i}", *ends(i)) for i in range(count))
    started = time.perf_counter()
    assert said in problems(f"<robot>{links}{body}</robot>")[0]
    assert time.perf_counter() - started < 20.0


def test_a_large_file_is_refused_unread(tmp_path):
    path = tmp_path / "big.urdf"
    with open(path, "wb") as file:
        file.truncate(100 * 2**20)
    with pytest.raises(InputError, match=r"the file has 100 MiB; expected a URDF file of at most 16 MiB"):
        load_robot(path)


def test_utf_16_is_refused(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_bytes(URDF.encode("utf-16"))
    with pytest.raises(InputError, match="this is text in UTF-16; expected a URDF file"):
        load_robot(path)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "iso-8859-1", "cp1252", "us-ascii"])
def test_encodings_that_hold_ascii_are_read(encoding):
    declared = encoding.removesuffix("-sig")
    text = swapped(
        ('encoding="utf-8"', f'encoding="{declared}"'),
        ("made by hand", "made by hand" if "ascii" in encoding else "fait à la main"),
    )
    assert read(text.encode(encoding), tip="tool") == read(URDF, tip="tool")


@given(
    st.integers(0, len(URDF) - 1),
    st.sampled_from(["", "<", ">", '"', "/", "&", "\0", "0", "é", "<joint"]),
    st.integers(0, 40),
)
def test_a_spoiled_file_is_read_or_refused_in_words(at, put, cut):
    text, said = URDF[:at] + put + URDF[at + cut :], []
    try:
        assert read(text, tip="tool").arm.joints
    except InputError as error:
        said.extend(error.problems)
    assert all(problem.isprintable() and problem.startswith("arm.urdf") for problem in said)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("\n<robot>\n<link></robot>", "arm.urdf, line 3: not valid XML: mismatched tag"),
        ("\r\n\n<robot>\n<link></robot>", "arm.urdf, line 4: not valid XML: mismatched tag"),
        ("<!-- -- --><robot>\n<link></robot>", "arm.urdf, line 1: not valid XML: not well-formed (invalid token)"),
        (
            '<!-- mine -->\n<?xml version="1.0"?>\n<robot/>',
            "arm.urdf, line 2: <?xml begins here and not at the file's beginning; remove what stands before it",
        ),
        ("\n  ", "arm.urdf, line 2: not valid XML: no element found"),
    ],
)
def test_lines_are_the_files_own(content, said):
    with pytest.raises(InputError) as caught:
        robot_file_of(Source(Path("arm.urdf"), "arm.urdf", content.encode()))
    assert caught.value.problems[0].startswith(said)


def test_a_comment_that_never_ends_is_told_at_once():
    content = b"<robot>" + b"<!--" * 2_000_000
    with pytest.raises(InputError, match="not valid XML"):
        robot_file_of(Source(Path("arm.urdf"), "arm.urdf", content))
