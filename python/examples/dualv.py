"""The DualV from its description to a controller's torques: load, look, simulate, identify, use.

Cells of a notebook (`# %%`); `python examples/dualv.py` runs them one after the other.
"""

# %% Load: the description becomes a robot
import pathlib

import numpy as np

import overact

# A notebook next to this file has no `__file__`.
EXAMPLES = pathlib.Path(globals().get("__file__", "dualv.ipynb")).resolve().parent
robot = overact.Robot(EXAMPLES.parents[1] / "robots" / "dualv.toml")
print(robot)
robot  # in a notebook: its drawing

# %% Look: parameters, what is regrouped, what functions cost
print(len(robot.base_parameters), "base parameters, among them")
print(robot.base_parameters["m_platformR"])
print("inverse_dynamics:", robot.cost("inverse_dynamics"))

# %% Evaluate: one state, then ten thousand
pose, twist, acceleration = [0.02, -0.01, 0.1], [0.3, 0.0, 1.0], [0.0, 2.0, 0.0]
print("Γ¹ = IDM χ, one state:", robot.idm_red_platform(pose, twist, acceleration).shape)
random = np.random.default_rng(1)
poses = random.uniform(-0.05, 0.05, (10_000, 3))
twists, accelerations = random.normal(size=(2, 10_000, 3))
regressors = robot.idm_red_platform(poses, twists, accelerations)
print("ten thousand:", regressors.shape)

# %% Simulate: what a laboratory would record
runs = robot.simulate()
for run in runs:
    print(run)

# %% Identify: from two runs, and compare predictions with those that are held out
held = [run for run in runs if run.name in robot.held_out]
own = [run for run in runs if run.name not in robot.held_out]
result = overact.identify(robot, own, validation=held)
print(result)  # what the command line prints
result  # in a notebook: the report

# %% Show: estimates with their intervals
for name in list(result.recommended)[:5]:
    print(result.recommended[name])

# %% Use: torques of a controller, with and without an internal torque
parameters = robot.parameter_vector(result.consistent)
torques = robot.inverse_dynamics(pose, twist, acceleration, parameters)
print("torques of least norm:", np.round(torques, 3), "N m")
print("preloaded by 1 N m:   ", np.round(torques + robot.null_space(pose) @ [1.0], 3), "N m")
