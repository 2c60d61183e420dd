//! The tables `[leg.NAME]`: shapes of legs with unevaluated expressions.

use crate::diagnostic::{Code, Diagnostic, Span, did_you_mean};
use crate::robot::cable::{self, CableShape};
use crate::robot::joint_shape::compound::split;
use crate::robot::joint_shape::compound_kind::{CompoundJointKind, WORDS};
use crate::robot::joint_shape::{JointShape, STEPS};
use crate::robot::model::{JointKind, Spanned};
use crate::robot::motor::{self, MotorShape};
use crate::robot::parameters::Owner;
use crate::robot::warnings;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word, name_problem};
use overact_core::StandardParameter;

/// Largest number of joints of a robot: the check takes seconds, a model takes too long.
pub(crate) const MOST_JOINTS: usize = 200;

/// A leg's shape.
pub(crate) struct Shape<'c, 't> {
    pub(crate) name: Spanned<String>,
    /// Names of the constants that each placement sets.
    pub(crate) variables: Vec<Spanned<String>>,
    pub(crate) base_at: Option<Item<'c, 't>>,
    pub(crate) base_rotation: Option<Item<'c, 't>>,
    /// The body of the skeleton on which the base is fixed; the ground by default.
    pub(crate) base_body: Option<Spanned<String>>,
    pub(crate) joints: Vec<JointShape<'c, 't>>,
    pub(crate) motors: Vec<MotorShape<'c, 't>>,
    /// The cable, of a leg that is one; its only joint is its length.
    pub(crate) cable: Option<CableShape<'c, 't>>,
    pub(crate) end: Option<EndShape<'c, 't>>,
    pub(crate) span: Span,
}

/// A leg's end.
pub(crate) struct EndShape<'c, 't> {
    pub(crate) rigid: bool,
    pub(crate) at: Option<Item<'c, 't>>,
    pub(crate) rotation: Option<Item<'c, 't>>,
    /// Axes of the base frame along which a point end coincides with the platform's point.
    pub(crate) along: [bool; 3],
    /// The body of the skeleton on which the end is; the platform by default.
    pub(crate) body: Option<Spanned<String>>,
    pub(crate) span: Span,
}

/// Reads a shape; `None` if it is not a table.
pub(crate) fn read<'c, 't>(item: &Item<'c, 't>, constants: &Scope) -> Option<Shape<'c, 't>> {
    let name = item.key.clone();
    let table = item.table(format!("the leg `{}`", name.value))?;
    let variables = table
        .get("variables")
        .and_then(|i| i.strings())
        .unwrap_or_default();
    let variables = valid_variables(&table, variables, constants);
    let base = table.get("base").and_then(|i| i.table("`base`"));
    let (base_at, base_rotation, base_body) = match &base {
        Some(base) => (base.get("at"), base.get("rotation"), base.get("body")),
        None => (None, None, None),
    };
    let base_body = base_body.and_then(|item| item.string());
    if let Some(base) = base {
        base.finish();
    }
    let kind = table.get("type");
    let is_cable = kind.and_then(|item| item.choice(&[("joints", false), ("cable", true)]));
    let is_cable = is_cable.is_some_and(|kind| kind.value);
    let (cable, joints) = if is_cable {
        let (cable, length) = cable::shape(&table);
        (Some(cable), vec![length])
    } else {
        let help = "write its joints as [[leg.NAME.joint]], from the base on; a cable has type = \"cable\" instead";
        let joints = table.require("joint", help);
        (None, joints.map_or_else(Vec::new, |item| joints_of(&item)))
    };
    let names: Vec<Spanned<String>> = joints.iter().map(|joint| joint.name.clone()).collect();
    let motors = if is_cable { None } else { table.get("motor") };
    let motors = motors.map(|item| motor::shapes(&item, &names));
    let end = table.get("end").and_then(|item| {
        if is_cable {
            cable_end(&item)
        } else {
            end(&item)
        }
    });
    table.finish();
    Some(Shape {
        name,
        variables,
        base_at,
        base_rotation,
        base_body,
        joints,
        motors: motors.unwrap_or_default(),
        cable,
        end,
        span: table.span.clone(),
    })
}

/// The variables with valid names; others are reported.
fn valid_variables(
    table: &Table<'_, '_>,
    variables: Vec<Spanned<String>>,
    constants: &Scope,
) -> Vec<Spanned<String>> {
    let mut valid: Vec<Spanned<String>> = Vec::new();
    for variable in variables {
        let name = &variable.value;
        let problem = if ["name", "shape", "home"].contains(&name.as_str()) {
            Some("every placement already has this key")
        } else if constants.contains(name) {
            Some("there is a constant of this name")
        } else if valid.iter().any(|v| v.value == *name) {
            Some("this variable is listed twice")
        } else {
            name_problem(name)
        };
        if let Some(problem) = problem {
            let message = format!("a variable cannot be named `{name}`");
            table
                .context
                .report(Diagnostic::new(Code::BAD_NAME, message, variable.span).label(problem));
        } else {
            valid.push(variable);
        }
    }
    valid
}

fn joints_of<'c, 't>(item: &Item<'c, 't>) -> Vec<JointShape<'c, 't>> {
    let tables = item.tables("a joint");
    if tables.is_empty() && item.value.as_array().is_some_and(|list| list.is_empty()) {
        item.context
            .report(item.error(Code::LEG_EMPTY_OR_LARGE, "a leg needs at least one joint"));
    }
    if tables.len() > MOST_JOINTS {
        let message = format!(
            "the robot has {} joints, more than {MOST_JOINTS}",
            tables.len()
        );
        let error = item.error(Code::LEG_EMPTY_OR_LARGE, message);
        let help = "describe it in parts, each as a robot of its own";
        item.context.report(error.help(help));
        return Vec::new();
    }
    // Names come first, to distinguish antecedents from wrong names.
    let names: Vec<_> = tables
        .iter()
        .enumerate()
        .map(|(index, t)| joint_name(t, index))
        .collect();
    let antecedents: Vec<_> = tables
        .iter()
        .enumerate()
        .map(|(index, table)| antecedent(table, index, &names))
        .collect();
    check_order(&tables, &antecedents);
    let words: Vec<_> = tables.iter().map(word).collect();
    // The first axis of each table's joint, and the total number.
    let firsts = words.iter().scan(0, |next, word| {
        let first = *next;
        *next += word.value.count();
        Some(first)
    });
    let firsts: Vec<usize> = firsts.collect();
    let last = |table: usize| {
        let (first, word) = (firsts.get(table)?, words.get(table)?);
        Some(first + word.value.count() - 1)
    };
    let parts = tables.iter().zip(names).zip(antecedents).zip(&words);
    let joints = parts
        .zip(&firsts)
        .flat_map(|((((table, name), antecedent), word), first)| {
            let antecedent = antecedent.and_then(|antecedent| last(antecedent.value));
            split(word.value, joint(table, name, antecedent, word), *first)
        });
    let joints: Vec<JointShape<'c, 't>> = joints.collect();
    check_names(item, &joints);
    joints
}

/// Help for a missing pitch.
const PITCH: &str = "pitch = \"5 mm\" for each turn about z, or \"0.8 mm/rad\" for each radian";

/// The keyword of a table's joint; a revolute joint if it is unknown.
fn word(table: &Table<'_, '_>) -> Spanned<CompoundJointKind> {
    let help = "type = \"revolute\", \"prismatic\" or \"fixed\", or a joint of several axes: \"cylindrical\", \"universal\", \"spherical\", \"planar\", \"helical\"";
    let word = table
        .require("type", help)
        .and_then(|item| item.choice(&WORDS));
    word.unwrap_or(Spanned::new(
        CompoundJointKind::Simple(JointKind::Revolute),
        table.span.clone(),
    ))
}

/// Reports duplicate names of joints.
fn check_names(item: &Item<'_, '_>, joints: &[JointShape<'_, '_>]) {
    for (index, joint) in joints.iter().enumerate() {
        let name = &joint.name;
        let before = joints.get(..index).unwrap_or_default();
        if before.iter().any(|other| other.name.value == name.value) {
            let message = format!("there are two joints `{}` in this leg", name.value);
            item.context.report(
                Diagnostic::new(Code::SAME_NAME, message, name.span.clone())
                    .help("a joint without a name is called by its number, and one of several axes has axes `NAME_1` and others"),
            );
        }
    }
}

fn joint_name(table: &Table<'_, '_>, index: usize) -> Spanned<String> {
    let number = || Spanned::new((index + 1).to_string(), table.span.clone());
    let name = table
        .get("name")
        .and_then(|item| item.string())
        .unwrap_or_else(number);
    // "base" is the antecedent of the first joint.
    if !is_word(&name.value) || name.value == "base" {
        let message = format!("`{}` cannot be the name of a joint", name.value);
        let diagnostic = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
        table
            .context
            .report(diagnostic.help("use letters, digits and underscores, but not \"base\""));
    }
    name
}

/// Index and location of a joint's antecedent; `None` for the base.
fn antecedent(
    table: &Table<'_, '_>,
    index: usize,
    names: &[Spanned<String>],
) -> Option<Spanned<usize>> {
    let before = || {
        index
            .checked_sub(1)
            .map(|i| Spanned::new(i, table.span.clone()))
    };
    let Some(item) = table.get("antecedent") else {
        return before();
    };
    let text = item.string()?;
    if text.value == "base" {
        return None;
    }
    let found = names.iter().position(|name| name.value == text.value);
    if found.is_none() {
        let known = || names.iter().map(|n| n.value.as_str()).chain(["base"]);
        let message = format!("there is no joint `{}` in this leg", text.value);
        let list = || format!("known: {}", known().collect::<Vec<_>>().join(", "));
        let help = did_you_mean(&text.value, known()).unwrap_or_else(list);
        table
            .context
            .report(item.error(Code::UNKNOWN_NAME, message).help(help));
    }
    found.map(|i| Spanned::new(i, text.span))
}

/// Reports antecedents that form a cycle or come after their joint.
fn check_order(tables: &[Table<'_, '_>], antecedents: &[Option<Spanned<usize>>]) {
    for (index, (table, antecedent)) in tables.iter().zip(antecedents).enumerate() {
        let Some(antecedent) = antecedent.as_ref().filter(|a| a.value >= index) else {
            continue;
        };
        let mut at = Some(antecedent.value);
        let mut steps = 0;
        while let Some(joint) = at.filter(|joint| *joint != index && steps <= tables.len()) {
            at = antecedents
                .get(joint)
                .and_then(Option::as_ref)
                .map(|a| a.value);
            steps += 1;
        }
        let diagnostic = if at.is_some() {
            Diagnostic::new(
                Code::ANTECEDENTS,
                "the antecedents form a cycle",
                antecedent.span.clone(),
            )
            .help("every chain of antecedents must lead to \"base\"")
        } else {
            Diagnostic::new(
                Code::ANTECEDENTS,
                "the antecedent comes after the joint",
                antecedent.span.clone(),
            )
            .help("write the joints from the base on")
        };
        table.context.report(diagnostic);
    }
}

fn joint<'c, 't>(
    table: &Table<'c, 't>,
    name: Spanned<String>,
    antecedent: Option<usize>,
    word: &Spanned<CompoundJointKind>,
) -> JointShape<'c, 't> {
    let kind = Spanned::new(word.value.first(), word.span.clone());
    let called = name.value.clone();
    let steps = STEPS.map(|key| table.get(key));
    let actuated_item = table.get("actuated");
    let actuated = actuated_item
        .as_ref()
        .and_then(Item::boolean)
        .unwrap_or(false);
    let driven = actuated_item.as_ref().filter(|_| actuated);
    let dependent = table.get("dependent");
    let dependent = dependent.filter(|item| item.boolean() == Some(true));
    if word.value == CompoundJointKind::Simple(JointKind::Fixed) {
        if let Some(item) = driven {
            let message = "a fixed joint cannot be actuated";
            table.context.report(item.error(Code::ACTUATED, message));
        }
        warnings::payload(table.context, &name);
    }
    let owner = Owner::Joint(word.value.last());
    let parameters = table
        .get("parameters")
        .and_then(|item| item.parameters(owner));
    let mut parameters = parameters.unwrap_or_else(|| owner.default(actuated));
    let spring = table.get("spring");
    parameters.extend(spring.as_ref().map(|_| StandardParameter::K));
    let stribeck = table.get("stribeck");
    parameters.extend(stribeck.as_ref().map(|_| StandardParameter::Fst));
    let load = table.get("friction_load");
    parameters.extend(load.as_ref().map(|_| StandardParameter::Fl));
    let known = table.get("known");
    let pitch = pitch(table, word.value);
    let said = [&spring, &stribeck, &load, &known].map(Option::as_ref);
    let switches = [driven, dependent.as_ref()];
    word.value.check(said.into_iter().chain(switches).flatten());
    table.finish();
    JointShape {
        name,
        kind,
        antecedent,
        steps,
        turned: false,
        actuated: actuated && (word.value.count() == 1 || word.value == CompoundJointKind::Helical),
        dependent,
        parameters,
        spring,
        known,
        stribeck,
        load,
        pitch,
        word: word.value,
        called,
        span: table.span.clone(),
    }
}

/// The pitch of a helical joint; an error if it is missing, or given for another joint.
fn pitch<'c, 't>(table: &Table<'c, 't>, word: CompoundJointKind) -> Option<Item<'c, 't>> {
    if word == CompoundJointKind::Helical {
        return table.require("pitch", PITCH);
    }
    let item = table.get("pitch")?;
    let message = "`pitch` is for helical joints only";
    let help = "use type = \"helical\", or leave it out";
    let error = item.error(Code::CONTRADICTION, message).help(help);
    table.context.report(error);
    None
}

fn end<'c, 't>(item: &Item<'c, 't>) -> Option<EndShape<'c, 't>> {
    let table = item.table("the leg's `end`")?;
    let kind = table
        .get("type")
        .and_then(|item| item.choice(&[("rigid", true), ("point", false)]));
    let rigid = kind.is_none_or(|kind| kind.value);
    let (at, rotation) = (table.get("at"), table.get("rotation"));
    if let (Some(rotation), false) = (&rotation, rigid) {
        let message = "an end of type \"point\" has no rotation";
        item.context.report(
            rotation
                .error(Code::CONTRADICTION, message)
                .help("leave it out, or use type = \"rigid\""),
        );
    }
    let along = along(table.get("along").as_ref(), rigid);
    let body = table.get("body").and_then(|item| item.string());
    table.finish();
    Some(EndShape {
        rigid,
        at,
        rotation,
        along,
        body,
        span: table.span.clone(),
    })
}

/// The axes of `along = ["x", "y"]`; all by default.
fn along(item: Option<&Item<'_, '_>>, rigid: bool) -> [bool; 3] {
    let Some(item) = item else { return [true; 3] };
    if rigid {
        let message = "an end of type \"rigid\" is fixed in all directions";
        let help = "leave `along` out, or use type = \"point\"";
        item.context
            .report(item.error(Code::CONTRADICTION, message).help(help));
        return [true; 3];
    }
    let mut along = [false; 3];
    for axis in item.list().into_iter().flatten() {
        let axis = axis.choice(&[("x", 0), ("y", 1), ("z", 2)]);
        if let Some(axis) = axis {
            along[axis.value] = true;
        }
    }
    if along == [false; 3] {
        let help = "name at least one axis of the base frame, for instance along = [\"x\", \"y\"]";
        let message = "the leg's end does not meet the platform along any axis";
        item.context
            .report(item.error(Code::CONTRADICTION, message).help(help));
    }
    along
}

/// Reads the platform point of a cable.
fn cable_end<'c, 't>(item: &Item<'c, 't>) -> Option<EndShape<'c, 't>> {
    let table = item.table("the cable's `end`")?;
    let at = table.get("at");
    table.finish();
    Some(EndShape {
        rigid: false,
        at,
        rotation: None,
        along: [true; 3],
        body: None,
        span: table.span.clone(),
    })
}
