"""Compressed bags that unpack to more than there is room for, or to more than recordings do."""

import io

import pytest

from boresight.errors import InputError
from boresight.files.bags import inflating, read_bag, storages


@pytest.fixture
def zstd():
    try:
        from compression import zstd
    except ImportError:
        from backports import zstd
    return zstd


def test_a_file_that_unpacks_to_far_more_than_its_size_is_refused(tmp_path, zstd, monkeypatch):
    monkeypatch.setattr(storages, "ALWAYS", 2**20)
    (tmp_path / "bomb.mcap.zstd").write_bytes(zstd.compress(bytes(64 * 2**20)))
    with pytest.raises(InputError, match=r"unpacks to more than 1 MiB, [\d,]+ times its size and more"):
        read_bag(tmp_path / "bomb.mcap.zstd", "bomb.mcap.zstd")


def test_a_full_temporary_folder_is_an_error_and_not_a_damaged_bag(tmp_path, zstd, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(storages, "inflate_file", full)
    (tmp_path / "run.mcap.zstd").write_bytes(zstd.compress(b"\x89MCAP0\r\n" + bytes(1000)))
    with pytest.raises(InputError, match=r"it cannot be unpacked in .*: No space left on device; make room there"):
        read_bag(tmp_path / "run.mcap.zstd", "run.mcap.zstd")


def test_no_room_is_told_from_damage(zstd):
    class Full(io.BytesIO):
        def write(self, _):
            raise OSError(28, "No space left on device")

    content = zstd.compress(bytes(10_000))
    with pytest.raises(OSError, match="No space left"):
        inflating.inflate_file(io.BytesIO(content), Full(), 2**20)
    assert inflating.inflate_file(io.BytesIO(content), io.BytesIO(), 2**20) == "whole"
    assert inflating.inflate_file(io.BytesIO(content[:-4]), io.BytesIO(), 2**20) == "broken"
    assert inflating.inflate_file(io.BytesIO(content), io.BytesIO(), 100) == "too large"
