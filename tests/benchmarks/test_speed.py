"""The speed table on budgets too small to say anything: what is compared is one function, and every line is there."""

from __future__ import annotations

import importlib.util
import json
import warnings

import numpy as np
import pytest
from benchmarks.speed import batch, identification, least_squares, peak, roofline
from benchmarks.speed.cases import plain
from benchmarks.speed.claims import figures
from benchmarks.speed.gpu import parting
from benchmarks.speed.lines import HEADER, duration, table_of
from benchmarks.speed.peers import PEERS, missing
from benchmarks.speed.peers.costs import hold_to_ours, numpy_cost


@pytest.mark.parametrize("rows", [35, 100])
def test_peers_costs_are_ours(rows):
    hold_to_ours(plain(rows), members=40)


def test_batches_end_alike():
    ends = [line.end for line in batch.measure(1_000, 150, 1)]
    np.testing.assert_allclose(ends, ends[0], rtol=1e-9)


def test_blocks_of_configurations_add_up(monkeypatch):
    problem = plain(35)
    members = np.random.default_rng(2).uniform(-1e-3, 1e-3, (len(problem.names), 7))
    whole = numpy_cost(problem)(members)
    monkeypatch.setattr("benchmarks.speed.peers.costs.BLOCK", 50)
    np.testing.assert_allclose(numpy_cost(problem)(members), whole, rtol=1e-12)


def test_every_peer_that_is_installed_has_its_lines():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the peers' own
        lines = identification.measure(1, 1, generations=3)
    assert lines[0].ratio == 1.0
    for package in set(PEERS) - set(missing()):
        named = [line for line in lines if line.who.lower().startswith(package)]
        assert len(named) >= 2
        assert all(line.end > 0.0 and line.median > 0.0 for line in named)


def test_a_peer_that_is_missing_is_named_and_left_out(monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert missing() == list(PEERS)
    lines = identification.measure(1, 1, generations=1)
    assert all(line.who.startswith("Boresight") for line in lines)


def test_the_table_holds_numbers_and_targets():
    lines = least_squares.measure(35, 1)
    roof = roofline.measure(100, 0.0)
    table = table_of(lines)
    assert table.header == HEADER
    assert all(len(row) == len(HEADER) for row in table.rows)
    assert [row[0] for row in table.rows[1:]] == [""] * (len(lines) - 1)
    assert 0.0 < roof.rate < 1e12
    assert figures(lines, [roof], []) == ()
    json.dumps([line.as_values() for line in lines] + [roof.as_values()])


def test_the_peak_is_measured_in_vectors():
    assert peak.peak_rate(1e-4) > 0.0
    assert peak.vector_bits() in (64, 128, 256, 512)


def test_times_are_told_in_their_unit():
    assert [duration(s) for s in (12.3, 0.0169, 5.04e-5, 2.5e-9)] == ["12.3 s", "16.9 ms", "50.4 µs", "2.5 ns"]


def test_histories_part_where_costs_differ():
    here = np.ones((4, 2))
    there = here.copy()
    assert parting(there, here) == 4
    there[2, 0] += 1e-6
    assert parting(there, here) == 2
