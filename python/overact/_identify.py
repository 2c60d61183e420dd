"""Parameters of a robot from measured or virtual runs."""

from __future__ import annotations

import os
from typing import Any, Callable, Iterable, Mapping, Sequence

import numpy as np

from ._errors import DataError
from ._overact import columns as _columns_of_arrow
from ._result import Identification
from ._robot import Robot
from ._run import Run

#: Tolerance of time steps, relative to the usual one.
_UNIFORM = 1e-3


def identify(
    robot: Robot,
    data: Any = None,
    *,
    payload_data: Any = None,
    validation: Any = None,
    payload_validation: Any = None,
    held_out: Iterable[str] | None = None,
    seed: int | None = None,
    kept: Iterable[str] | None = None,
    friction: str | None = None,
    calibrate: bool | str | None = None,
    gains: bool | None = None,
    checks: str = "all",
    tracking: bool | None = None,
    published: str | os.PathLike[str] | None | bool = None,
    progress: Callable[[float, str], None] | None = None,
) -> Identification:
    """Identifies the dynamic parameters of a robot from runs, with the settings of its description.

    A run has one of these forms; several runs are a list:

    - a `Run` from `Robot.simulate`;
    - the path of a log (``"a.csv+b.csv"`` is one run in two files);
    - a data frame or table with Arrow's interface (pandas, Polars, PyArrow). Its columns are those of
      ``[data]`` in the description, else ``time``, ``q_ACTUATOR``, ``tau_ACTUATOR``;
    - a mapping of such names to arrays; a matrix ``q`` has columns ``q(:,1)`` and so on;
    - a mapping with ``positions`` and ``torques`` as N x n arrays in SI units (rad or m, N m or N), and
      ``sampling`` (Hz) or ``time`` (s). ``velocities``, ``name`` and ``payload`` are optional.

    Args:
        robot: The robot.
        data: Training runs. Without any, the virtual experiment is simulated.
        payload_data: Training runs with the payload on the platform.
        validation: Validation runs.
        payload_validation: Validation runs with the payload.
        held_out: Names of the virtual experiment's validation runs.
        seed: Seed of the virtual experiment's noise.
        kept: Names of the actuators that the actuator projection (case 2) keeps.
        friction: "symmetric" or "asymmetric".
        calibrate: Encoder offsets and lengths first: "smallest" (or True), "offsets" or "all".
        gains: Whether drive gains are identified first.
        checks: "all", or "basic" for those of the raw samples and residuals only, which take less time.
        tracking: Whether the virtual robot follows the validation runs with the result. By default, if
            runs are virtual and there are published results.
        published: Published results for comparison. By default ``published/NAME.toml`` next to the
            description, if it exists; False for none.
        progress: Receives the completed fraction, from 0 to 1, and the current work.

    Raises:
        DataError: Runs or settings that cannot be used, or data that determine no parameter.
        DescriptionError: An invalid virtual experiment.
    """
    if not isinstance(robot, Robot):
        raise TypeError(f"`robot` is a {type(robot).__name__}: give a Robot, as Robot(\"my.toml\") makes it")
    own = [*_runs(robot, data, False, "data"), *_runs(robot, payload_data, True, "payload_data")]
    others = [
        *_runs(robot, validation, False, "validation"),
        *_runs(robot, payload_validation, True, "payload_validation"),
    ]
    if others and not own:
        raise ValueError(
            "there are validation runs but no training runs; name validation runs of a virtual experiment "
            "with held_out=[...]"
        )
    if own and (seed is not None or held_out is not None):
        raise ValueError("seed and held_out are for the virtual experiment, but there is data")
    options = {
        "held_out": [held_out] if isinstance(held_out, str) else list(held_out or ()),
        "seed": seed,
        "kept": None if kept is None else [kept] if isinstance(kept, str) else list(kept),
        "friction": friction,
        "calibrate": "smallest" if calibrate is True else calibrate or None,
        "gains": gains,
        "checks": checks,
        "tracking": tracking,
        "published": _published(robot, published),
        "progress": progress,
    }
    handle = robot._handle.identify(own, others, options)
    files = [one[2] for one in (*own, *others) if one[0] == "file"]
    return Identification(handle, (robot.file, *files))


def _published(robot: Robot, given: str | os.PathLike[str] | None | bool) -> str | None:
    if given is False:
        return None
    if given is None or given is True:
        folder, name = os.path.split(robot.file)
        beside = os.path.join(folder, "published", name)
        return beside if os.path.isfile(beside) else None
    return os.fspath(given)


def _runs(robot: Robot, data: Any, payload: bool, label: str) -> list[tuple]:
    """Converts runs for the compiled part."""
    if data is None:
        return []
    if isinstance(data, (list, tuple)):
        return [_run(robot, one, payload, f"{label}[{at}]") for at, one in enumerate(data)]
    return [_run(robot, data, payload, label)]


def _run(robot: Robot, item: Any, payload: bool, label: str) -> tuple:
    if isinstance(item, Run):
        velocities = None if item.velocities is None else _matrix(item.velocities, label)
        return (
            "samples",
            item.payload or payload,
            item.name,
            float(item.sampling),
            _matrix(item.positions, f"{label}.positions"),
            _matrix(item.torques, f"{label}.torques"),
            velocities,
        )
    if isinstance(item, (str, os.PathLike)):
        return ("file", payload, os.fspath(item))
    if isinstance(item, Mapping):
        return _of_mapping(robot, item, payload, label)
    if hasattr(item, "__arrow_c_stream__") or hasattr(item, "__arrow_c_array__"):
        return ("arrays", payload, label, _of_table(robot, item, label))
    raise TypeError(
        f"`{label}` is a {type(item).__name__}, which is not a run: give a path, a Run, a mapping of arrays, or "
        "a data frame with Arrow's interface"
    )


def _of_mapping(robot: Robot, item: Mapping[str, Any], payload: bool, label: str) -> tuple:
    if not {"positions", "torques"} <= item.keys():
        arrays = [_array(name, one, label) for name, one in item.items()]
        return ("arrays", payload, label, arrays)
    positions = _matrix(item["positions"], f"{label}['positions']")
    torques = _matrix(item["torques"], f"{label}['torques']")
    velocities = item.get("velocities")
    if velocities is not None:
        velocities = _matrix(velocities, f"{label}['velocities']")
    for name, one in (("positions", positions), ("torques", torques), ("velocities", velocities)):
        if one is not None and one.shape != (len(positions), robot.n):
            wanted = f"({len(positions)}, {robot.n})"
            raise DataError(f"`{label}['{name}']` has the shape {one.shape}, expected {wanted}")
    return (
        "samples",
        bool(item.get("payload", payload)),
        str(item.get("name", label)),
        _sampling(item, len(positions), label),
        positions,
        torques,
        velocities,
    )


def _sampling(item: Mapping[str, Any], samples: int, label: str) -> float:
    """Sampling frequency, Hz."""
    if "sampling" in item:
        return float(item["sampling"])
    if "time" not in item:
        raise DataError(f"`{label}` has neither `sampling` (Hz) nor `time` (s)")
    time = np.asarray(item["time"], dtype=np.float64)
    if time.shape != (samples,) or samples < 2:
        raise DataError(f"`{label}['time']` has the shape {time.shape}, expected ({samples},)")
    step = (time[-1] - time[0]) / (samples - 1)
    if not (step > 0 and np.all(np.abs(np.diff(time) - step) <= _UNIFORM * step)):
        raise DataError(
            f"`{label}['time']` does not step uniformly; give the columns by their names, and `resample` "
            "in the table [data] of the description"
        )
    return float(1.0 / step)


def _of_table(robot: Robot, table: Any, label: str) -> list[tuple]:
    """Columns of a table with Arrow's interface."""
    try:
        numbers, others = _columns_of_arrow(table)
    except ImportError:
        # pandas needs PyArrow for Arrow's interface; its columns can be read without.
        names = [name for name in table.columns if np.asarray(table[name]).dtype.kind in "fiub"]
        numbers = {str(name): np.asarray(table[name], dtype=np.float64) for name in names}
        others = {str(name): str(table[name].dtype) for name in table.columns if name not in names}
    for name in robot._info["columns"]:
        if name in others:
            raise DataError(f"column `{name}` of `{label}` has {others[name]}")
    return [_array(name, one, label) for name, one in numbers.items()]


def _array(name: str, value: Any, label: str) -> tuple:
    """Name, rows, columns, and the numbers in column-major order."""
    array = np.asarray(value)
    if np.ma.isMaskedArray(value) or array.dtype.kind not in "fiub":
        raise TypeError(f"`{label}['{name}']` has the dtype {array.dtype}, not real numbers")
    if array.ndim > 2:
        raise DataError(f"`{label}['{name}']` has {array.ndim} axes; give vectors or matrices")
    rows, columns = (*array.shape, 1, 1)[:2]
    flat = np.ascontiguousarray(array.T, dtype=np.float64).reshape(-1)
    return (str(name), rows, columns, flat)


def _matrix(value: Any, label: str) -> np.ndarray:
    array = np.asarray(value)
    if np.ma.isMaskedArray(value) or array.dtype.kind not in "fiub":
        raise TypeError(f"`{label}` has the dtype {array.dtype}, not real numbers")
    if array.ndim == 1:
        array = array[:, None]
    if array.ndim != 2:
        raise DataError(f"`{label}` has {array.ndim} axes; expected are samples x actuators")
    return np.ascontiguousarray(array, dtype=np.float64)


__all__: Sequence[str] = ["identify"]
