"""Exceptions of the package."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Iterable


@dataclass(frozen=True)
class Problem:
    """One problem.

    Attributes:
        message: The problem, in one sentence.
        file: File name as given, or the name of a run.
        line: Line, counted from 1.
        column: Number of a character, counted from 1, or the name of a column of a table.
        help: Advice.
        code: Code under which `overact explain` has cause and remedy, such as `OA302`; empty for
            problems of the package itself.
    """

    message: str
    file: str | None = None
    line: int | None = None
    column: int | str | None = None
    help: str | None = None
    code: str = ""


class OveractError(Exception):
    """An error of overact, with all problems at once.

    Attributes:
        problems: All problems, each with its location and advice.
    """

    def __init__(self, message: str, problems: Iterable[tuple] = ()) -> None:
        super().__init__(message)
        self.problems: tuple[Problem, ...] = tuple(Problem(*one) for one in problems)

    def _first(self, attribute: str):
        return getattr(self.problems[0], attribute) if self.problems else None

    @property
    def file(self) -> str | None:
        """The file of the first problem."""
        return self._first("file")

    @property
    def line(self) -> int | None:
        """Line of the first problem, counted from 1."""
        return self._first("line")

    @property
    def column(self) -> int | str | None:
        """Position of the first problem in its line."""
        return self._first("column")

    @property
    def help(self) -> str | None:
        """Advice on the first problem."""
        return self._first("help")


class DescriptionError(OveractError, ValueError):
    """An invalid description: every error with its line."""


class DataError(OveractError, ValueError):
    """Files, logs or settings that cannot be used."""


class EvaluationError(OveractError, ArithmeticError):
    """A state at which a function has no value: unreachable, singular or not finite.

    Attributes:
        sample: Index of the first such sample, counted from 0 through all axes but the last.
        reason: The reason.
    """

    def __init__(self, message: str, sample: int = 0, reason: str = "") -> None:
        super().__init__(message)
        self.sample = sample
        self.reason = reason


class UnknownNameError(OveractError, KeyError):
    """An unknown name; `help` suggests the nearest known one."""

    # `KeyError.__str__` would quote the message.
    __str__ = Exception.__str__

    def __init__(self, message: str, help: str | None = None) -> None:
        text = message if help is None else f"{message}: {help}"
        super().__init__(text, [(message, None, None, None, help)])


def unknown(what: str, name: Any, known: Iterable[str]) -> UnknownNameError:
    """Error for a name of an unknown `what`."""
    names = list(known)
    near = get_close_matches(str(name), names, n=1)
    if near:
        help = f"did you mean `{near[0]}`?"
    elif not names:
        help = "there are none"
    else:
        more = ", …" if len(names) > 10 else ""
        help = f"there are {', '.join(names[:10])}{more}"
    return UnknownNameError(f"there is no {what} `{name}`", help)


class Named(dict):
    """Numbers by parameter name, or other values by function name."""

    _what = "parameter"

    def __missing__(self, name: Any) -> Any:
        raise unknown(self._what, name, self)


class NamedFunctions(Named):
    """Values by function name."""

    _what = "function"


class InternalError(OveractError, RuntimeError):
    """An internal error of overact; please report it."""
