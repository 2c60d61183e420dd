//! Names in expressions, and typed values of expressions.

use crate::diagnostic::Spanned;
use crate::diagnostic::{Code, Diagnostic, Span};
use crate::expressions::dimension::{Dimension, UNITS, unit};
use crate::expressions::expression::{Failure, Meaning, Names, Quantity, evaluate, number};
use crate::expressions::function::FUNCTIONS;
use crate::expressions::scalar::Scalar;
use crate::expressions::value::{Fault, Value};
use crate::toml_text::reader::{Context, Item, Table};
use overact_exact::{Angle, Number};
use std::cell::Cell;
use toml::de::DeValue;

/// Named constants and, inside a joint's expression, joint variables.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scope {
    /// Named values; `None` for one that could not be evaluated.
    entries: Vec<(String, Option<Value>)>,
}

impl Names for Scope {
    fn meaning(&self, name: &str) -> Meaning {
        match self.entries.iter().rev().find(|(n, _)| n == name) {
            Some((_, Some(value))) => Meaning::Value(value.clone()),
            Some((_, None)) => Meaning::Poisoned,
            None => Meaning::Unknown,
        }
    }

    fn all(&self) -> Vec<String> {
        self.entries.iter().map(|(name, _)| name.clone()).collect()
    }
}

/// Looks up names, and records the numbers of the expression.
struct RecordedNames<'s, 'c, 't> {
    scope: &'s Scope,
    context: &'c Context<'t>,
    /// Whether the expression uses a named constant.
    uses_constants: Cell<bool>,
}

impl Names for RecordedNames<'_, '_, '_> {
    fn meaning(&self, name: &str) -> Meaning {
        let meaning = self.scope.meaning(name);
        if matches!(&meaning, Meaning::Value(value) if value.terms.is_empty()) {
            self.uses_constants.set(true);
        }
        meaning
    }

    fn all(&self) -> Vec<String> {
        self.scope.all()
    }

    fn record(&self, magnitude: f64) {
        self.context.record(magnitude);
    }
}

/// Largest number of constants of a description, which are searched linearly.
const MOST_CONSTANTS: usize = 2_000;

impl Scope {
    /// The constants of `[constants]`, each of which may use earlier ones.
    pub(crate) fn constants(table: &Table<'_, '_>) -> Self {
        let mut scope = Self::default();
        let items = table.items();
        if let Some(next) = items.get(MOST_CONSTANTS) {
            let message = format!("there are more than {MOST_CONSTANTS} constants");
            let diagnostic = Diagnostic::new(Code::FORMULA, message, next.key.span.clone());
            let help = "take out those that are not used";
            next.context.report(diagnostic.help(help));
        }
        for item in items.into_iter().take(MOST_CONSTANTS) {
            check_name(&item);
            let value = item.evaluate(&scope);
            scope.add(item.key.value.clone(), value);
        }
        scope
    }

    /// All constants except angles, in SI units.
    pub(crate) fn values(&self) -> Vec<(String, f64)> {
        let number = |(name, value): &(String, Option<Value>)| match value.as_ref()?.scalar {
            Scalar::Number(number) => Some((name.clone(), number.value())),
            Scalar::Angle(_) => None,
        };
        self.entries.iter().filter_map(number).collect()
    }

    /// The names that are not joint variables.
    pub(crate) fn without_variables(&self) -> Self {
        let holds = |value: &Option<Value>| value.as_ref().is_some_and(|v| !v.terms.is_empty());
        let entries = self.entries.iter().filter(|(_, value)| !holds(value));
        Self {
            entries: entries.cloned().collect(),
        }
    }

    pub(crate) fn contains(&self, name: &str) -> bool {
        self.entries.iter().any(|(n, _)| n == name)
    }

    pub(crate) fn add(&mut self, name: String, value: Option<Value>) {
        self.entries.push((name, value));
    }
}

/// Why a name is invalid for a constant.
pub(crate) fn name_problem(name: &str) -> Option<&'static str> {
    let starts_well = name.starts_with(|c: char| c.is_ascii_alphabetic());
    if !starts_well || !is_word(name) {
        return Some(
            "a constant's name has letters, digits and underscores and starts with a letter",
        );
    }
    if unit(name).is_some() || UNITS.contains(&name) {
        return Some("this is the name of a unit");
    }
    if name == "pi" || FUNCTIONS.contains(&name) {
        return Some("this name has a meaning in expressions");
    }
    let rest = name.strip_prefix('q')?;
    let variable = rest.is_empty() || rest.starts_with(|c: char| c.is_ascii_digit() || c == '_');
    variable.then_some("names like `q`, `q1` and `q_elbow` are joint variables")
}

/// Whether a name consists of ASCII letters, digits and underscores.
pub(crate) fn is_word(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

fn check_name(item: &Item<'_, '_>) {
    if let Some(problem) = name_problem(&item.key.value) {
        let message = format!("a constant cannot be named `{}`", item.key.value);
        item.context
            .report(Diagnostic::new(Code::BAD_NAME, message, item.key.span.clone()).label(problem));
    }
}

impl Item<'_, '_> {
    /// The value of a number or an expression.
    pub(crate) fn evaluate(&self, scope: &Scope) -> Option<Value> {
        let value: Value = self.evaluate_as(scope)?;
        self.kept(value.of_a_robot().map_err(whole))
    }

    /// The value of a number or an expression as a quantity of some kind.
    pub(crate) fn evaluate_as<Q: Quantity>(&self, scope: &Scope) -> Option<Q> {
        let plain = |number| Q::from_value(Value::plain(number));
        let outcome = match self.value {
            DeValue::String(text) => self.evaluate_text(text, scope),
            DeValue::Integer(text) => {
                let digits = text.as_str();
                let decimal = if text.radix() == 10 {
                    number(digits)
                } else {
                    i64::from_str_radix(digits, text.radix())
                        .ok()
                        .map(Number::integer)
                };
                decimal.map(plain).ok_or_else(out_of_range)
            }
            DeValue::Float(text) => {
                let decimal = number(text.as_str());
                decimal.inspect(|decimal| self.context.record(decimal.value()));
                decimal.map(plain).ok_or_else(out_of_range)
            }
            _ => return self.mismatch("a number or an expression"),
        };
        self.kept(outcome)
    }

    /// The value of an expression.
    ///
    /// Its numbers are recorded, and its result if it uses no named constant.
    fn evaluate_text<Q: Quantity>(&self, text: &str, scope: &Scope) -> Result<Q, Failure> {
        let names = RecordedNames {
            scope,
            context: self.context,
            uses_constants: Cell::new(false),
        };
        let value: Q = evaluate(text, &names)?;
        if let (Some(magnitude), false) = (value.constant_part(), names.uses_constants.get()) {
            self.context.record(magnitude);
        }
        Ok(value)
    }

    /// The result, or `None` after its fault is reported.
    fn kept<Q>(&self, outcome: Result<Q, Failure>) -> Option<Q> {
        match outcome {
            Ok(value) => Some(value),
            Err(Failure::Fault(fault, span)) => {
                let span = self.inner_span(&span);
                let diagnostic =
                    Diagnostic::new(Code::FORMULA, fault.message, span).maybe_help(fault.help);
                self.context.report_once(diagnostic);
                None
            }
            Err(Failure::Consequence) => None,
        }
    }

    /// Location of bytes of a string, if the string has no escapes; otherwise of all of it.
    fn inner_span(&self, span: &Span) -> Span {
        let (DeValue::String(text), raw) = (self.value, self.context.text(&self.span)) else {
            return self.span.clone();
        };
        let quotes = if raw.starts_with("\"\"\"") || raw.starts_with("'''") {
            3
        } else {
            1
        };
        let start = self.span.start + quotes;
        let verbatim = raw.get(quotes..raw.len().saturating_sub(quotes)) == Some(text.as_ref());
        if verbatim && span.end <= text.len() && span.start < span.end {
            start + span.start..start + span.end
        } else {
            self.span.clone()
        }
    }

    /// A value without joint variables and with a fitting dimension.
    pub(crate) fn quantity(&self, expected: Dimension, scope: &Scope) -> Option<Value> {
        let value = self.evaluate(scope)?;
        if !value.terms.is_empty() {
            let message = format!(
                "`{}` is constant and cannot hold a joint variable",
                self.key.value
            );
            let help =
                "joint variables are allowed in theta of a revolute or r of a prismatic joint";
            self.context
                .report_once(self.error(Code::JOINT_POSITION, message).help(help));
            return None;
        }
        self.check_dimension(&value, expected)?;
        Some(value)
    }

    pub(crate) fn check_dimension(&self, value: &Value, expected: Dimension) -> Option<()> {
        if value.dimension.fits(expected) {
            return Some(());
        }
        let found = value.dimension.name();
        let message = format!(
            "`{}`: expected {}, found {found} ({})",
            self.key.value,
            expected.describe(),
            value.describe()
        );
        self.context.report_once(
            self.error(Code::UNIT, message)
                .label(format!("this is {found}")),
        );
        None
    }

    pub(crate) fn number(&self, expected: Dimension, scope: &Scope) -> Option<Spanned<Number>> {
        let value = self.quantity(expected, scope)?;
        Some(Spanned::new(value.scalar.to_number(), self.span.clone()))
    }

    pub(crate) fn float(&self, expected: Dimension, scope: &Scope) -> Option<f64> {
        Some(self.quantity(expected, scope)?.scalar.value())
    }

    /// A number greater than zero.
    pub(crate) fn positive(&self, expected: Dimension, scope: &Scope) -> Option<f64> {
        self.bounded(expected, scope, |v| v > 0.0, "greater than 0")
    }

    /// A nonnegative number.
    pub(crate) fn not_negative(&self, expected: Dimension, scope: &Scope) -> Option<f64> {
        self.bounded(expected, scope, |v| v >= 0.0, "at least 0")
    }

    fn bounded(
        &self,
        expected: Dimension,
        scope: &Scope,
        inside: fn(f64) -> bool,
        bound: &str,
    ) -> Option<f64> {
        let value = self.quantity(expected, scope)?;
        if inside(value.scalar.value()) {
            return Some(value.scalar.value());
        }
        let found = value.describe();
        let message = format!(
            "`{}`: expected a value {bound}, found {found}",
            self.key.value
        );
        self.context
            .report_once(self.error(Code::OUT_OF_RANGE, message));
        None
    }

    pub(crate) fn angle(&self, scope: &Scope) -> Option<Spanned<Angle>> {
        let value = self.quantity(Dimension::ANGLE, scope)?;
        self.to_angle(&value)
    }

    /// The constant part of a value as an angle.
    pub(crate) fn to_angle(&self, value: &Value) -> Option<Spanned<Angle>> {
        let angle = value.scalar.to_angle();
        if angle.is_none() {
            self.context
                .report_once(self.error(Code::OUT_OF_RANGE, "the angle is too large"));
        }
        Some(Spanned::new(angle?, self.span.clone()))
    }
}

/// A fault of the whole expression.
fn whole(fault: Fault) -> Failure {
    Failure::Fault(fault, 0..usize::MAX)
}

fn out_of_range() -> Failure {
    Failure::Fault(Fault::new("this number is out of range"), 0..usize::MAX)
}
