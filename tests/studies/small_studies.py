"""Studies that take a moment."""

from boresight.arm import catalogue
from boresight.calibration.campaign import Freedom
from boresight.geometry import Plane
from boresight.sensing import Cell, LaserRanger
from boresight.studies import AXES, Bench, Chosen, Settings, Study, grid

PLANES = {
    "deck": Plane.of((0.0, 1.0, 4.6), -0.69),
    "wall_x": Plane.of((-1.0, 0.15, 0.2), 1.6),
    "wall_y": Plane.of((0.1, -1.0, 0.15), 1.7),
}
WIDTHS = {"theta": 0.02, "alpha": 0.02, "a": 0.008, "d": 0.008}


def bench():
    cell = Cell(catalogue.load("space-arm"), LaserRanger(2e-4, repeats=10), targets=PLANES)
    names = [n for n in cell.index if n.startswith("j") and n != "j2.d" and n.split(".")[1] in WIDTHS]
    widths = {name: WIDTHS[name.split(".")[1]] for name in names}
    widths["deck.normal_x"] = 0.01
    return Bench(cell, tuple(Freedom(name, width, width / 3**0.5) for name, width in widths.items()))


def planes(count):
    return Chosen(str(count), tuple(PLANES)[:count])


def settings(**others):
    usual = {"planes": planes(3), "noise_std": 2e-4, "repeats": 10, "rows": 40, "solver": "least-squares"}
    return Settings(**{**usual, **others})


def small_study(seeds=4, axes=None, **others):
    points = grid({"space-arm": bench()}, {"rows": (30, 45)} if axes is None else axes, settings(**others))
    varied = tuple(axis for axis in AXES if len({point.label(axis) for point in points}) > 1)
    return Study("small", points, varied, seeds)


def point(**others):
    (only,) = small_study(1, {}, **others).points
    return only


def numbers(summary):
    """Every outcome without its time."""
    return [
        (each.point.key, seed, outcome.numbers) for each in summary.points for seed, outcome in each.outcomes.items()
    ]
