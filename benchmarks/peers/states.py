"""States for comparison and timing: poses around home with matching joints."""

import json

import numpy as np

from .ours import overact

#: Largest displacement (m) and rotation (rad) from home.
REACH, TURN = 0.03, 0.3


def states(function, count, seed=1):
    """Random states of a function's inputs, joints consistent with the pose."""
    document = function.document
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        state = {"pose": pose(document, rng)} if function.inputs[0][0] == "pose" else {}
        for name, length in function.inputs:
            if name not in ("pose", "joints"):
                state[name] = rng.uniform(-2.0, 2.0, length)
        if not state.get("pose", np.empty(0)).size:
            state["joints"] = np.array(document["home_joints"]) + rng.uniform(-1.0, 1.0, document["joints"])
        made.append(state)
    if function.source == "joints" and "pose" in made[0]:
        text = json.dumps([{"pose": list(state["pose"])} for state in made])
        found = overact("evaluate", function.path, "joints", "--states", "-", stdin=text)
        for state, result in zip(made, found["results"], strict=True):
            state["joints"] = np.array(result["joints"])
    return [{name: state[name] for name, _ in function.inputs} for state in made]


def pose(document, rng):
    """A pose near home; orientations as unit quaternions."""
    home = np.array(document["home_pose"])
    names = document["pose"]
    if "qw" in names:
        at = names.index("qw")
        axis = rng.normal(size=3)
        half = 0.5 * rng.uniform(-TURN, TURN)
        quaternion = np.concatenate([[np.cos(half)], np.sin(half) * axis / np.linalg.norm(axis)])
        move = np.zeros(len(home))
        move[:at] = rng.uniform(-REACH, REACH, at)
        found = home + move
        found[at : at + 4] = quaternion
        return found
    spread = np.array([TURN if name == "phi" else REACH for name in names])
    return home + rng.uniform(-1.0, 1.0, len(home)) * spread
