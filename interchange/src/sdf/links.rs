//! Masses and inertias of links.

use super::{
    contents::{Link, SdfContents},
    value::{attribute_flag, flag, number, pose, reference_frame},
};
use crate::model::{Inertia, Model};
use nalgebra::{Matrix3, Point3};

/// Inertia of a link, and whether the link has inertia whose value the file does not give.
pub(super) fn inertia(contents: &SdfContents<'_>, link: &Link) -> (Option<Inertia>, bool) {
    let files = contents.files;
    let Some(inertial) = link.element.child("inertial") else {
        return (Some(usual()), false);
    };
    if attribute_flag(files, inertial, "auto") {
        let reason = "inertias from collision shapes and densities are not computed: the link's has no value";
        files.demote(&inertial.place, "inertial", Some("auto"), reason);
        return (None, true);
    }
    let own = inertial.child("pose");
    if let Some((name, place)) = reference_frame(own) {
        let message = format!("the pose of an <inertial> is relative to its link, not to `{name}`");
        let help = "give it in the frame of the link, without relative_to";
        files.report(place, message, help);
    }
    let mass = number(files, inertial, "mass", 1.0);
    if mass < 0.0 {
        let message = "a mass is negative";
        files.report(&inertial.place, message, "give a mass that is zero or more");
    }
    let tensor = inertial
        .child("inertia")
        .map_or_else(Matrix3::identity, |of| {
            let value = |name: &str, default| number(files, of, name, default);
            let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| value(name, 1.0));
            let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| value(name, 0.0));
            Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
        });
    let frame = pose(files, own);
    let about_centre = Inertia {
        mass,
        centre: Point3::origin(),
        tensor,
    };
    (Some(about_centre.transformed(&frame)), false)
}

/// Default inertia of SDFormat.
fn usual() -> Inertia {
    Inertia {
        mass: 1.0,
        centre: Point3::origin(),
        tensor: Matrix3::identity(),
    }
}

/// Adds notes on links with SDFormat's default inertia and on links of unknown mass.
pub(super) fn notes(contents: &SdfContents<'_>, links: &[usize], model: &mut Model) {
    let listed = |is: &dyn Fn(&Link) -> bool| {
        let own = links.iter().map(|&link| &contents.links[link]);
        let names: Vec<String> = own
            .filter(|link| is(link))
            .map(|link| format!("`{}`", link.name))
            .collect();
        (!names.is_empty()).then(|| names.join(", "))
    };
    if let Some(list) = listed(&|link| link.element.child("inertial").is_none()) {
        model.notes.push(format!(
            "Without <inertial>: {list}. SDFormat gives each of them 1 kg and 1 kg m^2 about its origin, as here."
        ));
    }
}

/// Checks that gravity acts on all links or on none.
///
/// The error lists the links without gravity.
pub(super) fn gravity(contents: &SdfContents<'_>, links: &[usize], model: &mut Model) {
    let files = contents.files;
    let is_light = |link: &&usize| {
        let element = &contents.links[**link].element;
        element.child("gravity").is_some() && !flag(files, element, "gravity")
    };
    let light: Vec<usize> = links.iter().filter(is_light).copied().collect();
    if light.len() == links.len() && !light.is_empty() {
        model.gravity = [0.0; 3];
        return;
    }
    for link in light {
        let own = &contents.links[link];
        let place = own.element.child("gravity").map(|element| &element.place);
        let message = format!(
            "gravity does not act on `{}` only, which is not supported",
            own.name
        );
        let help = "remove <gravity>, or write it for all links";
        files.report(place.unwrap_or(&own.element.place), message, help);
    }
}
