"""A result as plain data: the text of `result.json`."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from boresight.arm.serial import corrected_chain
from boresight.calibration.beyond import Beyond
from boresight.calibration.explanation import Explanation
from boresight.calibration.result import ErrorSummary, Residuals, Result
from boresight.calibration.solve import Stage
from boresight.geometry import Frame, Plane
from boresight.inference import PoseUncertainty, ToolAccuracy
from boresight.inference.pose import COVERAGE
from boresight.sensing import Target

SCHEMA = "boresight-result/1"
"""Name and version of the layout; the number grows when a key changes its meaning or goes."""


def result_document(result: Result, version: str, files: Mapping[str, str] = MappingProxyType({})) -> dict[str, Any]:
    """Returns a result as dictionaries, lists, numbers and strings; lengths in m, angles in rad.

    Args:
        result: the result.
        version: of the software that made it.
        files: SHA-256 of each file beside it, by name.
    """
    return {
        "schema": SCHEMA,
        "name": result.name,
        "version": version,
        "seed": result.solver.seed,
        "verdict": {
            "accepted": result.verdict.accepted,
            "accepted_for": result.verdict.accepted_for,
            "reasons": list(result.verdict.reasons),
        },
        "accuracy": {name: _accuracy(getattr(result.accuracy, name)) for name in ("absolute", "relative")},
        "explanations": [_explanation(each) for each in result.explanations],
        "alternatives": [
            {
                "effect": each.effect,
                "words": each.words,
                "ratio_before": _number(each.ratio_before),
                "ratio_after": _number(each.ratio_after),
            }
            for each in result.alternatives
        ],
        "sensitivities": [
            {
                "effect": each.effect,
                "amount": each.amount,
                "unit": each.unit,
                "tool_shift": each.shift_m,
                "tool_shift_unit": "m",
                "key": each.key,
            }
            for each in result.sensitivities
        ],
        "assumed": list(result.assumed),
        "priors": dict(result.priors),
        "residuals": {
            "calibration": _residuals(result.calibration),
            "validation": _residuals(result.validation),
            "by_sensor": [
                {
                    "sensor": each.sensor,
                    "what": each.what,
                    "unit": each.unit,
                    "count": each.rows,
                    "stated_std": each.stated_std,
                    "before": _summary(each.before),
                    "after": _summary(each.after),
                }
                for each in result.by_sensor
            ],
        },
        "parameters": [
            {
                "name": estimate.name,
                "unit": estimate.unit,
                "nominal": estimate.nominal,
                "identified": estimate.identified,
                "correction": estimate.correction,
                "std": estimate.std,
                "half_width_95": estimate.half_width_95,
                "conditional_std": estimate.conditional_std,
                "source": estimate.source,
            }
            for estimate in result.estimates
        ],
        "identifiability": {
            "free": result.free,
            "rank": result.rank,
            "unseen": [{"parameters": list(unseen.parameters), "words": unseen.words} for unseen in result.unseen],
        },
        "noise": {
            "unit": "m",
            "stated_std": result.stated_std,
            "model_std": result.model_std,
            "chi_square": _number(result.noise.chi_square),
            "degrees_of_freedom": result.noise.freedom,
        },
        "beyond_geometry": _beyond(result.beyond),
        "frames": {name: _frame(frame) for name, frame in {"base": result.cell.base, **result.cell.mounts}.items()},
        "targets": {name: _target(target) for name, target in result.cell.targets.items()},
        "correlations": [
            {"parameters": [first, second], "correlation": value} for first, second, value in result.correlations()
        ],
        "pose_uncertainty": {"rows": _pose(result.at_rows), "workspace": _pose(result.in_workspace)},
        "outliers": [
            {
                "line": outlier.line,
                "residual": _number(outlier.residual_m),
                "unit": "m",
                "ratio": _number(outlier.ratio),
                "reason": outlier.reason,
            }
            for outlier in result.outliers
        ],
        "jumps": [
            {
                "sensor": jump.sensor,
                "channel": jump.channel,
                "line": jump.line,
                "session": jump.session,
                "size": jump.size,
                "std": jump.std,
                "unit": "rad" if jump.angle else "m",
            }
            for jump in result.jumps
        ],
        "set_aside": [{"file": row.file, "line": row.line, "reason": row.reason} for row in result.set_aside],
        "warnings": list(result.warnings),
        "notes": list(result.notes),
        "search": _search(result),
        "urdf": _urdf(result),
        "inputs": dict(result.inputs),
        "files": dict(files),
    }


def result_json(result: Result, version: str, files: Mapping[str, str]) -> str:
    """Returns the text of `result.json`; see `result_document`."""
    return json.dumps(result_document(result, version, files), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _beyond(beyond: Beyond | None) -> dict[str, Any] | None:
    """Returns what was tried beyond geometry on rows left out of the fits; None where nothing was."""
    if beyond is None:
        return None
    return {
        "unit": "m",
        "used": list(beyond.chosen),
        "trials": [
            {"terms": list(trial.terms), "rms": trial.rms_m, "advantage_in_standard_errors": trial.advantage}
            for trial in beyond.trials
        ],
        "learned_std": dict(beyond.learned),
    }


def _residuals(residuals: Residuals) -> dict[str, Any]:
    return {
        "unit": "m",
        "count": residuals.count,
        "missed": residuals.missed,
        "method": residuals.method,
        "before": _summary(residuals.before),
        "after": _summary(residuals.after),
    }


def _summary(summary: ErrorSummary) -> dict[str, float | None]:
    return {"rms": _number(summary.rms), "mean": _number(summary.mean), "max": _number(summary.max)}


def _accuracy(accuracy: ToolAccuracy) -> dict[str, Any]:
    """Returns one accuracy of the tool: 95 % radii of the position, None where readings do not determine it."""
    return {
        "unit": "m",
        "determined": accuracy.determined,
        "radius_95": {
            "median": _number(accuracy.median),
            "max": _number(float(np.max(accuracy.pose.position_95))),
            "before": accuracy.prior,
        },
        "share_from_readings": _number(accuracy.noise_share),
    }


def _explanation(found: Explanation) -> dict[str, Any]:
    return {
        "effect": found.effect,
        "parameters": list(found.parameters),
        "value": found.value,
        "std": found.std,
        "unit": found.unit,
        "numbers": found.numbers,
        "ratio_before": _number(found.ratio_before),
        "ratio_after": _number(found.ratio_after),
        "left_out_before": found.left_out_before,
        "left_out_after": found.left_out_after,
        "tool_shift": _number(found.tool_m),
        "tool_shift_unit": "m",
    }


def _pose(uncertainty: PoseUncertainty) -> dict[str, Any]:
    """Returns the tool's uncertainty over some configurations: root mean square and worst, k = 2 beside k = 1.

    What readings do not determine is None.
    """
    return {
        "count": len(uncertainty.joints),
        "orientation_of": "beam" if uncertainty.beam_alone else "tool",
        "position": _spread("m", uncertainty.position_std, uncertainty.position_95),
        "orientation": _spread("rad", uncertainty.orientation_std, uncertainty.orientation_95),
    }


def _spread(unit: str, std: np.ndarray, radius_95: np.ndarray) -> dict[str, Any]:
    typical = float(np.sqrt(np.mean(std**2)))
    return {
        "unit": unit,
        "standard": _number(typical),
        "expanded": _number(COVERAGE * typical),
        "radius_95": {"median": _number(float(np.median(radius_95))), "max": _number(float(np.max(radius_95)))},
    }


def _search(result: Result) -> dict[str, Any]:
    solver, solution = result.solver, result.solution
    evolution = solver.evolution
    return {
        "solver": solver.name,
        "strategy": evolution.strategy.name,
        "population": evolution.population,
        "F": evolution.scale,
        "CR": evolution.crossover,
        "K": evolution.scale if evolution.strategy.pull is None else evolution.strategy.pull,
        "generations": {"limit": solver.stops.generations, "run": max(len(solution.history) - 1, 0)},
        "device": str(solver.device),
        "stages": [_stage(stage) for stage in solution.stages],
        "least_squares_from_nominal": None if solution.nominal is None else _stage(solution.nominal),
        "least_squares_from_nominal_suffices": solution.nominal_suffices,
    }


def _stage(stage: Stage) -> dict[str, Any]:
    return {
        "name": stage.name,
        "cost": _number(stage.cost),
        "rms": _number(stage.rms_m),
        "unit": "m",
        "seconds": round(stage.seconds, 6),
        "evaluations": stage.evaluations,
        "outcome": stage.outcome,
    }


def _urdf(result: Result) -> dict[str, Any] | None:
    """Returns the origins of the joints on the way from base to tip, before and after; None without a URDF."""
    if result.robot_file is None:
        return None
    chain = result.robot_file.chain
    corrected = corrected_chain(chain, result.nominal.arm, result.cell.arm)
    return {
        "file": result.robot_file.name,
        "base": chain.base,
        "tip": chain.tip,
        "origins": [
            {"joint": was.name, "type": was.type, "nominal": _frame(was.origin), "identified": _frame(now.origin)}
            for was, now in zip(chain.joints, corrected.joints, strict=True)
        ],
    }


def _target(target: Target) -> dict[str, Any]:
    if isinstance(target, Plane):
        return {"normal": list(target.normal), "offset": target.offset}
    return {"position": list(target.xyz)}


def _frame(frame: Frame) -> dict[str, list[float]]:
    return {"xyz": list(frame.xyz), "rpy": list(frame.rpy)}


def _number(value: float) -> float | None:
    """Returns a number that JSON has: infinities and NaN have none."""
    return float(value) if math.isfinite(value) else None
