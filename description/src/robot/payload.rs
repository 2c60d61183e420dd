//! The tables `[payload.NAME]`: payloads on bodies, which some runs carry.

use crate::diagnostic::{Code, Diagnostic, Span};
use crate::robot::frame::Bodies;
use crate::robot::geometry::placement;
use crate::robot::leg::chain::GROUND;
use crate::robot::model::{FrameBody, Leg, Payload, Spanned};
use crate::robot::parameters::Owner;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word};
use overact_core::StandardParameter;

/// Largest number of payloads of a robot.
const MOST: usize = 100;

/// Reads all payloads in the order of the file.
pub(crate) fn read(
    table: &Table<'_, '_>,
    has_platform: bool,
    legs: &[Leg],
    scope: &Scope,
) -> Vec<Payload> {
    let payloads = table
        .get("payload")
        .and_then(|item| item.table("the table `[payload]`"));
    let mut items = payloads.map_or_else(Vec::new, |payloads| payloads.items());
    items.sort_by_key(|item| item.key.span.start);
    if let Some(next) = items.get(MOST) {
        let message = format!("there are more than {MOST} payloads");
        let error = Diagnostic::new(Code::PAYLOAD, message, next.key.span.clone());
        let help = "describe those of further runs in another file";
        table.context.report(error.help(help));
    }
    let bodies = Bodies { has_platform, legs };
    let read = |item: &Item<'_, '_>| payload(item, &bodies, scope);
    items.iter().take(MOST).filter_map(read).collect()
}

/// One payload; `None` after an error.
fn payload(item: &Item<'_, '_>, bodies: &Bodies<'_>, scope: &Scope) -> Option<Payload> {
    let name = item.key.clone();
    let table = item.table(format!("the payload `{}`", name.value))?;
    if !is_word(&name.value) {
        let message = format!("`{}` cannot be the name of a payload", name.value);
        let error = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        let help = "its parameters are named after it: use letters, digits and underscores";
        item.context.report(error.help(help));
    }
    let (at, rotation) = (table.get("at"), table.get("rotation"));
    let placement = placement(at.as_ref(), rotation.as_ref(), scope);
    let body = match (table.get("body"), bodies.has_platform) {
        (Some(item), _) => item.string().and_then(|text| body(&text, bodies, &table)),
        (None, true) => Some(FrameBody::Platform),
        (None, false) => {
            let help = "for instance body = \"elbow\", the joint that moves the body";
            let _ = table.require("body", help);
            None
        }
    };
    let owner = Owner::Joint(crate::robot::model::JointKind::Fixed);
    let parameters = table
        .get("parameters")
        .and_then(|item| item.parameters(owner));
    table.finish();
    Some(Payload {
        name,
        body: body?,
        placement,
        parameters: parameters.unwrap_or_else(|| StandardParameter::INERTIA.to_vec()),
        span: table.span.clone(),
    })
}

/// The body of a name; `None` after an error.
fn body(name: &Spanned<String>, bodies: &Bodies<'_>, table: &Table<'_, '_>) -> Option<FrameBody> {
    if name.value == GROUND {
        let message = "a payload on the ground does not move";
        let error = Diagnostic::new(Code::PAYLOAD, message, name.span.clone());
        let help = "name a body that moves, by its joint or as \"platform\"";
        table.context.report(error.help(help));
        return None;
    }
    // After another error the intended body may be missing.
    let is_clean = table.context.is_clean();
    let found = bodies.find(name);
    let report = |error| {
        if is_clean {
            table.context.report(error);
        }
    };
    found.map_err(report).ok()
}

/// Reports other descriptions of payloads next to these tables.
pub(crate) fn check_alone(
    table: &Table<'_, '_>,
    payloads: &[Payload],
    of_platform: Option<Span>,
    legs: &[Leg],
) {
    if payloads.is_empty() {
        return;
    }
    let names = table.get("payloads").map(|item| item.span);
    let mut joints = legs.iter().flat_map(|leg| &leg.joints);
    let joint = joints.find(|joint| joint.is_payload());
    let joint = joint.map(|joint| joint.span.clone());
    for other in [of_platform, names, joint].into_iter().flatten() {
        let message = "payloads with tables of their own are described twice";
        let error = Diagnostic::new(Code::CONTRADICTION, message, other);
        let help = "describe each payload as [payload.NAME], and leave this out";
        table.context.report(error.help(help));
    }
}
