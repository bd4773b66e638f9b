"""What decides the outcomes of a point, as one digest: the name under which they are kept."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from boresight.calibration.campaign import Freedom
from boresight.sensing import Cell

RUN_FORMAT = 2
"""Grows when a run of the same point and seed gives other numbers than before, so that old ones are not mixed in."""


def key_of(
    cell: Cell,
    freedoms: tuple[Freedom, ...],
    joints: np.ndarray | None,
    target: np.ndarray | None,
    numbers: Mapping[str, Any],
) -> str:
    """Returns 24 hexadecimal digits that change with anything that changes an outcome.

    Args:
        cell: the nominal cell; the arm's own name does not matter, its joints' names do.
        freedoms: what is wrong and estimated.
        joints: configurations that are not drawn.
        target: their targets.
        numbers: plain settings.
    """
    content = {
        "format": RUN_FORMAT,
        "convention": cell.arm.convention,
        "joints": [asdict(joint) for joint in cell.arm.joints],
        "root": asdict(cell.arm.root),
        "tip": asdict(cell.arm.tip),
        "gravity": list(cell.arm.gravity),
        "sensors": {name: {"type": each.type, **asdict(each)} for name, each in cell.sensors.items()},  # type: ignore[call-overload]
        "base": asdict(cell.base),
        "mounts": {name: asdict(frame) for name, frame in cell.mounts.items()},
        "targets": {name: asdict(target) for name, target in cell.targets.items()},
        "freedoms": [[f.parameter, f.within, f.prior_std] for f in freedoms],
        "configurations": None if joints is None or target is None else [joints.tolist(), target.tolist()],
        "settings": dict(numbers),
    }
    text = json.dumps(content, sort_keys=True, default=float)
    return hashlib.sha256(text.encode()).hexdigest()[:24]
