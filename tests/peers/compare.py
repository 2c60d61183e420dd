"""Compares imported robots with the engines of their file formats.

    python tests/peers/compare.py OVERACT FILE...

Each file is imported by the command OVERACT. Positions of the bodies' centres, closures and inverse
dynamics of the description are compared with MuJoCo (MJCF) or Pinocchio (URDF) at random states. Constraint
forces of the engines are not compared: unconstrained torques of the tree, projected on the description's
motions, must equal those of the motors. Prints a line for each robot; the exit code is 1 if one differs,
and 0 with a message without an engine.
"""

import json
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


def sample(overact, toml, folder, size, count=5):
    """States of a description with all outputs of overact that the comparison needs."""
    sheet = json.loads(run(overact, "inspect", toml, "--json", "--effort", "none"))
    values = without_dry_friction(toml, folder)
    parameters = folder / "parameters.toml"
    lines = [f"{name} = {values.get(name, 0.0)!r}" for name in sheet["parameters"]]
    parameters.write_text("[parameters]\n" + "\n".join(lines) + "\n")
    r = sheet["dof"]
    random = np.random.default_rng(1)
    home = np.array(sheet["home_pose"])
    states = []
    for _ in range(count):
        pose = home + random.uniform(-size, size, r)
        state = {"pose": pose, "twist": random.uniform(-1, 1, r), "acceleration": random.uniform(-3, 3, r)}
        states.append({key: list(value) for key, value in state.items()})
    has_loops = sheet["joints"] > r
    result = []
    if has_loops:
        joints = evaluate(overact, toml, "joints", states)
        rates = evaluate(overact, toml, "joint_velocities", states)
        accelerations = evaluate(overact, toml, "joint_accelerations", states)
    else:
        for state in states:
            state["joints"] = state["pose"]
        joints, rates, accelerations = ([s[key] for s in states] for key in ("pose", "twist", "acceleration"))
    torques = evaluate(overact, toml, "inverse_dynamics", states, "--parameters", parameters)
    for at, state in enumerate(states):
        units = np.eye(r)
        if has_loops:
            unit = [{"pose": state["pose"], "twist": list(row), "acceleration": [0.0] * r} for row in units]
            motions = np.array(evaluate(overact, toml, "joint_velocities", unit)).T
        else:
            motions = units
        result.append((np.array(joints[at]), np.array(rates[at]), np.array(accelerations[at]), motions, np.array(torques[at])))
    return sheet, values, result


def compare(overact, file, folder):
    toml = folder / "robot.toml"
    run(overact, "import", file, "-o", toml)
    description = Description(toml)
    # Robots with a small workspace are compared nearer to home.
    for size in (0.08, 0.02, 0.005):
        try:
            sheet, values, states = sample(overact, toml, folder, size)
            break
        except RuntimeError as error:
            if "out of reach" not in str(error) or size < 0.01:
                raise
    if Path(file).suffix == ".urdf":
        from pinocchio_engine import Engine
    else:
        from mujoco_engine import Engine
    engine = Engine(file, description, np.array(sheet["home_joints"]))
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
    return sheet, worst_position, worst_torque


def main():
    overact, files = sys.argv[1], sys.argv[2:]
    is_good = True
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            try:
                sheet, position, torque = compare(overact, file, Path(folder))
            except ImportError as error:
                print(f"{file}: skipped, {error}")
                continue
            except RuntimeError as error:
                print(f"{file}: {str(error).splitlines()[0]}")
                is_good = False
                continue
        good = position < TOLERANCE and torque < TOLERANCE
        is_good &= good
        print(f"{file}: {sheet['dof']} coordinates, {sheet['actuators']} motors, centres {position:.1e} m, torques {torque:.1e}, {'ok' if good else 'DIFFERENT'}")
    sys.exit(0 if is_good else 1)


if __name__ == "__main__":
    main()
