"""Random mechanisms in three formats: all imports must give equal torques, which equal MuJoCo's.

    python tests/peers/random_mechanisms.py OVERACT [--trees N] [--closed N] [--seed S] [--keep FOLDER]

Each mechanism is written as MJCF, as URDF (loops as joints of `<gazebo>`) and as SDFormat. The import of the
MJCF is compared with MuJoCo as `compare.py` does, the torques of the other two with those of the first.
Prints failures and a summary; the exit code is 1 after a failure.
"""

import argparse
import json
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from compare import TOLERANCE, compare, run, sample
from description import Description
from mechanisms import FORMATS, closed, tree

try:
    import mujoco_engine  # noqa: F401
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(0)


def torques_of(overact, file, options, folder, size, order):
    """Torques in the order of the motors' names, and home positions of the coordinates."""
    toml = folder / f"{file.suffix[1:]}.toml"
    run(overact, "--json", "import", file, *options, "-o", toml)
    sheet, _, states = sample(overact, toml, folder, size, order)
    motors = Description(toml).actuated()
    by_name = np.argsort(motors)
    homes = dict(zip(sheet["pose"], sheet["home_pose"]))
    return np.array([torques[by_name] for *_, torques in states]), homes


def examine(overact, own, folder):
    """Largest deviations: from MuJoCo, and of each other format."""
    files = {}
    for suffix, write in FORMATS.items():
        files[suffix] = folder / f"m.{suffix}"
        files[suffix].write_text(write(own))
    options = ["--actuated", ",".join(f"j{body}" for body in own.driven)] if own.loops else []
    sheet, position, torque, misfit, size = compare(overact, files["xml"], folder, options, with_size=True)
    if misfit > 1e-9:
        raise RuntimeError(f"a misfit of {misfit:.1e}")
    found = {"MuJoCo": max(position, torque)}
    order = sheet["pose"]
    first, home = torques_of(overact, files["xml"], options, folder, size, order)
    for suffix in ("urdf", "sdf"):
        other, other_home = torques_of(overact, files[suffix], options, folder, size, order)
        if home.keys() != other_home.keys() or any(abs(home[key] - other_home[key]) > 1e-9 for key in home):
            raise RuntimeError(f"{suffix}: other coordinates or another home than in MJCF")
        found[suffix] = np.abs(other - first).max() / np.abs(first).max()
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("overact")
    parser.add_argument("--trees", type=int, default=20)
    parser.add_argument("--closed", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    failures = 0
    for name, make, count in (("trees", tree, given.trees), ("closed", closed, given.closed)):
        worst, bad = {}, 0
        for number in range(count):
            seed = [given.seed, number]
            with tempfile.TemporaryDirectory() as scratch:
                folder = Path(scratch)
                try:
                    found = examine(given.overact, make(np.random.default_rng(seed)), folder)
                    problem = ", ".join(f"{key} {value:.1e}" for key, value in found.items() if not value < TOLERANCE)
                    for key, value in found.items():
                        worst[key] = max(worst.get(key, 0.0), value)
                except (RuntimeError, AssertionError, KeyError, ValueError) as error:
                    problem = said(error)
                if problem:
                    bad += 1
                    print(f"{name} {number}: {problem}", flush=True)
                    if given.keep:
                        shutil.copytree(folder, given.keep / f"{name}_{number}", dirs_exist_ok=True)
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
