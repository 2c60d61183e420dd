"""Composition and cost of a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Mapping


@dataclass(frozen=True)
class Parameter:
    """A standard parameter: a column of the identification model.

    Attributes:
        name: Unique name, ``zz_2_leg3``, ``m_platform`` or ``m_payload``.
        symbol: Symbol of the standard parameter, for instance ``zz``.
        unit: SI unit.
    """

    name: str
    symbol: str
    unit: str

    def __repr__(self) -> str:
        return f"<{self.name}, {self.unit}>"


@dataclass(frozen=True)
class BaseParameter:
    """A base parameter: an independent column, with the standard parameters regrouped into it.

    Attributes:
        name: Name of the kept parameter, with the suffix ``R`` if others are regrouped into it.
        parameter: Name of the standard parameter whose column is kept.
        unit: SI unit.
        regrouped: Coefficients of the regrouped standard parameters, by name.
    """

    name: str
    parameter: str
    unit: str
    regrouped: Mapping[str, float]

    def value(self, values: Mapping[str, float]) -> float:
        """Value from those of the standard parameters; missing ones count as zero."""
        others = (factor * values.get(name, 0.0) for name, factor in self.regrouped.items())
        return values.get(self.parameter, 0.0) + sum(others)

    @property
    def expression(self) -> str:
        """The regrouping as a sum: ``m_platform + 0.5 m_3_leg1 - …``."""
        text = self.parameter
        for name, factor in self.regrouped.items():
            sign = "-" if factor < 0 else "+"
            size = "" if abs(factor) == 1 else f"{abs(factor):.6g} "
            text += f" {sign} {size}{name}"
        return text

    def __repr__(self) -> str:
        if not self.regrouped:
            return f"<{self.name}, {self.unit}>"
        return f"<{self.name} = {self.expression}, {self.unit}>"


@dataclass(frozen=True)
class Iteration:
    """An iteration within a function, and the cost of each step.

    Attributes:
        function: The function that iterates.
        within: The enclosing iteration, if there is one.
        operations: Additions, multiplications and divisions of a step.
    """

    function: str
    within: str | None
    operations: int


@dataclass(frozen=True)
class Cost:
    """Cost of a function including all functions that it calls.

    A product with a sign is a multiplication. Attributes other than additions, multiplications and
    divisions are not part of `operations`.
    """

    additions: int
    multiplications: int
    divisions: int
    square_roots: int
    trigonometric_pairs: int
    arc_tangents: int
    signs: int
    guards: int
    negations: int
    intermediates: int
    iterations: tuple[Iteration, ...] = ()

    @property
    def operations(self) -> int:
        """Additions, multiplications and divisions together."""
        return self.additions + self.multiplications + self.divisions

    @classmethod
    def _of(cls, document: dict) -> Cost:
        numbers = {name: document[name] for name in cls.__dataclass_fields__ if name != "iterations"}
        of = lambda one: Iteration(one["function"], one["within"], one["operations"])  # noqa: E731
        return cls(**numbers, iterations=tuple(of(one) for one in document["iterations"]))

    def __repr__(self) -> str:
        others = [
            (self.square_roots, "square roots"),
            (self.trigonometric_pairs, "sine-cosine pairs"),
            (self.arc_tangents, "arc tangents"),
        ]
        told = "".join(f", {count} {what}" for count, what in others if count)
        steps = "".join(f", {one.operations} in each step of {one.function}" for one in self.iterations)
        return (
            f"<{self.operations} operations ({self.additions} +, {self.multiplications} ×, "
            f"{self.divisions} ÷){told}{steps}>"
        )
