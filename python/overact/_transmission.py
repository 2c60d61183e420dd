"""Transmissions between motors and joints at a pose: motion, torques, gains and limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import real, shaped
from ._errors import DataError, EvaluationError

if TYPE_CHECKING:
    from ._robot import Robot

Array = NDArray[np.float64]

#: A Jacobian whose condition number exceeds this counts as singular.
LARGEST_CONDITION = 1e9
#: Smallest length of a column, relative to the longest, by which a joint is scaled.
SMALLEST_SCALE = 1e-5
#: Smallest eigenvalue of the normal matrix of independent gains.
SMALLEST_EIGENVALUE = 1e-9


def _transposed(matrix: Array) -> Array:
    return np.swapaxes(matrix, -1, -2)


def _times(matrix: Array, vector: Array) -> Array:
    return np.einsum("...ij,...j->...i", matrix, vector)


def _first(is_bad: NDArray[np.bool_]) -> int:
    """Index of the first sample with a fault."""
    return int(np.argmax(np.reshape(is_bad, -1)))


class Transmission:
    """Transmission between n motors and r joints at one or many poses.

    "Joints" are the coordinates of the twist: joints of a skeleton, or coordinates of a platform. All axes before
    the last ones are samples, as in the functions of a robot: of N poses, torques are (N, n) or, for all, (n,).

    >>> ankle = overact.Robot("robots/ankle.toml")
    >>> transmission = ankle.transmission([0.1, -0.05])
    >>> motors = transmission.motor_torques([20.0, 0.0])

    Args:
        jacobian: `inverse_jacobian` of the poses, n x r: motor velocities per joint velocity.

    Raises:
        EvaluationError: Motors that do not determine all joints, or numbers that are not finite.
    """

    def __init__(self, jacobian: ArrayLike) -> None:
        given = np.array(real(jacobian, "jacobian"))
        if given.ndim < 2:
            raise ValueError(f"`jacobian` has the shape {given.shape}, but needs motors x joints as its last axes")
        self._jacobian = given
        self._check("jacobian", given, 2)
        scales = self._scales()
        motors, joints = given.shape[-2:]
        if motors < joints:
            raise self._singular(0, np.inf)
        if joints == 0:
            self._inverse, self._condition = _transposed(given), np.ones(given.shape[:-2])
            return
        is_zero = (scales <= 0.0).any(axis=-1)
        if is_zero.any():
            raise self._singular(_first(is_zero), np.inf)
        left, values, right = np.linalg.svd(given / scales[..., None, :], full_matrices=False)
        with np.errstate(divide="ignore", over="ignore"):
            condition = np.sqrt((values**2).sum(-1) * (values**-2.0).sum(-1)) / joints
        is_singular = ~(condition < LARGEST_CONDITION)
        if is_singular.any():
            sample = _first(is_singular)
            raise self._singular(sample, float(np.reshape(condition, -1)[sample]))
        inverse = _transposed(right) / values[..., None, :] @ _transposed(left)
        self._inverse = inverse / scales[..., :, None]
        self._condition = condition

    def _singular(self, sample: int, condition: float) -> EvaluationError:
        reason = "the motors do not determine all joints here"
        if np.isfinite(condition):
            reason += f": the Jacobian has the condition number {condition:.1e}"
        return EvaluationError(f"transmission: sample {sample}: {reason}", sample, reason)

    def _scales(self) -> Array:
        lengths = np.sqrt((self._jacobian**2).sum(-2))
        return np.maximum(lengths, SMALLEST_SCALE * lengths.max(-1, initial=0.0)[..., None])

    @staticmethod
    def _check(name: str, array: Array, axes: int) -> None:
        is_bad = ~np.isfinite(array).all(axis=tuple(range(-axes, 0)))
        if is_bad.any():
            sample, reason = _first(is_bad), f"`{name}` has a number that is not finite"
            raise EvaluationError(f"transmission: sample {sample}: {reason}", sample, reason)

    def _given(self, value: ArrayLike, name: str, *last: int) -> Array:
        array = shaped(value, name, last)
        self._check(name, array, len(last))
        return array

    # The Jacobian

    @property
    def motors(self) -> int:
        """Number of motors."""
        return self._jacobian.shape[-2]

    @property
    def joints(self) -> int:
        """Number of joints."""
        return self._jacobian.shape[-1]

    @property
    def jacobian(self) -> Array:
        """J, n x r: motor velocities per joint velocity."""
        return self._jacobian

    @property
    def inverse(self) -> Array:
        """J⁺, the pseudo-inverse, r x n."""
        return self._inverse

    @property
    def condition(self) -> Array:
        """Condition number of J with columns scaled to the length 1; at least 1."""
        return self._condition

    def is_in_mode_of(self, home: Transmission) -> NDArray[np.bool_]:
        """Whether no singularity separates the poses from home.

        Beyond a singularity two poses have the same motor positions, so forward kinematics from home finds another
        one.
        """
        sign, _ = np.linalg.slogdet(home.inverse @ self._jacobian)
        return sign > 0.0

    # Motion and torques

    def motor_velocities(self, joint_velocities: ArrayLike) -> Array:
        """Velocities of the motors, J v."""
        return _times(self._jacobian, self._given(joint_velocities, "joint_velocities", self.joints))

    def joint_velocities(self, motor_velocities: ArrayLike) -> Array:
        """Velocities of the joints, J⁺ q̇: least squares with more motors than joints."""
        return _times(self._inverse, self._given(motor_velocities, "motor_velocities", self.motors))

    def motor_accelerations(self, joint_accelerations: ArrayLike, bias: ArrayLike) -> Array:
        """Accelerations of the motors, J v̇ + J̇ v; `bias` is J̇ v, `Robot.transmission_bias`."""
        given = self._given(joint_accelerations, "joint_accelerations", self.joints)
        return _times(self._jacobian, given) + self._given(bias, "bias", self.motors)

    def joint_accelerations(self, motor_accelerations: ArrayLike, bias: ArrayLike) -> Array:
        """Accelerations of the joints, J⁺ (q̈ - J̇ v); `bias` is J̇ v, `Robot.transmission_bias`."""
        given = self._given(motor_accelerations, "motor_accelerations", self.motors)
        return _times(self._inverse, given - self._given(bias, "bias", self.motors))

    def joint_torques(self, motor_torques: ArrayLike) -> Array:
        """Torques that the joints receive from motor torques, Jᵀ τ."""
        given = self._given(motor_torques, "motor_torques", self.motors)
        return _times(_transposed(self._jacobian), given)

    def motor_torques(self, joint_torques: ArrayLike) -> Array:
        """Motor torques of least norm that give joint torques, J⁺ᵀ τ."""
        given = self._given(joint_torques, "joint_torques", self.joints)
        return _times(_transposed(self._inverse), given)

    # Inertia, gains and stiffness

    def _congruence(self, diagonal: Array) -> Array:
        return _transposed(self._jacobian) @ (diagonal[..., :, None] * self._jacobian)

    def reflected_inertia(self, rotor_inertias: ArrayLike) -> Array:
        """Inertia of the rotors as the joints feel it, Jᵀ diag(I) J, r x r; I are those after the gear."""
        return self._congruence(self._given(rotor_inertias, "rotor_inertias", self.motors))

    def joint_gains(self, motor_gains: ArrayLike) -> Array:
        """Joint gains Jᵀ diag(k) J of position or velocity gains k of the motors, r x r."""
        return self._congruence(self._given(motor_gains, "motor_gains", self.motors))

    def motor_gains(self, joint_gains: ArrayLike) -> Array:
        """Motor gains J⁺ᵀ K J⁺ of joint gains K, n x n: each motor's torque depends on all errors."""
        given = self._given(joint_gains, "joint_gains", self.joints, self.joints)
        return _transposed(self._inverse) @ given @ self._inverse

    def _geometric(self, motor_torques: ArrayLike, curvature: ArrayLike) -> Array:
        torques = self._given(motor_torques, "motor_torques", self.motors)
        second = self._given(curvature, "curvature", self.motors, self.joints, self.joints)
        return np.einsum("...a,...aij->...ij", torques, second)

    def joint_stiffness(self, motor_gains: ArrayLike, motor_torques: ArrayLike, curvature: ArrayLike) -> Array:
        """Joint stiffness Jᵀ diag(k) J - Σ τ H of position gains k under motor torques τ, r x r.

        H is `Robot.curvature` of the pose, n x r x r.
        """
        return self.joint_gains(motor_gains) - self._geometric(motor_torques, curvature)

    def motor_stiffness(self, joint_stiffness: ArrayLike, motor_torques: ArrayLike, curvature: ArrayLike) -> Array:
        """Position gains of the motors for a joint stiffness under motor torques; inverse of `joint_stiffness`."""
        given = self._given(joint_stiffness, "joint_stiffness", self.joints, self.joints)
        return self.motor_gains(given + self._geometric(motor_torques, curvature))

    def diagonal_motor_gains(self, joint_gains: ArrayLike) -> Array:
        """Gains k of independent drives whose joint gains Jᵀ diag(k) J are nearest to K.

        Least squares over the entries, with joints scaled by the lengths of their columns of J. Gains may be
        negative if K cannot be approximated otherwise.

        Raises:
            DataError: Several motors that act alike, or more than r (r + 1)/2 motors.
        """
        given = self._given(joint_gains, "joint_gains", self.joints, self.joints)
        scales = self._scales()
        scaled = self._jacobian / scales[..., None, :]
        wanted = given / (scales[..., :, None] * scales[..., None, :])
        squares = (scaled**2).sum(-1)
        if (squares <= 0.0).any():
            raise DataError("transmission: a motor has no effect on the joints, so its gain is not determined")
        # The matrices of two motors have the scalar product (J_a J_bᵀ)².
        products = (scaled @ _transposed(scaled)) ** 2 / (squares[..., :, None] * squares[..., None, :])
        if (np.linalg.eigvalsh(products)[..., :1] < SMALLEST_EIGENVALUE).any():
            raise DataError(
                "transmission: several choices of motor gains have the same effect on the joints: "
                "give all gains but one of each such group"
            )
        right = np.einsum("...ai,...ij,...aj->...a", scaled, wanted, scaled) / squares
        return np.linalg.solve(products, right[..., None])[..., 0] / squares

    # Limits

    def _limits(self, value: ArrayLike, name: str) -> Array:
        """Limits as least and most, n x 2."""
        given = real(value, name)
        if given.shape == (self.motors,):
            given = np.stack([-given, given], axis=-1)
        if given.shape != (self.motors, 2):
            raise ValueError(
                f"`{name}` has the shape {given.shape}; expected is ({self.motors},) for limits in both directions, "
                f"or ({self.motors}, 2) for least and most"
            )
        if not ((given[:, 0] <= 0.0) & (given[:, 1] >= 0.0)).all():
            raise DataError(f"transmission: `{name}` must be intervals that contain zero")
        return given

    @staticmethod
    def _along(vectors: Array, limits: Array) -> Array:
        """Least and most factors by which vectors on the last axis are within the limits."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = limits / vectors[..., None]
        ends = np.where(vectors[..., None] < 0.0, ends[..., ::-1], ends)
        ends = np.where(vectors[..., None] == 0.0, [-np.inf, np.inf], ends)
        return np.stack([ends[..., 0].max(-1), ends[..., 1].min(-1)], axis=-1)

    def _direction(self, value: ArrayLike) -> Array:
        given = self._given(value, "direction", self.joints)
        if not (given != 0.0).any(axis=-1).all():
            raise DataError("transmission: `direction` must be different from zero")
        return given

    def speed_intervals(self, motor_speeds: ArrayLike) -> Array:
        """Least and most speed of each joint, r x 2, within the speed limits of the motors, if the others rest.

        Args:
            motor_speeds: (n,) for limits in both directions, or (n, 2) for least and most. inf means no limit.

        Raises:
            DataError: Limits that do not contain zero.
        """
        return self._along(_transposed(self._jacobian), self._limits(motor_speeds, "motor_speeds"))

    def torque_intervals(self, motor_torques: ArrayLike) -> Array:
        """Least and most torque of each joint, r x 2, within the torque limits of the motors, if the others have
        none; with torques of least norm. Limits are given as in `speed_intervals`."""
        return self._along(self._inverse, self._limits(motor_torques, "motor_torques"))

    def speed_factor(self, direction: ArrayLike, motor_speeds: ArrayLike) -> Array:
        """Largest factor s by which joint speeds s d are within the limits of all motors."""
        vectors = _times(self._jacobian, self._direction(direction))
        return self._along(vectors, self._limits(motor_speeds, "motor_speeds"))[..., 1]

    def torque_factor(self, direction: ArrayLike, motor_torques: ArrayLike) -> Array:
        """Largest factor s by which joint torques s d are within the limits of all motors, with the least norm."""
        vectors = _times(_transposed(self._inverse), self._direction(direction))
        return self._along(vectors, self._limits(motor_torques, "motor_torques"))[..., 1]

    def __repr__(self) -> str:
        samples = self._jacobian.shape[:-2]
        at = f" at {int(np.prod(samples))} poses" if samples else ""
        return f"<Transmission of {self.motors} motors and {self.joints} joints{at}>"


def bias(robot: Robot, pose: ArrayLike, twist: ArrayLike) -> Array:
    """J̇ v of the motors."""
    velocities = real(twist, "twist")
    if "joint_accelerations" not in robot.functions:
        # The motors of a robot without loops are on its coordinates, or geared to them by constant ratios.
        shape = np.broadcast_shapes(real(pose, "pose").shape[:-1], velocities.shape[:-1])
        return np.zeros((*shape, robot.n))
    joints = robot.joint_accelerations(pose, velocities, np.zeros(robot.r))
    found = np.zeros((*joints.shape[:-1], robot.n))
    for actuator, terms in enumerate(robot._info["actuator_joints"]):
        for joint, factor in terms:
            found[..., actuator] += factor * joints[..., joint]
    return found


def curvature(robot: Robot, pose: ArrayLike) -> Array:
    """Derivative of the Jacobian at a pose, from accelerations of the motors at r (r + 1)/2 twists."""
    r, unit = robot.r, np.eye(robot.r)
    given = real(pose, "pose")
    found = np.zeros((*given.shape[:-1], robot.n, r, r))

    def at(twist: Array) -> Array:
        return bias(robot, given, np.broadcast_to(twist, (*given.shape[:-1], r)))

    for i in range(r):
        found[..., i, i] = at(unit[i])
    for i in range(r):
        for j in range(i):
            mixed = 0.5 * (at(unit[i] + unit[j]) - found[..., i, i] - found[..., j, j])
            found[..., i, j] = found[..., j, i] = mixed
    return found
