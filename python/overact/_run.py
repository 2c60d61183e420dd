"""Runs: motion and torque of all actuators over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Sequence

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Run:
    """A measured or virtual run, uniformly sampled.

    Attributes:
        name: Name of the run.
        positions: Positions of the actuators, N x n (rad, m).
        torques: Torques and forces of the actuators, N x n (N m, N).
        sampling: Sampling frequency (Hz).
        payload: Whether the platform carried the payload.
        velocities: Measured velocities of the actuators, N x n (rad/s, m/s), or None.
        time: Time of each sample, N (s).
        actuators: Names of the actuators.
        tracking_error: Largest tracking errors of a virtual run, n (rad, m).
    """

    name: str
    positions: NDArray[np.float64]
    torques: NDArray[np.float64]
    sampling: float
    payload: bool = False
    velocities: NDArray[np.float64] | None = None
    time: NDArray[np.float64] | None = None
    actuators: Sequence[str] = ()
    tracking_error: NDArray[np.float64] | None = field(default=None, repr=False)

    def to_dict(self) -> dict[str, NDArray[np.float64]]:
        """Columns of the log that ``overact simulate`` writes: ``time``, ``q_ACTUATOR``, ``tau_ACTUATOR``.

        ``pandas.DataFrame(run.to_dict())`` is its data frame.
        """
        count, n = self.positions.shape
        time = np.arange(count) / self.sampling if self.time is None else self.time
        actuators = self.actuators or [str(at + 1) for at in range(n)]
        columns = {"time": time}
        for prefix, values in (("q_", self.positions), ("tau_", self.torques)):
            for at, actuator in enumerate(actuators):
                columns[prefix + actuator] = values[:, at]
        return columns

    def __len__(self) -> int:
        return len(self.positions)

    def __repr__(self) -> str:
        seconds = len(self) / self.sampling
        payload = ", with the payload" if self.payload else ""
        return (
            f"<run {self.name}: {len(self)} samples at {self.sampling:g} Hz ({seconds:g} s) of "
            f"{self.positions.shape[1]} actuators{payload}>"
        )
