"""Times the DualV's regressor over many samples through Python, in the rows layout and with `out=`.

`python benchmark.py [SAMPLES]`, with a release build of the package installed. The evaluator itself is the
example `rows`, which prints the nanoseconds of a sample: `cargo build --release --example rows`, then
`OVERACT_ROWS=target/release/examples/rows python benchmark.py`.
"""

import os
import pathlib
import subprocess
import sys
import time

import numpy as np

import overact

ROBOT = pathlib.Path(__file__).resolve().parents[1] / "robots" / "dualv.toml"
ROUNDS = 7


def seconds(work):
    """Shortest time of several rounds; longer ones were disturbed."""
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        work()
        times.append(time.perf_counter() - begin)
    return min(times)


def main(samples):
    robot = overact.Robot(ROBOT)
    random = np.random.default_rng(1)
    poses = random.uniform(-0.05, 0.05, (samples, 3))
    twists, accelerations = random.normal(size=(2, samples, 3))
    out = np.zeros((samples, 3, 64))
    idm = robot.idm_red_platform
    own = seconds(lambda: idm(poses, twists, accelerations, out=out)) / samples * 1e9
    print(f"Python, out=: {own:.1f} ns a sample ({samples} samples)")
    fresh = seconds(lambda: idm(poses, twists, accelerations)) / samples * 1e9
    print(f"Python, new array: {fresh:.1f} ns a sample")
    one = poses[0].copy(), twists[0].copy(), accelerations[0].copy()
    place = np.empty((3, 64))
    single = seconds(lambda: [idm(*one, out=place) for _ in range(10_000)]) / 10_000 * 1e6
    print(f"Python, one sample a call: {single:.2f} µs")
    if program := os.environ.get("OVERACT_ROWS"):
        subprocess.run([program, str(ROBOT), str(samples)], check=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
