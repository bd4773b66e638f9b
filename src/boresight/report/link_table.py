"""An arm's D-H numbers as a CSV table, and what such a table has no column for."""

from __future__ import annotations

import csv
import io

from boresight.arm import Arm
from boresight.files.names import csv_word
from boresight.files.problems import printable
from boresight.geometry import Frame


def link_table(arm: Arm, beside: tuple[str, ...] = ()) -> tuple[str, tuple[str, ...]]:
    """Returns the text of a table with a row a joint [m and rad], and what it has no column for, a sentence each.

    These sentences, and those of what else is `beside` the arm, stand as comments below the rows.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["joint", "type", "theta_rad", "d_m", "a_m", "alpha_rad", "beta_rad"])
    for joint in arm.joints:
        writer.writerow([csv_word(joint.name), joint.type, *(repr(value) for value in joint.numbers.values())])
    notes = tuple(_beside_the_rows(arm))
    return text.getvalue() + "".join(f"# {printable(note)}\n" for note in (*notes, *beside)), notes


def _beside_the_rows(arm: Arm) -> list[str]:
    notes = [f"The numbers are read in {arm.convention}."] if arm.convention != "standard-dh" else []
    if arm.root != Frame():
        notes.append(f"The table begins at root, which stands in the base frame at {_in_words(arm.root)}.")
    if arm.tip != Frame():
        notes.append(f"Behind the last row the tool stands at tip, {_in_words(arm.tip)}.")
    followers = (joint for joint in arm.joints if joint.follows)
    notes += [f"Joint {j.name} follows {j.follows}: its reading is {j.ratio!r} times that one's." for j in followers]
    return notes


def _in_words(frame: Frame) -> str:
    xyz, rpy = ([float(value) for value in part] for part in (frame.xyz, frame.rpy))
    return f"xyz {xyz} (m), rpy {rpy} (rad)"
