//! A robot's drawing: bodies, joints, frames and platform at the home configuration, as one SVG text.
//!
//! - `layout`: a mechanism becomes a `scene` of lines, joints and plates in space, leg by leg (`walk`); a
//!   robot whose axes all meet in one point has no lengths and is drawn on a `sphere` around it;
//! - `view`: planar robots are seen along the normal of their plane, others from the side
//!   that separates their joints best;
//! - `paint` puts the scene on a `sheet`, from far to near: `ground`, `joints`, `labels`.
//!
//! The text needs nothing from elsewhere: no fonts, no links, no scripts. Its colours follow the reader's
//! choice of light or dark. All class names begin with `ov-`, so that the text may stand within a page.

mod ground;
mod joints;
mod labels;
mod layout;
mod paint;
mod scene;
mod sheet;
mod sphere;
mod style;
mod view;
mod walk;

use layout::scene;
use overact_codegen::mechanism::Mechanism;
use sheet::Sheet;
use view::View;

/// Draws a mechanism at its home configuration; the same bytes for the same mechanism.
#[must_use]
pub fn svg(mechanism: &Mechanism) -> String {
    drawn(mechanism, None)
}

/// Draws a mechanism as it is seen after it has been turned by these angles, rad: `around` its vertical, to the
/// right, and `over` towards the reader. The sheet holds the robot however it is turned, so that neither its size
/// nor its scale changes from one view to the next.
#[must_use]
pub fn turned(mechanism: &Mechanism, around: f64, over: f64) -> String {
    drawn(mechanism, Some([around, over]))
}

fn drawn(mechanism: &Mechanism, turn: Option<[f64; 2]>) -> String {
    let mechanism = &bodies(mechanism);
    // Some symbols are as large on paper for every robot: the scale has to be known before they are
    // placed.
    let rough = scene(mechanism, 0.0);
    let own = View::of(mechanism, &rough);
    let view = turn.map_or(own, |[around, over]| own.turned(around, over));
    let fitted = match turn {
        None => Sheet::fitted,
        Some(_) => Sheet::around,
    };
    let pixel = fitted(&rough, &view).pixel();
    let scene = scene(mechanism, pixel);
    let sheet = fitted(&scene, &view);
    paint::document(mechanism, &scene, &view, &sheet)
}

/// The mechanism without the motors that turn several joints: they have no body.
fn bodies(mechanism: &Mechanism) -> Mechanism {
    let mut mechanism = mechanism.clone();
    for leg in &mut mechanism.legs {
        leg.joints.retain(|joint| joint.motor.is_none());
    }
    mechanism
}

#[cfg(test)]
mod tests {
    use super::turned;
    use overact_codegen::{Source, check, mechanism::Mechanism};
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn mechanism(text: &str) -> Mechanism {
        check(&Source::new("robot.toml", text))
            .expect("a robot")
            .mechanism
    }

    /// The first numbers that follow a mark, of all elements that have it.
    fn places(drawing: &str, mark: &str) -> Vec<f64> {
        let after = drawing.split(mark).skip(1);
        let number = |text: &str| {
            let end = text.find(|c: char| c != '-' && c != '.' && !c.is_ascii_digit());
            text[..end.unwrap_or(text.len())].parse().expect("a number")
        };
        after.map(number).collect()
    }

    #[test]
    fn a_robot_that_is_turned_keeps_sheet_and_parts() {
        for text in [
            include_str!("../../../robots/dualv.toml"),
            include_str!("../../../robots/hexapod.toml"),
            include_str!("../../../robots/rx90.toml"),
            include_str!("../../../robots/emps.toml"),
        ] {
            let mechanism = mechanism(text);
            let first = turned(&mechanism, 0.0, 0.0);
            let height = places(&first, "viewBox=\"0 0 720 ")[0];
            for (around, over) in [(0.4, 0.0), (0.0, 1.2), (-2.0, 0.7), (0.0, FRAC_PI_2)] {
                let other = turned(&mechanism, around, over);
                assert_ne!(first, other);
                assert_eq!(first.matches(">M<").count(), other.matches(">M<").count());
                assert_eq!(places(&other, "viewBox=\"0 0 720 ")[0], height);
                for mark in ["translate(", "class=\"ov-motor\" x=\""] {
                    for place in places(&other, mark) {
                        assert!((0.0..720.0).contains(&place), "{mark}{place}");
                    }
                }
            }
            assert_eq!(
                turned(&mechanism, TAU + 0.4, 0.0),
                turned(&mechanism, 0.4, 0.0)
            );
        }
    }
}
