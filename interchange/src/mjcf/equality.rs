//! Equality constraints: coincident points and frames, and joint couplings.

use super::{
    BOOLEAN, Reader, Sites,
    defaults::{EQUALITY, MAIN},
    names::WORLD,
    tendons::Tendons,
};
use crate::{
    account::Use,
    assembly::motion::Motion,
    couplings::{Coupling, Couplings},
    geometry::exact,
    model::{Closure, ClosureKind, Model, Pose},
    xml::Element,
};
use nalgebra::{Point3, Vector3};

/// Reads `<equality>`: closures into the model, couplings into its joints.
pub(super) fn read(
    reader: &Reader<'_>,
    root: &Element,
    sites: &Sites,
    tendons: &mut Tendons,
    model: &mut Model,
) {
    // A constraint gives the frame on one body. The other follows from the poses of the file.
    let poses = Motion::new(model).start().poses;
    let mut couplings = Couplings::default();
    for section in root.all("equality") {
        for element in &section.children {
            let whole = reader
                .defaults
                .apply_as(EQUALITY, reader.files, element, MAIN);
            if whole.keyword(reader.files, "active", BOOLEAN) == Some("false") {
                let reason = "inactive";
                let tag = &whole.name;
                reader
                    .files
                    .record(Use::Ignored, &whole.place, tag, None, reason);
                continue;
            }
            match whole.name.as_str() {
                "connect" | "weld" => {
                    if let Some(kind) = closure_kind(reader, &whole, sites, model, &poses) {
                        let (name, place) = (name_of(&whole), whole.place.clone());
                        model.closures.push(Closure { name, kind, place });
                    }
                }
                "joint" => read_coupling(reader, &whole, model, &mut couplings),
                "tendon" => {
                    let found = of_tendons(reader, &whole, tendons, model);
                    found.into_iter().for_each(|own| couplings.add(own));
                }
                other => {
                    let message = format!("the equality <{other}> is not supported");
                    reader.files.report(
                        &whole.place,
                        message,
                        "supported are connect, weld, joint and tendon",
                    );
                }
            }
        }
    }
    couplings.resolve(reader.files, model);
}

/// Whether constraints close loops.
pub(super) fn has_closures(root: &Element) -> bool {
    let mut sections = root.all("equality");
    sections.any(|section| {
        let mut children = section.children.iter();
        children.any(|child| ["connect", "weld"].contains(&child.name.as_str()))
    })
}

/// Name of a constraint, or of the elements that it connects.
fn name_of(element: &Element) -> String {
    let ends = [["site1", "site2"], ["body1", "body2"], ["joint1", "joint2"]];
    let joined = ends.iter().find_map(|[a, b]| {
        let a = element.get(a)?;
        Some(match element.get(b) {
            Some(b) => format!("{a} and {b}"),
            None => a.to_owned(),
        })
    });
    let own = element.get("name").map(str::to_owned);
    own.or(joined).unwrap_or_else(|| element.name.clone())
}

/// Closure of a `<connect>` or `<weld>`; `None` after an error.
fn closure_kind(
    reader: &Reader<'_>,
    element: &Element,
    sites: &Sites,
    model: &Model,
    poses: &[Pose],
) -> Option<ClosureKind> {
    let files = reader.files;
    let is_connect = element.name == "connect";
    // A weld whose torques have the scale zero holds a point alone.
    let is_point = is_connect || element.numbers::<1>(files, "torquescale") == Some([0.0]);
    if element.get("site1").is_some() || element.get("site2").is_some() {
        let site = |key: &str| {
            let name = element.required(files, key)?;
            let found = sites.get(name).copied();
            if found.is_none() {
                let near = files.did_you_mean(name, sites.keys().map(String::as_str));
                let help = near.unwrap_or_else(|| "name a site of a body".to_owned());
                files.report(&element.place, format!("there is no site `{name}`"), help);
            }
            found
        };
        let (a, b) = (site("site1")?, site("site2")?);
        let (bodies, at) = ([a.0, b.0], [a.1, b.1]);
        return Some(if is_point {
            ClosureKind::Point {
                bodies,
                at: at.map(|f| Point3::from(f.translation.vector)),
            }
        } else {
            ClosureKind::Weld { bodies, at }
        });
    }
    let body = |key: &str| {
        let name = element.get(key).unwrap_or(WORLD);
        let found = if name == WORLD {
            Some(0)
        } else {
            model.body_named(name)
        };
        if found.is_none() {
            let all = model.bodies.iter().map(|body| body.name.as_str());
            let near = files.did_you_mean(name, all);
            let help = near.unwrap_or_else(|| "name a body".to_owned());
            files.report(&element.place, format!("there is no body `{name}`"), help);
        }
        found
    };
    element.required(files, "body1")?;
    let bodies = [body("body1")?, body("body2")?];
    let relative = poses[bodies[1]].inv_mul(&poses[bodies[0]]);
    if is_connect {
        element.required(files, "anchor")?;
        let anchor = Point3::from(element.numbers(files, "anchor")?);
        return Some(ClosureKind::Point {
            bodies,
            at: [anchor, relative * anchor],
        });
    }
    let anchor: [f64; 3] = element.numbers(files, "anchor").unwrap_or_default();
    let second = Pose::from_parts(
        Vector3::from(anchor).into(),
        nalgebra::Rotation3::identity(),
    );
    let given = element
        .numbers::<7>(files, "relpose")
        .filter(|pose| pose[3..].iter().any(|v| *v != 0.0));
    let second_in_first = match given {
        Some([x, y, z, w, i, j, k]) => {
            let turn = exact::quaternion([w, i, j, k]).unwrap_or_default();
            Pose::from_parts(Vector3::new(x, y, z).into(), turn)
        }
        None => relative.inverse(),
    };
    let at = [second_in_first * second, second];
    Some(if is_point {
        ClosureKind::Point {
            bodies,
            at: at.map(|frame| Point3::from(frame.translation.vector)),
        }
    } else {
        ClosureKind::Weld { bodies, at }
    })
}

/// Reads `<joint>`: a linear coupling of one joint to another.
fn read_coupling(reader: &Reader<'_>, element: &Element, model: &Model, couplings: &mut Couplings) {
    let files = reader.files;
    let joint = |key: &str| {
        let name = element.get(key)?;
        let found = model.joint_named(name);
        if found.is_none() {
            let all = model.joints.iter().map(|joint| joint.name.as_str());
            let help = files.joint_help(name, all);
            files.report(&element.place, format!("there is no joint `{name}`"), help);
        }
        found
    };
    let (Some(own), Some(leader)) = (joint("joint1"), joint("joint2")) else {
        if element.get("joint2").is_none() {
            let help = "fix the body: remove the joint";
            files.report(
                &element.place,
                "an equality that fixes a joint is not supported",
                help,
            );
        }
        return;
    };
    let Some([c0, factor]) = linear(reader, element) else {
        return;
    };
    // MuJoCo couples displacements from the reference positions (`ref`) of both joints.
    let offset = c0 + model.joints[own].reference - factor * model.joints[leader].reference;
    couplings.add(Coupling {
        follower: own,
        leader,
        factor,
        offset,
        place: element.place.clone(),
    });
}

/// Constant and factor of `polycoef`; `None` after an error.
fn linear(reader: &Reader<'_>, element: &Element) -> Option<[f64; 2]> {
    let coefficients = element.list(reader.files, "polycoef").unwrap_or_default();
    if coefficients.iter().skip(2).any(|c| *c != 0.0) {
        let message = "a nonlinear coupling of joints is not supported";
        let help = "a coupling must be linear: polycoef=\"c0 c1 0 0 0\"";
        reader.files.report(&element.place, message, help);
        return None;
    }
    // Missing coefficients have MuJoCo's defaults 0 1 0 0 0.
    let coefficient = |at: usize, default| coefficients.get(at).copied().unwrap_or(default);
    Some([coefficient(0, 0.0), coefficient(1, 1.0)])
}

/// Coupling of two joints by the lengths of fixed tendons; `None` after an error.
///
/// MuJoCo couples changes of length from the reference positions (`ref`) of the joints:
/// l1 = c0 + c1 l2.
fn of_tendons(
    reader: &Reader<'_>,
    element: &Element,
    tendons: &mut Tendons,
    model: &Model,
) -> Option<Coupling> {
    let files = reader.files;
    let mut joints = |key: &str| {
        let (name, place) = element.attribute(key)?;
        let tendon = tendons.find(files, name, place)?;
        if tendon.joints.is_none() {
            let message = format!("`{name}` is a spatial tendon, whose length cannot be coupled");
            files.report(place, message, "couple fixed tendons, or joints");
        }
        tendon.joints.clone()
    };
    element.required(files, "tendon1")?;
    let first = joints("tendon1")?;
    let second = match element.get("tendon2") {
        Some(_) => joints("tendon2")?,
        None => Vec::new(),
    };
    let [c0, factor] = linear(reader, element)?;
    let second = second
        .into_iter()
        .map(|(joint, own)| (joint, -factor * own));
    let terms: Vec<(usize, f64)> = first.into_iter().chain(second).collect();
    let references = terms
        .iter()
        .map(|(joint, own)| own * model.joints[*joint].reference);
    let constant = c0 + references.sum::<f64>();
    let found = Coupling::of_sum(&terms, constant, &element.place);
    if found.is_none() {
        let message = "an equality of tendons that does not couple two joints is not supported";
        let help = "couple two joints, or fix a body: remove its joint";
        files.report(&element.place, message, help);
    }
    found
}
