"""Compares frames, centre of mass and energies of trees with Pinocchio.

    python tests/peers/frames.py OVERACT

Robots are trees of `robots/` and `tests/fixtures/`, also branched and coupled ones, each with frames on its last
body and on one in the middle. References are `frameForwardKinematics`, `getFrameJacobian`, `getFrameVelocity`,
`getFrameClassicalAcceleration` without joint accelerations, `jacobianCenterOfMass`, `computeKineticEnergy` and
`computePotentialEnergy`. Prints a line for each robot with the largest relative differences; the exit code is 1 if
one is 1e-9 or larger, and 0 with a message without Pinocchio.
"""

import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import pinocchio as pin
    from trees import KEYS, ROBOTS, ROOT, Differences, Tree, evaluate, parameters, report
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(0)

TOLERANCE = 1e-9
STATES = 20
#: Origins (m) and rotations rx, ry, rz (rad) of the frames.
PLACES = [([0.1, 0.05, 0.2], [0.3, -0.4, 0.5]), ([-0.02, 0.3, 0.1], [-1.0, 0.2, 2.0])]
AXES = pin.LOCAL_WORLD_ALIGNED


def placement(at, angles):
    """A frame from its origin and its rotation Rz(rz) Ry(ry) Rx(rx)."""
    return pin.SE3(pin.rpy.rpyToMatrix(*angles), np.array(at))


def with_frames(path, tree, folder):
    """The description with frames, and Pinocchio's frames by name."""
    bodies = list(tree.bodies)
    text, frames = path.read_text(), {}
    for number, (body, (at, angles)) in enumerate(zip((bodies[-1], bodies[len(bodies) // 2]), PLACES, strict=True)):
        text += f'\n[frame.place{number}]\nbody = "{body}"\nat = {at}\nrotation = {angles}\n'
        joint, own = tree.bodies[body]
        frame = pin.Frame(f"place{number}", joint, 0, own * placement(at, angles), pin.FrameType.OP_FRAME)
        frames[frame.name] = tree.model.addFrame(frame)
    tree.data = tree.model.createData()
    file = folder / path.name
    file.write_text(text)
    return file, frames


def compare_frame(binary, path, tree, name, frame, motions, found):
    rng = np.random.default_rng(1)
    wrenches = rng.uniform(-10.0, 10.0, (STATES, 6))
    moving = [dict(zip(KEYS, motion[:2], strict=False)) for motion in motions]
    still = [{"joints": motion[0]} for motion in motions]
    loaded = [{**state, "wrench": wrench} for state, wrench in zip(still, wrenches, strict=True)]
    inputs = {"pose": still, "jacobian": still, "velocity": moving, "acceleration_bias": moving, "torques": loaded}
    own = {kind: evaluate(binary, path, f"{name}_{kind}", states) for kind, states in inputs.items()}
    for number, motion in enumerate(motions):
        q, v = tree.coupling @ motion[0], tree.coupling @ motion[1]
        pin.forwardKinematics(tree.model, tree.data, q, v, np.zeros(tree.model.nv))
        pin.computeJointJacobians(tree.model, tree.data, q)
        pin.updateFramePlacements(tree.model, tree.data)
        x, y, z, w = pin.Quaternion(tree.data.oMf[frame].rotation).coeffs()
        quaternion = np.array([w, x, y, z])
        # Both signs are the same orientation.
        quaternion *= np.sign(quaternion @ own["pose"][number][3:])
        jacobian = pin.getFrameJacobian(tree.model, tree.data, frame, AXES) @ tree.coupling
        found.add("pose", own["pose"][number], [*tree.data.oMf[frame].translation, *quaternion])
        found.add("Jacobian", own["jacobian"][number], jacobian)
        found.add("velocity", own["velocity"][number], pin.getFrameVelocity(tree.model, tree.data, frame, AXES).vector)
        bias = pin.getFrameClassicalAcceleration(tree.model, tree.data, frame, AXES).vector
        found.add("J̇ v", own["acceleration_bias"][number], bias)
        found.add("torques", own["torques"][number], -jacobian.T @ wrenches[number])


def compare_masses(binary, path, tree, motions, found):
    """Centre of mass and energies.

    Parameters that the torques do not contain are missing in overact and count as zero. Their mass and moment of mass
    are subtracted from Pinocchio's.
    """
    values, names = parameters(binary, path, tree)
    missing = {name: value for name, value in tree.values.items() if name not in names}
    still = [{"joints": motion[0], "parameters": values} for motion in motions]
    moving = [{**state, "joint_velocities": motion[1]} for state, motion in zip(still, motions, strict=True)]
    own = {
        name: evaluate(binary, path, name, states)
        for name, states in {
            "total_mass": still,
            "centre_of_mass": still,
            "centre_of_mass_jacobian": still,
            "kinetic_energy": moving,
            "potential_energy": still,
        }.items()
    }
    for number, motion in enumerate(motions):
        q, v = tree.coupling @ motion[0], tree.coupling @ motion[1]
        # The call also sets the mass.
        jacobian = pin.jacobianCenterOfMass(tree.model, tree.data, q) * tree.data.mass[0]
        mass = tree.data.mass[0] - sum(missing.get(f"m_{body}", 0.0) for body in tree.bodies)
        moment, missing_moment = tree.data.mass[0] * tree.data.com[0], np.zeros(3)
        pin.computeJointJacobians(tree.model, tree.data, q)
        for body, (joint, frame) in tree.bodies.items():
            first = np.array([missing.get(f"m{axis}_{body}", 0.0) for axis in "xyz"])
            at = tree.data.oMi[joint] * frame
            arm = at.rotation @ first
            missing_moment += missing.get(f"m_{body}", 0.0) * at.translation + arm
            # A body without mass has a still origin.
            jacobian += pin.skew(arm) @ pin.getJointJacobian(tree.model, tree.data, joint, AXES)[3:]
        found.add("mass", own["total_mass"][number], mass)
        found.add("centre of mass", own["centre_of_mass"][number], (moment - missing_moment) / mass)
        found.add("its Jacobian", own["centre_of_mass_jacobian"][number], jacobian @ tree.coupling / mass)
        found.add("kinetic energy", own["kinetic_energy"][number], pin.computeKineticEnergy(tree.model, tree.data, q, v))
        potential = pin.computePotentialEnergy(tree.model, tree.data, q) + tree.model.gravity.linear @ missing_moment
        found.add("potential energy", own["potential_energy"][number], potential)


def compare(binary, path):
    tree, found = Tree(path), Differences()
    motions = [tree.motion(np.random.default_rng(seed)) for seed in range(STATES)]
    with tempfile.TemporaryDirectory() as folder:
        file, frames = with_frames(path, tree, Path(folder))
        for name, frame in frames.items():
            compare_frame(binary, file, tree, name, frame, motions, found)
        compare_masses(binary, file, tree, motions, found)
    return found


def main():
    pin.seed(7)
    differ = False
    for name in ROBOTS:
        differ |= report(name, compare(sys.argv[1], ROOT / f"{name}.toml"), TOLERANCE)
    sys.exit(differ)


if __name__ == "__main__":
    main()
