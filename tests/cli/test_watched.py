"""What a person at a terminal sees while a command works."""

import os
import pty
import subprocess
import sys


def seen_at_a_terminal(*arguments, folder):
    """Returns the exit code, stdout, and what a terminal got on stderr."""
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "boresight", *map(str, arguments)]
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=theirs, env={**os.environ, "TERM": "xterm"}
    ) as process:
        os.close(theirs)
        seen = b""
        try:
            while block := os.read(ours, 65536):
                seen += block
        except OSError:  # Linux tells so of a terminal whose other end is closed
            pass
        out = process.stdout.read()
    os.close(ours)
    return process.returncode, out.decode(), seen.decode()


def test_every_step_of_a_calibration_is_told_while_it_lasts(one_plane, tmp_path):
    code, out, seen = seen_at_a_terminal("calibrate", one_plane.campaign, "--population", "10000", folder=tmp_path)
    assert code == 0
    steps = ("reading", "evolution", "least squares", "held-out rows", "pose uncertainty", "writing mine-result")
    places = [seen.index(step) for step in steps]
    assert places == sorted(places)
    assert "/500 generations, best" in seen
    assert out.startswith("ACCEPTED")


def test_nothing_is_told_where_a_program_reads(one_plane, tmp_path):
    options = ("--solver", "least-squares", "--json")
    code, out, seen = seen_at_a_terminal("calibrate", one_plane.campaign, *options, folder=tmp_path)
    assert (code, seen) == (0, "")
    assert out.startswith("{")


def test_an_error_stands_alone_when_the_line_is_gone(one_plane, tmp_path):
    one_plane.campaign.write_text("nonsense")
    code, _, seen = seen_at_a_terminal("calibrate", one_plane.campaign, folder=tmp_path)
    assert code == 1
    assert "Error" in seen
    assert "Traceback" not in seen
