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
    let mechanism = &bodies(mechanism);
    // Some symbols are as large on paper for every robot: the scale has to be known before they are
    // placed.
    let rough = scene(mechanism, 0.0);
    let view = View::of(mechanism, &rough);
    let pixel = Sheet::fitted(&rough, &view).pixel();
    let scene = scene(mechanism, pixel);
    let sheet = Sheet::fitted(&scene, &view);
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
