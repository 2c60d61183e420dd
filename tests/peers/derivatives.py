"""Compares derivatives of inverse dynamics of serial robots with Pinocchio's `computeRNEADerivatives`.

    python tests/peers/derivatives.py OVERACT

Robots are those of `robots/` without loops whose bodies have all inertial parameters. Pinocchio's models are
built from the modified Denavit-Hartenberg frames of the descriptions, with random consistent bodies and
without friction. Prints a line for each robot; the exit code is 1 if one differs, and 0 with a message
without Pinocchio.
"""

import json
import subprocess
import sys
from pathlib import Path

try:
    import numpy as np
    import pinocchio as pin
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(0)

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks"))
from peers.description import INERTIA, load  # noqa: E402

TOLERANCE = 1e-9
ROBOTS = ["rx90", "tx40", "stanford", "kuka_lwr", "dvrk_mtm"]
STATES = 20


def turn(axis, angle):
    return pin.SE3(pin.AngleAxis(angle, np.array(axis)).toRotationMatrix(), np.zeros(3))


def shift(vector):
    return pin.SE3(np.eye(3), np.array(vector))


def model_of(robot, rng):
    """A chain of modified Denavit-Hartenberg frames, and the standard parameters of its bodies."""
    (leg,) = robot.legs
    model, parents, values = pin.Model(), [], {}
    model.gravity.linear = robot.gravity
    for joint in leg.joints:
        (motion,) = [e for e in (joint.theta, joint.r) if e.terms]
        if list(motion.terms.items()) != [(joint.name, 1.0)] or not set(INERTIA) <= set(joint.parameters):
            return None
        placement = turn([0.0, 0.0, 1.0], joint.gamma) * shift([0.0, 0.0, joint.b])
        placement = placement * turn([1.0, 0.0, 0.0], joint.alpha) * shift([joint.d, 0.0, 0.0])
        placement = placement * turn([0.0, 0.0, 1.0], joint.theta.constant)
        placement = placement * shift([0.0, 0.0, joint.r.constant])
        kind = pin.JointModelRZ() if joint.kind == "revolute" else pin.JointModelPZ()
        parent = 0 if joint.antecedent is None else parents[joint.antecedent]
        parents.append(model.addJoint(parent, kind, placement, joint.name))
        inertia = pin.Inertia.Random()
        model.appendBodyToJoint(parents[-1], inertia, pin.SE3.Identity())
        mass, first = inertia.mass, inertia.mass * inertia.lever
        tensor = inertia.inertia + mass * (inertia.lever @ inertia.lever * np.eye(3) - np.outer(inertia.lever, inertia.lever))
        own = {"m": mass, "mx": first[0], "my": first[1], "mz": first[2]}
        own |= {a + b: tensor["xyz".index(a), "xyz".index(b)] for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")}
        values |= {f"{symbol}_{joint.name}": value for symbol, value in own.items()}
    return model, values


def overact(binary, *arguments, text=None):
    done = subprocess.run([binary, *map(str, arguments), "--json"], input=text, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout)


def compare(binary, name, rng):
    """Largest difference relative to the largest entry, or `None` if Pinocchio has no such model."""
    path = ROOT / "robots" / f"{name}.toml"
    found = model_of(load(path), rng)
    if found is None:
        return None
    model, values = found
    names = overact(binary, "inspect", path, "--effort", "none")["parameters"]
    parameters = [values.get(name, 0.0) for name in names]
    motions = [rng.uniform(-1.5, 1.5, (3, model.nv)) for _ in range(STATES)]
    keys = ("joints", "joint_velocities", "joint_accelerations")
    states = [{**{k: list(v) for k, v in zip(keys, m, strict=True)}, "parameters": parameters} for m in motions]
    data, worst = model.createData(), 0.0
    for function, index in (("inverse_dynamics_by_displacement", 0), ("inverse_dynamics_by_twist", 1)):
        results = overact(binary, "evaluate", path, function, "--states", "-", text=json.dumps(states))["results"]
        for result, motion in zip(results, motions, strict=True):
            wanted = pin.computeRNEADerivatives(model, data, *motion)[index]
            own = np.array(result[function]).reshape(model.nv, model.nv)
            worst = max(worst, np.abs(own - wanted).max() / np.abs(wanted).max())
    return worst


def main():
    rng = np.random.default_rng(7)
    pin.seed(7)
    differ = False
    for name in ROBOTS:
        worst = compare(sys.argv[1], name, rng)
        if worst is None:
            print(f"{name}: skipped, not a chain of bodies with all parameters")
            continue
        print(f"{name}: {worst:.1e}")
        differ |= not worst < TOLERANCE
    sys.exit(differ)


if __name__ == "__main__":
    main()
