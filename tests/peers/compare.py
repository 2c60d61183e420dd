"""Compares imported robots with the engines of their file formats.

    python tests/peers/compare.py OVERACT FILE...

Each file is imported by the command OVERACT. Positions of the bodies' centres, closures and inverse
dynamics of the description are compared with MuJoCo (MJCF) or Pinocchio (URDF) at random states. Constraint
forces of the engines are not compared: unconstrained torques of the tree, projected on the description's
motions, must equal those of the motors. Prints a line for each robot; the exit code is 1 if one differs,
and 0 with a message without an engine.
"""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not installed")
    sys.exit(0)

from description import Description

TOLERANCE = 1e-8
# Largest displacements from home, rad and m, and errors after which a smaller one is tried.
SIZES = (0.08, 0.02, 0.005, 0.001)
# Largest displacement of the motors of a platform with parasitic motion, rad or m.
PLATFORM_SIZE = 0.05
# Steps of Newton's method for dependent joints.
CLOSING_STEPS = 6
NEARER = ("out of reach", "singular", "does not allow")


def run(overact, *arguments, text=None):
    done = subprocess.run([overact, *map(str, arguments)], input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return done.stdout


def evaluate(overact, toml, function, states, *more):
    done = run(overact, "evaluate", toml, function, "--states", "-", "--json", *more, text=json.dumps(states))
    return [next(iter(r.values())) for r in json.loads(done)["results"]]


def without_dry_friction(toml, folder):
    """The file's parameters without dry friction, whose sign at a state is a matter of convention."""
    values = tomllib.loads(Path(toml).read_text())["experiment"]["parameters"]
    return {name: (0.0 if name.startswith("fs_") else value) for name, value in values.items()}


def drawn_states(sheet, size, order=None, count=5):
    """Random states up to a displacement from home, drawn for coordinates in the given order of names.

    Dependent joints of the pose stay at home; `closed` corrects them.
    """
    random = np.random.default_rng(1)
    home = np.array(sheet["home_pose"])
    own = [(order or sheet["coordinates"]).index(name) for name in sheet["coordinates"]]
    independent = [sheet["pose"].index(name) for name in sheet["coordinates"]]
    states = []
    for _ in range(count):
        drawn = [random.uniform(-largest, largest, sheet["dof"])[own] for largest in (size, 1, 3)]
        pose = home.copy()
        pose[independent] += drawn[0]
        state = {"pose": pose, "twist": drawn[1], "acceleration": drawn[2]}
        states.append({key: list(value) for key, value in state.items()})
    return states


def closed(overact, toml, sheet, states):
    """States whose dependent joints close the chains, by Newton's method."""
    dependent = [at for at, name in enumerate(sheet["pose"]) if name not in sheet["coordinates"]]
    for _ in range(CLOSING_STEPS if dependent else 0):
        errors = evaluate(overact, toml, "pose_error", states)
        jacobians = evaluate(overact, toml, "pose_error_jacobian", states)
        for state, error, jacobian in zip(states, errors, jacobians):
            columns = np.reshape(jacobian, (len(dependent), len(sheet["pose"])))[:, dependent]
            for at, step in zip(dependent, np.linalg.solve(columns, np.ravel(error))):
                state["pose"][at] -= step
    return states


def inspected(overact, toml, folder):
    """The description's figures, its parameters without dry friction, and a file of those that it needs."""
    sheet = json.loads(run(overact, "inspect", toml, "--json", "--effort", "none"))
    values = without_dry_friction(toml, folder)
    parameters = folder / "parameters.toml"
    lines = [f"{name} = {values.get(name, 0.0)!r}" for name in sheet["parameters"]]
    parameters.write_text("[parameters]\n" + "\n".join(lines) + "\n")
    return sheet, values, parameters


def torques_at(overact, toml, parameters, states, has_loops):
    if not has_loops:
        states = [{**state, "joints": state["pose"]} for state in states]
    return evaluate(overact, toml, "inverse_dynamics", states, "--parameters", parameters)


def sample(overact, toml, figures, size):
    """States of a description with all outputs of overact that the comparison needs."""
    sheet, _, parameters = figures
    r = sheet["dof"]
    states = closed(overact, toml, sheet, drawn_states(sheet, size))
    count = len(states)
    result = []
    has_loops = sheet["joints"] > r
    result = []
    # The torques first: most states out of reach are found by them. Then the motions for unit rates of the
    # coordinates, of all states in one run.
    torques = torques_at(overact, toml, parameters, states, has_loops)
    still = {"acceleration": [0.0] * r}
    units = [{**still, "pose": state["pose"], "twist": list(row)} for state in states for row in np.eye(r)]
    motions = [np.eye(r)] * count
    if has_loops:
        joints = evaluate(overact, toml, "joints", states)
        rates = evaluate(overact, toml, "joint_velocities", states + units)
        motions = [np.array(rates[count + at * r : count + (at + 1) * r]).T for at in range(count)]
        accelerations = evaluate(overact, toml, "joint_accelerations", states)
    else:
        joints, rates, accelerations = ([s[key] for s in states] for key in ("pose", "twist", "acceleration"))
    for at in range(count):
        result.append((np.array(joints[at]), np.array(rates[at]), np.array(accelerations[at]), motions[at], np.array(torques[at])))
    return result


def compare_platform(overact, file, description, toml, folder):
    """Figures of a platform with parasitic motion, and deviations: 0 of positions, and of torques."""
    from parasitic import states

    sheet, _, parameters = inspected(overact, toml, folder)
    plate = re.search(r"^# `([^`]*)` is the platform", Path(toml).read_text(), re.M)[1]
    drawn = states(file, plate, description["platform"]["independent"], PLATFORM_SIZE)
    torques = np.array(evaluate(overact, toml, "inverse_dynamics", [state for state, _ in drawn], "--parameters", parameters))
    expected = np.array([torques for _, torques in drawn])
    return sheet, 0.0, np.abs(torques - expected).max() / np.abs(expected).max()


def compare(overact, file, folder, options=()):
    """Description's figures, largest deviations of positions and torques, and misfit of the import."""
    return compare_with_torques(overact, file, folder, options)[:4]


def compare_with_torques(overact, file, folder, options=()):
    """As `compare`, then the largest displacement from home and the motors' torques in all states."""
    toml = folder / "robot.toml"
    imported = json.loads(run(overact, "--json", "import", file, *options, "-o", toml))
    misfit = sum(max(own["length"], own["angle"]) for own in imported["misfits"])
    description = Description(toml)
    if "platform" in description.toml:
        return (*compare_platform(overact, file, description.toml, toml, folder), misfit, PLATFORM_SIZE, None)
    figures = inspected(overact, toml, folder)
    sheet, values, _ = figures
    # Robots with a small workspace, or a home near a singular pose, are compared nearer to home.
    for size in SIZES:
        try:
            states = sample(overact, toml, figures, size)
            break
        except RuntimeError as error:
            if not any(reason in str(error) for reason in NEARER) or size == SIZES[-1]:
                raise
    home = np.array(sheet["home_joints"])
    if Path(file).suffix == ".urdf":
        from pinocchio_engine import Engine

        engine = Engine(file, description, home)
    else:
        from mujoco_engine import Engine

        engine = Engine(file, description, home, misfit)
    worst_position, worst_torque = 0.0, 0.0
    for q, rates, accelerations, motions, torques in states:
        bodies = description.motion(q, rates, accelerations)
        engine.moved(q, rates, accelerations)
        position, velocity, acceleration = engine.state(bodies)
        worst_position = max(worst_position, engine.centres(position, description, bodies, values))
        free = engine.inverse_dynamics(position, velocity, acceleration)
        reduced = []
        for column in motions.T:
            engine.moved(q, column, 0 * column)
            reduced.append(engine.state(description.motion(q, column, 0 * column))[1])
        driven = engine.on_motors(torques, sheet)
        difference = np.array(reduced) @ (free - driven)
        scale = np.abs(np.array(reduced) @ free).max()
        assert scale > 0, "a robot without torques compares nothing"
        worst_torque = max(worst_torque, np.abs(difference).max() / scale)
    return sheet, worst_position, worst_torque, misfit, size, [torques for *_, torques in states]


def main():
    overact, files = sys.argv[1], sys.argv[2:]
    is_good = True
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            try:
                sheet, position, torque, misfit = compare(overact, file, Path(folder))
            except ImportError as error:
                print(f"{file}: skipped, {error}")
                continue
            except RuntimeError as error:
                print(f"{file}: {str(error).splitlines()[0]}")
                is_good = False
                continue
        # Import changes the mechanism by the misfits that it reports; the engine does not.
        good = max(position, torque) < TOLERANCE + misfit
        is_good &= good
        changed = f", misfit {misfit:.1e}" if misfit else ""
        print(f"{file}: {sheet['dof']} coordinates, {sheet['actuators']} motors, centres {position:.1e} m, torques {torque:.1e}{changed}, {'ok' if good else 'DIFFERENT'}")
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
