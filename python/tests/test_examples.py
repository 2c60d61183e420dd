"""The examples run with the expected results."""

import pathlib
import runpy

import numpy as np

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"


def test_dualv_example_recovers_the_true_parameters(capsys):
    found = runpy.run_path(str(EXAMPLES / "dualv.py"), run_name="__main__")
    printed = capsys.readouterr().out
    assert "<Robot DualV: r = 3, n = 4" in printed and str(found["result"]) in printed
    result, robot = found["result"], found["robot"]
    # The true parameters of the robot are known.
    truth = robot.true_values
    for name, one in result.base.items():
        expected = robot.base_parameters[name].value(truth) if "payload" not in name else truth[name]
        assert abs(one.value - expected) < 6 * one.correlated_standard_deviation, name
    pose, twist, acceleration = found["pose"], found["twist"], found["acceleration"]
    exact = robot.inverse_dynamics(pose, twist, acceleration, robot.parameter_vector(truth))
    np.testing.assert_allclose(found["torques"], exact, atol=0.1)


def test_pendulum_example_recovers_the_true_parameters(tmp_path, monkeypatch):
    # Away from the repository, as after `pip install overact`.
    copy = tmp_path / "pendulum.py"
    copy.write_text((EXAMPLES / "pendulum.py").read_text(encoding="utf-8"), encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    found = runpy.run_path(str(copy), run_name="__main__")
    assert set(found["result"].recommended) == set(found["truth"])
    for name, one in found["result"].recommended.items():
        assert abs(one.value - found["truth"][name]) < 6 * one.correlated_standard_deviation, name


def test_all_examples_are_tested():
    assert sorted(path.name for path in EXAMPLES.glob("*.py")) == ["dualv.py", "pendulum.py"]
