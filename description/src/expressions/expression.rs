//! Expressions: numbers with units, names, arithmetic and a few functions, evaluated while parsing.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = { "-" | "+" } power
//! power   = atom [ "^" unary ]
//! atom    = number [ units ] | name | function "(" sum { "," sum } ")" | "(" sum ")"
//! units   = unit [ "^" integer ] { [ "*" | "/" ] unit [ "^" integer ] }
//! ```
//!
//! Units that follow a number belong to it: `6 m / 2 m/s` is `(6 m) / (2 m/s)`.

use crate::diagnostic::{Span, did_you_mean};
use crate::expressions::dimension::{Dimension, UNITS, unit};
use crate::expressions::function::{FUNCTIONS, apply, arity};
use crate::expressions::scalar::Scalar;
use crate::expressions::token::{Token, TokenKind, tokens};
use crate::expressions::value::{Fault, Value};
use overact_exact::{Angle, Number, Ratio};
use std::marker::PhantomData;

/// Largest nesting depth of parentheses and signs.
const DEPTH: usize = 64;

/// Largest number of known names in the error of an unknown one.
const KNOWN: usize = 50;

/// Meaning of a name.
pub(crate) enum Meaning {
    /// A value.
    Value(Value),
    /// A value that is unknown because of an error, which is already reported.
    Poisoned,
    /// An unknown name.
    Unknown,
}

/// The names that an expression may use.
pub(crate) trait Names {
    /// The meaning of a name.
    fn meaning(&self, name: &str) -> Meaning;
    /// All names, for suggestions.
    fn all(&self) -> Vec<String>;
    /// Called with the magnitude of every number that is written with its units, in SI.
    fn record(&self, _magnitude: f64) {}
}

/// Reason why an expression has no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Failure {
    /// A fault at bytes of the expression.
    Fault(Fault, Span),
    /// A consequence of an error that is already reported.
    Consequence,
}

/// Result type of expressions.
pub(crate) trait Quantity: Sized + Clone {
    /// A constant or a name's value.
    fn from_value(value: Value) -> Self;
    /// Sum.
    fn plus(self, other: Self) -> Result<Self, Fault>;
    /// Negative.
    fn negative(self) -> Self;
    /// Product.
    fn times(self, other: Self) -> Result<Self, Fault>;
    /// Reciprocal.
    fn reciprocal(self) -> Result<Self, Fault>;
    /// A power with an integer exponent.
    fn power(self, exponent: &Self) -> Result<Self, Fault>;
    /// Value of a function; the number of arguments is already checked.
    fn apply(name: &str, arguments: Vec<Self>) -> Result<Self, Fault>;
    /// The constant part in SI units; angles in rad.
    fn constant_part(&self) -> Option<f64>;
}

impl Quantity for Value {
    fn from_value(value: Value) -> Self {
        value
    }

    fn plus(self, other: Self) -> Result<Self, Fault> {
        self.plus(other)
    }

    fn negative(self) -> Self {
        self.negative()
    }

    fn times(self, other: Self) -> Result<Self, Fault> {
        self.times(other)
    }

    fn reciprocal(self) -> Result<Self, Fault> {
        self.reciprocal()
    }

    fn power(self, exponent: &Self) -> Result<Self, Fault> {
        self.power(exponent)
    }

    fn apply(name: &str, arguments: Vec<Self>) -> Result<Self, Fault> {
        apply(name, arguments)
    }

    fn constant_part(&self) -> Option<f64> {
        Some(self.scalar.value())
    }
}

type Outcome<Q> = Result<Q, Failure>;

/// Evaluates an expression.
pub(crate) fn evaluate<Q: Quantity>(text: &str, names: &dyn Names) -> Outcome<Q> {
    let tokens = tokens(text).map_err(|(fault, span)| Failure::Fault(fault, span))?;
    let end = text.trim_end().len();
    let mut reader = Reader {
        tokens: &tokens,
        at: 0,
        depth: 0,
        end,
        names,
        of: PhantomData,
    };
    if tokens.is_empty() {
        let fault = Fault::new("expected an expression, found an empty string");
        return Err(Failure::Fault(
            fault.help("write a number with its unit, for instance \"0.41 m\""),
            0..text.len(),
        ));
    }
    let value = reader.sum()?;
    match reader.next() {
        None => Ok(value),
        Some(token) if token.is(')') => Err(fault_at(
            "this `)` has no opening parenthesis",
            token.span.clone(),
        )),
        Some(token) => {
            let message = format!("expected an operator or the end, found `{}`", token.text);
            let hint = Fault::new(message).maybe_help(unit_hint(token));
            Err(Failure::Fault(hint, token.span.clone()))
        }
    }
}

/// An unsigned number of a TOML file or an expression; decimals are exact.
pub(crate) fn number(text: &str) -> Option<Number> {
    if let Some(ratio) = Ratio::decimal(text) {
        return Some(Number::ratio(ratio));
    }
    // More digits than a fraction can hold: the float is as good as the author's intent.
    let value: f64 = text.replace('_', "").parse().ok()?;
    value.is_finite().then(|| Number::float(value))
}

fn fault_at(message: impl Into<String>, span: Span) -> Failure {
    Failure::Fault(Fault::new(message), span)
}

fn unit_hint(token: &Token<'_>) -> Option<String> {
    let is_name = token.kind == TokenKind::Name;
    if is_name && UNITS.contains(&token.text) {
        let unit = token.text;
        return Some(format!("a unit stands after a number: write `* 1 {unit}`"));
    }
    let all = || format!("units are {}", UNITS.join(", "));
    is_name.then(|| did_you_mean(token.text, UNITS).unwrap_or_else(all))
}

struct Reader<'r, 't, Q> {
    tokens: &'r [Token<'t>],
    at: usize,
    depth: usize,
    end: usize,
    names: &'r dyn Names,
    of: PhantomData<Q>,
}

impl<'r, 't, Q: Quantity> Reader<'r, 't, Q> {
    fn peek(&self) -> Option<&'r Token<'t>> {
        self.tokens.get(self.at)
    }

    fn next(&mut self) -> Option<&'r Token<'t>> {
        let token = self.peek();
        self.at += 1;
        token
    }

    /// Consumes the next token if it is this symbol.
    fn take(&mut self, symbol: char) -> Option<&'r Token<'t>> {
        let token = self.peek().filter(|t| t.is(symbol))?;
        self.at += 1;
        Some(token)
    }

    /// Span from the start of a token to the end of the last one read.
    fn since(&self, start: usize) -> Span {
        let last = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        start..last.map_or(self.end, |t| t.span.end)
    }

    fn start(&self) -> usize {
        self.peek().map_or(self.end, |t| t.span.start)
    }

    /// Locates a fault at everything read since `start`.
    fn located(&self, start: usize, result: Result<Q, Fault>) -> Outcome<Q> {
        result.map_err(|fault| Failure::Fault(fault, self.since(start)))
    }

    fn sum(&mut self) -> Outcome<Q> {
        let start = self.start();
        let mut value = self.product()?;
        loop {
            let term = if self.take('+').is_some() {
                self.product()?
            } else if self.take('-').is_some() {
                self.product()?.negative()
            } else {
                return Ok(value);
            };
            value = self.located(start, value.plus(term))?;
        }
    }

    fn product(&mut self) -> Outcome<Q> {
        let start = self.start();
        let mut value = self.unary()?;
        loop {
            let factor = if self.take('*').is_some() {
                self.unary()?
            } else if self.take('/').is_some() {
                let divisor_start = self.start();
                let divisor = self.unary()?;
                self.located(divisor_start, divisor.reciprocal())?
            } else {
                return Ok(value);
            };
            value = self.located(start, value.times(factor))?;
        }
    }

    fn unary(&mut self) -> Outcome<Q> {
        let mut negative = false;
        while let Some(sign) = self.peek().filter(|t| t.is('-') || t.is('+')) {
            negative ^= sign.is('-');
            self.at += 1;
        }
        let value = self.nested(Self::power)?;
        Ok(if negative { value.negative() } else { value })
    }

    fn power(&mut self) -> Outcome<Q> {
        let start = self.start();
        let base = self.atom()?;
        if self.take('^').is_none() {
            return Ok(base);
        }
        let exponent = self.unary()?;
        self.located(start, base.power(&exponent))
    }

    /// Reads one nesting level deeper, unless that is too deep.
    fn nested(&mut self, read: fn(&mut Self) -> Outcome<Q>) -> Outcome<Q> {
        if self.depth >= DEPTH {
            let start = self.start();
            return Err(fault_at(
                "the expression is nested too deeply",
                start..self.end.max(start),
            ));
        }
        self.depth += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }

    fn atom(&mut self) -> Outcome<Q> {
        let Some(token) = self.next() else {
            return Err(fault_at(
                "the expression ends where a value is expected",
                self.last_token(),
            ));
        };
        match token.kind {
            TokenKind::Number => self.quantity(token),
            TokenKind::Name if self.peek().is_some_and(|t| t.is('(')) => self.function(token),
            TokenKind::Name => self.name(token),
            TokenKind::Symbol('(') => {
                let value = self.nested(Self::sum)?;
                self.close(token)?;
                Ok(value)
            }
            TokenKind::Symbol(_) => Err(fault_at(
                format!("expected a value, found `{}`", token.text),
                token.span.clone(),
            )),
        }
    }

    fn last_token(&self) -> Span {
        self.tokens.last().map_or(0..self.end, |t| t.span.clone())
    }

    fn close(&mut self, open: &Token<'_>) -> Result<(), Failure> {
        match (self.take(')'), self.peek()) {
            (Some(_), _) => Ok(()),
            (None, None) => Err(fault_at(
                "this parenthesis is not closed",
                open.span.clone(),
            )),
            (None, Some(token)) => {
                let message = format!("expected an operator or `)`, found `{}`", token.text);
                let fault = Fault::new(message).maybe_help(unit_hint(token));
                Err(Failure::Fault(fault, token.span.clone()))
            }
        }
    }

    /// A number and its units.
    fn quantity(&mut self, token: &Token<'_>) -> Outcome<Q> {
        let start = token.span.start;
        let number = number(token.text);
        let number =
            number.ok_or_else(|| fault_at("this is not a number in range", token.span.clone()))?;
        let mut value = Q::from_value(Value::plain(number));
        let mut first = true;
        while let Some(factor) = self.unit_factor(first)? {
            value = self.located(start, value.times(factor))?;
            first = false;
        }
        if let Some(magnitude) = value.constant_part() {
            self.names.record(magnitude);
        }
        Ok(value)
    }

    /// The next unit of a product of units, if there is one.
    fn unit_factor(&mut self, first: bool) -> Result<Option<Q>, Failure> {
        let before = self.at;
        let mut divide = false;
        if !first && let Some(sign) = self.peek().filter(|t| t.is('/') || t.is('*')) {
            divide = sign.is('/');
            self.at += 1;
        }
        let start = self.start();
        let found = self
            .peek()
            .filter(|t| t.kind == TokenKind::Name)
            .and_then(|t| unit(t.text));
        let Some((scalar, dimension)) = found else {
            self.at = before;
            return Ok(None);
        };
        self.at += 1;
        let mut value = Q::from_value(Value::constant(scalar, dimension));
        if self.take('^').is_some() {
            let exponent = self.unary()?;
            value = self.located(start, value.power(&exponent))?;
        }
        if divide {
            value = self.located(start, value.reciprocal())?;
        }
        Ok(Some(value))
    }

    fn name(&self, token: &Token<'_>) -> Outcome<Q> {
        match self.names.meaning(token.text) {
            Meaning::Value(value) => return Ok(Q::from_value(value)),
            Meaning::Poisoned => return Err(Failure::Consequence),
            Meaning::Unknown => {}
        }
        if token.text == "pi" {
            let pi = Scalar::angle(Angle::half_turns(Ratio::ONE));
            return Ok(Q::from_value(Value::constant(pi, Dimension::NONE)));
        }
        if let Some((scalar, dimension)) = unit(token.text) {
            return Ok(Q::from_value(Value::constant(scalar, dimension)));
        }
        let all = self.names.all();
        let help = did_you_mean(token.text, all.iter().map(String::as_str));
        let is_short = (1..=KNOWN).contains(&all.len());
        let help = help.or_else(|| is_short.then(|| format!("known here: {}", all.join(", "))));
        let fault = Fault::new(format!("unknown name `{}`", token.text)).maybe_help(help);
        Err(Failure::Fault(fault, token.span.clone()))
    }

    fn function(&mut self, token: &Token<'_>) -> Outcome<Q> {
        let name = token.text;
        let Some(arity) = arity(name) else {
            let help = did_you_mean(name, FUNCTIONS);
            let help =
                help.unwrap_or_else(|| format!("the functions are {}", FUNCTIONS.join(", ")));
            let fault = Fault::new(format!("unknown function `{name}`")).help(help);
            return Err(Failure::Fault(fault, token.span.clone()));
        };
        let Some(open) = self.next() else {
            return Err(Failure::Consequence);
        };
        let mut arguments = vec![self.nested(Self::sum)?];
        while self.take(',').is_some() {
            arguments.push(self.nested(Self::sum)?);
        }
        self.close(open)?;
        if arguments.len() != arity {
            let message = format!(
                "`{}` takes {arity} argument(s), found {}",
                token.text,
                arguments.len()
            );
            return Err(fault_at(message, self.since(token.span.start)));
        }
        self.located(token.span.start, Q::apply(token.text, arguments))
    }
}
