"""The peers' models of one work: counts, and C code where it is timed."""

from dataclasses import dataclass

import numpy as np

from . import casadi_peer
from .casadi_peer import Casadi
from .count import Count
from .robot import columns
from .search import best

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


def models(work, function, robot, sample, expected, candidates=3):
    """CasADi's models in its best forms, with and without `cse`, all proved to agree."""
    found = []
    for form in best(robot, function.inputs, function.columns)[:candidates]:
        for cse in (True, False):
            algebra = Casadi()
            derived = columns(robot, algebra, function.inputs, function.columns, form)
            compiled = algebra.function("peer", function.inputs, derived, cse)
            values = [compiled(*state.values()).full() for state in sample]
            title = "CasADi, cse" if cse else "CasADi"
            check(f"{work.title}, {title}", np.array(values).reshape(expected.shape), expected)
            code = casadi_peer.c_code(compiled)
            found.append(Model(title, str(form), casadi_peer.count(compiled), code))
    return found
