"""Compares derivatives of the dynamics of trees with Pinocchio.

    python tests/peers/derivatives.py OVERACT

Robots are trees of `robots/` and `tests/fixtures/`, also branched and coupled ones. References are
`computeRNEADerivatives` and, for the accelerations, its inertia matrix. Prints a line for each robot with the
largest relative differences; the exit code is 1 if one is 1e-9 or larger, and 0 with a message without Pinocchio.
"""

import sys

try:
    import numpy as np
    import pinocchio as pin
    from trees import KEYS, ROBOTS, ROOT, Differences, Tree, evaluate, parameters, report
except ImportError as error:
    print(f"skipped: {error.name} is not installed")
    sys.exit(0)

TOLERANCE = 1e-9
STATES = 20


def inverse(tree, motion):
    """Derivatives of the torques by positions and velocities, and the inertia matrix."""
    whole = pin.computeRNEADerivatives(tree.model, tree.data, *(tree.coupling @ row for row in motion))
    return [tree.coupling.T @ matrix @ tree.coupling for matrix in whole]


def compare(binary, path):
    tree, found = Tree(path), Differences()
    values, _ = parameters(binary, path, tree)
    motions = [tree.motion(np.random.default_rng(seed)) for seed in range(STATES)]
    whole = [pin.rnea(tree.model, tree.data, *(tree.coupling @ row for row in motion)) for motion in motions]
    torques = [tree.coupling.T @ one for one in whole]
    states = [{**dict(zip(KEYS, motion, strict=True)), "parameters": values} for motion in motions]
    forward = [
        {"joints": m[0], "joint_velocities": m[1], "torques": t, "parameters": values}
        for m, t in zip(motions, torques, strict=True)
    ]
    references = [inverse(tree, motion) for motion in motions]
    for index, by in enumerate(("displacement", "twist")):
        results = evaluate(binary, path, f"inverse_dynamics_by_{by}", states)
        for own, reference in zip(results, references, strict=True):
            found.add(f"∂τ by {by}", own, reference[index])
        results = evaluate(binary, path, f"forward_dynamics_by_{by}", forward)
        for own, reference in zip(results, references, strict=True):
            # The acceleration of `motions`: M ∂v̇ = -∂τ.
            found.add(f"∂v̇ by {by}", own, -np.linalg.solve(reference[2], reference[index]))
    return found


def main():
    pin.seed(7)
    differ = False
    for name in ROBOTS:
        differ |= report(name, compare(sys.argv[1], ROOT / f"{name}.toml"), TOLERANCE)
    sys.exit(differ)


if __name__ == "__main__":
    main()
