"""Pinocchio's models of trees without loops, built from the frames of the descriptions.

Each moving joint of a description is a joint of Pinocchio with its modified Denavit-Hartenberg frame. Coupled joints
follow the coordinates by a constant matrix, `Tree.coupling`. Bodies are random and consistent; friction, rotors and
springs are zero.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pinocchio as pin

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
from peers.description import INERTIA, load  # noqa: E402
from peers.pinocchio_bodies import placement_of, standard_parameters  # noqa: E402

ROBOTS = ["robots/rx90", "robots/tx40", "robots/stanford", "robots/kuka_lwr", "robots/dvrk_mtm"]
ROBOTS += ["tests/fixtures/puma560", "tests/fixtures/branched_arm"]
#: Inputs of the functions of a tree.
KEYS = ("joints", "joint_velocities", "joint_accelerations")


def depth_first(joints, antecedent=None):
    """Joints with those of each branch together, as Pinocchio's derivatives need them."""
    for place, joint in enumerate(joints):
        if joint.antecedent == antecedent:
            yield joint
            yield from depth_first(joints, place)


class Tree:
    """A tree of a description: Pinocchio's model and the standard parameters of its bodies."""

    def __init__(self, path):
        robot = load(path)
        (leg,) = robot.legs
        self.model, self.values = pin.Model(), {}
        self.model.gravity.linear = robot.gravity
        base = pin.SE3(leg.base_rotation, leg.base_at)
        #: Joint of Pinocchio and frame in it, for each body.
        self.bodies = {}
        names, rows = [joint.name for joint in leg.joints if joint.name in joint.position.terms], []
        for joint in depth_first(leg.joints):
            parent, own = (0, base) if joint.antecedent is None else self.bodies[leg.joints[joint.antecedent].name]
            placement = own * placement_of(joint)
            if joint.kind == "fixed":
                self.bodies[joint.name] = parent, placement
            else:
                kind = pin.JointModelRZ() if joint.kind == "revolute" else pin.JointModelPZ()
                self.bodies[joint.name] = self.model.addJoint(parent, kind, placement, joint.name), pin.SE3.Identity()
                rows.append([joint.position.terms.get(name, 0.0) for name in names])
            if set(INERTIA) <= set(joint.parameters):
                self.add_body(joint.name)
            elif set(INERTIA) & set(joint.parameters):
                raise ValueError(f"{path}: joint {joint.name} has some inertial parameters only")
        self.coupling = np.array(rows)
        self.data = self.model.createData()

    def add_body(self, name):
        inertia = pin.Inertia.Random()
        self.model.appendBodyToJoint(self.bodies[name][0], inertia, self.bodies[name][1])
        self.values |= standard_parameters(inertia, name)

    @property
    def dof(self):
        return self.coupling.shape[1]

    def motion(self, rng):
        """Random positions, velocities and accelerations of the coordinates."""
        return rng.uniform(-1.5, 1.5, (3, self.dof))


def overact(binary, *arguments, text=None):
    """JSON document of a command."""
    command = [binary, *map(str, arguments), "--json"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout)


def parameters(binary, path, tree):
    """Values in the order of the description's parameters, and their names."""
    names = overact(binary, "inspect", path, "--effort", "none")["parameters"]
    return [tree.values.get(name, 0.0) for name in names], names


def evaluate(binary, path, function, states):
    """Values of a function at all states, in an array."""
    states = [{key: list(value) for key, value in state.items()} for state in states]
    results = overact(binary, "evaluate", path, function, "--states", "-", text=json.dumps(states))["results"]
    return np.array([result[function] for result in results])


class Differences:
    """Largest difference of each quantity, relative to the largest entry of the reference at its state."""

    def __init__(self):
        self.worst = {}

    def add(self, quantity, own, reference):
        own, reference = np.ravel(own), np.ravel(reference)
        if own.shape != reference.shape:
            raise RuntimeError(f"{quantity}: {own.size} numbers instead of {reference.size}")
        error = np.abs(own - reference).max() / np.abs(reference).max()
        # `max` would drop a NaN.
        self.worst[quantity] = error if not error <= self.worst.get(quantity, 0.0) else self.worst.get(quantity, 0.0)


def report(name, differences, tolerance):
    """Prints a line of a robot; whether one quantity differs."""
    print(f"{name}: " + ", ".join(f"{quantity} {worst:.1e}" for quantity, worst in differences.worst.items()))
    return not all(worst < tolerance for worst in differences.worst.values())
