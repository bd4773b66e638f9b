"""Whole processes: what only a real one shows."""

import json
import os
import signal
import subprocess
import sys
import time

import pytest

from boresight.cli import main


def start(*arguments, folder, **options):
    command = [sys.executable, "-m", "boresight", *map(str, arguments)]
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.Popen(command, cwd=folder, text=True, **{**streams, **options})


def finished(*arguments, folder):
    process = start(*arguments, folder=folder)
    out, err = process.communicate(timeout=120)
    assert "Traceback" not in out + err
    assert "defect of Boresight" not in err
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


QUICK = ("--solver", "least-squares", "-o", "out")


@pytest.mark.parametrize("options", [(), ("--json",)])
def test_a_closed_standard_output_is_no_reason_to_fail(one_plane, tmp_path, options):
    command = [sys.executable, "-m", "boresight", "calibrate", str(one_plane.campaign), *QUICK, *options]
    shell = ["sh", "-c", '"$@" >&-', "sh", *command]
    ended = subprocess.run(shell, cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert (tmp_path / "out" / "result.json").exists()


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device here")
@pytest.mark.parametrize("options", [(), ("--json",)])
def test_a_full_standard_output_is_told_and_the_result_is_there(one_plane, tmp_path, options):
    with open("/dev/full", "w") as full:
        process = start("calibrate", one_plane.campaign, *QUICK, *options, folder=tmp_path, stdout=full)
        _, err = process.communicate(timeout=120)
    assert process.returncode == 1
    assert err == "Error: standard output: No space left on device; files that the command names were written\n"
    assert (tmp_path / "out" / "result.json").exists()


def test_what_an_encoding_lacks_is_written_as_an_escape(one_plane, tmp_path):
    folder = one_plane.campaign.parent
    folder = folder.rename(folder.with_name("\u05d0\U0001f600"))
    ascii_only = {"env": os.environ | {"PYTHONIOENCODING": "ascii"}}
    for options in ((), ("--json",)):
        with start("calibrate", folder / "campaign.yaml", *QUICK, *options, folder=tmp_path, **ascii_only) as process:
            out, err = process.communicate(timeout=120)
        assert (process.returncode, err) == (0, "")
    assert json.loads(out)["name"] == "\u05d0\U0001f600"


def test_a_defect_is_told_in_a_sentence(monkeypatch, capsys):
    def broken(*_, **__):
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr("boresight.cli.inspect.run_inspect", broken)
    monkeypatch.setattr("sys.argv", ["boresight", "inspect", "campaign.yaml"])
    monkeypatch.delenv("BORESIGHT_TRACEBACK", raising=False)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 1
    told = capsys.readouterr().err
    assert told.startswith("Error: this is a defect of Boresight ")
    assert "(ZeroDivisionError: division by zero)" in told
    assert told.count("\n") == 1
