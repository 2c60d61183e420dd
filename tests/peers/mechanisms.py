"""Random trees and closed mechanisms, written as MJCF, URDF and SDFormat."""

from dataclasses import dataclass, field

import numpy as np


def unit(vector):
    return vector / np.linalg.norm(vector)


def random_rotation(random):
    q = unit(random.normal(size=4))
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


@dataclass
class Body:
    """A body with the joint that carries it; frames are in the world at home."""

    name: str
    parent: int
    rotation: np.ndarray
    origin: np.ndarray
    # `hinge`, `slide` or `ball`; the joint is at the origin of the body.
    kind: str
    # In the frame of the body.
    axis: np.ndarray
    mass: float = 1.0
    centre: np.ndarray = None
    tensor: np.ndarray = None
    damping: float = 0.0


@dataclass
class Loop:
    """A joint at a point of the world that connects two bodies: `hinge` or `ball`."""

    bodies: tuple
    point: np.ndarray
    kind: str
    axis: np.ndarray


@dataclass
class Mechanism:
    """The ground is body 0, which is not in the list."""

    bodies: list = field(default_factory=list)
    loops: list = field(default_factory=list)
    driven: list = field(default_factory=list)

    def frame(self, body):
        if body == 0:
            return np.eye(3), np.zeros(3)
        own = self.bodies[body - 1]
        return own.rotation, own.origin

    def name(self, body):
        return "world" if body == 0 else self.bodies[body - 1].name

    def add(self, random, parent, origin, kind, axis, rotation=None):
        """Adds a body with random inertia; the axis is in the world. Returns its number."""
        rotation = random_rotation(random) if rotation is None else rotation
        body = Body(f"b{len(self.bodies) + 1}", parent, rotation, np.array(origin), kind, rotation.T @ axis)
        body.mass = float(random.uniform(0.2, 3))
        body.centre = random.uniform(-0.2, 0.2, 3)
        # Moments of a box, whose sides give the triangle inequality a margin.
        sides = random.uniform(0.1, 0.4, 3) ** 2
        turn = random_rotation(random)
        body.tensor = turn @ np.diag(body.mass / 12 * (sides.sum() - sides)) @ turn.T
        body.damping = 0.0 if kind == "ball" else float(random.choice([0.0, random.uniform(0.1, 1)]))
        self.bodies.append(body)
        return len(self.bodies)


def tree(random):
    """A tree of two to eight bodies with hinges and slides in any direction."""
    own = Mechanism()
    for _ in range(random.integers(2, 9)):
        # Only the last body and its ancestors, so that every format has the same order.
        chain = [0]
        body = len(own.bodies)
        while body:
            chain.append(body)
            body = own.bodies[body - 1].parent
        parent = int(random.choice(chain))
        _, origin = own.frame(parent)
        kind = random.choice(["hinge", "hinge", "hinge", "slide"])
        own.add(random, parent, origin + random.uniform(-0.4, 0.4, 3), kind, unit(random.normal(size=3)))
    own.driven = list(range(1, len(own.bodies) + 1))
    return own


def closed(random):
    """Driven bodies, then dyads of two hinged bodies in their plane, and rods with two balls in space."""
    own = Mechanism()
    plane = random_rotation(random)
    normal = plane[:, 2]
    at = lambda x, y: plane @ np.array([x, y, 0.0])
    points = {0: at(0, 0)}
    for _ in range(random.integers(1, 4)):
        parent = int(random.integers(0, len(own.bodies) + 1))
        origin = points[parent] + at(*random.uniform(-0.3, 0.3, 2))
        body = own.add(random, parent, origin, "hinge", normal)
        own.driven.append(body)
        points[body] = origin + at(*(unit(random.normal(size=2)) * random.uniform(0.2, 0.4)))
    for _ in range(random.integers(1, 4)):
        if random.random() < 0.3:
            add_rod(random, own, points)
        else:
            add_dyad(random, own, points, at, normal)
    return own


def pair(random, own, points):
    """Two bodies that move in the plane, and a point of each."""
    a, b = (int(body) for body in random.choice(list(points), 2, replace=False))
    return a, b, [points[body] for body in (a, b)]


def add_dyad(random, own, points, at, normal):
    while True:
        a, b, (start, end) = pair(random, own, points)
        start = start + at(*random.uniform(-0.2, 0.2, 2))
        end = end + at(*random.uniform(-0.2, 0.2, 2))
        if np.linalg.norm(end - start) > 0.15:
            break
    across = np.cross(normal, end - start)
    middle = 0.5 * (start + end) + random.choice([-1, 1]) * random.uniform(0.4, 0.9) * across
    first = own.add(random, a, start, "hinge", normal)
    second = own.add(random, first, middle, "hinge", normal)
    points[first], points[second] = middle, 0.5 * (middle + end)
    own.loops.append(Loop((second, b), end, "hinge", normal))


def add_rod(random, own, points):
    """A rod with a ball joint at each end drives a rocker on the ground."""
    while True:
        a, _, (start, _) = pair(random, own, points)
        if a == 0:
            continue
        hinge = start + random.uniform(-0.6, 0.6, 3)
        axis, arm = unit(random.normal(size=3)), random.uniform(-0.3, 0.3, 3)
        end = hinge + arm
        rod, sweep = end - start, np.cross(axis, arm)
        # The rod must not be perpendicular to the path of its end.
        if np.linalg.norm(rod) > 0.15 and abs(unit(rod) @ sweep) > 0.08:
            break
    rocker = own.add(random, 0, hinge, "hinge", axis)
    body = own.add(random, a, start, "ball", axis)
    own.loops.append(Loop((body, rocker), end, "ball", axis))


def numbers(values):
    return " ".join(repr(float(value)) for value in np.ravel(values))


def angles(turn):
    """Roll, pitch and yaw about fixed axes."""
    pitch = np.arctan2(-turn[2, 0], np.hypot(turn[0, 0], turn[1, 0]))
    return np.array([np.arctan2(turn[2, 1], turn[2, 2]), pitch, np.arctan2(turn[1, 0], turn[0, 0])])


def quaternion(turn):
    roll, pitch, yaw = angles(turn) / 2
    c, s = np.cos, np.sin
    return np.array([
        c(roll) * c(pitch) * c(yaw) + s(roll) * s(pitch) * s(yaw),
        s(roll) * c(pitch) * c(yaw) - c(roll) * s(pitch) * s(yaw),
        c(roll) * s(pitch) * c(yaw) + s(roll) * c(pitch) * s(yaw),
        c(roll) * c(pitch) * s(yaw) - s(roll) * s(pitch) * c(yaw),
    ])


def relative(own, body):
    """Rotation and origin of a body in its parent."""
    turn, origin = own.frame(own.bodies[body - 1].parent)
    rotation, position = own.frame(body)
    return turn.T @ rotation, turn.T @ (position - origin)


def tensor_of(body):
    t = body.tensor
    return {"ixx": t[0, 0], "iyy": t[1, 1], "izz": t[2, 2], "ixy": t[0, 1], "ixz": t[0, 2], "iyz": t[1, 2]}


def mjcf(own):
    def written(parent):
        text = ""
        for number, body in enumerate(own.bodies, 1):
            if body.parent != parent:
                continue
            turn, origin = relative(own, number)
            axis = "" if body.kind == "ball" else f' axis="{numbers(body.axis)}" damping="{body.damping!r}"'
            text += f'<body name="{body.name}" pos="{numbers(origin)}" quat="{numbers(quaternion(turn))}">\n'
            text += f'<inertial pos="{numbers(body.centre)}" mass="{body.mass!r}" fullinertia="{numbers(list(tensor_of(body).values()))}"/>\n'
            text += f'<joint name="j{number}" type="{body.kind}"{axis}/>\n{written(number)}</body>\n'
        return text

    loops = ""
    for loop in own.loops:
        a, b = loop.bodies
        turn, origin = own.frame(a)
        other = "" if b == 0 else f' body2="{own.name(b)}"'
        loops += f'<connect body1="{own.name(a)}"{other} anchor="{numbers(turn.T @ (loop.point - origin))}"/>\n'
    motors = "".join(f'<motor joint="j{body}"/>' for body in own.driven)
    equality = f"<equality>{loops}</equality>" if loops else ""
    return f'<mujoco model="m"><compiler angle="radian"/>\n<worldbody>\n{written(0)}</worldbody>{equality}\n<actuator>{motors}</actuator></mujoco>\n'


def urdf(own):
    text = '<link name="world"/>\n'
    for number, body in enumerate(own.bodies, 1):
        t = " ".join(f'{key}="{float(value)!r}"' for key, value in tensor_of(body).items())
        inertial = f'<inertial><origin xyz="{numbers(body.centre)}"/><mass value="{body.mass!r}"/><inertia {t}/></inertial>'
        text += f'<link name="{body.name}">{inertial}</link>\n'
        turn, origin = relative(own, number)
        placed = f'<origin xyz="{numbers(origin)}" rpy="{numbers(angles(turn))}"/>'
        if body.kind == "ball":
            # Three hinges that meet in a point.
            parent = own.name(body.parent)
            for at, axis in enumerate(("1 0 0", "0 1 0", "0 0 1")):
                child = body.name if at == 2 else f"{body.name}_{at}"
                link = "" if at == 2 else f'<link name="{child}"/>'
                text += f'{link}<joint name="j{number}_{at}" type="continuous"><parent link="{parent}"/><child link="{child}"/>{placed}<axis xyz="{axis}"/></joint>\n'
                parent, placed = child, ""
            continue
        kind = {"hinge": "continuous", "slide": "prismatic"}[body.kind]
        limit = '<limit lower="-9" upper="9" effort="9" velocity="9"/>' if kind == "prismatic" else ""
        text += f'<joint name="j{number}" type="{kind}"><parent link="{own.name(body.parent)}"/><child link="{body.name}"/>{placed}'
        text += f'<axis xyz="{numbers(body.axis)}"/>{limit}<dynamics damping="{body.damping!r}"/></joint>\n'
    for number, loop in enumerate(own.loops, 1):
        a, b = loop.bodies
        # The pose is that of the joint in its child.
        turn, origin = own.frame(a)
        pose = f"<pose>{numbers(turn.T @ (loop.point - origin))} 0 0 0</pose>"
        axis = f"<axis><xyz>{numbers(turn.T @ loop.axis)}</xyz></axis>" if loop.kind == "hinge" else ""
        kind = {"hinge": "revolute", "ball": "ball"}[loop.kind]
        text += f'<gazebo><joint name="loop{number}" type="{kind}"><parent>{own.name(b)}</parent><child>{own.name(a)}</child>{pose}{axis}</joint></gazebo>\n'
    return f'<robot name="m">\n{text}</robot>\n'


def sdf(own):
    text = ""
    for number, body in enumerate(own.bodies, 1):
        turn, origin = own.frame(number)
        t = "".join(f"<{key}>{float(value)!r}</{key}>" for key, value in tensor_of(body).items())
        text += f'<link name="{body.name}"><pose>{numbers(origin)} {numbers(angles(turn))}</pose>\n<inertial><pose>{numbers(body.centre)} 0 0 0</pose>'
        text += f"<mass>{body.mass!r}</mass><inertia>{t}</inertia></inertial></link>\n"
        kind = {"hinge": "revolute", "slide": "prismatic", "ball": "ball"}[body.kind]
        dynamics = f"<dynamics><damping>{body.damping!r}</damping></dynamics>"
        axis = "" if body.kind == "ball" else f"<axis><xyz>{numbers(body.axis)}</xyz>{dynamics}</axis>"
        text += f'<joint name="j{number}" type="{kind}"><parent>{own.name(body.parent)}</parent><child>{body.name}</child>{axis}</joint>\n'
    for number, loop in enumerate(own.loops, 1):
        a, b = loop.bodies
        turn, origin = own.frame(a)
        pose = f"<pose>{numbers(turn.T @ (loop.point - origin))} 0 0 0</pose>"
        axis = f"<axis><xyz>{numbers(turn.T @ loop.axis)}</xyz></axis>" if loop.kind == "hinge" else ""
        kind = {"hinge": "revolute", "ball": "ball"}[loop.kind]
        text += f'<joint name="loop{number}" type="{kind}">{pose}<parent>{own.name(b)}</parent><child>{own.name(a)}</child>{axis}</joint>\n'
    return f'<sdf version="1.9"><model name="m">\n{text}</model></sdf>\n'


FORMATS = {"xml": mjcf, "urdf": urdf, "sdf": sdf}
