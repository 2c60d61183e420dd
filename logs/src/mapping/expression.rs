//! Expressions of columns: coupled motors, other units, known torques.
//!
//! An expression contains:
//!
//! - numbers and `pi`;
//! - columns by name (`q_1`, `data.q`, `q(:,2)`) or number (`$3`);
//! - other names in single quotation marks (`'motor 1 [deg]'`);
//! - the operators + - * / ^ and parentheses;
//! - the functions sin, cos, tan, asin, acos, atan, atan2, sqrt, abs, exp, sign;
//! - `poly(x, c0, c1, …)`, the polynomial c0 + c1 x + ….
//!
//! As in mathematics, -x^2 is -(x^2) and x^y^z is x^(y^z).

use std::{iter::Peekable, str::CharIndices};

/// Largest depth of parentheses and signs.
const LARGEST_DEPTH: usize = 64;

/// Largest length of an expression in bytes, since evaluation is recursive.
const LONGEST: usize = 4096;

/// An expression of columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    Number(f64),
    /// A column by its index.
    Column(usize),
    Negative(Box<Self>),
    Binary(Operator, Box<Self>, Box<Self>),
    Function(Function, Vec<Self>),
}

/// A binary operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
    Power,
}

/// A function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Sqrt,
    Abs,
    Exp,
    Sign,
    /// A polynomial of the first argument; coefficients start with the constant.
    Poly,
}

/// Functions with the number of their arguments; `poly` has any number.
const FUNCTIONS: [(&str, Function, usize); 12] = [
    ("sin", Function::Sin, 1),
    ("cos", Function::Cos, 1),
    ("tan", Function::Tan, 1),
    ("asin", Function::Asin, 1),
    ("acos", Function::Acos, 1),
    ("atan", Function::Atan, 1),
    ("atan2", Function::Atan2, 2),
    ("sqrt", Function::Sqrt, 1),
    ("abs", Function::Abs, 1),
    ("exp", Function::Exp, 1),
    ("sign", Function::Sign, 1),
    ("poly", Function::Poly, 0),
];

impl Expression {
    /// Parses an expression; `column` resolves a name to an expression.
    ///
    /// # Errors
    /// A sentence on the error in the text, or the error of `column`.
    pub(crate) fn parse(
        text: &str,
        column: &mut dyn FnMut(&str) -> Result<Self, String>,
    ) -> Result<Self, String> {
        if text.len() > LONGEST {
            return Err(format!("it has more than {LONGEST} bytes"));
        }
        let mut parser = Parser {
            text,
            rest: text.char_indices().peekable(),
            column,
            depth: 0,
        };
        let expression = parser.sum()?;
        match parser.peek() {
            None => Ok(expression),
            Some(found) => Err(format!("`{found}` is not expected")),
        }
    }

    /// Replaces the index of each column by its entry in `places`.
    pub(crate) fn renumber(&mut self, places: &[usize]) {
        match self {
            Self::Number(_) => {}
            Self::Column(place) => *place = places[*place],
            Self::Negative(one) => one.renumber(places),
            Self::Binary(_, left, right) => {
                left.renumber(places);
                right.renumber(places);
            }
            Self::Function(_, arguments) => {
                arguments.iter_mut().for_each(|own| own.renumber(places));
            }
        }
    }

    /// Value for the given values of the columns.
    pub(crate) fn evaluate(&self, columns: &[f64]) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Column(place) => columns[*place],
            Self::Negative(one) => -one.evaluate(columns),
            Self::Binary(operator, left, right) => {
                let (left, right) = (left.evaluate(columns), right.evaluate(columns));
                match operator {
                    Operator::Plus => left + right,
                    Operator::Minus => left - right,
                    Operator::Times => left * right,
                    Operator::Over => left / right,
                    Operator::Power => power(left, right),
                }
            }
            Self::Function(function, arguments) => {
                let value = |place: usize| arguments[place].evaluate(columns);
                match function {
                    Function::Sin => value(0).sin(),
                    Function::Cos => value(0).cos(),
                    Function::Tan => value(0).tan(),
                    Function::Asin => value(0).asin(),
                    Function::Acos => value(0).acos(),
                    Function::Atan => value(0).atan(),
                    Function::Atan2 => value(0).atan2(value(1)),
                    Function::Sqrt => value(0).sqrt(),
                    Function::Abs => value(0).abs(),
                    Function::Exp => value(0).exp(),
                    Function::Sign if value(0) == 0.0 => 0.0,
                    Function::Sign => value(0).signum(),
                    Function::Poly => {
                        let x = value(0);
                        let coefficients = arguments[1..].iter().rev();
                        coefficients.fold(0.0, |sum, own| sum * x + own.evaluate(columns))
                    }
                }
            }
        }
    }
}

/// A power; small integer exponents use multiplication.
fn power(base: f64, exponent: f64) -> f64 {
    if exponent.fract() == 0.0 && exponent.abs() <= 64.0 {
        base.powi(exponent as i32)
    } else {
        base.powf(exponent)
    }
}

/// Recursive-descent parser of an expression.
struct Parser<'a> {
    text: &'a str,
    rest: Peekable<CharIndices<'a>>,
    column: &'a mut dyn FnMut(&str) -> Result<Expression, String>,
    depth: usize,
}

impl<'a> Parser<'a> {
    /// The next non-blank character.
    fn peek(&mut self) -> Option<char> {
        while self.rest.next_if(|(_, c)| c.is_whitespace()).is_some() {}
        self.rest.peek().map(|(_, c)| *c)
    }

    /// Takes the next character if it is `wanted`.
    fn take(&mut self, wanted: char) -> bool {
        self.peek() == Some(wanted) && self.rest.next().is_some()
    }

    /// Takes the required next character.
    fn expect(&mut self, wanted: char) -> Result<(), String> {
        match self.peek() {
            Some(found) if found == wanted => {
                self.rest.next();
                Ok(())
            }
            Some(found) => Err(format!("expected `{wanted}`, found `{found}`")),
            None => Err(format!("`{wanted}` is missing at the end")),
        }
    }

    /// Terms with + and - between them.
    fn sum(&mut self) -> Result<Expression, String> {
        let mut sum = self.product()?;
        loop {
            let operator = match self.peek() {
                Some('+') => Operator::Plus,
                Some('-') => Operator::Minus,
                _ => return Ok(sum),
            };
            self.rest.next();
            sum = Expression::Binary(operator, Box::new(sum), Box::new(self.product()?));
        }
    }

    /// Factors with * and / between them.
    fn product(&mut self) -> Result<Expression, String> {
        let mut product = self.signed()?;
        loop {
            let operator = match self.peek() {
                Some('*') => Operator::Times,
                Some('/') => Operator::Over,
                _ => return Ok(product),
            };
            self.rest.next();
            product = Expression::Binary(operator, Box::new(product), Box::new(self.signed()?));
        }
    }

    /// A power with an optional sign.
    fn signed(&mut self) -> Result<Expression, String> {
        self.depth += 1;
        if self.depth > LARGEST_DEPTH {
            return Err(String::from("parentheses and signs are nested too deeply"));
        }
        let signed = if self.take('-') {
            Expression::Negative(Box::new(self.signed()?))
        } else if self.take('+') {
            self.signed()?
        } else {
            let base = self.primary()?;
            if self.take('^') {
                Expression::Binary(Operator::Power, Box::new(base), Box::new(self.signed()?))
            } else {
                base
            }
        };
        self.depth -= 1;
        Ok(signed)
    }

    /// A number, a column, a function, or an expression in parentheses.
    fn primary(&mut self) -> Result<Expression, String> {
        match self.peek() {
            None => Err(String::from("something is missing at the end")),
            Some('(') => {
                self.rest.next();
                let inside = self.sum()?;
                self.expect(')')?;
                Ok(inside)
            }
            Some('\'') => {
                self.rest.next();
                let name = self.while_is(|c| c != '\'');
                self.expect('\'')?;
                (self.column)(name)
            }
            Some('$') => {
                let start = self.place();
                self.rest.next();
                self.while_is(|c| c.is_ascii_digit());
                let end = self.place();
                (self.column)(&self.text[start..end])
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.named(),
            Some(c) => Err(format!("`{c}` is not expected")),
        }
    }

    /// Index of the next character in the text.
    fn place(&mut self) -> usize {
        self.rest
            .peek()
            .map_or(self.text.len(), |(place, _)| *place)
    }

    /// Takes characters while they satisfy `is`.
    fn while_is(&mut self, is: impl Fn(char) -> bool) -> &'a str {
        let start = self.place();
        while self.rest.next_if(|(_, c)| is(*c)).is_some() {}
        let end = self.place();
        &self.text[start..end]
    }

    fn number(&mut self) -> Result<Expression, String> {
        let start = self.place();
        self.while_is(|c| c.is_ascii_digit() || c == '.');
        let mut end = self.place();
        // `e` starts an exponent only if digits follow.
        let mut ahead = self.rest.clone();
        if ahead.next_if(|(_, c)| matches!(c, 'e' | 'E')).is_some() {
            ahead.next_if(|(_, c)| matches!(c, '+' | '-'));
            if ahead.peek().is_some_and(|(_, c)| c.is_ascii_digit()) {
                self.rest = ahead;
                self.while_is(|c| c.is_ascii_digit());
                end = self.place();
            }
        }
        let digits = &self.text[start..end];
        let value = digits.parse().ok().filter(|value: &f64| value.is_finite());
        let value = value.ok_or_else(|| format!("`{digits}` is not a number"))?;
        Ok(Expression::Number(value))
    }

    /// Skips indices and further names of a column: `(:,2)`, `(3).Data`, `[0]`, `{1}.q`.
    fn indices(&mut self, name: &str) -> Result<(), String> {
        loop {
            let end = match self.peek() {
                Some('(') => ')',
                Some('[') => ']',
                Some('{') => '}',
                _ => return Ok(()),
            };
            let place = self.while_is(|c| c != end);
            if place.contains(|c: char| c.is_alphabetic() || c == '$' || c == '\'') {
                let known: Vec<&str> = FUNCTIONS.iter().map(|(name, ..)| *name).collect();
                let known = known.join(", ");
                return Err(format!("there is no function `{name}`; there are {known}"));
            }
            self.expect(end)?;
            if self.peek() == Some('.') {
                self.while_is(|c| c.is_alphanumeric() || c == '_' || c == '.');
            }
        }
    }

    /// A function, a constant, or a column with an optional matrix index.
    fn named(&mut self) -> Result<Expression, String> {
        let start = self.place();
        self.while_is(|c| c.is_alphanumeric() || c == '_' || c == '.');
        let end = self.place();
        let name = &self.text[start..end];
        let known = FUNCTIONS.iter().find(|(known, ..)| *known == name);
        let Some(&(_, function, count)) = known else {
            self.indices(name)?;
            let end = self.place();
            return match self.text[start..end].trim_end() {
                "pi" => Ok(Expression::Number(std::f64::consts::PI)),
                column => (self.column)(column),
            };
        };
        if self.peek() != Some('(') {
            return Err(format!("`{name}` has no argument"));
        }
        self.expect('(')?;
        let mut arguments = vec![self.sum()?];
        while self.take(',') {
            arguments.push(self.sum()?);
        }
        self.expect(')')?;
        let fits = if count == 0 {
            arguments.len() > 1
        } else {
            arguments.len() == count
        };
        match (fits, count) {
            (true, _) => Ok(Expression::Function(function, arguments)),
            (false, 0) => Err(format!("`{name}` takes a variable and its coefficients")),
            (false, 1) => Err(format!("`{name}` takes one argument")),
            (false, _) => Err(format!("`{name}` takes {count} arguments")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Expression;

    /// Value of an expression for a = 2, b = 3 and the column $4 = 4.
    fn value(text: &str) -> Result<f64, String> {
        let mut column = |name: &str| match name {
            "a" => Ok(Expression::Column(0)),
            "b.c" | "b(:,1)" | "b [deg]" => Ok(Expression::Column(1)),
            "$4" => Ok(Expression::Column(2)),
            _ => Err(format!("no `{name}`")),
        };
        Ok(Expression::parse(text, &mut column)?.evaluate(&[2.0, 3.0, 4.0]))
    }

    #[test]
    fn expressions_are_evaluated_with_usual_precedence() {
        let cases = [
            ("1 + 2*3 - 4/8", 6.5),
            ("-a^2", -4.0),
            ("a^b.c^2", 512.0),
            ("a^-1", 0.5),
            ("2 - 3 - 4", -5.0),
            ("8/2/2", 2.0),
            ("--a", 2.0),
            ("(a + b(:,1)) * 'b [deg]'", 15.0),
            ("b( :, 1)", f64::NAN),
            ("1.5e1 * $4 + 2e", f64::NAN),
            ("1.5e-1*$4", 0.6),
            ("poly(a, 1, 0, -2, 0.5)", -3.0),
            ("sin(pi/6) + cos(0) + tan(0) + exp(0)", 2.5),
            ("atan2(0, -1) - acos(-1) + asin(0) + atan(0)", 0.0),
            ("sqrt($4) + abs(-3) + sign(-7) + sign(0)", 4.0),
        ];
        for (text, expected) in cases {
            match value(text) {
                Ok(found) => assert!((found - expected).abs() < 1e-12, "{text}: {found}"),
                Err(error) => assert!(expected.is_nan(), "{text}: {error}"),
            }
        }
    }

    #[test]
    fn invalid_expressions_are_rejected_with_the_reason() {
        let cases = [
            ("", "something is missing at the end"),
            ("a +", "something is missing at the end"),
            ("a b", "`b` is not expected"),
            ("(a", "`)` is missing at the end"),
            ("a * c", "no `c`"),
            ("sin a", "`sin` has no argument"),
            ("sin(a, a)", "`sin` takes one argument"),
            ("atan2(a)", "`atan2` takes 2 arguments"),
            ("poly(a)", "`poly` takes a variable and its coefficients"),
            ("1.2.3", "`1.2.3` is not a number"),
            ("1e999", "`1e999` is not a number"),
            ("a ? b", "`?` is not expected"),
            ("'a", "`'` is missing at the end"),
        ];
        for (text, message) in cases {
            assert_eq!(value(text).expect_err(text), message, "{text}");
        }
        let deep = |mark: &str| value(&format!("{}a", mark.repeat(4000))).expect_err("deep");
        assert!(deep("(").contains("too deeply"), "{}", deep("("));
        assert!(deep("-").contains("too deeply"), "{}", deep("-"));
        let sum = |terms: usize| value(&format!("a{}", "+a".repeat(terms - 1)));
        assert_eq!(sum(2000), Ok(4000.0));
        assert!(sum(100_000).expect_err("long").contains("4096 bytes"));
    }
}
