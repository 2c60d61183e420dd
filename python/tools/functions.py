"""Writes `overact/_functions.pyi`, the functions of robots for editors and type checkers, from the table of
functions: `python tools/functions.py`, with the package installed."""

import pathlib
import textwrap

from overact._overact import known_functions

STUB = pathlib.Path(__file__).resolve().parents[1] / "overact" / "_functions.pyi"

INPUTS = {
    "pose": "pose (m, rad)",
    "joints": "joints (n_t; m, rad)",
    "twist": "twist (r; m/s, rad/s)",
    "acceleration": "acceleration (r; m/s², rad/s²)",
    "actuators": "actuators (n; m, rad)",
    "actuator_velocities": "actuator_velocities (n; m/s, rad/s)",
    "actuator_accelerations": "actuator_accelerations (n; m/s², rad/s²)",
    "torques": "torques (n; N, N m)",
    "parameters": "parameters (n_st + n_l; SI)",
    "base_parameters": "base_parameters (n_b + n_l; SI)",
    "preload": "preload (n - r; N, N m)",
    "wrench": "wrench (6; N, N m)",
}

HEAD = '''"""The functions of robots. This file is written by `tools/functions.py`.

r are the degrees of freedom, n the actuators, n_t the joints, n_st, n_b and n_l the standard, base and
payload parameters. Robots without a platform call pose, twist and acceleration `joints`,
`joint_velocities` and `joint_accelerations`; `Function.inputs` has the names of a robot's.
"""

from ._overact import Function

class Functions:
'''


def written() -> str:
    """The text of the stub."""
    text = HEAD
    for name, origin, inputs, (rows, columns), summary in known_functions():
        told = ", ".join(INPUTS[one] for one in inputs)
        shape = f"({rows}, {columns})" if columns else f"({rows},)"
        if name.endswith("_from_actuators") and origin == "actuators":
            told = "actuators (n; m, rad) and, as its `inputs` say, what else it takes; the pose is found"
        elif name.endswith("_from_joints") and "joints" not in inputs:
            told = "joints (n_t; m, rad) and, as its `inputs` say, what else it takes"
        paragraph = f"{summary} Inputs: {told}. Output: {shape}."
        lines = textwrap.wrap(paragraph, 100)
        body = "\n".join(f"    {one}" for one in lines)
        text += f'    {name}: Function\n    """{body.strip()}"""\n'
    return text


if __name__ == "__main__":
    STUB.write_text(written(), encoding="utf-8")
