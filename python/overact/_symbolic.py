"""Programs as SymPy expressions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Sequence

if TYPE_CHECKING:
    import sympy


def _sympy() -> Any:
    try:
        import sympy
    except ImportError as error:
        message = 'to_sympy needs SymPy: pip install "overact[sympy]", or pip install sympy'
        raise ImportError(message) from error
    return sympy


class Symbolic:
    """A function of a robot as SymPy expressions, in steps like the result of `sympy.cse`.

    Attributes:
        function: Name of the function.
        inputs: Symbols of each input.
        steps: Assignments of a symbol and its expression; later ones use earlier ones.
        matrix: The output (a vector has one column), in terms of inputs and steps.
        guards: Expressions and the conditions that they must satisfy for a valid output.
    """

    function: str
    inputs: Mapping[str, Sequence[sympy.Symbol]]
    steps: Sequence[tuple[sympy.Symbol, sympy.Expr]]
    matrix: sympy.Matrix
    guards: Sequence[tuple[sympy.Expr, str]]

    def __init__(self, function: str, program: dict, names: Mapping[str, Sequence[str]]) -> None:
        sympy = _sympy()
        self.function = function
        taken: set[str] = set()

        def symbol(name: str) -> sympy.Symbol:
            own, count = name, 1
            while own in taken:
                count += 1
                own = f"{name}_{count}"
            taken.add(own)
            return sympy.Symbol(own, real=True)

        inputs = {}
        for name, length in program["inputs"]:
            own = names.get(name, ())
            own = own if len(own) == length else [f"{name}_{at}" for at in range(length)]
            inputs[name] = tuple(symbol(one) for one in own)
        arrays = list(inputs.values())
        results: list[sympy.Symbol] = []

        def value(term: tuple) -> sympy.Expr:
            kind, at, number = term
            if kind == "constant":
                return sympy.Integer(int(number)) if number == int(number) else sympy.Float(number, 17)
            return arrays[at][int(number)] if kind == "input" else results[at]

        steps = []
        for at, (operation, operands, name) in enumerate(program["steps"]):
            expression = _operations(sympy)[operation](*[value(one) for one in operands])
            results.append(symbol(name or f"t{at}"))
            steps.append((results[-1], expression))
        entries = [-value(term) if negative else value(term) for term, negative in program["entries"]]
        rows, columns = (*program["shape"], 1)[:2]
        self.inputs = inputs
        self.steps = tuple(steps)
        self.matrix = sympy.Matrix(rows, columns, entries)
        self.guards = tuple((value(term), what) for term, what in program["guards"])

    def inlined(self) -> sympy.Matrix:
        """The output in terms of the inputs only; long, because shared steps are expanded."""
        sympy = _sympy()
        known: dict = {}
        for name, expression in self.steps:
            known[name] = expression.xreplace(known)
        return sympy.Matrix(*self.matrix.shape, [one.xreplace(known) for one in self.matrix])

    def lambdify(self, modules: str | list = "numpy") -> Callable[..., Any]:
        """Function of the inputs, each a sequence of numbers, that returns the output as an array."""
        sympy = _sympy()
        steps, matrix = list(self.steps), self.matrix

        def replacements(_: Iterable) -> tuple[list, Any]:
            return steps, matrix

        arguments = [list(one) for one in self.inputs.values()]
        return sympy.lambdify(arguments, matrix, modules=modules, cse=replacements)

    def __repr__(self) -> str:
        rows, columns = self.matrix.shape
        return f"<{self.function}: {rows} x {columns} expressions in {len(self.steps)} steps>"


def _operations(sympy: Any) -> dict[str, Callable[..., Any]]:
    return {
        "add": lambda a, b: a + b,
        "sub": lambda a, b: a - b,
        "mul": lambda a, b: a * b,
        "div": lambda a, b: a / b,
        "neg": lambda a: -a,
        "sqrt": sympy.sqrt,
        "sin": sympy.sin,
        "cos": sympy.cos,
        "sign": sympy.sign,
        "signed": lambda a, b: a * sympy.sign(b),
        "atan2": sympy.atan2,
    }
