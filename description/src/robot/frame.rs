//! The tables `[frame.NAME]`: frames on bodies, such as tools.

use crate::diagnostic::{Code, Diagnostic, did_you_mean};
use crate::robot::geometry::placement;
use crate::robot::model::{BodyIndex, Frame, FrameBody, Leg, Spanned};
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word};
use overact_core::{FrameQuantity, Function};

/// Tables of the generated code whose names end like those of a frame's functions.
const TABLES: [&str; 1] = ["home_pose"];

/// Name of the platform as a body.
const PLATFORM: &str = "platform";

/// Reads all frames in the order of the file.
pub(crate) fn read(
    table: &Table<'_, '_>,
    has_platform: bool,
    legs: &[Leg],
    scope: &Scope,
) -> Vec<Frame> {
    let frames = table
        .get("frame")
        .and_then(|item| item.table("the table `[frame]`"));
    let mut items = frames.map_or_else(Vec::new, |frames| frames.items());
    items.sort_by_key(|item| item.key.span.start);
    let bodies = Bodies { has_platform, legs };
    let read = |item: &Item<'_, '_>| frame(item, &bodies, scope);
    items.iter().filter_map(read).collect()
}

fn frame(item: &Item<'_, '_>, bodies: &Bodies<'_>, scope: &Scope) -> Option<Frame> {
    let name = item.key.clone();
    let is_named = check_name(item, &name);
    let table = item.table(format!("the frame `{}`", name.value))?;
    let (at, rotation) = (table.get("at"), table.get("rotation"));
    let placement = placement(at.as_ref(), rotation.as_ref(), scope);
    let body = match table.get("body") {
        None => bodies.default(),
        Some(item) => item.string().and_then(|text| {
            let found = bodies.find(&text);
            found.map_err(|error| table.context.report(error)).ok()
        }),
    };
    table.finish();
    Some(Frame {
        name,
        body: body.filter(|_| is_named)?,
        placement,
    })
}

/// Reports a name that is no identifier, or that gives a function the name of another one.
fn check_name(item: &Item<'_, '_>, name: &Spanned<String>) -> bool {
    let starts_well = name.value.starts_with(|c: char| c.is_ascii_alphabetic());
    if !starts_well || !is_word(&name.value) {
        let message = format!("`{}` cannot be the name of a frame", name.value);
        let error = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        let help = "use letters, digits and underscores, a letter first";
        item.context.report(error.help(help));
        return false;
    }
    let names = FrameQuantity::ALL.map(|quantity| format!("{}_{}", name.value, quantity.name()));
    let is_taken = |own: &&String| {
        let mut functions = Function::ALL.iter();
        functions.any(|known| known.name() == own.as_str()) || TABLES.contains(&own.as_str())
    };
    let Some(taken) = names.iter().find(is_taken) else {
        return true;
    };
    let message = format!("a frame cannot be named `{}`", name.value);
    let error = Diagnostic::new(Code::SAME_NAME, message, name.span.clone());
    let error = error.label(format!("the code of every robot already has `{taken}`"));
    let help = format!("choose another name, for instance `{}_frame`", name.value);
    item.context.report(error.help(help));
    false
}

/// The bodies that may carry a frame or a payload.
pub(crate) struct Bodies<'l> {
    pub(crate) has_platform: bool,
    pub(crate) legs: &'l [Leg],
}

impl Bodies<'_> {
    /// The platform, or the last joint of a robot without one, of its skeleton if it has chains.
    ///
    /// `None` after an error in the legs.
    fn default(&self) -> Option<FrameBody> {
        if self.has_platform {
            return Some(FrameBody::Platform);
        }
        let joints = &self.legs.first()?.joints;
        let joint = joints.iter().rposition(|joint| joint.motor.is_none())?;
        Some(FrameBody::Joint(BodyIndex { leg: 0, joint }))
    }

    /// The body of a name: `platform`, `LEG.JOINT`, or `JOINT` of a robot without a platform.
    pub(crate) fn find(&self, name: &Spanned<String>) -> Result<FrameBody, Diagnostic> {
        if name.value == PLATFORM && self.has_platform {
            return Ok(FrameBody::Platform);
        }
        let known = self.names();
        if let Some((_, body)) = known.iter().find(|(known, _)| *known == name.value) {
            return Ok(*body);
        }
        let message = format!("the robot has no body `{}`", name.value);
        let error = Diagnostic::new(Code::UNKNOWN_NAME, message, name.span.clone());
        let names = || known.iter().map(|(name, _)| name.as_str());
        let list = || {
            let all: Vec<&str> = names().collect();
            format!("bodies are {}", all.join(", "))
        };
        Err(error.help(did_you_mean(&name.value, names()).unwrap_or_else(list)))
    }

    /// All bodies with their names; the first spelling of a body is the one of `inspect`.
    pub(crate) fn names(&self) -> Vec<(String, FrameBody)> {
        let mut all = Vec::new();
        if self.has_platform {
            all.push((PLATFORM.to_owned(), FrameBody::Platform));
        }
        let mut long = Vec::new();
        // A cable is no body.
        let legs = self.legs.iter().enumerate();
        for (leg, own) in legs.filter(|(_, own)| own.cable.is_none()) {
            let joints = own.joints.iter().enumerate();
            for (joint, of) in joints.filter(|(_, joint)| joint.motor.is_none()) {
                let body = FrameBody::Joint(BodyIndex { leg, joint });
                if leg == 0 && !self.has_platform {
                    all.push((of.name.value.clone(), body));
                }
                let name = format!("{}.{}", own.name.value, of.name.value);
                long.push((name, body));
            }
        }
        all.append(&mut long);
        all
    }
}
