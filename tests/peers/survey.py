"""Imports many files and prints a table: result of import and `check`, and agreement with an engine.

    python tests/peers/survey.py OVERACT [--root FOLDER] FILE[,OPTION...]...

Options of `overact import` follow the name of a file, separated by commas, such as `arm.urdf,--fix-base`.
Names are written relative to the folder. Files that are rejected have their first message. The comparison is
that of `compare.py`; .par files and SDFormat have no engine.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from compare import compare

LONGEST = 600


def first_error(text):
    """First error with its location, and its help."""
    message = re.search(r"^error(?:\[(\w+)\])?: (.*)$", text, re.M)
    place = re.search(r"^\s*-->\s*(\S+?:\d+)", text, re.M)
    where = f"line {place[1].rpartition(':')[2]}: " if place else ""
    return f"{where}{message[2]}" if message else text.strip().splitlines()[-1]


def row(overact, name, file, options):
    """Cells of a file's row."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        toml = folder / "robot.toml"
        words = [overact, "import", file, *options, "-o", toml]
        done = subprocess.run(words, capture_output=True, text=True, timeout=LONGEST, check=False)
        if done.returncode:
            return [name, f"{first_error(done.stderr)}", "", "", ""]
        checked = subprocess.run([overact, "check", toml], capture_output=True, text=True, timeout=LONGEST, check=False)
        passes = "passes" if checked.returncode == 0 else first_error(checked.stderr)
        size = found(overact, toml)
        if file.suffix not in (".xml", ".urdf"):
            return [name, "imported", passes, size, "no engine"]
        try:
            _, position, torque, misfit = compare(overact, file, folder, options)
        except (RuntimeError, AssertionError, ValueError, KeyError, AttributeError, IndexError, np.linalg.LinAlgError) as error:
            said = str(error).splitlines()
            return [name, "imported", passes, size, f"not compared: {type(error).__name__} {said[0] if said else ''}"]
        changed = f", misfit {misfit:.1e}" if misfit else ""
        return [name, "imported", passes, size, f"{max(position, torque):.1e}{changed}"]


def found(overact, toml):
    """Numbers of coordinates, motors and joints."""
    done = subprocess.run([overact, "inspect", toml, "--json", "--effort", "none"], capture_output=True, text=True, check=False)
    if done.returncode:
        return ""
    sheet = json.loads(done.stdout)
    return f"{sheet['joints']}, {sheet['dof']}, {sheet['actuators']}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("overact")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--root", type=Path, default=Path())
    given = parser.parse_args()
    print("| file | import | `check` | joints, coordinates, motors | largest difference |\n|---|---|---|---|---|", flush=True)
    for text in given.files:
        name, *options = text.split(",")
        shown = f"`{name}`" + "".join(f" `{option}`" for option in options)
        try:
            cells = row(given.overact, shown, given.root / name, [o.replace("+", ",") for o in options])
        except subprocess.TimeoutExpired:
            cells = [shown, f"no result after {LONGEST} s", "", "", ""]
        print("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
