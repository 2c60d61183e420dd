"""Sines and cosines of a leg's joints from the platform's pose: no angle is ever computed.

Legs of two links in the platform's plane, as their closure is usually written: with the vector from the first
joint to the leg's end, the law of cosines gives the second joint, the direction of the vector the first.
"""

import math

from .algebra import ONE, apply, sub, vector
from .values import Linear


def close(angles, algebra, platform, leg, pose, home):
    """Tells `angles` the pairs of all sums of a leg's joints."""
    first, second, third = leg.joints
    if platform.robot.motion != "planar" or any(j.kind != "revolute" or j.alpha for j in leg.joints):
        raise NotImplementedError("the closure of other legs than those of two links in a plane")
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
    # The second link ends where the leg does.
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
    """The pair of a sum with a constant."""
    c, s = round(math.cos(angle), 15), round(math.sin(angle), 15)
    return pair[0] * c - pair[1] * s, pair[1] * c + pair[0] * s
