"""Forward kinematics of parallel robots as users of CasADi would write it.

Each Gauss-Newton step is one function with shared subexpressions, in a loop in C.
"""

import json
import math
from dataclasses import dataclass

import numpy as np

from . import casadi_peer, ours
from .algebra import ONE, apply, dot, identity, sub, transpose
from .casadi_peer import Casadi
from .controller import actuated
from .count import Count
from .description import load
from .dynamics import Parallel, quadratic, solve_symmetric
from .search import PAIR, forms
from .states import pose
from .timing import TEMPLATES

#: Motion of the pose between two samples (m, rad), and noise of the encoders.
MOVE, NOISE = 1e-3, 1e-5


@dataclass
class Function(ours.Function):
    """overact's forward kinematics, which iterates and is therefore not a function of `evaluate`."""

    @property
    def rust_name(self):
        return self.name


class Forward(Parallel):
    """A step from a pose to the one that fits the actuators."""

    def __init__(self, robot, algebra, inputs, form, homes, driven):
        self.positions, self.homes = [], homes
        super().__init__(robot, algebra, inputs, [], form, homes, driven)

    def leg(self, leg, actuated, start):
        found = super().leg(leg, actuated, start)
        moving = [joint for joint in leg.joints if joint.kind != "fixed"]
        for k, joint in enumerate(moving):
            if start + k not in actuated:
                continue
            if joint.kind == "prismatic":
                self.positions.append(self.angles.variables[joint.name])
            else:
                cosine, sine = self.angles.closed[(joint.name,)]
                # Branch of the arc tangent at home.
                turn = 2.0 * math.pi * round(self.homes[start + k] / (2.0 * math.pi))
                self.positions.append(self.algebra.arc_tangent(sine, cosine) + turn)
        return found

    def step(self):
        jacobian = self.inverse_jacobian()
        difference = sub(self.given["actuators"], self.positions)
        if len(jacobian) == len(jacobian[0]):
            return solve(jacobian, difference)
        normal = quadratic(identity(len(jacobian)), jacobian)
        return solve_symmetric(normal, apply(transpose(jacobian), difference))


def solve(matrix, given):
    """Elimination without pivoting."""
    rows, x = [list(row) for row in matrix], list(given)
    size, inverses = len(x), []
    for k in range(size):
        inverses.append(ONE / rows[k][k])
        for i in range(k + 1, size):
            factor = rows[i][k] * inverses[k]
            rows[i] = [a - factor * b if j > k else a for j, (a, b) in enumerate(zip(rows[i], rows[k], strict=True))]
            x[i] = x[i] - factor * x[k]
    for k in reversed(range(size)):
        x[k] = (x[k] - dot(rows[k][k + 1 :], x[k + 1 :])) * inverses[k]
    return x


def function(robot):
    """overact's forward kinematics; the count is that of one step if it iterates."""
    document = ours.inspect(robot)
    sizes = document["actuators"], len(document["home_pose"])
    steps = [i for f in document["functions"] for i in f["iterations"] if i["function"] == "pose_from_actuators"]
    closed = [f for f in document["functions"] if f["name"] == "pose_in_closed_form"]
    return Function(
        robot=robot,
        name="pose_from_actuators",
        source="actuators",
        kind="standard",
        inputs=[("actuators", sizes[0]), ("start", sizes[1])],
        shape=[sizes[1]],
        columns=[],
        count=Count.from_json((steps or closed)[0]),
        document=document,
    )


def sample(work, number, seed=1):
    """Encoder positions of random poses with noise, and start poses at the distance of one sample."""
    rng = np.random.default_rng(seed)
    poses = [pose(work.document, rng) for _ in range(number)]
    text = json.dumps([{"pose": list(x)} for x in poses])
    found = ours.overact("evaluate", work.path, "actuator_positions", "--states", "-", stdin=text)
    made = []
    for x, result in zip(poses, found["results"], strict=True):
        start = x + rng.uniform(-MOVE, MOVE, len(x))
        if "qw" in work.document["pose"]:
            at = work.document["pose"].index("qw")
            start[at : at + 4] /= np.linalg.norm(start[at : at + 4])
        encoders = np.array(result["actuator_positions"])
        made.append({"actuators": encoders + NOISE * rng.normal(size=len(encoders)), "start": start})
    return made


def best(work):
    """CasADi's step with the fewest operations after `cse`: form, count, and C code with and without `cse`."""
    document, robot = work.document, load(work.path)
    driven = {"dof": document["dof"], "joints": actuated(work.robot)}
    inputs = [("pose", len(document["home_pose"])), ("actuators", document["actuators"])]
    found = []
    for index, form in enumerate(forms(robot)):
        algebra = Casadi()
        try:
            step = [Forward(robot, algebra, inputs, form, document["home_joints"], driven).step()]
        except NotImplementedError:
            continue
        made = [algebra.function("peer", inputs, step, cse) for cse in (True, False)]
        counted = casadi_peer.count(made[0])
        found.append((counted.operations + PAIR * counted.trigonometric_pairs, index, form, counted, made))
    _, _, form, counted, made = min(found, key=lambda entry: entry[:2])
    return form, counted, [code(each, document) for each in made]


def code(function, document):
    """C code of the loop around a step."""
    quaternion = "qw" in document["pose"]
    text = casadi_peer.c_code(function, "newton_step") + (TEMPLATES / "forward.c").read_text()
    for key, value in {
        "POSE": len(document["home_pose"]),
        "DOF": document["dof"],
        "LINEAR": document["dof"] - 3 * quaternion,
        "QUATERNION": int(quaternion),
    }.items():
        text = text.replace(f"@{key}@", str(value))
    return text
