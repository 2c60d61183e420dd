"""Placements and bodies of Pinocchio's models, from the frames and parameters of descriptions."""

import numpy as np
import pinocchio as pin


def turn(axis, angle):
    return pin.SE3(pin.AngleAxis(angle, np.array(axis)).toRotationMatrix(), np.zeros(3))


def shift(vector):
    return pin.SE3(np.eye(3), np.array(vector))


def placement_of(joint):
    """Modified Denavit-Hartenberg frame of a joint at zero, in the frame of its antecedent."""
    placement = turn([0.0, 0.0, 1.0], joint.gamma) * shift([0.0, 0.0, joint.b])
    placement = placement * turn([1.0, 0.0, 0.0], joint.alpha) * shift([joint.d, 0.0, 0.0])
    placement = placement * turn([0.0, 0.0, 1.0], joint.theta.constant)
    return placement * shift([0.0, 0.0, joint.r.constant])


def standard_parameters(inertia, name):
    """The ten standard parameters of a body, by name; about the origin of its frame."""
    mass, lever = inertia.mass, inertia.lever
    tensor = inertia.inertia + mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    own = {"m": mass} | {f"m{axis}": mass * arm for axis, arm in zip("xyz", lever, strict=True)}
    own |= {a + b: tensor["xyz".index(a), "xyz".index(b)] for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")}
    return {f"{symbol}_{name}": value for symbol, value in own.items()}
