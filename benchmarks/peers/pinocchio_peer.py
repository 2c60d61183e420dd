"""Pinocchio's joint torque regressor of serial robots: agreement and time.

It has all ten inertial columns of every body, in the same order of axes, and no friction. It is called from
Python, like its users do. The time of an empty call is also measured.
"""

import time

import numpy as np
import pinocchio as pin

from . import ours
from .description import load
from .peers import check
from .pinocchio_bodies import placement_of
from .states import states
from .works import WORKS, Work

SYMBOLS = ["m", "mx", "my", "mz", "xx", "xy", "yy", "xz", "yz", "zz"]


def model_of(robot):
    """A chain of modified Denavit-Hartenberg frames."""
    (leg,) = robot.legs
    model, parent = pin.Model(), 0
    model.gravity.linear = robot.gravity
    for joint in leg.joints:
        (motion,) = [e for e in (joint.theta, joint.r) if e.terms]
        if list(motion.terms.values()) != [1.0]:
            raise NotImplementedError("a joint that turns against its variable")
        kind = pin.JointModelRZ() if joint.kind == "revolute" else pin.JointModelPZ()
        parent = model.addJoint(parent, kind, placement_of(joint), joint.name)
    return model


def shortest(call, arguments, batches=200):
    """Nanoseconds of a call."""
    best = float("inf")
    for _ in range(batches):
        start = time.perf_counter()
        for given in arguments:
            call(*given)
        best = min(best, time.perf_counter() - start)
    return 1e9 * best / len(arguments)


def measure(robot, name):
    """Nanoseconds of a regressor and of an empty call, after checking agreement with overact's columns."""
    function = ours.function(Work(name, name))
    sample = states(function, 50)
    model = model_of(robot)
    data = model.createData()
    arguments = [tuple(np.array(v) for v in state.values()) for state in sample]
    found = np.array([pin.computeJointTorqueRegressor(model, data, *given).copy() for given in arguments])
    bodies = [joint.name for joint in robot.legs[0].joints]
    places = {f"{s}_{body}": 10 * k + i for k, body in enumerate(bodies) for i, s in enumerate(SYMBOLS)}
    shared = [name for name in function.columns if name in places]
    expected = function.evaluate(sample)[:, :, [function.columns.index(name) for name in shared]]
    check(f"{name}, Pinocchio", found[:, :, [places[name] for name in shared]], expected)
    regressor = shortest(lambda q, v, a: pin.computeJointTorqueRegressor(model, data, q, v, a), arguments)
    nothing = shortest(lambda q, v, a: pin.neutral, arguments)
    return regressor, nothing


def measure_all():
    """Serial robots among the tasks: name, nanoseconds of a regressor and of an empty call."""
    robots = dict.fromkeys(work.robot for work in WORKS)
    described = {name: load(ours.description(name)) for name in robots}
    serial = {name: robot for name, robot in described.items() if robot.motion is None}
    return [(robot.name, *measure(robot, name)) for name, robot in serial.items()]
