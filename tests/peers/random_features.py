"""Random trees with many features of MJCF: imports must give MuJoCo's torques.

    python tests/peers/random_features.py OVERACT [--count N] [--seed S] [--keep FOLDER]

Trees have geoms of all shapes, default classes, frames, orientations of all kinds, several joints in a body, springs,
couplings, and the settings of `<compiler>` that change inertias. Files that MuJoCo rejects are skipped. Prints
failures and a summary; the exit code is 1 after a failure.
"""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from compare import TOLERANCE, compare
from random_mechanisms import said

import mujoco

SEQUENCES = ("xyz", "XYZ", "zyx", "ZYX", "xZy", "zxz")
CLASSES = """<default><geom density="700"/><joint damping="0.05"/>
<default class="A"><geom density="1500" group="1"/><joint armature="0.02" stiffness="3"/>
<default class="B"><geom mass="0.7"/><joint damping="0.3" frictionloss="0.1" axis="1 0 0"/></default></default></default>"""
SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}


def numbers(*values):
    return " ".join(f"{value:.6g}" for own in values for value in np.ravel(own))


class Writer:
    """Draws one tree."""

    def __init__(self, random):
        self.random = random
        self.is_degrees = self.chance(0.5)
        self.from_geoms = self.choice("auto", "auto", "true", "false")
        self.joints, self.bodies = [], 0

    def chance(self, probability):
        return self.random.random() < probability

    def choice(self, *values):
        return values[self.random.integers(len(values))]

    def angle(self, largest):
        value = self.random.uniform(-largest, largest)
        return np.degrees(value) if self.is_degrees else value

    def vector(self, largest):
        return numbers(self.random.uniform(-largest, largest, 3))

    def orientation(self):
        normal = self.random.normal
        return self.choice(
            "",
            f' quat="{numbers(normal(size=4))}"',
            f' euler="{numbers([self.angle(2) for _ in range(3)])}"',
            f' axisangle="{numbers(normal(size=3), self.angle(2))}"',
            f' xyaxes="{numbers(normal(size=6))}"',
            f' zaxis="{numbers(normal(size=3))}"',
        )

    def geom(self, group):
        kind = self.choice(*SIZES)
        text = f'type="{kind}"'
        if kind != "sphere" and self.chance(0.3):
            size = self.random.uniform(0.02, 0.1, 1 if kind in ("capsule", "cylinder") else 2)
            text += f' fromto="{numbers(self.random.uniform(-0.3, 0.3, 6))}" size="{numbers(size)}"'
        else:
            text += f' size="{numbers(self.random.uniform(0.03, 0.2, SIZES[kind]))}"{self.orientation()}'
            if self.chance(0.7):
                text += f' pos="{self.vector(0.3)}"'
        if self.chance(0.3):
            text += f' mass="{self.random.uniform(0.1, 2):.4g}"'
        elif self.chance(0.4):
            text += f' density="{self.random.uniform(200, 3000):.4g}"'
        if self.chance(0.15) and kind != "ellipsoid":
            text += ' shellinertia="true"'
        if self.chance(0.3):
            text += f' group="{self.random.integers(0, 5)}"'
        return f"<geom {text}{self.of_class(group)}/>"

    def of_class(self, name):
        return f' class="{name}"' if name and self.chance(0.3) else ""

    def inertial(self):
        mass, sides = self.random.uniform(0.2, 3), self.random.uniform(0.1, 0.4, 3) ** 2
        moments = mass / 12 * (sides.sum() - sides)
        place = f'pos="{self.vector(0.2)}" mass="{mass:.6g}"'
        if self.chance(0.5):
            return f'<inertial {place}{self.orientation()} diaginertia="{numbers(moments)}"/>'
        turn, _ = np.linalg.qr(self.random.normal(size=(3, 3)))
        t = turn @ np.diag(moments) @ turn.T
        return f'<inertial {place} fullinertia="{numbers(t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2])}"/>'

    def joint(self, group):
        name, kind = f"j{len(self.joints)}", self.choice("hinge", "hinge", "hinge", "slide")
        self.joints.append(name)
        position = lambda: f"{self.angle(0.5) if kind == 'hinge' else self.random.uniform(-0.5, 0.5):.5g}"
        text = f'name="{name}" type="{kind}" axis="{numbers(self.random.normal(size=3))}"'
        if self.chance(0.4):
            text += f' pos="{self.vector(0.2)}"'
        for key, largest in (("damping", 1), ("armature", 0.1), ("frictionloss", 1)):
            if self.chance(0.3):
                text += f' {key}="{self.random.uniform(0, largest):.4g}"'
        if self.chance(0.25):
            text += f' ref="{position()}"'
        if self.chance(0.25):
            text += f' stiffness="{self.random.uniform(1, 20):.4g}" springref="{position()}"'
        elif self.chance(0.1):
            text += f' springdamper="{numbers(self.random.uniform(0.3, 1, 2))}"'
        return f"<joint {text}{self.of_class(group)}/>"

    def body(self, depth=0):
        self.bodies += 1
        group = self.choice("", "A", "B")
        inherited = f' childclass="{self.choice("A", "B")}"' if self.chance(0.3) else ""
        text = f'<body name="b{self.bodies}" pos="{self.vector(0.4)}"{self.orientation()}{inherited}>\n'
        text += "\n".join(self.joint(group) for _ in range(self.choice(1, 1, 1, 2, 3)))
        text += "\n".join(self.geom(group) for _ in range(self.random.integers(1, 4)))
        if self.from_geoms == "false" or self.chance(0.5):
            text += self.inertial()
        for _ in range(self.choice(0, 1, 1, 2) if depth < 3 and self.bodies < 5 else 0):
            child = self.body(depth + 1)
            if self.chance(0.25):
                child = f'<frame pos="{self.vector(0.3)}"{self.orientation()}>{child}</frame>'
            text += child
        if self.chance(0.2):
            own = self.inertial() if self.from_geoms == "false" or self.chance(0.3) else ""
            text += f'<body pos="{self.vector(0.3)}"{self.orientation()}>{self.geom("")}{own}</body>'
        return text + "</body>\n"

    def compiler(self):
        unit = "degree" if self.is_degrees else "radian"
        text = f'angle="{unit}" eulerseq="{self.choice(*SEQUENCES)}" inertiafromgeom="{self.from_geoms}"'
        for setting in (
            f'settotalmass="{self.random.uniform(1, 5):.4g}"',
            f'boundmass="{self.random.uniform(0.1, 1):.4g}"',
            f'boundinertia="{self.random.uniform(0.001, 0.01):.4g}"',
            'balanceinertia="true"',
            'inertiagrouprange="0 2"',
        ):
            if self.chance(0.2):
                text += f" {setting}"
        return text

    def mjcf(self):
        compiler, bodies = self.compiler(), self.body()
        equality, driven = "", list(self.joints)
        if len(driven) > 1 and self.chance(0.35):
            leader, follower = sorted(self.random.choice(len(driven), 2, replace=False))
            factors = f"{numbers(self.random.uniform(-0.3, 0.3), self.choice(-1, 0.5, 2, 1))} 0 0 0"
            equality = f'<equality><joint joint1="j{follower}" joint2="j{leader}" polycoef="{factors}"/></equality>'
            driven.remove(f"j{follower}")
        motors = "".join(self.choice(f'<motor joint="{name}" gear="7"/>', f'<position joint="{name}" kp="5"/>') for name in driven)
        gravity = f'<option gravity="{numbers(self.random.normal(size=3) * 5)}"/>' if self.chance(0.4) else ""
        return (
            f'<mujoco model="m"><compiler {compiler}/>{gravity}\n{CLASSES}\n<worldbody>\n{bodies}</worldbody>'
            f"{equality}<actuator>{motors}</actuator></mujoco>\n"
        )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("overact")
    parser.add_argument("--count", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    worst, compared, failures = 0.0, 0, 0
    for number in range(given.count):
        with tempfile.TemporaryDirectory() as scratch:
            folder = Path(scratch)
            file = folder / "m.xml"
            file.write_text(Writer(np.random.default_rng([given.seed, number])).mjcf())
            try:
                mujoco.MjModel.from_xml_path(str(file))
            except ValueError:
                continue
            compared += 1
            try:
                _, position, torque, _ = compare(given.overact, file, folder)
                found = max(position, torque)
                problem = "" if found < TOLERANCE else f"positions {position:.1e} m, torques {torque:.1e}"
                worst = max(worst, found)
            except (RuntimeError, AssertionError, KeyError, ValueError, AttributeError) as error:
                problem = said(error)
            if problem:
                failures += 1
                print(f"{number}: {problem}", flush=True)
                if given.keep:
                    shutil.copytree(folder, given.keep / str(number), dirs_exist_ok=True)
    print(f"{compared} trees of seed {given.seed}: {failures} failures; largest deviation {worst:.1e}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
