"""Descriptions of robots with a variable number of legs or joints: n-RRR, n-UPS, nR."""

HEAD = """name = "{name}"
summary = "{summary}"
gravity = [0, 0, "-9.81 m/s^2"]
"""

RRR = """
[constants]
radius = "0.35 m"
l_1 = "0.20 m"
l_2 = "0.20 m"
r_p = "0.10 m"

[platform]
motion = "planar"
home = { x = "0 m", y = "0 m", phi = "0 deg" }

[leg.arm]
variables = ["psi"]
base = { at = ["radius * cos(psi)", "radius * sin(psi)", 0], rotation = [0, 0, "psi"] }

[[leg.arm.joint]]
type = "revolute"
actuated = true

[[leg.arm.joint]]
type = "revolute"
d = "l_1"
parameters = ["inertia", "fs"]

[[leg.arm.joint]]
type = "revolute"
d = "l_2"
parameters = ["fs"]

[leg.arm.end]
type = "rigid"
at = ["r_p * cos(psi)", "r_p * sin(psi)", 0]
rotation = [0, 0, 0]
"""

UPS = """
[constants]
r_b = "0.40 m"
r_p = "0.20 m"

[platform]
motion = "spatial"
home = { z = "0.50 m" }

[leg.ups]
variables = ["base", "top"]
base = { at = ["r_b * cos(base)", "r_b * sin(base)", 0], rotation = [0, 0, "base"] }

[[leg.ups.joint]]
name = "cross"
type = "revolute"
alpha = "90 deg"
theta = "q + 90 deg"
parameters = []

[[leg.ups.joint]]
name = "cylinder"
type = "revolute"
alpha = "90 deg"
theta = "q + 90 deg"
parameters = "inertia"

[[leg.ups.joint]]
name = "rod"
type = "prismatic"
alpha = "90 deg"
actuated = true

[leg.ups.end]
type = "point"
at = ["r_p * cos(top)", "r_p * sin(top)", 0]
"""


def rrr(n):
    """A platform on n arms of two links."""
    text = HEAD.format(name=f"Rrr{n}", summary=f"Planar robot with {n} RRR legs") + RRR
    for k in range(n):
        psi = 90 + 360 * k / n
        third = -129 - 103 - psi
        text += f"""
[[place]]
name = "leg{k + 1}"
shape = "arm"
psi = "{psi:.6f} deg"
home = {{ 1 = "129 deg", 2 = "103 deg", 3 = "{third:.6f} deg" }}
"""
    return text


def ups(n):
    """A platform on n linear drives, in pairs."""
    text = HEAD.format(name=f"Ups{n}", summary=f"Platform with {n} UPS legs") + UPS
    pairs = (n + 1) // 2
    for k in range(n):
        middle, side = 360 * (k // 2) / pairs, (-1, 1)[k % 2]
        base, top = middle + side * 36 / pairs, middle + side * 135 / pairs
        text += f"""
[[place]]
name = "leg{k + 1}"
shape = "ups"
base = "{base:.6f} deg"
top = "{top:.6f} deg"
home = {{ rod = "0.5 m" }}
"""
    return text


def arm(n):
    """An arm of n revolute joints, neighbouring axes at right angles."""
    text = HEAD.format(name=f"Arm{n}", summary=f"Serial robot with {n} revolute joints") + "\n[leg.arm]\n"
    place = '\n[[place]]\nname = "arm"\nshape = "arm"\n'
    for k in range(n):
        alpha = 0 if k == 0 else (90, -90, -90, 90)[(k - 1) % 4]
        length = '\nr = "0.25 m"' if k % 2 == 0 and k > 0 else ""
        text += f"""
[[leg.arm.joint]]
type = "revolute"
alpha = "{alpha} deg"{length}
actuated = true
"""
    return text + place


FAMILIES = {"n-RRR": rrr, "n-UPS": ups, "nR": arm}
