"""Which part of a residual of the dVRK MTM depends on the motion of one joint (docs/measured.md).

pip install numpy scipy
overact identify mtm.toml --data one_results.csv --cross-validate two_results.csv --json > result.json
overact identify mtm.toml --data one_results.csv --parameters names.toml
python residual_over_motion.py OVERACT mtm.toml result.json names.toml one_results.csv two_results.csv 6

mtm.toml is robots/dvrk_mtm.toml with `filter_torques` in the place of `filter_equations`. Polynomials in position,
velocity or acceleration of each joint are fitted to the residual of the first run; printed is the part of the square
of that of the second run, in percent, that they explain.
"""

import io
import json
import re
import subprocess
import sys
import tempfile

import numpy as np
import scipy.signal

N = 7
RATE = 200.0
COUNTED = 2000
CABLE = [0.0004877, -0.0037149, 0.0067497, 0.008519, -0.0201475, -0.025265, 0.048095, 0.00255]


def filtered(signal):
    sections = scipy.signal.butter(6, 5.65 / (RATE / 2), output="sos")
    return scipy.signal.sosfiltfilt(sections, signal, axis=0)


def parameters(result, names, path):
    """The base parameters as standard ones; regrouped ones are zero."""
    estimates = json.load(open(result))["estimates"]
    base = next(one for one in estimates if one["stage"] == "base" and one["estimator"] == "least-squares")
    values = {one["name"].removesuffix("R"): one["value"] for one in base["parameters"]}
    with open(path, "w") as file:
        for line in open(names):
            name = re.match(r"(\w+) = ", line)
            file.write(f"{name[1]} = {values.get(name[1], 0.0)!r}\n" if name else line)


def residual(overact, robot, values, log):
    """Filtered positions, velocities, accelerations and torques, and the residual of the model."""
    columns = np.loadtxt(log, delimiter=",")
    q, v, torques = columns[:, :N], columns[:, N : 2 * N], columns[:, 2 * N :].copy()
    cable = np.polyval(CABLE, 0.6697 * q[:, 1] - 0.6697 * q[:, 2] + q[:, 3])
    torques[:, 1:4] -= np.outer(cable, [0.6697, -0.6697, 1.0])
    a = np.zeros_like(v)
    a[2:-2] = (v[:-4] - 8 * v[1:-3] + 8 * v[3:-1] - v[4:]) * RATE / 12
    q, v, a, torques = (filtered(one)[200:-200] for one in (q, v, a, torques))
    names = [f"{one}[{i}]" for one in ("joints", "joint_velocities", "joint_accelerations") for i in range(N)]
    with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
        np.savetxt(file.name, np.hstack([q, v, a]), delimiter=",", header=",".join(names), comments="", fmt="%.17g")
        asked = [overact, "evaluate", robot, "inverse_dynamics", "--states", file.name, "--parameters", values]
        told = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    model = np.loadtxt(io.StringIO(told), delimiter=",", skiprows=1)[:, -N:]
    return (q, v, a), torques, torques - model


def explained(learnt, told, degree):
    (x, y), (u, w) = learnt, told
    scale = np.abs(x).max()
    fit = np.polynomial.chebyshev.chebfit(x / scale, y, degree)
    rest = w - np.polynomial.chebyshev.chebval(u / scale, fit)
    return 100 * (1 - (rest @ rest) / (w @ w))


def main():
    overact, robot, result, names, training, test, joint = sys.argv[1:]
    line = int(joint) - 1
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as values:
        parameters(result, names, values.name)
        motion, _, learnt = residual(overact, robot, values.name, training)
        other, torques, told = residual(overact, robot, values.name, test)
    norms = [np.linalg.norm(one[:COUNTED], axis=0) for one in (told, torques)]
    print("errors of the test run, %:", np.round(100 * norms[0] / norms[1], 1))
    for what, kept in (("the first samples", slice(COUNTED)), ("all", slice(None))):
        for degree in (3, 6, 10):
            for name, own, also in zip("qva", motion, other):
                parts = [
                    explained((own[:, i], learnt[:, line]), (also[kept, i], told[kept, line]), degree)
                    for i in range(N)
                ]
                print(f"{what}, degree {degree}, {name}:", np.round(parts, 1))


main()
