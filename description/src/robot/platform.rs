//! The table `[platform]`.

use crate::diagnostic::Code;
use crate::expressions::dimension::Dimension;
use crate::robot::model::{Motion, Platform, PlatformHome, SIX, Spanned};
use crate::robot::parameters::Owner;
use crate::toml_text::reader::Item;
use crate::toml_text::scope::Scope;
use overact_exact::Number;

/// Keywords of motions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum CompoundJointKind {
    FixedAxis,
    Point,
    Planar,
    Translation,
    Schoenflies,
    Spherical,
    Spatial,
}

const WORDS: [(&str, CompoundJointKind); 7] = [
    ("fixed axis", CompoundJointKind::FixedAxis),
    ("point", CompoundJointKind::Point),
    ("planar", CompoundJointKind::Planar),
    ("translation", CompoundJointKind::Translation),
    ("schoenflies", CompoundJointKind::Schoenflies),
    ("spherical", CompoundJointKind::Spherical),
    ("spatial", CompoundJointKind::Spatial),
];

const AXES: [(&str, usize); 3] = [("x", 0), ("y", 1), ("z", 2)];

pub(crate) fn read(item: &Item<'_, '_>, scope: &Scope) -> Option<Platform> {
    let table = item.table("the table `[platform]`")?;
    let parameters = table
        .get("parameters")
        .and_then(|i| i.parameters(Owner::FreeBody));
    let parameters = parameters.unwrap_or_else(|| Owner::FreeBody.default(false));
    let payload = table.get("payload").and_then(|item| {
        let payload = item.table("the table `[platform.payload]`")?;
        let own = payload
            .get("parameters")
            .and_then(|i| i.parameters(Owner::FreeBody));
        payload.finish();
        Some(own.unwrap_or_else(|| parameters.clone()))
    });
    let word = table
        .require("motion", "for instance motion = \"planar\"")
        .and_then(|i| i.choice(&WORDS));
    let redundancy = table
        .get("redundancy")
        .and_then(|item| Some(Spanned::new(item.size(0)?, item.span.clone())));
    let (axis, home) = (table.get("axis"), table.get("home"));
    let independent = table.get("independent");
    table.finish();
    let word = word?;
    let (motion, axis_at) = motion(word.value, axis.as_ref(), scope)?;
    let motion = match independent {
        Some(item) => parasitic(motion, &item)?,
        None => motion,
    };
    let home = home.map_or(Some(PlatformHome::ZERO), |item| {
        read_home(&item, motion, scope)
    });
    Some(Platform {
        motion: Spanned::new(motion, word.span),
        axis_at,
        home: home.unwrap_or(PlatformHome::ZERO),
        redundancy,
        parameters,
        payload,
        span: table.span.clone(),
    })
}

/// A free platform with some independent coordinates; the legs' closures give the others.
fn parasitic(motion: Motion, item: &Item<'_, '_>) -> Option<Motion> {
    if motion != Motion::Spatial {
        let message = "`independent` has no meaning for this motion";
        item.context
            .report(item.error(Code::CONTRADICTION, message).help(
                "leave it out, or write motion = \"spatial\" for a platform with parasitic motion",
            ));
        return None;
    }
    let choices: [(&str, usize); 6] = std::array::from_fn(|at| (SIX[at], at));
    let mut independent = [false; 6];
    let mut is_right = true;
    for name in item.list()? {
        match name.choice(&choices) {
            Some(at) if independent[at.value] => {
                let message = format!("`{}` occurs twice", SIX[at.value]);
                name.context.report(
                    name.error(Code::CONTRADICTION, message)
                        .help("leave one out"),
                );
                is_right = false;
            }
            Some(at) => independent[at.value] = true,
            None => is_right = false,
        }
    }
    let count = independent.iter().filter(|own| **own).count();
    if is_right && !(1..6).contains(&count) {
        let message = format!("{count} of six coordinates are independent");
        item.context
            .report(item.error(Code::CONTRADICTION, message).help(
            "name as many as the legs allow, one to five; leave the key out if they allow all six",
        ));
        return None;
    }
    is_right.then_some(Motion::Parasitic { independent })
}

fn motion(
    word: CompoundJointKind,
    axis: Option<&Item<'_, '_>>,
    scope: &Scope,
) -> Option<(Motion, [Number; 3])> {
    let mut at = [Number::ZERO; 3];
    let motion = match word {
        CompoundJointKind::FixedAxis => {
            let fixed = fixed_axis(axis, scope)?;
            at = fixed.1;
            fixed.0
        }
        CompoundJointKind::Point => Motion::Point {
            axis: normal(axis)?,
        },
        CompoundJointKind::Planar => Motion::Planar {
            axis: normal(axis)?,
        },
        CompoundJointKind::Schoenflies => Motion::Schoenflies {
            axis: normal(axis)?,
        },
        CompoundJointKind::Translation
        | CompoundJointKind::Spherical
        | CompoundJointKind::Spatial => {
            if let Some(item) = axis {
                let message = "`axis` has no meaning for this motion";
                item.context.report(
                    item.error(Code::CONTRADICTION, message)
                        .help("leave it out"),
                );
            }
            match word {
                CompoundJointKind::Translation => Motion::Translation,
                CompoundJointKind::Spherical => Motion::Spherical,
                _ => Motion::Spatial,
            }
        }
    };
    Some((motion, at))
}

/// The plane's normal or the rotation's axis; z by default.
fn normal(axis: Option<&Item<'_, '_>>) -> Option<usize> {
    axis.map_or(Some(2), |item| Some(item.choice(&AXES)?.value))
}

/// Motion on a fixed axis and a point of it.
///
/// The keyword alone is a translation along an axis through the origin.
fn fixed_axis(axis: Option<&Item<'_, '_>>, scope: &Scope) -> Option<(Motion, [Number; 3])> {
    let Some(item) = axis.filter(|item| item.is_table()) else {
        let motion = Motion::FixedAxis {
            axis: normal(axis)?,
        };
        return Some((motion, [Number::ZERO; 3]));
    };
    let table = item.table("`axis`")?;
    let at = table
        .get("at")
        .and_then(|i| i.vector(Dimension::LENGTH, scope));
    let direction = table.require("direction", "for instance direction = \"z\"");
    let choices = [("translation", false), ("rotation", true)];
    let turns = table.get("motion").map(|item| item.choice(&choices));
    table.finish();
    let axis = direction?.choice(&AXES)?.value;
    let motion = match turns {
        None => Motion::FixedAxis { axis },
        Some(turns) if turns.as_ref()?.value => Motion::Rotation { axis },
        Some(_) => Motion::FixedAxis { axis },
    };
    Some((motion, at.unwrap_or([Number::ZERO; 3])))
}

fn read_home(item: &Item<'_, '_>, motion: Motion, scope: &Scope) -> Option<PlatformHome> {
    let table = item.table("the platform's `home`")?;
    let mut home = PlatformHome::ZERO;
    for name in motion.of_pose().coordinates() {
        let Some(value) = table.get(name) else {
            continue;
        };
        match name {
            "x" | "y" | "z" => {
                let length = value.number(Dimension::LENGTH, scope).map(|n| n.value);
                let axis = AXES
                    .iter()
                    .find(|(axis, _)| *axis == name)
                    .map(|(_, index)| *index);
                if let (Some(length), Some(place)) = (length, axis.and_then(|a| home.at.get_mut(a)))
                {
                    *place = length;
                }
            }
            "phi" => home.phi = value.angle(scope).map_or(home.phi, |a| a.value),
            _ => {
                let angle = value.angle(scope).map(|a| a.value);
                let axis = ["rx", "ry", "rz"].iter().position(|axis| *axis == name);
                if let (Some(angle), Some(place)) =
                    (angle, axis.and_then(|a| home.rotation.get_mut(a)))
                {
                    *place = angle;
                }
            }
        }
    }
    table.finish();
    Some(home)
}
