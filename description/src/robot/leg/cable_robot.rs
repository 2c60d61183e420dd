//! Conditions on robots with cables.

use crate::diagnostic::{Code, Diagnostic, Span};
use crate::robot::model::{Leg, Motion, Platform};
use crate::robot::shape::Shape;
use crate::toml_text::reader::Context;

/// Reports cables of robots that cannot have any.
pub(crate) fn check(
    context: &Context<'_>,
    shapes: &[Shape<'_, '_>],
    has_platform: bool,
    platform: Option<&Platform>,
    legs: &[Leg],
) {
    let report = |span: &Span, message: String, help: &str| {
        let error = Diagnostic::new(Code::STRUCTURE, message, span.clone());
        context.report_once(error.help(help));
    };
    for shape in shapes.iter().filter(|shape| shape.cable.is_some()) {
        let (name, span) = (&shape.name.value, &shape.span);
        if !has_platform {
            let help = "describe the platform in a table [platform]";
            let message = format!("the cable `{name}` ends on a platform, but there is none");
            report(span, message, help);
        }
        if let Some(body) = &shape.base_body {
            let message = format!("the cable `{name}` cannot start from a body");
            let help = "its exit point is fixed on the ground: leave `body` out";
            report(&body.span, message, help);
        }
    }
    let parasitic =
        platform.is_some_and(|own| matches!(own.motion.value, Motion::Parasitic { .. }));
    if let (true, Some(leg)) = (parasitic, legs.iter().find(|leg| leg.cable.is_some())) {
        let message = format!(
            "the cable `{}` cannot pull a platform with parasitic motion",
            leg.name.value
        );
        let help = "cables are supported for platforms whose coordinates are all independent: leave out `independent`";
        report(&leg.span, message, help);
    }
}
