"""Robots with cables from the pose: overact compared with CasADi's best form, function by function."""

import itertools

import numpy as np

from . import cables, compiled, ours, report
from .controller import function, sample
from .description import load
from .peers import check
from .states import states

ROBOTS = ["cable_planar", "cable_spatial"]


def tensions(particular, basis, least):
    """The tensions with the least distance to `least` that are not below it.

    The correction of least norm is zero at some of its conditions; every choice of these is tried.
    """
    deviation = particular - least
    start = deviation - basis @ (basis.T @ deviation)
    cables, redundant = basis.shape
    found = []
    for size in range(redundant + 1):
        for active in map(list, itertools.combinations(range(cables), size)):
            internal = np.linalg.lstsq(basis[active], -start[active], rcond=None)[0]
            whole = start + basis @ internal
            if whole.min() > -1e-9 * np.abs(whole).max():
                found.append((internal @ internal, tuple(whole)))
    return least + np.array(min(found)[1])


def torques(robot, document, entries):
    """Tensions from the kept ones and the internal ones that the peer's function returns."""
    names, kept = document["actuator_names"], document["kept_actuators"]
    particular = np.zeros(len(names))
    particular[[names.index(name) for name in kept]] = entries[: len(kept)]
    internal = entries[len(kept) :].reshape(-1, len(names))
    return tensions(particular, internal.T, np.array([leg.cable.minimum for leg in robot.legs]))


def compared(robot, task, peer, samples):
    """Checks that the results of both tools agree."""
    has_parameters = "parameters" in dict(task.inputs)
    given = sample(task, samples) if has_parameters else states(task, samples)
    values = [peer(*state.values()).full().ravel() for state in given]
    if task.name == "inverse_dynamics":
        values = [torques(robot, task.document, entries) for entries in values]
    expected = task.evaluate(given)
    rows = len(given), -1, task.shape[-1]
    check(f"{task.robot}, {task.name}", np.array(values).reshape(rows), expected.reshape(rows))


def measure(only, samples):
    """The table."""
    lines = []
    for robot in ROBOTS:
        if not compiled.is_selected(robot, only):
            continue
        document, own = ours.inspect(robot), load(ours.description(robot))
        for name in cables.FUNCTIONS:
            task = function(document, robot, name)
            _, _, form, counted, peer = cables.best(own, task)
            compared(own, task, peer, samples)
            ratio = task.count.operations / counted.operations
            line = [f"{document['robot']}, {name.replace('_', ' ')}", report.operations(task.count)]
            lines.append([*line, report.operations(counted), f"{ratio:.2f}", form])
    return report.table(["function", "overact", "CasADi, cse", "ratio", "CasADi's form"], lines)
