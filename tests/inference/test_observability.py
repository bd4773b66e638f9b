"""The indices against numbers worked out by hand."""

import numpy as np
import pytest

from boresight.inference import Observability, everett_count, observability


def test_indices_of_singular_values_8_and_2_in_four_configurations():
    assert observability(np.array([8.0, 2.0]), 4) == Observability(
        o1=pytest.approx(4.0 / 2.0),  # sqrt(8 * 2) / sqrt(4)
        o2=pytest.approx(0.25),
        o3=pytest.approx(2.0),
        o4=pytest.approx(0.5),  # 4 / 8
        o5=pytest.approx(1.6),  # 1 / (1/8 + 1/2)
    )


def test_one_direction_has_every_index_but_o2_at_its_own_size():
    found = observability(np.array([3.0]), 1)
    assert (found.o1, found.o2, found.o3, found.o4, found.o5) == pytest.approx((3.0, 1.0, 3.0, 3.0, 3.0))


def test_order_of_singular_values_does_not_matter():
    values = np.array([5.0, 0.5, 2.0])
    assert observability(values, 9) == observability(values[::-1], 9)


def test_measuring_everything_four_times_doubles_all_indices_but_o1_and_o2():
    once, often = observability(np.array([8.0, 2.0]), 10), observability(2.0 * np.array([8.0, 2.0]), 40)
    assert (often.o1, often.o2) == pytest.approx((once.o1, once.o2))
    assert (often.o3, often.o4, often.o5) == pytest.approx((2 * once.o3, 2 * once.o4, 2 * once.o5))


def test_nothing_seen_is_zero():
    assert observability(np.empty(0), 10) == Observability(0.0, 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("revolute", "prismatic", "count"), [(6, 0, 30), (7, 0, 34), (0, 3, 12), (5, 1, 28)])
def test_everett_counts_four_a_turn_two_a_slide_and_six(revolute, prismatic, count):
    assert everett_count(revolute, prismatic) == count
