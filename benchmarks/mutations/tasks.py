"""Damaged files and the commands that read them."""

import dataclasses
import random

from damage import damaged
from wholes import Whole

# In Python: everything that is read from a description, each function at home, and an identification if there
# is a log.
PYTHON = """
import sys, overact
try:
    robot = overact.Robot("robot.toml")
    repr(robot), robot.parameters, robot.base_parameters, robot._repr_html_()
    for name in ("joints", "inverse_jacobian", "idm_red_platform", "idm_red_platform_base"):
        if name in robot.functions:
            function = robot.function(name)
            home = {"pose": robot.home_pose, "joints": robot.home_joints}
            sizes = {one: robot.r for one in ("twist", "acceleration", "joint_velocities", "joint_accelerations")}
            function(*[home[one] if one in home else [0.1] * sizes[one] for one in function.inputs], invalid="nan")
    if "log" in sys.argv:
        result = overact.identify(robot, "log.csv")
        repr(result), result.to_dict(), result._repr_html_()
    if "simulate" in sys.argv:
        robot.simulate()
except overact.InternalError:
    raise
except overact.OveractError as error:
    print(f"{error}"[:2000], [one.message for one in getattr(error, "problems", ())])
    sys.exit(1)
"""
QUICK = ["--effort", "none"]
OUT = ["-o", "kept"]


@dataclasses.dataclass
class Case:
    """Files, one of which is damaged, and the command for them."""

    files: dict[str, bytes]
    tasks: list[list[str]]
    #: Arguments of the equivalent Python program; None if there is none.
    python: list[str] | None = None


def changed(whole: Whole, name: str, draw: random.Random, is_text: bool = True) -> dict[str, bytes]:
    return {**whole.files, name: damaged(whole.files[name], draw, is_text)}


def evaluated(whole: Whole, draw: random.Random, functions: list[str] | None = None) -> tuple[list[str], bytes]:
    """Evaluation of a function of the undamaged robot, with its states."""
    function = draw.choice(functions or list(whole.states))
    given = draw.choice([["--parameters", "parameters.toml"], []])
    # Parameters in a file are the same for all states.
    return ["evaluate", "robot.toml", function, "--states", "states.csv", *given, *draw.choice([OUT, ["--json"]])], whole.states[function]


def description(whole: Whole, draw: random.Random, only: str | None) -> Case:
    """A damaged description with valid files."""
    files = changed(whole, "robot.toml", draw)
    evaluate, files["states.csv"] = evaluated(whole, draw)
    every = [
        ["inspect", "robot.toml", *QUICK, "--json"],
        ["inspect", "robot.toml", *QUICK, "--svg", "kept.svg"],
        ["generate", "robot.toml", *QUICK, "--functions", "identification", *OUT],
        ["generate", "robot.toml", *QUICK, "--float", "f32", "--functions", "control", *OUT],
        ["generate", "robot.toml", *QUICK, "--parameters", "parameters.toml", *OUT],
        ["generate", "robot.toml", *QUICK, "--lang", "c", "-o", "c"],
        evaluate,
        ["simulate", "robot.toml", *OUT],
        ["simulate", "robot.toml", "--parameters", "parameters.toml", *OUT],
        ["identify", "robot.toml", "--parameters", "kept.toml", "--json"],
        ["partitions", "robot.toml", "--json"],
        ["excite", "robot.toml", "--runs", "1", "--time", "2", *OUT],
        ["factor", "robot.toml", "log.csv", *OUT],
        ["identify", "robot.toml", "--data", "log.csv", "--report", "kept.html"],
    ]
    if b"[data]" in whole.files["robot.toml"]:
        # Its columns are those of a measured log.
        every = every[:-2]
    if only:
        return Case(files, [draw.choice([one for one in every if one[0] == only] or every)])
    words = [[], ["simulate"]] if b"[data]" in whole.files["robot.toml"] else [[], ["simulate"], ["log"]]
    return Case(files, [["check", "robot.toml"], draw.choice(every)], draw.choice(words))


def log(whole: Whole, draw: random.Random) -> Case:
    """A damaged log, as text or in another library's format."""
    is_text = "factors.parquet" in whole.files
    options = draw.choice([["--report", "kept.html"], ["--json"], ["--tables", *OUT], ["--gains"], ["--calibrate", "--json"]])
    data = draw.choice(["--data", "--payload-data"]) if is_text else "--data"
    tasks = [["identify", "robot.toml", data, "log.csv", *options], ["factor", "robot.toml", "log.csv", *OUT]]
    files = changed(whole, "log.csv", draw, is_text)
    if is_text:
        files["whole.csv"] = whole.files["log.csv"]
        tasks.append(["identify", "robot.toml", "--data", "whole.csv", "--cross-validate", "log.csv", "--json"])
    return Case(files, [draw.choice(tasks)], ["log"])


def states(whole: Whole, draw: random.Random) -> Case:
    """Damaged states of a valid robot."""
    evaluate, content = evaluated(whole, draw)
    return Case({**whole.files, "states.csv": damaged(content, draw)}, [evaluate])


def parameters(whole: Whole, draw: random.Random) -> Case:
    """Damaged parameters of a valid robot."""
    given = ["--parameters", "parameters.toml"]
    dynamic = [one for one in whole.states if "inverse_dynamics" in one or "mass_matrix" in one]
    evaluate, content = evaluated(whole, draw, dynamic)
    tasks = [
        ["generate", "robot.toml", *QUICK, *given, *OUT],
        ["generate", "robot.toml", *QUICK, *given, "--lang", "c", "-o", "c"],
        ["simulate", "robot.toml", *given, *OUT],
        evaluate if "--parameters" in evaluate else [*evaluate, *given],
    ]
    return Case({**changed(whole, "parameters.toml", draw), "states.csv": content}, [draw.choice(tasks)])


def factors(whole: Whole, draw: random.Random) -> Case:
    """A damaged factor file."""
    skip = draw.choice([[], ["--skip-bad"]])
    tasks = [
        ["merge", "factors.parquet", *skip, *OUT],
        ["merge", "factors.parquet", "whole.parquet", *skip, *OUT],
        ["identify", "robot.toml", "--factors", "factors.parquet", *skip, "--json"],
        ["identify", "robot.toml", "--factors", "whole.parquet", "factors.parquet", *skip, *OUT],
    ]
    files = {**changed(whole, "factors.parquet", draw, False), "whole.parquet": whole.files["factors.parquet"]}
    return Case(files, [draw.choice(tasks)])


def model(whole: Whole, draw: random.Random) -> Case:
    """A damaged model of another program, or damaged parameters for it."""
    (name,) = [one for one in whole.files if one.startswith("model.")]
    key = {"model.xml": "--mjcf", "model.urdf": "--urdf"}.get(name)
    into = ["import", name, *whole.options, *OUT]
    if not key:
        return Case(changed(whole, name, draw), [into])
    back = ["export", key, name, "--parameters", "parameters.toml", *OUT]
    if draw.random() < 0.2:
        return Case(changed(whole, "parameters.toml", draw), [back])
    return Case(changed(whole, name, draw), [into, back])
