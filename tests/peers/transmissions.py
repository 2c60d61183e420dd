"""Compares transmissions of imported robots with MuJoCo.

    python tests/peers/transmissions.py OVERACT FILE...

MuJoCo's tree is projected on its closures: the null space of the constraint Jacobian gives the velocities of
all joints per velocity of the description's coordinates. At random states, these are compared with overact:

- torque map: the rows of the motors with `inverse_jacobian`, and forces on the coordinates with
  `project_platform`;
- reflected inertia: rotor inertias of the motors with `mass_matrix` of these parameters alone;
- inertia matrix: that of the whole tree with `mass_matrix`, unless rods can spin about their own axes, since
  a description fixes these spins by convention.

Prints a line for each robot; the exit code is 1 if one differs, and 0 with a message without MuJoCo.
"""

import json
import sys
import tempfile
from pathlib import Path

try:
    import mujoco
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(0)

from compare import NEARER, SIZES, evaluate, run, without_dry_friction
from description import Description
from mujoco_engine import Engine

TOLERANCE = 1e-8
STATES = 20
# Smallest singular value of a constraint, relative to the largest.
RANK = 1e-9


def constraints(engine):
    """Jacobian of the closures and of joints that follow others."""
    rows = [engine.closure()[1]]
    address = {engine.model.joint(j).name: engine.model.jnt_dofadr[j] for j in range(engine.model.njnt)}
    for name, (leader, factor, _) in engine.followers.items():
        row = np.zeros((1, engine.model.nv))
        row[0, address[name]], row[0, address[leader]] = 1, -factor
        rows.append(row)
    return np.vstack(rows)


def motions(engine, names):
    """Velocities of all joints per velocity of the coordinates, and the number of other free motions."""
    rows = constraints(engine)
    _, singular, basis = np.linalg.svd(rows)
    rank = int((singular > RANK * singular.max(initial=0.0)).sum())
    null = basis[rank:].T
    dofs = [engine.model.jnt_dofadr[engine.model.joint(name).id] for name in names]
    return null @ np.linalg.lstsq(null[dofs], np.eye(len(dofs)), rcond=1e-9)[0], null.shape[1] - len(dofs)


def relative(own, wanted):
    return np.abs(np.asarray(own) - wanted).max() / np.abs(wanted).max()


def states_within_reach(overact, toml, home, rng):
    for size in SIZES:
        states = [{"pose": list(home + rng.uniform(-size, size, len(home)))} for _ in range(STATES)]
        try:
            return states, evaluate(overact, toml, "joints", states)
        except RuntimeError as error:
            if not any(reason in str(error) for reason in NEARER) or size == SIZES[-1]:
                raise


def compare(overact, file, folder):
    """Largest errors of torque map, reflected inertia and inertia matrix, and the misfit of the import."""
    toml = folder / "robot.toml"
    imported = json.loads(run(overact, "--json", "import", file, "-o", toml))
    misfit = sum(max(own["length"], own["angle"]) for own in imported["misfits"])
    description = Description(toml)
    sheet = json.loads(run(overact, "inspect", toml, "--json", "--effort", "none"))
    engine = Engine(file, description, np.array(sheet["home_joints"]), misfit)
    rng = np.random.default_rng(3)
    n, r = sheet["actuators"], sheet["dof"]
    states, joints = states_within_reach(overact, toml, np.array(sheet["home_pose"]), rng)
    values = without_dry_friction(toml, folder)

    def matrices(name, chosen):
        """Inertia matrices of some parameters."""
        parameters = folder / f"{name}.toml"
        lines = [f"{own} = {chosen.get(own, 0.0)!r}" for own in sheet["parameters"]]
        parameters.write_text("[parameters]\n" + "\n".join(lines) + "\n")
        found = evaluate(overact, toml, "mass_matrix", states, "--parameters", parameters)
        return np.array(found).reshape(len(states), r, r)

    rotors = {name: rng.uniform(0.5, 2.0) for name in sheet["parameters"] if name.startswith("ia_")}
    reflected, whole = matrices("rotors", rotors), matrices("all", values)
    jacobians = np.array(evaluate(overact, toml, "inverse_jacobian", states)).reshape(len(states), n, r)
    torques = rng.uniform(-10, 10, (len(states), n))
    with_torques = [{**state, "torques": list(own)} for state, own in zip(states, torques, strict=True)]
    projected = evaluate(overact, toml, "project_platform", with_torques)
    # Coordinates are the joints of the skeleton and of branches, which have no end.
    free = {leg for leg in description.legs if "end" not in description.toml["leg"][leg]}
    names = [name for (leg, _), name in zip(description.joints(), description.names(), strict=True) if leg in free]
    address = {engine.model.joint(j).name: engine.model.jnt_dofadr[j] for j in range(engine.model.njnt)}
    of_joint = {}
    for (leg, joint), name in zip(description.joints(), description.names(), strict=True):
        own = f"ia_{joint}" + ("" if len(description.legs) == 1 else f"_{leg}")
        of_joint[name] = rotors.get(own, 0.0)
    motors = [of_joint[name] for name in description.actuated()]
    motors += [rotors.get(f"ia_{name}", 0.0) for name in description.toml.get("motor", {})]
    worst = np.zeros(3)
    for at, q in enumerate(joints):
        still = 0 * np.array(q)
        bodies = description.motion(q, still, still)
        engine.moved(np.array(q), still, still)
        engine.data.qpos[:], engine.data.qvel[:] = engine.state(bodies)[0], 0
        mujoco.mj_forward(engine.model, engine.data)
        moved, spins = motions(engine, names)
        drives = np.array([sum(f * moved[address[name]] for name, f in terms.items()) for terms in description.drives()])
        worst[0] = max(worst[0], relative(jacobians[at], drives), relative(projected[at], drives.T @ torques[at]))
        if rotors:
            worst[1] = max(worst[1], relative(reflected[at], drives.T @ np.diag(motors) @ drives))
        if spins:
            worst[2] = np.nan
            continue
        tree = np.zeros((engine.model.nv, engine.model.nv))
        mujoco.mj_fullM(engine.model, engine.data, tree)
        lengths, armature = engine.rotors
        tree += lengths.T @ (armature[:, None] * lengths)
        worst[2] = max(worst[2], relative(whole[at], moved.T @ tree @ moved))
    return sheet, worst, misfit


def main():
    overact, files = sys.argv[1], sys.argv[2:]
    is_good = True
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            try:
                sheet, worst, misfit = compare(overact, file, Path(folder))
            except RuntimeError as error:
                print(f"{file}: {str(error).splitlines()[0]}")
                is_good = False
                continue
        good = np.nanmax(worst) < TOLERANCE + misfit
        is_good &= good
        changed = f", misfit {misfit:.1e}" if misfit else ""
        named = zip(("torque map", "reflected inertia", "inertia matrix"), worst, strict=True)
        figures = ", ".join(f"{name} {'not compared' if np.isnan(own) else f'{own:.1e}'}" for name, own in named)
        print(f"{Path(file).stem}: {sheet['dof']} coordinates, {sheet['actuators']} motors, {figures}{changed}, {'ok' if good else 'DIFFERENT'}")
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
