"""Times of compiled derivatives and Jacobians of frames: overact's Rust and C compared with CasADi's C code.

All programs call their function for the same random states and take turns on one core. CasADi's code is that of
its form with the fewest operations. It is compiled by GCC and Clang with `-march=native`, with and without
`-ffast-math`; the fastest of the four counts. So is overact's C code, with `-fno-finite-math-only` in addition to
`-ffast-math`, since its checks of the inputs need infinities and NaN. overact's Rust has `target-cpu=native`.
"""

import hashlib
import json
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import casadi
import numpy as np

from . import casadi_peer, controller, ours, report, timing
from .count import Count
from .table import DERIVING, FAST, NATIVE

#: Builds of overact's C code.
OWN = [*NATIVE, *[replace(build, flags=(*build.flags, "-fno-finite-math-only")) for build in FAST]]
OWN = [replace(build, title=f"{build.title}, own") for build in OWN]
#: Number of states, and of passes through them in a round; the median pass of a round counts.
STATES, PASSES = 1000, 31


@dataclass
class Cell:
    """A function of both tools, CasADi's form, and the times of all programs."""

    title: str
    function: ours.Function
    count: Count
    form: str
    #: CasADi's function, and the function that draws a number of states with a seed.
    peer: object
    sample: object
    times: dict | None = None

    @property
    def ratio(self):
        return self.function.count.operations / self.count.operations if self.count.operations else 1.0

    def check(self, samples):
        """Compares CasADi's function with the evaluation of overact."""
        given = self.sample(samples, 1)
        values = np.array([self.peer(*state.values()).full() for state in given])
        controller.check(self.title, values, self.function.evaluate(given))

    def line(self):
        """Operations, and times if they are measured."""
        found = [self.title, report.operations(self.function.count), report.operations(self.count), f"{self.ratio:.2f}"]
        if self.times:
            rust, own, peer = (self.times[kind] for kind in ("Rust", "C", "CasADi"))
            found += [f"{t[0]:.0f}" for t in (rust, own, peer)] + [f"{t[0] / peer[0]:.2f}" for t in (rust, own)]
            found += [own[1].removesuffix(", own"), peer[1]]
        return [*found, self.form]


def is_selected(robot, only):
    """Whether a robot's name contains one of the texts, which commas separate."""
    return not only or any(one in robot for one in only.split(","))


def kept(function, made_of, make):
    """CasADi's best form, cached until the description or the deriving modules change."""
    modules = [*DERIVING, "controller", "derivatives", "frames"]
    sources = [(Path(__file__).parent / f"{module}.py").read_bytes() for module in modules]
    key = hashlib.sha256(b"\0".join([made_of.encode(), function.path.read_bytes(), *sources])).hexdigest()
    path = timing.BUILD / "derived" / f"{function.module}_{function.rust_name}_form.json"
    if path.exists():
        stored = json.loads(path.read_text())
        if stored["key"] == key:
            return stored["form"], Count(**stored["count"]), casadi.Function.deserialize(stored["function"])
    _, _, form, counted, peer = make()
    stored = {"key": key, "form": form, "count": vars(counted), "function": peer.serialize()}
    timing.write(path, json.dumps(stored))
    return form, counted, peer


def own_code(function):
    """overact's C code with the signature of the timing loop."""
    with tempfile.TemporaryDirectory() as folder:
        command = [ours.BINARY, "generate", function.path, "--lang", "c", "--functions", function.rust_name]
        subprocess.run([*command, "--effort", ours.EFFORT, "-o", folder], capture_output=True, check=True)
        (header,), (source,) = (list(Path(folder).glob(f"*.{kind}")) for kind in "hc")
        text = source.read_text().replace(f'#include "{header.name}"', header.read_text())
    arguments = "".join(f"inputs[{i}], " for i in range(len(function.inputs)))
    call = f"{header.stem}_{function.rust_name}({arguments}output);"
    return f"{text}\nvoid model(const double **inputs, double *output) {{\n    {call}\n}}\n"


def time(cell, rust, core, rounds):
    """Times all programs of a cell alternately, after checking that their results agree at all states."""
    function = cell.function
    name = f"{function.module}_{function.rust_name}"
    path = timing.BUILD / "states" / f"{name}.bin"
    timing.write_states(path, cell.sample(STATES, 2))
    programs = [("Rust", "", rust)]
    for kind, code, builds in (
        ("C", own_code(function), OWN),
        ("CasADi", casadi_peer.c_code(cell.peer), [*NATIVE, *FAST]),
    ):
        for build in builds:
            size = int(np.prod(function.shape))
            program = timing.c_program(kind, f"{name}_{kind}", code, function.inputs, size, build)
            programs.append((kind, build.title, program))
    expected = timing.outputs(rust, path, core, function.shape)
    for kind, build, program in programs[1:]:
        found = timing.outputs(program, path, core, function.shape)
        controller.check(f"{cell.title}, {kind}, {build}", found, expected)
    own = [program for *_, program in programs]
    times = timing.compare(own, path, core, rounds, PASSES, "median")
    cell.times = {}
    for (kind, build, _), one in zip(programs, times, strict=True):
        cell.times[kind] = min(cell.times.get(kind, (one, build)), (one, build))


def table(cells, timed, core, rounds):
    """The cells and the geometric means of their ratios as Markdown."""
    if timed:
        functions = [cell.function for cell in cells]
        for cell, rust in zip(cells, timing.rust_programs(functions, build=timing.THIS), strict=True):
            time(cell, rust, core, rounds)
    header = ["function", "overact", "CasADi, cse", "ratio"]
    means = ["geometric mean", "", "", mean([cell.ratio for cell in cells])]
    if timed:
        header += ["Rust, ns", "C, ns", "CasADi, ns", "ratio, Rust", "ratio, C", "compiler, C", "CasADi"]
        ratios = [[cell.times[kind][0] / cell.times["CasADi"][0] for cell in cells] for kind in ("Rust", "C")]
        means += ["", "", "", *map(mean, ratios), "", ""]
    return report.table([*header, "CasADi's form"], [*[cell.line() for cell in cells], [*means, ""]])


def mean(ratios):
    """Geometric mean of ratios, as text."""
    return f"{np.exp(np.mean(np.log(ratios))):.2f}"
