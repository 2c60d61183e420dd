"""The peers' models of one task: counts, and C code for timing."""

from dataclasses import dataclass

import numpy as np

from . import casadi_peer, timing
from .casadi_peer import Casadi
from .count import Count
from .robot import columns
from .search import best
from .symplex_peer import symplex_trees
from .tree_peer import symforce_trees, sympy_trees

#: Largest difference of results, relative to the largest entry of a row.
AGREEMENT = 1e-9


@dataclass
class Model:
    """A peer's model: its operations, and C code `void model(const double **inputs, double *output)`."""

    peer: str
    form: str
    count: Count
    code: str | None


def disagreement(found, expected):
    """Largest difference, relative to the largest entry of each row."""
    scale = np.abs(expected).max(axis=2, keepdims=True)
    return float((np.abs(found - expected) / np.where(scale == 0.0, 1.0, scale)).max())


def check(title, found, expected):
    error = disagreement(found, expected)
    if not error < AGREEMENT:
        raise RuntimeError(f"{title}: results differ from overact's by {error:.1e}")


#: Libraries of expression trees besides CasADi.
TREES = (sympy_trees, symforce_trees, symplex_trees)


def models(work, function, robot, sample, expected, candidates=3, trees=TREES):
    """The peers' models, after checking their agreement.

    CasADi's in its best forms, with and without `cse`; those of SymPy, SymForce and symplex, whose `cse` is
    similar, in the best of these.
    """
    found = []
    homes = function.document["home_joints"]
    forms = best(robot, function.inputs, function.columns, homes)[:candidates]
    for form in forms:
        for cse in (True, False):
            algebra = Casadi()
            derived = columns(robot, algebra, function.inputs, function.columns, form, homes)
            compiled = algebra.function("peer", function.inputs, derived, cse)
            values = [compiled(*state.values()).full() for state in sample]
            title = "CasADi, cse" if cse else "CasADi"
            check(f"{work.title}, {title}", np.array(values).reshape(expected.shape), expected)
            code = casadi_peer.c_code(compiled)
            found.append(Model(title, str(form), casadi_peer.count(compiled), code))
    for make in trees:
        algebra = make()
        derived = columns(robot, algebra, function.inputs, function.columns, forms[0], homes)
        counted, code = algebra.function(function.inputs, derived)
        check(f"{work.title}, {algebra.name}", run(function, algebra.name, code, sample), expected)
        found.append(Model(algebra.name, str(forms[0]), counted, code))
    return found


def run(function, title, code, sample):
    """Output of C code for some states."""
    name = f"{function.robot}_{function.rust_name}_{title.partition(',')[0].lower()}"
    path = timing.BUILD / "states" / f"{name}.bin"
    timing.write_states(path, sample)
    program = timing.c_program(title, name, code, function.inputs, int(np.prod(function.shape)))
    return timing.outputs(program, path, 0, function.shape)
