//! The tables `[[spring]]`: springs and dampers between two points on two bodies.
//!
//! The element's force is an expression of its length `l` and the length's rate `dl`; a positive
//! one pulls the points together. `force` is the force per unit of an unknown coefficient, `known`
//! a known force.

use crate::diagnostic::{Code, Diagnostic, Span, Spanned, did_you_mean};
use crate::expressions::dimension::Dimension;
use crate::expressions::formula::{Formula, Spring};
use crate::expressions::value::Value;
use crate::robot::leg::chain::GROUND;
use crate::robot::model::{BodyIndex, Leg};
use crate::robot::spring;
use crate::toml_text::reader::{Item, Table};
use crate::toml_text::scope::{Scope, is_word};
use overact_exact::Number;

/// Name of the platform as the body of a point.
const PLATFORM: &str = "platform";

/// Largest number of springs between points.
const MOST: usize = 200;

/// A spring or damper between two points on two bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSpring {
    /// Name, unique in the robot; its coefficient is `k_NAME`.
    pub name: Spanned<String>,
    /// One end.
    pub from: SpringEnd,
    /// The other end.
    pub to: SpringEnd,
    /// Force per unit of an unknown coefficient, a formula of length (m) and rate (m/s).
    pub force: Option<Spring>,
    /// Known force, N.
    pub known: Option<Formula>,
    /// Location of its table.
    pub span: Span,
}

/// An end of a spring: a point on a body.
#[derive(Debug, Clone, PartialEq)]
pub struct SpringEnd {
    /// The body.
    pub body: SpringBody,
    /// The point in the body's frame, m.
    pub at: [Number; 3],
}

/// A body to which a spring is attached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpringBody {
    /// The ground, with the robot's base frame.
    Ground,
    /// The platform.
    Platform,
    /// The body that a joint moves.
    Joint(BodyIndex),
}

/// Reads all tables `[[spring]]`.
pub(crate) fn read(
    table: &Table<'_, '_>,
    scope: &Scope,
    has_platform: bool,
    legs: &[Leg],
) -> Vec<PointSpring> {
    let tables = table
        .get("spring")
        .map(|item| item.tables("the spring"))
        .unwrap_or_default();
    if let Some(next) = tables.get(MOST) {
        let message = format!("there are more than {MOST} springs");
        let error = Diagnostic::new(Code::OUT_OF_RANGE, message, next.span.clone());
        let help = "replace parallel springs by one";
        table.context.report(error.help(help));
    }
    let reader = Reader {
        scope,
        has_platform,
        legs,
    };
    let mut springs: Vec<PointSpring> = Vec::new();
    for one in tables.iter().take(MOST) {
        let spring = reader.spring(one);
        one.finish();
        let Some(spring) = spring else { continue };
        if springs
            .iter()
            .any(|other| other.name.value == spring.name.value)
        {
            let message = format!("there are two springs `{}`", spring.name.value);
            let error = Diagnostic::new(Code::SAME_NAME, message, spring.name.span.clone());
            let help = "parameters are named after springs: rename one of them";
            table.context.report(error.help(help));
            continue;
        }
        springs.push(spring);
    }
    springs
}

/// Data of the robot to which springs refer.
struct Reader<'r> {
    scope: &'r Scope,
    has_platform: bool,
    legs: &'r [Leg],
}

impl Reader<'_> {
    /// One spring; `None` after an error.
    fn spring(&self, table: &Table<'_, '_>) -> Option<PointSpring> {
        let name = table.require("name", "for instance name = \"gas\"");
        let name = name.and_then(|item| name_of(&item));
        let place = "for instance from = { body = \"ground\", at = [0, 0, \"0.2 m\"] }";
        let [from, to] = ["from", "to"].map(|key| {
            let item = table.require(key, place)?;
            self.end(&item)
        });
        self.check_constants(table);
        let variables = self.variables();
        let (force, known) = (table.get("force"), table.get("known"));
        if force.is_none() && known.is_none() {
            let message = "the spring has neither a `force` nor a `known` force";
            let help = "for instance force = \"l - 0.3 m\", with an unknown coefficient, or known = \"2 N/mm * (l - 0.3 m)\"";
            let error = Diagnostic::new(Code::MISSING_KEY, message, table.span.clone());
            table.context.report(error.help(help));
            return None;
        }
        let has_both = [&force, &known].map(Option::is_some);
        let force = force.and_then(|item| spring::force(&item, &variables));
        let known = known.and_then(|item| spring::known_force(&item, &variables));
        let (from, to) = (from?, to?);
        if from.body == to.body {
            let message = "both ends of the spring are on the same body";
            let help = "a spring connects two bodies; name another one in `from` or `to`";
            let error = Diagnostic::new(Code::CONTRADICTION, message, table.span.clone());
            table.context.report(error.help(help));
            return None;
        }
        let is_whole = has_both == [force.is_some(), known.is_some()];
        is_whole.then_some(PointSpring {
            name: name?,
            from,
            to,
            force,
            known,
            span: table.span.clone(),
        })
    }

    /// Reports constants that have the names of the length and its rate.
    fn check_constants(&self, table: &Table<'_, '_>) {
        for (name, of_spring) in [("l", "length"), ("dl", "rate of the length")] {
            if self.scope.contains(name) {
                let message =
                    format!("the constant `{name}` has the name of the {of_spring} of springs");
                let help = "rename the constant: in `force` and `known`, `l` and `dl` are the spring's length and its rate";
                let error = Diagnostic::new(Code::BAD_NAME, message, table.span.clone());
                table.context.report_once(error.help(help));
            }
        }
    }

    /// The constants, and the length and its rate.
    fn variables(&self) -> Scope {
        let mut scope = self.scope.clone();
        let variable = |index, dimension| Some(Value::variable(index, dimension));
        scope.add("l".to_owned(), variable(0, Dimension::LENGTH));
        scope.add("dl".to_owned(), variable(spring::RATE, Dimension::SPEED));
        scope
    }

    /// An end `{ body = "2", at = [0, 0, "0.1 m"] }`.
    fn end(&self, item: &Item<'_, '_>) -> Option<SpringEnd> {
        let table = item.table("the end of a spring")?;
        let body = table.require("body", "for instance body = \"ground\"");
        let body = body.and_then(|item| item.string());
        let body = body.and_then(|name| self.body(&name, &table));
        let at = match table.get("at") {
            Some(item) => item.vector(Dimension::LENGTH, self.scope),
            None => Some([Number::ZERO; 3]),
        };
        table.finish();
        Some(SpringEnd {
            body: body?,
            at: at?,
        })
    }

    /// The body of a name; `None` after an error.
    fn body(&self, name: &Spanned<String>, table: &Table<'_, '_>) -> Option<SpringBody> {
        let known = self.bodies();
        if let Some((_, body)) = known.iter().find(|(own, _)| *own == name.value) {
            return Some(*body);
        }
        // After another error the intended body may be missing.
        if !table.context.is_clean() {
            return None;
        }
        let names = known.iter().map(|(own, _)| own.as_str());
        let help = did_you_mean(&name.value, names.clone());
        let all = || format!("bodies are {}", names.collect::<Vec<_>>().join(", "));
        let message = format!("the robot has no body `{}`", name.value);
        let error = Diagnostic::new(Code::UNKNOWN_NAME, message, name.span.clone());
        let help = help.unwrap_or_else(all);
        table.context.report(error.help(help));
        None
    }

    /// Names of all bodies. Those of the first leg of a robot without a platform also have their
    /// joints' names alone.
    fn bodies(&self) -> Vec<(String, SpringBody)> {
        let mut all = vec![(GROUND.to_owned(), SpringBody::Ground)];
        if self.has_platform {
            all.push((PLATFORM.to_owned(), SpringBody::Platform));
        }
        for (index, leg) in self.legs.iter().enumerate() {
            let bodies = leg.joints.iter().enumerate();
            for (joint, own) in bodies.filter(|(_, own)| own.motor.is_none()) {
                let body = SpringBody::Joint(BodyIndex { leg: index, joint });
                if index == 0 && !self.has_platform {
                    all.push((own.name.value.clone(), body));
                }
                all.push((format!("{}.{}", leg.name.value, own.name.value), body));
            }
        }
        all
    }
}

/// A name that can be part of parameter names; `None` after an error.
fn name_of(item: &Item<'_, '_>) -> Option<Spanned<String>> {
    let name = item.string()?;
    if is_word(&name.value) {
        return Some(name);
    }
    let message = format!("`{}` cannot be the name of a spring", name.value);
    let help = "its parameter is named after it: use letters, digits and underscores";
    let error = Diagnostic::new(Code::BAD_NAME, message, name.span.clone());
    item.context.report(error.help(help));
    None
}
