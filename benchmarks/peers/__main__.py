"""Builds the peers' models, checks that they agree with overact's, counts and times them, writes the tables."""

import argparse
import os
import sys
from dataclasses import dataclass

import numpy as np

from . import blockwise, cable_robots, closed, controller, derivatives, frames, identification, logs, ours, pinocchio_cpp, pinocchio_peer, report, table, timing
from .description import load
from .ours import Function
from .peers import Model, check, models
from .states import states
from .works import WORKS, Work


@dataclass
class Result:
    """One task: overact's function, the peers' models, and the times of all."""

    work: Work
    function: Function
    models: list[Model]
    times: tuple[float, list[tuple[Model, float]]] | None = None


def measure(work, samples):
    """Models of one task with equal results."""
    function = ours.function(work)
    sample = states(function, samples)
    expected = function.evaluate(sample)
    return Result(work, function, models(work, function, load(function.path), sample, expected))


def time(result, program, core, rounds):
    """Times overact's program and the peers' alternately, after checking that they give the same numbers."""
    function = result.function
    size = int(np.prod(function.shape))
    name = f"{function.robot}_{function.rust_name}"
    path = timing.BUILD / "states" / f"{name}.bin"
    timing.write_states(path, states(function, timing.STATES, seed=2))
    compiled = [m for m in result.models if m.code]
    programs = [program]
    for index, model in enumerate(compiled):
        title = f"{model.peer}: {model.form}"
        programs.append(timing.c_program(title, f"{name}_{index}", model.code, function.inputs, size))
    expected = timing.outputs(program, path, core, function.shape)
    for other in programs[1:]:
        check(
            f"{result.work.title}, C code of {other.title}",
            timing.outputs(other, path, core, function.shape),
            expected,
        )
    own, *peers = timing.compare(programs, path, core, rounds)
    result.times = own, list(zip(compiled, peers, strict=True))


def main():
    parser = argparse.ArgumentParser(prog="benchmarks/run", description=__doc__)
    parser.add_argument("--samples", type=int, default=20, help="states at which the results are compared")
    parser.add_argument("--only", help="works whose robot's name holds this text")
    parser.add_argument(
        "--identification", action="store_true", help="only the throughput of an identification"
    )
    parser.add_argument("--logs", action="store_true", help="only the identification from whole logs")
    parser.add_argument(
        "--blocks", action="store_true", help="only the evaluation over blocks beside the compiled function"
    )
    parser.add_argument("--pinocchio", action="store_true", help="only Pinocchio's regressor of serial robots, and its derivatives in C++")
    parser.add_argument(
        "--dynamics", action="store_true", help="only dynamics of given parameters, as a controller needs them"
    )
    parser.add_argument(
        "--table", action="store_true", help="all functions of seven robots, beside the fastest peer at equal flags"
    )
    parser.add_argument(
        "--closed", action="store_true", help="only robots with closed chains, from joint angles"
    )
    parser.add_argument(
        "--cables", action="store_true", help="only robots with cables, from the pose; counts only"
    )
    parser.add_argument(
        "--derivatives", action="store_true", help="only derivatives of the dynamics, in C and Rust"
    )
    parser.add_argument("--frames", action="store_true", help="only Jacobians of frames, in C and Rust")
    parser.add_argument("--no-times", action="store_true", help="count only")
    parser.add_argument("--core", type=int, default=0, help="the core on which all programs are timed")
    parser.add_argument("--rounds", type=int, default=15, help="turns of every program")
    arguments = parser.parse_args()
    given = arguments.only, arguments.samples, not arguments.no_times, arguments.core, arguments.rounds
    if arguments.identification:
        peers = [identification.Pipeline, blockwise.Blockwise]
        print(identification.table(*identification.measure(arguments.core, peers)))
        return
    if arguments.logs:
        print(logs.measure())
        return
    if arguments.blocks:
        work = WORKS[0]
        print(report.blocks(work, timing.blocks(ours.function(work), arguments.core)))
        return
    if arguments.pinocchio:
        os.sched_setaffinity(0, {arguments.core})
        print(report.calls(pinocchio_peer.measure_all()))
        print(f"\n{pinocchio_cpp.measure(arguments.core, arguments.rounds)}")
        return
    if arguments.table:
        # Print each robot's results as soon as they are available, because all of them take long.
        for found in table.measured(arguments.only, arguments.core, arguments.rounds):
            print(table.table(found), flush=True)
            print(flush=True)
        return
    if arguments.closed:
        print(closed.measure(arguments.only, arguments.samples))
        return
    if arguments.cables:
        print(cable_robots.measure(arguments.only, arguments.samples))
        return
    if arguments.derivatives:
        print(derivatives.measure(*given))
        return
    if arguments.frames:
        print(frames.measure(*given))
        return
    if arguments.dynamics:
        print(controller.measure(*given))
        return
    results = []
    for work in WORKS:
        if not arguments.only or arguments.only in work.robot:
            print(f"{work.title} …", file=sys.stderr, flush=True)
            results.append(measure(work, arguments.samples))
    if not arguments.no_times:
        programs = timing.rust_programs([result.function for result in results])
        for result, program in zip(results, programs, strict=True):
            print(f"{result.work.title}: times …", file=sys.stderr, flush=True)
            time(result, program, arguments.core, arguments.rounds)
    print(report.counts(results))
    if not arguments.no_times:
        print(f"\n{report.times(results)}")


if __name__ == "__main__":
    main()
