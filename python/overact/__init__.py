"""Dynamic models and parameter identification of robots with closed loops and redundant motors.

>>> import overact
>>> robot = overact.Robot("robots/dualv.toml")
>>> robot.idm_red_platform(pose, twist, acceleration)   # 3 x 64, or N x 3 x 64 of N samples
>>> result = overact.identify(robot, {"time": t, "q_leg1": ..., "tau_leg1": ...})
>>> result.recommended["zz_platformR"].interval_95

`Robot` has the functions of the robot, which take NumPy arrays. `Robot.simulate` simulates its virtual
experiment, `identify` estimates its parameters, `online` does so while data arrive. `Transmission` converts
torques, gains and limits between motors and joints. Errors are raised as one of the exceptions below, all of
which are an `OveractError`. All numbers are in SI units: m, rad, s, N, N m, kg.
"""

from . import online
from ._errors import (
    DataError,
    DescriptionError,
    EvaluationError,
    InternalError,
    OveractError,
    Problem,
    UnknownNameError,
)
from ._identify import identify
from ._model import BaseParameter, Cost, Iteration, Parameter
from ._overact import Function, __version__
from ._result import Estimate, Identification, ParameterEstimate, Verdict
from ._robot import Robot
from ._run import Run
from ._symbolic import Symbolic
from ._transmission import Transmission

__all__ = [
    "BaseParameter",
    "Cost",
    "DataError",
    "DescriptionError",
    "Estimate",
    "EvaluationError",
    "Function",
    "Identification",
    "InternalError",
    "Iteration",
    "OveractError",
    "Parameter",
    "ParameterEstimate",
    "Problem",
    "Robot",
    "Run",
    "Symbolic",
    "Transmission",
    "UnknownNameError",
    "Verdict",
    "__version__",
    "identify",
    "online",
]
