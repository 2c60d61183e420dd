"""Pinocchio as the engine of an imported robot."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio
from description import relative_turn


class Engine:
    """Tree of a URDF. Ball joints of the description are three joints about x, y and z here."""

    def __init__(self, file, description, home):
        self.model = pinocchio.buildModelFromUrdf(str(file))
        self.data = self.model.createData()
        self.description = description
        self.carried = description.carried()
        root = ElementTree.parse(file).getroot()
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
        values = {name: value for (_, name), value in zip(self.description.joints(), home)}
        for name, value in values.items():
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
        self.scalar = {name: (q[i], rates[i], accelerations[i]) for i, (_, name) in enumerate(self.description.joints())}

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
        moving = [
            j["name"] for leg in self.description.legs for j in self.description.toml["leg"][leg]["joint"] if j.get("actuated")
        ]
        for name, torque in zip(moving, torques):
            force[self.model.joints[self.model.getJointId(name)].idx_v] = torque
        return force
