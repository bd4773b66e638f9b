"""Compiles least squares, in a process of its own while another one compiles evolution: `python -m` this module."""

from __future__ import annotations

import numpy as np

from boresight.arm import catalogue
from boresight.geometry import Plane
from boresight.sensing import Cell, LaserRanger, Readings
from boresight.sensing.linear import model_of, triangle_of


def main() -> None:
    """Returns when all that linearises is compiled and on disk."""
    cell = Cell(catalogue.load("space-arm"), LaserRanger(1e-4), targets={"deck": Plane.of((0.0, 1.0, 4.6), -0.69)})
    one = np.ones((1, 1))
    readings = Readings(np.zeros((1, len(cell.arm.joint_names))), one, one, np.zeros(1, dtype=int), np.arange(1))
    model, x = model_of(cell, readings, ["j2.theta"]), np.zeros(1)
    model.errors(x)
    triangle_of(model, x, one)


if __name__ == "__main__":
    main()
