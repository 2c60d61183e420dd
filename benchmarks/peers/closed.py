"""Robots with closed chains from joint angles: identification model and inverse dynamics compared with CasADi's
best form."""

import json

import numpy as np

from . import loops, ours, report
from .controller import Function, actuated, check, sample
from .count import Count
from .description import load
from .ours import overact
from .states import states

ROBOTS = ["ankle", "humanoid_leg", "tricept", "reachy_mini", "spatial_3rps", "spatial_3prs"]
FUNCTIONS = ["idm_red_platform", "inverse_dynamics"]
SIX = ["x", "y", "z", "rx", "ry", "rz"]


def function(document, robot, name):
    """overact's function of standard parameters from joints."""
    for entry in document["functions"]:
        if entry["name"] == name and entry["columns"] != "base" and entry["from"] == "joints":
            columns = document["parameters"]
            if name == "idm_red_platform":
                columns = [p for p in columns if not p.endswith("_payload")]
            return Function(
                robot=robot,
                name=name,
                source="joints",
                kind="standard",
                inputs=[(i["name"], i["shape"][0]) for i in entry["inputs"]],
                shape=entry["outputs"][0]["shape"],
                columns=columns,
                count=Count.from_json(entry),
                document=document,
            )
    raise RuntimeError(f"{robot}: overact has no {name} from joints")


def closed(path, independent, poses):
    """Closed poses of a platform with parasitic motion, by Newton's method on the dependent coordinates."""
    others = [at for at, name in enumerate(SIX) if name not in independent]
    for _ in range(12):
        text = json.dumps([{"pose": list(pose)} for pose in poses])
        asked = {}
        for name in ("blocked_error", "blocked_jacobian"):
            found = overact("evaluate", path, name, "--states", "-", stdin=text)
            asked[name] = [np.array(result[name]) for result in found["results"]]
        for pose, error, rows in zip(poses, asked["blocked_error"], asked["blocked_jacobian"], strict=True):
            step = np.zeros(6)
            step[others] = -np.linalg.solve(rows.reshape(-1, 6)[:, others], error)
            move(pose, step)
    return poses


def move(pose, step):
    """Moves a pose by a translation and a rotation vector in the base frame."""
    pose[:3] += step[:3]
    angle = np.linalg.norm(step[3:])
    axis = step[3:] * (0.5 if angle < 1e-12 else np.sin(0.5 * angle) / angle)
    w, v = pose[3], pose[4:].copy()
    pose[3] = np.cos(0.5 * angle) * w - axis @ v
    pose[4:] = np.cos(0.5 * angle) * v + w * axis + np.cross(axis, v)
    pose[3:] /= np.linalg.norm(pose[3:])


def closed_states(function, number, robot):
    """States with consistent pose, joints and parameters."""
    if robot.motion is None:
        return sample(function, number) if "parameters" in dict(function.inputs) else states(function, number)
    rng = np.random.default_rng(5)
    home = np.array(function.document["home_pose"])
    poses = []
    for _ in range(number):
        pose = home.copy()
        move(pose, np.array([*rng.uniform(-0.006, 0.006, 3), *rng.uniform(-0.15, 0.15, 3)]))
        poses.append(pose)
    if robot.independent is not None:
        poses = closed(function.path, robot.independent, poses)
    text = json.dumps([{"pose": list(pose)} for pose in poses])
    joints = overact("evaluate", function.path, "joints", "--states", "-", stdin=text)["results"]
    found = []
    for pose, one in zip(poses, joints, strict=True):
        state = {"pose": pose, "joints": np.array(one["joints"])}
        for name, length in function.inputs:
            if name not in state:
                state[name] = rng.uniform(-1.0, 1.0, length)
        found.append({name: state[name] for name, _ in function.inputs})
    return found


def measure(only, samples):
    """The table."""
    lines = []
    for robot in ROBOTS:
        if only and only not in robot:
            continue
        path = ours.description(robot)
        document, own = ours.inspect(robot), load(path)
        for name in FUNCTIONS:
            work = function(document, robot, name)
            driven = actuated(robot)
            found = loops.best(own, name, work.inputs, work.columns, document["dof"], driven)
            if found is None:
                raise RuntimeError(f"{robot}: no form of the peer's {name}")
            _, _, form, counted, peer = found
            given = closed_states(work, samples, own)
            values = np.array([peer(*state.values()).full() for state in given])
            check(f"{robot}, {name}", values, work.evaluate(given))
            line = [f"{document['robot']}, {name.replace('_', ' ')}", report.operations(work.count)]
            ratio = work.count.operations / counted.operations
            lines.append([*line, report.operations(counted), f"{ratio:.2f}", form])
    return report.table(["function", "overact", "CasADi, cse", "ratio", "CasADi's form"], lines)
