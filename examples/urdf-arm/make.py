"""Makes this folder's readings: an arm that is not quite `arm.urdf`, measured in MuJoCo.

    python examples/urdf-arm/make.py

The true arm is `arm.urdf` with every moving joint's origin off by up to 1.5 mm along and 3 mrad about each axis (the
first joint's along and about z only, since that is where the arm's base is). MuJoCo reads it as URDF, moves it and
casts the beam; nothing of Boresight takes part.
"""

import json
import re
from pathlib import Path

import mujoco
import numpy as np

FOLDER = Path(__file__).parent
PLANES = {
    "deck": ((0.0, 1.0, 4.6), -0.69),
    "wall_x": ((-5.0, 0.75, 1.0), 8.0),
    "wall_y": ((0.6, -5.0, 1.2), 8.0),
}
JOINTS = ("turn", "shoulder", "elbow", "roll", "pitch", "spin")
NOISE_M, REPEATS = 0.0002, 10
LARGEST_SHIFT_M, LARGEST_TURN_RAD = 0.0015, 0.003


def true_urdf(text, random):
    """Returns the text with every moving joint's origin moved, and the origins, by joint."""
    origins = {}
    for joint in JOINTS:
        block = re.search(rf'<joint name="{joint}" .*?</joint>', text, re.DOTALL)[0]
        origin = re.search(r"<origin [^>]*/>", block)
        xyz, rpy = (numbers(origin[0] if origin else "", key) for key in ("xyz", "rpy"))
        shift = random.uniform(-LARGEST_SHIFT_M, LARGEST_SHIFT_M, 3)
        turn = random.uniform(-LARGEST_TURN_RAD, LARGEST_TURN_RAD, 3)
        if joint == "turn":
            shift[:2] = turn[:2] = 0.0
        xyz, rpy = xyz + shift, rpy + turn
        origins[joint] = {"xyz": xyz.tolist(), "rpy": rpy.tolist()}
        words = [" ".join(map(repr, part.tolist())) for part in (xyz, rpy)]
        new = f'<origin xyz="{words[0]}" rpy="{words[1]}"/>'
        text = text.replace(block, block.replace(origin[0], new) if origin else block.replace("<axis", f"{new}<axis"))
    return text, origins


def numbers(origin, key):
    """Returns the three numbers of an attribute, 0 where there is none."""
    found = re.search(rf"{key}=['\"]([^'\"]*)", origin)
    return np.array(found[1].split(), dtype=float) if found else np.zeros(3)


class Cell:
    """A URDF, the planes and the ranger in MuJoCo; plane k's two faces are in group k, which alone is seen."""

    def __init__(self, urdf):
        spec = mujoco.MjSpec.from_string(urdf)
        spec.compiler.fusestatic = False
        for group, (normal, offset) in enumerate(PLANES.values()):
            n = np.array(normal) / np.linalg.norm(normal)
            point = -offset / np.linalg.norm(normal) * n
            for side in (1.0, -1.0):
                quat = np.empty(4)
                mujoco.mju_quatZ2Vec(quat, side * n)
                spec.worldbody.add_geom(
                    type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=point, quat=quat, group=group
                )
        for body in spec.bodies[1:]:
            body.explicitinertial, body.mass, body.inertia = True, 1.0, [1.0, 1.0, 1.0]
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.ranger = self.model.body("ranger").id
        self.places = [self.model.joint(joint).qposadr[0] for joint in JOINTS]

    def measure(self, joints, target):
        """Returns the range [m] or -1, the ranger's position [m] and its rotation."""
        self.data.qpos[self.places] = joints
        mujoco.mj_kinematics(self.model, self.data)
        position, rotation = self.data.xpos[self.ranger].copy(), self.data.xmat[self.ranger].reshape(3, 3).copy()
        seen = np.zeros(6, dtype=np.uint8)
        seen[target] = 1
        hit = mujoco.mj_ray(self.model, self.data, position, rotation[:, 2].copy(), seen, 1, -1, np.zeros(1, np.int32))
        return hit, position, rotation


def rows(true, nominal, count, random):
    """Yields configurations in which both arms see their target well, the targets in turn."""
    limits = np.array([[-2.9, 2.9], [-2.3, 2.3], [-2.5, 2.5], [-np.pi, np.pi], [-2.1, 2.1], [-np.pi, np.pi]])
    for row in range(count):
        target = row % len(PLANES)
        normal = np.array(list(PLANES.values())[target][0])
        while True:
            joints = np.round(random.uniform(limits[:, 0], limits[:, 1]), 9)
            hit, position, rotation = true.measure(joints, target)
            square = abs(rotation[:, 2] @ normal) / np.linalg.norm(normal)
            if 0.1 < hit < 3.0 and square > 0.5 and nominal.measure(joints, target)[0] > 0.0:
                yield joints, target, hit, position, rotation
                break


def write_csv(name, measured, random):
    """Writes the rows, each range the mean of repeated readings."""
    lines = [",".join([*JOINTS, "range", "target"])]
    for joints, target, hit, *_ in measured:
        reading = hit + random.normal(0.0, NOISE_M, REPEATS).mean()
        lines.append(",".join([*(f"{q:.9f}" for q in joints), f"{reading:.9f}", list(PLANES)[target]]))
    (FOLDER / name).write_text("\n".join(lines) + "\n")


def main():
    """Writes observations.csv, validation.csv and truth.json."""
    random = np.random.default_rng(2024)
    text = (FOLDER / "arm.urdf").read_text()
    urdf, origins = true_urdf(text, random)
    true, nominal = Cell(urdf), Cell(text)
    calibration = list(rows(true, nominal, 100, random))
    validation = list(rows(true, nominal, 60, random))
    write_csv("observations.csv", calibration, random)
    write_csv("validation.csv", validation, random)
    truth = {
        "units": {"length": "m", "angle": "rad"},
        "origins": origins,
        "validation_position": [position.tolist() for _, _, _, position, _ in validation],
        "validation_rotation": [rotation.tolist() for _, _, _, _, rotation in validation],
    }
    (FOLDER / "truth.json").write_text(json.dumps(truth) + "\n")


if __name__ == "__main__":
    main()
