"""Derivatives of the dynamics by displacement and twist: overact compared with CasADi's best form.

CasADi differentiates the dynamics of `dynamics.py` along displacements of the pose, or by the twist, in forward
or reverse mode. Each is done directly, and implicitly as in Carpentier and Mansard 2018: the solved torques or
accelerations are held while the residual forces are differentiated, and the result is solved for. `best` takes
the form with the fewest operations after `cse`.
"""

import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import casadi

from . import compiled, controller, dynamics, ours
from .algebra import Scalar, apply, transpose
from .casadi_peer import Casadi, count
from .count import Count
from .description import load
from .search import PAIR, forms

ROBOTS = ["rx90", "kuka_lwr", "stanford", "dualv", "delta", "hexapod"]
FUNCTIONS = [f"{of}_dynamics_by_{by}" for of in ("inverse", "forward") for by in ("displacement", "twist")]
#: Modes in which CasADi differentiates.
MODES = os.environ.get("MODES", "forward,reverse,jacobian").split(",")


@dataclass
class Task(ours.Function):
    """A derivative of standard parameters, and what it differentiates."""

    @property
    def rust_name(self):
        return self.name

    @property
    def base(self):
        return self.name.split("_by_")[0]

    @property
    def by_twist(self):
        return self.name.endswith("twist")


def pose_rates(pose, names):
    """Rates of a pose's coordinates per displacement, rotations about base axes."""
    if "qw" not in names:
        return casadi.SX.eye(len(names))
    at = names.index("qw")
    w, x, y, z = (pose[at + k] for k in range(4))
    rates = casadi.SX(at + 4, at + 3)
    rates[:at, :at] = casadi.SX.eye(at)
    rates[at:, at:] = casadi.vertcat(
        casadi.horzcat(-x, -y, -z), casadi.horzcat(w, z, -y), casadi.horzcat(-z, w, x), casadi.horzcat(y, -x, w)
    ) * 0.5
    return rates


def sx(rows):
    """Vectors or matrices of scalars as SX."""
    if isinstance(rows[0], Scalar):
        return casadi.vertcat(*[casadi.SX(entry.value) for entry in rows])
    return casadi.vertcat(*[casadi.horzcat(*[casadi.SX(entry.value) for entry in row]) for row in rows])


def scalars(matrix):
    """An SX matrix as rows of scalars; its zeros as numbers."""
    def scalar(entry):
        return Scalar(float(entry)) if entry.is_constant() else Scalar(entry)

    return [[scalar(matrix[i, j]) for j in range(matrix.size2())] for i in range(matrix.size1())]


def derivative(of, variable, seeds, mode):
    """Derivative of a vector along seeds in one of CasADi's modes."""
    if mode == "forward":
        return casadi.jtimes(of, variable, seeds)
    if mode == "reverse":
        return casadi.mtimes(casadi.jtimes(of, variable, casadi.SX.eye(of.numel()), True).T, seeds)
    return casadi.mtimes(casadi.jacobian(of, variable), seeds)


class Derivative:
    """The derivatives of one form of a robot's dynamics."""

    def __init__(self, robot, algebra, task, names, form, homes, driven, dof):
        kind = dynamics.Serial if robot.motion is None else dynamics.Parallel
        self.model = kind(robot, algebra, task.inputs, names, form, homes, driven)
        self.task, self.form = task, form
        given = self.model.given
        vector = lambda name: casadi.vertcat(*[s.value for s in given[name]])  # noqa: E731
        is_tree = robot.motion is None
        self.twist = vector("joint_velocities" if is_tree else "twist")
        self.pose = vector("joints" if is_tree else "pose")
        self.is_tree, self.dof = is_tree, dof
        self.torques = vector("torques") if "torques" in given else None

    def variable(self):
        if self.task.by_twist:
            return self.twist, casadi.SX.eye(self.dof)
        names = [str(k) for k in range(self.dof)] if self.is_tree else self.task.document["pose"]
        return self.pose, pose_rates(self.pose, names)

    def direct(self, mode):
        output = sx(getattr(self.model, self.task.base)())
        return derivative(output, *self.variable(), mode)

    def implicit(self, mode):
        """The solved quantity is a symbol while the residual is differentiated."""
        model = self.model
        solved = getattr(model, self.task.base)()
        held = casadi.SX.sym("held", len(solved))
        jacobian = None if self.is_tree else model.inverse_jacobian()
        if self.task.base == "inverse_dynamics":
            forces = sx(model.inverse_dynamics() if self.is_tree else model.torques())
            if self.is_tree:
                return None
            if len(jacobian) != self.dof:
                return self.least_norm(mode, jacobian, forces, held, solved)
            residual = forces - casadi.mtimes(sx(jacobian).T, held)
            rows = derivative(residual, *self.variable(), mode)
            rows = casadi.substitute(rows, held, sx(solved))
            inverse = transpose(dynamics.INVERSES[self.form.inverse](jacobian))
            columns = [apply(inverse, column) for column in transpose(scalars(rows))]
            return sx(transpose(columns))
        accelerations = [Scalar(held[k]) for k in range(self.dof)]
        if self.is_tree:
            forces = sx(model.torques(dict(enumerate(accelerations)))) - self.torques
        else:
            forces = self.forces_at(accelerations) - casadi.mtimes(sx(jacobian).T, self.torques)
        rows = derivative(forces, *self.variable(), mode)
        rows = casadi.substitute(rows, held, sx(solved))
        columns = [dynamics.solve_symmetric(model.masses(), [-e for e in c]) for c in transpose(scalars(rows))]
        return sx(transpose(columns))

    def least_norm(self, mode, jacobian, forces, held, solved):
        """Derivative of J (JᵀJ)⁻¹ F with τ and (JᵀJ)⁻¹ F held."""
        normal = dynamics.quadratic(dynamics.identity(len(jacobian)), jacobian)
        multipliers = dynamics.solve_symmetric(normal, self.model.torques())
        other = casadi.SX.sym("multipliers", self.dof)
        matrix = sx(jacobian)
        residual = forces - casadi.mtimes(matrix.T, held)
        own = casadi.mtimes(matrix, other)
        rows, moved = (derivative(of, *self.variable(), mode) for of in (residual, own))
        rows, moved = (
            casadi.substitute(casadi.substitute(of, held, sx(solved)), other, sx(multipliers)) for of in (rows, moved)
        )
        right = rows - casadi.mtimes(matrix.T, moved)
        columns = [
            apply(jacobian, dynamics.solve_symmetric(normal, column)) for column in transpose(scalars(right))
        ]
        return moved + sx(transpose(columns))

    def forces_at(self, accelerations):
        """Forces on the platform at given accelerations."""
        inputs = [*self.task.inputs, ("acceleration", self.dof)]
        algebra = Casadi()
        model = dynamics.Parallel(
            self.model.robot, algebra, inputs, self.names, self.form, self.homes, self.driven
        )
        given = [algebra.symbols[f"{name}[{i}]"] for name, length in inputs for i in range(length)]
        own = self.model.algebra.symbols
        by = [
            accelerations[i].value if name == "acceleration" else own[f"{name}[{i}]"]
            for name, length in inputs
            for i in range(length)
        ]
        return casadi.substitute(sx(model.torques()), casadi.vertcat(*given), casadi.vertcat(*by))


def candidates(robot, task, names, homes, driven):
    """All forms with their counts."""
    for index, form in enumerate(forms(robot)):
        if form.columns != "recursion":
            continue
        for kind in ("direct", "implicit"):
            for mode in MODES:
                algebra = Casadi()
                try:
                    made = Derivative(robot, algebra, task, names, form, homes, driven, driven["dof"])
                except NotImplementedError:
                    continue
                made.names, made.homes, made.driven = names, homes, driven
                matrix = getattr(made, kind)(mode)
                if matrix is None:
                    continue
                entries = casadi.cse(casadi.vec(casadi.densify(matrix).T))
                rank, counted, function = ranked(algebra, task, entries)
                yield rank, index, f"{kind}, {mode}, {form}", counted, function


def ranked(algebra, task, entries):
    """Rank by operations, count and function of CasADi for the entries of a task."""
    arguments = [
        casadi.vertcat(*[algebra.symbols[f"{name}[{i}]"] for i in range(length)])
        for name, length in task.inputs
    ]
    function = casadi.Function("peer", arguments, [entries])
    counted = count(function)
    return counted.operations + PAIR * counted.trigonometric_pairs, counted, function


def best(robot, task, names, homes, driven):
    """CasADi's form with the fewest operations."""
    return min(candidates(robot, task, names, homes, driven), key=lambda entry: entry[:2])


def tasks(robot, document, is_tree):
    """The functions of a robot with their counts."""
    dof, n = document["dof"], document["actuators"]
    counts = own_counts(robot)
    for name in FUNCTIONS:
        is_inverse = name.startswith("inverse")
        if is_tree:
            inputs = [("joints", dof), ("joint_velocities", dof)]
            inputs.append(("joint_accelerations", dof) if is_inverse else ("torques", n))
        else:
            inputs = [("pose", len(document["pose"])), ("twist", dof)]
            inputs.append(("acceleration", dof) if is_inverse else ("torques", n))
        inputs.append(("parameters", len(document["parameters"])))
        yield Task(
            robot=robot,
            name=name,
            source="joints" if is_tree else "pose",
            kind="standard",
            inputs=inputs,
            shape=[n if is_inverse else dof, dof],
            columns=document["parameters"],
            count=counts[name],
            document=document,
        )


def own_counts(robot):
    """overact's counts of all derivatives of a robot."""
    return counts_of(ours.description(robot), FUNCTIONS)


def counts_of(description, names):
    """overact's counts of functions, from the documentation of the generated code."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.rs"
        call = [ours.BINARY, "generate", description, "-o", path, "--effort", ours.EFFORT]
        call += ["--functions", ",".join(names)]
        subprocess.run([str(part) for part in call], capture_output=True, text=True, check=True)
        text = path.read_text()
    return {name: documented(text[: text.index(f"pub fn {name}(")]) for name in names}


def documented(text):
    """The last count in generated code."""
    line = [line for line in text.splitlines() if re.search(r"/// \d+ operations \(", line)][-1]

    def number(what):
        found = re.search(rf"(\d+) {what}", line)
        return int(found.group(1)) if found else 0

    kinds = ["addition", "multiplication", "division", "square root", "trigonometric pair", "arc tangent"]
    return Count(*[number(kind) for kind in kinds])


def cells(only, samples):
    """All derivatives of the robots with CasADi's best forms, after checking their agreement."""
    for robot in ROBOTS:
        if not compiled.is_selected(robot, only):
            continue
        document, own = ours.inspect(robot), load(ours.description(robot))
        is_tree = own.motion is None
        driven = {"dof": document["dof"], "joints": [] if is_tree else controller.actuated(robot)}
        for task in tasks(robot, document, is_tree):
            print(f"{task.robot}, {task.name} …", file=sys.stderr, flush=True)
            given = own, task, task.columns, document["home_joints"], driven
            form, counted, peer = compiled.kept(task, repr(MODES), partial(best, *given))
            title = f"{document['robot']}, {task.name.replace('_', ' ')}"
            cell = compiled.Cell(title, task, counted, form, peer, partial(controller.sample, task))
            cell.check(samples)
            yield cell


def measure(only, samples, timed, core, rounds):
    """The table."""
    return compiled.table(list(cells(only, samples)), timed, core, rounds)
