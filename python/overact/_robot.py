"""A robot, compiled from its description."""

from __future__ import annotations

import json
import os
import warnings
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Sequence

import numpy as np

from ._errors import Named, NamedFunctions, unknown
from ._functions import Functions
from ._model import BaseParameter, Cost, Parameter
from ._overact import Function, Handle
from ._run import Run
from ._symbolic import Symbolic
from ._transmission import Transmission, bias, curvature

if TYPE_CHECKING:
    from ._result import Identification


class _Table(tuple):
    """A tuple whose elements can also be accessed by name."""

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            for one in self:
                if one.name == key:
                    return one
            raise unknown("parameter", key, (one.name for one in self))
        return super().__getitem__(key)


class Robot(Functions):
    """A robot, compiled from its description in TOML.

    The functions of the robot are attributes: ``robot.idm_red_platform(pose, twist, acceleration)``;
    `functions` lists them. The last axis of each input has the numbers of a sample, all axes before are
    samples. An input of one axis is used for all samples.

    Contiguous float64 is read in place, and ``out=`` is a contiguous float64 array for the result. Other
    Python threads can run meanwhile. A state without a value (unreachable, singular or not finite) raises
    an `EvaluationError` with its sample, or gives rows of NaN with ``invalid="nan"``. Functions
    ``…_from_actuators`` first compute the pose, sample after sample, from ``start=`` or from home.

    Args:
        path: The description.

    Raises:
        DescriptionError: All errors of the description, each with its line.
        DataError: A file that cannot be read.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._take(Handle.from_file(os.fspath(path)))

    @classmethod
    def from_string(cls, text: str, name: str = "robot.toml") -> Robot:
        """Robot of a description in memory; `name` is its name in errors."""
        robot = cls.__new__(cls)
        robot._take(Handle.from_text(text, name))
        return robot

    def _take(self, handle: Handle) -> None:
        self._handle = handle
        self._info = json.loads(handle.info())
        parameter = lambda one: Parameter(one["name"], one["symbol"], one["unit"])  # noqa: E731
        self._parameters = _Table(map(parameter, self._info["parameters"]))
        self._payload_parameters = _Table(map(parameter, self._info["payload_parameters"]))
        self._base_parameters = _Table(
            BaseParameter(one["name"], one["parameter"], one["unit"], dict(one["regrouped"]))
            for one in self._info["base_parameters"]
        )

    def _missing(self, name: str) -> Function:
        # Unknown attributes are functions, which are then stored.
        if name.startswith("_"):
            raise AttributeError(name)
        function = self._handle.function(name)
        self.__dict__[name] = function
        return function

    if not TYPE_CHECKING:
        # Type checkers know only the functions of `Functions`.
        __getattr__ = _missing

    def __dir__(self) -> Iterable[str]:
        return [*super().__dir__(), *self.functions]

    def __reduce__(self) -> tuple:
        return _rebuilt, (self.text, self.file)

    # Names and sizes

    @property
    def name(self) -> str:
        """Name of the robot."""
        return self._info["name"]

    @property
    def summary(self) -> str:
        """Summary of the robot, one sentence."""
        return self._info["summary"]

    @property
    def file(self) -> str:
        """Path of the description, or its given name."""
        return self._handle.file

    @property
    def text(self) -> str:
        """The text of the description."""
        return self._handle.text

    @property
    def r(self) -> int:
        """Degrees of freedom, the length of a twist."""
        return self._info["r"]

    @property
    def n(self) -> int:
        """Number of actuators."""
        return self._info["n"]

    @property
    def legs(self) -> tuple[str, ...]:
        """Names of the legs."""
        return tuple(self._info["legs"])

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of all joints, in the order of ``joints``."""
        return tuple(self._info["joints"])

    @property
    def actuators(self) -> tuple[str, ...]:
        """Names of the actuators, in the order of positions and torques."""
        return tuple(self._info["actuators"])

    @property
    def kept_actuators(self) -> tuple[str, ...]:
        """Names of the actuators that the actuator projection (case 2) keeps."""
        return tuple(self.actuators[at] for at in self._info["kept_actuators"])

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates of a twist."""
        return tuple(self._info["coordinates"])

    @property
    def pose_coordinates(self) -> tuple[str, ...]:
        """Names of the pose coordinates (m, rad); a spatial pose ends with a quaternion."""
        return tuple(self._info["pose_coordinates"])

    @property
    def home_pose(self) -> np.ndarray:
        """The pose of the home configuration (m, rad)."""
        return np.array(self._info["home_pose"])

    @property
    def home_joints(self) -> np.ndarray:
        """Positions of all joints in the home configuration (m, rad)."""
        return np.array(self._info["home_joints"])

    @property
    def parameters(self) -> Sequence[Parameter]:
        """Standard parameters whose columns are not identically zero, in column order; also accessible by
        name."""
        return self._parameters

    @property
    def payload_parameters(self) -> Sequence[Parameter]:
        """The payload's parameters in column order."""
        return self._payload_parameters

    @property
    def base_parameters(self) -> Sequence[BaseParameter]:
        """The base parameters with their regroupings, in column order."""
        return self._base_parameters

    @property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs of the virtual experiment."""
        return tuple(self._info["runs"])

    @property
    def held_out(self) -> tuple[str, ...]:
        """Names of the description's validation runs."""
        return tuple(self._info["held_out"])

    @property
    def true_values(self) -> dict[str, float] | None:
        """Standard parameters of the virtual robot (SI units); None without a virtual experiment."""
        values = self._info["true_values"]
        return None if values is None else Named(values)

    # Functions

    @property
    def functions(self) -> tuple[str, ...]:
        """Names of all functions of the robot."""
        return tuple(self._handle.function_names())

    def function(self, name: str) -> Function:
        """A function by name, as ``getattr(robot, name)``."""
        return self._handle.function(name)

    def pose_from_actuators(self, actuators: Any, start: Any = None, out: Any = None) -> np.ndarray:
        """Forward kinematics: the least-squares poses for the positions of all actuators.

        Args:
            actuators: Positions of the actuators, (n,) or (N, n) (rad, m).
            start: Start pose of the first sample, by default home; each further sample starts from the
                previous one.
            out: Array for the poses.

        Returns:
            Poses (m, rad), one for each sample.
        """
        return self._handle.pose_from_actuators(actuators, start, out)

    def transmission(self, pose: Any) -> Transmission:
        """The transmission between motors and joints at a pose, or at many: torques, gains and limits.

        Args:
            pose: Pose (m, rad); joint positions of a robot without a platform.

        Raises:
            EvaluationError: A pose at which the motors do not determine all joints.
        """
        if "inverse_jacobian" not in self.functions:
            raise ValueError(f"{self.name} has no `inverse_jacobian`: its motors are on its coordinates")
        return Transmission(self.inverse_jacobian(pose))

    def transmission_bias(self, pose: Any, twist: Any) -> np.ndarray:
        """J̇ v: accelerations of the motors while the velocities of the joints are constant.

        `Transmission` converts accelerations with it.
        """
        return bias(self, pose, twist)

    def curvature(self, pose: Any) -> np.ndarray:
        """Derivative of the transmission's Jacobian at a pose, n x r x r; exact.

        Element (a, i, j) is the second derivative of the position of motor a. For several rotations in space it
        is the symmetric part.
        """
        return curvature(self, pose)

    def cost(self, function: str, effort: str = "quick") -> Cost:
        """Cost of a function in generated code.

        Args:
            function: Name of the function.
            effort: Effort of the search for fewer operations: "none", "quick" or "thorough".
        """
        return self.costs([function], effort)[function]

    def costs(self, functions: Iterable[str] | None = None, effort: str = "quick") -> dict[str, Cost]:
        """Cost of functions and of those that they call, in generated code.

        By default of all functions that are generated without a request.

        Groups are "control", "identification" and "kinematics".
        """
        names = None if functions is None else list(functions)
        document = json.loads(self._handle.costs(names, effort))
        return NamedFunctions({name: Cost._of(one["cost"]) for name, one in document.items()})

    def to_sympy(self, function: str, effort: str = "quick") -> Symbolic:
        """A function as SymPy expressions (``pip install "overact[sympy]"``).

        Args:
            function: Name of the function.
            effort: Effort of the search for fewer operations: "none", "quick" or "thorough".
        """
        names = {
            "pose": self.pose_coordinates,
            "twist": [f"v_{one}" for one in self.coordinates],
            "acceleration": [f"a_{one}" for one in self.coordinates],
            "joints": [f"q_{one}" for one in self.joint_names],
            "joint_velocities": [f"qd_{one}" for one in self.joint_names],
            "joint_accelerations": [f"qdd_{one}" for one in self.joint_names],
            "torques": [f"tau_{one}" for one in self.actuators],
            "parameters": [one.name for one in (*self.parameters, *self.payload_parameters)],
            "base_parameters": [one.name for one in (*self.base_parameters, *self.payload_parameters)],
        }
        from ._symbolic import _sympy

        _sympy()
        return Symbolic(function, self._handle.program(function, effort), names)

    # Values of parameters

    def parameter_vector(self, values: Mapping[str, float]) -> np.ndarray:
        """Converts standard parameters by name to the array that functions take as ``parameters``.

        The robot's parameters come first, then the payload's, which may be omitted together.

        Raises:
            ValueError: Unknown or missing names.
        """
        self._complete(values)
        names = [one.name for one in (*self.parameters, *self.payload_parameters)]
        return np.array([float(values.get(name, 0.0)) for name in names])

    def base_parameter_vector(self, values: Mapping[str, float]) -> np.ndarray:
        """Converts standard parameters by name to the array that functions take as ``base_parameters``.

        It contains the regrouped values of the base parameters, then the payload's.
        """
        self._complete(values)
        return np.array(self._handle.regrouped({name: float(one) for name, one in values.items()}))

    def _complete(self, values: Mapping[str, float]) -> None:
        own = [one.name for one in self.parameters]
        load = [one.name for one in self.payload_parameters]
        unknown = [name for name in values if name not in {*own, *load}]
        if unknown:
            raise ValueError(f"{self.name} has no parameters {', '.join(unknown)}")
        missing = [name for name in own if name not in values]
        lacking = [name for name in load if name not in values]
        if len(lacking) < len(load):
            missing += lacking
        if missing:
            raise ValueError(f"missing parameters: {', '.join(missing)}; write 0 for one that is absent")

    # Simulation and identification

    def simulate(
        self,
        runs: str | Iterable[str] | None = None,
        *,
        seed: int | None = None,
        parameters: Mapping[str, float] | None = None,
        progress: Callable[[float, str], None] | None = None,
    ) -> list[Run]:
        """Simulates the virtual experiment of the description.

        Args:
            runs: Names of the runs; all by default.
            seed: Seed of the noise; the description's by default.
            parameters: Standard parameters of the virtual robot by name (SI units); the description's by
                default.
            progress: Receives the completed fraction, from 0 to 1, and the name of a run.

        Returns:
            The runs, in order.

        Raises:
            DescriptionError, DataError: A missing or invalid experiment.
        """
        names = [runs] if isinstance(runs, str) else list(runs or ())
        given = None if parameters is None else {name: float(one) for name, one in parameters.items()}
        if given is not None:
            known = {one.name for one in (*self.parameters, *self.payload_parameters)}
            unknown = [name for name in given if name not in known]
            if unknown:
                raise ValueError(f"{self.name} has no parameters {', '.join(unknown)}")
        made, without_effect = self._handle.simulate(names, seed, given, progress)
        if without_effect:
            warnings.warn(f"without effect on the model: {', '.join(without_effect)}", stacklevel=2)
        return [
            Run(
                name=name,
                payload=payload,
                sampling=sampling,
                actuators=tuple(actuators),
                time=time,
                positions=positions,
                torques=torques,
                tracking_error=errors,
            )
            for name, payload, sampling, actuators, time, positions, torques, errors in made
        ]

    def identify(self, data: Any = None, **options: Any) -> Identification:
        """`overact.identify` of this robot."""
        from ._identify import identify

        return identify(self, data, **options)

    # How it is shown

    def drawing(self) -> str:
        """A drawing of the robot at its home configuration, SVG."""
        return self._handle.drawing()

    def __repr__(self) -> str:
        counts = [
            (len(self.parameters), "standard"),
            (len(self.base_parameters), "base"),
            (len(self.payload_parameters), "payload"),
        ]
        told = ", ".join(f"{count} {what}" for count, what in counts if count)
        return (
            f"<Robot {self.name}: r = {self.r}, n = {self.n}, {len(self.joint_names)} joints, "
            f"parameters: {told}>"
        )

    def _repr_html_(self) -> str:
        from html import escape

        return (
            f"<div><p><strong>{escape(self.name)}</strong> {escape(self.summary)}</p>"
            f'<div style="max-width: 32em">{self.drawing()}</div>'
            f"<p>{escape(repr(self))}</p></div>"
        )


def _rebuilt(text: str, name: str) -> Robot:
    return Robot.from_string(text, name)
