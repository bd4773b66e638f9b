"""Makes the folders `panda` and `canadarm2`: known arms with errors, measured in MuJoCo. Nothing of Boresight is in it.

    pip install mujoco
    python examples/make_arms.py

The links are written straight from their published D-H numbers as MJCF bodies; multiplying up, weights and ray casting
are MuJoCo's. The Panda stands on the ground before a laser tracker and gives way under its own weight: joints are
springs, links have masses and centres of mass, and it is measured where both balance. Canadarm2 is in orbit and
carries a ranger.
"""

import json
import math
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).parent
QUARTER = math.pi / 2


@dataclass(frozen=True)
class Setup:
    """What is measured.

    `links` has (theta, d, a, alpha) a joint [rad, m], modified D-H (Craig) or standard; `beta` names the links that are
    parallel to the next axis, where it stands for d. `shift` and `turn` are the largest errors [m, rad].
    """

    folder: str
    names: tuple
    links: np.ndarray
    modified: bool
    limits: np.ndarray
    beta: tuple
    shift: float
    turn: float
    mount: tuple
    noise: float
    rows: int
    validation: int
    planes: dict
    ranges: tuple = (0.5, 12.0)
    masses: np.ndarray | None = None
    base: tuple = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


PANDA = Setup(
    folder="panda",
    names=tuple(f"panda_joint{k}" for k in range(1, 8)),
    links=np.array(
        [
            (0, 0.333, 0, 0),
            (0, 0, 0, -QUARTER),
            (0, 0.316, 0, QUARTER),
            (0, 0, 0.0825, QUARTER),
            (0, 0.384, -0.0825, -QUARTER),
            (0, 0, 0, QUARTER),
            (0, 0.107, 0.088, QUARTER),
        ]
    ),
    modified=True,
    limits=0.9
    * np.array([(-2.9, 2.9), (-1.76, 1.76), (-2.9, 2.9), (-3.07, -0.07), (-2.9, 2.9), (0.0, 3.75), (-2.9, 2.9)]),
    beta=(),
    shift=0.0008,
    turn=0.0015,
    mount=((0.03, 0.02, 0.08), (0.0, 0.0, 0.0)),
    noise=0.00003,
    rows=120,
    validation=100,
    planes={},
    masses=np.array([4.9, 4.6, 3.2, 3.5, 3.3, 1.6, 2.7]),
    base=((2.1, -0.6, 0.2), (0.0, 0.0, 2.1)),
)

CANADARM2 = Setup(
    folder="canadarm2",
    names=("shoulder_roll", "shoulder_yaw", "shoulder_pitch", "elbow_pitch", "wrist_pitch", "wrist_yaw", "wrist_roll"),
    links=np.array(
        [
            (0, 1.3589, 0, QUARTER),
            (-QUARTER, 0.7026, 0, QUARTER),
            (2 * QUARTER, -0.5692, 7.11, 0),
            (0, -0.475, 7.11, 0),
            (0, -0.5692, 0, QUARTER),
            (QUARTER, -0.7026, 0, QUARTER),
            (0, 1.3589, 0, 0),
        ]
    ),
    modified=False,
    limits=np.tile((-math.pi, math.pi), (7, 1)),
    beta=(2, 3),
    shift=0.008,
    turn=0.003,
    mount=((0.3, 0.0, 0.2), (0.0, 0.35, 0.0)),
    noise=0.001,
    rows=100,
    validation=60,
    planes={
        "truss": ((0.0, 0.2, 1.0), 9.0),
        "module": ((-1.0, 0.15, 0.2), 14.0),
        "radiator": ((0.1, -1.0, 0.15), 15.0),
    },
)


def quat(axis, angle):
    """Returns the attribute of a body turned about an axis."""
    numbers = [math.cos(angle / 2), 0.0, 0.0, 0.0]
    numbers[1 + "xyz".index(axis)] = math.sin(angle / 2)
    return f'quat="{" ".join(map(repr, numbers))}"'


def nested(steps, inside):
    """Returns bodies in bodies: of each step (attribute or joint) everything after it."""
    for step in reversed(steps):
        inside = f"<body>{step}{inside}</body>" if step.startswith("<") else f"<body {step}>{inside}</body>"
    return inside


def frame_steps(xyz, rpy):
    """Returns the steps to a frame: Tx Ty Tz Rz(yaw) Ry(pitch) Rx(roll)."""
    place = f'pos="{" ".join(map(repr, map(float, xyz)))}"'
    return [place, quat("z", rpy[2]), quat("y", rpy[1]), quat("x", rpy[0])]


def mjcf(setup, links, beta):
    """Returns the cell: joints, planes that are two-sided and each in a group of its own, and the sensor's site."""
    hinge = '<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint type="hinge" axis="0 0 1"/>'
    steps = frame_steps(*setup.base)
    for k, (theta, d, a, alpha) in enumerate(links):
        fixed = [f'pos="{float(a)!r} 0 0"', quat("x", float(alpha)), quat("y", float(beta[k]))]
        moving = [hinge, quat("z", float(theta)), f'pos="0 0 {float(d)!r}"']
        steps += [*fixed[1:2], *fixed[:1], *moving] if setup.modified else [*moving, *fixed]
    steps += frame_steps(*setup.mount)
    faces = ""
    for k, (normal, offset) in enumerate(setup.planes.values()):
        n = np.array(normal) / np.linalg.norm(normal)
        place = " ".join(map(repr, (-offset / np.linalg.norm(normal) * n).tolist()))
        for side in (1.0, -1.0):
            up = " ".join(map(repr, (side * n).tolist()))
            faces += f'<geom type="plane" size="0 0 1" group="{k}" pos="{place}" zaxis="{up}"/>'
    options = '<compiler angle="radian" autolimits="false"/><option gravity="0 0 -9.81"/>'
    arm = nested(steps, '<site name="sensor"/>')
    return f"<mujoco>{options}<worldbody>{faces}{arm}</worldbody></mujoco>"


class Cell:
    """The true cell."""

    def __init__(self, setup, links, beta, random):
        self.setup, self.model = setup, mujoco.MjModel.from_xml_string(mjcf(setup, links, beta))
        self.stiffness, moving = None, self.model.jnt_bodyid
        if setup.masses is None:
            self.model.opt.gravity[:] = 0.0
        else:
            along = np.array([(0.0, 0.0, d) if setup.modified else (a, 0.0, d) for _, d, a, _ in links])
            self.model.body_mass[moving] = setup.masses
            self.model.body_ipos[moving] = along * random.uniform(0.3, 0.7, (len(links), 1)) + random.normal(
                0.0, 0.03, (len(links), 3)
            )
            self.model.body_sameframe[moving] = 0  # or centres compiled at the origin would stay there
            self.stiffness = 2.0e4 * random.uniform(0.5, 1.5, len(links))
        self.data = mujoco.MjData(self.model)

    def pose(self, joints):
        """Returns position and rotation of the sensor where springs and weights balance."""
        self.data.qpos[:] = joints
        for _ in range(0 if self.stiffness is None else 5):
            mujoco.mj_forward(self.model, self.data)
            self.data.qpos[:] = joints - self.data.qfrc_bias / self.stiffness
        mujoco.mj_kinematics(self.model, self.data)
        site = self.data.site("sensor")
        return site.xpos.copy(), site.xmat.reshape(3, 3).copy()

    def value(self, joints, plane):
        """Returns what the sensor reads without noise: a range, None where there is no good one; or a position."""
        position, rotation = self.pose(joints)
        if plane is None:
            return position
        groups = np.zeros(6, dtype=np.uint8)
        groups[list(self.setup.planes).index(plane)] = 1
        hit, normal = np.zeros(1, dtype=np.int32), np.zeros(3)
        found = mujoco.mj_ray(self.model, self.data, position, rotation[:, 2], groups, 1, -1, hit, normal)
        n = np.array(self.setup.planes[plane][0])
        steep = abs(rotation[:, 2] @ n) / np.linalg.norm(n) > 0.4
        low, high = self.setup.ranges
        return np.array([found]) if steep and low < found < high else None


def measured(cell, random, count):
    """Returns rows of joints, values with noise, planes, and the true positions."""
    setup, rows, positions = cell.setup, [], []
    planes = list(setup.planes) or [None]
    while len(rows) < count:
        plane = planes[len(rows) % len(planes)]
        joints = np.round(random.uniform(*setup.limits.T), 9)
        value = cell.value(joints, plane)
        if value is None:
            continue
        std = setup.noise / (math.sqrt(10) if plane else 1.0)
        noisy = value + random.normal(0.0, std, len(value))
        rows.append(
            ",".join([*(f"{q:.9f}" for q in joints), *(f"{v:.9f}" for v in noisy), *([plane] if plane else [])])
        )
        positions.append(cell.pose(joints)[0].tolist())
    return rows, positions


def make(setup, seed):
    """Writes a folder's `observations.csv`, `validation.csv` and `truth.json`."""
    random = np.random.default_rng(seed)
    count = len(setup.names)
    off = np.stack(
        [random.uniform(-size, size, count) for size in (setup.turn, setup.shift, setup.shift, setup.turn)], axis=1
    )
    off[0, 0] = 0.0  # the first joint defines azimuth
    beta = np.zeros(count)
    for k in setup.beta:
        off[k, 1], beta[k] = 0.0, random.uniform(-setup.turn, setup.turn)
    cell = Cell(setup, setup.links + off, beta, random)
    head = ",".join([*setup.names, *(["range", "target"] if setup.planes else ["x", "y", "z"])])
    folder = HERE / setup.folder
    for name, number in (("observations", setup.rows), ("validation", setup.validation)):
        rows, positions = measured(cell, random, number)
        (folder / f"{name}.csv").write_text("\n".join([head, *rows]) + "\n")
    true = dict(zip(("theta", "d", "a", "alpha"), (setup.links + off).T.tolist(), strict=True)) | {
        "beta": beta.tolist()
    }
    (folder / "truth.json").write_text(json.dumps({"true": true, "validation_position": positions}) + "\n")


if __name__ == "__main__":
    make(PANDA, 7)
    make(CANADARM2, 2)
