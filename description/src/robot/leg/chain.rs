//! Chains: legs that start from, or end on, a body of the skeleton or of an earlier chain.
//!
//! The skeleton is the leg without an end in a robot without a platform, and is placed first. Its
//! joints are the independent coordinates, together with those of branches: legs without an end on
//! bodies of chains.

use crate::diagnostic::{Code, Diagnostic, Span, did_you_mean};
use crate::robot::model::{BodyIndex, Leg, Spanned};
use crate::robot::shape::Shape;
use crate::toml_text::reader::Context;

/// Resolves the bodies that chains connect, and reports unknown ones.
pub(crate) fn attach(
    shapes: &[Shape<'_, '_>],
    has_platform: bool,
    legs: &mut [Leg],
    context: &Context,
) {
    if has_platform {
        refuse_bodies(shapes, context);
        return;
    }
    // Without a skeleton an end has no body; this is reported for the ends.
    let Some(first) = legs.iter().position(|leg| leg.end.is_none()) else {
        return;
    };
    if legs.len() == 1 {
        // After another error an intended chain may be missing.
        if context.is_clean() {
            refuse_bodies(shapes, context);
        }
        return;
    }
    let is_skeleton = |leg: &Leg| {
        let body = shapes.get(leg.shape).and_then(|own| own.base_body.as_ref());
        leg.end.is_none() && body.is_none_or(|body| body.value == GROUND)
    };
    let Some(at) = legs.iter().position(is_skeleton) else {
        let branch = &legs[first].name;
        let message = format!("no leg is the skeleton: `{}` is a branch", branch.value);
        let help = "chains and branches need a skeleton: first place a leg that has neither an `end` nor a `base.body`; its joints are the robot's coordinates";
        context.report(Diagnostic::new(Code::STRUCTURE, message, branch.span.clone()).help(help));
        return;
    };
    let skeleton = legs[at].clone();
    if at > 0 {
        let message = format!("the skeleton `{}` is not placed first", skeleton.name.value);
        let help = "its joints are the robot's coordinates: put its [[place]] before those of chains and branches";
        context.report(
            Diagnostic::new(Code::STRUCTURE, message, skeleton.name.span.clone()).help(help),
        );
        return;
    }
    let mut seen_shapes = Vec::new();
    for index in 1..legs.len() {
        let (before, rest) = legs.split_at_mut(index);
        let Some((leg, after)) = rest.split_first_mut() else {
            continue;
        };
        let bodies = Bodies {
            before,
            after,
            own: (kind(leg), leg.name.value.clone()),
        };
        let Some(shape) = shapes.get(leg.shape) else {
            continue;
        };
        let is_new = !seen_shapes.contains(&leg.shape);
        seen_shapes.push(leg.shape);
        let report = |error: Diagnostic| {
            // Legs of one shape share its errors.
            if is_new {
                context.report(error);
            }
        };
        let name = &shape.name.value;
        leg.base_body = match &shape.base_body {
            None => None,
            Some(body) => match bodies.find(body) {
                Ok(found) => found,
                Err(error) => {
                    report(error);
                    continue;
                }
            },
        };
        let Some(end) = &shape.end else { continue };
        match &end.body {
            None => report(no_body(name, &skeleton, end.span.clone())),
            Some(body) => match bodies.find(body) {
                Ok(Some(found)) if Some(found) != leg.base_body => leg.end_body = Some(found),
                Ok(Some(_)) => {
                    let message =
                        format!("the chain `{name}` starts from and ends on the same body");
                    let help =
                        "name another body in `base.body` or `end.body`: a chain connects two";
                    report(Diagnostic::new(Code::STRUCTURE, message, body.span.clone()).help(help));
                }
                Ok(None) => {
                    let message = format!("the chain `{name}` ends on the ground");
                    let help = "reverse it: its base on the ground, its end on the body";
                    report(Diagnostic::new(Code::STRUCTURE, message, body.span.clone()).help(help));
                }
                Err(error) => report(error),
            },
        }
    }
}

/// The bodies that a chain may connect: those of the skeleton and of earlier chains.
struct Bodies<'a> {
    before: &'a [Leg],
    after: &'a [Leg],
    /// Noun and name of the leg that connects them.
    own: (&'static str, String),
}

/// Noun for a leg after the skeleton.
const fn kind(leg: &Leg) -> &'static str {
    match leg.end {
        None => "branch",
        Some(_) => "chain",
    }
}

impl Bodies<'_> {
    /// The body of a name, `JOINT` of the skeleton or `CHAIN.JOINT`; `None` for the ground.
    fn find(&self, name: &Spanned<String>) -> Result<Option<BodyIndex>, Diagnostic> {
        if name.value == GROUND {
            return Ok(None);
        }
        if let Some((chain, joint)) = name.value.split_once('.') {
            return self.of_chain(name, chain, joint).map(Some);
        }
        let (skeleton, what) = (&self.before[0], "skeleton");
        body_of(0, skeleton, name, &name.value, what, &[GROUND]).map(Some)
    }

    /// A body of a chain.
    fn of_chain(
        &self,
        name: &Spanned<String>,
        chain: &str,
        joint: &str,
    ) -> Result<BodyIndex, Diagnostic> {
        let named = |leg: &Leg| leg.name.value == chain;
        if let Some(leg) = self.before.iter().position(named) {
            let own = &self.before[leg];
            let what = if leg == 0 { "skeleton" } else { kind(own) };
            return body_of(leg, own, name, joint, what, &[]);
        }
        let (kind_of, own) = &self.own;
        let message = match self.after.iter().find(|leg| named(leg)) {
            Some(after) => format!(
                "the {} `{chain}` is not placed before the {kind_of} `{own}`, which needs a body of it",
                kind(after)
            ),
            None if own == chain => {
                format!("the {kind_of} `{own}` can't start or end on its own body")
            }
            None => format!("no chain or branch `{chain}` is placed before the {kind_of} `{own}`"),
        };
        let help = "legs are solved in the order of their places, so a body that carries a chain or a branch must be in the skeleton, or in a chain or branch that is placed before";
        let others = self.before.iter().map(|leg| leg.name.value.as_str());
        let help = did_you_mean(chain, others).unwrap_or_else(|| help.to_owned());
        Err(Diagnostic::new(Code::UNKNOWN_NAME, message, name.span.clone()).help(help))
    }
}

/// The body of this name in a leg; the error suggests other valid bodies.
fn body_of(
    leg: usize,
    of: &Leg,
    name: &Spanned<String>,
    own: &str,
    what: &str,
    others: &[&str],
) -> Result<BodyIndex, Diagnostic> {
    let names = || of.joints.iter().map(|joint| joint.name.value.as_str());
    if let Some(joint) = names().position(|joint| joint == own) {
        return Ok(BodyIndex { leg, joint });
    }
    let message = format!("the {what} `{}` has no body `{own}`", of.name.value);
    let all = || names().chain(others.iter().copied());
    let list = || {
        let all = all().collect::<Vec<_>>().join(", ");
        format!("bodies have the names of their joints: {all}")
    };
    let help = did_you_mean(own, all()).unwrap_or_else(list);
    Err(Diagnostic::new(Code::UNKNOWN_NAME, message, name.span.clone()).help(help))
}

/// Name of the ground, from which chains start by default.
pub(crate) const GROUND: &str = "ground";

fn no_body(name: &str, skeleton: &Leg, span: Span) -> Diagnostic {
    let names: Vec<&str> = skeleton
        .joints
        .iter()
        .map(|joint| joint.name.value.as_str())
        .collect();
    let message = format!("the chain `{name}` has no body to end on");
    let help = format!(
        "body = \"NAME\" of a joint of the skeleton `{}`: {}",
        skeleton.name.value,
        names.join(", ")
    );
    Diagnostic::new(Code::UNKNOWN_NAME, message, span).help(help)
}

/// Reports bodies in robots without a skeleton.
fn refuse_bodies(shapes: &[Shape<'_, '_>], context: &Context) {
    for shape in shapes {
        let of_end = shape.end.as_ref().and_then(|end| end.body.as_ref());
        for body in shape.base_body.iter().chain(of_end) {
            let message = format!("there is no skeleton with a body `{}`", body.value);
            let help = "leave `body` out: legs start from the ground and end on the platform; a skeleton is a leg without `end` of a robot without platform";
            context
                .report(Diagnostic::new(Code::UNKNOWN_NAME, message, body.span.clone()).help(help));
        }
    }
}
