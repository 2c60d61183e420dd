"""Search for a peer's best form for a robot: the fewest operations after `cse`."""

import itertools

from .casadi_peer import Casadi, count
from .model import Form
from .robot import columns


def forms(robot):
    """All distinct forms for a robot."""
    if robot.motion is None:
        for merged, kind in itertools.product([False, True], ["partial", "recursion"]):
            yield Form(merged=merged, columns=kind)
        return
    frames = range(1 + max(len(leg.joints) for leg in robot.legs))
    for frame, merged, inverse, kind, staged in itertools.product(
        frames, [False, True], ["elimination", "cofactors"], ["partial", "recursion"], [True, False]
    ):
        yield Form(frame, merged, inverse, kind, staged)


#: Weight of one sine-cosine pair in operations, to rank forms.
PAIR = 15


def best(robot, inputs, names, homes=()):
    """The form with the fewest operations of CasADi's function after `cse`, then the others by operations and
    sine-cosine pairs."""
    found = []
    for index, form in enumerate(forms(robot)):
        algebra = Casadi()
        try:
            derived = columns(robot, algebra, inputs, names, form, homes)
        except NotImplementedError:
            # The closure is not square in this frame; another one is used.
            continue
        counted = count(algebra.function("model", inputs, derived, cse=True))
        found.append((counted, index, form))
    if not found:
        raise RuntimeError(f"no form fits {robot.name}")
    fewest = min(found, key=lambda entry: (entry[0].operations, entry[0].trigonometric_pairs, entry[1]))
    rest = [entry for entry in found if entry is not fewest]
    rest.sort(key=lambda entry: (entry[0].operations + PAIR * entry[0].trigonometric_pairs, entry[1]))
    return [form for _, _, form in [fewest, *rest]]
