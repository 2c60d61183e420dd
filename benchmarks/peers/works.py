"""Tasks that are measured: a robot, a function, its columns."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Work:
    """One row of the table; `quoted` are published numbers of others that are not measured here."""

    title: str
    robot: str
    columns: str = "standard"  # or "base"
    source: str = "joints"  # or "pose"
    quoted: str = ""


WORKS = [
    Work("DualV, standard columns", "dualv", quoted="607 CasADi, 385 by hand"),
    Work("DualV, base columns", "dualv", "base", quoted="357 by hand"),
    Work("DualV, base columns from the pose", "dualv", "base", "pose"),
    Work("RX90, base columns", "rx90", "base", quoted="769 best of OpenSYMORO, SymPyBotics, CasADi"),
    Work("PUMA 560, base columns", "puma560", "base", quoted="824, likewise"),
    Work("Stanford arm, base columns", "stanford", "base", quoted="670, likewise"),
    Work("KUKA LWR, base columns", "kuka_lwr", "base", quoted="1175, likewise"),
    Work("Five-bar, standard columns", "five_bar", quoted="199 CasADi, 181 by hand"),
    Work("Three legs to a point, standard columns", "three_leg_point", quoted="267 CasADi, 231 by hand"),
    Work("3-PRR, standard columns", "planar_3prr", quoted="356 CasADi"),
    Work("4-PRR, standard columns", "planar_4prr", quoted="457 CasADi"),
    Work("Delta, standard columns", "delta", quoted="893 CasADi, 763 by hand"),
    Work("Delta of four arms, standard columns", "delta_4", quoted="1237 CasADi, 1061 by hand"),
    Work("6-UPS, standard columns", "hexapod", quoted="3343 CasADi"),
    Work("8-UPS, standard columns", "octopod", quoted="4377 CasADi"),
]
