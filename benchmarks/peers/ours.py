"""overact's side: output of its command line, and its own results."""

import json
import os
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from .count import Count

ROOT = Path(__file__).resolve().parents[2]

#: Command line: that of this repository, or another build.
BINARY = os.environ.get("OVERACT", ROOT / "target" / "release" / "overact")

#: Effort of the search for fewer operations.
EFFORT = os.environ.get("EFFORT", "thorough")

#: Folders of descriptions: the library, and robots for tests.
FOLDERS = [ROOT / "robots", ROOT / "tests" / "fixtures"]


def description(robot):
    """Description of a robot."""
    return next(folder / f"{robot}.toml" for folder in FOLDERS if (folder / f"{robot}.toml").exists())


def overact(*arguments, stdin=None):
    """JSON document of a command of the release build."""
    done = subprocess.run(
        [BINARY, *map(str, arguments), "--json"], input=stdin, capture_output=True, text=True
    )
    if done.returncode:
        raise RuntimeError(f"overact {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


@dataclass
class Function:
    """One of overact's functions: inputs in the order of its arguments, the columns' names, its cost."""

    robot: str
    name: str
    source: str
    kind: str
    inputs: list
    shape: list
    columns: list
    count: Count
    document: dict

    @property
    def path(self):
        return description(self.robot)

    @property
    def module(self):
        """Name of the module of its description."""
        return self.robot

    @property
    def rust_name(self):
        base = "_base" if self.kind == "base" else ""
        # A robot without a platform has only one source.
        source = "_from_joints" if self.inputs[0][0] == "pose" and self.source == "joints" else ""
        return f"idm_red_platform{base}{source}"

    def evaluate(self, states):
        """Rows x columns per state, by the evaluation backend."""
        text = json.dumps([{name: list(v) for name, v in state.items()} for state in states])
        found = overact(
            "evaluate", self.path, self.name, "--from", self.source, "--columns", self.kind, "--states", "-",
            stdin=text,
        )  # fmt: skip
        return np.array([result[self.name] for result in found["results"]]).reshape(len(states), *self.shape)


@cache
def inspect(robot):
    """Output of `inspect` for a robot, cached because its functions take minutes to derive."""
    path, kept = description(robot), ROOT / "target" / "benchmarks" / "inspected" / f"{robot}.json"
    made_of = [str(Path(BINARY).stat().st_mtime_ns), EFFORT, path.read_text()]
    if kept.exists():
        stored = json.loads(kept.read_text())
        if stored["made of"] == made_of:
            return stored["document"]
    document = overact("inspect", path, "--effort", EFFORT)
    kept.parent.mkdir(parents=True, exist_ok=True)
    kept.write_text(json.dumps({"made of": made_of, "document": document}))
    return document


def function(work):
    """Function of a task."""
    document = inspect(work.robot)
    for entry in document["functions"]:
        key = (entry["name"], entry["columns"], entry["from"])
        if key != ("idm_red_platform", work.columns, work.source):
            continue
        shape = entry["outputs"][0]["shape"]
        if work.columns == "base":
            columns = [p["regrouping"][0]["parameter"] for p in document["base_parameters"]]
        else:
            columns = [p for p in document["parameters"] if not p.endswith("_payload")]
        if len(columns) != shape[1]:
            raise RuntimeError(f"{work.title}: {len(columns)} names for {shape[1]} columns")
        return Function(
            robot=work.robot,
            name=entry["name"],
            source=work.source,
            kind=work.columns,
            inputs=[(i["name"], i["shape"][0]) for i in entry["inputs"]],
            shape=shape,
            columns=columns,
            count=Count.from_json(entry),
            document=document,
        )
    raise RuntimeError(f"{work.title}: overact has no such function")
