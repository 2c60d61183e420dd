"""Scalars, vectors and matrices over any computer algebra: CasADi, SymPy, SymForce, or plain floats.

A `Scalar` folds exact zeros and ones before the peer sees them. No peer's count then includes products that a
user would not have written.
"""

import math


class Scalar:
    """A Python float or a symbol of the peer."""

    __slots__ = ("value",)

    def __init__(self, value):
        self.value = value

    @property
    def is_number(self):
        return isinstance(self.value, float)

    def is_equal(self, number):
        return self.is_number and self.value == number

    @property
    def is_zero(self):
        return self.is_equal(0.0)

    def __add__(self, other):
        other = scalar(other)
        if self.is_zero:
            return other
        return self if other.is_zero else Scalar(self.value + other.value)

    __radd__ = __add__

    def __neg__(self):
        return self if self.is_zero else Scalar(-self.value)

    def __sub__(self, other):
        other = scalar(other)
        if other.is_zero:
            return self
        return -other if self.is_zero else Scalar(self.value - other.value)

    def __rsub__(self, other):
        return scalar(other) - self

    def __mul__(self, other):
        other = scalar(other)
        for one, another in ((self, other), (other, self)):
            if one.is_zero or another.is_equal(1.0):
                return one
            if another.is_equal(-1.0):
                return -one
        return Scalar(self.value * other.value)

    __rmul__ = __mul__

    def __truediv__(self, other):
        other = scalar(other)
        if other.is_number:
            return self * (1.0 / other.value)
        return self if self.is_zero else Scalar(self.value / other.value)

    def __rtruediv__(self, other):
        return scalar(other) / self


def scalar(value):
    return value if isinstance(value, Scalar) else Scalar(float(value))


ZERO, ONE = Scalar(0.0), Scalar(1.0)


def vector(values):
    return [scalar(v) for v in values]


def add(a, b):
    return [x + y for x, y in zip(a, b, strict=True)]


def sub(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def scale(a, factor):
    return [x * factor for x in a]


def dot(a, b):
    total = ZERO
    for x, y in zip(a, b, strict=True):
        total = total + x * y
    return total


def cross(a, b):
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def matrix(rows):
    return [vector(row) for row in rows]


def transpose(m):
    return [list(column) for column in zip(*m, strict=True)]


def product(a, b):
    columns = transpose(b)
    return [[dot(row, column) for column in columns] for row in a]


def apply(m, v):
    return [dot(row, v) for row in m]


def identity(n):
    return [[ONE if i == j else ZERO for j in range(n)] for i in range(n)]


def inverse_by_elimination(m):
    """Gauss-Jordan elimination; the pivot is a number if possible, else in the row with the fewest entries."""
    n = len(m)
    work = [list(row) + unit for row, unit in zip(m, identity(n), strict=True)]
    rows, columns, pivots = set(range(n)), set(range(n)), {}
    while rows:
        candidates = [(i, j) for i in rows for j in columns if not work[i][j].is_zero]
        if not candidates:
            raise ZeroDivisionError("the leg's Jacobian is singular everywhere")

        def filling(at):
            i, j = at
            in_row = sum(not work[i][k].is_zero for k in columns)
            in_column = sum(not work[k][j].is_zero for k in rows)
            return ((in_row - 1) * (in_column - 1), not work[i][j].is_number, i, j)

        i, j = min(candidates, key=filling)
        reciprocal = ONE / work[i][j]
        work[i] = [ONE if k == j else x * reciprocal for k, x in enumerate(work[i])]
        for k in range(n):
            if k != i and not work[k][j].is_zero:
                factor = work[k][j]
                row = sub(work[k], scale(work[i], factor))
                row[j] = ZERO
                work[k] = row
        pivots[j] = i
        rows.remove(i)
        columns.remove(j)
    return [work[pivots[j]][n:] for j in range(n)]


def solve_by_elimination(m, v):
    """Solves m x = v by elimination without exchange of rows, and back substitution."""
    n = len(v)
    rows, x = [list(row) for row in m], list(v)
    inverses = []
    for k in range(n):
        inverses.append(ONE / rows[k][k])
        for i in range(k + 1, n):
            factor = rows[i][k] * inverses[k]
            for j in range(k + 1, n):
                rows[i][j] = rows[i][j] - factor * rows[k][j]
            x[i] = x[i] - factor * x[k]
    for k in reversed(range(n)):
        x[k] = (x[k] - dot(rows[k][k + 1 :], x[k + 1 :])) * inverses[k]
    return x


def determinant(m):
    if len(m) == 1:
        return m[0][0]
    total = ZERO
    for j, entry in enumerate(m[0]):
        minor = [row[:j] + row[j + 1 :] for row in m[1:]]
        total = total + entry * determinant(minor) * (-1.0) ** j
    return total


def inverse_by_cofactors(m):
    """Adjugate divided by the determinant: one division."""
    n = len(m)

    def cofactor(i, j):
        minor = [row[:j] + row[j + 1 :] for k, row in enumerate(m) if k != i]
        return (determinant(minor) if minor else ONE) * (-1.0) ** (i + j)

    cofactors = [[cofactor(i, j) for j in range(n)] for i in range(n)]
    first = min(range(n), key=lambda i: sum(not x.is_zero for x in m[i]))
    reciprocal = ONE / dot(m[first], cofactors[first])
    return [[cofactors[j][i] * reciprocal for j in range(n)] for i in range(n)]


class Numbers:
    """Plain floats: a derivation with numbers checks itself."""

    name = "numbers"

    def __init__(self, values):
        self.values = values

    def symbol(self, name):
        return Scalar(float(self.values[name]))

    def sin(self, x):
        return Scalar(math.sin(x.value))

    def cos(self, x):
        return Scalar(math.cos(x.value))

    def sqrt(self, x):
        return Scalar(math.sqrt(x.value))

    def sign(self, x):
        return Scalar(float((x.value > 0.0) - (x.value < 0.0)))
