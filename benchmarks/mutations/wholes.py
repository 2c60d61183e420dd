"""Valid, matching files: the log, states, parameters and factors of each robot."""

import dataclasses
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Small robots of each type, because size does not matter for damaged text.
ROBOTS = ["emps", "five_bar", "two_motor_axis", "three_leg_point", "planar_3prr", "four_bar", "scotch_yoke"]
# Number of lines of a log.
LINES = 2500
MODELS = ROOT / "interchange" / "tests" / "models"
# Files of other programs, with the required options.
FOREIGN = {"ankle.xml": [], "arm.urdf": [], "arm.par": ["--value", "L1=0.2,D3=0.5,L2=0.52,L3=0.25"]}
WRITTEN = ROOT / "logs" / "tests" / "written"
# One log of two drives in every binary format without a feature, with the names of its columns.
STORED = {
    "same.npy": ("$1", ["$2", "$3"], ["$6", "$7"]),
    "same.npz": ("t", ["q(:,1)", "q(:,2)"], ["tau(:,1)", "tau(:,2)"]),
    "same.mat": ("t", ["q(:,1)", "q(:,2)"], ["tau(:,1)", "tau(:,2)"]),
    "same.parquet": ("t", ["q1", "q2"], ["tau1", "tau2"]),
    "duckdb_zstd.parquet": None,
    "polars_gzip.parquet": None,
    "pyarrow_gzip_2.parquet": None,
}
# Inputs that are drawn about zero; their magnitude is that of the robot.
SAMPLES = 3


@dataclasses.dataclass
class Whole:
    """Files by name, states of each function, and required options."""

    files: dict[str, bytes]
    states: dict[str, bytes] = dataclasses.field(default_factory=dict)
    options: list[str] = dataclasses.field(default_factory=list)


def said(overact: pathlib.Path, folder: pathlib.Path, *words: str) -> str:
    """Output of a command that must succeed."""
    done = subprocess.run([overact, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")
    return done.stdout


def table(names: list[str], rows: list[list[float]]) -> bytes:
    return "\n".join([",".join(names), *(",".join(map(repr, row)) for row in rows), ""]).encode()


def robot(overact: pathlib.Path, stem: str, folder: pathlib.Path, draw) -> Whole:
    """A robot of the library with all other files that commands read."""
    text = (ROOT / "robots" / f"{stem}.toml").read_bytes()
    # The log has the columns of a virtual experiment, also if the description is for a measured one.
    (folder / "robot.toml").write_bytes(text)
    said(overact, folder, "simulate", "robot.toml", "-o", "log.csv", "--json")
    logs = sorted(folder.glob("log*.csv"))
    lines = logs[0].read_bytes().splitlines(keepends=True)[:LINES]
    said(overact, folder, "identify", "robot.toml", "--parameters", "parameters.toml")
    files = {"robot.toml": text, "log.csv": b"".join(lines), "parameters.toml": (folder / "parameters.toml").read_bytes()}
    states = states_of(overact, folder, draw)
    for file in folder.iterdir():
        file.unlink()
    return Whole(files, states)


def with_factors(overact: pathlib.Path, whole: Whole, folder: pathlib.Path) -> None:
    """Adds the factors of the log."""
    for name in ("robot.toml", "log.csv"):
        (folder / name).write_bytes(whole.files[name])
    said(overact, folder, "factor", "robot.toml", "log.csv", "-o", "factors.parquet")
    whole.files["factors.parquet"] = (folder / "factors.parquet").read_bytes()
    for file in folder.iterdir():
        file.unlink()


def states_of(overact: pathlib.Path, folder: pathlib.Path, draw) -> dict[str, bytes]:
    """States near home for every function, at which it has a value."""
    model = json.loads(said(overact, folder, "inspect", "robot.toml", "--effort", "none", "--json"))
    home = model["home_pose"] or model["home_joints"]
    known = {"pose": [[one + draw.uniform(-0.01, 0.01) for one in home] for _ in range(SAMPLES)]}
    functions = {one["function"]: one["inputs"] for one in model["functions"]}
    (folder / "states.csv").write_bytes(table([f"pose[{at}]" for at in range(len(home))], known["pose"]))
    for name, function in (("joints", "joints"), ("actuators", "actuator_positions")):
        if function in functions:
            found = json.loads(said(overact, folder, "evaluate", "robot.toml", function, "--states", "states.csv", "--json"))
            known[name] = [one[function] for one in found["results"]]
    if "joints" not in known:
        known["joints"] = known["pose"]
    states = {}
    for function, inputs in functions.items():
        names, rows = [], [[] for _ in range(SAMPLES)]
        for one in inputs:
            name, count = one["name"], 1
            for size in one["shape"]:
                count *= size
            if name not in known:
                known[name] = [[draw.uniform(0.2, 1.0) for _ in range(count)] for _ in range(SAMPLES)]
            names += [f"{name}[{at}]" for at in range(count)]
            for row, values in zip(rows, known[name]):
                row += values
        states[function] = table(names, rows)
    return states


def foreign(overact: pathlib.Path, name: str, folder: pathlib.Path) -> Whole:
    """A model of another program with parameters for it."""
    kind = name.rsplit(".", 1)[1]
    content, options = (MODELS / name).read_bytes(), FOREIGN[name]
    files = {f"model.{kind}": content}
    (folder / name).write_bytes(content)
    said(overact, folder, "import", name, *options, "-o", "robot.toml")
    if kind != "par":
        said(overact, folder, "identify", "robot.toml", "--parameters", "parameters.toml")
        files["parameters.toml"] = (folder / "parameters.toml").read_bytes()
    for file in folder.iterdir():
        file.unlink()
    return Whole(files, options=options)


def stored(name: str) -> Whole:
    """A log of a robot with two drives, written by another library."""
    time, positions, torques = STORED[name] or STORED["same.parquet"]
    text = (ROOT / "robots" / "two_motor_axis.toml").read_text()
    data = f"\n[data]\ntime = {json.dumps(time)}\npositions = {json.dumps(positions)}\ntorques = {json.dumps(torques)}\n"
    log = (WRITTEN / name).read_bytes()
    return Whole({"robot.toml": (text + data).encode(), "log.csv": log})
