"""C = Rust = Python = WebAssembly = interpreter on every robot, as one table (Markdown).

    cargo build -p overact-cli && cargo build -p overact-compiled --example values
    cargo build -p overact-robot --example interpreted_values && cargo xtask page
    python tests/languages/compare.py [ROBOT...] [--languages LANGUAGE...]

Every function that all languages have is evaluated at random states near home, and compared with the compiled Rust:
the largest difference, relative to the largest number of an output. Needs NumPy; the package `overact`, gcc, Node and
the page are left out, with a dash, where they are not there.
"""

import argparse
import ctypes
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROBOTS = ROOT / "robots"
SAMPLES = 20
#: Parameters that are computed from columns or drawn, because each robot has its own.
DRAWN = {"parameters", "base_parameters"}
#: Functions that a compiled `overact::Model` does not offer by these names.
OTHERS = {"closure_error", "acceleration_from_actuators"}
COLUMNS = ["interpreter", "Python", "C", "WebAssembly"]


def target():
    done = subprocess.run(
        ["cargo", "metadata", "--no-deps", "--format-version", "1"], cwd=ROOT, capture_output=True, text=True
    )
    return pathlib.Path(json.loads(done.stdout)["target_directory"])


TARGET = target()
BINARY = TARGET / "debug/overact"


def asked(program, questions):
    """Answers of a program of values; None for a state without a value."""
    done = subprocess.run(program, input="\n".join(questions) + "\n", capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    answers = done.stdout.splitlines()
    assert len(answers) == len(questions), (program, done.stderr)
    return [None if one.startswith("error") else np.array(one.split(), dtype=float) for one in answers]


def question(stem, name, inputs):
    lines = [" ".join(map(repr, map(float, np.ravel(value)))) for value in inputs]
    return "\n".join([f"{stem} {name} {SAMPLES} {len(lines)}", *lines])


class Robot:
    """A robot, its functions and states near home."""

    def __init__(self, stem, compiled):
        self.stem = stem
        inspected = subprocess.run(
            [BINARY, "inspect", ROBOTS / f"{stem}.toml", "--effort", "none", "--json"], capture_output=True, text=True
        )
        self.model = json.loads(inspected.stdout)
        self.functions = {}
        for one in self.model["functions"]:
            name = one["function"]
            if name in OTHERS or name.endswith(("_from_actuators", "_from_joints")) and name != "twist_from_actuators":
                continue
            self.functions[name] = one
        random = np.random.default_rng(5)
        self.random = random
        home = np.array(self.model["home_pose"] or self.model["home_joints"])
        poses = home + random.uniform(-0.02, 0.02, (SAMPLES, len(home)))
        if len(home) > self.model["dof"]:
            poses[:, -4:] /= np.linalg.norm(poses[:, -4:], axis=1, keepdims=True)
        if "blocked_error" in self.functions:
            poses = self.allowed(compiled, poses)
        self.states = {"pose": poses}
        for name, function in (("joints", "joints"), ("actuators", "actuator_positions")):
            if function in self.functions:
                self.states[name] = asked(compiled, [question(stem, function, [poses])])[0]

    def allowed(self, compiled, poses):
        """Closed poses near given ones for a platform with parasitic motion, by Newton steps."""
        for _ in range(5):
            questions = [question(self.stem, one, [poses]) for one in ("blocked_error", "blocked_jacobian")]
            errors, jacobians = (one.reshape((SAMPLES, -1)) for one in asked(compiled, questions))
            for pose, error, jacobian in zip(poses, errors, jacobians):
                step = -np.linalg.pinv(jacobian.reshape((len(error), -1))) @ error
                pose[:3] += step[:3]
                # Left multiplication by half a small rotation vector, which is in the base frame.
                w, v, turn = pose[3], pose[4:].copy(), step[3:] / 2
                pose[3] = w - turn @ v
                pose[4:] = v + w * turn + np.cross(turn, v)
                pose[3:] /= np.linalg.norm(pose[3:])
        left = asked(compiled, [question(self.stem, "blocked_error", [poses])])[0]
        assert np.abs(left).max() < 1e-13, (self.stem, left)
        return poses

    def inputs(self, name):
        """Inputs of a function by name, in order."""
        found = {}
        names = [one["name"] for one in self.functions[name]["inputs"]]
        for one in self.functions[name]["inputs"]:
            known, length = one["name"], int(np.prod(one["shape"]))
            if known == "joints" and "pose" not in names and "joints" not in self.states:
                known = "pose"
            if known not in self.states:
                shape = (length,) if known in DRAWN else (SAMPLES, length)
                low = (0.5, 1.5) if known in DRAWN else (-1.0, 1.0)
                self.states[known] = self.random.uniform(*low, shape)
            found[one["name"]] = np.asarray(self.states[known]).reshape((-1, length))
        return found


def library(robot, folder):
    """C of the robot as a library; None without gcc."""
    if not shutil.which("gcc"):
        return None
    path = ROBOTS / f"{robot.stem}.toml"
    subprocess.run([BINARY, "generate", path, "--effort", "quick", "--lang", "c", "-o", folder], check=True, capture_output=True)
    (source,) = pathlib.Path(folder).glob("*.c")
    shared = pathlib.Path(folder) / "robot.so"
    subprocess.run(["gcc", "-std=c99", "-O0", "-fPIC", "-shared", source, "-o", shared, "-lm"], check=True)
    header = source.with_suffix(".h").read_text()
    return ctypes.CDLL(str(shared)), header, source.stem


def in_c(built, robot, name, inputs, width):
    """Values of a function by its C; None for a state without a value."""
    own, header, stem = built
    found = re.search(rf"\b{stem}_{name}\(([^)]*)\);", header)
    if not found:
        return None
    arguments = [re.search(r"(\w+)\s*(\[[^\]]*\])?$", one.strip()).group(1) for one in found.group(1).split(",")]
    *names, _ = arguments
    if not set(names) <= set(inputs):
        return None
    pointer = ctypes.POINTER(ctypes.c_double)
    output = np.zeros((SAMPLES, width))
    for sample in range(SAMPLES):
        rows = [np.ascontiguousarray(inputs[one][sample % len(inputs[one])]) for one in names]
        given = [row.ctypes.data_as(pointer) for row in rows]
        if getattr(own, f"{stem}_{name}")(*given, output[sample].ctypes.data_as(pointer)) != 0:
            return None
    return output.ravel()


def in_python(robot, names):
    """Values by the package `overact`, function by function; None without it."""
    try:
        import overact
    except ImportError:
        return None
    own = overact.Robot(ROBOTS / f"{robot.stem}.toml")

    def values(name):
        function, known = own.function(name), robot.inputs(name)
        inputs = [known[one][0] if len(known[one]) == 1 else known[one] for one in function.inputs]
        try:
            return np.ravel(function(*inputs))
        except overact.EvaluationError:
            return None

    return [values(name) for name in names]


def compare(stem, compiled, languages):
    """For each language the number of compared values and the largest difference; the number of functions."""
    robot = Robot(stem, compiled)
    names = list(robot.functions)
    questions = [question(stem, name, robot.inputs(name).values()) for name in names]
    wanted = asked(compiled, questions)
    found = {}
    example = TARGET / "debug/examples/interpreted_values"
    if "interpreter" in languages and example.exists():
        found["interpreter"] = asked([example, ROBOTS], questions)
    if "Python" in languages:
        found["Python"] = in_python(robot, names)
    page = TARGET / "page"
    if "WebAssembly" in languages and shutil.which("node") and (page / "overact_bg.wasm").exists():
        found["WebAssembly"] = asked(["node", ROOT / "page/test/values.mjs", page, ROBOTS], questions)
    with tempfile.TemporaryDirectory() as folder:
        if "C" in languages and (built := library(robot, folder)):
            found["C"] = [
                None if value is None else in_c(built, robot, name, robot.inputs(name), len(value) // SAMPLES)
                for name, value in zip(names, wanted)
            ]
    results = {}
    for language, values in found.items():
        if values is None:
            continue
        most, where, functions, count = 0.0, "", 0, 0
        for name, own, other in zip(names, values, wanted):
            if own is None or other is None:
                continue
            size = max(1.0, np.abs(other).max(initial=0.0))
            difference = np.abs(own - other).max(initial=0.0) / size
            functions, count = functions + 1, count + len(other)
            if difference > most:
                most, where = difference, name
        results[language] = most, where, functions, count
    return results, sum(one is not None for one in wanted)


def main():
    compiled = [TARGET / "debug/examples/values"]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*")
    parser.add_argument("--languages", nargs="+", default=COLUMNS, choices=COLUMNS)
    given = parser.parse_args()
    stems = given.robots or sorted(path.stem for path in ROBOTS.glob("*.toml"))
    print(f"| robot | functions | {' | '.join(COLUMNS)} |")
    print(f"|---|---|{'---|' * len(COLUMNS)}", flush=True)
    worst = 0.0
    for stem in stems:
        results, functions = compare(stem, compiled, given.languages)
        cells = []
        for column in COLUMNS:
            if column not in results:
                cells.append("–")
                continue
            most, where, own, _ = results[column]
            worst = max(worst, most)
            left = "" if own == functions else f" ({own} functions)"
            cells.append(f"{most:.0e}{left}")
            if most > 1e-10:
                print(f"{stem}: {column}: {where}: {most:.1e}", file=sys.stderr)
        print(f"| {stem} | {functions} | {' | '.join(cells)} |", flush=True)
    if worst > 1e-9:
        sys.exit(f"the languages differ by {worst:.1e}")


if __name__ == "__main__":
    main()
