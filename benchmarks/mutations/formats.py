"""Damaged robot files of each format through `overact import`, and each imported description through `check`.

    python3 benchmarks/mutations/formats.py [--count N] [--seed S] [--format xml,urdf,sdf,par,toml] [--files FOLDER]
        [--jobs N]

Needs Python 3.11 or newer and a build of this repository: `OVERACT` names its program, else target/debug/overact.
The damaged files are those of interchange/tests/models and robots, and of the folder `--files`. Descriptions go
through `check` alone. A run may take 10 s of processor time and 1.5 GB; faults are those of `faults.py`, and imports
whose description does not pass its check. Prints a line per format; the exit code is 1 after a fault.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import shutil
import tempfile

import faults
import wholes
from damage import damaged

faults.LONGEST, faults.MEMORY = 10, 3 << 29
OVERACT = pathlib.Path(os.environ.get("OVERACT", wholes.ROOT / "target" / "debug" / "overact")).resolve()
OPTIONS = {"arm.par": wholes.FOREIGN["arm.par"]}


def originals(suffix: str, folder: pathlib.Path | None) -> list[pathlib.Path]:
    """Files of a format to damage."""
    if suffix == "toml":
        return [wholes.ROOT / "robots" / f"{stem}.toml" for stem in wholes.ROBOTS]
    found = sorted(wholes.MODELS.glob(f"*.{suffix}"))
    return found + (sorted(folder.rglob(f"*.{suffix}")) if folder else [])


def trial(suffix: str, number: int, seed: int, files: list[pathlib.Path]) -> tuple[int, float, list[str], str]:
    """Exit code, processor time, faults and where the files are kept, for one damaged file."""
    draw = random.Random(f"{suffix} {seed} {number}")
    file = draw.choice(files)
    content = damaged(file.read_bytes(), draw)
    name = f"model.{suffix}"
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        words = ["check", name] if suffix == "toml" else ["import", name, *OPTIONS.get(file.name, []), "-o", "kept.toml"]
        run = faults.Run([OVERACT, *words], {name: content}, folder)
        found = run.faults()
        if suffix != "toml" and run.code == 0:
            imported = run.kept
            run.clear()
            checked = faults.Run([OVERACT, "check", "imported.toml"], {"imported.toml": imported}, folder)
            found += checked.faults()
            if checked.code != 0:
                found.append("an imported description does not pass its check")
                run.complaint += checked.complaint
        kept = ""
        if found:
            kept = pathlib.Path(tempfile.gettempdir()) / f"format_{suffix}_{seed}_{number}"
            shutil.copytree(folder, kept, dirs_exist_ok=True)
            (kept / name).write_bytes(content)
            (kept / "complaint").write_text(run.complaint[-2000:])
        return run.code, run.took, found, str(kept)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--format", default="xml,urdf,sdf,par,toml")
    parser.add_argument("--files", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=1)
    given = parser.parse_args()
    is_bad = False
    for suffix in given.format.split(","):
        files = originals(suffix, given.files)
        codes, all_faults, longest = collections.Counter(), collections.Counter(), 0.0
        with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
            for code, took, found, kept in pool.map(trial, *zip(*((suffix, at, given.seed, files) for at in range(given.count))), chunksize=8):
                codes[code] += 1
                all_faults.update(found)
                longest = max(longest, took)
                if found:
                    print(f"{kept}: {', '.join(found)}", flush=True)
        is_bad |= bool(all_faults)
        faults_of = ", ".join(f"{what} ({count})" for what, count in all_faults.most_common()) or "none"
        print(f"{suffix}: {given.count} damaged copies of {len(files)} files, seed {given.seed}: {codes[0]} accepted, {given.count - codes[0]} rejected; longest run {longest:.1f} s; faults: {faults_of}", flush=True)
    raise SystemExit(1 if is_bad else 0)


if __name__ == "__main__":
    main()
