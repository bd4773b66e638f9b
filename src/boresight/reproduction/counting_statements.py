"""What the paper says about how many parameters can be identified (section 3.1 and 4.3)."""

from __future__ import annotations

import numpy as np

from boresight.inference import everett_count
from boresight.reproduction.measurements import Measurements
from boresight.reproduction.spread import percent
from boresight.reproduction.verdicts import Answer, Finding, Statement, share_of


def _twenty_five(found: Measurements) -> Finding:
    seen = np.array([trial.ranks.of_paper for trial in found.trials])
    return Finding(
        (Answer("rank 25 of the 26 parameters of eq. (19)", share_of(seen == 25)),),
        f"Rank of the 24 link parameters and n_x, n_z together: {_counts(seen)}. `j1.theta` and n_x are one direction.",
    )


def _counted(found: Measurements) -> Finding:
    plane = np.array([trial.ranks.of_one_plane for trial in found.trials])
    return Finding(
        (Answer("25 of 30 seen", share_of(plane == 25)),),
        f"Ranges to one known plane see {_counts(plane)} of the arm's 30 independent parameters. Hidden are the spin "
        "about the beam and three motions of the base along and about the plane: four, not five. The number 25 comes "
        "out for another reason: the plane is identified too.",
    )


def _everett(found: Measurements) -> Finding:
    pose = np.array([trial.ranks.of_pose for trial in found.trials])
    return Finding(
        (
            Answer("rank 30 where the whole pose is measured", share_of(pose == 30)),
            Answer("C = 2R + 2P + 6 gives that rank", share_of(pose == 2 * 6 + 6)),
        ),
        f"Measured rank: {_counts(pose)}. As printed the formula gives {2 * 6 + 6} for six revolute joints; with 4R, "
        f"as Everett has it, {everett_count(6, 0)}. The 30 is right, the 2R a misprint.",
    )


def _floor(found: Measurements) -> Finding:
    seen = np.array([trial.ranks.of_floor for trial in found.trials])
    blind = [set(trial.ranks.blind_to) == {"j1.theta", "j1.a", "j3.d"} for trial in found.trials]
    return Finding(
        (
            Answer("exactly these three change no range", share_of(np.array(blind))),
            Answer("rank 21 of 24", share_of(seen == 21)),
        ),
        f"Rank of the 24 link parameters: {_counts(seen)}. They only slide and turn the arm along the plane.",
    )


def _counts(ranks: np.ndarray) -> str:
    """Returns the ranks that occur, the commonest first."""
    values, counts = np.unique(ranks, return_counts=True)
    order = np.argsort(-counts)
    if len(values) == 1:
        return str(values[0])
    return ", ".join(f"{values[i]} in {percent(counts[i] / len(ranks))} of seeds" for i in order)


COUNTING_STATEMENTS = (
    Statement(
        "section 3.1", "With the ranger “there are 25 identifiable geometric parameters … at most”.", _twenty_five
    ),
    Statement(
        "section 3.1",
        "They are 25 because, of 30, three are lost to a rotation and two to coordinates left free.",
        _counted,
    ),
    Statement("section 3.1, eq. (13)", "C = 2R + 2P + 6, hence 30 parameters for six revolute joints.", _everett),
    Statement("section 4.3", "The plane z + f = 0 makes θ1, a1 and d3 unidentifiable.", _floor),
)
