"""Dynamics of given parameters, function by function: overact compared with CasADi's best form."""

import tomllib
from dataclasses import dataclass

import casadi
import numpy as np

from . import casadi_peer, dynamics, ours, report, timing
from .count import Count
from .description import load
from .model import Form
from .peers import AGREEMENT
from .states import states

ROBOTS = ["dualv", "delta", "hexapod", "rx90", "kuka_lwr", "puma560", "stanford"]
FUNCTIONS = ["inverse_dynamics", "mass_matrix", "bias", "forward_dynamics"]


@dataclass
class Function(ours.Function):
    """A function with parameters as inputs."""

    @property
    def rust_name(self):
        return self.name


@dataclass
class Cell:
    """One function of one robot for both tools, and all times."""

    function: Function
    form: Form
    count: Count
    peer: casadi.Function
    times: list[float] | None = None


def function(document, robot, name):
    """overact's function of standard parameters, from the pose or from joints."""
    for entry in document["functions"]:
        if entry["name"] == name and entry["columns"] != "base" and entry["from"] != "actuators":
            inputs = [(i["name"], i["shape"][0]) for i in entry["inputs"]]
            names = {given for given, _ in inputs}
            if "pose" in names and "joints" in names:
                continue
            return Function(
                robot=robot,
                name=name,
                source=entry["from"],
                kind="standard",
                inputs=inputs,
                shape=entry["outputs"][0]["shape"],
                columns=document["parameters"],
                count=Count.from_json(entry),
                document=document,
            )
    raise RuntimeError(f"{robot}: overact has no {name}")


def actuated(robot):
    """Indices of the actuated joints among the moving ones, leg by leg."""
    with open(ours.description(robot), "rb") as file:
        described = tomllib.load(file)
    places, start = [], 0
    for place in described["place"]:
        moving = [j for j in described["leg"][place["shape"]]["joint"] if j["type"] != "fixed"]
        places += [start + k for k, joint in enumerate(moving) if joint.get("actuated")]
        start += len(moving)
    return places


def sample(function, number, seed=1):
    """States with parameters of bodies with inertia: diagonal ones near 1, the others small."""
    rng = np.random.default_rng(seed)
    made = states(function, number, seed)
    is_diagonal = [name.split("_")[0] in ("xx", "yy", "zz", "m", "ia", "fv") for name in function.columns]
    for state in made:
        size = len(function.columns)
        large, small = rng.uniform(0.5, 1.5, size), rng.uniform(-0.1, 0.1, size)
        state["parameters"] = np.where(is_diagonal, large, small)
    return made


def check(title, found, expected):
    """Differences relative to the largest entry of a result."""
    found, expected = (x.reshape(len(x), -1) for x in (found, expected))
    error = (np.abs(found - expected).max(axis=1) / np.abs(expected).max(axis=1)).max()
    if not error < AGREEMENT:
        raise RuntimeError(f"{title}: results differ from overact's by {error:.1e}")


def cells(robot, samples):
    """All functions of a robot, after checking their agreement."""
    document = ours.inspect(robot)
    own = load(ours.description(robot))
    driven = {"dof": document["dof"], "joints": actuated(robot)}
    for name in FUNCTIONS:
        work = function(document, robot, name)
        found = dynamics.best(own, name, work.inputs, work.columns, document["home_joints"], driven)
        if found is None:
            raise RuntimeError(f"{robot}: no form of the peer's {name}")
        _, _, form, counted, peer = found
        given = sample(work, samples)
        values = np.array([peer(*state.values()).full() for state in given])
        check(f"{robot}, {name}", values, work.evaluate(given))
        yield Cell(work, form, counted, peer)


def time(cell, program, core, rounds):
    """Times overact's program and CasADi's C code alternately."""
    work = cell.function
    name = f"{work.robot}_{work.name}"
    path = timing.BUILD / "states" / f"{name}.bin"
    timing.write_states(path, sample(work, timing.STATES, seed=2))
    size = int(np.prod(work.shape))
    peer = timing.c_program("CasADi, cse", name, casadi_peer.c_code(cell.peer), work.inputs, size)
    expected = timing.outputs(program, path, core, work.shape)
    check(f"{name}, C code", timing.outputs(peer, path, core, work.shape), expected)
    cell.times = timing.compare([program, peer], path, core, rounds)


def measure(only, samples, timed, core, rounds):
    """The table of all cells."""
    found = [cell for robot in ROBOTS if not only or only in robot for cell in cells(robot, samples)]
    if timed:
        for cell, program in zip(found, timing.rust_programs([c.function for c in found]), strict=True):
            time(cell, program, core, rounds)
    lines = []
    for cell in found:
        own, peer = cell.function.count, cell.count
        line = [f"{cell.function.document['robot']}, {cell.function.name.replace('_', ' ')}"]
        line += [report.operations(own), report.operations(peer), f"{own.operations / peer.operations:.2f}"]
        if cell.times:
            line += [f"{t:.0f}" for t in cell.times] + [f"{cell.times[0] / cell.times[1]:.2f}"]
        lines.append([*line, str(cell.form)])
    header = ["function", "overact", "CasADi, cse", "ratio"]
    header += ["overact, ns", "CasADi, ns", "ratio"] if timed else []
    return report.table([*header, "CasADi's form"], lines)
