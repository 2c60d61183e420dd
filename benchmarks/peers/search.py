"""The best of a peer's forms for a robot: the one with the fewest operations after `cse`."""

import itertools

from .casadi_peer import Casadi, count
from .model import Form
from .robot import columns


def forms(robot):
    """All forms that differ for a robot."""
    if robot.motion is None:
        for merged, kind in itertools.product([False, True], ["partial", "recursion"]):
            yield Form(merged=merged, columns=kind)
        return
    frames = range(1 + max(len(leg.joints) for leg in robot.legs))
    for frame, merged, inverse, kind, staged in itertools.product(
        frames, [False, True], ["elimination", "cofactors"], ["partial", "recursion"], [True, False]
    ):
        yield Form(frame, merged, inverse, kind, staged)


def best(robot, inputs, names):
    """Forms by the operations of CasADi's function, the fewest first."""
    found = []
    for index, form in enumerate(forms(robot)):
        algebra = Casadi()
        try:
            derived = columns(robot, algebra, inputs, names, form)
        except NotImplementedError:
            # The closure is not square in this frame: another one serves.
            continue
        counted = count(algebra.function("model", inputs, derived, cse=True))
        found.append((counted.operations, counted.trigonometric_pairs, index, form))
    if not found:
        raise RuntimeError(f"no form fits {robot.name}")
    return [form for *_, form in sorted(found, key=lambda entry: entry[:3])]
