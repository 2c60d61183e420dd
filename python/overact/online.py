"""Estimation of parameters while data arrive, in bounded memory and time.

>>> filter = Filter.from_standard_deviations([0.0, 0.0], [10.0, 5.0])
>>> innovation = filter.update([9.81, 0.3], 5.2, 0.05)
>>> filter.estimate(), filter.covariance()

`Filter` estimates any parameters from rows of a regressor, `PayloadEstimator` mass, centre of mass and inertia
of a payload. `ChangeTest` detects changes in their innovations, `Whitening` removes the correlation of these.
`StateVariableFilter` gives velocities and accelerations of measured positions, and torques with equal delay.

Results are those of the Rust module `overact::online`. The last axes of an input are those of a sample, all axes
before are samples, which enter one after the other. An update that raises an error changes nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import real, shaped
from ._errors import DataError
from ._model import Parameter
from ._overact import OnlineChangeTest, OnlineFilter, OnlinePayload, OnlineSignals, OnlineWhitening

__all__ = [
    "ChangeTest",
    "Filter",
    "Innovation",
    "Payload",
    "PayloadEstimator",
    "Signal",
    "StateVariableFilter",
    "Whitening",
]

#: The ten inertial parameters of a body, in the order of `Payload.parameters`.
INERTIA = ("xx", "xy", "xz", "yy", "yz", "zz", "mx", "my", "mz", "m")

Rule = Literal["none", "exponential", "directional"]


@dataclass(frozen=True)
class Innovation:
    """Differences of measurements from their prediction by all samples before; arrays of the shape of y.

    Attributes:
        residual: y - w χ, in the unit of y.
        standard_deviation: That of the residual, from σ and the covariance of the parameters.
        normalised: The residual over its standard deviation: standard normal if model and σ are right.
        is_determined: Whether earlier rows determine a prediction. If not, the other numbers are zero.
    """

    residual: NDArray[np.float64]
    standard_deviation: NDArray[np.float64]
    normalised: NDArray[np.float64]
    is_determined: NDArray[np.bool_]


@dataclass(frozen=True)
class Payload:
    """A physically consistent payload.

    Attributes:
        mass: Mass, kg; positive.
        centre: Centre of mass in the body frame, m.
        inertia: Inertia tensor about the centre of mass, axes of the body frame, kg m².
        parameters: The ten inertial parameters about the body frame's origin, in the order of `INERTIA`.
        is_projected: Whether the unconstrained estimate belongs to no body, so that the nearest one is given.
    """

    mass: float
    centre: NDArray[np.float64]
    inertia: NDArray[np.float64]
    parameters: NDArray[np.float64]
    is_projected: bool


@dataclass(frozen=True)
class Signal:
    """A filtered signal and its derivatives; arrays of the shape of the samples.

    Attributes:
        value: The filtered signal.
        velocity: Its derivative, per second.
        acceleration: Its second derivative, per second squared.
    """

    value: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]


def _flat(array: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.ascontiguousarray(array).reshape(-1)


class _Estimator:
    """What a filter and a payload estimator have in common."""

    _inner: Any
    _parameters: int

    def _update(self, rows: ArrayLike, y: ArrayLike, sigma: ArrayLike, name: str) -> Innovation:
        all_rows = shaped(rows, "rows", (self._parameters,))
        sides = real(y, name)
        if sides.shape != all_rows.shape[:-1]:
            raise ValueError(
                f"`{name}` has the shape {sides.shape}, but `rows` needs {all_rows.shape[:-1]}: one number per row"
            )
        try:
            deviations = np.broadcast_to(real(sigma, "sigma"), sides.shape)
        except ValueError:
            raise ValueError(
                f"`sigma` has the shape {np.shape(sigma)}, which does not fit that of `{name}`, {sides.shape}"
            ) from None
        block = sides.shape[-1] if sides.ndim else 1
        found = self._inner.update(_flat(all_rows), _flat(sides), _flat(deviations), block)
        return Innovation(**{key: value.reshape(sides.shape) for key, value in found.items()})

    def set_forgetting(self, rule: Rule, factor: float = 1.0) -> None:
        """Sets how old information loses weight.

        Args:
            rule: "none", "exponential" (all information, once per sample) or "directional" (information along
                each row's direction, once per row).
            factor: Remaining weight, above 0 and at most 1. The weight of a row falls to 1/e after n updates
                with 1 - 1/n.

        Raises:
            DataError: A factor out of range.
        """
        if rule not in ("none", "exponential", "directional"):
            raise ValueError(f'rule="{rule}" is none of "none", "exponential", "directional"')
        self._inner.set_forgetting(rule, float(factor))

    def discount(self, factor: float) -> None:
        """Multiplies all information by a factor in (0, 1], for example after a detected change.

        The estimate stays the same. Standard deviations grow by 1/√factor, up to those of the prior.

        Raises:
            DataError: Another factor.
        """
        self._inner.discount(float(factor))

    def estimate(self) -> NDArray[np.float64]:
        """The estimated parameters.

        Raises:
            EvaluationError: Without prior, before the rows determine all parameters.
        """
        return self._inner.estimate()

    def covariance(self) -> NDArray[np.float64]:
        """The covariance of the estimate.

        Raises:
            EvaluationError: As `estimate`.
        """
        return self._inner.covariance().reshape(self._parameters, self._parameters)

    def standard_deviations(self) -> NDArray[np.float64]:
        """The standard deviations, in the units of the parameters.

        Raises:
            EvaluationError: As `estimate`.
        """
        return np.sqrt(np.diagonal(self.covariance()))


class Filter(_Estimator):
    """Square-root information filter: recursive least squares with prior, forgetting and covariance.

    Without forgetting, the estimate is that of batch least squares of the same rows.

    Args:
        parameters: Number of parameters. The filter knows nothing of them; the class methods give a prior.
    """

    def __init__(self, parameters: int) -> None:
        self._parameters = int(parameters)
        if self._parameters < 0:
            raise ValueError("`parameters` must not be negative")
        self._inner = OnlineFilter(self._parameters)

    @classmethod
    def from_square_root(cls, prior: ArrayLike, square_root_information: ArrayLike) -> Filter:
        """A filter with a prior estimate and a square root S of its information SᵀS.

        Raises:
            DataError: A singular S.
        """
        estimate = real(prior, "prior").reshape(-1)
        count = len(estimate)
        square_root = shaped(square_root_information, "square_root_information", (count, count))
        filter = cls.__new__(cls)
        filter._parameters = count
        filter._inner = OnlineFilter(count, (_flat(estimate), _flat(square_root)))
        return filter

    @classmethod
    def from_standard_deviations(cls, prior: ArrayLike, deviations: ArrayLike) -> Filter:
        """A filter with a prior of independent parameters with these standard deviations.

        Raises:
            DataError: Standard deviations that are not positive and finite.
        """
        estimate = real(prior, "prior").reshape(-1)
        given = shaped(deviations, "deviations", (len(estimate),))
        if not np.all((given > 0.0) & np.isfinite(given)):
            raise DataError("the prior: `deviations` must be positive and finite")
        return cls.from_square_root(estimate, np.diag(1.0 / given))

    @classmethod
    def from_covariance(cls, prior: ArrayLike, covariance: ArrayLike) -> Filter:
        """A filter with a prior estimate and its covariance, of which the lower triangle is read.

        Raises:
            DataError: A covariance that is not positive definite.
        """
        estimate = real(prior, "prior").reshape(-1)
        given = shaped(covariance, "covariance", (len(estimate), len(estimate)))
        try:
            root = np.linalg.inv(np.linalg.cholesky(given))
        except np.linalg.LinAlgError:
            raise DataError("the prior: `covariance` is not positive definite") from None
        return cls.from_square_root(estimate, root)

    @property
    def parameters(self) -> int:
        """Number of parameters."""
        return self._parameters

    def update(self, rows: ArrayLike, y: ArrayLike, sigma: ArrayLike) -> Innovation:
        """Adds rows W of a regressor and right sides y with y = W χ + e.

        Args:
            rows: (p,) is one row, (m, p) a sample of m rows, (N, m, p) N samples, one after the other.
            y: Right sides: a number, (m,) or (N, m).
            sigma: Standard deviation of e: a number, or of a shape that fits that of y.

        Returns:
            Innovations of the shape of y.

        Raises:
            EvaluationError: Numbers that are not finite or too large; the filter is then unchanged.
        """
        return self._update(rows, y, sigma, "y")

    def factor(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The upper triangle R and the right side z, with R χ = z."""
        numbers, count = self._inner.triangle(), self._parameters
        return numbers[: count * count].reshape(count, count), numbers[count * count :]

    def determined(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Estimates and standard deviations of the parameters that the rows determine; NaN for the others."""
        numbers = self._inner.determined()
        return numbers[: self._parameters], numbers[self._parameters :]

    def residual_deviation(self) -> float | None:
        """Standard deviation of the normalised residuals, which is 1 if every sigma is right."""
        return self._inner.residual_deviation()

    def __repr__(self) -> str:
        return f"<Filter of {self._parameters} parameters>"


class PayloadEstimator(_Estimator):
    """Estimator of a payload's inertial parameters with known parameters of the robot.

    Rows are those of the payload, `Robot.idm_red_payload`; residuals are y - W χ of the robot without payload. The
    prior is no payload, with the standard deviations `mass`, `mass` `length` and `mass` `length`² of masses, first
    moments and inertias.

    Args:
        columns: Inertial parameters of the columns, such as `Robot.payload_parameters` or "m" and "mx".
        mass: Largest expected mass, kg.
        length: Largest expected distance of its parts from the body frame's origin, m.

    Raises:
        DataError: Columns that are not different inertial parameters, or sizes that are not positive.
    """

    def __init__(self, columns: Iterable[str | Parameter], *, mass: float, length: float) -> None:
        names = [one if isinstance(one, str) else one.symbol for one in columns]
        self._columns = tuple(names)
        self._parameters = len(names)
        self._inner = OnlinePayload(names, float(mass), float(length))

    @property
    def columns(self) -> tuple[str, ...]:
        """Inertial parameters of the columns."""
        return self._columns

    def update(self, rows: ArrayLike, residuals: ArrayLike, sigma: ArrayLike) -> Innovation:
        """Adds samples.

        Args:
            rows: Columns of the payload: (m, p) of m torques, or (N, m, p) of N samples, one after the other.
            residuals: What the known robot leaves of the torques: (m,) or (N, m).
            sigma: Standard deviation of that without payload: a number, or of a shape that fits.

        Returns:
            Innovations of the shape of the residuals.

        Raises:
            EvaluationError: Numbers that are not finite or too large; the estimator is then unchanged.
        """
        return self._update(rows, residuals, sigma, "residuals")

    def payload(self) -> Payload:
        """The physically consistent payload nearest to the estimate, in the metric of the information.

        Raises:
            EvaluationError: An estimate that overflows.
        """
        numbers, is_projected = self._inner.payload()
        parameters = np.array(numbers)
        xx, xy, xz, yy, yz, zz = parameters[:6]
        mass = float(parameters[9])
        centre = parameters[6:9] / mass
        about_origin = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        # Steiner's theorem.
        inertia = about_origin - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        return Payload(mass, centre, inertia, parameters, is_projected)

    def __repr__(self) -> str:
        return f"<PayloadEstimator of {', '.join(self._columns)}>"


class ChangeTest:
    """Two-sided CUSUM test for a change of the mean of normalised innovations.

    Args:
        shift: Shift to detect, in standard deviations, from 0.01 to 100.
        samples: Mean number of samples between false alarms, from 10 to 1e15.

    Raises:
        DataError: Numbers out of range.
    """

    def __init__(self, shift: float, samples: float) -> None:
        self._inner = OnlineChangeTest(float(shift), float(samples))

    @property
    def threshold(self) -> float:
        """Threshold of the sums."""
        return self._inner.threshold()

    def update(self, normalised: float) -> Literal["increase", "decrease"] | None:
        """Adds a normalised innovation; returns the direction of a detected change.

        A number that is not finite is left out.
        """
        return self._inner.update(float(normalised))

    def reset(self) -> None:
        """Sets both sums to zero."""
        self._inner.reset()


class Whitening:
    """Removes the correlation between successive innovations, which it estimates on the way."""

    def __init__(self) -> None:
        self._inner = OnlineWhitening()

    @property
    def correlation(self) -> float:
        """Correlation of successive numbers."""
        return self._inner.correlation()

    def update(self, normalised: ArrayLike) -> NDArray[np.float64]:
        """Whitens numbers, one after the other; zero for one that is not finite, which is left out."""
        given = real(normalised, "normalised")
        numbers = np.array(given, order="C").reshape(-1)
        self._inner.update(numbers)
        return numbers.reshape(given.shape)


class StateVariableFilter:
    """Butterworth low-pass filter whose states are the filtered signal and its exact derivatives.

    Use equal filters for positions and torques: delay and attenuation are then equal.

    Args:
        order: Order, from 3 to 8.
        cutoff: Cutoff, Hz.
        sampling: Sampling frequency, Hz.
        signals: Number of signals of a sample; without it, a sample is a number.

    Raises:
        DataError: A cutoff outside 1e-5 to 0.45 of the sampling frequency, or another order.
    """

    def __init__(self, order: int, cutoff: float, sampling: float, signals: int | None = None) -> None:
        self._shape = () if signals is None else (int(signals),)
        count = 1 if signals is None else int(signals)
        if count < 0:
            raise ValueError("`signals` must not be negative")
        self._inner = OnlineSignals(int(order), float(cutoff), float(sampling), count)

    @property
    def delay(self) -> float:
        """Delay of signals far below the cutoff, s."""
        return self._inner.delay()

    def update(self, samples: ArrayLike) -> Signal:
        """Filters samples, one after the other. The filter starts at rest at the first one.

        Args:
            samples: A sample, or (N,) or (N, signals) of N samples.

        Raises:
            EvaluationError: Numbers that are not finite; the filter is then unchanged.
        """
        given = shaped(samples, "samples", self._shape) if self._shape else real(samples, "samples")
        found = self._inner.update(_flat(given))
        return Signal(*(numbers.reshape(given.shape) for numbers in found))

    def restart(self, values: ArrayLike) -> None:
        """Sets the filter to rest at the values of a sample."""
        given = np.broadcast_to(real(values, "values"), self._shape or (1,))
        self._inner.restart(_flat(given))
