"""An imported description, moved by its modified Denavit-Hartenberg constants only."""

import re
import tomllib
from pathlib import Path

import numpy as np

UNITS = {"deg": np.pi / 180, "": 1.0}


def number(value):
    """A number, or a text with a number and its unit."""
    if not isinstance(value, str):
        return float(value)
    value, _, unit = value.partition(" ")
    return float(value) * UNITS[unit]


def about(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    turn = np.eye(3)
    turn[i, i], turn[j, j], turn[i, j], turn[j, i] = c, c, -s, s
    return turn


def frame(at=(0, 0, 0), rotation=None):
    whole = np.eye(4)
    whole[:3, 3] = at
    if rotation is not None:
        whole[:3, :3] = rotation
    return whole


def placed(table):
    """Frame given by `at` and `rotation`."""
    rx, ry, rz = (number(v) for v in table.get("rotation", [0, 0, 0]))
    return frame([number(v) for v in table.get("at", [0, 0, 0])], about(2, rz) @ about(1, ry) @ about(0, rx))


def relative_turn(before, after):
    return before.T @ after


def with_followers(values, followers):
    """Positions of joints, or (position, rate, acceleration), with those of the joints that follow them.

    `followers`: leader, factor and offset by name.
    """
    every = dict(values)
    for _ in followers:
        for name, (leader, factor, offset) in followers.items():
            if leader in every and name not in every:
                value = factor * np.asarray(every[leader], dtype=float)
                every[name] = value + (offset if value.ndim == 0 else np.eye(len(value))[0] * offset)
            elif name in every and leader not in every:
                value = np.asarray(every[name], dtype=float)
                every[leader] = (value - (offset if value.ndim == 0 else np.eye(len(value))[0] * offset)) / factor
    return every


class Body:
    """Frame of a joint's body, its angular velocity and acceleration, and those of its origin."""

    def __init__(self, whole, rate, acceleration, linear):
        self.frame, self.rate, self.acceleration = whole, rate, acceleration
        self.linear_rate, self.linear_acceleration = linear

    def at(self, origin):
        """Velocity and acceleration of a point of the body."""
        arm = origin - self.frame[:3, 3]
        rate = self.linear_rate + np.cross(self.rate, arm)
        centripetal = np.cross(self.rate, np.cross(self.rate, arm))
        return rate, self.linear_acceleration + np.cross(self.acceleration, arm) + centripetal


class Description:
    def __init__(self, path):
        text = Path(path).read_text()
        self.toml = tomllib.loads(text)
        self.legs = [place["name"] for place in self.toml["place"]]
        # The comment of each joint names the bodies of the file that it connects.
        self.between = {}
        # Names of joints in the file, where those of the description differ.
        self.in_file = {}
        for block in re.split(r"\n(?=\n)", text):
            joint = re.search(r"\[\[leg\.(\w+)\.joint\]\]\nname = \"(\w+)\"", block)
            said = re.search(r"from `([^`]*)`\s+to\s+`([^`]*)`", block.replace("\n#", ""))
            if joint and said:
                self.between[joint.groups()] = said.groups()
            own = re.search(r"^# `([^`]*)` of line", block, re.M)
            if joint and own:
                self.in_file[joint.groups()] = own[1]
            platform = re.search(r"Displacements of the platform `([^`]*)`", block)
            if joint and platform:
                self.between[joint.groups()] = ("ground", platform[1])

        # Home positions of joints without a coordinate of their own.
        joined = re.sub(r"\n# ?", " ", text)
        self.home = {}
        for name, value in re.findall(r"Home: `([^`]*)` = (\[[^\]]*\]|\S+)", joined):
            self.home[name] = np.array([float(v) for v in value.strip("[]").split(",")])
        # The head of the file lists the bodies that are fixed together; the first gives the name.
        head = text.split("\nname =")[0].replace("\n# ", " ")
        self.together = {}
        for own, others in re.findall(r"One body here, fixed together: `([^`]*)` and ((?:`[^`]*`(?:, )?)*)", head):
            self.together[own] = re.findall(r"`([^`]*)`", others)

    def joints(self):
        """Joints with a variable of their own, in order."""
        for leg in self.legs:
            for joint in self.toml["leg"][leg]["joint"]:
                if joint["type"] != "fixed" and "q_" not in str(joint.get("theta", "")) + str(joint.get("r", "")):
                    yield leg, joint["name"]

    def names(self):
        """Names of these joints in the file."""
        return [self.in_file.get(key, key[1]) for key in self.joints()]

    def actuated(self):
        """Names in the file of the joints with a motor, in order."""
        every = [(leg, joint) for leg in self.legs for joint in self.toml["leg"][leg]["joint"] if joint.get("actuated")]
        return [self.in_file.get((leg, joint["name"]), joint["name"]) for leg, joint in every]

    def drives(self):
        """Combinations of joints of the file that the actuators turn, as factors by name, in order."""
        drives = [{name: 1.0} for name in self.actuated()]
        for motor in self.toml.get("motor", {}).values():
            terms = {}
            for sign, factor, leg, joint in re.findall(r"([-+]?) *(?:([\d.e-]+)(?: [a-z/]+)? \* )?(\w+)\.q_(\w+)", motor["turns"]):
                name = self.in_file.get((leg, joint), joint)
                terms[name] = float(factor or 1) * (-1 if sign == "-" else 1)
            drives.append(terms)
        return drives

    def motion(self, q, rates, accelerations):
        """Motions of all bodies by leg and joint."""
        own = {key: (q[i], rates[i], accelerations[i]) for i, key in enumerate(self.joints())}
        still = Body(np.eye(4), np.zeros(3), np.zeros(3), (np.zeros(3), np.zeros(3)))
        bodies = {}
        for leg in self.legs:
            table = self.toml["leg"][leg]
            base = table.get("base", {})
            on = self.named(bodies, base.get("body", "ground"), still)
            origin = on.frame @ placed(base)
            start = Body(origin, on.rate, on.acceleration, on.at(origin[:3, 3]))
            before = "base"
            for joint in table["joint"]:
                antecedent = joint.get("antecedent", before)
                carrier = start if antecedent == "base" else bodies[leg, antecedent]
                bodies[leg, joint["name"]] = self.moved(leg, joint, carrier, own)
                before = joint["name"]
        bodies["ground"] = still
        return bodies

    def named(self, bodies, name, still):
        if name == "ground":
            return still
        leg, _, joint = name.rpartition(".")
        return bodies[leg or self.legs[0], joint]

    def moved(self, leg, joint, carrier, own):
        variable = {"revolute": "theta", "prismatic": "r"}.get(joint["type"])
        constants = {key: 0.0 for key in ("gamma", "b", "alpha", "d", "theta", "r")}
        position = rate = acceleration = 0.0
        for key in constants:
            value = joint.get(key, "q" if key == variable else 0.0)
            if key == variable:
                found = re.fullmatch(r"(?:(-?[\d.e+-]+)(?: [a-z/]+)? \* )?(q(?:_\w+)?)(?: ([+-]) (.*))?", value)
                factor, name, sign, constant = found.groups()
                moved = own[leg, joint["name"] if name == "q" else name[2:]]
                position, rate, acceleration = (float(factor or 1) * m for m in moved)
                offset = number(constant if " " in constant else float(constant)) if constant else 0.0
                constants[key] = position + (-offset if sign == "-" else offset)
            else:
                constants[key] = number(value)
        c = constants
        step = frame(rotation=about(2, c["gamma"])) @ frame((0, 0, c["b"])) @ frame(rotation=about(0, c["alpha"]))
        step = step @ frame((c["d"], 0, 0)) @ frame(rotation=about(2, c["theta"])) @ frame((0, 0, c["r"]))
        whole = carrier.frame @ step
        z = whole[:3, 2]
        linear = carrier.at(whole[:3, 3])
        if joint["type"] != "revolute":
            linear = (linear[0] + z * rate, linear[1] + z * acceleration + 2 * np.cross(carrier.rate, z) * rate)
            return Body(whole, carrier.rate, carrier.acceleration, linear)
        turning = np.cross(carrier.rate, z) * rate
        return Body(whole, carrier.rate + z * rate, carrier.acceleration + z * acceleration + turning, linear)

    def carried(self):
        """Body of the file that each joint of the description carries, by name."""
        found, known = {}, {"ground": None}
        groups = {}
        for leg in self.legs:
            table = self.toml["leg"][leg]
            before = "base"
            here = base = groups.get(table.get("base", {}).get("body", "ground"), "ground")
            ends = table.get("end", {}).get("type") == "rigid"
            moving = [j for j in table["joint"] if j["type"] != "fixed"]
            for at, joint in enumerate(moving):
                antecedent = joint.get("antecedent")
                name = joint["name"]
                if antecedent is not None:
                    here = base if antecedent == "base" else groups[antecedent if leg == self.legs[0] else f"{leg}.{antecedent}"]
                if (leg, name) in self.between:
                    pair = self.between[leg, name]
                    here = pair[1] if pair[0] == here else pair[0]
                groups[name if leg == self.legs[0] else f"{leg}.{name}"] = here
                is_last_axis = at + 1 == len(moving) or (leg, moving[at + 1]["name"]) in self.between
                if is_last_axis and here not in known and not (ends and at + 1 == len(moving)):
                    known[here] = (leg, name)
                    for body in [here, *self.together.get(here, [])]:
                        found[body] = (leg, name)
        return found
