//! The key `held` of `[prior]`: bodies and parameters that keep their prior values.

use crate::diagnostic::{Code, Diagnostic, Span, did_you_mean};
use crate::experiments::experiment::TrueParameter;
use crate::robot::frame::Bodies;
use crate::robot::inventory::{Body, Inventory};
use crate::robot::model::{FrameBody, Spanned};
use crate::toml_text::reader::Item;
use overact_core::StandardParameter;

/// Why parameters are not held together with corrections of the torques or of gravity.
pub const HELD_AND_CORRECTIONS: &str = "parameters are not held if gains of drives, the friction of gears or the direction of gravity are identified: these change what the held parameters contribute";

/// A parameter that is held, with the entry of the list that names it or its body.
pub(crate) struct HeldName {
    pub(crate) parameter: String,
    /// Name of its body; empty if the entry is the parameter itself.
    body: String,
    span: Span,
}

/// Parameters of the entries: names of bodies, whose inertial parameters are held, or of single
/// parameters.
pub(crate) fn names(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Vec<HeldName> {
    let mut all: Vec<HeldName> = Vec::new();
    for entry in item.strings().unwrap_or_default() {
        let found = of_entry(&entry, robot);
        let found = found.and_then(|own| {
            let twice = |one: &HeldName| all.iter().any(|other| other.parameter == one.parameter);
            if own.iter().any(twice) {
                let message = format!("`{}` is held twice", entry.value);
                let error = Diagnostic::new(Code::KNOWN, message, entry.span.clone());
                return Err(error.help("leave one of the entries out"));
            }
            Ok(own)
        });
        match found {
            Ok(own) => all.extend(own),
            Err(error) => item.context.report(error),
        }
    }
    all
}

fn of_entry(entry: &Spanned<String>, robot: &Inventory<'_>) -> Result<Vec<HeldName>, Diagnostic> {
    let known = robot.parameters();
    let error = |message: String, help: &str| {
        Diagnostic::new(Code::KNOWN, message, entry.span.clone()).help(help)
    };
    let name = |parameter: &String, body: &str| HeldName {
        parameter: parameter.clone(),
        body: body.to_owned(),
        span: entry.span.clone(),
    };
    if let Some((own, body, symbol, _)) = known.iter().find(|(own, ..)| *own == entry.value) {
        if *body == Body::Payload {
            let message = format!("`{own}` belongs to a payload, which only some runs carry");
            let help = "payloads are not held: a body that all runs carry is a fixed joint";
            return Err(error(message, help));
        }
        return match symbol {
            StandardParameter::Ia | StandardParameter::K => Ok(vec![name(own, "")]),
            symbol if symbol.is_inertial() => Err(error(
                format!("`{own}` is one of the parameters of a body"),
                "name the body: all of its inertial parameters are held",
            )),
            _ => Err(error(
                format!("`{own}` is friction or an offset, which is not held"),
                "bodies, rotor inertias and coefficients of springs are held; friction is identified",
            )),
        };
    }
    let bodies = Bodies {
        has_platform: robot.platform.is_some(),
        legs: robot.legs,
    };
    let body = bodies.find(entry).map_err(|_| {
        let names = bodies.names();
        let names = names.iter().map(|(name, _)| name.as_str());
        let near = did_you_mean(&entry.value, names);
        let message = format!("the robot has no body or parameter `{}`", entry.value);
        let help = near.unwrap_or_else(|| {
            String::from("write names of bodies, of rotor inertias or of coefficients of springs")
        });
        Diagnostic::new(Code::UNKNOWN_NAME, message, entry.span.clone()).help(help)
    })?;
    let body = match body {
        FrameBody::Platform => Body::Platform,
        FrameBody::Joint(own) => Body::Joint {
            leg: own.leg,
            joint: own.joint,
        },
    };
    if let Body::Joint { leg, joint } = body
        && robot.legs[leg].joints[joint].is_payload()
    {
        let message = format!(
            "the body `{}` is a payload, which only some runs carry",
            entry.value
        );
        return Err(error(
            message,
            "rename the joint if all runs carry the body",
        ));
    }
    let own = known.iter();
    let own = own.filter(|(_, of, symbol, _)| *of == body && symbol.is_inertial());
    let own: Vec<HeldName> = own.map(|(own, ..)| name(own, &entry.value)).collect();
    if own.is_empty() {
        let message = format!("the body `{}` has no parameters to hold", entry.value);
        return Err(error(message, "leave it out"));
    }
    Ok(own)
}

/// Values of the held parameters; those without one are reported, entry by entry.
pub(crate) fn values(
    item: &Item<'_, '_>,
    names: &[HeldName],
    values: &[TrueParameter],
) -> Vec<(String, f64)> {
    let value = |name: &HeldName| {
        let own = values.iter().find(|one| one.name.value == name.parameter);
        own.map(|one| (name.parameter.clone(), one.value))
    };
    for group in names.chunk_by(|a, b| a.span == b.span) {
        let missing = group.iter().filter(|one| value(one).is_none());
        let missing: Vec<String> = missing.map(|one| format!("`{}`", one.parameter)).collect();
        let Some(first) = group.first().filter(|_| !missing.is_empty()) else {
            continue;
        };
        let missing = missing.join(", ");
        let message = if first.body.is_empty() {
            format!("{missing} is held, but has no value in [prior.values]")
        } else {
            format!(
                "the body `{}` is held, but [prior.values] lacks {missing}",
                first.body
            )
        };
        let error = Diagnostic::new(Code::KNOWN, message, first.span.clone());
        let help =
            "give each value, also a zero, or leave the parameter out of the body's `parameters`";
        item.context.report(error.help(help));
    }
    names.iter().filter_map(value).collect()
}
