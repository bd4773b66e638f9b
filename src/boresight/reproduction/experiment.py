"""One simulated campaign of the paper's section 4: everything in it is decided by a seed and what was assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from boresight.calibration.campaign import Freedom
from boresight.calibration.problem import Problem
from boresight.geometry import Plane
from boresight.reproduction import setting
from boresight.sensing import Cell, Readings
from boresight.synthetic import draw_configurations, simulated_readings

NON_SINGULAR = 0.03
"""Smallest singular value of the tool's Jacobian (lengths in metres, an arm of about one) of a configuration that
counts as non-singular; a quarter of those drawn fall below."""

_PRESET, _VALIDATION = 101, 102
_MOST_PARTS = 400


@dataclass(frozen=True, slots=True)
class Assumptions:
    """What the paper leaves open.

    Attributes:
        preset: whether link errors are the chosen ones or drawn anew for every seed, or the plane's errors are read
            as those of (23) as printed rather than of the unit normal.
        cosine: least cosine of the angle at which a beam meets its plane.
        scope: factor on the search's half-widths of link parameters.
        azimuth: whether `j1.theta` is wrong and free too.
        walls: whether two surveyed planes are aimed at beside the deck.
    """

    preset: str = "chosen"
    cosine: float = 0.5
    scope: float = 1.0
    azimuth: bool = False
    walls: bool = False


@dataclass(frozen=True)
class Experiment:
    """A campaign with its truth.

    Attributes:
        truth: the cell that was measured.
        readings: `MOST_ROWS` rows, of which cases take the first.
        validation: (20, joints) other configurations [rad].
        problem: the problem on all rows.
    """

    truth: Cell
    readings: Readings
    validation: Float[np.ndarray, "validation joints"]
    problem: Problem

    def on(self, rows: int) -> Problem:
        """Returns the problem on the first rows."""
        return self.problem.on(np.arange(rows))


def experiment(seed: int, assumed: Assumptions | None = None) -> Experiment:
    """Returns the campaign of a seed: configurations and noise are the seed's, preset errors those of table 2.

    Calibration configurations are uniform within the joints' limits among those that are not singular and whose beams,
    nominal and real, meet the plane from at least 50 mm and not too flatly. Validation configurations are uniform
    among those that are not singular; no beam has to meet anything there.
    """
    assumed = assumed or Assumptions()
    nominal = Cell(
        setting.ARM, setting.RANGER, targets={"deck": setting.DECK} | (setting.WALLS if assumed.walls else {})
    )
    errors = preset_errors(seed, assumed, nominal)
    truth = nominal.corrected(errors)
    joints, target = _configurations(nominal, truth, assumed.cosine, seed)
    readings = simulated_readings(truth, joints, target, seed)
    problem = Problem(nominal, readings, _freedoms(nominal, errors, assumed.scope))
    return Experiment(truth, readings, _validation(nominal, seed), problem)


def preset_errors(seed: int, assumed: Assumptions, nominal: Cell) -> dict[str, float]:
    """Returns real minus nominal value [m, rad, 1] of every free parameter, in the order of eq. (19)."""
    errors = ({setting.AZIMUTH: setting.PRESET_AZIMUTH} if assumed.azimuth else {}) | setting.PRESET
    if assumed.preset == "printed":
        return errors | _printed_errors()
    if assumed.preset == "drawn":
        quantity = {parameter.name: parameter.quantity for parameter in nominal.parameters}
        random = np.random.Generator(np.random.Philox(np.random.SeedSequence((seed, _PRESET))))
        width = {name: setting.LARGEST_ERROR.get(quantity[name], 0.0) for name in errors}
        return {n: float(random.uniform(-w, w)) if (w := width[n]) else error for n, error in errors.items()}
    return errors


def _printed_errors() -> dict[str, float]:
    """Returns the unit normal's errors if those of section 4.3 are added to (0, 1, 4.6) before it is normalised."""
    x, z = (setting.PRINTED_NORMAL[f"deck.normal_{axis}"] for axis in "xz")
    real = Plane.of((x, 1.0, 4.6 + z), 0.0).normal
    return {f"deck.normal_{axis}": real[i] - setting.DECK.normal[i] for axis, i in (("x", 0), ("z", 2))}


def _freedoms(nominal: Cell, errors: dict[str, float], scope: float) -> tuple[Freedom, ...]:
    """Returns the parameters of eq. (19), bounded by the scopes, without priors."""
    quantity = {parameter.name: parameter.quantity for parameter in nominal.parameters}
    factor = {"angle": scope, "length": scope, "number": 1.0}
    return tuple(
        Freedom(name, factor[quantity[name]] * setting.SCOPE[quantity[name]], None)
        for name in nominal.index
        if name in errors
    )


def _configurations(nominal: Cell, truth: Cell, cosine: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns `MOST_ROWS` configurations and targets, the targets in turn."""
    planes = len(nominal.targets)
    each = -(-setting.MOST_ROWS // planes)
    found: list[list[np.ndarray]] = [[] for _ in range(planes)]
    for part in range(_MOST_PARTS):
        joints, target = draw_configurations((nominal, truth), 2 * setting.MOST_ROWS, seed, part)
        good = non_singular(nominal, joints)
        for cell in (nominal, truth):
            planes_of = [plane for plane in cell.targets.values() if isinstance(plane, Plane)]
            normals = np.array([plane.normal for plane in planes_of])[target]
            good &= np.abs(np.einsum("ri,ri->r", cell.poses(joints)[:, :3, 2], normals)) > cosine
        for place in range(planes):
            found[place].extend(joints[good & (target == place)])
        if min(map(len, found)) >= each:
            break
    turn = np.arange(setting.MOST_ROWS) % planes
    return np.array([found[place][row // planes] for row, place in enumerate(turn)]), turn


def _validation(nominal: Cell, seed: int) -> np.ndarray:
    random = np.random.Generator(np.random.Philox(np.random.SeedSequence((seed, _VALIDATION))))
    low, high = nominal.arm.limits.T
    drawn = random.uniform(low, high, (20 * setting.VALIDATION_ROWS, len(low)))
    return drawn[non_singular(nominal, drawn)][: setting.VALIDATION_ROWS]


def non_singular(cell: Cell, joints: Float[np.ndarray, "rows joints"]) -> np.ndarray:
    """Returns which configurations let the tool move in all six directions."""
    motion = cell.chain.linearise(joints)
    twists = motion.twists[:, [cell.index[f"{name}.theta"] for name in cell.arm.joint_names]]
    shifts = twists[:, :, :3] + np.cross(twists[:, :, 3:], motion.poses[:, None, :3, 3])
    jacobian = np.concatenate([shifts, twists[:, :, 3:]], axis=2)
    return np.linalg.svd(jacobian, compute_uv=False)[:, -1] > NON_SINGULAR
