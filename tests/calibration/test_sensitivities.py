"""What a result hangs on that no reading can check."""

import numpy as np
import pytest
from rehearsed import measured, ranger_cell, usual_freedoms

from boresight.arm import catalogue
from boresight.calibration.complete_model import complete_model
from boresight.calibration.noise_size import noise_size
from boresight.calibration.problem import Problem
from boresight.calibration.robust import fit
from boresight.calibration.sensitivities import Sensitivity, sensitivities, sensitivities_in_words
from boresight.inference import spread_configurations
from boresight.sensing import Cell, Distances

CELL = ranger_cell(planes=1)
JOINTS = spread_configurations(CELL, 200)


def found(truth=CELL, **stated):
    freedoms = usual_freedoms(CELL)
    best = fit(Problem(CELL, measured(CELL, truth, rows=100), freedoms), np.zeros(len(freedoms)))
    return best, sensitivities(best, complete_model(best, stated, noise_size(best)), JOINTS, (1e-4, 1e-4))


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
    assert sensitivities(best, complete_model(best, {}, noise_size(best)), JOINTS, (10.0, 10.0)) == ()


def test_the_unit_of_length_of_positions_is_told_though_the_base_is_not_known():
    """A draw wire to unknown points, or distances between positions: nothing absolute is determined."""
    cell = Cell(catalogue.load("space-arm"), Distances(1e-4))
    freedoms = usual_freedoms(cell)
    best = fit(Problem(cell, measured(cell, rows=60), freedoms), np.zeros(len(freedoms)))
    known = complete_model(best, {}, noise_size(best))
    (told,) = [each for each in sensitivities(best, known, JOINTS, (np.inf, 1e-4)) if each.effect == "sensor.scale"]
    assert told.shift_m > 1e-4
    words = sensitivities_in_words((told,))[0]
    assert "Assumes that `sensor` reads without bias or scale error" in words
    assert words.endswith("Measure it by a known length to be sure of it.")


def test_slides_are_told_together():
    slides = tuple(Sensitivity(f"{name}.gain", 1e-3, "1", shift, "") for name, shift in (("x", 2e-3), ("y", 1e-3)))
    assert sensitivities_in_words(slides) == (
        "Assumes that `x` and `y` travel exactly as far as they read, which no reading here can check: 0.1 % of their "
        "unit of length would move the tool by 2.00 mm and 1.00 mm. Measure a known length to be sure of it.",
    )
