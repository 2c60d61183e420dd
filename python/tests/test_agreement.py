"""Python, the command line's interpreter and compiled Rust agree on every robot of the library."""

import json
import os
import subprocess

import numpy as np
import pytest

from conftest import ROBOTS

import overact

STEMS = sorted(path.stem for path in ROBOTS.glob("*.toml"))
IS_FULL = os.environ.get("OVERACT_TESTS") in ("full", "night")
#: Robots of the default tier: redundant, with one motor, with two, with chains, serial.
FEW = {"dualv", "emps", "five_bar", "ankle", "rx90"}
#: Functions evaluated by the command line, which compiles the robot each time.
ASKED = ["idm_red_platform_base", "inverse_dynamics"]
SAMPLES = 70 if IS_FULL else 7


def robot_of(stem):
    if stem not in FEW and not IS_FULL:
        pytest.skip("in the full tier")
    return overact.Robot(ROBOTS / f"{stem}.toml")


def inputs_of(robot, function, samples=SAMPLES):
    """Random inputs near the home configuration."""
    random = np.random.default_rng(5)
    home = robot.home_pose
    poses = home + random.uniform(-0.02, 0.02, (samples, len(home)))
    if len(home) > robot.r:
        poses[:, -4:] /= np.linalg.norm(poses[:, -4:], axis=1, keepdims=True)
    if "blocked_error" in robot.functions:
        poses = allowed(robot, poses)
    inputs = {}
    for name, length in function.inputs.items():
        if name == "pose" or (name == "joints" and "pose" not in function.inputs):
            inputs[name] = poses
        elif name == "joints":
            inputs[name] = robot.joints(poses)
        elif name == "actuators":
            inputs[name] = robot.actuator_positions(poses)
        elif name.endswith("parameters"):
            inputs[name] = random.uniform(0.5, 1.5, length)
        else:
            inputs[name] = random.normal(size=(samples, length))
    return inputs


def allowed(robot, poses):
    """Closed poses near given ones for a platform with parasitic motion, by Newton steps."""
    for _ in range(5):
        errors, jacobians = robot.blocked_error(poses), robot.blocked_jacobian(poses)
        for pose, error, jacobian in zip(poses, errors, jacobians):
            step = -np.linalg.pinv(jacobian) @ error
            pose[:3] += step[:3]
            # Left multiplication by half a small rotation vector, which is in the base frame.
            w, v, turn = pose[3], pose[4:].copy(), step[3:] / 2
            pose[3] = w - turn @ v
            pose[4:] = v + w * turn + np.cross(turn, v)
            pose[3:] /= np.linalg.norm(pose[3:])
    assert np.abs(robot.blocked_error(poses)).max() < 1e-13
    return poses


def agree(found, expected, tolerance, what):
    size = max(1.0, np.abs(expected).max())
    np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance * size, err_msg=what)


@pytest.mark.parametrize("stem", STEMS)
def test_values_equal_those_of_the_command_line(stem, command, tmp_path):
    robot = robot_of(stem)
    for name in ASKED:
        function = robot.function(name)
        inputs = inputs_of(robot, function)
        states = [
            {one: (value if value.ndim == 1 else value[at]).tolist() for one, value in inputs.items()}
            for at in range(SAMPLES)
        ]
        (tmp_path / "states.json").write_text(json.dumps(states), encoding="utf-8")
        document = command.json("evaluate", robot.file, name, "--states", "states.json")
        rows = [row[function.name.removesuffix("_base")] for row in document["results"]]
        expected = np.array(rows).reshape(SAMPLES, *function.shape)
        # The same programs, evaluated in blocks of the same samples.
        agree(function(**inputs), expected, 1e-13, f"{stem}.{name}")


@pytest.fixture(scope="module")
def compiled():
    """Evaluates compiled robots, if they have been built."""
    program = os.environ.get("OVERACT_COMPILED_VALUES")
    if not program:
        pytest.skip("OVERACT_COMPILED_VALUES names no program with the compiled robots")

    def ask(questions):
        done = subprocess.run([program], input="\n".join(questions) + "\n", capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout.splitlines()

    return ask


@pytest.mark.parametrize("stem", STEMS)
def test_values_equal_those_of_compiled_rust(stem, compiled):
    robot = robot_of(stem)
    names, questions, found = [], [], []
    for name in robot.functions:
        # A compiled `overact::Model` does not offer forms from joints and actuators.
        if name.endswith(("_from_actuators", "_from_joints")) and name != "twist_from_actuators":
            continue
        if name in ("closure_error", "acceleration_from_actuators"):
            continue
        function = robot.function(name)
        inputs = inputs_of(robot, function)
        lines = [" ".join(map(repr, map(float, value.ravel()))) for value in inputs.values()]
        try:
            found.append(function(**inputs))
        except overact.EvaluationError as error:
            # Parameters are drawn independently, so not every draw is physically consistent.
            assert "positive definite" in str(error), f"{stem}.{name}: {error}"
            continue
        names.append(name)
        questions.append("\n".join([f"{stem} {name} {SAMPLES} {len(lines)}", *lines]))
    answers = compiled(questions)
    assert len(answers) == len(names) > 10
    for name, own, answer in zip(names, found, answers):
        assert not answer.startswith("error"), f"{stem}.{name}: {answer}"
        expected = np.array(answer.split(), dtype=float).reshape(own.shape)
        # Other forms of the same expressions: the search reorders sums, and square roots lose digits for
        # legs near their limits.
        agree(own, expected, TOLERANCE, f"{stem}.{name}")


TOLERANCE = 1e-10
