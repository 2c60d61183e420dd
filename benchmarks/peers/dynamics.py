"""Dynamics of given parameters as users of a peer would write them.

The functions are inverse dynamics, mass matrix, bias and forward dynamics. Along a leg: the recursive
Newton-Euler algorithm for torques, composite bodies for mass matrices, or partial velocities of the bodies.
Across legs: projection by reduced Jacobians. Systems are solved by L D Lᵀ if symmetric, else by elimination.
`best` takes the form with the fewest operations.
"""

import itertools

from .algebra import ONE, ZERO, add, apply, cross, dot, identity, product, scale, sub, transpose, vector
from .casadi_peer import Casadi, count
from .closure import close
from .model import Angles, LegModel, Motion, spin_matrix
from .platform import Platform
from .robot import INVERSES, end_drift, independent_rows, rotation_to, symbols, values_of
from .search import PAIR, forms

TENSOR = [["xx", "xy", "xz"], ["xy", "yy", "yz"], ["xz", "yz", "zz"]]


class Body:
    """Mass, first moments and tensor about the origin of a frame."""

    def __init__(self, value):
        self.m = value("m")
        self.s = [value(k) for k in ("mx", "my", "mz")]
        self.i = [[value(k) for k in row] for row in TENSOR]

    @classmethod
    def of(cls, m, s, i):
        made = cls(lambda _: ZERO)
        made.m, made.s, made.i = m, s, i
        return made

    def wrench(self, motion):
        """Force and moment about the origin that cause the motion."""
        force = add(scale(motion.acceleration, self.m), apply(spin_matrix(motion.omega, motion.alpha), self.s))
        moment = add(apply(self.i, motion.alpha), cross(motion.omega, apply(self.i, motion.omega)))
        return force, add(moment, cross(self.s, motion.acceleration))

    def push(self, move, spin):
        """Momentum of a velocity and an angular velocity."""
        linear = add(scale(move, self.m), cross(spin, self.s))
        return linear, add(apply(self.i, spin), cross(self.s, move))

    def seen(self, rotation, p):
        """The same body in a frame whose axes and origin are given in its own."""
        s = apply(rotation, self.s)
        i = product(product(rotation, self.i), transpose(rotation))
        i = [[i[min(a, b)][max(a, b)] for b in range(3)] for a in range(3)]
        # About the new origin: (2 s p + m p p) 1 - s pᵀ - p sᵀ - m p pᵀ, with t = s + m p.
        t = add(s, scale(p, self.m))
        both = dot(p, add(s, t))
        moved = [[ZERO] * 3 for _ in range(3)]
        for a, b in itertools.combinations_with_replacement(range(3), 2):
            entry = i[a][b] - p[a] * t[b] - s[a] * p[b]
            moved[a][b] = moved[b][a] = entry + both if a == b else entry
        return Body.of(self.m, t, moved)

    def __add__(self, other):
        rows = [[ZERO] * 3 for _ in range(3)]
        for a, b in itertools.combinations_with_replacement(range(3), 2):
            rows[a][b] = rows[b][a] = self.i[a][b] + other.i[a][b]
        return Body.of(self.m + other.m, add(self.s, other.s), rows)


class Values:
    """Parameter values by name; zero if a robot does not have the parameter."""

    def __init__(self, names, scalars):
        self.known = dict(zip(names, scalars, strict=True))

    def of(self, *suffix):
        return lambda symbol: self.known.get("_".join([symbol, *suffix]), ZERO)


def leg_torques(model, values, suffix, rates, accelerations, algebra, gravity=True):
    """Torques of a leg's moving joints by the recursive Newton-Euler algorithm."""
    base = scale(model.gravity, -1.0) if gravity else vector([0] * 3)
    motions = model.forward(rates, accelerations, base)
    force, moment = vector([0] * 3), vector([0] * 3)
    found = {}
    for j in reversed(range(model.n)):
        value = values.of(model.leg.joints[j].name, *suffix)
        own_force, own_moment = Body(value).wrench(motions[j])
        force, moment = add(force, own_force), add(moment, own_moment)
        found[j] = moment[2] if model.leg.joints[j].kind == "revolute" else force[2]
        if j in model.moving:
            found[j] = found[j] + joint_torque(value, rates.get(j, ZERO), accelerations.get(j, ZERO), algebra)
        force = apply(model.rotations[j], force)
        moment = add(apply(model.rotations[j], moment), cross(model.offsets[j], force))
    return [found[j] for j in model.moving]


def joint_torque(value, rate, acceleration, algebra):
    """Torque of rotor inertia and friction."""
    dry = value("fs")
    sign = ZERO if dry.is_zero else algebra.sign(rate) * dry
    return value("ia") * acceleration + value("fv") * rate + sign + value("off")


def leg_masses(model, values, suffix):
    """The mass matrix of a leg's moving joints by composite bodies."""
    place = {j: k for k, j in enumerate(model.moving)}
    size = len(model.moving)
    masses = [[ZERO] * size for _ in range(size)]
    whole = Body(lambda _: ZERO)
    for j in reversed(range(model.n)):
        value = values.of(model.leg.joints[j].name, *suffix)
        whole = whole + Body(value)
        if j in place:
            is_turn = model.leg.joints[j].kind == "revolute"
            axis, none = vector([0, 0, 1]), vector([0] * 3)
            force, moment = whole.push(none, axis) if is_turn else whole.push(axis, none)
            for k in reversed(range(j + 1)):
                if k in place:
                    entry = moment[2] if model.leg.joints[k].kind == "revolute" else force[2]
                    entry = entry + value("ia") if k == j else entry
                    masses[place[j]][place[k]] = masses[place[k]][place[j]] = entry
                force = apply(model.rotations[k], force)
                moment = add(apply(model.rotations[k], moment), cross(model.offsets[k], force))
        whole = whole.seen(model.rotations[j], model.offsets[j])
    return masses


def quadratic(masses, jacobian):
    """Upper triangle of Jᵀ M J."""
    pushed = product(masses, jacobian)
    columns, back = transpose(pushed), transpose(jacobian)
    size = len(back)
    found = [[ZERO] * size for _ in range(size)]
    for a, b in itertools.combinations_with_replacement(range(size), 2):
        found[a][b] = found[b][a] = dot(back[a], columns[b])
    return found


def solve_symmetric(matrix, vector_):
    """Solves a system by L D Lᵀ."""
    n = len(vector_)
    rows, x = [list(row) for row in matrix], list(vector_)
    inverses = []
    for k in range(n):
        inverses.append(ONE / rows[k][k])
        for i in range(k + 1, n):
            factor = rows[k][i] * inverses[k]
            for j in range(i, n):
                rows[i][j] = rows[i][j] - factor * rows[k][j]
            x[i] = x[i] - factor * x[k]
    for k in reversed(range(n)):
        x[k] = (x[k] - dot(rows[k][k + 1 :], x[k + 1 :])) * inverses[k]
    return x


class Serial:
    """A chain without loops."""

    def __init__(self, robot, algebra, inputs, names, form, homes, actuated):
        (leg,) = robot.legs
        self.algebra = algebra
        given = symbols(algebra, inputs)
        self.given = given
        angles = Angles(algebra, {joint.name: given["joints"][j] for j, joint in enumerate(leg.joints)})
        self.model = LegModel(robot, leg, angles, form)
        self.values = Values(names, given["parameters"])
        self.rates = dict(enumerate(given.get("joint_velocities", [])))

    def inverse_dynamics(self):
        return self.torques(dict(enumerate(self.given["joint_accelerations"])))

    def torques(self, accelerations):
        return leg_torques(self.model, self.values, (), self.rates, accelerations, self.algebra)

    def bias(self):
        return self.torques({})

    def masses(self):
        return leg_masses(self.model, self.values, ())

    def forward_dynamics(self):
        return solve_symmetric(self.masses(), sub(self.given["torques"], self.bias()))


class Parallel:
    """Legs that carry a platform, projected on it by their reduced Jacobians."""

    def __init__(self, robot, algebra, inputs, names, form, homes, actuated):
        self.robot, self.algebra, self.form = robot, algebra, form
        given = symbols(algebra, inputs)
        self.given = given
        self.values = Values(names, given.get("parameters", []))
        dof = actuated["dof"]
        motion = {key: given.get(key, [ZERO] * dof) for key in ("twist", "acceleration")}
        self.angles = Angles(algebra, {})
        self.platform = Platform(robot, algebra, self.angles, {**given, **motion})
        self.legs, start = [], 0
        for leg in robot.legs:
            moving = [joint for joint in leg.joints if joint.kind != "fixed"]
            known = self.angles.known.items()
            self.angles.known = {key: pair for key, pair in known if key[0][0][0] == "phi"}
            close(self.angles, algebra, self.platform, leg, given["pose"], homes[start : start + len(moving)])
            self.legs.append(self.leg(leg, actuated["joints"], start))
            start += len(moving)

    def leg(self, leg, actuated, start):
        """Model, Jacobian of the moving joints per platform velocity, rates and accelerations of a leg."""
        model = LegModel(self.robot, leg, self.angles, self.form)
        frame = self.form.frame if self.form.frame >= 0 else model.n
        to_frame = transpose(rotation_to(model, self.platform, leg, frame))
        partials, velocity, acceleration = self.platform.end(leg)
        seen = lambda pair: apply(to_frame, pair[0]) + apply(to_frame, pair[1])  # noqa: E731
        jacobian = model.jacobian(frame)
        rows = independent_rows(jacobian, leg)
        inverse = INVERSES[self.form.inverse](transpose([[column[i] for i in rows] for column in jacobian]))
        moves = transpose([[seen(pair)[i] for i in rows] for pair in partials])
        full = product(inverse, moves)
        if self.form.staged:
            rates = apply(inverse, [seen(velocity)[i] for i in rows])
        else:
            rates = apply(full, values_of(self.platform))
        rates = dict(zip(model.moving, rates, strict=True))
        drift = end_drift(model, rates, frame)
        rest = [seen(acceleration)[i] - drift[i] for i in rows]
        accelerations = dict(zip(model.moving, apply(inverse, rest), strict=True))
        kept = [full[k] for k in range(len(model.moving)) if start + k in actuated]
        return model, (inverse, moves, full), rates, accelerations, kept

    def project(self, jacobians, torques):
        inverse, moves, full = jacobians
        if self.form.staged:
            return apply(transpose(moves), apply(transpose(inverse), torques))
        return apply(transpose(full), torques)

    def torques(self):
        """Inputs projected on the platform, for the given motion."""
        back = transpose(self.platform.rotation)
        gravity = vector(self.robot.gravity)
        motion = Motion(
            apply(back, self.platform.omega),
            apply(back, self.platform.alpha),
            apply(back, sub(self.platform.acceleration, gravity)),
        )
        force, moment = self.carried().wrench(motion)
        force, moment = apply(self.platform.rotation, force), apply(self.platform.rotation, moment)
        total = [dot(v, force) + dot(w, moment) for v, w in self.platform.moves]
        for model, jacobians, rates, accelerations, _ in self.legs:
            suffix = (model.leg.name,)
            of_leg = leg_torques(model, self.values, suffix, rates, accelerations, self.algebra)
            total = add(total, self.project(jacobians, of_leg))
        return total

    def carried(self):
        return Body(self.values.of("platform")) + Body(self.values.of("payload"))

    def masses(self):
        body, back = self.carried(), transpose(self.platform.rotation)
        moves = [(apply(back, v), apply(back, w)) for v, w in self.platform.moves]
        pushed = [body.push(v, w) for v, w in moves]
        size = len(moves)
        total = [[dot(v, f) + dot(w, m) for f, m in pushed] for v, w in moves]
        for model, (inverse, move, full), _, _, _ in self.legs:
            masses = leg_masses(model, self.values, (model.leg.name,))
            own = quadratic(quadratic(masses, inverse), move) if self.form.staged else quadratic(masses, full)
            total = [[total[a][b] + own[min(a, b)][max(a, b)] for b in range(size)] for a in range(size)]
        return total

    def bias(self):
        return self.torques()

    def inverse_jacobian(self):
        return [row for leg in self.legs for row in leg[4]]

    def inverse_dynamics(self):
        """Least-norm torques."""
        jacobian = self.inverse_jacobian()
        if len(jacobian) == len(jacobian[0]):
            return apply(transpose(INVERSES[self.form.inverse](jacobian)), self.torques())
        normal = quadratic(identity(len(jacobian)), jacobian)
        return apply(jacobian, solve_symmetric(normal, self.torques()))

    def forward_dynamics(self):
        driven = apply(transpose(self.inverse_jacobian()), self.given["torques"])
        return solve_symmetric(self.masses(), sub(driven, self.torques()))


def derive(robot, algebra, name, inputs, names, form, homes, actuated):
    """The function's entries as a matrix of one column, row by row."""
    kind = Serial if robot.motion is None else Parallel
    model = kind(robot, algebra, inputs, names, form, homes, actuated)
    if name == "mass_matrix":
        return [[entry for row in model.masses() for entry in row]]
    return [getattr(model, name)()]


def best(robot, name, inputs, names, homes, actuated):
    """CasADi's function after `cse` in the form with the fewest operations, and its count."""
    found = []
    for index, form in enumerate(forms(robot)):
        if form.columns != "recursion":
            continue
        algebra = Casadi()
        try:
            derived = derive(robot, algebra, name, inputs, names, form, homes, actuated)
        except NotImplementedError:
            continue
        function = algebra.function("peer", inputs, derived, cse=True)
        counted = count(function)
        rank = counted.operations + PAIR * counted.trigonometric_pairs
        found.append((rank, index, form, counted, function))
    return min(found, default=None, key=lambda entry: entry[:2])
