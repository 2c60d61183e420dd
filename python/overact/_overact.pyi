"""The compiled part of the package. Functions of a `Robot` are `Function` objects; the rest is internal."""

from typing import Any, Callable, Literal, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Function:
    """A function of a robot, callable with arrays of one or many samples."""

    def __call__(
        self,
        *arguments: ArrayLike,
        out: NDArray[np.float64] | None = None,
        start: ArrayLike | None = None,
        invalid: Literal["raise", "nan"] = "raise",
        **named: ArrayLike,
    ) -> NDArray[np.float64]:
        """Evaluates the function.

        Args:
            arguments: Inputs in order, or by name. The last axis of each array has the numbers of a
                sample, all axes before are samples. An input of one axis is used for all samples.
                Contiguous float64 is read in place; other real numbers and layouts are converted.
            out: A contiguous float64 array of the result's shape for the result.
            start: For functions from actuators: start pose of the first sample.
            invalid: Treatment of samples without a value (unreachable, singular, not finite): an
                `EvaluationError` with the first one, or rows of NaN.

        Returns:
            The results: the axes of the samples, then `shape`.
        """

    @property
    def name(self) -> str:
        """Name of the function, as in generated code."""
    @property
    def summary(self) -> str:
        """Result of the function, with its equation."""
    @property
    def inputs(self) -> dict[str, int]:
        """Inputs in order, with their length in a sample."""
    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the output at a sample."""
    @property
    def columns(self) -> list[str]:
        """Names of the parameters of its columns; empty if it is not a regressor."""
    @property
    def signature(self) -> str:
        """The function with its inputs and shapes."""

class Identified:
    def json(self) -> str: ...
    def json_with_figures(self) -> str: ...
    def html(self) -> str: ...
    def csv(self) -> str: ...
    def summary(self) -> str: ...
    def tables(self) -> str: ...
    def parameters_toml(self) -> str | None: ...
    def calibrated_description(self) -> str | None: ...
    def trusted(self) -> bool: ...

class Handle:
    @staticmethod
    def from_file(path: str) -> Handle: ...
    @staticmethod
    def from_text(text: str, name: str) -> Handle: ...
    @property
    def text(self) -> str: ...
    @property
    def file(self) -> str: ...
    def info(self) -> str: ...
    def function_names(self) -> list[str]: ...
    def function(self, name: str) -> Function: ...
    def costs(self, functions: list[str] | None = None, effort: str = "quick") -> str: ...
    def program(self, name: str, effort: str = "quick") -> dict[str, Any]: ...
    def pose_from_actuators(
        self, actuators: ArrayLike, start: ArrayLike | None = None, out: NDArray[np.float64] | None = None
    ) -> NDArray[np.float64]: ...
    def regrouped(self, values: dict[str, float]) -> list[float]: ...
    def drawing(self) -> str: ...
    def simulate(
        self,
        runs: list[str],
        seed: int | None = None,
        parameters: dict[str, float] | None = None,
        progress: Callable[[float, str], None] | None = None,
    ) -> tuple[list[tuple[Any, ...]], list[str]]: ...
    def identify(
        self, runs: Sequence[tuple[Any, ...]], validation: Sequence[tuple[Any, ...]], options: dict[str, Any]
    ) -> Identified: ...

def columns(table: Any) -> tuple[dict[str, NDArray[np.float64]], dict[str, str]]: ...
def command(arguments: list[str]) -> int: ...
def known_functions() -> list[tuple[str, list[str], tuple[str, str | None], str]]: ...
