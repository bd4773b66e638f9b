"""Files that are not what they should be are told by their first bytes, wherever they are named."""

import bz2
import gzip
import io
import lzma
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from boresight.cli.importing import ArmOf, run_import
from boresight.errors import InputError
from boresight.files import load_robot
from boresight.files.bags import is_bag, read_bag
from boresight.files.signatures import signature_of
from boresight.files.topics import Choice

CSV = b"j1,j2,range\n0.1,0.2,1.5\n"
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"


def zipped(*names):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name in names:
            archive.writestr(name, "x")
    return content.getvalue()


def tarred():
    content = io.BytesIO()
    with tarfile.open(fileobj=content, mode="w") as archive:
        archive.addfile(tarfile.TarInfo("a.csv"), io.BytesIO())
    return content.getvalue()


def npz():
    content = io.BytesIO()
    np.savez(content, joints=np.zeros(2))
    return content.getvalue()


FOREIGN = {
    "a Git LFS pointer": (POINTER, "git lfs pull"),
    "a ZIP archive": (zipped("a.csv"), "unpack it"),
    "an Excel workbook": (zipped("[Content_Types].xml", "xl/workbook.xml"), "CSV"),
    "a NumPy archive": (npz(), "CSV"),
    "a gzip file": (gzip.compress(CSV), "gunzip -k"),
    "a bzip2 file": (bz2.compress(CSV), "bunzip2 -k"),
    "an xz file": (lzma.compress(CSV), "unxz -k"),
    "a tar archive": (tarred(), "tar xf"),
    "a PDF document": (b"%PDF-1.7\n%\xe2\xe3", "CSV"),
    "a web page": (b"\n<!DOCTYPE html><html>", "download the file itself"),
    "text in UTF-16": (CSV.decode().encode("utf-16"), "UTF-8"),
}


@pytest.fixture
def ros1(tmp_path):
    path, store = tmp_path / "run.bag", get_typestore(Stores.ROS1_NOETIC)
    message = store.types["std_msgs/msg/Float64"](data=1.5)
    with Writer(path) as writer:
        topic = writer.add_connection("/ranger", message.__msgtype__, typestore=store)
        writer.write(topic, 10**18, store.serialize_ros1(message, message.__msgtype__))
    return path


def imported(path, output):
    with pytest.raises(InputError) as caught:
        run_import(path, output, Choice(), arm=ArmOf(), joint_file=None, marker=None, overwrite=False, as_json=False)
    (told,) = caught.value.problems
    return told


@pytest.mark.parametrize("kind", FOREIGN)
@pytest.mark.parametrize("name", ["run.csv", "run.mcap", "run.db3"])
def test_import_says_what_the_file_is(tmp_path, kind, name):
    content, mend = FOREIGN[kind]
    (tmp_path / name).write_bytes(content)
    told = imported(tmp_path / name, tmp_path / "o.csv")
    assert f"this is {kind}" in told
    assert mend in told


@pytest.mark.parametrize("kind", FOREIGN)
def test_so_does_a_robot(tmp_path, kind):
    (tmp_path / "robot.yaml").write_bytes(FOREIGN[kind][0])
    with pytest.raises(InputError, match=f"this is {kind}"):
        load_robot(tmp_path / "robot.yaml")


@pytest.mark.parametrize("name", ["run.bag", "run.mcap", "run.csv", "run"])
def test_a_ros_1_bag_is_known_whatever_it_is_called(ros1, tmp_path, name):
    path = ros1.rename(tmp_path / name)
    assert is_bag(path)
    told = imported(path, tmp_path / "o.csv")
    assert "this is a ROS 1 bag; expected a ROS 2 bag" in told
    assert f"rosbags-convert --src {tmp_path / 'run'}.bag --dst {tmp_path / 'run'}" in told
    assert ("call it" in told) == (name != "run.bag")


def test_a_folder_of_ros_1_bags_is_told_too(ros1):
    with pytest.raises(InputError, match=r"run\.bag: this is a ROS 1 bag"):
        read_bag(ros1.parent, "folder")


def test_the_conversion_that_is_named_works(ros1, tmp_path):
    command = Path(sys.executable).with_name("rosbags-convert")
    subprocess.run([command, "--src", ros1, "--dst", tmp_path / "run"], check=True, capture_output=True)
    assert read_bag(tmp_path / "run", "run").topics["/ranger"].count == 1


@pytest.mark.parametrize("text", [CSV, b"PAR1,j\n", b"ARROW1,GIF89\n", b"BZh91,x\n", b"#ROSBAG V2.0\nj1\n", b"PK,j\n"])
def test_csv_that_only_begins_alike_is_text(tmp_path, text):
    assert signature_of(text, "a.csv") is None
