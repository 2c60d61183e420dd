"""A robot's description: legs of joints in modified Denavit-Hartenberg frames, and a platform."""

import math
import tomllib
from dataclasses import dataclass, field

import numpy as np

from .values import Linear, evaluate, settle

INERTIA = ["xx", "xy", "xz", "yy", "yz", "zz", "mx", "my", "mz", "m"]
FRICTION = ["fv", "fs", "off"]
GROUPS = {"inertia": INERTIA, "friction": FRICTION, "all": [*INERTIA, "ia", *FRICTION]}


def turn(axis, angle):
    """Rotation about the axis x (0), y (1) or z (2)."""
    c, s = settle(math.cos(angle)), settle(math.sin(angle))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def orientation(angles):
    """Rz(rz) Ry(ry) Rx(rx), without rounding errors of right angles."""
    rx, ry, rz = angles
    return np.vectorize(settle)(turn(2, rz) @ turn(1, ry) @ turn(0, rx))


@dataclass
class Joint:
    """One joint with its body; `position` is a linear expression of joint variables."""

    name: str
    kind: str
    antecedent: int | None
    gamma: float
    b: float
    alpha: float
    d: float
    theta: Linear
    r: Linear
    parameters: list[str]

    @property
    def position(self):
        return self.theta if self.kind == "revolute" else self.r


@dataclass
class Cable:
    """A leg without joints: radius of its pulley (0 for an eyelet), least tension, parameters of its drive."""

    pulley: float
    minimum: float
    parameters: list[str]


@dataclass
class Leg:
    """A placed leg."""

    name: str
    base_at: np.ndarray
    base_rotation: np.ndarray
    joints: list[Joint]
    end_type: str | None = None
    end_at: np.ndarray | None = None
    end_rotation: np.ndarray | None = None
    #: For a chain of a skeleton: joints of the first leg whose bodies it starts and ends on.
    base_body: int | None = None
    end_body: int | None = None
    variables: list[int] = field(default_factory=list)
    cable: Cable | None = None


@dataclass
class Robot:
    """A mechanism."""

    name: str
    gravity: np.ndarray
    motion: str | None
    axis: str
    platform_parameters: list[str]
    legs: list[Leg]
    #: Names of the independent coordinates of a platform with parasitic motion.
    independent: list[str] | None = None


def parameter_list(value):
    entries = [value] if isinstance(value, str) else value
    return [s for entry in entries for s in GROUPS.get(entry, [entry])]


def vector(values, names):
    return np.array([evaluate(v, names) for v in values])


def joint(entry, number, known, names, full):
    name = str(entry.get("name", number))
    kind = entry["type"]
    own = name if kind != "fixed" else None
    variables = {f"q_{n}": Linear(0.0, {n: 1.0}) for n in [*known, name]}
    variables |= {f"q{n}": Linear(0.0, {n: 1.0}) for n in [*known, name] if n.isdigit()}
    if own is not None:
        variables["q"] = Linear(0.0, {own: 1.0})

    def constant(key):
        return evaluate(entry.get(key, 0), names)

    def linear(key, moves):
        return Linear.of(evaluate(entry.get(key, "q" if moves else 0), names | variables))

    antecedent = entry.get("antecedent")
    parent = (
        len(known) - 1 if antecedent is None else (-1 if antecedent == "base" else known.index(antecedent))
    )
    default = "all" if entry.get("actuated") else ["inertia", "friction"]
    parameters = parameter_list(entry.get("parameters", default))
    if full:
        parameters = [] if kind == "fixed" else GROUPS["all"]
    return Joint(
        name=name,
        kind=kind,
        antecedent=None if parent < 0 else parent,
        gamma=constant("gamma"),
        b=constant("b"),
        alpha=constant("alpha"),
        d=constant("d"),
        theta=linear("theta", kind == "revolute"),
        r=linear("r", kind == "prismatic"),
        parameters=parameters,
    )


def cable(shape, names):
    """The cable of a leg without joints."""
    if shape.get("type") != "cable":
        return None
    return Cable(
        pulley=evaluate(shape.get("pulley", 0), names),
        minimum=evaluate(shape.get("minimum", 0), names),
        parameters=parameter_list(shape.get("parameters", ["ia", "fv", "fs"])),
    )


def load(path, full=False):
    """Reads a description; `full` gives every joint all fourteen parameters."""
    with open(path, "rb") as file:
        document = tomllib.load(file)
    constants = {}
    for name, value in document.get("constants", {}).items():
        constants[name] = evaluate(value, constants)
    platform = document.get("platform", {})
    legs = []
    for place in document["place"]:
        shape = document["leg"][place["shape"]]
        names = dict(constants)
        for variable in shape.get("variables", []):
            names[variable] = evaluate(place[variable], constants)
        base = shape.get("base", {})
        known, joints = [], []
        for number, entry in enumerate(shape.get("joint", []), 1):
            joints.append(joint(entry, number, known, names, full))
            known.append(joints[-1].name)
        end = shape.get("end", {})
        bodies = [joint.name for joint in legs[0].joints] if legs else []
        carriers = [bodies.index(of["body"]) if "body" in of else None for of in (base, end)]
        legs.append(
            Leg(
                name=place["name"],
                base_at=vector(base.get("at", [0, 0, 0]), names),
                base_rotation=orientation(vector(base.get("rotation", [0, 0, 0]), names)),
                joints=joints,
                end_type=end.get("type", "rigid") if end else None,
                end_at=vector(end.get("at", [0, 0, 0]), names),
                end_rotation=orientation(vector(end.get("rotation", [0, 0, 0]), names)),
                base_body=carriers[0],
                end_body=carriers[1],
                cable=cable(shape, names),
            )
        )
    return Robot(
        name=document["name"],
        gravity=vector(document.get("gravity", [0, 0, -9.81]), constants),
        motion=platform.get("motion"),
        axis=platform.get("axis", "z"),
        platform_parameters=INERTIA if full else parameter_list(platform.get("parameters", "inertia")),
        legs=legs,
        independent=platform.get("independent"),
    )
