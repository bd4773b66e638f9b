"""Names hold anything that a file system, a URDF or a table allows; no written format reads them as more than names."""

import io
import json
import xml.etree.ElementTree as ElementTree

import pytest
from rich.text import Text
from ruamel.yaml import YAML

from boresight.arm import Arm, Joint, catalogue, chain_of
from boresight.cli.consoles import PipedConsole
from boresight.files import dump_robot, load_robot
from boresight.files.campaigns import load_campaign
from boresight.files.names import csv_word, xml_comment, yaml_key, yaml_quoted
from boresight.files.universal_robots import kinematics_yaml
from boresight.files.urdf_writing import dump_urdf
from boresight.geometry import Frame

NAMES = ["a\x07b", "\x1b[31mred", "x\x7fy", "--", "a---b-", "yes", "on", "null", "12", "a: b", "#c", '"q"', "=1+1",
         "@x", "{a}", "<b>&amp;", "ü", "\u2028z", "tab\tx", "new\nline", "-"]  # fmt: skip


def read(text):
    return YAML(typ="safe", pure=True).load(text)


@pytest.mark.parametrize("name", NAMES)
def test_yaml_reads_names_as_they_are(name):
    assert read(f"{yaml_key(name)}: 1") == {name: 1}
    assert read(f"a: {yaml_quoted(name)}") == {"a": name}
    block = read(kinematics_yaml({name: Frame()}, f"of {name}", [name]))
    assert name in block["kinematics"]


@pytest.mark.parametrize("name", NAMES)
def test_comments_of_a_robot_hold_any_name(name, tmp_path):
    arm = catalogue.load("ur10")
    (tmp_path / "a.yaml").write_text(dump_robot(arm, f"of {name}\nsecond"))
    assert load_robot(tmp_path / "a.yaml").joints == arm.joints


@pytest.mark.parametrize("name", NAMES)
def test_comments_of_xml_hold_any_name(name):
    text = dump_urdf(chain_of(Arm("arm", (Joint("j"),))), f"{name}\nsecond")
    assert ElementTree.fromstring(text).get("name") == "arm"
    assert "--" not in xml_comment(name)


@pytest.mark.parametrize("name", ["=cmd()", "+1", "-1+2", "@x"])
def test_words_of_a_table_begin_no_formula(name):
    assert csv_word(name) == f"'{name}"
    assert csv_word("deck") == "deck"


@pytest.mark.parametrize("renderable", [str, Text])
def test_a_terminal_obeys_no_name(renderable):
    out = io.StringIO()
    PipedConsole(file=out, width=200).print(renderable("a\x1b]0;title\x1b\\ \x9b31m\nb"))
    assert "\x1b" not in out.getvalue()
    assert "\x9b" not in out.getvalue()
    assert "\\x1b]0;title" in out.getvalue()
    assert out.getvalue().endswith("b\n")


def test_colours_are_still_printed():
    out = io.StringIO()
    PipedConsole(file=out, force_terminal=True, color_system="standard").print("[red]a[/]")
    assert "\x1b[31ma" in out.getvalue()


@pytest.mark.parametrize("name", ["bell\x07", "\x1b[31mred", "not-utf8-\udcff"])
def test_a_campaign_is_called_as_its_folder_in_visible_characters(tmp_path, name, folder):
    there = tmp_path / name
    there.mkdir()
    for file in ("robot.yaml", "campaign.yaml", "observations.csv"):
        (there / file).write_bytes((tmp_path / file).read_bytes())
    called = load_campaign(there / "campaign.yaml").name
    assert called.isprintable()
    assert json.dumps(called).encode()


def test_sessions_are_visible_characters(folder):
    rows = "j1,j2,range,session\n0.1,0.2,0.3,\x1b[31mred\n0.2,0.3,0.4,b\n"
    assert folder.write(observations=rows).load().readings.session.tolist() == ["\\x1b[31mred", "b"]
