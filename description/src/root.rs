//! The complete description.

use crate::diagnostic::{Code, Diagnostic, Diagnostics, Source};
use crate::document::{BaseColumns, Description, type_name};
use crate::effort::Effort;
use crate::experiments::{controller, data, excitation, experiment, payloads, prior, settings};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::{Body, Inventory};
use crate::robot::model::{Leg, Motor, Platform, Spanned, actuators};
use crate::robot::shape::{MOST_JOINTS, Shape};
use crate::robot::{
    frame, leg,
    leg::{cable_robot, chain, coupled_motor, dependent},
    payload, platform, point_spring, shape,
};
use crate::toml_text::reader::{Context, Item, Table};
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;
use overact_exact::{Number, Ratio};
use std::collections::{BTreeMap, BTreeSet};
use toml::de::DeTable;

/// Words that cannot name a type.
const KEYWORDS: [&str; 51] = [
    "Self", "abstract", "as", "async", "await", "become", "box", "break", "const", "continue",
    "crate", "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if",
    "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while",
];

pub(crate) fn read(source: &Source) -> Result<Description, Diagnostics> {
    let (document, syntax_errors) = DeTable::parse_recoverable(&source.text);
    if !syntax_errors.is_empty() {
        return Err(syntax(&syntax_errors));
    }
    let context = Context::new(source);
    // Errors of the file as a whole are shown at its first line.
    let table = Table::new(&context, document.get_ref(), 0..0, "the description");
    let description = root(&table);
    let mut errors = context.into_errors();
    match description {
        Some(description) => errors.into_result(description),
        None => {
            // Readers that fail report the reason; a missing report must not look like success.
            if errors.is_empty() {
                errors.push(Diagnostic::global(
                    Code::INCOMPLETE,
                    "the description is incomplete",
                ));
            }
            Err(errors)
        }
    }
}

/// The parser's first message: later ones are mostly consequences of a broken line.
pub(crate) fn syntax(errors: &[toml::de::Error]) -> Diagnostics {
    let place = |error: &&toml::de::Error| error.span().map_or(usize::MAX, |span| span.start);
    let first = errors.iter().min_by_key(place);
    let diagnostic = |error: &toml::de::Error| {
        let message = format!("this is not valid TOML: {}", error.message());
        match error.span() {
            Some(span) => Diagnostic::new(Code::SYNTAX, message, span),
            None => Diagnostic::global(Code::SYNTAX, message),
        }
    };
    first.map_or_else(Diagnostics::new, |error| diagnostic(error).into())
}

fn root(table: &Table<'_, '_>) -> Option<Description> {
    let name = table
        .require("name", "for instance name = \"MyRobot\"")
        .and_then(|item| robot_name(&item));
    let text = |key: &str| {
        table
            .get(key)
            .and_then(|item| item.string())
            .map(|text| text.value)
    };
    let (summary, source) = (
        text("summary").unwrap_or_default(),
        text("source").unwrap_or_default(),
    );
    let effort = table
        .get("effort")
        .and_then(|item| item.choice(&Effort::ALL.map(|e| (e.name(), e))));
    let base_columns = table
        .get("base_columns")
        .and_then(|item| item.choice(&BaseColumns::ALL));
    let constants = table
        .get("constants")
        .and_then(|item| item.table("the table `[constants]`"));
    let scope = constants
        .map(|table| Scope::constants(&table))
        .unwrap_or_default();
    // Numbers of the constants themselves are not compared with the constants.
    table.context.take_magnitudes();
    let gravity = table
        .get("gravity")
        .and_then(|i| i.vector(Dimension::ACCELERATION, &scope));
    let platform_item = table.get("platform");
    let platform = platform_item
        .as_ref()
        .and_then(|item| platform::read(item, &scope));
    let shapes = shapes(table, &scope);
    let mut legs = legs(table, &shapes, &scope);
    check_joint_count(table, name.as_ref(), &legs)?;
    let motors = motors(table, &shapes, platform_item.is_some(), &mut legs, &scope);
    chain::attach(&shapes, platform_item.is_some(), &mut legs, table.context);
    check_ends(table, &shapes, platform_item.is_some(), &legs);
    dependent::check(&shapes, platform_item.is_some(), &legs, table.context);
    let has_platform = platform_item.is_some();
    cable_robot::check(
        table.context,
        &shapes,
        has_platform,
        platform.as_ref(),
        &legs,
    );
    check_actuators(table, platform.as_ref(), &legs, &motors);
    let frames = frame::read(table, platform_item.is_some(), &legs, &scope);
    let springs = point_spring::read(table, &scope, platform_item.is_some(), &legs);
    let payload_bodies = payload::read(table, platform_item.is_some(), &legs, &scope);
    let of_platform = platform
        .as_ref()
        .filter(|platform| platform.payload.is_some());
    let of_platform = of_platform.map(|platform| platform.span.clone());
    payload::check_alone(table, &payload_bodies, of_platform, &legs);
    let robot = Inventory {
        platform: platform.as_ref(),
        legs: &legs,
        motors: &motors,
        springs: &springs,
        scope: &scope,
        payloads: &[],
        payload_bodies: &[],
    };
    let robot = Inventory {
        payload_bodies: &payload_bodies,
        ..robot
    };
    check_parameter_names(table, &robot);
    check_spring_names(table, &robot);
    check_motor_names(table, &robot);
    let payloads = payloads::read(table, &robot);
    let robot = Inventory {
        payloads: &payloads,
        ..robot
    };
    let (experiment, data) = (table.get("experiment"), table.get("data"));
    let (settings, loops) = (table.get("identification"), table.get("controller"));
    let (prior, limits) = (table.get("prior"), table.get("excitation"));
    table.finish();
    // Later names and numbers depend on all legs, so a failed leg would cause further errors.
    let complete = platform.is_some() == platform_item.is_some() && !legs.is_empty();
    if !complete || legs.len() != placements(table).len() {
        return None;
    }
    let magnitudes = table.context.take_magnitudes();
    let experiment = experiment.and_then(|item| experiment::read(&item, &robot));
    let excitation = limits.and_then(|item| excitation::read(&item, &robot));
    let data = data.and_then(|item| data::data(&item, &robot));
    let controller = loops.and_then(|item| controller::read(&item, &robot));
    let prior = prior.and_then(|item| prior::read(&item, &robot));
    let gravity = gravity.unwrap_or_else(standard_gravity);
    let identification = settings::identification(settings.as_ref(), &robot, &gravity);
    Some(Description {
        name: name?,
        effort: effort.map(|effort| effort.value),
        base_columns: base_columns.map(|columns| columns.value),
        summary,
        source,
        gravity,
        payloads,
        payload_bodies,
        constants: scope.values(),
        magnitudes,
        platform,
        legs,
        motors,
        springs,
        frames,
        experiment,
        excitation,
        data,
        controller,
        prior: prior.unwrap_or_default(),
        identification,
        warnings: table.context.warnings(),
    })
}

/// 9.81 m/s² down the z axis.
fn standard_gravity() -> [Number; 3] {
    let down = Ratio::new(-981, 100).unwrap_or(Ratio::integer(-10));
    [Number::ZERO, Number::ZERO, Number::ratio(down)]
}

fn robot_name(item: &Item<'_, '_>) -> Option<Spanned<String>> {
    let name = item.string()?;
    let letter = name.value.starts_with(|c: char| c.is_ascii_alphabetic());
    let keyword = |name: &str| KEYWORDS.contains(&name);
    if !letter || !crate::toml_text::scope::is_word(&name.value) {
        let error = item.error(
            Code::BAD_NAME,
            format!("\"{}\" cannot be the name of a Rust type", name.value),
        );
        item.context
            .report(error.help("use letters and digits, a letter first, for instance \"DualV\""));
    } else if keyword(&name.value) || keyword(&type_name(&name.value)) {
        let error = item.error(
            Code::BAD_NAME,
            format!("\"{}\" is a keyword of Rust", name.value),
        );
        item.context
            .report(error.help("choose another name, for instance \"MyRobot\""));
    }
    Some(name)
}

fn shapes<'c, 't>(table: &Table<'c, 't>, scope: &Scope) -> Vec<Shape<'c, 't>> {
    let help = "write each leg once as [[leg.NAME.joint]] and place it by [[place]]";
    let Some(item) = table.require("leg", help) else {
        return Vec::new();
    };
    let legs = item
        .table("the table `[leg]`")
        .map(|legs| legs.items())
        .unwrap_or_default();
    if item.is_table() && legs.is_empty() {
        table.context.report(
            item.error(Code::STRUCTURE, "the robot has no leg")
                .help(help),
        );
    }
    legs.iter()
        .filter_map(|item| shape::read(item, scope))
        .collect()
}

fn placements<'c, 't>(table: &Table<'c, 't>) -> Vec<Table<'c, 't>> {
    table
        .get("place")
        .map(|item| item.tables("a placement"))
        .unwrap_or_default()
}

fn legs(table: &Table<'_, '_>, shapes: &[Shape<'_, '_>], scope: &Scope) -> Vec<Leg> {
    let help = "a table [[place]] with name = \"leg1\" and shape = \"NAME\" places a leg";
    let wanted = !shapes.is_empty();
    if wanted && table.require("place", help).is_none() {
        return Vec::new();
    }
    let tables = placements(table);
    for shape in shapes {
        let placed = |t: &Table<'_, '_>| {
            let name = t.get("shape");
            name.is_some_and(|item| item.value.as_str() == Some(shape.name.value.as_str()))
        };
        if !tables.iter().any(placed) {
            let message = format!("the leg `{}` is never placed", shape.name.value);
            table.context.report(
                Diagnostic::new(Code::STRUCTURE, message, shape.name.span.clone()).help(help),
            );
        }
    }
    leg::read(&placements(table), shapes, scope)
}

/// Checks that legs of a platform have ends, and that a robot without a platform has a leg without
/// one.
fn check_ends(table: &Table<'_, '_>, shapes: &[Shape<'_, '_>], platform: bool, legs: &[Leg]) {
    let has_skeleton = !platform && shapes.iter().any(|shape| shape.end.is_none());
    for shape in shapes {
        let name = &shape.name.value;
        let diagnostic = match &shape.end {
            None if platform => {
                let message = format!("the leg `{name}` has no end on the platform");
                let help = format!(
                    "[leg.{name}.end] says where it ends, for instance at = [0, \"0.1 m\", 0]"
                );
                Diagnostic::new(Code::STRUCTURE, message, shape.span.clone()).help(help)
            }
            Some(end) if !platform && !has_skeleton => {
                let message = format!("the leg `{name}` ends on a platform, but there is none");
                let help = "describe it in a table [platform], or a skeleton as a leg without `end`, whose bodies `end.body` names";
                Diagnostic::new(Code::STRUCTURE, message, end.span.clone()).help(help)
            }
            _ => continue,
        };
        table.context.report(diagnostic);
    }
    // Bodies of chains may carry branches.
    let has_chains = legs.iter().any(|leg| leg.end.is_some());
    let is_branch = |leg: &&Leg| {
        let body = shapes
            .get(leg.shape)
            .and_then(|shape| shape.base_body.as_ref());
        has_chains && body.is_some_and(|body| body.value != chain::GROUND)
    };
    let mut skeletons = legs
        .iter()
        .filter(|leg| leg.end.is_none() && !is_branch(leg));
    let _ = skeletons.next();
    let second = skeletons.next();
    if let (false, Some(second)) = (platform, second) {
        let message = "a robot without platform has one leg without an end, and others only on bodies of chains";
        let help = "branches of a tree are joints whose `antecedent` is not the joint before them; \
                    those on a body of a chain are legs whose `base.body` names it";
        table
            .context
            .report(Diagnostic::new(Code::STRUCTURE, message, second.span.clone()).help(help));
    }
}

/// Motors of a robot with loops: those described with its legs, then the tables `[motor.NAME]`.
///
/// Those of other robots are added to the joints of the leg.
fn motors(
    table: &Table<'_, '_>,
    shapes: &[Shape<'_, '_>],
    has_platform: bool,
    legs: &mut [Leg],
    scope: &Scope,
) -> Vec<Motor> {
    let is_closed = has_platform || shapes.iter().any(|shape| shape.end.is_some());
    let mut motors = Vec::new();
    if is_closed {
        motors = coupled_motor::take_from_legs(shapes, legs);
    }
    let own = coupled_motor::read(table, scope, is_closed, has_platform, legs);
    motors.extend(own);
    motors
}

/// Without actuators nothing can be identified.
fn check_actuators(
    table: &Table<'_, '_>,
    platform: Option<&Platform>,
    legs: &[Leg],
    motors: &[Motor],
) {
    let count = actuators(legs).len() + motors.len();
    let Some(platform) = platform else {
        let first = legs.iter().flat_map(|leg| &leg.joints).next();
        // After another error the intended actuated joints are unknown.
        if let (0, Some(joint), true) = (count, first, table.context.is_clean()) {
            let diagnostic = Diagnostic::new(
                Code::ACTUATED,
                "no joint of the robot is actuated",
                joint.span.clone(),
            );
            table
                .context
                .report(diagnostic.help("mark a joint with actuated = true"));
        }
        return;
    };
    let dof = platform.motion.value.coordinates().len();
    // Missing actuators are reported by the mechanism, which knows the allowed motions.
    if count >= dof {
        check_redundancy(table, platform, legs, motors);
    }
}

/// Checks the stated number of redundant actuators.
fn check_redundancy(table: &Table<'_, '_>, platform: &Platform, legs: &[Leg], motors: &[Motor]) {
    let robot = Inventory {
        platform: Some(platform),
        legs,
        motors,
        springs: &[],
        scope: &Scope::default(),
        payloads: &[],
        payload_bodies: &[],
    };
    let names = robot.actuator_names();
    let names: Vec<&str> = names.usual().collect();
    let dof = platform.motion.value.coordinates().len();
    let Some(wanted) = &platform.redundancy else {
        return;
    };
    if legs.is_empty() || !table.context.is_clean() || names.len() == dof + wanted.value {
        return;
    }
    let coordinates = if dof == 1 {
        "coordinate"
    } else {
        "coordinates"
    };
    let message = format!(
        "a redundancy of {} means {} actuators for {dof} {coordinates}, but the robot has {}",
        wanted.value,
        dof + wanted.value,
        names.len()
    );
    let help = if names.len() > dof + wanted.value {
        format!(
            "take `actuated = true` from a joint, or write redundancy = {}",
            names.len() - dof
        )
    } else {
        "mark more joints with actuated = true, or name the redundancy that the robot has"
            .to_owned()
    };
    table.context.report(
        Diagnostic::new(Code::WRONG_COUNT, message, wanted.span.clone())
            .label(format!("the actuators are {}", names.join(", ")))
            .help(help),
    );
}

/// Rejects robots with too many joints, before names are compared.
fn check_joint_count(
    table: &Table<'_, '_>,
    name: Option<&Spanned<String>>,
    legs: &[Leg],
) -> Option<()> {
    let joints: usize = legs.iter().map(|leg| leg.joints.len()).sum();
    if joints <= MOST_JOINTS {
        return Some(());
    }
    let message = format!("the robot has {joints} joints, more than {MOST_JOINTS}");
    let at = name.map(|name| name.span.clone());
    let diagnostic = Diagnostic::global(Code::LEG_EMPTY_OR_LARGE, message).at(at);
    let help = "describe it in parts, each as a robot of its own";
    table.context.report(diagnostic.help(help));
    None
}

/// Reports springs between points whose parameters have the names of others.
fn check_spring_names(table: &Table<'_, '_>, robot: &Inventory<'_>) {
    let all = robot.parameters();
    let unknown = robot.springs.iter().filter(|spring| spring.force.is_some());
    for spring in unknown {
        let name = format!("{}_{}", StandardParameter::K.name(), spring.name.value);
        if all.iter().filter(|(other, ..)| *other == name).count() > 1 {
            let message = format!("another parameter is also called `{name}`");
            let error = Diagnostic::new(Code::SAME_NAME, message, spring.name.span.clone());
            let help = "the coefficient of a joint's spring has this name: rename this spring";
            table.context.report(error.help(help));
        }
    }
}

/// Reports motors whose names, as actuators or in parameters, are those of others.
fn check_motor_names(table: &Table<'_, '_>, robot: &Inventory<'_>) {
    if robot.motors.is_empty() {
        return;
    }
    let help = "rename this motor, or the joint or leg";
    let parameters = robot.parameters();
    let names = robot.actuator_names();
    let usual: Vec<&str> = names.usual().collect();
    let first = usual.len() - robot.motors.len();
    for (index, motor) in robot.motors.iter().enumerate() {
        let own = usual.get(first + index).copied().unwrap_or_default();
        if usual.iter().filter(|name| **name == own).count() > 1 {
            let message = format!("another actuator is also called `{own}`");
            let error = Diagnostic::new(Code::SAME_NAME, message, motor.name.span.clone());
            table.context.report(error.help(help));
            continue;
        }
        let of_motor = parameters
            .iter()
            .filter(|(_, body, ..)| *body == Body::Motor(index));
        let taken = of_motor.map(|(name, ..)| name).find(|name| {
            let alike = parameters.iter().filter(|(other, ..)| other == *name);
            alike.count() > 1
        });
        if let Some(name) = taken {
            let message = format!("another parameter is also called `{name}`");
            let error = Diagnostic::new(Code::SAME_NAME, message, motor.name.span.clone());
            table.context.report(error.help(help));
        }
    }
}

/// Leg and joint names are joined by underscores, so two bodies may get the same name.
fn check_parameter_names(table: &Table<'_, '_>, robot: &Inventory<'_>) {
    let joined = |leg: &Leg, joint: &crate::robot::model::Joint| {
        format!("{}_{}", joint.name.value, leg.name.value)
    };
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut legs_by_name: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for leg in robot.legs {
        *counts.entry(&leg.name.value).or_default() += 1;
        for joint in &leg.joints {
            let legs = legs_by_name.entry(joined(leg, joint)).or_default();
            legs.insert(&leg.name.value);
        }
    }
    // Legs of the same name are a separate error.
    for leg in robot
        .legs
        .iter()
        .filter(|leg| counts[leg.name.value.as_str()] == 1)
    {
        let mut names = leg.joints.iter().map(|joint| joined(leg, joint));
        if let Some(name) = names.find(|name| legs_by_name[name].len() > 1) {
            let message = format!("another leg's joint is also called `{name}`");
            let diagnostic = Diagnostic::new(Code::SAME_NAME, message, leg.name.span.clone());
            table
                .context
                .report(diagnostic.help("choose names without underscores"));
        }
    }
}
