"""Whole processes: what only a real one shows."""

import os
import signal
import subprocess
import sys
import time

import pytest


def start(*arguments, folder, **options):
    command = [sys.executable, "-m", "boresight", *map(str, arguments)]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, cwd=folder, text=True, **{**streams, **options})


def finished(*arguments, folder):
    process = start(*arguments, folder=folder)
    out, err = process.communicate(timeout=120)
    assert "Traceback" not in out + err
    return process.returncode, out, err


def test_help_names_the_commands_and_the_exit_codes(tmp_path):
    code, out, err = finished("--help", folder=tmp_path)
    assert (code, err) == (0, "")
    assert "calibrate" in out
    assert "simulate" in out
    assert "Exit codes: 0 accepted" in out


def test_version_is_the_packages(tmp_path):
    import boresight

    assert finished("--version", folder=tmp_path) == (0, f"{boresight.__version__}\n", "")


def test_no_command_is_a_call_for_help(tmp_path):
    code, out, _ = finished(folder=tmp_path)
    assert code == 0
    assert "Usage: boresight COMMAND" in out


def test_exit_codes_are_0_1_and_2(one_plane, tmp_path):
    quick = ("--solver", "least-squares")
    assert finished("calibrate", one_plane.campaign, *quick, folder=tmp_path)[0] == 0
    assert finished("calibrate", "none.yaml", folder=tmp_path)[0] == 1
    assert finished("calibrate", one_plane.campaign, "--frobnicate", folder=tmp_path)[0] == 1
    one_plane.shuffle_ranges()
    assert finished("calibrate", one_plane.campaign, *quick, folder=tmp_path)[0] == 2


def test_ctrl_c_in_a_long_search_exits_with_130_and_writes_nothing(one_plane, tmp_path):
    # A large population takes minutes to settle, so that patience does not end the search first.
    arguments = ("calibrate", one_plane.campaign, "-o", "here", "--population", "200000", "--generations", "100000")
    # A shell ignores the signal for what it runs in the background, and its children inherit that.
    listening = {"preexec_fn": lambda: signal.signal(signal.SIGINT, signal.default_int_handler)}
    with start(*arguments, folder=tmp_path, **listening) as process:
        try:
            time.sleep(6.0)
            assert process.poll() is None
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    assert process.returncode == 130
    assert out == ""
    assert err.splitlines()[-1] == "Interrupted; nothing was written."
    assert "Traceback" not in err
    assert not (tmp_path / "here").exists()


@pytest.mark.parametrize("more", [[], ["--json"]])
def test_a_reader_who_leaves_changes_neither_exit_code_nor_result(one_plane, tmp_path, more):
    process = start("calibrate", one_plane.campaign, "--solver", "least-squares", *more, folder=tmp_path)
    process.stdout.close()
    err = process.stderr.read()
    assert (process.wait(timeout=60), err) == (0, "")
    process.stderr.close()
    assert (tmp_path / "mine-result" / "result.json").exists()


def test_output_piped_into_head_is_no_traceback(one_plane, tmp_path):
    command = f"{sys.executable} -m boresight calibrate {one_plane.campaign} --solver least-squares | head -n 1"
    done = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True, env={**os.environ})
    assert (done.stdout, done.stderr) == ("ACCEPTED  mine\n", "")
