"""Damaged files through every command that reads them, and through Python: nothing may panic, hang, or touch a file that
it does not own.

    python3 benchmarks/mutations [--count N] [--seed S] [--only COMMAND] [--compile N] [--write]

Needs Python 3.11 or newer and a build of this repository: `OVERACT` names its program, else target/debug/overact.
Modules that are generated all the same are compiled, `--compile` of them at most, in Rust where `OVERACT_RLIB` names
`liboveract-….rlib` in the `deps` of a build, in C where there is a `cc`. `OVERACT_PYTHON` is a Python that has the
package `overact`; every fifth description and log goes through it, too.
`--only generate` gives all files to that command, to compile a sample of what it writes. `--write` writes
docs/mutations.md.
"""

import argparse
import collections
import os
import pathlib
import random
import shutil
import tempfile

import tasks
import wholes
from faults import LONGEST, MEMORY, Run, compiles, compiles_as_c

DOCUMENT = wholes.ROOT / "docs" / "mutations.md"
OVERACT = pathlib.Path(os.environ.get("OVERACT", wholes.ROOT / "target" / "debug" / "overact")).resolve()
PYTHON, RLIB = os.environ.get("OVERACT_PYTHON"), os.environ.get("OVERACT_RLIB")
# Robots whose logs and factors are also damaged.
LOGGED = ["five_bar", "two_motor_axis"]
# Kinds of damaged files, with their percentage.
KINDS = {"description": 48, "log": 14, "stored log": 6, "states": 8, "parameters": 8, "factors": 6, "model": 10}
EVERY = 5


class Trial:
    """Damaged files of one seed, and the results."""

    def __init__(self, given: argparse.Namespace, folder: pathlib.Path):
        self.given, self.folder = given, folder
        self.draw = random.Random(given.seed)
        self.robots = {stem: wholes.robot(OVERACT, stem, folder, self.draw) for stem in wholes.ROBOTS}
        for stem in LOGGED:
            wholes.with_factors(OVERACT, self.robots[stem], folder)
        self.models = [wholes.foreign(OVERACT, name, folder) for name in wholes.FOREIGN]
        self.stored = [wholes.stored(name) for name in wholes.STORED]
        self.damaged, self.codes, self.compiled = collections.Counter(), collections.Counter(), collections.Counter()
        self.faults: list[str] = []
        self.longest = (0.0, "")

    def case(self) -> tuple[str, tasks.Case]:
        """The next damaged file and the command for it."""
        draw, only = self.draw, self.given.only
        kind = "description" if only else draw.choices(list(KINDS), list(KINDS.values()))[0]
        robot, logged = self.robots[draw.choice(wholes.ROBOTS)], self.robots[draw.choice(LOGGED)]
        match kind:
            case "description":
                return kind, tasks.description(robot, draw, only)
            case "log":
                return kind, tasks.log(logged, draw)
            case "stored log":
                return kind, tasks.log(draw.choice(self.stored), draw)
            case "states":
                return kind, tasks.states(robot, draw)
            case "parameters":
                return kind, tasks.parameters(robot, draw)
            case "factors":
                return kind, tasks.factors(logged, draw)
            case _:
                return kind, tasks.model(draw.choice(self.models), draw)

    def step(self, number: int) -> None:
        kind, case = self.case()
        self.damaged[kind] += 1
        programs = [[OVERACT, *words] for words in case.tasks]
        if PYTHON and case.python is not None and number % EVERY == 0:
            programs.append([PYTHON, "-c", tasks.PYTHON, *case.python])
        for words in programs:
            run = Run(words, case.files, self.folder)
            name = "python" if words[0] == PYTHON else words[1]
            self.codes[name, run.code] += 1
            self.longest = max(self.longest, (run.took, name))
            self.tell(number, run, [*run.faults(), *self.followed(name, run)])
            run.clear()

    def followed(self, name: str, run: Run) -> list[str]:
        """Problems when a result is used."""
        if run.code != 0:
            return []
        if name == "import":
            (self.folder / "imported.toml").write_bytes(run.kept)
            checked = Run([OVERACT, "check", "imported.toml"], {}, self.folder)
            run.complaint += checked.complaint
            return ["an imported description does not pass its check"] if checked.code != 0 else []
        if name != "generate" or sum(self.compiled.values()) >= self.given.compile:
            return []
        language = "C" if "c" in run.words else "Rust"
        if language == "Rust" and not RLIB or language == "C" and not shutil.which("cc"):
            return []
        self.compiled[language] += 1
        complaint = compiles(run.kept, RLIB, self.folder) if language == "Rust" else compiles_as_c(self.folder / "c")
        run.complaint += complaint
        return ["a generated module does not compile"] if complaint else []

    def tell(self, number: int, run: Run, faults: list[str]) -> None:
        """Reports faults and saves the files."""
        if not faults:
            return
        self.faults += faults
        at = pathlib.Path(tempfile.gettempdir()) / f"mutation_{self.given.seed}_{number}"
        shutil.copytree(self.folder, at, dirs_exist_ok=True)
        for name, content in run.files.items():
            (at / name).write_bytes(content)
        words = [word if "\n" not in str(word) else "…" for word in run.words[1:]]
        print(f"{number}: {' '.join(map(str, words))}: {', '.join(faults)}, kept in {at}\n{run.complaint[-800:]}", flush=True)

    def summary(self) -> str:
        files = ", ".join(f"{count} of {kind}" for kind, count in self.damaged.most_common())
        compiled = " and ".join(f"{count} in {language}" for language, count in self.compiled.most_common())
        faults = ", ".join(f"{what} ({count})" for what, count in collections.Counter(self.faults).most_common())
        return (
            f"{self.damaged.total()} damaged files of seed {self.given.seed} ({files}) in {self.codes.total()} runs; generated modules "
            f"that were compiled: {compiled or 'none'}; the longest run took {self.longest[0]:.1f} s of processor time (`{self.longest[1]}`). Faults: {faults or 'none'}."
        )

    def table(self) -> str:
        lines = ["| command | runs | as if nothing were wrong | refused |", "|---|---:|---:|---:|"]
        for name in sorted({name for name, _ in self.codes}):
            total = sum(count for (one, _), count in self.codes.items() if one == name)
            lines.append(f"| `{name}` | {total} | {self.codes[name, 0]} | {total - self.codes[name, 0]} |")
        return "\n".join(lines)


def document(trial: Trial) -> str:
    return f"""# Damaged files

Written by `python3 benchmarks/mutations --write`: descriptions, logs, states, parameters, factor files and models of other programs with one to four faults each (lines, characters and bytes that are lost, doubled, moved or replaced, numbers that are none or of another size), beside files that are right and belong to them, through the commands that read them and, every fifth description and log, through Python in a process of its own. A fault is a panic, a signal, a run of more than {LONGEST} s of processor time or {MEMORY >> 30} GB, an input that is written to, an output that is touched by a run that fails or left empty by one that does not, a file that is left behind, an error without its code, a document that is none, an imported description that does not pass its check, and a generated module that does not compile.

{trial.summary()}

{trial.table()}
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", metavar="COMMAND")
    parser.add_argument("--compile", type=int, default=50, metavar="N")
    parser.add_argument("--write", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        trial = Trial(given, pathlib.Path(scratch))
        for number in range(given.count):
            trial.step(number)
    print(f"{trial.table()}\n\n{trial.summary()}")
    if given.write:
        DOCUMENT.write_text(document(trial))
    raise SystemExit(1 if trial.faults else 0)


if __name__ == "__main__":
    main()
