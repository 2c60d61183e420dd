"""`overact identify` on whole logs of the DualV: processor time, bytes read, memory; reading compared with
polars.

The logs are the description's own experiment, four runs of 50000 samples, and one of ten minutes. The latter
repeats the first run with continuous time. Everything runs with one thread.
"""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

from . import ours, report
from .timing import BUILD

RUNS = {"--data": ["unloaded_1", "unloaded_2"], "--payload-data": ["loaded_1", "loaded_2"]}
#: Number of repetitions of the first run: ten minutes.
REPEATED = 60
#: Hz.
FREQUENCY = 5000
ENVIRONMENT = os.environ | {"RAYON_NUM_THREADS": "1", "POLARS_MAX_THREADS": "1"}

POLARS = """
import sys, time, polars
start = time.process_time()
polars.read_csv(sys.argv[1])
print(time.process_time() - start)
"""


def logs(folder):
    """Writes the logs: the four runs, and the long one."""
    folder.mkdir(parents=True, exist_ok=True)
    runs = {option: [folder / f"{name}.csv" for name in names] for option, names in RUNS.items()}
    long = folder / "long.csv"
    if not long.exists():
        command = [ours.BINARY, "simulate", ours.description("dualv"), "-o", f"{folder}/"]
        subprocess.run(command, check=True, capture_output=True)
        header, *lines = runs["--data"][0].read_text().splitlines()
        rows = [line.split(",", 1)[1] for line in lines]
        partial = long.with_suffix(".partial")
        with open(partial, "w") as output:
            output.write(header + "\n")
            for first in range(0, REPEATED * len(rows), len(rows)):
                output.writelines(f"{(first + k) / FREQUENCY:.4f},{row}\n" for k, row in enumerate(rows))
        partial.rename(long)
    return runs, long


def without_instruments(folder):
    """The description without an estimate by instrumental variables, which needs a second motion."""
    text = ours.description("dualv").read_text()
    path = folder / "dualv.toml"
    path.write_text(text.replace("[identification]\n", '[identification]\ninstruments = "none"\n', 1))
    return path


def measured(command):
    """Processor seconds, bytes read, and peak memory (MB) of a program, which must succeed."""
    process = subprocess.Popen(
        list(map(str, command)), env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    memory = 0
    # The system's final figures include the parent process, and a terminated program has no memory
    # information.
    while not os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT | os.WNOHANG):
        status = Path(f"/proc/{process.pid}/status").read_text()
        memory = max([memory, *map(int, re.findall(r"VmHWM:\s*(\d+)", status))])
        time.sleep(0.02)
    message = process.stderr.read()
    counts = Path(f"/proc/{process.pid}/io").read_text().split()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(message.decode().strip())
    read = int(counts[counts.index("rchar:") + 1])
    return usage.ru_utime + usage.ru_stime, read, memory / 1024


def identified(description, runs, rounds):
    """Cells of the table: nanoseconds per sample, bytes read relative to the logs, MB."""
    files = [path for paths in runs.values() for path in paths]
    samples = sum(sum(1 for _ in open(path, "rb")) - 1 for path in files)
    bytes_ = sum(path.stat().st_size for path in files)
    command = [ours.BINARY, "identify", description, "-q"]
    for option, paths in runs.items():
        command += [option, *paths]
    all_ = [measured(command) for _ in range(rounds)]
    seconds, read, memory = min(all_)
    return f"{seconds * 1e9 / samples:.0f}", f"{read / bytes_:.2f}", f"{memory:.0f}"


def printed(command):
    """Seconds that a program prints."""
    done = subprocess.run(list(map(str, command)), env=ENVIRONMENT, capture_output=True, text=True, check=True)
    return float(done.stdout)


def measure(rounds=3):
    """Both tables."""
    folder = BUILD / "logs"
    runs, long = logs(folder)
    dualv, plain = ours.description("dualv"), without_instruments(folder)
    rows = [
        ["4 x 50 000 samples", *identified(dualv, runs, rounds)],
        ["the same, no instruments", *identified(plain, runs, rounds)],
        ["10 minutes at 5 kHz", *identified(dualv, {"--data": [long]}, 1)],
        ["the same, no instruments", *identified(plain, {"--data": [long]}, 1)],
    ]
    title = ["`overact identify`", "ns per sample", "bytes read / bytes of the logs", "peak memory, MB"]
    size = long.stat().st_size
    reader = ours.ROOT / "target/release/overact-read"
    own = [printed([reader, dualv, long]) for _ in range(rounds)]
    polars = [printed([sys.executable, "-c", POLARS, long]) for _ in range(rounds)]
    speeds = [f"{size / min(times) / 1e9:.2f}" for times in (own, polars)]
    ratio = f"{min(own) / min(polars):.2f}"
    read = report.table(["reading, GB/s", "overact", "polars", "time / polars'"], [["10 minutes", *speeds, ratio]])
    return f"{report.table(title, rows)}\n\n{read}"
