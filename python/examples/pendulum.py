"""A pendulum from its description to identified parameters. It needs the installed package alone:

    pip install overact
    python pendulum.py
"""

import numpy as np

import overact

DESCRIPTION = """
name = "Pendulum"
gravity = [0, 0, "-9.81 m/s^2"]

[[leg.arm.joint]]
type = "revolute"
alpha = "90 deg"        # the joint's axis is horizontal
actuated = true
parameters = ["zz", "mx", "fv", "fs"]

[[place]]
name = "arm"
shape = "arm"
"""

robot = overact.Robot.from_string(DESCRIPTION)
print(robot)

# What a laboratory records: ten seconds of motion (rad), and the torque with noise (N m).
time = np.arange(0.0, 10.0, 1e-3)
amplitudes, rates = np.array([[1.0], [0.4]]), 2 * np.pi * np.array([[0.3], [1.1]])
position = (amplitudes * np.sin(rates * time)).sum(axis=0)
velocity = (amplitudes * rates * np.cos(rates * time)).sum(axis=0)
acceleration = (-amplitudes * rates**2 * np.sin(rates * time)).sum(axis=0)
truth = {"zz_1": 0.05, "mx_1": 0.6, "fv_1": 0.1, "fs_1": 0.2}
states = (position[:, None], velocity[:, None], acceleration[:, None])
torque = robot.inverse_dynamics(*states, robot.parameter_vector(truth))[:, 0]
torque += np.random.default_rng(1).normal(scale=0.05, size=torque.size)

# Positions and torques suffice: velocities and accelerations are computed from the positions.
result = overact.identify(robot, {"time": time, "q_1": position, "tau_1": torque})
print(result)
for name, one in result.recommended.items():
    print(f"{name}: {one.value:.4f}, true {truth[name]}, 95 % interval {one.interval_95}")
