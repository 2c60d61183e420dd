"""The platform: its independent coordinates, its motion, its columns."""

from .algebra import ONE, add, apply, cross, dot, matrix, scale, sub, transpose, vector
from .model import Motion, about_x, about_y, about_z, body_wrench, spin
from .values import Linear

#: Directions of the translations and rotations of each motion, for motions without an axis.
SPACE = "xyz"


def unit(axis):
    return vector([float(a == axis) for a in SPACE])


class Platform:
    """Position, orientation, twist and acceleration in the base frame, from the independent coordinates."""

    def __init__(self, robot, algebra, angles, inputs):
        self.robot = robot
        axis = robot.axis
        others = {"z": "xy", "x": "yz", "y": "zx"}[axis] if axis in SPACE else ""
        translations, rotations = {
            "point": (others, ""),
            "planar": (others, axis),
            "translation": (SPACE, ""),
            "schoenflies": (SPACE, axis),
            "spatial": (SPACE, SPACE),
            "spherical": ("", SPACE),
        }[robot.motion]
        self.moves = [(unit(a), vector([0] * 3)) for a in translations]
        self.moves += [(vector([0] * 3), unit(a)) for a in rotations]
        self.rotation = self.orientation(len(translations), rotations, angles, inputs["pose"])
        self.velocity, self.omega = self.combined(inputs["twist"])
        self.acceleration, self.alpha = self.combined(inputs["acceleration"])

    @property
    def dof(self):
        return len(self.moves)

    def orientation(self, at, rotations, angles, pose):
        if rotations == SPACE:
            return from_quaternion(pose[at : at + 4])
        if not rotations:
            return matrix([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
        if rotations not in tuple(SPACE):
            raise NotImplementedError("rotation about a tilted axis")
        angles.variables["phi"] = pose[at]
        about = [about_x, about_y, about_z][SPACE.index(rotations)]
        return about(angles.pair(Linear(0.0, {"phi": 1.0})))

    def combined(self, values):
        linear, angular = vector([0] * 3), vector([0] * 3)
        for (v, w), value in zip(self.moves, values, strict=True):
            linear = add(linear, scale(v, value))
            angular = add(angular, scale(w, value))
        return linear, angular

    def end(self, leg):
        """Quantities of a leg's end in the base frame: lever, partial twists, acceleration and angular
        acceleration."""
        lever = apply(self.rotation, vector(leg.end_at))
        partials = [(add(v, cross(w, lever)), w) for v, w in self.moves]
        velocity = add(self.velocity, cross(self.omega, lever))
        acceleration = add(self.acceleration, spin(self.omega, self.alpha, lever))
        return partials, (velocity, self.omega), (acceleration, self.alpha)

    def columns(self, wanted):
        """Columns of the platform's own parameters."""
        back = transpose(self.rotation)
        motion = Motion(
            apply(back, self.omega),
            apply(back, self.alpha),
            apply(back, sub(self.acceleration, vector(self.robot.gravity))),
        )
        moves = [(apply(back, v), apply(back, w)) for v, w in self.moves]
        found = {}
        for symbol in self.robot.platform_parameters:
            name = wanted(symbol)
            if name is not None:
                force, moment = body_wrench(symbol, motion)
                found[name] = [dot(v, force) + dot(w, moment) for v, w in moves]
        return found


def from_quaternion(q):
    """The rotation matrix of a unit quaternion, scalar first."""
    w, x, y, z = q
    two = 2.0
    return [
        [ONE - (y * y + z * z) * two, (x * y - w * z) * two, (x * z + w * y) * two],
        [(x * y + w * z) * two, ONE - (x * x + z * z) * two, (y * z - w * x) * two],
        [(x * z - w * y) * two, (y * z + w * x) * two, ONE - (x * x + y * y) * two],
    ]
