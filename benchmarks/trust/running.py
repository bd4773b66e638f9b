"""One run: a campaign written, loaded and calibrated with the product's defaults, and judged."""

from __future__ import annotations

import tempfile
import time
import traceback
import warnings
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.trust.campaign_files import write_campaign
from benchmarks.trust.case import Case, draw
from benchmarks.trust.claims import Claims, claims_of
from benchmarks.trust.judging import aligning_turn, beam_errors, outcome_of, position_errors, rms, turn_errors
from benchmarks.trust.scenarios import SCENARIOS


@dataclass(frozen=True)
class Record:
    """What one run came to; lengths in metres, root mean squares over the configurations, None without a result.

    Attributes:
        scenario, seed: which run.
        outcome: one of `OUTCOMES`.
        accuracy: which one it is accepted for.
        before: true error of the nominal arm, of the same accuracy.
        error, claimed: true error and claimed radius of the accuracy that is judged.
        ratio: of the two.
        inside: share of configurations whose error is within their own radius.
        absolute, relative: true errors, whichever is judged.
        angle_ratio: true error of orientation over claimed.
        named: where the true cause is named.
        explanations, sensitivities: effects, best first.
        sentences: warnings and reasons; the error where there is no result.
        seconds: of loading and calibrating.
    """

    scenario: str
    seed: int
    outcome: str
    accuracy: str = ""
    before: float | None = None
    error: float | None = None
    claimed: float | None = None
    ratio: float | None = None
    inside: float | None = None
    absolute: float | None = None
    relative: float | None = None
    angle_ratio: float | None = None
    named: tuple[str, ...] = ()
    explanations: tuple[str, ...] = ()
    sensitivities: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()
    seconds: float = 0.0

    def as_json(self) -> dict[str, object]:
        """Returns everything as plain values."""
        return asdict(self)


def run_one(task: tuple[str, int]) -> Record:
    """Returns the record of a scenario's name and a seed."""
    from boresight.calibration import calibrate
    from boresight.errors import BoresightError
    from boresight.files import load_campaign

    name, seed = task
    case = draw(SCENARIOS[name], seed)
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path = write_campaign(case, Path(folder))
        try:
            result = calibrate(load_campaign(path, need_readings=True))
        except BoresightError as error:
            return Record(name, seed, "rejected", sentences=(str(error),), seconds=time.perf_counter() - began)
        except Exception:
            return Record(name, seed, "crash", sentences=(traceback.format_exc(),), seconds=time.perf_counter() - began)
    return judged(case, seed, claims_of(result), time.perf_counter() - began)


def judged(case: Case, seed: int, claims: Claims, seconds: float) -> Record:
    """Returns the record of what a result claims."""
    fault = case.scenario.fault
    place, turn = case.true_poses(claims.joints)
    errors = position_errors(claims.position, place)
    before = position_errors(case.nominal.poses(claims.joints)[0], place)
    error = errors[claims.accuracy]
    named = claims.names(fault.effects, fault.words)
    ratio = rms(error) / max(rms(claims.radius), 1e-12)
    turned = beam_errors if claims.beam_alone else turn_errors
    align = aligning_turn(claims.position, place) if claims.accuracy == "relative" else np.eye(3)
    return Record(
        case.scenario.name,
        seed,
        outcome_of(claims.accepted, ratio, bool(named)),
        claims.accuracy,
        before=rms(before[claims.accuracy]),
        error=rms(error),
        claimed=rms(claims.radius),
        ratio=ratio,
        inside=float(np.mean(error <= claims.radius)),
        absolute=rms(errors["absolute"]),
        relative=rms(errors["relative"]),
        angle_ratio=rms(turned(align @ claims.orientation, turn)) / max(rms(claims.angle), 1e-12),
        named=named,
        explanations=claims.explanations,
        sensitivities=claims.sensitivities,
        sentences=claims.sentences,
        seconds=seconds,
    )
