"""What a result hangs on that no reading can check."""

import numpy as np
import pytest
from rehearsed import measured, ranger_cell, usual_freedoms

from boresight.calibration.complete_model import complete_model
from boresight.calibration.noise_size import noise_size
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.calibration.sensitivities import sensitivities, sensitivities_in_words
from boresight.inference import spread_configurations

CELL = ranger_cell(planes=1)
JOINTS = spread_configurations(CELL, 200)


def found(truth=CELL, **stated):
    freedoms = usual_freedoms(CELL)
    best = fit(Problem(CELL, measured(CELL, truth, rows=100), freedoms), np.zeros(len(freedoms)))
    return best, sensitivities(best, complete_model(best, stated, noise_size(best)), JOINTS, 1e-4)


def test_the_only_planes_offset_is_told_and_moves_the_tool_by_what_it_says():
    exact, told = found()
    offset = next(each for each in told if each.effect == "deck.offset")
    moved, _ = found(CELL.corrected({"deck.offset": offset.amount}))
    away = [each.problem.fitted(each.x).poses(JOINTS)[:, :3, 3] for each in (exact, moved)]
    shift = np.sqrt(np.mean(np.sum((away[1] - away[0]) ** 2, axis=1)))
    assert shift == pytest.approx(offset.shift_m, rel=0.1)
    assert offset.key == "offset_std"


def test_what_is_stated_is_no_silent_assumption():
    _, told = found(**{"deck.offset": 1e-3})
    assert "deck.offset" not in {each.effect for each in told}


def test_the_sentence_says_what_to_state():
    _, told = found()
    words = " ".join(sensitivities_in_words(told))
    assert "Assumes that `deck` stands exactly where stated, which no reading here can check" in words
    assert "1 mm of offset would move the tool by" in words
    assert "`offset_std`" in words


def test_a_result_that_claims_little_assumes_nothing_of_weight():
    best, _ = found()
    assert sensitivities(best, complete_model(best, {}, noise_size(best)), JOINTS, 10.0) == ()
