"""One table of all timings: regressors, dynamics and forward kinematics of seven robots, with overact's fastest
peer.

The flags of both are equivalent. The peers are CasADi in the form with the fewest operations, with and
without `cse`, and for regressors SymForce. Each is compiled by GCC and by Clang. `default` is -O3 or cargo's
release profile, `native` is for this processor. The gain from -ffast-math and the C library's vector sines is
listed separately, because Rust has no equivalent.
"""

import hashlib
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import casadi_peer, controller, dynamics, forward, instructions, ours, report, timing
from .casadi_peer import Casadi
from .count import Count
from .description import load
from .peers import models
from .states import states
from .timing import Build
from .tree_peer import symforce_trees
from .works import Work

ROBOTS = {
    "dualv": "DualV",
    "delta": "Delta",
    "hexapod": "6-UPS",
    "octopod": "8-UPS",
    "rx90": "RX90",
    "kuka_lwr": "KUKA LWR",
    "puma560": "PUMA 560",
}
DEFAULT = [Build("gcc", "gcc", ("-O3",)), Build("clang", "clang", ("-O3",))]
NATIVE = [
    Build("gcc native", "gcc", ("-O3", "-march=native")),
    Build("clang native", "clang", ("-O3", "-march=native")),
]
FAST = [
    Build("gcc fast", "gcc", ("-O3", "-march=native", "-ffast-math")),
    Build("clang fast", "clang", ("-O3", "-march=native", "-ffast-math", "-fveclib=libmvec", "-lmvec")),
]
#: Modules that derive the peers' functions.
DERIVING = ["algebra", "casadi_peer", "closure", "description", "dynamics", "model", "platform", "robot", "search"]
DERIVING += ["tree_peer", "values"]


@dataclass
class Peer:
    """A peer's function as C code."""

    title: str
    count: Count
    code: str


@dataclass
class Cell:
    """A function of a robot for both tools."""

    title: str
    function: ours.Function
    peers: list[Peer]
    #: Draws a number of states with a seed.
    sample: object
    #: Function that draws a number of states with a seed.
    times: dict = field(default_factory=dict)
    #: Instructions, misses and bytes of overact's function, and of the peer that is fastest in default
    #: builds.
    instructions: list = field(default_factory=list)

    @property
    def name(self):
        return f"{self.function.robot}_{self.function.rust_name}"

    def fastest(self, builds):
        """The peer's shortest time in some builds, and its name."""
        of = [(time, f"{title}, {build}") for (build, title), time in self.times.items() if title]
        return min(entry for entry in of if entry[1].rpartition(", ")[2] in [b.title for b in builds])


def kept(name, made_of, make):
    """Peers that take minutes to derive, cached until the description or the deriving modules change."""
    sources = [(Path(__file__).parent / f"{source}.py").read_bytes() for source in DERIVING]
    key = hashlib.sha256(b"\0".join([made_of, *sources])).hexdigest()
    path = timing.BUILD / "derived" / f"{name}.json"
    if path.exists():
        stored = json.loads(path.read_text())
        if stored["key"] == key:
            return [Peer(p["title"], Count(**p["count"]), p["code"]) for p in stored["peers"]]
    peers = make()
    stored = [{"title": p.title, "count": vars(p.count), "code": p.code} for p in peers]
    timing.write(path, json.dumps({"key": key, "peers": stored}))
    return peers


def regressor(robot, columns, source):
    """A cell of the identification model."""
    work = Work(robot, robot, columns, source)
    function = ours.function(work)

    def make():
        sample = states(function, 20)
        expected = function.evaluate(sample)
        found = models(work, function, load(function.path), sample, expected, candidates=1, trees=[symforce_trees])
        return [Peer(m.peer, m.count, m.code) for m in found]

    title = f"{columns} columns" + (", from the pose" if source == "pose" else "")
    name = f"{robot}_{function.rust_name}"
    peers = kept(name, function.path.read_bytes(), make)
    return Cell(title, function, peers, lambda number, seed: states(function, number, seed))


def of_parameters(robot, name):
    """A cell of dynamics of given parameters."""
    document = ours.inspect(robot)
    function = controller.function(document, robot, name)

    def make():
        own = load(function.path)
        driven = {"dof": document["dof"], "joints": controller.actuated(robot)}
        given = function.inputs, function.columns, document["home_joints"], driven
        _, _, form, counted, shared = dynamics.best(own, name, *given)
        sample = controller.sample(function, 20)
        values = np.array([shared(*state.values()).full() for state in sample])
        controller.check(f"{robot}, {name}", values, function.evaluate(sample))
        algebra, (inputs, names, homes, driven) = Casadi(), given
        derived = dynamics.derive(own, algebra, name, inputs, names, form, homes, driven)
        plain = algebra.function("peer", inputs, derived, cse=False)
        return [
            Peer("CasADi, cse", counted, casadi_peer.c_code(shared)),
            Peer("CasADi", casadi_peer.count(plain), casadi_peer.c_code(plain)),
        ]

    peers = kept(f"{robot}_{name}", function.path.read_bytes(), make)
    title = name.replace("_", " ")
    return Cell(title, function, peers, lambda number, seed: controller.sample(function, number, seed))


def kinematics(robot):
    """A cell of forward kinematics."""
    function = forward.function(robot)

    def make():
        _, counted, codes = forward.best(function)
        return [Peer(title, counted, c) for title, c in zip(("CasADi, cse", "CasADi"), codes, strict=True)]

    peers = kept(f"{robot}_forward", function.path.read_bytes(), make)
    return Cell("forward kinematics", function, peers, lambda number, seed: forward.sample(function, number, seed))


def cells(robot):
    """All cells of a robot."""
    is_parallel = any(f["from"] == "pose" for f in ours.inspect(robot)["functions"])
    for columns in ("standard", "base"):
        yield regressor(robot, columns, "joints")
        if is_parallel:
            yield regressor(robot, columns, "pose")
    for name in controller.FUNCTIONS:
        yield of_parameters(robot, name)
    if is_parallel:
        yield kinematics(robot)


def time(cell, own, core, rounds):
    """Times both builds of overact and all builds of the peers alternately, after checking their agreement."""
    path = timing.BUILD / "states" / f"{cell.name}.bin"
    given = cell.sample(timing.STATES, 2)
    timing.write_states(path, given)
    inputs = [(name, len(value)) for name, value in given[0].items()]
    size = int(np.prod(cell.function.shape))
    programs = list(zip([("default", ""), ("native", ""), ("plain", "")], own, strict=True))
    for index, peer in enumerate(cell.peers):
        for build in [*DEFAULT, *NATIVE, *FAST]:
            compiled = timing.c_program(peer.title, f"{cell.name}_{index}", peer.code, inputs, size, build)
            programs.append(((build.title, peer.title), compiled))
    expected = timing.outputs(own[0], path, core, cell.function.shape)
    for (build, title), program in programs[1:]:
        found = timing.outputs(program, path, core, cell.function.shape)
        controller.check(f"{cell.name}, {title}, {build}", found, expected)
    times = timing.compare([program for _, program in programs], path, core, rounds)
    cell.times = dict(zip((key for key, _ in programs), times, strict=True))
    fastest = min((k for k in cell.times if k[1] and k[0] in [b.title for b in DEFAULT]), key=cell.times.get)
    # Valgrind does not know all instructions of run-time detection.
    cell.instructions = [instructions.per_call(p, path) for p in (own[2], dict(programs)[fastest])]


def line(robot, cell):
    """Operations, times and their ratios to the best peer's."""
    own, best = cell.function.count, min((p.count for p in cell.peers), key=lambda c: c.operations)
    found = [f"{ROBOTS[robot]}, {cell.title}", report.operations(own), report.operations(best)]
    found.append(f"{own.operations / best.operations:.2f}")
    for kind, builds in (("default", DEFAULT), ("native", NATIVE)):
        peer, _ = cell.fastest(builds)
        time = cell.times[(kind, "")]
        found += [f"{time:.0f}", f"{peer:.0f}", f"{time / peer:.2f}"]
    fast, _ = cell.fastest(FAST)
    return [*found, f"{fast:.0f}", f"{cell.times[('native', '')] / fast:.2f}"]


def counts(robot, cell):
    """Time without run-time vectors, instructions and misses of the instruction cache, with the fastest peer's
    and its name."""
    (own, missed), (peer, peers_missed) = cell.instructions
    ratio = f"{own / peer:.2f}"
    names = [cell.fastest(builds)[1] for builds in (DEFAULT, NATIVE, FAST)]
    # A difference of two runs may be slightly below zero.
    misses = [f"{round(number, 1) + 0.0:.1f}" for number in (missed, peers_missed)]
    plain = cell.times[("plain", "")]
    beside = f"{plain / cell.fastest(DEFAULT)[0]:.2f}"
    return [f"{ROBOTS[robot]}, {cell.title}", f"{plain:.0f}", beside, f"{own:.0f}", f"{peer:.0f}", ratio, *misses, *names]


def measured(only, core, rounds):
    """Cells of each robot with their times."""
    for robot in ROBOTS:
        if only and only not in robot:
            continue
        print(f"{ROBOTS[robot]} …", file=sys.stderr, flush=True)
        found = list(cells(robot))
        functions = [cell.function for cell in found]
        builds = (timing.ANY, timing.THIS, timing.ANY_PLAIN)
        own = zip(*(timing.rust_programs(functions, build=build) for build in builds), strict=True)
        for cell, programs in zip(found, own, strict=True):
            print(f"{ROBOTS[robot]}, {cell.title}: times …", file=sys.stderr, flush=True)
            time(cell, programs, core, rounds)
        yield [(robot, cell) for cell in found]


def table(found):
    """The cells as Markdown: operations and times, then figures that do not depend on other work."""
    header = ["function", "operations", "peer", "ratio", "default, ns", "peer", "ratio", "native, ns", "peer", "ratio"]
    times = report.table([*header, "peer, -ffast-math", "ratio"], [line(robot, cell) for robot, cell in found])
    header = ["function", "no dispatch, ns", "ratio", "instructions", "peer", "ratio", "misses", "peer"]
    header += ["fastest, default", "native", "-ffast-math"]
    return f"{times}\n\n{report.table(header, [counts(robot, cell) for robot, cell in found])}"
