"""Jacobians of frames: overact compared with CasADi's best form.

A frame is on the last body of a serial robot, on the platform, or on the second body of the first leg. CasADi
computes the columns of the joints in the frame of any body (geometric), or differentiates the position in forward
or reverse mode or by `jacobian`; the angular rows are the axes of the joints. Behind closures, the columns of the
joints are multiplied by the reduced Jacobian of the leg. `best` takes the form with the fewest operations after
`cse`.
"""

import sys
from dataclasses import dataclass
from functools import partial

import casadi

from . import compiled, controller, derivatives, dynamics, ours, timing
from .algebra import ZERO, add, apply, cross, matrix, product, transpose, vector
from .casadi_peer import Casadi
from .closure import close
from .description import load
from .model import Angles, LegModel
from .platform import Platform
from .robot import symbols
from .search import forms

#: Robots and the body of their frame; without one the platform or the last body.
CELLS = [
    ("rx90", None),
    ("kuka_lwr", None),
    ("puma560", None),
    ("stanford", None),
    ("dualv", None),
    ("dualv", "leg1.2"),
    ("delta", None),
    ("delta", "leg1.2"),
    ("hexapod", None),
    ("hexapod", "leg1.2"),
]
#: Origin of the frame, m.
AT = [0.1, 0.05, 0.2]


@dataclass
class Task(ours.Function):
    """The Jacobian of a frame; without a body, of the platform or the last body."""

    body: str | None = None

    @property
    def module(self):
        return "_".join([self.robot, *(self.body or "").split(".")]).rstrip("_")

    @property
    def path(self):
        """The description of the robot with the frame."""
        where = f'body = "{self.body}"\n' if self.body else ""
        at = ", ".join(f'"{one} m"' for one in AT)
        found = timing.BUILD / "frames" / f"{self.module}.toml"
        text = ours.description(self.robot).read_text()
        timing.write(found, f"{text}\n[frame.tool]\n{where}at = [{at}]\n")
        return found

    @property
    def rust_name(self):
        return self.name


def point_columns(model, body, at, frame):
    """Velocity of a point of a body and angular velocity of the body, per joint, in the axes of a frame."""
    to_point = apply(model.chain.rotation(frame, body + 1), vector(at))
    columns = {}
    for j in reversed(range(body + 1)):
        axis = apply(model.chain.rotation(frame, j + 1), vector([0, 0, 1]))
        kind = model.leg.joints[j].kind
        if kind == "revolute":
            columns[j] = (cross(axis, to_point), axis)
        elif kind == "prismatic":
            columns[j] = (axis, vector([0, 0, 0]))
        to_point = add(to_point, apply(model.chain.rotation(frame, j), model.offsets[j]))
    return [columns[j] for j in model.moving if j in columns], to_point


class FrameJacobian:
    """The Jacobian of one form, as rows of scalars."""

    def __init__(self, robot, algebra, task, form, homes, driven, body):
        self.robot, self.form, self.driven = robot, form, driven
        self.is_tree = robot.motion is None
        if self.is_tree:
            (leg,) = robot.legs
            self.given = symbols(algebra, task.inputs)
            joints = {joint.name: self.given["joints"][j] for j, joint in enumerate(leg.joints)}
            self.model = LegModel(robot, leg, Angles(algebra, joints), form)
            self.body, self.full = len(leg.joints) - 1, None
            return
        if body is None:
            self.given = symbols(algebra, task.inputs)
            none = {"twist": [ZERO] * driven["dof"], "acceleration": [ZERO] * driven["dof"]}
            self.platform = Platform(robot, algebra, Angles(algebra, {}), {**self.given, **none})
            self.model = None
            return
        whole = dynamics.Parallel(robot, algebra, task.inputs, [], form, homes, driven)
        self.given = whole.given
        name, joint = body.split(".")
        (leg,) = [one for one in whole.legs if one[0].leg.name == name]
        self.model, (_, _, self.full), *_ = leg
        self.body = int(joint) - 1
        # The angles are those of the last leg: close this one again.
        moving = [[j for j in leg.joints if j.kind != "fixed"] for leg in robot.legs]
        place = [leg.name for leg in robot.legs].index(name)
        start = sum(len(joints) for joints in moving[:place])
        known = whole.angles.known.items()
        whole.angles.known = {key: pair for key, pair in known if key[0][0][0] == "phi"}
        own = homes[start : start + len(moving[place])]
        close(whole.angles, algebra, whole.platform, self.model.leg, self.given["pose"], own)

    def rows(self, mode):
        if self.model is None:
            return self.of_platform() if mode == "geometric" else None
        model, base = self.model, matrix(self.model.leg.base_rotation)
        if mode == "geometric":
            frame = max(self.form.frame, 0)
            if frame > self.body + 1:
                return None
            turn = product(base, model.chain.rotation(0, frame))
            columns, _ = point_columns(model, self.body, AT, frame)
            columns = [apply(turn, v) + apply(turn, w) for v, w in columns]
            return self.reduced(transpose(columns))
        # The position is differentiated, the angular rows are axes.
        columns, position = point_columns(model, self.body, AT, 0)
        position = add(apply(base, position), vector(model.leg.base_at))
        linear = derivatives.derivative(derivatives.sx(position), *self.variable(), mode)
        angular = self.reduced(transpose([apply(base, w) for _, w in columns]))
        return derivatives.scalars(linear) + angular

    def variable(self):
        if self.is_tree:
            joints = casadi.vertcat(*[one.value for one in self.given["joints"]])
            return joints, casadi.SX.eye(joints.numel())
        pose = casadi.vertcat(*[one.value for one in self.given["pose"]])
        return pose, derivatives.pose_rates(pose, self.driven["pose"])

    def reduced(self, rows):
        if self.full is None:
            return rows
        return product(rows, self.full[: len(rows[0])])

    def of_platform(self):
        lever = apply(self.platform.rotation, vector(AT))
        columns = [add(v, cross(w, lever)) + w for v, w in self.platform.moves]
        return transpose(columns)


def candidates(robot, task, homes, driven, body):
    """All forms with their counts."""
    frames = range(len(robot.legs[0].joints) + 1) if robot.motion is None else [None]
    for index, form in enumerate(forms(robot)):
        if form.columns != "recursion":
            continue
        for frame in frames:
            own = form if frame is None else type(form)(frame, form.merged, form.inverse, form.columns, form.staged)
            for mode in ("geometric", *derivatives.MODES):
                algebra = Casadi()
                try:
                    rows = FrameJacobian(robot, algebra, task, own, homes, driven, body).rows(mode)
                except NotImplementedError:
                    continue
                if rows is None or (mode != "geometric" and frame):
                    continue
                entries = casadi.cse(casadi.vertcat(*[casadi.SX(e.value) for row in rows for e in row]))
                rank, counted, function = derivatives.ranked(algebra, task, entries)
                yield rank, index, f"{mode}, {own}", counted, function


def best(*given):
    """CasADi's form with the fewest operations."""
    return min(candidates(*given), key=lambda entry: entry[:2])


def task_of(robot, body, document):
    """The Jacobian of a frame of a robot, with its count."""
    is_tree = load(ours.description(robot)).motion is None
    inputs = [("joints", document["dof"])] if is_tree else [("pose", len(document["pose"]))]
    task = Task(
        robot=robot,
        name="tool_jacobian",
        source="joints" if is_tree else "pose",
        kind="standard",
        inputs=inputs,
        shape=[6, document["dof"]],
        columns=[],
        count=None,
        document=document,
        body=body,
    )
    task.count = derivatives.counts_of(task.path, [task.name])[task.name]
    return task


def cells(only, samples):
    """All frames with CasADi's best forms, after checking their agreement."""
    for robot, body in CELLS:
        if not compiled.is_selected(robot, only):
            continue
        document, own = ours.inspect(robot), load(ours.description(robot))
        is_tree = own.motion is None
        driven = {"dof": document["dof"], "joints": [] if is_tree else controller.actuated(robot)}
        driven["pose"] = None if is_tree else document["pose"]
        task = task_of(robot, body, document)
        print(f"{task.module} …", file=sys.stderr, flush=True)
        given = own, task, document["home_joints"], driven, body
        form, counted, peer = compiled.kept(task, repr(derivatives.MODES), partial(best, *given))
        title = f"{document['robot']}, {body or ('last body' if is_tree else 'platform')}"
        cell = compiled.Cell(title, task, counted, form, peer, partial(controller.states, task))
        cell.check(samples)
        yield cell


def measure(only, samples, timed, core, rounds):
    """The table."""
    return compiled.table(list(cells(only, samples)), timed, core, rounds)
