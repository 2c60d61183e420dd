"""Values of a description: numbers with units, expressions, and joint variables in them."""

import ast
import math
import operator
import re

UNITS = {
    "m": 1.0, "mm": 1e-3, "cm": 1e-2, "um": 1e-6, "km": 1e3,
    "deg": math.pi / 180.0, "rad": 1.0, "mrad": 1e-3,
    "kg": 1.0, "g": 1e-3, "s": 1.0, "ms": 1e-3, "us": 1e-6,
    "N": 1.0, "mN": 1e-3, "kN": 1e3,
}  # fmt: skip

QUANTITY = re.compile(
    r"(?<![\w.])(\d[\d_]*\.?[\d_]*(?:[eE][+-]?\d+)?)\s+((?:[A-Za-z]+(?:\^-?\d+)?)(?:\s*/\s*[A-Za-z]+(?:\^-?\d+)?)*)"
)


class Linear:
    """A constant plus multiples of joint variables."""

    def __init__(self, constant, terms=()):
        self.constant = constant
        self.terms = dict(terms)

    @staticmethod
    def of(value):
        return value if isinstance(value, Linear) else Linear(value)

    def __add__(self, other):
        other = Linear.of(other)
        terms = dict(self.terms)
        for name, factor in other.terms.items():
            terms[name] = terms.get(name, 0.0) + factor
        return Linear(self.constant + other.constant, terms)

    __radd__ = __add__

    def __mul__(self, factor):
        return Linear(self.constant * factor, {n: f * factor for n, f in self.terms.items()})

    __rmul__ = __mul__

    def __truediv__(self, divisor):
        return self * (1.0 / divisor)

    def __neg__(self):
        return self * -1.0

    def __pos__(self):
        return self

    def __sub__(self, other):
        return self + -Linear.of(other)

    def __rsub__(self, other):
        return Linear.of(other) - self


def settle(x):
    """A cosine of a right angle is 0, not 6e-17."""
    nearest = round(2.0 * x) / 2.0
    return nearest if abs(x - nearest) < 4e-16 else x


FUNCTIONS = {
    "sqrt": math.sqrt,
    "sin": lambda x: settle(math.sin(x)),
    "cos": lambda x: settle(math.cos(x)),
    "tan": math.tan,
    "atan2": math.atan2,
}
OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def with_units(match):
    number, unit = match.groups()
    factors = re.split(r"\s*/\s*", unit)
    value = "1.0"
    for index, factor in enumerate(factors):
        name, _, power = factor.partition("^")
        if name not in UNITS:
            return match.group(0)
        sign = "/" if index else "*"
        value += f"{sign}{UNITS[name]!r}**{power or 1}"
    return f"({number}*({value}))"


def evaluate(value, names):
    """Number (or `Linear` expression) in a key of a description."""
    if not isinstance(value, str):
        return float(value)
    text = QUANTITY.sub(with_units, value).replace("^", "**")
    scope = {"pi": math.pi} | names

    def walk(node):
        match node:
            case ast.Expression(body=body):
                return walk(body)
            case ast.Constant(value=number):
                return float(number)
            case ast.Name(id=name):
                return scope[name]
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                return -walk(operand)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                return walk(operand)
            case ast.BinOp(left=left, op=op, right=right):
                return OPERATORS[type(op)](walk(left), walk(right))
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return FUNCTIONS[name](*map(walk, arguments))
        raise ValueError(f"{value!r} is no expression that a description may hold")

    return walk(ast.parse(text.strip(), mode="eval"))
