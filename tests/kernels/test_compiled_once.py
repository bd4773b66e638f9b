"""What a process compiles itself and what it loads from disk give the same numbers, to the last bit."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import hashlib
import sys
import numpy as np
sys.path.insert(0, sys.argv[1])
from random_cells import mixed_cell, near_readings, random_arm, random_cell
from boresight.arm import catalogue
from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import Problem
from boresight.compensation import compensate
from boresight.kernels.reducing import fold
from boresight.search import DifferentialEvolution, Stops, evolve

def told(name, *arrays):
    print(name, hashlib.sha256(b"".join(np.ascontiguousarray(a).tobytes() for a in arrays)).hexdigest())

rng = np.random.default_rng(0)
for rows in (30, 45, 128, 300):
    triangle = np.zeros((25, 25))
    fold(triangle, rng.random((25, rows)))
    told(f"fold {rows}", triangle)
cells = {"ranges": random_cell(rng, planes=2, arm=random_arm(rng, 6)), "all": mixed_cell(rng, random_arm(rng, 5))}
for name, cell in cells.items():
    free = tuple(Freedom(p.name, 0.02, 0.01) for p in cell.parameters if p.name.startswith("j"))
    problem = Problem(cell, near_readings(rng, cell, 41, 1e-3), free)
    x = rng.uniform(-0.01, 0.01, len(free))
    told(f"errors {name}", problem.errors(x))
    told(f"triangle {name}", problem.triangle(x).slopes)
    for cost in (problem.cost, problem.robust_cost, problem.robust_cost.single()):
        told(f"cost {name}", cost(np.array([x, -x])))
        found = evolve(cost, problem.box, DifferentialEvolution(population=50), Stops(100), seed=1)
        told(f"evolution {name}", found.history, found.population.members, found.population.costs)
arm = catalogue.load("space-arm")
found = compensate(arm, arm.corrected({"j2.theta": 1e-3}), joints=rng.uniform(-1.0, 1.0, (30, 6)))
told("reach", found.joints, found.missing)
"""


@pytest.mark.long
def test_the_first_process_on_a_machine_computes_what_later_ones_do(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", SCRIPT, str(Path(__file__).parents[1])]
    first, later = (
        subprocess.run(command, env=environment, capture_output=True, text=True, check=False) for _ in range(2)
    )
    assert first.returncode == 0, first.stderr
    assert len(first.stdout.splitlines()) == 21
    assert first.stdout.splitlines() == later.stdout.splitlines()


@pytest.mark.long
def test_what_is_compiled_beside_evolution_is_all_that_least_squares_calls(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    subprocess.run([sys.executable, "-m", "boresight.cli.warming"], env=environment, check=True)
    ask = (
        "from boresight.kernels.compiling import first_compile_ahead as ahead\n"
        "from boresight.kernels.linearising import linearise_rows, predict_rows\n"
        "from boresight.kernels.reducing import fold\n"
        "from boresight.kernels.evolving import evolve_generations\n"
        "print(*map(ahead, (linearise_rows, predict_rows, fold, evolve_generations)))"
    )
    told = subprocess.run([sys.executable, "-c", ask], env=environment, capture_output=True, text=True, check=True)
    assert told.stdout.split() == ["False", "False", "False", "True"]
