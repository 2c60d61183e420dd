"""Throughput of an identification: filters, regressor, decimation, R factor, in NumPy and SciPy as in overact.

Both get the same log of the DualV: poses and torques at 5 kHz. Positions pass a zero-phase Butterworth
low-pass filter; velocities and accelerations are central differences. The base columns and the projected
torques are computed at every sample and decimated in parallel by a zero-phase Chebyshev low-pass filter. The
equations of each row become an R factor. NumPy's regressor is CasADi's best model after `cse`, with one NumPy
operation for all samples of a block at a time. SciPy's filters are cascades of second-order sections like
overact's.
"""

import os
import subprocess
import time

import casadi
import numpy as np
from scipy import signal

from . import ours, report
from .casadi_peer import Casadi
from .description import load
from .robot import columns
from .search import best
from .timing import BUILD
from .works import Work

STAGES = ["filters", "regressor", "decimation", "factor"]
#: Hz, order, Hz, factor: settings of the DualV's description.
FREQUENCY, ORDER, CUTOFF, DECIMATION = 5000.0, 4, 100.0, 50
RIPPLE, DECIMATION_ORDER = 0.05, 8
SAMPLES = 50_000
#: Samples per block of NumPy's regressor: the fastest power of two.
BLOCK = 2048
#: Largest difference of RᵀR, relative to the norms of the columns.
AGREEMENT = 1e-9

BINARY = {casadi.OP_ADD: "+", casadi.OP_SUB: "-", casadi.OP_MUL: "*", casadi.OP_DIV: "/"}
UNARY = {
    casadi.OP_NEG: "-{0}",
    casadi.OP_SQ: "{0} * {0}",
    casadi.OP_TWICE: "{0} + {0}",
    casadi.OP_INV: "1.0 / {0}",
    casadi.OP_SQRT: "sqrt({0})",
    casadi.OP_SIN: "sin({0})",
    casadi.OP_COS: "cos({0})",
    casadi.OP_SIGN: "sign({0})",
}


def vectorised(function):
    """A CasADi function as a NumPy function: a list of input arrays, and an array for each output."""
    lines = ["def regressor(inputs, output):"]
    for k in range(function.n_instructions()):
        kind = function.instruction_id(k)
        to, of = function.instruction_output(k), function.instruction_input(k)
        if kind == casadi.OP_INPUT:
            lines.append(f"    w{to[0]} = inputs[{of[0]}][{of[1]}]")
        elif kind == casadi.OP_OUTPUT:
            lines.append(f"    output[{to[1]}] = w{of[0]}")
        elif kind == casadi.OP_CONST:
            lines.append(f"    w{to[0]} = {function.instruction_constant(k)!r}")
        elif kind in BINARY:
            lines.append(f"    w{to[0]} = w{of[0]} {BINARY[kind]} w{of[1]}")
        else:
            lines.append(f"    w{to[0]} = {UNARY[kind].format(f'w{of[0]}')}")
    scope = {"sin": np.sin, "cos": np.cos, "sqrt": np.sqrt, "sign": np.sign}
    exec("\n".join(lines), scope)
    return scope["regressor"]


class Pipeline:
    """NumPy's and SciPy's side."""

    def __init__(self, function, log):
        self.robot = load(function.path)
        self.home = np.array(function.document["home_joints"])
        self.pose, self.torques = log[:, :3].T.copy(), log[:, 3:].T.copy()
        # The offset column of an actuated joint is its row of the inverse Jacobian.
        offsets = [f"off_1_{leg.name}" for leg in self.robot.legs]
        self.names = list(function.columns)
        everything = self.names + [name for name in offsets if name not in self.names]
        self.offsets = [everything.index(name) for name in offsets]
        algebra = Casadi()
        form = best(self.robot, function.inputs, everything)[0]
        derived = columns(self.robot, algebra, function.inputs, everything, form)
        self.function = algebra.function("regressor", function.inputs, derived, cse=True)
        self.regressor = vectorised(self.function)
        self.width, self.inputs = len(everything), [name for name, _ in function.inputs]
        self.rows = function.shape[0]

    def filtered(self):
        sections = signal.butter(ORDER, CUTOFF, fs=FREQUENCY, output="sos")
        pose = signal.sosfiltfilt(sections, self.pose, padlen=3 * ORDER)
        twist = np.gradient(pose, axis=1) * FREQUENCY
        return pose, twist, np.gradient(twist, axis=1) * FREQUENCY

    def joints(self, pose):
        """Joints of legs with two links in a plane, by the law of cosines."""
        x, y, phi = pose
        c, s = np.cos(phi), np.sin(phi)
        found = []
        for leg, home in zip(self.robot.legs, self.home.reshape(-1, 3), strict=True):
            first, second, third = leg.joints
            u, v = leg.end_at[0], leg.end_at[1]
            dx = x + c * u - s * v - first.d * np.cos(first.gamma)
            dy = y + s * u + c * v - first.d * np.sin(first.gamma)
            cosine = (dx * dx + dy * dy - second.d**2 - third.d**2) / (2.0 * second.d * third.d)
            sine = np.sign(home[1]) * np.sqrt(1.0 - cosine * cosine)
            q2 = np.arctan2(sine, cosine)
            q1 = np.arctan2(dy, dx) - np.arctan2(third.d * sine, second.d + third.d * cosine)
            turn = np.arctan2(leg.end_rotation[1, 0], leg.end_rotation[0, 0])
            found += [q1, q2, phi + turn - q1 - q2]
        return found

    def lines(self, pose, twist, acceleration):
        """Rows x (columns + 1) x samples, Y last."""
        samples, count = pose.shape[1], len(self.names)
        found = np.empty((self.rows, count + 1, samples))
        for start in range(0, samples, BLOCK):
            part = slice(start, min(start + BLOCK, samples))
            given = {"pose": pose[:, part], "twist": twist[:, part], "acceleration": acceleration[:, part]}
            given["joints"] = self.joints(given["pose"])
            output = [None] * (self.rows * self.width)
            self.regressor([given[name] for name in self.inputs], output)
            for row in range(self.rows):
                own = output[row * self.width : (row + 1) * self.width]
                for column in range(count):
                    found[row, column, part] = own[column]
                found[row, count, part] = sum(
                    own[k] * torque[part] for k, torque in zip(self.offsets, self.torques, strict=True)
                )
        return found

    def decimated(self, lines):
        sections = signal.cheby1(DECIMATION_ORDER, RIPPLE, 0.8 / DECIMATION, output="sos")
        smooth = signal.sosfiltfilt(sections, lines, axis=-1, padlen=3 * DECIMATION_ORDER)
        return smooth[:, :, (lines.shape[2] - 1) % DECIMATION :: DECIMATION]

    def run(self):
        """Processor nanoseconds per sample in each stage and in total, and the R factors."""
        times = [time.process_time()]
        motion = self.filtered()
        times.append(time.process_time())
        lines = self.lines(*motion)
        times.append(time.process_time())
        kept = self.decimated(lines)
        times.append(time.process_time())
        factors = [np.linalg.qr(line.T, mode="r") for line in kept]
        times.append(time.process_time())
        per_sample = np.diff(times) * 1e9 / self.pose.shape[1]
        return [*per_sample, per_sample.sum()], factors


def log(function):
    """A smooth motion with a little noise, and torques."""
    rng = np.random.default_rng(3)
    t = np.arange(SAMPLES) / FREQUENCY
    home = np.array(function.document["home_pose"])
    waves = lambda size: sum(  # noqa: E731
        size / (k + 1) * np.sin(2.0 * np.pi * f * t + rng.uniform(0.0, 6.0))
        for k, f in enumerate(rng.uniform(0.5, 4.0, 4))
    )
    pose = [home[i] + waves(size) for i, size in enumerate([0.03, 0.03, 0.15])]
    torques = [waves(2.0) for _ in range(4)]
    values = np.array(pose + torques).T
    return values + rng.normal(scale=1e-6, size=values.shape)


def own(function, path, core, result):
    """overact's processor nanoseconds per sample, and its R factors."""
    settings = [FREQUENCY, ORDER, CUTOFF, DECIMATION, *function.columns]
    command = ["taskset", "-c", str(core), ours.ROOT / "target/release/overact-throughput", function.path, path]
    command += [",".join(map(str, settings)), "3", result]
    environment = os.environ | {"RAYON_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    width = len(function.columns) + 1
    return float(done.stdout), np.fromfile(result).reshape(-1, width, width)


def check(found, expected):
    """Checks that the R factors are equal up to the signs of their rows."""
    for mine, other in zip(found, expected, strict=True):
        norms = np.linalg.norm(other, axis=0)
        norms[norms == 0.0] = 1.0
        error = np.abs(mine.T @ mine - other.T @ other) / np.outer(norms, norms)
        if not error.max() < AGREEMENT:
            raise RuntimeError(f"R factors differ by {error.max():.1e}")


def measure(core, peers, rounds=7):
    """Shortest times of overact and of the peers' stages, run alternately."""
    function = ours.function(Work("DualV, base columns", "dualv", "base"))
    values = log(function)
    path = BUILD / "states" / "identification.bin"
    path.parent.mkdir(parents=True, exist_ok=True)
    values.tofile(path)
    os.sched_setaffinity(0, {core})
    pipelines = [peer(function, values) for peer in peers]
    mine, theirs = [], [[] for _ in pipelines]
    for _ in range(rounds):
        total, expected = own(function, path, core, BUILD / "states" / "identification.out")
        mine.append(total)
        for pipeline, measured in zip(pipelines, theirs, strict=True):
            times, factors = pipeline.run()
            measured.append(times)
            check(factors, expected)
    return min(mine), [np.min(measured, axis=0) for measured in theirs]


def table(mine, theirs):
    """Table of the peers' stages and all totals; overact's stages alternate block by block."""
    rows = []
    for number, stage in enumerate(STAGES):
        rows.append([stage, "", *(f"{times[number]:.0f}" for times in theirs), ""])
    totals = [times[-1] for times in theirs]
    rows.append(["all", f"**{mine:.0f}**", *(f"{total:.0f}" for total in totals), f"{mine / min(totals):.2f}"])
    head = ["ns per sample", "overact", "NumPy and SciPy", "NumPy with C code, group by group", "ratio to the faster"]
    return report.table(head, rows)
