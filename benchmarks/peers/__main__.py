"""Builds the peers' models, checks that they agree with overact's, counts, and writes the table."""

import argparse
import sys

import numpy as np

from . import casadi_peer, ours
from .casadi_peer import Casadi
from .description import load
from .robot import columns
from .search import best
from .states import states
from .works import WORKS

#: Largest difference of results, relative to the largest entry of a row.
AGREEMENT = 1e-9


def disagreement(found, expected):
    """Largest difference, relative to the largest entry of each row."""
    scale = np.abs(expected).max(axis=2, keepdims=True)
    return float((np.abs(found - expected) / np.where(scale == 0.0, 1.0, scale)).max())


def measure(work, samples):
    function = ours.function(work)
    robot = load(function.path)
    sample = states(function, samples)
    expected = function.evaluate(sample)
    form = best(robot, function.inputs, function.columns)[0]
    lines = {}
    for cse in (False, True):
        algebra = Casadi()
        derived = columns(robot, algebra, function.inputs, function.columns, form)
        compiled = algebra.function("model", function.inputs, derived, cse)
        found = np.array([compiled(*s.values()).full() for s in sample]).reshape(expected.shape)
        error = disagreement(found, expected)
        if not error < AGREEMENT:
            raise RuntimeError(f"{work.title}: CasADi and overact differ by {error:.1e}")
        lines[cse] = casadi_peer.count(compiled)
    return function, form, lines


def cell(count):
    extra = [f"{count.trigonometric_pairs} sc"] if count.trigonometric_pairs else []
    extra += [f"{count.square_roots} √"] if count.square_roots else []
    return f"{count.operations}" + (f" + {', '.join(extra)}" if extra else "")


def main():
    parser = argparse.ArgumentParser(prog="benchmarks/run", description=__doc__)
    parser.add_argument("--samples", type=int, default=20, help="states at which the results are compared")
    parser.add_argument("--only", help="works whose robot's name holds this text")
    arguments = parser.parse_args()
    print("| work | overact | CasADi, cse | CasADi | quoted |")
    print("|---|---|---|---|---|")
    for work in WORKS:
        if arguments.only and arguments.only not in work.robot:
            continue
        function, form, lines = measure(work, arguments.samples)
        cells = [work.title, cell(function.count), cell(lines[True]), cell(lines[False]), work.quoted]
        print(f"| {' | '.join(cells)} |", flush=True)
        print(f"{work.title}: form of the peer: {form}", file=sys.stderr)


if __name__ == "__main__":
    main()
