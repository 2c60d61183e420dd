"""Torques of an imported platform with parasitic motion, compared with MuJoCo at states that its closures allow."""

import mujoco
import numpy as np

COORDINATES = ("x", "y", "z", "rx", "ry", "rz")


def closures(model, data):
    """Residuals of all connect constraints, their Jacobian and its time derivative."""
    mujoco.mj_forward(model, data)
    gaps, rows, rates = [], [], []
    for at in range(model.neq):
        ends = model.eq_obj1id[at], model.eq_obj2id[at]
        if model.eq_objtype[at] == mujoco.mjtObj.mjOBJ_SITE:
            points = [(model.site_bodyid[site], data.site_xpos[site]) for site in ends]
        else:
            local = model.eq_data[at][:3], model.eq_data[at][3:6]
            points = [(body, data.xpos[body] + data.xmat[body].reshape(3, 3) @ p) for body, p in zip(ends, local)]
        both = [(jacobian(mujoco.mj_jac, model, data, *own)[0], jacobian(mujoco.mj_jacDot, model, data, *own)[0]) for own in points]
        gaps.append(points[0][1] - points[1][1])
        rows.append(both[0][0] - both[1][0])
        rates.append(both[0][1] - both[1][1])
    return np.concatenate(gaps), np.vstack(rows), np.vstack(rates)


def jacobian(function, model, data, body, point):
    """Linear and angular Jacobian of a point, or their derivatives."""
    both = np.zeros((3, model.nv)), np.zeros((3, model.nv))
    function(model, data, *both, point, body)
    return both


def states(file, plate, independent, size, count=5):
    """States of the platform, and the torques with which MuJoCo's tree moves along the closures."""
    model = mujoco.MjModel.from_xml_path(str(file))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    model.dof_frictionloss[:] = 0
    data = mujoco.MjData(model)
    body = model.body(plate).id
    motors = [model.jnt_dofadr[model.actuator_trnid[at][0]] for at in range(model.nu)]
    passive = [dof for dof in range(model.nv) if dof not in motors]
    chosen = [COORDINATES.index(name) for name in independent]
    random = np.random.default_rng(1)
    found = []
    for _ in range(count):
        data.qpos[:], data.qvel[:] = model.qpos0, 0
        step = np.zeros(model.nv)
        step[motors] = random.uniform(-size, size, len(motors))
        for _ in range(30):
            mujoco.mj_integratePos(model, data.qpos, step, 1)
            gap, rows, _ = closures(model, data)
            step[:] = 0
            step[passive] = -np.linalg.lstsq(rows[:, passive], gap, rcond=1e-10)[0]
        _, values, turned = np.linalg.svd(rows)
        free = turned[np.count_nonzero(values > 1e-9 * values[0]) :].T
        twist, acceleration = random.uniform(-1, 1, len(chosen)), random.uniform(-3, 3, len(chosen))
        own = np.vstack(jacobian(mujoco.mj_jac, model, data, body, data.xpos[body]))[chosen]
        data.qvel[:] = free @ np.linalg.solve(own @ free, twist)
        _, rows, rates = closures(model, data)
        own_rates = np.vstack(jacobian(mujoco.mj_jacDot, model, data, body, data.xpos[body]))[chosen]
        bias = np.concatenate([-rates @ data.qvel, acceleration - own_rates @ data.qvel])
        data.qacc[:] = np.linalg.lstsq(np.vstack([rows, own]), bias, rcond=1e-11)[0]
        mujoco.mj_inverse(model, data)
        torques = np.linalg.lstsq(free.T[:, motors], free.T @ data.qfrc_inverse, rcond=None)[0]
        pose = [*data.xpos[body], *data.xquat[body]]
        state = {"pose": pose, "twist": twist, "acceleration": acceleration}
        found.append(({key: [float(v) for v in value] for key, value in state.items()}, torques))
    return found
