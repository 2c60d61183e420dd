"""Exceptions of the package."""

from __future__ import annotations

from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, Iterable


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong.

    Attributes:
        message: What is wrong, in one sentence.
        file: The file, as it was named, or the name of a run.
        line: Line, counted from 1.
        column: Number of a character, counted from 1, or the name of a column of a table.
        help: A way out.
    """

    message: str
    file: str | None = None
    line: int | None = None
    column: int | str | None = None
    help: str | None = None


class OveractError(Exception):
    """What overact can't do, with all that is wrong at once.

    Attributes:
        problems: All of it, each with its place and a way out.
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
        """Where the first problem is in its line."""
        return self._first("column")

    @property
    def help(self) -> str | None:
        """A way out of the first problem."""
        return self._first("help")


class DescriptionError(OveractError, ValueError):
    """A description that is wrong: every error of it, each at its line."""


class DataError(OveractError, ValueError):
    """Files, logs or settings that can't be used."""


class EvaluationError(OveractError, ArithmeticError):
    """A state at which a function has no value: out of reach, singular, not finite.

    Attributes:
        sample: Number of the first such sample, counted from 0 through all axes but the last.
        reason: What is wrong there.
    """

    def __init__(self, message: str, sample: int = 0, reason: str = "") -> None:
        super().__init__(message)
        self.sample = sample
        self.reason = reason


class UnknownNameError(OveractError, KeyError):
    """A name by which nothing is called; `help` has the nearest that there is."""

    # That of KeyError puts the message into quotes.
    __str__ = Exception.__str__

    def __init__(self, message: str, help: str | None = None) -> None:
        text = message if help is None else f"{message}: {help}"
        super().__init__(text, [(message, None, None, None, help)])


def unknown(what: str, name: Any, known: Iterable[str]) -> UnknownNameError:
    """The error of a name by which no `what` is called."""
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
    """Numbers by the names of parameters, or others by the names of functions."""

    _what = "parameter"

    def __missing__(self, name: Any) -> Any:
        raise unknown(self._what, name, self)


class NamedFunctions(Named):
    """By the names of functions."""

    _what = "function"


class InternalError(OveractError, RuntimeError):
    """Something is wrong with overact itself; please report it."""
