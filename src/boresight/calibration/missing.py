"""What a fit's model lacks, looked for once it is there: constants first, then steps, then slips."""

from __future__ import annotations

from dataclasses import dataclass

from boresight.calibration.alternatives import Alternative, find_alternatives, is_bad
from boresight.calibration.campaign import Campaign
from boresight.calibration.encoder_noise import find_encoder_noise
from boresight.calibration.explanation import Explanation, explanation_in_words
from boresight.calibration.explanations import explain
from boresight.calibration.freedom import usual_within
from boresight.calibration.gross import beyond_help
from boresight.calibration.jumps import Jump, find_jumps
from boresight.calibration.robust import Fit
from boresight.inference import Accuracy
from boresight.sensing import Cell

ENOUGH = 2.0
"""An effect that brings residuals down to this many times the stated noise leaves no step to be told."""


@dataclass(frozen=True, slots=True)
class Missing:
    """What explains the residuals.

    Attributes:
        explanations: effects, the best first.
        explained: the same as sentences.
        alternatives: slips.
        jumps: steps of a sensor's level that no constant explains.
        words: sentences for a person, all of them.
    """

    explanations: tuple[Explanation, ...]
    explained: tuple[str, ...]
    alternatives: tuple[Alternative, ...]
    jumps: tuple[Jump, ...]
    words: tuple[str, ...]


def find_missing(fit: Fit, campaign: Campaign, nominal: Cell, accuracy: Accuracy, seed: int) -> Missing:
    """Returns what explains the residuals of a fit.

    Args:
        fit: the final fit.
        campaign: its campaign.
        nominal: the cell before it, frames found.
        accuracy: of the tool, as the fit has it.
        seed: of the search for frames, where a slip asks for it.
    """
    tool = accuracy.absolute if accuracy.absolute.determined else accuracy.relative
    alternatives = find_alternatives(fit, nominal, campaign, seed) if is_bad(fit, campaign.sought) else ()
    if alternatives:
        return Missing((), (), alternatives, (), tuple(each.sentence for each in alternatives))
    jumps = find_jumps(fit)
    found = explain(fit, jumps, gravity=not campaign.weightless, radius_m=tool.median)
    # What a constant explains is not told as a step at the first row that a step may begin at.
    constant = bool(found) and not found[0].effect.startswith("step") and found[0].ratio_after < ENOUGH
    jumps = () if constant else jumps
    explanations = tuple(each for each in found if not each.effect.startswith("step"))
    if jumps and found and found[0].effect.startswith("step"):
        explanations = ()
    explained = tuple(explanation_in_words(each, _line(each, campaign, nominal)) for each in explanations)
    encoder = None if beyond_help(fit) else find_encoder_noise(fit)
    noise = () if encoder is None or constant else (encoder.words,)
    return Missing(explanations, explained, (), jumps, (*explained, *noise, *(jump.words for jump in jumps)))


def _line(found: Explanation, campaign: Campaign, cell: Cell) -> str | None:
    """Returns the line of the campaign that estimates an effect; None where no parameter models it."""
    if not found.parameters or not set(found.parameters) <= set(cell.index):
        return None
    quantity = cell.parameters[cell.index[found.parameters[0]]].quantity
    if found.effect.partition(".")[0] in ("base", *cell.mounts):
        owner, _, part = found.effect.partition(".")
        parts = ", ".join(f"{each}: unknown" for each in ([part] if part else ["xyz", "rpy"]))
        return f"{owner}: {{{parts}}}"
    within = max(usual_within(cell.arm)[quantity], 2.0 * abs(found.value))
    entry = f"{{parameters: [{', '.join(found.parameters)}], within: {within:.2g}}}"
    return f"estimate: [default, {entry}]" if campaign.chosen_by_default else f"- {entry} under estimate"
