"""Pinocchio's `computeRNEADerivatives` in C++, compared with overact's code for the same three matrices.

The call computes the derivatives of the torques by positions and velocities, and the inertia matrix. overact's time
is the sum of `inverse_dynamics_by_displacement`, `inverse_dynamics_by_twist` and `mass_matrix`. Bodies are random
and consistent, states are random. Pinocchio's headers come with its Python package, Eigen's with CasADi's.
"""

import subprocess
from pathlib import Path

import casadi
import numpy as np
import pinocchio as pin

from . import compiled, controller, derivatives, ours, report, timing
from .description import load
from .pinocchio_bodies import placement_of, standard_parameters
from .timing import Build

ROBOTS = ["rx90", "stanford", "kuka_lwr"]
FUNCTIONS = ["inverse_dynamics_by_displacement", "inverse_dynamics_by_twist", "mass_matrix"]
FLAGS = ("-std=c++17", "-O3", "-march=native", "-DNDEBUG")
#: Those of Pinocchio's own build files: its list of joints is longer than Boost's default.
DEFINITIONS = ["BOOST_MPL_LIMIT_LIST_SIZE=30", "BOOST_MPL_LIMIT_VECTOR_SIZE=30", "BOOST_FUSION_INVOKE_MAX_ARITY=12"]
DEFINITIONS += ["BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
BUILDS = [Build("g++", "g++", FLAGS), Build("clang++", "clang++", FLAGS)]


def program(build):
    """Compiles the loop. It takes a minute or two."""
    source = timing.TEMPLATES / "derivatives.cpp"
    binary = timing.BUILD / "cpp" / build.folder
    if not binary.exists() or source.stat().st_mtime > binary.stat().st_mtime:
        binary.parent.mkdir(parents=True, exist_ok=True)
        site = Path(casadi.__file__).parents[1]
        includes = ["-isystem", site / "cmeel.prefix" / "include", "-isystem", site / "casadi" / "include" / "eigen3"]
        definitions = [f"-D{one}" for one in DEFINITIONS]
        subprocess.run([build.compiler, *build.flags, *definitions, *includes, "-o", binary, source], check=True)
    return binary


class Pinocchio:
    """Pinocchio's model of a serial robot in a file, with random bodies, and overact's parameters of these."""

    def __init__(self, robot):
        (leg,) = load(ours.description(robot)).legs
        numbers, self.values = [len(leg.joints), *load(ours.description(robot)).gravity], {}
        for joint in leg.joints:
            placement, inertia = placement_of(joint), pin.Inertia.Random()
            numbers += [float(joint.kind == "prismatic"), *np.ravel(placement.rotation), *placement.translation]
            numbers += [inertia.mass, *inertia.lever, *np.ravel(inertia.inertia)]
            self.values |= standard_parameters(inertia, joint.name)
        self.path = timing.BUILD / "states" / f"{robot}_pinocchio.model"
        self.path.parent.mkdir(parents=True, exist_ok=True)
        np.array(numbers).tofile(self.path)


class Program(timing.Program):
    """The C++ loop; its first argument is the model."""

    def __init__(self, build, model):
        super().__init__(build.title, program(build))
        self.model = model

    @property
    def command(self):
        return [self.path, self.model.path]


def tasks(robot):
    """overact's functions."""
    document = ours.inspect(robot)
    found = {task.name: task for task in derivatives.tasks(robot, document, True)}
    found["mass_matrix"] = controller.function(document, robot, "mass_matrix")
    return [found[name] for name in FUNCTIONS]


def measure_robot(robot, rust, core, rounds):
    """Times of overact's Rust and C, each the sum of three functions, and of Pinocchio."""
    functions, model = tasks(robot), Pinocchio(robot)
    dof = functions[0].document["dof"]
    parameters = [model.values.get(name, 0.0) for name in functions[0].columns]
    motions = np.random.default_rng(2).uniform(-1.5, 1.5, (compiled.STATES, 3, dof))
    names = ["joints", "joint_velocities", "joint_accelerations"]
    given = [dict(zip(names, motion, strict=True)) | {"parameters": np.array(parameters)} for motion in motions]
    folder = timing.BUILD / "states"
    motion_path = folder / f"{robot}_pinocchio.bin"
    timing.write_states(motion_path, [{name: state[name] for name in names} for state in given])
    peers = [Program(build, model) for build in BUILDS]
    expected = timing.outputs(peers[0], motion_path, core, (3, dof, dof))
    timed = [(program, motion_path, ("Pinocchio", program.title)) for program in peers]
    for index, (function, own) in enumerate(zip(functions, rust, strict=True)):
        path = folder / f"{robot}_{function.name}_pinocchio.bin"
        timing.write_states(path, [{name: state[name] for name, _ in function.inputs} for state in given])
        programs = [(own, ("Rust", function.name))]
        for build in compiled.OWN:
            code = compiled.own_code(function)
            name = f"{robot}_{function.name}_C"
            compiled_c = timing.c_program("C", name, code, function.inputs, dof * dof, build)
            programs.append((compiled_c, ("C " + build.title, function.name)))
        for one, key in programs:
            found = timing.outputs(one, path, core, (dof, dof))
            controller.check(f"{robot}, {function.name}, {key[0]}", found, expected[:, index])
            timed.append((one, path, key))
    times = timing.compare_each([(one, path) for one, path, _ in timed], core, rounds, compiled.PASSES, "median")
    by_key = {key: time for (*_, key), time in zip(timed, times, strict=True)}
    summed = {}
    for (kind, _), time in list(by_key.items())[len(BUILDS) :]:
        summed[kind] = summed.get(kind, 0.0) + time
    peer = min((time, title) for (kind, title), time in by_key.items() if kind == "Pinocchio")
    return summed["Rust"], min(time for kind, time in summed.items() if kind != "Rust"), *peer


def measure(core, rounds):
    """The table."""
    pin.seed(7)
    rust = iter(timing.rust_programs([f for robot in ROBOTS for f in tasks(robot)], build=timing.THIS))
    lines = []
    for robot in ROBOTS:
        own, in_c, peer, title = measure_robot(robot, [next(rust) for _ in FUNCTIONS], core, rounds)
        ratios = [f"{time / peer:.2f}" for time in (own, in_c)]
        lines.append([ours.inspect(robot)["robot"], f"{own:.0f}", f"{in_c:.0f}", f"{peer:.0f}", *ratios, title])
    header = ["robot", "overact's Rust, ns", "its C, ns", "Pinocchio, ns", "ratio, Rust", "ratio, C", "compiler"]
    return report.table(header, lines)
