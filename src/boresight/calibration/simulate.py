"""A rehearsal of a campaign: the same cell with known errors, measured in simulation (paper, section 4.2)."""

from __future__ import annotations

from dataclasses import dataclass

from boresight.calibration.campaign import Campaign
from boresight.calibration.freedom import USUAL_WITHIN, link_candidates
from boresight.sensing import Cell, Readings
from boresight.synthetic import draw_configurations, perturbed, simulated_readings, with_reachable_points

UNKNOWN_WITHIN = {"length": 0.3, "angle": 0.3, "number": 0.3}
"""How far [m, rad] a frame that the campaign calls unknown is put from the identity."""

OFFSETS_WITHIN = 0.03
"""How far [m] a session's offset is from 0: less than any range."""


@dataclass(frozen=True)
class Rehearsal:
    """A simulated campaign and its truth.

    Attributes:
        truth: the cell that was measured.
        readings: what its sensor reported.
        validation: the same for rows kept for validation.
    """

    truth: Cell
    readings: Readings
    validation: Readings


def simulate(
    campaign: Campaign, *, rows: int | None = None, validation_rows: int = 20, size: float = 1.0, seed: int = 0
) -> Rehearsal:
    """Returns readings of a cell whose errors are known.

    Every parameter that the campaign estimates is off by a uniform error within its `within`; without
    `estimate`, every link parameter by the usual errors. The campaign's own configurations are used where it
    has them and `rows` does not ask for others.

    Args:
        campaign: cell, configurations if any, and what may be wrong.
        rows: number of configurations to draw; 100 where the campaign has none.
        validation_rows: number of rows to draw for validation.
        size: factor on the errors.
        seed: of the truth, the configurations and the noise.
    """
    cell = with_reachable_points(campaign.cell, campaign.unknown, seed)
    truth = perturbed(cell, {name: size * width for name, width in _widths(campaign, cell).items()}, seed)
    both = (cell, truth) if not campaign.unknown else (truth,)
    if rows is None and campaign.readings is not None:
        joints, target = campaign.readings.joints, campaign.readings.target
    else:
        joints, target = draw_configurations(both, rows or 100, seed, part=0)
    held_out, held_target = draw_configurations(both, validation_rows, seed, part=1)
    return Rehearsal(
        truth,
        simulated_readings(truth, joints, target, seed, part=0),
        simulated_readings(truth, held_out, held_target, seed, part=1),
    )


def _widths(campaign: Campaign, cell: Cell) -> dict[str, float]:
    """Returns how far each parameter may be off; points that were put within reach stay there."""
    quantity = {parameter.name: parameter.quantity for parameter in cell.parameters}
    placed = {name for name, target in cell.targets.items() if target != campaign.cell.targets[name]}
    unknown = (name for name in campaign.unknown if name.rpartition(".")[0] not in placed)
    widths = {name: UNKNOWN_WITHIN[quantity[name]] for name in unknown}
    widths |= dict.fromkeys(cell.offsets, OFFSETS_WITHIN)
    if campaign.chosen_by_default:
        widths |= {name: 0.2 * USUAL_WITHIN[quantity[name]] for name in link_candidates(cell.arm)}
    widths |= {f.parameter: f.within for f in campaign.freedoms or () if f.within is not None}
    return {name: width for name, width in widths.items() if name not in campaign.fixed}
