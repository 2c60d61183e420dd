"""Robots whose legs are cables, as users of a peer would write them.

A cable is straight from an eyelet E to the platform point P: ℓ = |P - E|, with the unit vector e along it. Over a
pulley of radius ρ that swivels about z, let r be the distance of P from that axis, h its height and b = r - ρ. The
straight part is a tangent of the pulley, s² = b² + h² - ρ². Its direction (sin β, cos β) solves
b = s sin β - ρ cos β and h = s cos β + ρ sin β, and ℓ = s + ρ β. In both cases ℓ' = e · P'. The change of e adds to ℓ''

- (P'² - ℓ'²)/ℓ for an eyelet,
- v²/s + sin β w²/r for a pulley, with the velocities of P across the cable in its plane, v, and across the plane, w.

The forces of a drive act on its length: ia ℓ'' + fv ℓ' + fs sign(ℓ') + off. A tension is a negative force on it.
`best` takes the form with the fewest operations.
"""

import itertools
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
    scale,
    solve_by_elimination,
    sub,
    transpose,
    vector,
)
from .casadi_peer import Casadi, count
from .dynamics import Body, Values, joint_torque, quadratic, solve_symmetric
from .model import Angles, Motion, spin_matrix
from .platform import Platform
from .robot import INVERSES, symbols
from .search import PAIR

NONE = vector([0, 0, 0])
DRIVE = ["ia", "fv", "fs", "off"]


@dataclass(frozen=True)
class Form:
    """One way of writing the functions."""

    velocities: str = "points"  # of each point by a cross product, or a sum over the platform's "axes"
    accelerations: str = "points"  # likewise, or "rows": the Jacobian's row times the platform's acceleration
    moments: str = "unit"  # lever x e; "line": the lever times the vector from the eyelet to the platform's origin
    rates: str = "rows"  # the row times the twist, or e times the velocity of the "points"
    turning: str = "planes"  # of a pulley: by unit vectors of its plane, or by "squares" of the velocities
    wrench: str = "body"  # axes in which the platform's wrench is computed, or "base"
    solution: str = "substitution"  # of the kept forces, or the inverse by "elimination" or "cofactors"


CHOICES = {
    "velocities": ["points", "axes"],
    "accelerations": ["points", "axes", "rows"],
    "moments": ["unit", "line"],
    "rates": ["rows", "points"],
    "turning": ["planes", "squares"],
    "wrench": ["body", "base"],
    "solution": ["substitution", "elimination", "cofactors"],
}
COURSE = ["moments", "turning"]
MOTION = [*COURSE, "velocities", "rates", "accelerations"]
#: Choices on which each function depends.
FUNCTIONS = {
    "joints": [],
    "inverse_jacobian": COURSE,
    "jacobian": COURSE,
    "joint_velocities": [*COURSE, "velocities", "rates"],
    "joint_accelerations": MOTION,
    "idm_red_platform": [*MOTION, "wrench"],
    "idm_red_actuators": [*MOTION, "wrench", "solution"],
    "inverse_dynamics": [*MOTION, "wrench", "solution"],
    "mass_matrix": [*COURSE, "wrench"],
    "bias": [*MOTION, "wrench"],
    "forward_dynamics": [*MOTION, "wrench"],
}


def combination(columns, factors):
    """A sum of multiples of columns; sums that differ by a sign share their terms."""
    used = [(column, factor) for column, factor in zip(columns, factors, strict=True) if factor != 0.0]
    total, sign = NONE, math.copysign(1.0, used[0][1]) if used else 1.0
    for column, factor in used:
        term = scale(column, abs(factor))
        total = add(total, term) if factor * sign > 0.0 else sub(total, term)
    return scale(total, sign)


class Point:
    """Lever of a platform point, and its velocity and acceleration, in the base axes."""

    def __init__(self, platform, at, form):
        axes = transpose(platform.rotation)
        spin = spin_matrix(platform.omega, platform.alpha)
        self.lever = combination(axes, at)
        # The opposite point has the opposite motion about the origin.
        sign = next((math.copysign(1.0, one) for one in at if one), 1.0)
        lever = scale(self.lever, sign)
        if form.velocities == "axes":
            turned = combination([cross(platform.omega, axis) for axis in axes], at)
        else:
            turned = scale(cross(platform.omega, lever), sign)
        self.velocity = add(platform.velocity, turned)
        if form.accelerations == "axes":
            turned = combination([apply(spin, axis) for axis in axes], at)
        else:
            turned = scale(apply(spin, lever), sign)
        self.acceleration = add(platform.acceleration, turned)
        #: Acceleration of the point of a platform that does not accelerate.
        self.drift = scale(apply(spin_matrix(platform.omega, NONE), lever), sign)


class Eyelet:
    """The course of a cable from an eyelet."""

    def __init__(self, algebra, leg, to_origin, lever, form):
        between = add(to_origin, lever)
        self.length = algebra.sqrt(dot(between, between))
        self.inverse = ONE / self.length
        self.direction = scale(between, self.inverse)
        if form.moments == "line":
            self.moment = scale(cross(lever, to_origin), self.inverse)
        else:
            self.moment = cross(lever, self.direction)

    def rate(self, velocity):
        return dot(self.direction, velocity)

    def turning(self, velocity, rate):
        return (dot(velocity, velocity) - rate * rate) * self.inverse


class Pulley:
    """The course of a cable over a swivelling pulley, in the axes of the leg's base."""

    def __init__(self, algebra, leg, to_origin, lever, form):
        self.form, radius = form, leg.cable.pulley
        self.axes = matrix(leg.base_rotation)
        self.at = apply(transpose(self.axes), add(to_origin, lever))
        x, y, h = self.at
        distance = algebra.sqrt(x * x + y * y)
        b = distance - radius
        square = b * b + h * h
        self.straight = algebra.sqrt(square - radius * radius)
        sine, cosine = self.straight * b + h * radius, self.straight * h - b * radius
        self.length = self.straight + algebra.arc_tangent(sine, cosine) * radius
        self.inverse = ONE / distance
        if form.turning == "planes":
            self.sine, self.cosine = (one * (ONE / square) for one in (sine, cosine))
            self.out = [x * self.inverse, y * self.inverse]
            local = [*scale(self.out, self.sine), self.cosine]
        else:
            self.factor = sine / (square * distance)
            local = [x * self.factor, y * self.factor, cosine / square]
        self.direction = apply(self.axes, local)
        self.moment = cross(lever, self.direction)

    def in_plane(self, velocity):
        """Velocity of the point out from the axis and along it, and across the plane."""
        x, y, z = apply(transpose(self.axes), velocity)
        return self.out[0] * x + self.out[1] * y, z, self.out[0] * y - self.out[1] * x

    def rate(self, velocity):
        if self.form.turning == "planes":
            out, along, _ = self.in_plane(velocity)
            return out * self.sine + along * self.cosine
        return dot(self.direction, velocity)

    def turning(self, velocity, rate):
        if self.form.turning == "planes":
            out, along, beside = self.in_plane(velocity)
            across = out * self.cosine - along * self.sine
            turned = beside * beside * (self.sine * self.inverse)
            return across * across / self.straight + turned
        x, y, _ = apply(transpose(self.axes), velocity)
        beside = (self.at[0] * y - self.at[1] * x) * self.inverse
        squares = beside * beside
        return (dot(velocity, velocity) - rate * rate - squares) / self.straight + squares * self.factor


@dataclass
class Cable:
    """One cable: its course, its row of the Jacobian, rate and acceleration of its length."""

    name: str
    course: Eyelet | Pulley
    row: list
    rate: object
    acceleration: object


class CableRobot:
    """A platform that is held by cables only."""

    def __init__(self, robot, algebra, task, form):
        self.robot, self.algebra, self.form = robot, algebra, form
        self.names, self.document = task.columns, task.document
        self.given = symbols(algebra, task.inputs)
        none = [ZERO] * self.document["dof"]
        motion = {key: self.given.get(key, none) for key in ("twist", "acceleration")}
        self.twist, self.acceleration = motion["twist"], motion["acceleration"]
        self.platform = Platform(robot, algebra, Angles(algebra, {}), {**self.given, **motion})
        self.values = Values(self.names, self.given.get("parameters", [ZERO] * len(self.names)))
        self.cables = [self.cable(leg) for leg in robot.legs]

    def cable(self, leg):
        point = Point(self.platform, leg.end_at, self.form)
        moves = [v for v, _ in self.platform.moves if not all(x.is_zero for x in v)]
        place = apply(transpose(moves), self.given["pose"][: len(moves)])
        kind = Pulley if leg.cable.pulley else Eyelet
        course = kind(self.algebra, leg, sub(place, vector(leg.base_at)), point.lever, self.form)
        row = [dot(v, course.direction) + dot(w, course.moment) for v, w in self.platform.moves]
        rate = dot(row, self.twist) if self.form.rates == "rows" else course.rate(point.velocity)
        if self.form.accelerations == "rows":
            along = dot(row, self.acceleration) + dot(course.direction, point.drift)
        else:
            along = dot(course.direction, point.acceleration)
        return Cable(leg.name, course, row, rate, along + course.turning(point.velocity, rate))

    @property
    def rows(self):
        return [cable.row for cable in self.cables]

    # Wrenches on the platform, per independent coordinate.

    def projected(self, force, moment):
        return [dot(v, force) + dot(w, moment) for v, w in self.platform.moves]

    def platform_wrench(self, body):
        platform = self.platform
        back = transpose(platform.rotation)
        lifted = sub(platform.acceleration, vector(self.robot.gravity))
        own = Motion(*(apply(back, one) for one in (platform.omega, platform.alpha, lifted)))
        if self.form.wrench == "body":
            force, moment = body.wrench(own)
            return self.projected(apply(platform.rotation, force), apply(platform.rotation, moment))
        none = [NONE] * 3
        moved = Body.of(body.m, apply(platform.rotation, body.s), none)
        force, moment = moved.wrench(Motion(platform.omega, platform.alpha, lifted))
        _, turning = Body.of(ZERO, NONE, body.i).wrench(own)
        return self.projected(force, add(moment, apply(platform.rotation, turning)))

    def force(self, cable):
        """Force of the drive on the length."""
        value = self.values.of("length", cable.name)
        return joint_torque(value, cable.rate, cable.acceleration, self.algebra)

    def carried(self):
        return Body(self.values.of("platform"))

    def forces(self, others=None):
        """Wrench that causes the motion, less that of other forces on the lengths."""
        own = [self.force(cable) for cable in self.cables]
        own = own if others is None else sub(own, others)
        return add(apply(transpose(self.rows), own), self.platform_wrench(self.carried()))

    # Regressors.

    def drive_factor(self, symbol, cable):
        factors = {"ia": cable.acceleration, "fv": cable.rate, "off": ONE}
        return self.algebra.sign(cable.rate) if symbol == "fs" else factors[symbol]

    def drive_columns(self, rows):
        """Columns of the cables, whose forces act by the rows."""
        found = {}
        for cable, row in zip(self.cables, rows, strict=True):
            for symbol in DRIVE:
                name = f"{symbol}_length_{cable.name}"
                if name in self.names:
                    found[name] = scale(row, self.drive_factor(symbol, cable))
        return found

    def platform_columns(self):
        found = {}
        for symbol in self.robot.platform_parameters:
            name = f"{symbol}_platform"
            if name in self.names:
                unit = Body(lambda one, symbol=symbol: ONE if one == symbol else ZERO)
                found[name] = self.platform_wrench(unit)
        return found

    # Forces of the kept actuators.

    def is_kept(self, cable):
        return cable.name in self.document["kept_actuators"]

    def kept_forces(self, wrench):
        """Forces of the kept cables that have the effect of a wrench."""
        kept = transpose([cable.row for cable in self.cables if self.is_kept(cable)])
        if self.form.solution == "substitution":
            return solve_by_elimination(kept, wrench)
        return apply(INVERSES[self.form.solution](kept), wrench)

    def internal_forces(self):
        """An orthonormal basis of the forces without effect, by Gram and Schmidt."""
        basis = []
        others = [at for at, cable in enumerate(self.cables) if not self.is_kept(cable)]
        for other in others:
            kept = iter(self.kept_forces(scale(self.rows[other], -1.0)))
            unit = identity(len(self.cables))[other]
            found = [next(kept) if self.is_kept(cable) else unit[at] for at, cable in enumerate(self.cables)]
            for one in basis:
                found = sub(found, scale(one, dot(one, found)))
            basis.append(scale(found, ONE / self.algebra.sqrt(dot(found, found))))
        return basis

    # Functions; each returns its entries row by row.

    def joints(self):
        return [cable.course.length for cable in self.cables]

    def inverse_jacobian(self):
        return flat(self.rows)

    def jacobian(self):
        """Least-squares inverse."""
        normal = quadratic(identity(len(self.rows)), self.rows)
        return flat(transpose([solve_symmetric(normal, row) for row in self.rows]))

    def joint_velocities(self):
        return [cable.rate for cable in self.cables]

    def joint_accelerations(self):
        return [cable.acceleration for cable in self.cables]

    def idm_red_platform(self):
        found = self.drive_columns(self.rows) | self.platform_columns()
        return flat(transpose([found[name] for name in self.names]))

    def idm_red_actuators(self):
        kept = iter(identity(self.document["dof"]))
        rows = [next(kept) if self.is_kept(cable) else self.kept_forces(cable.row) for cable in self.cables]
        found = self.drive_columns(rows)
        found |= {name: self.kept_forces(column) for name, column in self.platform_columns().items()}
        return flat(transpose([found[name] for name in self.names]))

    def inverse_dynamics(self):
        """Tensions of the kept cables and a basis of the internal ones, from which the tensions follow."""
        return [*self.kept_forces(scale(self.forces(), -1.0)), *flat(self.internal_forces())]

    def masses(self):
        rotation, body = self.platform.rotation, self.carried()
        moves = self.platform.moves
        if self.form.wrench == "body":
            moves = [(apply(transpose(rotation), v), apply(transpose(rotation), w)) for v, w in moves]
        else:
            body = body.seen(rotation, NONE)
        pushed = [body.push(v, w) for v, w in moves]
        own = [[dot(v, force) + dot(w, moment) for force, moment in pushed] for v, w in moves]
        drives = [self.values.of("length", cable.name)("ia") for cable in self.cables]
        units = identity(len(drives))
        of_drives = quadratic([scale(unit, ia) for unit, ia in zip(units, drives, strict=True)], self.rows)
        # Write each entry above the diagonal once.
        size = range(len(own))
        return [[own[min(a, b)][max(a, b)] + of_drives[a][b] for b in size] for a in size]

    def mass_matrix(self):
        return flat(self.masses())

    def bias(self):
        return self.forces()

    def forward_dynamics(self):
        rest = self.forces(scale(self.given["torques"], -1.0))
        return solve_symmetric(self.masses(), scale(rest, -1.0))


def flat(rows):
    return [entry for row in rows for entry in row]


def choices(robot, name):
    """Choices that change a function of a robot."""
    idle = "moments" if all(leg.cable.pulley for leg in robot.legs) else "turning"
    found = {key: list(ways) for key, ways in CHOICES.items() if key in FUNCTIONS[name] and key != idle}
    if robot.motion != "planar" and "solution" in found:
        # The minors of matrices of more than three rows have many terms.
        found["solution"].remove("cofactors")
    return found


def best(robot, task):
    """CasADi's function after `cse` in the form with the fewest operations, and its count."""
    found = []
    names = choices(robot, task.name)
    for index, ways in enumerate(itertools.product(*names.values())):
        chosen = dict(zip(names, ways, strict=True))
        algebra = Casadi()
        entries = getattr(CableRobot(robot, algebra, task, Form(**chosen)), task.name)()
        function = algebra.function("peer", task.inputs, [entries], cse=True)
        counted = count(function)
        rank = counted.operations + PAIR * counted.trigonometric_pairs
        text = ", ".join(f"{key} {way}" for key, way in chosen.items()) or "–"
        found.append((rank, index, text, counted, function))
    return min(found, key=lambda entry: entry[:2])
