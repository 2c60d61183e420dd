"""SymPy and SymForce: expression trees, shared by their own `cse`, counted and written as C."""

from itertools import count as numbers

import symforce

symforce.set_symbolic_api("symengine")

import symforce.symbolic as sf  # noqa: E402
import sympy  # noqa: E402

from .algebra import Scalar  # noqa: E402
from .count import Count  # noqa: E402

POWERS = {2: "square", 3: "cube", 4: "fourth"}
PRELUDE = """#include <math.h>
static inline double square(double x) { return x * x; }
static inline double cube(double x) { return x * x * x; }
static inline double fourth(double x) { return square(square(x)); }
static inline double three_halves(double x) { return x * sqrt(x); }
static inline double sign(double x) { return (x > 0.0) - (x < 0.0); }
"""


class Trees:
    """Scalars are expressions of a module with SymPy's names."""

    def __init__(self, name, module):
        self.name, self.module = name, module
        self.inputs = {}

    def symbol(self, name):
        """An input; its index in the arguments is in its name."""
        array, _, index = name.rstrip("]").partition("[")
        symbol = self.module.Symbol(f"{array}_{index}")
        self.inputs[str(symbol)] = (array, int(index))
        return Scalar(symbol)

    def sin(self, x):
        return Scalar(self.module.sin(x.value))

    def cos(self, x):
        return Scalar(self.module.cos(x.value))

    def sqrt(self, x):
        return Scalar(self.module.sqrt(x.value))

    def sign(self, x):
        return Scalar(self.module.sign(x.value))

    def function(self, inputs, columns):
        """Operations, and C code with row-major rows x columns as the output."""
        rows = len(columns[0])
        entries = [self.module.sympify(column[row].value) for row in range(rows) for column in columns]
        symbols = (self.module.Symbol(f"shared{k}") for k in numbers())
        shared, outputs = self.module.cse(entries, symbols=symbols)
        arguments = {array: place for place, (array, _) in enumerate(inputs)}
        names = {name: f"inputs[{arguments[a]}][{i}]" for name, (a, i) in self.inputs.items()}
        writer = Writer(names)
        lines = [f"    const double {symbol} = {writer.text(value)};" for symbol, value in shared]
        lines += [f"    output[{k}] = {writer.text(value)};" for k, value in enumerate(outputs)]
        body = "\n".join(lines)
        return writer.counted(), f"{PRELUDE}void model(const double **inputs, double *output) {{\n{body}\n}}\n"


def sympy_trees():
    return Trees("SymPy, cse", sympy)


def symforce_trees():
    return Trees("SymForce", sf)


class Writer:
    """Writes expressions as C and counts their operations."""

    def __init__(self, names):
        self.names = names
        self.count = Count()
        self.angles = set()

    def counted(self):
        self.count.trigonometric_pairs = len(self.angles)
        return self.count

    def text(self, e):
        if e.is_Symbol:
            return self.names.get(str(e), str(e))
        if e.is_Number:
            return repr(float(e))
        if e.is_Add:
            return self.sum(e)
        if e.is_Mul:
            negative, text = self.product(e)
            self.count.add("negations", int(negative))
            return f"(-{text})" if negative else text
        if e.is_Pow:
            return self.power(*e.args)
        kind = type(e).__name__
        if kind in ("sin", "cos"):
            self.angles.add(str(e.args[0]))
            return f"{kind}({self.text(e.args[0])})"
        if kind == "sign":
            self.count.add("signs")
            return f"sign({self.text(e.args[0])})"
        raise NotImplementedError(f"{kind} in C")

    def sum(self, e):
        self.count.add("additions", len(e.args) - 1)
        terms = []
        for term in e.args:
            negative, text = self.product(term) if term.is_Mul else (False, self.text(term))
            terms.append((negative, text))
        terms.sort(key=lambda term: term[0])
        if terms[0][0]:
            self.count.add("negations")
        text = ("-" if terms[0][0] else "") + terms[0][1]
        return "(" + text + "".join(f" {'-' if n else '+'} {t}" for n, t in terms[1:]) + ")"

    def product(self, e):
        """Whether the product is negative, and its magnitude."""
        negative, above, below = False, [], []
        for factor in e.args:
            if factor.is_Number:
                value = float(factor)
                negative ^= value < 0.0
                if abs(value) != 1.0:
                    above.append(repr(abs(value)))
            elif factor.is_Pow and factor.args[1].is_Number and float(factor.args[1]) < 0.0:
                base, exponent = factor.args
                below.append(self.power(base, -exponent))
            else:
                above.append(self.text(factor))
        self.count.add("multiplications", max(len(above) - 1, 0) + max(len(below) - 1, 0))
        text = " * ".join(above or ["1.0"])
        if below:
            self.count.add("divisions")
            text = f"({text}) / ({' * '.join(below)})"
        return negative, f"({text})"

    def power(self, base, exponent):
        value = float(exponent)
        if value < 0.0:
            self.count.add("divisions")
            return f"(1.0 / {self.power(base, -exponent)})"
        if value == 1.0:
            return self.text(base)
        if value == 0.5:
            self.count.add("square_roots")
            return f"sqrt({self.text(base)})"
        if value == 1.5:
            self.count.add("square_roots")
            self.count.add("multiplications")
            return f"three_halves({self.text(base)})"
        if value not in POWERS:
            raise NotImplementedError(f"the power {exponent}")
        self.count.add("multiplications", {2: 1, 3: 2, 4: 2}[int(value)])
        return f"{POWERS[int(value)]}({self.text(base)})"
