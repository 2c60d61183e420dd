"""Random mechanisms in three formats: all imports must give equal torques, which equal MuJoCo's.

    python tests/peers/random_mechanisms.py OVERACT [--trees N] [--closed N] [--seed S] [--keep FOLDER] [--jobs N]

Each mechanism is written as MJCF, as URDF (loops as joints of `<gazebo>`) and as SDFormat. The import of the
MJCF is compared with MuJoCo as `compare.py` does, the torques of the other two with those of the first.
Prints failures and a summary; the exit code is 1 after a failure.
"""

import argparse
import concurrent.futures
import json
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from compare import TOLERANCE, compare_with_torques, drawn_states, inspected, run, torques_at
from description import Description
from mechanisms import FORMATS, closed, tree

try:
    import mujoco_engine  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(0)


def sorted_torques(toml, torques):
    """Torques of all states in the order of the motors' names."""
    return np.array(torques)[:, np.argsort(Description(toml).actuated())]


def examine(overact, own, folder):
    """Largest deviations: from MuJoCo, and of each other format."""
    files = {}
    for suffix, write in FORMATS.items():
        files[suffix] = folder / f"m.{suffix}"
        files[suffix].write_text(write(own))
    options = ["--actuated", ",".join(f"j{body}" for body in own.driven)] if own.loops else []
    sheet, position, torque, misfit, size, torques = compare_with_torques(overact, files["xml"], folder, options)
    if misfit > 1e-9:
        raise RuntimeError(f"a misfit of {misfit:.1e}")
    found = {"MuJoCo": max(position, torque)}
    first, order = sorted_torques(folder / "robot.toml", torques), sheet["pose"]
    home = dict(zip(order, sheet["home_pose"]))
    for suffix in ("urdf", "sdf"):
        toml = folder / f"{suffix}.toml"
        run(overact, "import", files[suffix], *options, "-o", toml)
        other, _, parameters = inspected(overact, toml, folder)
        other_home = dict(zip(other["pose"], other["home_pose"]))
        if home.keys() != other_home.keys() or any(abs(home[key] - other_home[key]) > 1e-9 for key in home):
            raise RuntimeError(f"{suffix}: other coordinates or another home than in MJCF")
        states = drawn_states(other, size, order)
        torques = torques_at(overact, toml, parameters, states, bool(own.loops))
        found[suffix] = np.abs(sorted_torques(toml, torques) - first).max() / np.abs(first).max()
    return found


def trial(overact, make, seed, keep):
    """Deviations of one mechanism, and the problem with it if there is one."""
    found = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        try:
            found = examine(overact, make(np.random.default_rng(seed)), folder)
            problem = ", ".join(f"{key} {value:.1e}" for key, value in found.items() if not value < TOLERANCE)
        except (RuntimeError, AssertionError, KeyError, ValueError) as error:
            problem = said(error)
        if problem and keep:
            shutil.copytree(folder, keep / f"{make.__name__}_{seed[1]}", dirs_exist_ok=True)
    return found, problem


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("overact")
    parser.add_argument("--trees", type=int, default=20)
    parser.add_argument("--closed", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    failures = 0
    for name, make, count in (("trees", tree, given.trees), ("closed", closed, given.closed)):
        worst, bad = {}, 0
        with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
            arguments = ([given.overact] * count, [make] * count, [[given.seed, at] for at in range(count)], [given.keep] * count)
            for number, (found, problem) in enumerate(pool.map(trial, *arguments)):
                for key, value in found.items():
                    worst[key] = max(worst.get(key, 0.0), value)
                if problem:
                    bad += 1
                    print(f"{name} {number}: {problem}", flush=True)
        largest = ", ".join(f"{key} {value:.1e}" for key, value in worst.items())
        print(f"{count} {name} of seed {given.seed}: {bad} failures; largest relative deviation of torques: {largest}", flush=True)
        failures += bad
    sys.exit(1 if failures else 0)


def said(error):
    """First message of an error, which may be a JSON document."""
    text = str(error)
    try:
        return json.loads(text.splitlines()[-1])["errors"][0]["message"]
    except (ValueError, KeyError, IndexError):
        return f"{type(error).__name__} {text.splitlines()[0] if text else ''}"


if __name__ == "__main__":
    main()
