//! Arithmetic expressions of .par files with symbols and functions.

use std::collections::BTreeMap;

/// Largest depth of nested parentheses, functions and powers.
const DEPTH: usize = 50;

/// Reason why an expression has no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Fault {
    /// A symbol without a value.
    Unknown(String),
    /// Not an expression.
    Unreadable,
}

/// Evaluates an expression with values of its symbols.
pub(super) fn value(text: &str, symbols: &BTreeMap<String, f64>) -> Result<f64, Fault> {
    let mut reader = Reader {
        rest: text,
        symbols,
        depth: 0,
    };
    let value = reader.sum()?;
    if reader.rest.trim().is_empty() && value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::Unreadable)
    }
}

/// Distinct symbols of an expression.
pub(super) fn symbols(text: &str) -> Vec<String> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let words = text.split(|c: char| !is_part(c));
    let names = words.filter(|word| word.starts_with(|c: char| c.is_alphabetic()) && *word != "pi");
    let mut all: Vec<String> = names
        .filter(|word| function(word, &[1.0, 1.0]).is_none())
        .map(str::to_owned)
        .collect();
    all.sort();
    all.dedup();
    all
}

struct Reader<'r> {
    rest: &'r str,
    symbols: &'r BTreeMap<String, f64>,
    depth: usize,
}

impl Reader<'_> {
    fn next_is(&mut self, sign: &str) -> bool {
        self.rest = self.rest.trim_start();
        match self.rest.strip_prefix(sign) {
            Some(behind) => {
                self.rest = behind;
                true
            }
            None => false,
        }
    }

    /// Reads one level deeper, within the depth limit.
    fn nested(&mut self, read: fn(&mut Self) -> Result<f64, Fault>) -> Result<f64, Fault> {
        if self.depth >= DEPTH {
            return Err(Fault::Unreadable);
        }
        self.depth += 1;
        let value = read(self)?;
        self.depth -= 1;
        Ok(value)
    }

    fn sum(&mut self) -> Result<f64, Fault> {
        let mut sum = self.product()?;
        loop {
            if self.next_is("+") {
                sum += self.product()?;
            } else if self.next_is("-") {
                sum -= self.product()?;
            } else {
                return Ok(sum);
            }
        }
    }

    fn product(&mut self) -> Result<f64, Fault> {
        let mut product = self.signed()?;
        loop {
            // Powers (`**`) bind tighter and were already read.
            if self.next_is("*") {
                product *= self.signed()?;
            } else if self.next_is("/") {
                product /= self.signed()?;
            } else {
                return Ok(product);
            }
        }
    }

    fn signed(&mut self) -> Result<f64, Fault> {
        let mut sign = 1.0;
        loop {
            if self.next_is("-") {
                sign = -sign;
            } else if !self.next_is("+") {
                break;
            }
        }
        let base = self.atom()?;
        if self.next_is("**") || self.next_is("^") {
            return Ok(sign * base.powf(self.nested(Self::signed)?));
        }
        Ok(sign * base)
    }

    fn atom(&mut self) -> Result<f64, Fault> {
        if self.next_is("(") {
            let value = self.nested(Self::sum)?;
            return self.next_is(")").then_some(value).ok_or(Fault::Unreadable);
        }
        let rest = self.rest.trim_start();
        if rest.starts_with(|c: char| c.is_alphabetic()) {
            let end = rest
                .find(|c: char| !c.is_alphanumeric() && c != '_')
                .unwrap_or(rest.len());
            let name = &rest[..end];
            self.rest = &rest[end..];
            return self.named(name);
        }
        let mut end = rest
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(rest.len());
        let behind = &rest[end..];
        if let Some(exponent) = behind.strip_prefix(['e', 'E']) {
            let sign = usize::from(exponent.starts_with(['+', '-']));
            let digits = exponent[sign..]
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(exponent.len() - sign);
            if digits > 0 {
                end += 1 + sign + digits;
            }
        }
        self.rest = &rest[end..];
        rest[..end].parse().map_err(|_| Fault::Unreadable)
    }

    fn named(&mut self, name: &str) -> Result<f64, Fault> {
        if name == "pi" {
            return Ok(std::f64::consts::PI);
        }
        if function(name, &[1.0, 1.0]).is_some() && self.next_is("(") {
            let mut arguments = vec![self.nested(Self::sum)?];
            while self.next_is(",") {
                arguments.push(self.nested(Self::sum)?);
            }
            let value = function(name, &arguments);
            return value.filter(|_| self.next_is(")")).ok_or(Fault::Unreadable);
        }
        self.symbols
            .get(name)
            .copied()
            .ok_or_else(|| Fault::Unknown(name.to_owned()))
    }
}

fn function(name: &str, arguments: &[f64]) -> Option<f64> {
    let first = arguments.first().copied()?;
    Some(match name.to_ascii_lowercase().as_str() {
        "sin" => first.sin(),
        "cos" => first.cos(),
        "tan" => first.tan(),
        "asin" => first.asin(),
        "acos" => first.acos(),
        "atan" => first.atan(),
        "sqrt" => first.sqrt(),
        "abs" => first.abs(),
        "atan2" => first.atan2(arguments.get(1).copied()?),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{Fault, symbols, value};
    use std::collections::BTreeMap;

    #[test]
    fn par_expressions_are_evaluated() {
        let given = BTreeMap::from([("D3".to_owned(), 0.5), ("RL4".to_owned(), 2.0)]);
        let of = |text: &str| value(text, &given);
        assert_eq!(of("-pi/2"), Ok(-std::f64::consts::FRAC_PI_2));
        assert_eq!(of("D3**2 + 3*(RL4 - 1) - 1e-1"), Ok(0.25 + 3.0 - 0.1));
        assert_eq!(of("2^-1*atan2(0, -1)"), Ok(std::f64::consts::FRAC_PI_2));
        assert_eq!(of("D4"), Err(Fault::Unknown("D4".to_owned())));
        for wrong in [
            "",
            "(1",
            "1 2",
            "1/0",
            "sin()",
            "{1}",
            &"(".repeat(1000),
            &"1^".repeat(50_000),
            &"-(".repeat(50_000),
        ] {
            assert_eq!(of(wrong), Err(Fault::Unreadable), "{wrong}");
        }
        assert_eq!(symbols("th1 + pi/2 - sin(D3)*th1"), ["D3", "th1"]);
    }
}
