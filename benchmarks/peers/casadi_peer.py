"""CasADi: expressions, operation counts, C code."""

import casadi

from .algebra import Scalar
from .count import Count

BINARY = {
    casadi.OP_ADD: "additions",
    casadi.OP_SUB: "additions",
    casadi.OP_MUL: "multiplications",
    casadi.OP_DIV: "divisions",
    casadi.OP_SQ: "multiplications",
    casadi.OP_TWICE: "multiplications",
    casadi.OP_INV: "divisions",
    casadi.OP_SQRT: "square_roots",
    casadi.OP_SIGN: "signs",
    casadi.OP_ATAN2: "arc_tangents",
    casadi.OP_NEG: "negations",
}
SKIPPED = {casadi.OP_INPUT, casadi.OP_OUTPUT, casadi.OP_CONST, casadi.OP_PARAMETER}


class Casadi:
    """Scalars are SX symbols."""

    name = "CasADi"

    def __init__(self):
        self.symbols = {}

    def symbol(self, name):
        self.symbols[name] = casadi.SX.sym(name)
        return Scalar(self.symbols[name])

    def sin(self, x):
        return Scalar(casadi.sin(x.value))

    def cos(self, x):
        return Scalar(casadi.cos(x.value))

    def sqrt(self, x):
        return Scalar(casadi.sqrt(x.value))

    def sign(self, x):
        return Scalar(casadi.sign(x.value))

    def arc_tangent(self, y, x):
        return Scalar(casadi.atan2(y.value, x.value))

    def function(self, name, inputs, columns, cse):
        """A function of the inputs; the output is rows x columns, row by row."""
        rows = len(columns[0])
        entries = [column[row].value for row in range(rows) for column in columns]
        output = casadi.vertcat(*[casadi.SX(e) for e in entries])
        if cse:
            output = casadi.cse(output)
        arguments = []
        for array, length in inputs:
            of = [self.symbols[f"{array}[{i}]"] for i in range(length)]
            arguments.append(casadi.vertcat(*of) if of else casadi.SX(0, 1))
        return casadi.Function(name, arguments, [output])


def count(function):
    """Number of operations of a function by the common rule."""
    counted = Count()
    angles = {"sin": set(), "cos": set()}
    holds = {}
    for k in range(function.n_instructions()):
        operation = function.instruction_id(k)
        if operation in SKIPPED:
            if operation in (casadi.OP_CONST, casadi.OP_INPUT):
                holds[function.instruction_output(k)[0]] = k
            continue
        arguments = [holds.get(i) for i in function.instruction_input(k)]
        if operation in (casadi.OP_SIN, casadi.OP_COS):
            angles["sin" if operation == casadi.OP_SIN else "cos"].add(arguments[0])
        elif operation in BINARY:
            counted.add(BINARY[operation])
        else:
            raise NotImplementedError(f"operation {operation} of CasADi")
        holds[function.instruction_output(k)[0]] = k
    counted.trigonometric_pairs = len(angles["sin"] | angles["cos"])
    return counted


def c_code(function, name="model"):
    """CasADi's own C code with the signature of the timing loop."""
    generator = casadi.CodeGenerator("model.c", {"with_header": False})
    generator.add(function)
    call = f"void {name}(const double **inputs, double *output) {{\n"
    call += f"    casadi_int iw[{max(1, function.sz_iw())}];\n    double w[{max(1, function.sz_w())}];\n"
    call += f"    {function.name()}(inputs, &output, iw, w, 0);\n}}\n"
    return generator.dump() + call
