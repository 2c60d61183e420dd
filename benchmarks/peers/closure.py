"""Sines and cosines of a leg's joints from the platform's pose, without computing angles.

There are three types of legs:

- Two links in the platform's plane: the law of cosines gives the second joint, the direction to the leg's end
  the first.
- An arm with a rod on a universal joint: the same in the arm's plane, after the rod's slope to it.
- A universal joint with a prismatic one: only the direction to the end is needed.
"""

import math

from .algebra import ONE, add, apply, matrix, sub, transpose, vector
from .values import Linear


def close(angles, algebra, platform, leg, pose, home):
    """Passes the pairs of all sums of a leg's joints to `angles`."""
    kinds = [joint.kind[0] for joint in leg.joints]
    alphas = [round(math.degrees(joint.alpha), 9) for joint in leg.joints]
    is_planar = platform.robot.motion == "planar" and platform.robot.axis == "z"
    if is_planar and kinds == ["r"] * 3 and not any(alphas):
        plane(angles, algebra, platform, leg, pose, home)
    elif kinds == ["r", "r", "r", "f"] and alphas == [-90.0, 0.0, 90.0, 0.0] and leg.end_type == "point":
        arm(angles, algebra, to_end(platform, leg, pose), leg, home)
    elif kinds == ["r", "r", "p"] and alphas == [90.0] * 3 and leg.end_type == "point":
        strut(angles, algebra, to_end(platform, leg, pose), leg, home)
    else:
        raise NotImplementedError("the closure of other legs than these")


def to_end(platform, leg, pose):
    """End of a leg in its base frame, for spatial platform motion."""
    if platform.robot.motion not in ("translation", "spatial"):
        raise NotImplementedError("the closure of a platform that does not move in space")
    end = add(pose[:3], apply(platform.rotation, vector(leg.end_at)))
    return apply(transpose(matrix(leg.base_rotation)), sub(end, vector(leg.base_at)))


def arm(angles, algebra, end, leg, home):
    """An arm about -y, and a rod on a universal joint at its end."""
    first, second, third, tip = leg.joints
    x, y, across = end[0] - first.d, -end[2], end[1]
    a, rod = second.d, tip.d
    s3 = across * (1.0 / rod)
    b_squared = rod * rod - across * across
    b = algebra.sqrt(b_squared) * math.copysign(1.0, math.cos(home[2]))
    squares = x * x + y * y
    along = (squares - a * a - b_squared) * (0.5 / a)
    beside = algebra.sqrt(b_squared - along * along) * math.copysign(1.0, math.sin(home[1]))
    reciprocal = ONE / squares
    c1 = (x * (along + a) + y * beside) * reciprocal
    s1 = (y * (along + a) - x * beside) * reciprocal
    inverse = ONE / b
    one, two, three = (joint.name for joint in (first, second, third))
    angles.closed = {
        (one,): (c1, s1),
        (two,): (along * inverse, beside * inverse),
        tuple(sorted((one, two))): ((x - c1 * a) * inverse, (y - s1 * a) * inverse),
        (three,): (b * (1.0 / rod), s3),
    }


def strut(angles, algebra, end, leg, home):
    """A universal joint about z and x of its base rotated by a right angle, and a prismatic joint."""
    first, second, third = leg.joints
    quarter = math.pi / 2
    if any(abs(joint.theta.constant - quarter) > 1e-12 for joint in (first, second)) or first.d or second.d:
        raise NotImplementedError("the closure of other struts")
    x, y, z = end
    flat = x * x + z * z
    length = algebra.sqrt(flat + y * y)
    flat = algebra.sqrt(flat) * math.copysign(1.0, math.cos(home[1]))
    one, two = ONE / flat, ONE / length
    angles.closed = {(first.name,): (z * one, -(x * one)), (second.name,): (flat * two, -(y * two))}
    angles.variables[third.name] = length


def plane(angles, algebra, platform, leg, pose, home):
    """Two links in the platform's plane."""
    first, second, third = leg.joints
    axis = [math.cos(first.gamma), math.sin(first.gamma), 0.0]
    lever = apply(platform.rotation, vector(leg.end_at))
    end = sub([pose[0] + lever[0], pose[1] + lever[1]], vector([first.d * a for a in axis[:2]]))
    a, b = second.d, third.d
    squares = end[0] * end[0] + end[1] * end[1]
    c2 = (squares - (a * a + b * b)) * (0.5 / (a * b))
    s2 = algebra.sqrt(ONE - c2 * c2) * math.copysign(1.0, math.sin(home[1]))
    # end = (a + b c2) e1 + b s2 e1', solved for the direction e1.
    along, across = c2 * b + a, s2 * b
    reciprocal = ONE / squares
    c1 = (end[0] * along + end[1] * across) * reciprocal
    s1 = (end[1] * along - end[0] * across) * reciprocal
    # The second link ends at the leg's end.
    c12, s12 = (end[0] - c1 * a) * (1.0 / b), (end[1] - s1 * a) * (1.0 / b)
    turn = math.atan2(leg.end_rotation[1][0], leg.end_rotation[0][0])
    whole = turned(angles.pair(Linear(0.0, {"phi": 1.0})), turn)
    one, two, three = (joint.name for joint in leg.joints)
    angles.closed = {
        (one,): (c1, s1),
        (two,): (c2, s2),
        (one, two): (c12, s12),
        (one, two, three): whole,
        (three,): (c12 * whole[0] + s12 * whole[1], c12 * whole[1] - s12 * whole[0]),
        (two, three): (c1 * whole[0] + s1 * whole[1], c1 * whole[1] - s1 * whole[0]),
    }


def turned(pair, angle):
    """Pair of a sum with a constant."""
    c, s = round(math.cos(angle), 15), round(math.sin(angle), 15)
    return pair[0] * c - pair[1] * s, pair[1] * c + pair[0] * s
