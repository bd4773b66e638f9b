"""What the default freedom leaves out, and why: the other half of `freedoms_of`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from boresight.arm import Arm
from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.freedom import length_of_scale, link_candidates, usual_within
from boresight.inference import listed
from boresight.sensing import Cell, Readings
from boresight.sensing.linear import seen_by

_NAMED = 0.05
"""Parameters that explain less than this share of another are not named as its explanation."""

_SILENT = 1e-6
"""A parameter whose effect is below this share of the largest changes no reading."""


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A link parameter that is held at its nominal value although the campaign does not say so.

    Attributes:
        parameter: its name.
        reason: why, as words to stand in brackets.
    """

    parameter: str
    reason: str


def left_out(campaign: Campaign, cell: Cell, freedoms: tuple[Freedom, ...]) -> tuple[LeftOut, ...]:
    """Returns what the default choice left out; of what the campaign chose itself, the length that carries the scale.

    Args:
        campaign: with readings.
        cell: its cell, with unknown frames where they were found.
        freedoms: the choice.
    """
    free = [freedom.parameter for freedom in freedoms]
    scale = _scale(campaign, cell)
    if not campaign.chosen_by_default:
        return scale
    assert campaign.readings is not None
    held = campaign.fixed.union(out.parameter for out in scale)
    unseen = [name for name in link_candidates(cell.arm) if name not in held and name not in free]
    replaced = [out for out in _replaced(cell.arm) if out.parameter not in campaign.fixed]
    return (*scale, *replaced, *_explained(cell, campaign.readings, unseen, free))


def _scale(campaign: Campaign, cell: Cell) -> tuple[LeftOut, ...]:
    """Returns the length that is held as contacts do not see the scale, where there is one."""
    held = length_of_scale(campaign, cell)
    if held is None:
        return ()
    reason = (
        "scale is not seen: contacts with points at unknown places know no unit of length, and all other lengths are "
        "in proportion to it; state the positions of two points to see it"
    )
    return (LeftOut(held, reason),)


def left_out_in_words(out: tuple[LeftOut, ...]) -> tuple[str, ...]:
    """Returns one note that says what was left out and why, parameters with one reason together; none if nothing."""
    reasons: dict[str, list[str]] = {}
    for each in out:
        reasons.setdefault(each.reason, []).append(each.parameter)
    said = [f"{listed(names)} ({reason})" for reason, names in reasons.items()]
    return (f"Left out of the estimate: {'; '.join(said)}.",) if said else ()


def _replaced(arm: Arm) -> list[LeftOut]:
    """Returns every d for which beta stands in."""
    betas = {name.split(".")[0] for name in link_candidates(arm) if name.endswith(".beta")}
    out = []
    for place, joint in enumerate(arm.joints):
        if joint.name in betas and joint.type == "revolute":
            other = arm.joints[place + 1 if arm.convention == "standard-dh" else place - 1].name
            out.append(LeftOut(f"{joint.name}.d", f"parallel to {other}'s axis: beta stands in"))
    return out


def _explained(cell: Cell, readings: Readings, unseen: list[str], free: list[str]) -> list[LeftOut]:
    """Returns why candidates show nothing that the free parameters do not."""
    names = free + unseen
    if not unseen:
        return []
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    within = usual_within(cell.arm)
    flat = seen_by(cell, readings, names) * [within[quantity[name]] for name in names]
    chosen, rest = flat[:, : len(free)], flat[:, len(free) :]
    largest = float(np.linalg.norm(flat, axis=0).max(initial=0.0))
    parts = np.linalg.lstsq(chosen, rest, rcond=None)[0] if free else np.empty((0, len(unseen)))
    out = []
    for place, name in enumerate(unseen):
        share = np.abs(parts[:, place])
        causes = [free[i] for i in np.argsort(-share, kind="stable") if share[i] > _NAMED * share.max()]
        if np.linalg.norm(rest[:, place]) <= _SILENT * largest or not causes:
            out.append(LeftOut(name, "changes no reading"))
        else:
            verb = "does" if len(causes) == 1 else "do"
            out.append(LeftOut(name, f"changes no reading that {listed(causes, 4)} {verb} not explain"))
    return out
