"""Identification models from first principles, in the forms in which users of a peer would write them.

For each leg, velocities of the leg's end give joint rates by the inverse K of the leg's Jacobian. The
Newton-Euler recursion gives every body's motion in its own frame. The wrench of one unit of a parameter gives
its column. The forms differ in

- the frame in which K is computed,
- the method of inversion,
- the projection of a column (joint torques by the backward recursion, or the body's partial velocities),
- the projection on the platform, in one step or by way of the leg's end,
- whether parallel axes are merged.

None is the best for all robots; `search.py` takes the best for each.
"""

import math
from dataclasses import dataclass

from .algebra import (
    ONE,
    ZERO,
    add,
    apply,
    cross,
    dot,
    identity,
    matrix,
    product,
    scalar,
    scale,
    transpose,
    vector,
)
from .description import INERTIA
from .values import Linear

Z = vector([0, 0, 1])


@dataclass(frozen=True)
class Form:
    """One way of writing a model."""

    frame: int = 0  # of the leg, in which its Jacobian is formed: 0 base, 1 first body, -1 last
    merged: bool = False  # cos(q1 + q2) for parallel axes rather than products
    inverse: str = "elimination"  # or "cofactors"
    columns: str = "partial"  # velocities of the body, or "recursion" to joint torques
    staged: bool = True  # by way of the leg's end

    def __str__(self):
        frame = {0: "base"}.get(self.frame, f"body {self.frame}")
        merged = "merged axes" if self.merged else "products"
        staged = "by the leg's end" if self.staged else "direct"
        return f"{frame}, {merged}, {self.inverse}, {self.columns}, {staged}"


class Angles:
    """Sines and cosines of linear expressions, each evaluated once."""

    def __init__(self, algebra, variables):
        self.algebra = algebra
        self.variables = variables
        self.known = {}
        #: Pairs of joint sums from a closure, by joint names.
        self.closed = {}

    def pair(self, angle):
        """Cosine and sine of a `Linear`; quarter turns need no operations."""
        terms = tuple(sorted((n, f) for n, f in angle.terms.items() if f != 0.0))
        if not terms:
            c, s = math.cos(angle.constant), math.sin(angle.constant)
            return scalar(round(c, 15)) if abs(c - round(c)) < 1e-15 else scalar(c), (
                scalar(round(s, 15)) if abs(s - round(s)) < 1e-15 else scalar(s)
            )
        if terms[0][1] < 0.0:
            c, s = self.pair(-angle)
            return c, -s
        quarters = round(angle.constant / (math.pi / 2))
        rest = angle.constant - quarters * math.pi / 2
        rest = 0.0 if abs(rest) < 1e-15 else rest
        key = (terms, rest)
        names = tuple(name for name, factor in terms if factor == 1.0)
        if key not in self.known and names in self.closed:
            c, s = self.closed[names]
            cosine, sine = math.cos(rest), math.sin(rest)
            self.known[key] = (c * cosine - s * sine, s * cosine + c * sine)
        elif key not in self.known:
            total = scalar(rest)
            for name, factor in terms:
                total = total + self.variables[name] * factor
            self.known[key] = (self.algebra.cos(total), self.algebra.sin(total))
        c, s = self.known[key]
        return [(c, s), (-s, c), (-c, -s), (s, -c)][quarters % 4]


def about_z(pair):
    c, s = pair
    return [[c, -s, ZERO], [s, c, ZERO], [ZERO, ZERO, ONE]]


def about_y(pair):
    c, s = pair
    return [[c, ZERO, s], [ZERO, ONE, ZERO], [-s, ZERO, c]]


def about_x(pair):
    c, s = pair
    return [[ONE, ZERO, ZERO], [ZERO, c, -s], [ZERO, s, c]]


class Chain:
    """Frames of a leg; index 0 is its base, j + 1 the body of joint j."""

    def __init__(self, leg, angles, merged):
        self.joints = leg.joints
        self.angles = angles
        self.merged = merged
        for index, joint in enumerate(leg.joints):
            if (joint.antecedent if joint.antecedent is not None else -1) != index - 1:
                raise NotImplementedError("legs with branches")
        self.steps = [self.turns(joint) for joint in leg.joints]

    @staticmethod
    def turns(joint):
        """Rotations from the antecedent, about z and x alternately."""
        return [("z", Linear(joint.gamma)), ("x", Linear(joint.alpha)), ("z", joint.theta)]

    def rotation(self, first, last):
        """Axes of frame `last` in frame `first`."""
        if first > last:
            return transpose(self.rotation(last, first))
        turns = []
        for step in self.steps[first:last]:
            for axis, angle in step:
                is_zero = not any(angle.terms.values()) and angle.constant == 0.0
                if is_zero:
                    continue
                mergeable = turns and turns[-1][0] == axis
                if mergeable and (self.merged or not turns[-1][1].terms or not angle.terms):
                    turns[-1] = (axis, turns[-1][1] + angle)
                else:
                    turns.append((axis, angle))
        result = identity(3)
        for axis, angle in turns:
            turn = about_z if axis == "z" else about_x
            result = product(result, turn(self.angles.pair(angle)))
        return result

    def offset(self, index):
        """Origin of body `index` in its antecedent's frame."""
        joint = self.joints[index]
        r = scalar(joint.r.constant)
        for name, factor in joint.r.terms.items():
            r = r + self.angles.variables[name] * factor
        c, s = self.angles.pair(Linear(joint.alpha))
        along = [scalar(joint.d), -s * r, scalar(joint.b) + c * r]
        return apply(about_z(self.angles.pair(Linear(joint.gamma))), along)


@dataclass
class Motion:
    """Motion of a body in its own frame: angular velocity, angular acceleration, acceleration of the origin."""

    omega: list
    alpha: list
    acceleration: list


def spin(omega, alpha, p):
    """alpha x p + omega x (omega x p), the squares of omega shared by all points."""
    return apply(spin_matrix(omega, alpha), p)


def spin_matrix(omega, alpha):
    x, y, z = omega
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    ax, ay, az = alpha
    return [
        [-(yy + zz), xy - az, xz + ay],
        [xy + az, -(xx + zz), yz - ax],
        [xz - ay, yz + ax, -(xx + yy)],
    ]


def body_wrench(symbol, motion):
    """Force and moment about the origin for one unit of an inertial parameter, in the body's frame."""
    zero = vector([0, 0, 0])
    if symbol == "m":
        return motion.acceleration, zero
    if symbol in ("mx", "my", "mz"):
        axis = "xyz".index(symbol[1])
        unit = vector([float(i == axis) for i in range(3)])
        force = transpose(spin_matrix(motion.omega, motion.alpha))[axis]
        return force, cross(unit, motion.acceleration)
    i, j = "xyz".index(symbol[0]), "xyz".index(symbol[1])
    tensor = [[ZERO] * 3 for _ in range(3)]
    tensor[i][j] = tensor[j][i] = ONE
    # omega x (I omega), for I with a single entry and its mirror image.
    momentum = apply(tensor, motion.omega)
    return zero, add(apply(tensor, motion.alpha), cross(motion.omega, momentum))


class LegModel:
    """Kinematics and columns of one leg (or of a serial robot)."""

    def __init__(self, robot, leg, angles, form):
        self.leg, self.form = leg, form
        self.chain = Chain(leg, angles, form.merged)
        n = len(leg.joints)
        self.n = n
        self.rotations = [self.chain.rotation(j, j + 1) for j in range(n)]
        self.offsets = [self.chain.offset(j) for j in range(n)]
        self.moving = [j for j, joint in enumerate(leg.joints) if joint.kind != "fixed"]
        self.gravity = apply(transpose(matrix(leg.base_rotation)), vector(robot.gravity))

    def rate(self, j, values):
        return values.get(j, ZERO)

    def forward(self, rates, accelerations, base_acceleration):
        """The Newton-Euler recursion towards the end."""
        omega, alpha = vector([0, 0, 0]), vector([0, 0, 0])
        acceleration = base_acceleration
        motions = []
        for j, joint in enumerate(self.leg.joints):
            back = transpose(self.rotations[j])
            moved = add(acceleration, spin(omega, alpha, self.offsets[j]))
            acceleration = apply(back, moved)
            omega, alpha = apply(back, omega), apply(back, alpha)
            rate, rise = rates.get(j, ZERO), accelerations.get(j, ZERO)
            if joint.kind == "revolute":
                alpha = add(add(alpha, scale(Z, rise)), cross(omega, scale(Z, rate)))
                omega = add(omega, scale(Z, rate))
            elif joint.kind == "prismatic":
                slide = scale(cross(omega, Z), rate * 2.0)
                acceleration = add(add(acceleration, scale(Z, rise)), slide)
            motions.append(Motion(omega, alpha, acceleration))
        return motions

    def jacobian(self, frame):
        """Velocity of the end's origin and angular velocity of the end, per joint, in a frame."""
        to_end = vector([0, 0, 0])
        columns = {}
        for j in reversed(range(self.n)):
            axis = apply(self.chain.rotation(frame, j + 1), Z)
            kind = self.leg.joints[j].kind
            if kind == "revolute":
                columns[j] = cross(axis, to_end) + axis
            elif kind == "prismatic":
                columns[j] = axis + vector([0, 0, 0])
            to_end = add(to_end, apply(self.chain.rotation(frame, j), self.offsets[j]))
        return [columns[j] for j in self.moving]

    def partials(self, inverse):
        """Velocities of every body, in its frame, per velocity of the end."""
        width = len(inverse[0])
        spins, moves = [vector([0] * 3)] * width, [vector([0] * 3)] * width
        result = []
        for j, joint in enumerate(self.leg.joints):
            back = transpose(self.rotations[j])
            moves = [
                apply(back, add(v, cross(w, self.offsets[j]))) for v, w in zip(moves, spins, strict=True)
            ]
            spins = [apply(back, w) for w in spins]
            if j in self.moving:
                row = inverse[self.moving.index(j)]
                own = [scale(Z, g) for g in row]
                if joint.kind == "revolute":
                    spins = [add(w, g) for w, g in zip(spins, own, strict=True)]
                else:
                    moves = [add(v, g) for v, g in zip(moves, own, strict=True)]
            result.append((moves, spins))
        return result

    def torques(self, j, force, moment):
        """Joint torques that balance a wrench on body j: the recursion towards the base."""
        found = {}
        for k in reversed(range(j + 1)):
            kind = self.leg.joints[k].kind
            if kind == "revolute":
                found[k] = moment[2]
            elif kind == "prismatic":
                found[k] = force[2]
            force = apply(self.rotations[k], force)
            moment = add(apply(self.rotations[k], moment), cross(self.offsets[k], force))
        return [found.get(k, ZERO) for k in self.moving]

    def columns(self, inverse, rates, accelerations, algebra, wanted):
        """Columns of all parameters: projections with the rows of `inverse`."""
        motions = self.forward(rates, accelerations, scale(self.gravity, -1.0))
        partials = self.partials(inverse) if self.form.columns == "partial" else None
        projection = transpose(inverse)
        found = {}
        for j, joint in enumerate(self.leg.joints):
            for symbol in joint.parameters:
                name = wanted(joint, symbol)
                if name is None:
                    continue
                if symbol in INERTIA:
                    force, moment = body_wrench(symbol, motions[j])
                    if partials is None:
                        found[name] = apply(projection, self.torques(j, force, moment))
                    else:
                        moves, spins = partials[j]
                        found[name] = [
                            dot(v, force) + dot(w, moment) for v, w in zip(moves, spins, strict=True)
                        ]
                elif j in self.moving:
                    factor = {
                        "ia": accelerations[j],
                        "fv": rates[j],
                        "fs": algebra.sign(rates[j]) if symbol == "fs" else None,
                        "off": ONE,
                    }[symbol]
                    found[name] = scale(inverse[self.moving.index(j)], factor)
        return found
