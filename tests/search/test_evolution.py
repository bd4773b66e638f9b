"""Differential evolution: values, strategies, bounds and replay."""

from dataclasses import replace

import numpy as np
import pytest

from boresight.search import STRATEGIES, Box, DifferentialEvolution, Outcome, Stops, ask, evolve, seed_population, tell

BOX = Box(np.full(6, -2.0), np.full(6, 3.0))


def sphere(members):
    return np.sum((members - 0.5) ** 2, axis=1)


def evaluated(settings, seed=3):
    population = seed_population(settings, BOX, seed)
    return tell(population, ask(settings, BOX, population), sphere(population.members))


@pytest.mark.parametrize("strategy", STRATEGIES.values(), ids=STRATEGIES)
def test_every_strategy_finds_the_bottom_of_a_bowl(strategy):
    found = evolve(sphere, BOX, DifferentialEvolution(strategy, 60), Stops(600, cost=1e-8), seed=1)
    assert found.outcome is Outcome.COST
    assert np.allclose(found.best, 0.5, atol=1e-3)


def test_the_same_seed_replays_and_another_does_not():
    first, again, other = (evolve(sphere, BOX, stops=Stops(20), seed=seed) for seed in (5, 5, 6))
    assert np.array_equal(first.best, again.best)
    assert np.array_equal(first.history, again.history)
    assert not np.array_equal(first.best, other.best)


def test_another_run_of_the_same_seed_draws_other_numbers():
    assert not np.array_equal(
        seed_population(DifferentialEvolution(), BOX, 1, run=0).members,
        seed_population(DifferentialEvolution(), BOX, 1, run=1).members,
    )


def test_a_generation_can_be_asked_for_twice():
    population = evaluated(DifferentialEvolution(population=40))
    assert np.array_equal(
        ask(DifferentialEvolution(population=40), BOX, population),
        ask(DifferentialEvolution(population=40), BOX, population),
    )


def test_telling_changes_no_value_that_was_given():
    settings = DifferentialEvolution(population=40)
    population = evaluated(settings)
    before = population.members.copy()
    trials = ask(settings, BOX, population)
    tell(population, trials, sphere(trials))
    assert np.array_equal(population.members, before)


def test_no_member_ever_gets_worse_or_leaves_the_box():
    settings = DifferentialEvolution(population=40)
    population = evaluated(settings)
    for _ in range(50):
        trials = ask(settings, BOX, population)
        assert np.all(trials >= BOX.lower)
        assert np.all(trials <= BOX.upper)
        after = tell(population, trials, sphere(trials))
        assert np.all(after.costs <= population.costs)
        assert np.allclose(after.costs, sphere(after.members))
        population = after


def test_an_optimum_on_the_bound_is_reached():
    at_corner = evolve(lambda members: np.sum((members - 3.0) ** 2, axis=1), BOX, stops=Stops(300), seed=2)
    assert np.allclose(at_corner.best, 3.0, atol=1e-3)


def test_nan_and_infinite_costs_never_become_the_best():
    def holed(members):
        costs = sphere(members)
        costs[members[:, 0] > 0.5] = np.nan
        costs[members[:, 1] > 2.5] = np.inf
        return costs

    found = evolve(holed, BOX, stops=Stops(200), seed=4)
    assert np.isfinite(found.cost)
    assert found.best[0] <= 0.5


def test_the_definitions_of_the_paper():
    """Eq. 14 to 16 with CR = 1: every trial inside the box is its strategy's own combination of members."""
    for name, combine in {
        "rand/1": lambda x, best, a, b, c: a + 0.6 * (b - c),
        "best/1": lambda x, best, a, b, c: best + 0.6 * (b - c),
        "trade-off": lambda x, best, a, b, c: a + 0.5 * (best - a) + 0.6 * (b - c),
        "rand-to-best/1": lambda x, best, a, b, c: a + 0.6 * (best - a) + 0.6 * (b - c),
        "current-to-best/1": lambda x, best, a, b, c: x + 0.6 * (best - x) + 0.6 * (b - c),
    }.items():
        settings = DifferentialEvolution(STRATEGIES[name], 6, crossover=1.0)
        wide = Box(np.full(3, -1e6), np.full(3, 1e6))
        population = seed_population(settings, wide, 1)
        population = tell(population, population.members, sphere(np.resize(population.members, (6, 3))))
        members, best, trials = population.members, population.best, ask(settings, wide, population)
        inside = 0
        for i, trial in enumerate(trials):
            others = [k for k in range(6) if k != i]
            options = [
                combine(members[i], best, members[a], members[b], members[c])
                for a in others
                for b in others
                for c in others
                if len({a, b, c}) == 3
            ]
            matches = [np.isclose(option, trial, rtol=1e-9, atol=1e-3) for option in options]
            redrawn = [np.abs(option) > 1e6 for option in options]
            assert any(np.all(match | outside) for match, outside in zip(matches, redrawn, strict=True)), name
            inside += any(match.all() for match in matches)
        assert inside, name


def test_a_downhill_difference_points_from_the_dearer_to_the_cheaper_of_two_members():
    """CR = 1, no leader but the best, F fixed: every trial is x + K (best - x) + F (b - c) with b below c."""
    strategy = replace(STRATEGIES["downhill"], elite=0.0, spread=0.0)
    settings, wide = DifferentialEvolution(strategy, 6, crossover=1.0), Box(np.full(3, -1e6), np.full(3, 1e6))
    population = seed_population(settings, wide, 1)
    population = tell(population, population.members, np.arange(6.0))
    members, found = population.members, 0
    for i, trial in enumerate(ask(settings, wide, population)):
        pulled = members[i] + 0.3 * (members[0] - members[i])
        options = [
            pulled + settings.scale * (members[b] - members[c])
            for b in range(6)
            for c in range(b + 1, 6)
            if i not in (b, c)
        ]
        matches = [np.isclose(option, trial, rtol=1e-9, atol=1e-3) for option in options]
        redrawn = [np.abs(option) > 1e6 for option in options]
        assert any(np.all(match | outside) for match, outside in zip(matches, redrawn, strict=True))
        found += any(match.all() for match in matches)
    assert found


def test_mutants_are_drawn_to_every_leader_and_to_nobody_else():
    """K = 1, F = 0: a mutant is its leader."""
    strategy = replace(STRATEGIES["downhill"], pull=1.0, elite=0.1, spread=0.0)
    settings = DifferentialEvolution(strategy, 50, scale=0.0, crossover=1.0)
    population = evaluated(settings)
    leaders = population.members[np.argsort(population.costs)[:5]]
    drawn_to = np.array([[np.allclose(trial, one) for one in leaders] for trial in ask(settings, BOX, population)])
    assert np.all(drawn_to.sum(axis=1) == 1)
    assert np.all(drawn_to.any(axis=0))


def test_f_varies_from_mutant_to_mutant_within_the_spread():
    strategy = replace(STRATEGIES["rand/1"], from_current=True, spread=0.2)
    settings = DifferentialEvolution(strategy, 400, scale=0.5, crossover=1.0)
    box = Box(np.array([-1e9]), np.array([1e9]))
    population = seed_population(settings, box, 1)
    middle = np.where(np.arange(400) % 2, 1.0, -1.0)[:, None]
    population = tell(replace(population, members=middle + 0.0), middle, np.zeros(400))
    steps = np.abs(ask(settings, box, population) - population.members)
    scales = steps[steps > 0.0] / 2.0  # members are 0 or 2 apart
    assert 0.3 <= scales.min() < 0.32
    assert 0.68 < scales.max() <= 0.7


def test_what_a_strategy_was_tuned_with_is_used_unless_told_otherwise():
    tuned, paper = DifferentialEvolution(STRATEGIES["downhill"]), DifferentialEvolution()
    assert (tuned.population, tuned.scale, tuned.crossover) == (120, 0.565, 0.99)
    assert (paper.population, paper.scale, paper.crossover) == (150, 0.6, 0.9)
    assert DifferentialEvolution(STRATEGIES["downhill"], 40, crossover=0.0).crossover == 0.0


def test_crossover_always_takes_one_component_of_the_mutant():
    settings = DifferentialEvolution(population=30, crossover=0.0)
    population = evaluated(settings)
    changed = np.count_nonzero(ask(settings, BOX, population) != population.members, axis=1)
    assert np.all(changed == 1)


def test_crossover_takes_the_share_it_is_told_to():
    settings = DifferentialEvolution(population=2000, crossover=0.3)
    population = evaluated(settings)
    share = np.mean(ask(settings, BOX, population) != population.members)
    assert share == pytest.approx(0.3 + 0.7 / 6, abs=0.015)


def test_a_search_says_why_it_stopped():
    assert evolve(sphere, BOX, stops=Stops(5), seed=1).outcome is Outcome.GENERATIONS
    assert evolve(sphere, BOX, stops=Stops(500, cost=0.1), seed=1).outcome is Outcome.COST
    flat = evolve(lambda members: np.ones(len(members)), BOX, stops=Stops(500, patience=10), seed=1)
    assert flat.outcome is Outcome.STAGNATION
    assert len(flat.history) == 11


def test_history_has_a_row_a_generation_and_never_rises():
    found = evolve(sphere, BOX, stops=Stops(40), seed=1)
    assert found.history.shape == (41, 2)
    assert np.all(np.diff(found.history[:, 0]) <= 0)
    assert found.history[-1, 0] == found.cost
    assert found.evaluations == 41 * 150


def test_progress_is_reported_to_the_last_generation():
    seen = []
    evolve(sphere, BOX, stops=Stops(30), seed=1, on_progress=lambda generation, cost: seen.append((generation, cost)))
    assert seen[-1][0] == 30
    assert [generation for generation, _ in seen] == sorted({generation for generation, _ in seen})


def test_too_small_a_population_is_refused():
    with pytest.raises(ValueError, match="at least 5"):
        DifferentialEvolution(population=4)
