"""Compiled functions on disk: damaged files are made anew, and no place to keep them is no reason to fail."""

import os

import numba
import pytest

from boresight.cli import compiling as told
from boresight.kernels import caching, compiling
from boresight.kernels.caching import CheckedCache, cache_of

SOURCE = "def twice(x):\n    return 2.0 * x\n"


@pytest.fixture
def function(tmp_path, monkeypatch):
    """A function in a file of its own, whose cache lies beside it."""
    monkeypatch.setattr(numba.core.config, "CACHE_DIR", str(tmp_path / "cache"))
    path = tmp_path / "twice.py"
    path.write_text(SOURCE)
    names = {}
    exec(compile(SOURCE, str(path), "exec"), names)
    return names["twice"]


def compiled(function):
    dispatcher = numba.njit(function)
    dispatcher._cache = CheckedCache(function)
    return dispatcher


def files(tmp_path, ending):
    return sorted((tmp_path / "cache").rglob(f"*.{ending}"))


def emptied(content):
    return b""


def cut(content):
    return content[: len(content) // 2]


def flipped(content):
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 0xFF]) + content[middle + 1 :]


def test_what_was_compiled_is_loaded(function):
    assert compiled(function)(2.0) == 4.0
    again = compiled(function)
    assert again(3.0) == 6.0
    assert sum(again.stats.cache_hits.values()) == 1


@pytest.mark.parametrize("ending", ["nbc", "nbi"])
@pytest.mark.parametrize("damage", [emptied, cut, flipped])
def test_damaged_files_are_made_anew(function, tmp_path, ending, damage):
    compiled(function)(2.0)
    for path in files(tmp_path, ending):
        path.write_bytes(damage(path.read_bytes()))
    assert compiled(function)(3.0) == 6.0
    again = compiled(function)
    assert again(3.0) == 6.0
    assert sum(again.stats.cache_hits.values()) == 1


def test_without_room_for_it_a_function_stays_in_memory(function, tmp_path, monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    dispatcher = compiled(function)
    monkeypatch.setattr(caching.CheckedFiles, "_save_data", full)
    assert dispatcher(2.0) == 4.0
    assert files(tmp_path, "nbc") == []


def test_without_a_place_functions_are_compiled_in_memory_and_a_line_says_so(function, monkeypatch, capsys):
    def nowhere(_):
        raise RuntimeError("cannot cache function: no locator available")

    monkeypatch.setattr(caching, "CheckedCache", nowhere)
    monkeypatch.setattr(caching, "_private_folder", lambda: None)
    dispatcher = compiling.compiled(function)
    assert dispatcher(2.0) == 4.0
    assert not compiling.cached_on_disk(dispatcher)
    told.told_of_compiling(compiling.compiled(function))
    assert "there is no place to keep what is compiled" in " ".join(capsys.readouterr().err.split())


def test_the_temporary_folder_serves_where_nothing_else_does(function, tmp_path, monkeypatch):
    tried = []

    class Picky(CheckedCache):
        def __init__(self, function):
            tried.append(numba.core.config.CACHE_DIR)
            if len(tried) == 1:
                raise RuntimeError("cannot cache function: no locator available")
            super().__init__(function)

    monkeypatch.setattr(caching, "CheckedCache", Picky)
    monkeypatch.setattr(caching.tempfile, "gettempdir", lambda: str(tmp_path))
    assert cache_of(function) is not None
    assert tried[1] == str(tmp_path / f"boresight-cache-{os.getuid()}")


def test_a_folder_that_others_can_write_to_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(caching.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = tmp_path / f"boresight-cache-{os.getuid()}"
    folder.mkdir()
    folder.chmod(0o777)
    assert caching._private_folder() is None
    folder.chmod(0o700)
    assert caching._private_folder() == folder
