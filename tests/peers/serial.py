"""Compares serial models of robots with MuJoCo and Pinocchio.

    python tests/peers/serial.py OVERACT [DESCRIPTION...]

The command OVERACT exports each description as MJCF and URDF. The engines compute the inertia matrix, the torque
of gravity, and centrifugal and Coriolis torques of the files at the states of the report. Their differences from the
whole robot, evaluated by OVERACT, must be the reported errors. Prints a line for each file; the exit code is 1 if
one differs, and 0 with a message without an engine.
"""

import json
import sys
import tempfile
import tomllib
from pathlib import Path

try:
    import mujoco
    import numpy as np
    import pinocchio as pin
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(0)

from compare import evaluate, run

ROBOTS = Path(__file__).resolve().parents[2] / "robots"
DEFAULT = ("ankle", "ankle_offset", "excavator", "humanoid_leg", "palletiser", "tricept")
QUANTITIES = ("inertia_matrix", "gravity", "velocity_torques")
# Largest difference of an error from the reported one, relative to the root mean square of the quantity.
TOLERANCE = 1e-8
INERTIAL = ("xx", "xy", "xz", "yy", "yz", "zz", "mx", "my", "mz", "m", "ia")


def of_robot(overact, toml, folder, states):
    """Inertia matrices, gravity and velocity torques of the whole robot, of inertias alone."""
    sheet = json.loads(run(overact, "inspect", toml, "--json", "--effort", "none"))
    values = tomllib.loads(Path(toml).read_text())["experiment"]["parameters"]
    r = sheet["dof"]

    def file(name, chosen):
        parameters = folder / f"{name}.toml"
        lines = [f"{own} = {chosen(own)!r}" for own in sheet["parameters"]]
        parameters.write_text("[parameters]\n" + "\n".join(lines) + "\n")
        return parameters

    whole = file("inertias", lambda own: float(values.get(own, 0.0)) if own.split("_")[0] in INERTIAL else 0.0)
    nothing = file("nothing", lambda own: 0.0)
    still = [{**state, "twist": [0.0] * r} for state in states]
    mass = np.array(evaluate(overact, toml, "mass_matrix", states, "--parameters", whole)).reshape(-1, r, r)
    bias = lambda at: np.array(evaluate(overact, toml, "bias", at, "--parameters", whole)) - np.array(
        evaluate(overact, toml, "bias", at, "--parameters", nothing)
    )
    gravity = bias(still).reshape(-1, r)
    return mass, gravity, bias(states).reshape(-1, r) - gravity


def of_mujoco(file, coordinates, states):
    model = mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    dofs = [model.jnt_dofadr[model.joint(name).id] for name in coordinates]
    assert model.nv == len(dofs), "joints that follow others are not compared"
    mass, gravity, velocity = [], [], []
    for state in states:
        data.qpos[dofs], data.qvel[dofs] = state["pose"], 0
        mujoco.mj_forward(model, data)
        still = data.qfrc_bias[dofs].copy()
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        data.qvel[dofs] = state["twist"]
        mujoco.mj_forward(model, data)
        mass.append(full[np.ix_(dofs, dofs)])
        gravity.append(still)
        velocity.append(data.qfrc_bias[dofs] - still)
    return np.array(mass), np.array(gravity), np.array(velocity)


def of_pinocchio(file, coordinates, states):
    model = pin.buildModelFromUrdf(str(file))
    data = model.createData()
    at = [model.joints[model.getJointId(name)].idx_v for name in coordinates]
    mass, gravity, velocity = [], [], []
    for state in states:
        q, v = np.zeros(model.nq), np.zeros(model.nv)
        q[at], v[at] = state["pose"], state["twist"]
        own = pin.crba(model, data, q).copy()
        own = np.triu(own) + np.triu(own, 1).T
        still = pin.computeGeneralizedGravity(model, data, q).copy()
        mass.append(own[np.ix_(at, at)])
        gravity.append(still[at])
        velocity.append((pin.nle(model, data, q, v) - still)[at])
    return np.array(mass), np.array(gravity), np.array(velocity)


def errors(robot, serial):
    """Root mean square and largest error of each quantity, relative to its root mean square."""
    scale = np.sqrt(np.diagonal(robot[0], axis1=1, axis2=2).mean(axis=0))
    weights = (np.outer(scale, scale), scale, scale)
    found = []
    for own, other, weight in zip(robot, serial, weights, strict=True):
        norms = lambda x: np.sqrt(((x / weight) ** 2).reshape(len(x), -1).sum(axis=1))
        size = np.sqrt((norms(own) ** 2).mean())
        each = norms(other - own) / size if size > 1e-12 else 0 * norms(own)
        found.append((np.sqrt((each**2).mean()), each.max()))
    return found


def main():
    overact, files = sys.argv[1], sys.argv[2:] or [ROBOTS / f"{name}.toml" for name in DEFAULT]
    is_good = True
    for toml in files:
        for language, engine in (("mjcf", of_mujoco), ("urdf", of_pinocchio)):
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                file, table = folder / f"serial.{language}", folder / "states.csv"
                arguments = ("--serial", language, toml, "-o", file, "--states", table)
                report = json.loads(run(overact, "--json", "export", *arguments))
                numbers = np.loadtxt(table, delimiter=",", skiprows=1, ndmin=2)
                r = len(report["coordinates"])
                states = [{"pose": list(row[:r]), "twist": list(row[r:])} for row in numbers]
                found = errors(of_robot(overact, toml, folder, states), engine(file, report["coordinates"], states))
            worst, texts = 0.0, []
            for quantity, own in zip(QUANTITIES, found, strict=True):
                said = report[quantity]
                if said is None:
                    continue
                worst = max(worst, abs(said["rms"] - own[0]), abs(said["largest"] - own[1]))
                texts.append(f"{quantity} {100 * said['rms']:.2g} % (largest {100 * said['largest']:.2g} %)")
            good = worst < TOLERANCE and len(states) == report["state_count"]
            is_good &= good
            print(f"{Path(toml).stem}.{language}: {len(states)} states, {', '.join(texts)}; differs by {worst:.1e}, {'ok' if good else 'DIFFERENT'}")
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
