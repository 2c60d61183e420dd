"""The whole robot: inputs, legs, platform; rows x columns of the identification model."""

from .algebra import (
    apply,
    dot,
    identity,
    inverse_by_cofactors,
    inverse_by_elimination,
    matrix,
    product,
    transpose,
    vector,
)
from .closure import close
from .model import Angles, LegModel
from .platform import Platform

INVERSES = {"elimination": inverse_by_elimination, "cofactors": inverse_by_cofactors}


def symbols(algebra, inputs):
    """Scalars of the inputs; `inputs` are names and lengths in the order of the function's arguments."""
    return {name: [algebra.symbol(f"{name}[{i}]") for i in range(length)] for name, length in inputs}


def columns(robot, algebra, inputs, names, form, homes=()):
    """The model's columns `names`, each a list of `dof` scalars.

    `homes` are the joints at home, which determine the working modes if the joints are not inputs.
    """
    values = symbols(algebra, inputs)
    wanted = set(names)
    found = serial(robot, algebra, values, wanted, form) if robot.motion is None else {}
    if robot.motion is not None:
        found = parallel(robot, algebra, values, wanted, form, homes)
    return [found[name] for name in names]


def own_name(wanted, *suffix):
    def name(joint, symbol):
        text = "_".join([symbol, joint.name, *suffix])
        return text if text in wanted else None

    return name


def serial(robot, algebra, values, wanted, form):
    """Joint torques of a chain without loops."""
    (leg,) = robot.legs
    variables = {joint.name: values["joints"][j] for j, joint in enumerate(leg.joints)}
    angles = Angles(algebra, variables)
    model = LegModel(robot, leg, angles, form)
    rates = dict(enumerate(values["joint_velocities"]))
    accelerations = dict(enumerate(values["joint_accelerations"]))
    inverse = identity(len(leg.joints))
    return model.columns(inverse, rates, accelerations, algebra, own_name(wanted))


def parallel(robot, algebra, values, wanted, form, homes):
    """Inputs projected on the platform."""
    angles = Angles(algebra, {})
    platform = Platform(robot, algebra, angles, values)
    found = platform.columns(lambda s: f"{s}_platform" if f"{s}_platform" in wanted else None)
    start = 0
    for leg in robot.legs:
        moving = [joint for joint in leg.joints if joint.kind != "fixed"]
        if "joints" in values:
            angles.variables.update({j.name: values["joints"][start + k] for k, j in enumerate(moving)})
        angles.known = {key: pair for key, pair in angles.known.items() if key[0][0][0] == "phi"}
        if "joints" not in values:
            close(angles, algebra, platform, leg, values["pose"], homes[start : start + len(moving)])
        start += len(moving)
        found |= leg_columns(robot, algebra, angles, platform, leg, wanted, form)
    return found


def leg_columns(robot, algebra, angles, platform, leg, wanted, form):
    model = LegModel(robot, leg, angles, form)
    frame = form.frame if form.frame >= 0 else model.n
    to_frame = transpose(rotation_to(model, platform, leg, frame))
    partials, velocity, acceleration = platform.end(leg)

    def seen(pair):
        linear, angular = pair
        return apply(to_frame, linear) + apply(to_frame, angular)

    jacobian = model.jacobian(frame)
    end_moves = [seen(pair) for pair in partials]
    rows = independent_rows(jacobian, leg)
    inverse = INVERSES[form.inverse](transpose([[column[i] for i in rows] for column in jacobian]))
    move_rows = transpose([[move[i] for i in rows] for move in end_moves])
    full = inverse if form.staged else product(inverse, move_rows)
    if form.staged:
        rates = apply(inverse, [seen(velocity)[i] for i in rows])
    else:
        twist = values_of(platform)
        rates = apply(full, twist)
    rates = dict(zip(model.moving, rates, strict=True))
    drift = end_drift(model, rates, frame)
    rest = [seen(acceleration)[i] - drift[i] for i in rows]
    accelerations = dict(zip(model.moving, apply(inverse, rest), strict=True))
    found = model.columns(full, rates, accelerations, algebra, own_name(wanted, leg.name))
    if form.staged:
        found = {name: apply(transpose(move_rows), column) for name, column in found.items()}
    return found


def values_of(platform):
    """Independent coordinates of the twist."""
    return [
        dot(v, platform.velocity) if any(not x.is_zero for x in v) else dot(w, platform.omega)
        for v, w in platform.moves
    ]


def rotation_to(model, platform, leg, frame):
    """Axes of a leg's frame in the base frame; those of a rigid end are known from the platform."""
    if frame == model.n and leg.end_type == "rigid":
        return product(platform.rotation, matrix(leg.end_rotation))
    return product(matrix(leg.base_rotation), model.chain.rotation(0, frame))


def independent_rows(jacobian, leg):
    """Rows of the end's velocity (and angular velocity) in which the leg can move."""
    count = 6 if leg.end_type == "rigid" else 3
    rows = [i for i in range(count) if any(not column[i].is_zero for column in jacobian)]
    if len(rows) != len(jacobian):
        raise NotImplementedError("a leg whose closure is not square in this frame")
    return rows


def end_drift(model, rates, frame):
    """Acceleration of the leg's end without joint accelerations, in a frame."""
    motions = model.forward(rates, {}, vector([0] * 3))
    rotation = model.chain.rotation(frame, model.n)
    last = motions[-1]
    return apply(rotation, last.acceleration) + apply(rotation, last.alpha)
