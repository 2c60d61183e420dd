"""Pinocchio as the engine of an imported robot."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pinocchio
from description import relative_turn, with_followers


class Engine:
    """Tree of a URDF. Ball joints of the description are three joints about x, y and z here."""

    def __init__(self, file, description, home):
        root = with_universal_joints(file)
        self.model = pinocchio.buildModelFromXML(ElementTree.tostring(root, encoding="unicode"))
        self.data = self.model.createData()
        self.description = description
        self.carried = description.carried()
        mimics = {joint.get("name"): joint.find("mimic") for joint in root.findall("joint") if joint.find("mimic") is not None}
        self.followers = {
            name: (mimic.get("joint"), float(mimic.get("multiplier", 1)), float(mimic.get("offset", 0))) for name, mimic in mimics.items()
        }
        self.damping = np.zeros(self.model.nv)
        self.child = {}
        for joint in root.findall("joint"):
            self.child[joint.get("name")] = joint.find("child").get("link")
            dynamics = joint.find("dynamics")
            if dynamics is not None and self.model.existJointName(joint.get("name")):
                self.damping[self.model.joints[self.model.getJointId(joint.get("name"))].idx_v] = float(dynamics.get("damping", 0))
        gravity = description.toml["gravity"]
        self.model.gravity.linear = np.array(gravity)
        self.at_home(home)

    def at_home(self, home):
        """Rotations between the frames of description and engine."""
        still = self.description.motion(home, 0 * home, 0 * home)
        q = pinocchio.neutral(self.model)
        values = dict(zip(self.description.names(), home))
        for name, value in with_followers(values, self.followers).items():
            if self.model.existJointName(name):
                self.place(q, name, value)
        for name, value in self.description.home.items():
            if self.model.existJointName(name):
                self.place(q, name, value[0])
                continue
            # A ball joint corresponds to three joints about x, y and z whose names contain its name.
            row = [n for n in self.model.names if n.startswith(name + "_") and "_" not in n[len(name) + 1 :]]
            turn = pinocchio.exp3(value)
            angles = np.arctan2(-turn[1, 2], turn[2, 2]), np.arcsin(turn[0, 2]), np.arctan2(-turn[0, 1], turn[0, 0])
            assert len(row) == 3, f"{name} is {row}"
            for own, angle in zip(row, angles):
                self.place(q, own, angle)
        pinocchio.forwardKinematics(self.model, self.data, q)
        self.offset = {}
        for name, joint in self.carried.items():
            at = self.joint_of(name)
            if at is not None:
                self.offset[at] = (joint, relative_turn(still[joint].frame[:3, :3], self.data.oMi[at].rotation))

    def place(self, q, name, value):
        joint = self.model.joints[self.model.getJointId(name)]
        if joint.nq == 2:
            q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
        else:
            q[joint.idx_q] = value

    def joint_of(self, link):
        for joint, child in self.child.items():
            if child == link and self.model.existJointName(joint):
                return self.model.getJointId(joint)
        return None

    def turned(self, bodies, joint):
        if joint == 0:
            return np.eye(3), np.zeros(3), np.zeros(3)
        own, offset = self.offset[joint]
        moved = bodies[own]
        return moved.frame[:3, :3] @ offset, moved.rate, moved.acceleration

    def state(self, bodies):
        model = self.model
        q, v, a = pinocchio.neutral(model), np.zeros(model.nv), np.zeros(model.nv)
        done = set()
        for joint in range(model.njoints - 1, 0, -1):
            if joint in done:
                continue
            if joint not in self.offset:
                raise RuntimeError(f"the description has no body behind `{model.names[joint]}`")
            row = [joint]
            while model.parents[row[0]] not in self.offset and model.parents[row[0]]:
                row.insert(0, model.parents[row[0]])
            done.update(row)
            turn, rate, acceleration = self.turned(bodies, joint)
            before, rate0, acceleration0 = self.turned(bodies, model.parents[row[0]])
            self.fill(row, before, turn, (rate - rate0, acceleration - acceleration0, rate0), q, v, a, bodies)
        return q, v, a

    def axis(self, joint):
        data = self.model.joints[joint].createData() if hasattr(self.model.joints[joint], "createData") else None
        name = self.model.joints[joint].shortname()
        for at, letter in enumerate("XYZ"):
            if name.endswith("R" + letter) or name.endswith("RUB" + letter) or name.endswith("P" + letter):
                return np.eye(3)[at], "P" in name[-2:]
        own = self.model.joints[joint]
        q = np.zeros(own.nq)
        own.calc(data, q)
        motion = np.array(data.S).reshape(6, -1)[:, 0]
        return (motion[:3], True) if np.abs(motion[3:]).max() < 1e-12 else (motion[3:], False)

    def fill(self, row, before, turn, relative, q, v, a, bodies):
        rate, acceleration, rate0 = relative
        if len(row) == 1:
            joint = row[0]
            own = self.model.joints[joint]
            axis, is_slide = self.axis(joint)
            name = self.model.names[joint]
            if is_slide:
                position, speed, change = self.scalar[name]
            else:
                left = self.model.jointPlacements[joint].rotation.T @ before.T @ turn
                sine = np.array([left[2, 1] - left[1, 2], left[0, 2] - left[2, 0], left[1, 0] - left[0, 1]]) @ axis / 2
                position = np.arctan2(sine, (np.trace(left) - 1) / 2)
                world = turn @ axis
                speed, change = rate @ world, acceleration @ world
            self.place(q, name, position)
            v[own.idx_v], a[own.idx_v] = speed, change
            return
        placed = self.model.jointPlacements[row[0]].rotation
        assert len(row) == 3, "three joints of a ball"
        left = placed.T @ before.T @ turn
        angles = np.array([np.arctan2(-left[1, 2], left[2, 2]), np.arcsin(left[0, 2]), np.arctan2(-left[0, 1], left[0, 0])])
        axes, so_far = [], before @ placed
        for at, angle in enumerate(angles):
            axes.append(so_far[:, at])
            c, s = np.cos(angle), np.sin(angle)
            i, j = [(1, 2), (2, 0), (0, 1)][at]
            step = np.eye(3)
            step[i, i], step[j, j], step[i, j], step[j, i] = c, c, -s, s
            so_far = so_far @ step
        assert np.abs(so_far - turn).max() < 1e-9, "three joints about x, y and z"
        columns = np.array(axes).T
        rates = np.linalg.solve(columns, rate)
        turning, spin = np.zeros(3), rate0.copy()
        for axis, speed in zip(axes, rates):
            turning += np.cross(spin, axis) * speed
            spin += axis * speed
        changes = np.linalg.solve(columns, acceleration - turning)
        for joint, angle, speed, change in zip(row, angles, rates, changes):
            own = self.model.joints[joint]
            self.place(q, self.model.names[joint], angle)
            v[own.idx_v], a[own.idx_v] = speed, change

    def moved(self, q, rates, accelerations):
        """Positions of the joints themselves, needed for slides."""
        states = np.array([q, rates, accelerations])
        own = dict(zip(self.description.names(), states.T))
        self.scalar = with_followers(own, self.followers)

    def centres(self, position, description, bodies, values):
        model, data = self.model, self.data
        pinocchio.forwardKinematics(model, data, position)
        worst = 0.0
        single = len(description.legs) == 1
        sums = {}
        for joint, (own, _) in self.offset.items():
            mass, moment = sums.get(own, (0.0, np.zeros(3)))
            inertia = model.inertias[joint]
            sums[own] = mass + inertia.mass, moment + inertia.mass * data.oMi[joint].act(inertia.lever)
        for (leg, name), (mass, moment) in sums.items():
            value = lambda symbol: values.get(f"{symbol}_{name}" + ("" if single else f"_{leg}"), 0.0)
            if mass == 0 and value("m") == 0:
                continue
            own = bodies[leg, name].frame
            ours = own[:3, 3] + own[:3, :3] @ np.array([value("mx"), value("my"), value("mz")]) / value("m")
            worst = max(worst, np.abs(ours - moment / mass).max(), abs(mass / value("m") - 1))
        return worst

    def inverse_dynamics(self, q, v, a):
        return pinocchio.rnea(self.model, self.data, q, v, a) + self.damping * v

    def on_motors(self, torques, sheet):
        force = np.zeros(self.model.nv)
        for name, torque in zip(self.description.actuated(), torques):
            force[self.model.joints[self.model.getJointId(name)].idx_v] = torque
        return force


def with_universal_joints(file):
    """The tree of a URDF, with the universal and ball joints that `robot.yaml` next to it makes of others."""
    root = ElementTree.parse(file).getroot()
    beside = Path(file).with_name("robot.yaml")
    text = re.sub(r"#.*", "", beside.read_text()) if beside.exists() else ""
    lists = {key: re.findall(r"[\w.-]+", value) for key, value in re.findall(r"^(joint_name|joint_type):\s*\[(.*?)\]", text, re.M | re.S)}
    for name, kind in zip(lists.get("joint_name", []), lists.get("joint_type", [])):
        joint = root.find(f"joint[@name='{name}']")
        letters = {"CARDAN": "XY", "SPHERICAL": "XYZ"}.get(kind, kind.removeprefix("UJOINT_"))
        if len(letters) not in (2, 3) or joint is None or joint.get("type") == "spherical":
            continue
        axes = {"X": "1 0 0", "Y": "0 1 0", "Z": "0 0 1"}
        child = joint.find("child").get("link")
        links = [f"{child}_{letter}" for letter in letters[:-1]] + [child]
        for link in links[:-1]:
            ElementTree.SubElement(root, "link", name=link)
        for letter, before, after in zip(letters[1:], links, links[1:]):
            own = ElementTree.SubElement(root, "joint", name=f"{name}_{letter}", type="continuous")
            ElementTree.SubElement(own, "parent", link=before)
            ElementTree.SubElement(own, "child", link=after)
            ElementTree.SubElement(own, "axis", xyz=axes[letter])
        joint.set("name", f"{name}_{letters[0]}")
        joint.set("type", "continuous")
        joint.find("child").set("link", links[0])
        for axis in joint.findall("axis"):
            joint.remove(axis)
        ElementTree.SubElement(joint, "axis", xyz=axes[letters[0]])
    return root
