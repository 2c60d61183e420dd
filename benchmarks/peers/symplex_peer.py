"""symplex: a separate program optimises a model's operations and returns trees."""

import json
import subprocess
from functools import cache

import sympy

from .ours import ROOT
from .tree_peer import Trees


@cache
def program():
    """The compiled program. It is its own workspace, so that only runs that need it compile symplex."""
    target = ROOT / "target" / "benchmarks" / "symplex"
    manifest = ROOT / "benchmarks" / "symplex" / "Cargo.toml"
    command = ["cargo", "build", "--quiet", "--release", "--locked", "--manifest-path", manifest]
    subprocess.run([*command, "--target-dir", target], check=True)
    return target / "release" / "overact-symplex"


class Operand:
    """A symbol, a number, or the name of the line that computes it.

    An operation adds a line, unless there already is one for it.
    """

    def __init__(self, lines, name):
        self.lines, self.name = lines, name

    def __str__(self):
        return self.name

    def operation(self, operator, *operands):
        words = map(str, operands)
        line = " ".join([operator, *(sorted(words) if operator in ("add", "mul") else words)])
        return Operand(self.lines, self.lines.setdefault(line, f"line{len(self.lines)}"))

    def __neg__(self):
        return self.operation("neg", self)

    def __add__(self, other):
        return self.operation("add", self, other)

    def __radd__(self, other):
        return self.operation("add", other, self)

    def __sub__(self, other):
        return self.operation("sub", self, other)

    def __rsub__(self, other):
        return self.operation("sub", other, self)

    def __mul__(self, other):
        return self.operation("mul", self, other)

    def __rmul__(self, other):
        return self.operation("mul", other, self)

    def __truediv__(self, other):
        return self.operation("div", self, other)

    def __rtruediv__(self, other):
        return self.operation("div", other, self)


class Module:
    """Functions that `Trees` needs of a module with SymPy's names."""

    def __init__(self):
        #: Names of lines, by their operations.
        self.lines = {}

    def Symbol(self, name):
        return Operand(self.lines, name)

    def sympify(self, value):
        return value

    def sin(self, x):
        return x.operation("sin", x)

    def cos(self, x):
        return x.operation("cos", x)

    def sqrt(self, x):
        return x.operation("sqrt", x)

    def sign(self, x):
        return x.operation("sign", x)

    def cse(self, entries, symbols):
        """Shared expressions, with symplex's names, and the entries, as SymPy trees."""
        lines = [f"{name} {line}" for line, name in self.lines.items()]
        text = "\n".join([*lines, *(f"output {entry}" for entry in entries)])
        done = subprocess.run([program()], input=text, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"symplex: {done.stderr.strip()}")
        found = [line.split(" ", 1) for line in done.stdout.splitlines()]
        trees = [(name, tree(json.loads(text))) for name, text in found]
        return [t for t in trees if t[0] != "output"], [value for name, value in trees if name == "output"]


def tree(node):
    """The tree that symplex writes, in SymPy's classes without evaluation."""
    match node:
        case {"type": "Num", "numer": above, "denom": below}:
            return sympy.Rational(int(above), int(below))
        case {"type": "Symbol", "name": name}:
            return sympy.Symbol(name)
        case {"type": "Add", "terms": terms}:
            return sympy.Add(*map(tree, terms), evaluate=False)
        case {"type": "Mul", "factors": factors}:
            return sympy.Mul(*map(tree, factors), evaluate=False)
        case {"type": "Pow", "base": base, "exp": exponent}:
            return sympy.Pow(tree(base), tree(exponent), evaluate=False)
        case {"type": "Sqrt", "arg": argument}:
            return sympy.Pow(tree(argument), sympy.Rational(1, 2), evaluate=False)
        case {"type": "Sin" | "Cos" | "Sign" as function, "arg": argument}:
            return getattr(sympy, function.lower())(tree(argument), evaluate=False)
    raise NotImplementedError(f"{node['type']} of symplex")


def symplex_trees():
    return Trees("symplex", Module())
