"""Writes robots with springs, counterbalances and coupled motors, for the coverage table.

Usage: elements.py FOLDER [LEG]. Each robot is one of `robots/` with a few changes. LEG is the imported
description of the Cassie-like leg of the example parallel robots.
"""

import pathlib
import re
import sys

ROBOTS = pathlib.Path(__file__).resolve().parents[2] / "robots"

SPRING = """
[[spring]]
name = "{name}"
from = {{ body = "{start}", at = {start_at} }}
to = {{ body = "{end}", at = {end_at} }}
{force}
"""

GAS_SPRING = SPRING.format(
    name="gas",
    start="swing",
    start_at='["0.35 m", "0.10 m", 0]',
    end="boom",
    end_at='["1.00 m", "-0.05 m", 0]',
    force='force = "l - 1.4 m"\nknown = "-900 N"',
)
DAMPER = SPRING.format(
    name="damper",
    start="boom",
    start_at='["0.95 m", "0.20 m", 0]',
    end="stick",
    end_at='["-0.20 m", "0.10 m", 0]',
    force='force = "dl"',
)
COUNTERBALANCE = SPRING.format(
    name="counterbalance",
    start="turret",
    start_at='["-0.05 m", 0, "0.15 m"]',
    end="shoulder",
    end_at='["0.08 m", 0, 0]',
    force='force = "l - 0.1 m"',
)
MOTORS = """
[motor.pitch]
turns = "left.q_crank + right.q_crank"
ratio = 30
parameters = ["ia", "friction"]

[motor.roll]
turns = "left.q_crank - right.q_crank"
ratio = 30
parameters = ["ia", "friction"]
"""


def with_spring(text, spring, values):
    """A description with springs and the true values of their coefficients."""
    heading = "[experiment.parameters]\n"
    assert text.count(heading) == 1
    lines = "".join(f"{name} = {value}\n" for name, value in values.items())
    return text.replace(heading, heading + lines) + spring


def excavator(text):
    """The excavator with a gas spring at the boom and a damper at the stick."""
    return with_spring(text, GAS_SPRING + DAMPER, {"k_gas": 3000, "k_damper": 800})


def palletiser(text):
    """The palletiser with a counterbalance at the shoulder."""
    return with_spring(text, COUNTERBALANCE, {"k_counterbalance": 900})


def ankle(text):
    """The ankle whose motors turn sum and difference of its cranks.

    The foot has no friction: it would differ from that of the motors around reversals only.
    """
    for old, new in [('["fs"]', "[]"), ('["inertia", "fs"]', '["inertia"]')]:
        assert text.count(old) == 1
        text = text.replace(old, new)
    text = re.sub("fs_(pitch|roll)_foot = .*\n", "", text)
    crank = 'theta = "q + 180 deg"\nactuated = true\n'
    assert text.count(crank) == 1
    text = text.replace(crank, 'theta = "q + 180 deg"\nparameters = ["zz", "mx"]\n')
    text = text.replace('kept_actuators = ["left", "right"]', 'kept_actuators = ["pitch", "roll"]')
    for symbol in ["ia", "fv", "fs", "off"]:
        for side, motor in [("left", "pitch"), ("right", "roll")]:
            text = text.replace(f"{symbol}_crank_{side} =", f"{symbol}_{motor} =")
    return text + MOTORS


def cassie(text):
    """The leg with springs at its passive knee and ankle."""
    springs = {"free_knee": "q + 1.5 rad", "free_ankle": "q - 0.1 rad"}
    for joint, spring in springs.items():
        heading = f'name = "{joint}"\ntype = "revolute"\n'
        assert text.count(heading) == 1
        text = text.replace(heading, f'{heading}spring = "{spring}"\n')
    return with_spring(text, "", {"k_free_knee_tarsus": 15, "k_free_ankle_foot_2": 3})


def write(path, text, name):
    """Writes a description with this name."""
    own = next(line for line in text.splitlines() if line.startswith("name = "))
    path.write_text(text.replace(own, f'name = "{name}"', 1), encoding="utf-8")


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    robots = {
        "excavator": ("GasSpringExcavator", excavator),
        "palletiser": ("CounterbalancedPalletiser", palletiser),
        "ankle": ("DifferentialAnkle", ankle),
    }
    for stem, (name, change) in robots.items():
        text = (ROBOTS / f"{stem}.toml").read_text(encoding="utf-8")
        write(folder / f"{stem}.toml", change(text), name)
    for leg in sys.argv[2:]:
        text = pathlib.Path(leg).read_text(encoding="utf-8")
        write(folder / "cassie.toml", cassie(text), "SprungCassieLeg")


if __name__ == "__main__":
    main()
