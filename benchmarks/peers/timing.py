"""Times of compiled functions, all in one run and on one core.

Every function becomes a program with the same loop in its language. It reads the same states, calls the
function for each, and prints the shortest and the median time of many batches. The programs alternate, so that
other work of the machine affects all of them.
"""

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .ours import BINARY, EFFORT, ROOT
from .states import states

BUILD = ROOT / "target" / "benchmarks"
TEMPLATES = Path(__file__).parent / "templates"
#: Command in front of each timed program, such as `chrt -f 50` on a machine that does other work.
PRIORITY = os.environ.get("PRIORITY", "").split()
#: Number of states in a program, and of timed batches.
STATES, BATCHES = 256, 200


@dataclass(frozen=True)
class Build:
    """Compiler and flags of a peer's C code."""

    title: str
    compiler: str
    flags: tuple[str, ...]

    @property
    def folder(self):
        return "".join(c if c.isalnum() else "_" for c in self.title)


#: Build of the table of tasks.
NATIVE = Build("cc -march=native", os.environ.get("CC", "cc"), ("-O3", "-march=native"))


@dataclass(frozen=True)
class Times:
    """Nanoseconds per call: the shortest and the median batch of a run."""

    shortest: float
    median: float


@dataclass
class Program:
    """An executable that times one function."""

    title: str
    path: Path

    @property
    def command(self):
        return [self.path]

    def run(self, states, core, batches, dump=None):
        command = [*PRIORITY, "taskset", "-c", str(core), *self.command, states, str(batches)]
        done = subprocess.run(
            [*command, *([dump] if dump else [])], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise RuntimeError(f"{self.path}: {done.stderr.strip()}")
        shortest, median = map(float, done.stdout.split())
        return Times(shortest, median)


def write(path, text):
    """Writes a file unless it already contains the text, to avoid recompilation."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def write_states(path, states):
    path.parent.mkdir(parents=True, exist_ok=True)
    np.array([np.concatenate(list(s.values())) for s in states]).tofile(path)


def c_program(title, name, source, inputs, outputs, build=NATIVE):
    """Compiles C code with a function `model(const double **inputs, double *output)` and its loop."""
    folder = BUILD / "c" / build.folder / name
    main = (TEMPLATES / "main.c").read_text()
    lengths = ", ".join(str(length) for _, length in inputs)
    for key, value in {"LENGTHS": lengths, "INPUTS": str(len(inputs)), "OUTPUTS": str(outputs)}.items():
        main = main.replace(f"@{key}@", value)
    write(folder / "main.c", main)
    write(folder / "model.c", source)
    binary = folder / "model"
    sources = [folder / "main.c", folder / "model.c"]
    if not binary.exists() or any(s.stat().st_mtime > binary.stat().st_mtime for s in sources):
        # Two translation units: the loop cannot be merged with the timed function.
        subprocess.run([build.compiler, *build.flags, "-o", binary, *sources, "-lm"], check=True)
    return Program(title, binary)


#: Builds of overact's functions: for any processor with or without run-time vectors, or for this processor.
#
#: Each has the features of the runtime and its own folder.
ANY, ANY_PLAIN, THIS = ("dispatch", "target"), ("std", "target-plain"), ("std", "target-native")


def rust_crate(functions, features):
    """A crate with the modules that hold overact's functions, in cargo's default release profile."""
    folder = BUILD / "ours"
    paths = {function.module: function.path for function in functions}
    for module, path in sorted(paths.items()):
        names = ",".join(sorted({f.rust_name for f in functions if f.module == module}))
        command = [BINARY, "generate", path, "--effort", EFFORT, "--functions", names]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        write(folder / "src" / f"{module}.rs", done.stdout)
    modules = "".join(f"pub mod {module};\n" for module in sorted(paths))
    write(folder / "src" / "lib.rs", (TEMPLATES / "lib.rs").read_text() + modules)
    manifest = (TEMPLATES / "Cargo.toml").read_text()
    write(folder / "Cargo.toml", manifest.replace("@ROOT@", str(ROOT)).replace("@FEATURES@", features))
    return folder


def rust_programs(functions, template="main.rs", dependencies=(), build=ANY):
    """Compiles a program for each of overact's functions."""
    features, name_of_target = build
    folder = rust_crate(functions, features)
    target = folder / name_of_target
    shutil.rmtree(folder / "src" / "bin", ignore_errors=True)
    programs = []
    for function in functions:
        name = f"{function.module}_{function.rust_name}_{template.removesuffix('.rs')}"
        write(folder / "src" / "bin" / f"{name}.rs", rust_main(function, template))
        programs.append(Program("overact", target / "release" / name))
    if dependencies:
        with open(folder / "Cargo.toml", "a") as manifest:
            manifest.writelines(f'[dependencies.{d}]\npath = "{ROOT / p}"\n' for d, p in dependencies)
    environment = {k: v for k, v in os.environ.items() if k not in ("RUSTFLAGS", "CARGO_TARGET_DIR")}
    environment["CARGO_TARGET_DIR"] = str(target)
    if build == THIS:
        environment["RUSTFLAGS"] = "-C target-cpu=native"
    subprocess.run(["cargo", "build", "--quiet", "--release"], cwd=folder, env=environment, check=True)
    return programs


def rust_main(function, template):
    """Program that times one of overact's functions."""
    starts = np.cumsum([0] + [length for _, length in function.inputs])
    spans = [f"values[{a}..{b}].try_into()?" for a, b in zip(starts, starts[1:], strict=False)]
    text = (TEMPLATES / template).read_text()
    call = f"{function.module}::{function.document['robot']}::{function.rust_name}"
    arguments = [f"&s.{i}" for i in range(len(function.inputs))]
    written = "()"
    # The peers also write into the caller's array.
    if function.rust_name.startswith("idm_red"):
        rows, columns = function.shape
        call, written = f"{call}_into", f"[[0.0_f64; {columns}]; {rows}]"
        arguments.append("&mut written")
    for key, value in {
        "MODULE": function.module,
        "TYPES": "".join(f"[f64; {length}]," for _, length in function.inputs),
        "READ": "".join(f"{span}," for span in spans),
        "LENGTHS": ", ".join(str(length) for _, length in function.inputs),
        "TOTAL": str(starts[-1]),
        "CALL": call,
        "ARGUMENTS": ", ".join(arguments),
        "WRITTEN": written,
        "DESCRIPTION": str(function.path),
        "COLUMNS": function.kind.capitalize(),
    }.items():
        text = text.replace(f"@{key}@", value)
    return text


def blocks(function, core=0, rounds=2000):
    """Nanoseconds per sample of overact's function, of its program over blocks, and of the same with rows."""
    (program,) = rust_programs([function], "blocks.rs", [("overact-codegen", "codegen")])
    path = BUILD / "states" / f"{function.robot}_blocks.bin"
    write_states(path, states(function, STATES, seed=2))
    command = ["taskset", "-c", str(core), program.path, path, str(rounds)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [float(word) for word in done.stdout.split()]


def outputs(program, path, core, shape):
    """Output of a compiled program for its states."""
    dump = path.with_suffix(".out")
    program.run(path, core, 1, dump)
    return np.fromfile(dump).reshape(-1, *shape)


def compare(programs, states, core=0, rounds=15, batches=BATCHES, statistic="shortest"):
    """Nanoseconds per call of each program, the programs alternating: smallest of all rounds.

    The statistic of a round is that of `Times`.
    """
    return compare_each([(program, states) for program in programs], core, rounds, batches, statistic)


def compare_each(programs, core, rounds, batches, statistic):
    """The same for pairs of a program and its states."""
    best = [float("inf")] * len(programs)
    for _ in range(rounds):
        for index, (program, states) in enumerate(programs):
            best[index] = min(best[index], getattr(program.run(states, core, batches), statistic))
    return best
