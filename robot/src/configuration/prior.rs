//! Prior of the inertial parameters: the `[prior]` table, and uniform rods between joints.

use std::collections::BTreeMap;

use crate::parameters::body::leg_body;
use nalgebra::{Matrix3, Rotation3, Vector3};
use overact::{Body, Info, Parameter, StandardParameter};
use overact_codegen::description::{Description, Joint, JointKind};
use overact_identification::{Prior, is_carried, load_of};

/// Smallest length of a rod, relative to the mean length.
const SHORTEST: f64 = 0.3;

/// Mean square half width of a rod, relative to the square of the mean length.
const SQUARE_WIDTH: f64 = 0.01;

/// A standard parameter: name, symbol and body.
pub(crate) type NamedParameter<'a> = (&'a str, StandardParameter, Body);

/// Standard parameters of a robot and of its payloads.
pub(crate) fn with_loads(
    description: &Description,
    info: &Info<'_>,
) -> Vec<(String, StandardParameter, Body)> {
    let all = || info.parameters.iter().chain(info.payload_parameters);
    let own = all().map(|one| (one.name.to_owned(), one.symbol, one.body));
    let loads = description.payloads.iter().flat_map(|load| {
        let loads = all().filter(|one| is_of_payload(one));
        let loads = loads.filter(|one| load_of(one).is_none());
        loads.map(|one| (of_load(one.name, &load.value), one.symbol, one.body))
    });
    own.chain(loads).collect()
}

/// Whether a parameter belongs to the payload.
pub(crate) fn is_of_payload(parameter: &Parameter) -> bool {
    parameter.body == Body::Payload || is_carried(parameter)
}

/// Name of a payload's parameter for a named payload.
///
/// Parameters of payloads with tables of their own have these names; for other payloads the name is
/// empty.
pub(crate) fn of_load(parameter: &str, load: &str) -> String {
    match parameter.split_once("_payload_") {
        Some((_, own)) if own == load => parameter.to_owned(),
        Some(_) => String::new(),
        None => format!("{parameter}_{load}"),
    }
}

/// Prior for a robot with these standard parameters and this home configuration.
pub(crate) fn prior<N: AsRef<str>>(
    description: &Description,
    parameters: &[(N, StandardParameter, Body)],
    home_joints: &[f64],
) -> Prior {
    let mut prior = Prior {
        values: { description.prior.values.iter() }
            .filter(|(name, _)| !description.prior.held.iter().any(|(held, _)| held == name))
            .cloned()
            .collect(),
        bounds: description.prior.bounds.iter().cloned().collect(),
        held: description.prior.held.iter().cloned().collect(),
        ..Prior::default()
    };
    let links = links(description, home_joints);
    let lengths: Vec<f64> = links.values().map(|link| link.norm()).collect();
    let moving: Vec<&f64> = lengths.iter().filter(|length| **length > 0.0).collect();
    let mean = moving.iter().copied().sum::<f64>() / moving.len().max(1) as f64;
    let mean = if mean > 0.0 { mean } else { 0.1 };
    let inertial = parameters.iter();
    for (name, symbol, body) in inertial.filter(|(_, symbol, _)| symbol.is_inertial()) {
        let suffix = name
            .as_ref()
            .strip_prefix(symbol.name())
            .unwrap_or_default();
        let name = |symbol: StandardParameter| format!("{}{suffix}", symbol.name());
        let link = links.get(body).copied().unwrap_or_default();
        let values = rod(link, mean);
        let named = StandardParameter::INERTIA.map(name).into_iter().zip(values);
        prior.uniform.extend(named);
    }
    prior
}

/// Mean vector from each body's joint to the next ones, in the body's frame, m.
fn links(description: &Description, home_joints: &[f64]) -> BTreeMap<Body, Vector3<f64>> {
    let mut positions = home_joints.iter();
    let mut links = BTreeMap::new();
    for (number, leg) in description.legs.iter().enumerate() {
        let mut ends: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); leg.joints.len()];
        for (index, joint) in leg.joints.iter().enumerate() {
            let position = if joint.is_independent(index) {
                positions.next().copied().unwrap_or(0.0)
            } else {
                0.0
            };
            if let Some(end) = joint.antecedent.and_then(|from| ends.get_mut(from)) {
                end.push(origin(joint, position));
            }
        }
        for (index, ends) in ends.iter().enumerate() {
            let count = ends.len().max(1) as f64;
            let mean: Vector3<f64> = ends.iter().sum::<Vector3<f64>>() / count;
            links.insert(leg_body(number, index, leg.shape), mean);
        }
    }
    links
}

/// Origin of a joint's frame in that of its antecedent, at a joint position.
fn origin(joint: &Joint, position: f64) -> Vector3<f64> {
    let slide = match joint.kind.value {
        JointKind::Prismatic => position,
        JointKind::Revolute | JointKind::Fixed => 0.0,
    };
    let along = Vector3::z() * (joint.r.value.value() + slide);
    let turned = Rotation3::from_axis_angle(&Vector3::x_axis(), joint.alpha.value.value()) * along;
    let shifted = Vector3::new(joint.d.value.value(), 0.0, joint.b.value.value()) + turned;
    Rotation3::from_axis_angle(&Vector3::z_axis(), joint.gamma.value.value()) * shifted
}

/// Ten parameters of a rod from the origin to `end`, with mass equal to its length.
///
/// Shorter rods get a smallest length relative to `mean`, the mean length of the robot's bodies.
fn rod(end: Vector3<f64>, mean: f64) -> [f64; 10] {
    let mass = end.norm().max(SHORTEST * mean);
    let width = Matrix3::identity() * (SQUARE_WIDTH * mean * mean);
    let second = (end * end.transpose() / 3.0 + width) * mass;
    let first = end * (0.5 * mass);
    let trace = second.trace();
    [
        trace - second[(0, 0)],
        -second[(0, 1)],
        -second[(0, 2)],
        trace - second[(1, 1)],
        -second[(1, 2)],
        trace - second[(2, 2)],
        first[0],
        first[1],
        first[2],
        mass,
    ]
}
