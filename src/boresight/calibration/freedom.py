"""Which parameters are free: those the campaign names, or the most that the data can see."""

from __future__ import annotations

import math

from boresight.arm import LINK_NUMBERS, Arm
from boresight.arm.conventions import NEARLY_PARALLEL
from boresight.calibration.campaign import Campaign, Freedom
from boresight.calibration.scale_held import scale_held
from boresight.inference import select_visible
from boresight.sensing import Cell, Readings
from boresight.sensing.linear import seen_by
from boresight.units import Quantity

USUAL_WITHIN: dict[Quantity, float] = {"angle": 0.05, "length": 0.02, "number": 0.02}
"""Half-width of the search [rad, m, 1] where the campaign names no parameters: several times the errors that
assembly, transport and temperature leave on arms of up to `USUAL_REACH`."""

USUAL_REACH = 2.0
"""Reach [m] beyond which errors of lengths grow with the arm."""


def usual_within(arm: Arm) -> dict[Quantity, float]:
    """Returns the half-width of the search [rad, m, 1] for an arm: lengths of 10 m may be off by five times more."""
    return {**USUAL_WITHIN, "length": USUAL_WITHIN["length"] * max(1.0, arm.reach / USUAL_REACH)}


def freedoms_of(campaign: Campaign, cell: Cell) -> tuple[Freedom, ...]:
    """Returns the free parameters of a campaign, unknown frames first.

    Args:
        campaign: what was asked for.
        cell: its cell, with unknown frames where they were found.
    """
    first = _asked(campaign, cell)
    held = _carries_scale(campaign, cell, first)
    first = tuple(freedom for freedom in first if freedom.parameter != held)
    if not campaign.chosen_by_default:
        return first
    assert campaign.readings is not None
    return _visible(cell, campaign.readings, first, campaign, held)


def length_of_scale(campaign: Campaign, cell: Cell) -> str | None:
    """Returns the length that a campaign holds since its readings do not see the arm's scale; None where they do."""
    return _carries_scale(campaign, cell, _asked(campaign, cell))


def _carries_scale(campaign: Campaign, cell: Cell, first: tuple[Freedom, ...]) -> str | None:
    if campaign.readings is None:
        return None
    named = {freedom.parameter for freedom in first}
    links = set(link_candidates(cell.arm)) - campaign.fixed if campaign.chosen_by_default else set()
    return scale_held(cell, campaign.readings, tuple(name for name in cell.index if name in named | links))


def _asked(campaign: Campaign, cell: Cell) -> tuple[Freedom, ...]:
    """Returns what a campaign names, unknown frames first."""
    sought = campaign.sought - campaign.fixed
    frames = tuple(Freedom(name, None, campaign.priors.get(name)) for name in cell.index if name in sought)
    asked = {f.parameter: f for f in campaign.freedoms or () if f.parameter not in campaign.fixed | campaign.sought}
    return frames + tuple(asked[name] for name in cell.index if name in asked)


def link_candidates(arm: Arm) -> list[str]:
    """Returns the link parameters that can be independent, the more physical first.

    Every theta, a and alpha; d, or beta in its place where the joint's axis is nearly parallel to the next.
    """
    standing_in = {joint.name for joint, parallel in zip(arm.joints, _parallel(arm), strict=True) if parallel}
    chosen = []
    for number in LINK_NUMBERS:
        for joint in arm.joints:
            if number == "d" and joint.name in standing_in and joint.type == "revolute":
                continue
            if number == "beta" and joint.name not in standing_in:
                continue
            chosen.append(f"{joint.name}.{number}")
    return chosen


def _parallel(arm: Arm) -> list[bool]:
    """Returns for each joint whether the next axis (standard) or the one before (modified) is nearly parallel."""
    count = len(arm.joints)
    related = range(count - 1) if arm.convention == "standard-dh" else range(1, count)
    return [
        i in related and abs(math.sin(joint.alpha)) < math.sin(NEARLY_PARALLEL) for i, joint in enumerate(arm.joints)
    ]


def _visible(
    cell: Cell, readings: Readings, first: tuple[Freedom, ...], campaign: Campaign, held: str | None
) -> tuple[Freedom, ...]:
    """Returns what comes first and every link parameter that shows something the ones before it do not."""
    within = usual_within(cell.arm)
    usual = {p.name: within[p.quantity] for p in cell.parameters}
    before = [freedom.parameter for freedom in first]
    left = campaign.fixed.union(before, [held] if held else [])
    links = [name for name in link_candidates(cell.arm) if name not in left]
    names = before + links
    seen = seen_by(cell, readings, names)
    chosen = {names[i] for i in select_visible(seen * [usual[name] for name in names], list(range(len(names))))}
    return first + tuple(
        Freedom(name, usual[name], campaign.priors.get(name, usual[name] / math.sqrt(3.0)))
        for name in cell.index
        if name in chosen & set(links)
    )
