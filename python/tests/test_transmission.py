"""Transmissions between motors and joints."""

import numpy as np
import pytest

import overact
from conftest import ROBOTS


@pytest.fixture(scope="module")
def ankle():
    return overact.Robot(ROBOTS / "ankle.toml")


def test_power_and_round_trips(ankle):
    rng = np.random.default_rng(1)
    pose = ankle.home_pose + rng.uniform(-0.1, 0.1, (20, ankle.r))
    transmission = ankle.transmission(pose)
    speeds, torques = rng.normal(size=(2, 20, ankle.r))
    motors = transmission.motor_torques(torques)
    np.testing.assert_allclose(transmission.joint_torques(motors), torques, rtol=1e-12, atol=1e-12)
    rates = transmission.motor_velocities(speeds)
    np.testing.assert_allclose(transmission.joint_velocities(rates), speeds, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose((motors * rates).sum(-1), (torques * speeds).sum(-1), rtol=1e-12, atol=1e-12)
    inertia = transmission.reflected_inertia([0.02, 0.03])
    power = 0.5 * ([0.02, 0.03] * rates**2).sum(-1)
    np.testing.assert_allclose(0.5 * np.einsum("ni,nij,nj->n", speeds, inertia, speeds), power, rtol=1e-12)


def test_accelerations_and_curvature(ankle):
    rng = np.random.default_rng(2)
    pose = ankle.home_pose + rng.uniform(-0.1, 0.1, ankle.r)
    twist, acceleration = rng.normal(size=(2, ankle.r))
    transmission = ankle.transmission(pose)
    bias = ankle.transmission_bias(pose, twist)
    motors = transmission.motor_accelerations(acceleration, bias)
    np.testing.assert_allclose(transmission.joint_accelerations(motors, bias), acceleration, rtol=1e-12)
    second = ankle.curvature(pose)
    np.testing.assert_allclose(np.einsum("aij,i,j->a", second, twist, twist), bias, rtol=1e-9, atol=1e-12)
    step = 1e-5
    for k, unit in enumerate(np.eye(ankle.r)):
        ends = ankle.inverse_jacobian(pose + step * np.array([unit, -unit]))
        np.testing.assert_allclose(second[:, :, k], (ends[0] - ends[1]) / (2 * step), rtol=1e-6, atol=1e-7)
    gains = np.array([100.0, 120.0])
    torques = rng.normal(size=2)
    stiffness = transmission.joint_stiffness(gains, torques, second)
    np.testing.assert_allclose(transmission.motor_stiffness(stiffness, torques, second), np.diag(gains), atol=1e-9)


def test_gains_and_limits():
    ankle = overact.Transmission([[0.8, 0.5], [0.8, -0.5]])
    np.testing.assert_allclose(ankle.motor_torques([16.0, 2.0]), [12.0, 8.0])
    np.testing.assert_allclose(ankle.joint_gains([100.0, 100.0]), [[128.0, 0.0], [0.0, 50.0]], atol=1e-12)
    np.testing.assert_allclose(ankle.diagonal_motor_gains([[128.0, 0.0], [0.0, 50.0]]), [100.0, 100.0])
    np.testing.assert_allclose(ankle.motor_gains(ankle.joint_gains([3.0, 5.0])), np.diag([3.0, 5.0]), atol=1e-12)
    np.testing.assert_allclose(ankle.speed_intervals([12.0, 12.0]), [[-15.0, 15.0], [-24.0, 24.0]])
    np.testing.assert_allclose(ankle.speed_factor([1.0, 0.0], [[-12.0, 8.0], [-12.0, np.inf]]), 10.0)
    np.testing.assert_allclose(ankle.torque_factor([1.0, 0.0], [5.0, 5.0]), 8.0)
    # A single joint torque of ±1.6 N m loads both motors with 1 N m.
    np.testing.assert_allclose(ankle.torque_intervals([1.0, 1.0])[0], [-1.6, 1.6])
    beyond = overact.Transmission([[0.8, -0.2], [0.8, 0.2]])
    assert ankle.is_in_mode_of(ankle) and not beyond.is_in_mode_of(ankle)
    assert repr(ankle) == "<Transmission of 2 motors and 2 joints>"


def test_redundant_motors(dualv):
    transmission = dualv.transmission(dualv.home_pose)
    np.testing.assert_allclose(transmission.inverse, dualv.jacobian(dualv.home_pose), rtol=1e-9, atol=1e-12)
    torques = transmission.motor_torques([1.0, 2.0, 0.5])
    np.testing.assert_allclose(dualv.null_space(dualv.home_pose).T @ torques, 0.0, atol=1e-12)


def test_errors(emps):
    with pytest.raises(overact.EvaluationError, match="sample 1: .*do not determine"):
        overact.Transmission([[[1.0, 0.0], [0.0, 1.0]], [[1.0, 1.0], [2.0, 2.0]]])
    with pytest.raises(overact.EvaluationError, match="not finite"):
        overact.Transmission([[np.nan]])
    one = overact.Transmission([[1.0], [2.0]])
    with pytest.raises(overact.DataError, match="same effect"):
        one.diagonal_motor_gains([[1.0]])
    with pytest.raises(overact.DataError, match="contain zero"):
        one.speed_intervals([[1.0, 2.0], [-1.0, 1.0]])
    with pytest.raises(overact.DataError, match="direction"):
        one.speed_factor([0.0], [1.0, 1.0])
    with pytest.raises(ValueError, match="`joint_torques`"):
        one.motor_torques([1.0, 2.0])
    if "inverse_jacobian" not in emps.functions:
        with pytest.raises(ValueError, match="its motors are on its coordinates"):
            emps.transmission([0.0])


FRAME = '\n[frame.tool]\nat = ["0.1 m", 0, 0]\n'


def test_frames_and_derivatives():
    robot = overact.Robot.from_string((ROBOTS / "rx90.toml").read_text(encoding="utf-8") + FRAME)
    assert {"tool_pose", "tool_jacobian", "tool_torques", "inverse_dynamics_by_displacement"} <= set(robot.functions)
    rng = np.random.default_rng(7)
    joints, rates, rising = rng.uniform(-1.0, 1.0, (3, robot.r))
    jacobian, step = robot.tool_jacobian(joints), 1e-6
    parameters = rng.uniform(0.5, 1.5, robot.inverse_dynamics.inputs["parameters"])
    by_pose = robot.inverse_dynamics_by_displacement(joints, rates, rising, parameters)
    for k, unit in enumerate(step * np.eye(robot.r)):
        ends = robot.tool_pose(np.array([joints + unit, joints - unit]))
        np.testing.assert_allclose(jacobian[:3, k], (ends[0] - ends[1])[:3] / (2 * step), rtol=1e-6, atol=1e-7)
        torques = robot.inverse_dynamics(np.array([joints + unit, joints - unit]), rates, rising, parameters)
        difference = (torques[0] - torques[1]) / (2 * step)
        np.testing.assert_allclose(by_pose[:, k], difference, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(robot.tool_velocity(joints, rates), jacobian @ rates, rtol=1e-12, atol=1e-12)
    wrench = rng.normal(size=6)
    np.testing.assert_allclose(robot.tool_torques(joints, wrench), -jacobian.T @ wrench, rtol=1e-12, atol=1e-12)
