"""Robots with loops on a tree of joints, and platforms with parasitic motion, as users of a peer would write
them.

From joint angles, the recursive Newton-Euler algorithm runs on the whole tree and is projected by the reduced
Jacobian. A chain between two bodies is solved from their relative motion in one of its frames. A platform
with parasitic motion is a free body; its dependent velocities follow from the remaining rows of its legs.
`best` takes the form with the fewest operations.
"""

from dataclasses import dataclass, field

from .algebra import (
    ZERO,
    add,
    apply,
    cross,
    dot,
    identity,
    matrix,
    product,
    scale,
    sub,
    transpose,
    vector,
)
from .casadi_peer import Casadi, count
from .description import INERTIA
from .dynamics import Body, Values, joint_torque
from .model import Angles, Form, LegModel, Motion, body_wrench, spin
from .platform import Platform
from .robot import INVERSES, symbols
from .search import PAIR

NONE = vector([0, 0, 0])


@dataclass
class Part:
    """A leg of the tree in a derivation: its model, its joint rates per independent rate, and its motion."""

    model: LegModel
    rows: list = field(default_factory=list)
    rates: dict = field(default_factory=dict)
    accelerations: dict = field(default_factory=dict)
    motions: list = field(default_factory=list)


def unit_rows(count, width, first=0):
    return [[identity(width)[first + k][c] for c in range(width)] for k in range(count)]


class Tree:
    """All legs of a robot with their motion; `closed_from` are rows x columns of the independent joints."""

    def __init__(self, robot, algebra, inputs, form, dof):
        self.robot, self.algebra, self.form, self.dof = robot, algebra, form, dof
        self.given = symbols(algebra, inputs)
        self.gravity = vector(robot.gravity)
        self.parts, self.platform = [], None
        start = 0
        if robot.motion is not None:
            self.free_platform()
        for leg in robot.legs:
            moving = [joint for joint in leg.joints if joint.kind != "fixed"]
            variables = {j.name: self.given["joints"][start + k] for k, j in enumerate(moving)}
            self.parts.append(Part(LegModel(robot, leg, Angles(algebra, variables), form)))
            start += len(moving)
        if self.platform is not None:
            self.follow_platform()
        else:
            for index in range(len(self.parts)):
                self.close(index)

    # A skeleton and chains.

    def close(self, index):
        part = self.parts[index]
        leg = part.model.leg
        if leg.end_body is None:
            part.rows = unit_rows(len(part.model.moving), self.dof)
            of = lambda key: dict(zip(part.model.moving, self.given.get(key, [ZERO] * self.dof), strict=True))  # noqa: E731
            part.rates, part.accelerations = of("twist"), of("acceleration")
            part.motions = self.forward(part, None)
            return
        skeleton = self.parts[0]
        first = -1 if leg.base_body is None else leg.base_body
        columns, acceleration, turned = self.relative(skeleton, first, leg.end_body, vector(leg.end_at))
        into = product(transpose(matrix(leg.base_rotation)), turned)
        model, form = part.model, self.form
        frame = min(form.frame, model.n)
        to_frame = product(transpose(model.chain.rotation(0, frame)), into)
        jacobian = [column[:3] for column in model.jacobian(frame)]
        rows = [i for i in range(3) if any(not column[i].is_zero for column in jacobian)]
        if len(rows) != len(jacobian):
            raise NotImplementedError("a chain whose closure is not square in this frame")
        inverse = INVERSES[form.inverse](transpose([[column[i] for i in rows] for column in jacobian]))
        moves = {j: apply(to_frame, column) for j, column in columns.items()}
        wide = [[moves[j][i] if j in moves else ZERO for j in skeleton.model.moving] for i in rows]
        part.rows = product(inverse, wide)
        known = [skeleton.rates[j] for j in skeleton.model.moving]
        if form.staged:
            rates = apply(inverse, apply(wide, known))
        else:
            rates = apply(part.rows, known)
        part.rates = dict(zip(model.moving, rates, strict=True))
        drift = model.forward(part.rates, {}, NONE)[-1].acceleration
        drift = apply(model.chain.rotation(frame, model.n), drift)
        rest = sub(apply(to_frame, acceleration), drift)
        found = apply(inverse, [rest[i] for i in rows])
        part.accelerations = dict(zip(model.moving, found, strict=True))
        carrier = None if leg.base_body is None else skeleton.motions[leg.base_body]
        part.motions = self.forward(part, carrier)

    def relative(self, part, first, last, at):
        """Motion of a point of body `last` relative to body `first` (-1 is the base).

        Velocity per joint rate, acceleration, and axes, in the axes of `first`; those of the base are the
        base frame's.
        """
        model = part.model
        columns, to_end = {}, apply(model.chain.rotation(first + 1, last + 1), at)
        for j in range(last, first, -1):
            axis = apply(model.chain.rotation(first + 1, j + 1), vector([0, 0, 1]))
            kind = model.leg.joints[j].kind
            if kind == "revolute":
                columns[j] = cross(axis, to_end)
            elif kind == "prismatic":
                columns[j] = axis
            to_end = add(to_end, apply(model.chain.rotation(first + 1, j), model.offsets[j]))
        omega = alpha = acceleration = NONE
        for j in range(first + 1, last + 1):
            omega, alpha, acceleration = step(model, j, part, omega, alpha, acceleration)
        acceleration = add(acceleration, spin(omega, alpha, at))
        acceleration = apply(model.chain.rotation(first + 1, last + 1), acceleration)
        axes = matrix(model.leg.base_rotation) if first < 0 else identity(3)
        return columns, acceleration, axes

    def forward(self, part, carrier):
        """Motions of a leg's bodies; its base is on a body or on the ground."""
        model, leg = part.model, part.model.leg
        if carrier is None:
            omega = alpha = NONE
            acceleration = scale(apply(transpose(matrix(leg.base_rotation)), self.gravity), -1.0)
        else:
            back = transpose(matrix(leg.base_rotation))
            moved = add(carrier.acceleration, spin(carrier.omega, carrier.alpha, vector(leg.base_at)))
            omega, alpha = apply(back, carrier.omega), apply(back, carrier.alpha)
            acceleration = apply(back, moved)
        motions = []
        for j in range(model.n):
            omega, alpha, acceleration = step(model, j, part, omega, alpha, acceleration)
            motions.append(Motion(omega, alpha, acceleration))
        return motions

    # A platform.

    def free_platform(self):
        """The platform with its independent velocities; with parasitic motion, the others are computed later."""
        names = ["x", "y", "z", "rx", "ry", "rz"]
        own = self.robot.independent or names
        self.own = [names.index(name) for name in own]
        self.others = [at for at in range(6) if at not in self.own]
        given = {"pose": self.given.get("pose", [ZERO] * 7), "twist": [ZERO] * 6, "acceleration": [ZERO] * 6}
        self.platform = Platform(self.robot, self.algebra, Angles(self.algebra, {}), given)

    def set_motion(self, twist, acceleration):
        self.platform.velocity, self.platform.omega = self.platform.combined(twist)
        self.platform.acceleration, self.platform.alpha = self.platform.combined(acceleration)

    def together(self, own, others):
        whole = [ZERO] * 6
        for at, value in [*zip(self.own, own, strict=True), *zip(self.others, others, strict=True)]:
            whole[at] = value
        return whole

    def follow_platform(self):
        form = self.form
        twist = self.given.get("twist", [ZERO] * self.dof)
        rising = self.given.get("acceleration", [ZERO] * self.dof)
        ends, over = [], []
        for part in self.parts:
            model, leg = part.model, part.model.leg
            frame = min(form.frame, model.n)
            to_frame = transpose(product(matrix(leg.base_rotation), model.chain.rotation(0, frame)))
            partials, _, _ = self.platform.end(leg)
            jacobian = [column[:3] for column in model.jacobian(frame)]
            rows = [i for i in range(3) if any(not column[i].is_zero for column in jacobian)]
            if len(rows) != len(jacobian):
                raise NotImplementedError("a leg whose closure is not square in this frame")
            inverse = INVERSES[form.inverse](transpose([[column[i] for i in rows] for column in jacobian]))
            moves = transpose([apply(to_frame, pair[0]) for pair in partials])
            ends.append((part, to_frame, frame, rows, inverse, moves))
            over += [(len(ends) - 1, i) for i in range(3) if i not in rows]
        lines = [ends[k][5][i] for k, i in over]
        if len(lines) != len(self.others):
            raise NotImplementedError("other rows than dependent coordinates")
        solved = INVERSES[form.inverse]([[line[c] for c in self.others] for line in lines]) if lines else []
        follow = product(solved, [[-line[c] for c in self.own] for line in lines]) if lines else []
        self.jacobian = [[ZERO] * self.dof for _ in range(6)]
        for k, at in enumerate(self.own):
            self.jacobian[at][k] = identity(self.dof)[k][k]
        for k, at in enumerate(self.others):
            self.jacobian[at] = follow[k]
        whole = self.together(twist, apply(follow, twist) if lines else [])
        self.set_motion(whole, [ZERO] * 6)
        bias = []
        for part, to_frame, frame, rows, inverse, moves in ends:
            model = part.model
            narrow = [moves[i] for i in rows]
            _, velocity, acceleration = self.platform.end(model.leg)
            part.rows = product(product(inverse, narrow), self.jacobian)
            if form.staged:
                seen = apply(to_frame, velocity[0])
                rates = apply(inverse, [seen[i] for i in rows])
            else:
                rates = apply(part.rows, twist)
            part.rates = dict(zip(model.moving, rates, strict=True))
            drift = model.forward(part.rates, {}, NONE)[-1].acceleration
            drift = apply(model.chain.rotation(frame, model.n), drift)
            bias.append(sub(apply(to_frame, acceleration[0]), drift))
        rest = [-bias[k][i] for k, i in over]
        others = add(apply(follow, rising), apply(solved, rest)) if lines else []
        growth = self.together(rising, others)
        self.set_motion(whole, growth)
        for (part, _to_frame, _, rows, inverse, moves), start in zip(ends, bias, strict=True):
            moved = [dot(moves[i], growth) + start[i] for i in rows]
            found = apply(inverse, moved)
            part.accelerations = dict(zip(part.model.moving, found, strict=True))
            part.motions = self.forward(part, None)

    def platform_motion(self):
        back = transpose(self.platform.rotation)
        return Motion(
            apply(back, self.platform.omega),
            apply(back, self.platform.alpha),
            apply(back, sub(self.platform.acceleration, self.gravity)),
        )

    def on_platform(self, force, moment):
        """Projects a wrench in the platform's axes on the independent coordinates."""
        force, moment = apply(self.platform.rotation, force), apply(self.platform.rotation, moment)
        return apply(transpose(self.jacobian), force + moment)

    # Forces.

    def handed(self, part, j, force, moment, torques):
        """Joint torques that balance a wrench on body j, and the reactions on the bodies that carry the leg."""
        model = part.model
        own = torques.setdefault(id(part), {})
        for k in range(j, -1, -1):
            kind = model.leg.joints[k].kind
            if kind != "fixed":
                held = moment[2] if kind == "revolute" else force[2]
                own[k] = own[k] + held if k in own else held
            force = apply(model.rotations[k], force)
            moment = add(apply(model.rotations[k], moment), cross(model.offsets[k], force))
        if model.leg.base_body is not None:
            turn = matrix(model.leg.base_rotation)
            force = apply(turn, force)
            moment = add(apply(turn, moment), cross(vector(model.leg.base_at), force))
            self.handed(self.parts[0], model.leg.base_body, force, moment, torques)

    def projected(self, torques):
        """Projects torques of the moving joints on the independent coordinates."""
        total = [ZERO] * self.dof
        for part in self.parts:
            own = torques.get(id(part), {})
            for k, j in enumerate(part.model.moving):
                if j in own:
                    total = add(total, scale(part.rows[k], own[j]))
        return total

    def columns(self, names):
        """The identification model."""
        wanted, found = set(names), {}
        for part in self.parts:
            model = part.model
            for j, joint in enumerate(model.leg.joints):
                for symbol in joint.parameters:
                    name = f"{symbol}_{joint.name}_{model.leg.name}"
                    if name not in wanted:
                        continue
                    if symbol in INERTIA:
                        torques = {}
                        self.handed(part, j, *body_wrench(symbol, part.motions[j]), torques)
                        found[name] = self.projected(torques)
                    elif j in model.moving:
                        rate = part.rates[j]
                        factor = {"ia": part.accelerations[j], "fv": rate, "off": identity(1)[0][0]}
                        factor = self.algebra.sign(rate) if symbol == "fs" else factor[symbol]
                        found[name] = scale(part.rows[model.moving.index(j)], factor)
        if self.platform is not None:
            for symbol in self.robot.platform_parameters:
                if f"{symbol}_platform" in wanted:
                    wrench = body_wrench(symbol, self.platform_motion())
                    found[f"{symbol}_platform"] = self.on_platform(*wrench)
        return [found[name] for name in names]

    def inverse_dynamics(self, names, actuated):
        """Torques of as many actuators as independent coordinates: one recursion over the whole tree."""
        values = Values(names, self.given["parameters"])
        torques, loads = {}, {}
        for part in reversed(self.parts):
            model, leg = part.model, part.model.leg
            force, moment = NONE, NONE
            own = torques.setdefault(id(part), {})
            for j in reversed(range(model.n)):
                value = values.of(leg.joints[j].name, leg.name)
                for push, turn in [Body(value).wrench(part.motions[j]), *loads.get((id(part), j), [])]:
                    force, moment = add(force, push), add(moment, turn)
                if j in model.moving:
                    held = moment[2] if leg.joints[j].kind == "revolute" else force[2]
                    rate, growth = part.rates[j], part.accelerations[j]
                    own[j] = held + joint_torque(value, rate, growth, self.algebra)
                force = apply(model.rotations[j], force)
                moment = add(apply(model.rotations[j], moment), cross(model.offsets[j], force))
            if leg.base_body is not None:
                turn = matrix(leg.base_rotation)
                force = apply(turn, force)
                moment = add(apply(turn, moment), cross(vector(leg.base_at), force))
                loads.setdefault((id(self.parts[0]), leg.base_body), []).append((force, moment))
        total = self.projected(torques)
        if self.platform is not None:
            body = Body(values.of("platform")) + Body(values.of("payload"))
            total = add(total, self.on_platform(*body.wrench(self.platform_motion())))
        rows = [row for part in self.parts for row in part.rows]
        jacobian = [rows[at] for at in actuated]
        return apply(transpose(INVERSES[self.form.inverse](jacobian)), total)


def step(model, j, part, omega, alpha, acceleration):
    """The Newton-Euler recursion over one joint."""
    back = transpose(model.rotations[j])
    acceleration = apply(back, add(acceleration, spin(omega, alpha, model.offsets[j])))
    omega, alpha = apply(back, omega), apply(back, alpha)
    rate, rise = part.rates.get(j, ZERO), part.accelerations.get(j, ZERO)
    axis = vector([0, 0, 1])
    kind = model.leg.joints[j].kind
    if kind == "revolute":
        alpha = add(add(alpha, scale(axis, rise)), cross(omega, scale(axis, rate)))
        omega = add(omega, scale(axis, rate))
    elif kind == "prismatic":
        slide = scale(cross(omega, axis), rate * 2.0)
        acceleration = add(add(acceleration, scale(axis, rise)), slide)
    return omega, alpha, acceleration


def forms(robot):
    """All distinct forms."""
    for frame in range(1 + max(len(leg.joints) for leg in robot.legs)):
        for merged in (False, True):
            for inverse in ("elimination", "cofactors"):
                for staged in (True, False):
                    yield Form(frame, merged, inverse, "recursion", staged)


def best(robot, name, inputs, names, dof, actuated):
    """CasADi's function after `cse` in the form with the fewest operations, and its count."""
    found = []
    for index, form in enumerate(forms(robot)):
        algebra = Casadi()
        try:
            tree = Tree(robot, algebra, inputs, form, dof)
            if name == "idm_red_platform":
                derived = tree.columns(names)
            else:
                derived = [tree.inverse_dynamics(names, actuated)]
        except NotImplementedError:
            continue
        function = algebra.function("peer", inputs, derived, cse=True)
        counted = count(function)
        rank = counted.operations + PAIR * counted.trigonometric_pairs
        found.append((rank, index, str(form), counted, function))
    return min(found, default=None, key=lambda entry: entry[:2])
