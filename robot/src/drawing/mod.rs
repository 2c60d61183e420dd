//! Drawing of a robot at its home configuration, as an SVG text.
//!
//! - `layout` converts a mechanism to a `scene` of lines, joints and plates in space, leg by leg
//!   (`walk`). A robot whose axes all meet in one point has no lengths and is drawn on a `sphere`
//!   around it.
//! - `view` chooses the direction: planar robots along the normal of their plane, others from the
//!   side that separates their joints best.
//! - `paint` draws the scene on a `sheet`, from far to near: `ground`, `joints`, `labels`.
//!
//! The text needs no external fonts, links or scripts. Its colours follow the reader's choice of
//! light or dark. All class names begin with `ov-`, so that the text can be embedded in a page.

mod ground;
mod joints;
mod labels;
mod layout;
mod paint;
mod paper;
mod scene;
mod sphere;
mod style;
mod view;
mod walk;

use layout::scene;
use overact_codegen::mechanism::Mechanism;
use paper::Sheet;
use view::View;

/// Draws a mechanism at its home configuration; the output is deterministic.
#[must_use]
pub fn svg(mechanism: &Mechanism) -> String {
    drawn(mechanism, None)
}

/// Draws a mechanism rotated by two angles, rad.
///
/// `around` rotates it about its vertical to the right, `over` then towards the reader. Size and
/// scale of the sheet do not depend on the angles.
#[must_use]
pub fn turned(mechanism: &Mechanism, around: f64, over: f64) -> String {
    drawn(mechanism, Some([around, over]))
}

fn drawn(mechanism: &Mechanism, turn: Option<[f64; 2]>) -> String {
    let mechanism = &bodies(mechanism);
    // Some symbols have a fixed size on paper, so the scale must be known before they are placed.
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

/// Mechanism without motors that drive several joints, which have no body.
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

    /// First numbers after a mark, for each of its occurrences.
    fn places(drawing: &str, mark: &str) -> Vec<f64> {
        let after = drawing.split(mark).skip(1);
        let number = |text: &str| {
            let end = text.find(|c: char| c != '-' && c != '.' && !c.is_ascii_digit());
            text[..end.unwrap_or(text.len())].parse().expect("a number")
        };
        after.map(number).collect()
    }

    #[test]
    fn rotated_drawings_keep_sheet_and_elements() {
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
