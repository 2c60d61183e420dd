"""MuJoCo as the engine of an imported robot."""

import itertools

import mujoco
import numpy as np
from description import relative_turn, with_followers


class Engine:
    def __init__(self, file, description, home, misfit=0.0):
        """Misfit: changes of the description that close loops, which stay open here, m or rad."""
        self.model = model_of(file)
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        self.model.dof_frictionloss[:] = 0
        # Forces that descriptions leave out, as import reports.
        self.model.opt.density = self.model.opt.viscosity = 0
        # Ball joints of descriptions have no torques, as import reports.
        for dof in range(self.model.nv):
            if self.model.jnt_type[self.model.dof_jntid[dof]] == mujoco.mjtJoint.mjJNT_BALL:
                self.model.dof_damping[dof] = self.model.dof_armature[dof] = 0
                self.model.jnt_stiffness[self.model.dof_jntid[dof]] = 0
        # Descriptions scale gravity by a compensation of all weights; import reports others.
        self.model.body_gravcomp[:] = 0
        self.model.opt.gravity[:] = description.toml["gravity"]
        self.followers = followers_of(self.model)
        # MuJoCo leaves out the inertia that a tendon couples between branches of the tree.
        self.rotors = fixed_tendons(self.model), taken_armature(self.model)
        self.data = mujoco.MjData(self.model)
        self.description = description
        self.carried = description.carried()
        self.at_home(home, misfit)

    def at_home(self, home, misfit):
        """Poses of the engine's bodies at the description's home: ball joints rotate and free bodies move
        until the loops are closed."""
        model, data = self.model, self.data
        still = self.description.motion(home, 0 * home, 0 * home)
        data.qpos[:] = model.qpos0
        values = {name: value[0] for name, value in self.description.home.items() if len(value) == 1}
        values |= dict(zip(self.description.names(), home))
        for name, value in with_followers(values, self.followers).items():
            joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
            if joint >= 0:
                data.qpos[model.jnt_qposadr[joint]] = value
        loose = (int(mujoco.mjtJoint.mjJNT_BALL), int(mujoco.mjtJoint.mjJNT_FREE))
        balls = [
            dof
            for dof in range(model.nv)
            if int(model.jnt_type[model.dof_jntid[dof]]) in loose and not self.is_held(model.dof_bodyid[dof])
        ]
        for _ in range(20):
            mujoco.mj_forward(model, data)
            gap, rows = self.closure()
            if not len(gap) or not balls:
                break
            step = np.zeros(model.nv)
            step[balls] = -np.linalg.lstsq(rows[:, balls], gap, rcond=1e-9)[0]
            mujoco.mj_integratePos(model, data.qpos, step, 1.0)
        mujoco.mj_forward(model, data)
        gap, _ = self.closure()
        assert not len(gap) or np.abs(gap).max() < 1e-10 + 10 * misfit, f"MuJoCo's loops are {np.abs(gap).max()} m open at home"
        self.offset, self.shift = {}, {}
        for body in range(1, model.nbody):
            for name, turn in self.stages_at(body, data.qpos):
                if name in self.carried:
                    own = still[self.carried[name]].frame
                    self.offset[name] = relative_turn(own[:3, :3], turn)
                    self.shift[name] = own[:3, :3].T @ (data.xpos[body] - own[:3, 3])

    def body(self, name):
        return mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, name)

    def stages(self, body):
        """Bodies after each joint of a body of the engine, as import names them."""
        name, count = self.model.body(body).name, self.model.body_jntnum[body]
        return [self.unused(f"{name}_{at + 1}") for at in range(count - 1)] + [name]

    def unused(self, name):
        """The name, with a number if a body of the file has it."""
        free = (f"{name}_{number}" for number in itertools.count(2))
        return next(free_name for free_name in itertools.chain([name], free) if self.body(free_name) < 0)

    def stages_at(self, body, position):
        """Name and rotation after each joint of a body."""
        model = self.model
        placed = np.zeros(9)
        mujoco.mju_quat2Mat(placed, model.body_quat[body])
        turn = self.data.xmat[model.body_parentid[body]].reshape(3, 3) @ placed.reshape(3, 3)
        for at, name in enumerate(self.stages(body)[:-1]):
            joint = model.body_jntadr[body] + at
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
                address, quaternion, own = model.jnt_qposadr[joint], np.zeros(4), np.zeros(9)
                mujoco.mju_axisAngle2Quat(quaternion, model.jnt_axis[joint], position[address] - model.qpos0[address])
                mujoco.mju_quat2Mat(own, quaternion)
                turn = turn @ own.reshape(3, 3)
            yield name, turn
        yield model.body(body).name, self.data.xmat[body].reshape(3, 3)

    def closure(self):
        """Residuals of all active connect constraints and their Jacobian."""
        model, data = self.model, self.data
        gaps, rows = [], []
        for at in range(model.neq):
            if model.eq_type[at] != mujoco.mjtEq.mjEQ_CONNECT or not model.eq_active0[at]:
                continue
            a, b = model.eq_obj1id[at], model.eq_obj2id[at]
            if model.eq_objtype[at] == mujoco.mjtObj.mjOBJ_SITE:
                points = [(model.site_bodyid[s], data.site_xpos[s]) for s in (a, b)]
            else:
                local = [model.eq_data[at][:3], model.eq_data[at][3:6]]
                points = [(i, data.xpos[i] + data.xmat[i].reshape(3, 3) @ p) for i, p in zip((a, b), local)]
            jacobians = []
            for body, point in points:
                jacobian = np.zeros((3, model.nv))
                mujoco.mj_jac(model, data, jacobian, None, point, body)
                jacobians.append(jacobian)
            gaps.append(points[0][1] - points[1][1])
            rows.append(jacobians[0] - jacobians[1])
        return (np.concatenate(gaps), np.vstack(rows)) if gaps else (np.zeros(0), np.zeros((0, model.nv)))

    def turned(self, bodies, body):
        """Rotation, angular velocity and acceleration of a body of the engine."""
        while body and self.model.body(body).name not in self.carried:
            if self.is_held(body):
                return self.rotation_at_zero(body), np.zeros(3), np.zeros(3)
            if self.model.body_jntnum[body]:
                raise RuntimeError(f"the description has no body `{self.model.body(body).name}`")
            parent = self.model.body_parentid[body]
            turn, rate, acceleration = self.turned(bodies, parent)
            own = np.zeros(9)
            mujoco.mju_quat2Mat(own, self.model.body_quat[body])
            return turn @ own.reshape(3, 3), rate, acceleration
        if not body:
            return np.eye(3), np.zeros(3), np.zeros(3)
        return self.stage(bodies, self.model.body(body).name)

    def is_held(self, body):
        """Whether a body is free in the file and fixed by import."""
        model, first = self.model, self.model.body_jntadr[body]
        is_free = first >= 0 and model.jnt_type[first] == mujoco.mjtJoint.mjJNT_FREE
        return is_free and model.body(body).name not in self.carried

    def rotation_at_zero(self, body):
        address = self.model.jnt_qposadr[self.model.body_jntadr[body]]
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, self.model.qpos0[address + 3 : address + 7])
        return turn.reshape(3, 3)

    def stage(self, bodies, name):
        """Rotation, angular velocity and acceleration of a body of the description."""
        if name not in self.carried:
            raise RuntimeError(f"the description has no body `{name}`")
        moved = bodies[self.carried[name]]
        return moved.frame[:3, :3] @ self.offset[name], moved.rate, moved.acceleration

    def moved(self, q, rates, accelerations):
        """Positions of the joints themselves, needed for slides."""
        states = np.array([q, rates, accelerations])
        own = dict(zip(self.description.names(), states.T))
        self.scalar = with_followers(own, self.followers)

    def state(self, bodies):
        model = self.model
        q, v, a = model.qpos0.copy(), np.zeros(model.nv), np.zeros(model.nv)
        for joint in range(model.njnt):
            body = model.jnt_bodyid[joint]
            at, stages = joint - model.body_jntadr[body], self.stages(body)
            if self.is_held(body):
                continue
            turn, rate, acceleration = self.stage(bodies, stages[at])
            qa, va = model.jnt_qposadr[joint], model.jnt_dofadr[joint]
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE:
                q[qa : qa + 7], v[va : va + 6], a[va : va + 6] = self.free(bodies[self.carried[stages[at]]], stages[at])
                continue
            placed = np.eye(3).flatten()
            if at > 0:
                before, rate0, acceleration0 = self.stage(bodies, stages[at - 1])
            else:
                before, rate0, acceleration0 = self.turned(bodies, model.body_parentid[body])
                mujoco.mju_quat2Mat(placed, model.body_quat[body])
            relative = (before @ placed.reshape(3, 3)).T @ turn
            quaternion = np.zeros(4)
            mujoco.mju_mat2Quat(quaternion, relative.flatten())
            local = turn.T @ (rate - rate0)
            change = turn.T @ (acceleration - acceleration0 - np.cross(rate, rate - rate0))
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_BALL:
                q[qa : qa + 4], v[va : va + 3], a[va : va + 3] = quaternion, local, change
            elif model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE:
                axis = model.jnt_axis[joint]
                q[qa] += 2 * np.arctan2(quaternion[1:] @ axis, quaternion[0])
                v[va], a[va] = local @ axis, change @ axis
            else:
                q[qa], v[va], a[va] = self.scalar[model.joint(joint).name]
        return q, v, a

    def free(self, body, name):
        """Position, velocity and acceleration of a free joint: linear in the world, angular in the body."""
        turn = body.frame[:3, :3] @ self.offset[name]
        origin = body.frame[:3, 3] + body.frame[:3, :3] @ self.shift[name]
        rate, acceleration = body.at(origin)
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, turn.flatten())
        position = np.concatenate([origin, quaternion])
        return position, np.concatenate([rate, turn.T @ body.rate]), np.concatenate([acceleration, turn.T @ body.acceleration])

    def centres(self, position, description, bodies, values):
        """Largest distance between centres of mass, and between closure points."""
        model, data = self.model, self.data
        data.qpos[:] = position
        mujoco.mj_forward(model, data)
        gap, _ = self.closure()
        worst = np.abs(gap).max() if len(gap) else 0.0
        single = len(description.legs) == 1
        sums = {}
        for body in range(1, model.nbody):
            group = self.model.body(self.group(body)).name
            if group in self.carried:
                mass, moment = sums.get(self.carried[group], (0.0, np.zeros(3)))
                sums[self.carried[group]] = mass + model.body_mass[body], moment + model.body_mass[body] * data.xipos[body]
        for (leg, joint), (mass, moment) in sums.items():
            value = lambda symbol: values.get(f"{symbol}_{joint}" + ("" if single else f"_{leg}"), 0.0)
            if mass == 0 and value("m") == 0:
                continue
            own = bodies[leg, joint].frame
            ours = own[:3, 3] + own[:3, :3] @ np.array([value("mx"), value("my"), value("mz")]) / value("m")
            worst = max(worst, np.abs(ours - moment / mass).max(), abs(mass / value("m") - 1))
        return worst

    def group(self, body):
        while body and not self.model.body_jntnum[body]:
            body = self.model.body_parentid[body]
        return body

    def inverse_dynamics(self, q, v, a):
        data = self.data
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(self.model, data)
        lengths, armature = self.rotors
        return data.qfrc_inverse + lengths.T @ (armature * (lengths @ a))

    def on_motors(self, torques, sheet):
        force = np.zeros(self.model.nv)
        for terms, torque in zip(self.description.drives(), torques, strict=True):
            for name, factor in terms.items():
                joint = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_JOINT, name)
                force[self.model.jnt_dofadr[joint]] += factor * torque
        return force


def fixed_tendons(model):
    """Derivatives of the lengths of fixed tendons by the coordinates; zero for other tendons."""
    lengths = np.zeros((model.ntendon, model.nv))
    for tendon in range(model.ntendon):
        first = model.tendon_adr[tendon]
        for at in range(first, first + model.tendon_num[tendon]):
            if model.wrap_type[at] == mujoco.mjtWrap.mjWRAP_JOINT:
                lengths[tendon, model.jnt_dofadr[model.wrap_objid[at]]] += model.wrap_prm[at]
    return lengths


def taken_armature(model):
    """Armature of tendons and of their actuators, which is zero in the model afterwards."""
    armature = model.tendon_armature.copy()
    model.tendon_armature[:] = 0
    for actuator in np.flatnonzero(model.actuator_trntype == mujoco.mjtTrn.mjTRN_TENDON):
        armature[model.actuator_trnid[actuator, 0]] += model.actuator_gear[actuator, 0] ** 2 * model.actuator_armature[actuator]
        model.actuator_armature[actuator] = 0
    return armature


def followers_of(model):
    """Leader, factor and offset of joints by name, from active equalities of joints and fixed tendons."""
    found = {}
    lengths = fixed_tendons(model)
    for at in range(model.neq):
        row = np.zeros(model.nv)
        own, other, (offset, factor) = model.eq_obj1id[at], model.eq_obj2id[at], model.eq_data[at][:2]
        is_joint = model.eq_type[at] == mujoco.mjtEq.mjEQ_JOINT
        if is_joint:
            row[model.jnt_dofadr[own]] = 1
            if other >= 0:
                row[model.jnt_dofadr[other]] -= factor
        elif model.eq_type[at] == mujoco.mjtEq.mjEQ_TENDON:
            row += lengths[own] - (factor * lengths[other] if other >= 0 else 0)
        moved = np.flatnonzero(row)
        if not model.eq_active0[at] or len(moved) != 2:
            continue
        # row @ (q - q0) = offset. A joint equality names its follower. Of a tendon's joints, one without a
        # leader follows.
        joints = list(model.dof_jntid[moved])
        if joints[0] != own if is_joint else model.joint(joints[0]).name in found:
            joints.reverse()
        weights = row[model.jnt_dofadr[joints]]
        references = model.qpos0[model.jnt_qposadr[joints]]
        ratio = -weights[1] / weights[0]
        follower, leader = (model.joint(joint).name for joint in joints)
        found[follower] = (leader, ratio, offset / weights[0] + references[0] - ratio * references[1])
    return found


def model_of(file):
    """The model of a file, without pictures, and without meshes if some are missing."""
    try:
        return mujoco.MjModel.from_xml_path(str(file))
    except ValueError:
        pass
    spec = mujoco.MjSpec.from_file(str(file))
    for geom in spec.geoms:
        geom.material = ""
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            # Names of shapes may be used elsewhere.
            geom.type, geom.meshname, geom.size, geom.mass = mujoco.mjtGeom.mjGEOM_SPHERE, "", [1e-3, 0, 0], 0
    for part in [*spec.sites, *spec.tendons]:
        part.material = ""
    for part in [*spec.skins, *spec.materials, *spec.textures, *spec.meshes]:
        spec.delete(part)
    return spec.compile()
