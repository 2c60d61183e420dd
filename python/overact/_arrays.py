"""Arrays of real numbers from what callers give."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def real(value: Any, name: str) -> NDArray[np.float64]:
    """The numbers of a value as float64; `name` is the argument in errors.

    Raises:
        TypeError: A value that is not an array of real numbers.
    """
    if np.ma.isMaskedArray(value):
        raise TypeError(f"`{name}` is a masked array; fill it first, `{name}.filled(...)`")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise TypeError(f"`{name}` is not an array of numbers: {error}") from None
    if array.dtype.kind not in "fiub":
        raise TypeError(f"`{name}` has the dtype {array.dtype}; expected are real numbers (float64)")
    return array.astype(np.float64, copy=False)


def shaped(value: Any, name: str, last: tuple[int, ...]) -> NDArray[np.float64]:
    """The numbers of a value whose last axes have these lengths.

    Raises:
        ValueError: Another shape.
    """
    array = real(value, name)
    if array.shape[-len(last) :] != last or array.ndim < len(last):
        one = f"({last[0]},)" if len(last) == 1 else str(last)
        raise ValueError(f"`{name}` has the shape {array.shape}, but its last axes must be {one}")
    return array
