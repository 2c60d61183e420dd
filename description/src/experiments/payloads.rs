//! Names of payloads, which may differ between runs.

use crate::diagnostic::{Code, Diagnostic, did_you_mean};
use crate::robot::inventory::Inventory;
use crate::robot::model::{Leg, Spanned};
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::is_word;

/// Largest number of payloads of a robot.
const MOST: usize = 100;

/// Reads the key `payloads`: distinct names, for a robot that may carry a payload.
pub(crate) fn read(table: &Table<'_, '_>, robot: &Inventory<'_>) -> Vec<Spanned<String>> {
    if !robot.payload_bodies.is_empty() {
        let bodies = robot.payload_bodies.iter();
        return bodies.map(|payload| payload.name.clone()).collect();
    }
    let Some(item) = table.get("payloads") else {
        return Vec::new();
    };
    let Some(given) = item.strings() else {
        return Vec::new();
    };
    if !has_payload(robot) {
        let error = item.error(
            Code::PAYLOAD,
            "payloads have names, but the robot has no payload",
        );
        item.context.report(error.help(help(robot)));
    }
    if given.is_empty() || given.len() > MOST {
        let error = item.error(
            Code::PAYLOAD,
            format!("`payloads` has {} names", given.len()),
        );
        let help = format!("give 1 to {MOST} names, or leave the key out if there is one payload");
        item.context.report(error.help(help));
    }
    let mut names: Vec<Spanned<String>> = Vec::new();
    for name in given {
        let report = |message: String, help: &str| {
            let error = Diagnostic::new(Code::PAYLOAD, message, name.span.clone());
            item.context.report(error.help(help));
        };
        if names.iter().any(|one| one.value == name.value) {
            let message = format!("the payload `{}` is listed twice", name.value);
            report(message, "payloads of different names are different bodies");
        } else if !is_word(&name.value) {
            let message = format!("`{}` cannot be the name of a payload", name.value);
            report(
                message,
                "its parameters are named after it: use letters, digits and underscores",
            );
        } else {
            names.push(name);
        }
    }
    names
}

/// Whether a robot may carry a payload.
///
/// Identification recognises payloads by parameter names, which contain the leg's name if there are
/// several legs.
pub(crate) fn has_payload(robot: &Inventory<'_>) -> bool {
    if !robot.payload_bodies.is_empty() {
        return true;
    }
    match robot.platform {
        Some(platform) => platform.payload.is_some(),
        None => robot.legs.len() == 1 && robot.legs.iter().any(Leg::carries_payload),
    }
}

/// Where a payload is described.
pub(crate) fn help(robot: &Inventory<'_>) -> &'static str {
    match robot.platform {
        Some(_) => "describe it in a table [platform.payload]",
        None if robot.legs.len() > 1 => {
            "describe it in a table [payload.NAME] with the `body` that carries it"
        }
        None => "describe it as a joint of type \"fixed\" with the name `payload` on the last body",
    }
}

/// The payload of a run: whether there is one, and its name if payloads have names.
///
/// The name of several payloads has plus signs, `A+B`.
pub(crate) fn of_run(item: &Item<'_, '_>, robot: &Inventory<'_>) -> (bool, Option<String>) {
    let known = || robot.payloads.iter().map(|one| one.value.as_str());
    let list = || known().collect::<Vec<_>>().join(", ");
    if item.value.is_array() {
        return of_names(item, robot);
    }
    if let Some(name) = item.value.as_str() {
        if known().any(|one| one == name) {
            return (true, Some(name.to_owned()));
        }
        report_unknown(
            item,
            robot,
            &Spanned {
                value: name.to_owned(),
                span: item.span.clone(),
            },
        );
        return (false, None);
    }
    let loaded = item.boolean().unwrap_or(false);
    if loaded && !has_payload(robot) {
        let error = item.error(Code::PAYLOAD, "the robot has no payload");
        item.context.report(error.help(help(robot)));
    } else if loaded && known().next().is_some() {
        let error = item.error(
            Code::PAYLOAD,
            "the robot's payloads have names: the run must name one",
        );
        item.context
            .report(error.help(format!("give its name, one of {}", list())));
    }
    (loaded, None)
}

/// The payloads of a run from a list of their names, `["A", "B"]`.
fn of_names(item: &Item<'_, '_>, robot: &Inventory<'_>) -> (bool, Option<String>) {
    let mut names: Vec<String> = Vec::new();
    for name in item.strings().unwrap_or_default() {
        if names.contains(&name.value) {
            let message = format!("the payload `{}` is listed twice", name.value);
            let error = Diagnostic::new(Code::PAYLOAD, message, name.span);
            item.context
                .report(error.help("a run carries each payload at most once"));
        } else if robot.payloads.iter().any(|one| one.value == name.value) {
            names.push(name.value);
        } else {
            report_unknown(item, robot, &name);
        }
    }
    let label = Some(names.join("+")).filter(|label| !label.is_empty());
    (label.is_some(), label)
}

/// Reports a payload that the robot does not have.
fn report_unknown(item: &Item<'_, '_>, robot: &Inventory<'_>, name: &Spanned<String>) {
    let known = || robot.payloads.iter().map(|one| one.value.as_str());
    let (name, span) = (&name.value, name.span.clone());
    let message = format!("there is no payload `{name}`");
    let error = Diagnostic::new(Code::PAYLOAD, message, span);
    let help = match known().next() {
        None => String::from(
            "name the payloads of the robot at the head of the file, payloads = [\"A\", \"B\"], or write payload = true",
        ),
        Some(_) if name.contains('+') => {
            String::from("write several payloads as a list, payload = [\"A\", \"B\"]")
        }
        Some(_) => did_you_mean(name, known()).unwrap_or_else(|| {
            let list: Vec<&str> = known().collect();
            format!("its payloads are {}", list.join(", "))
        }),
    };
    item.context.report(error.help(help));
}
