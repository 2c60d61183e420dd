"""Types and documentation of the package."""

import importlib.util
import inspect
import pathlib
import subprocess
import sys

import pytest

import overact
from conftest import ROBOTS

HERE = pathlib.Path(__file__).resolve().parents[1]


def test_the_function_stub_is_fresh():
    spec = importlib.util.spec_from_file_location("functions", HERE / "tools" / "functions.py")
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    assert tool.STUB.read_text(encoding="utf-8") == tool.written(), "run python tools/functions.py"


@pytest.mark.parametrize("stem", ["dualv", "emps", "five_bar", "hexapod", "ankle"])
def test_the_stub_has_all_robot_functions(stem):
    stub = (HERE / "overact" / "_functions.pyi").read_text(encoding="utf-8")
    for name in overact.Robot(ROBOTS / f"{stem}.toml").functions:
        assert f"    {name}: Function\n" in stub, name


def test_the_wheel_is_typed():
    assert (pathlib.Path(overact.__file__).parent / "py.typed").is_file()
    assert (pathlib.Path(overact.__file__).parent / "_overact.pyi").is_file()


def test_the_stub_has_all_items_of_the_compiled_module():
    stub = (HERE / "overact" / "_overact.pyi").read_text(encoding="utf-8")
    from overact import _overact

    for name, one in vars(_overact).items():
        if name.startswith("__") or inspect.ismodule(one):
            continue
        assert f"class {name}" in stub or f"def {name}" in stub, name
        for member in vars(one) if inspect.isclass(one) else ():
            if not member.startswith("__"):
                assert f"def {member}(" in stub, f"{name}.{member}"


def test_all_public_items_are_documented():
    for name in overact.__all__:
        one = getattr(overact, name)
        if inspect.isclass(one) or inspect.isfunction(one):
            assert inspect.getdoc(one), name
        for member, what in vars(one).items() if inspect.isclass(one) else ():
            if not member.startswith("_") and (inspect.isfunction(what) or isinstance(what, property)):
                assert inspect.getdoc(what), f"{name}.{member}"


def test_mypy_accepts_valid_use_only(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "use.py").write_text(
        "import numpy as np\nimport overact\n"
        "robot = overact.Robot('a.toml')\n"
        "values: np.ndarray = robot.inverse_dynamics([0.0], out=None)\n"
        "mass: float = overact.identify(robot).recommended['m'].value\n"
        "robot.identify(7).verdict.reasons[0].upper()\n"
        "robot.no_such_function\n",
        encoding="utf-8",
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "use.py"], cwd=tmp_path, capture_output=True, text=True
    )
    errors = [line for line in done.stdout.splitlines() if "error" in line and "use.py" in line]
    assert len(errors) == 1 and "no_such_function" in errors[0], done.stdout
