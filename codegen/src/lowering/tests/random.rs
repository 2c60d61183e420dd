//! Random functions in the language of the cases.

use super::language::{Line, Text};
use crate::cas::Stream;

/// The lines of a random function.
///
/// It has shared parts, products, quotients by guarded values, roots of sums of squares, signs, and
/// sines and cosines of sums of angles.
pub(super) fn function(seed: u64) -> Vec<Line> {
    let mut draw = Draw {
        stream: Stream::new(seed),
        values: vec!["a", "b", "c", "d"]
            .into_iter()
            .map(str::to_owned)
            .collect(),
        lines: Vec::new(),
    };
    let inputs = ["a", "b", "c", "d", "p", "q"].map(str::to_owned);
    draw.lines.push(Line::Input(inputs.to_vec()));
    for angle in ["p", "q", "r"] {
        draw.turn(angle);
    }
    let count = 8 + draw.stream.below(16);
    for number in 0..count {
        draw.step(number);
    }
    let outputs = 3 + draw.stream.below(6);
    let output = (0..outputs).map(|_| draw.sum()).collect();
    draw.lines.push(Line::Output(output));
    draw.lines
}

struct Draw {
    stream: Stream,
    /// Names of existing values.
    values: Vec<String>,
    lines: Vec<Line>,
}

fn binary(operator: char, a: Text, b: Text) -> Text {
    Text::Binary(operator, Box::new(a), Box::new(b))
}

impl Draw {
    fn define(&mut self, name: String, text: Text) {
        self.lines.push(Line::Let(name.clone(), text));
        self.values.push(name);
    }

    /// Cosine and sine of p, of q or of their sum.
    fn turn(&mut self, angle: &str) {
        let name = |name: &str| Text::Name(name.to_owned());
        let of = match (angle, self.stream.below(3)) {
            ("r", 0) => binary('+', name("p"), name("q")),
            ("r", 1) => binary('-', name("q"), name("p")),
            ("r", _) => binary(
                '+',
                name("q"),
                Text::Call("deg".to_owned(), vec![Text::Number("30".to_owned())]),
            ),
            _ => name(angle),
        };
        for function in ["cos", "sin"] {
            let call = Text::Call(function.to_owned(), vec![of.clone()]);
            self.define(format!("{function}_{angle}"), call);
        }
    }

    fn name(&mut self) -> Text {
        let at = self.stream.below(self.values.len());
        Text::Name(self.values[at].clone())
    }

    fn number(&mut self) -> Text {
        let numbers = ["2", "3", "0.5", "0.43"];
        Text::Number(numbers[self.stream.below(numbers.len())].to_owned())
    }

    fn product(&mut self) -> Text {
        let first = match self.stream.below(4) {
            0 => self.number(),
            1 => Text::Minus(Box::new(self.name())),
            _ => self.name(),
        };
        binary('*', first, self.name())
    }

    fn sum(&mut self) -> Text {
        let terms = 1 + self.stream.below(3);
        (0..terms).fold(self.product(), |sum, _| {
            let operator = if self.stream.below(3) == 0 { '-' } else { '+' };
            binary(operator, sum, self.product())
        })
    }

    /// 2 + a² + b², which is never zero.
    fn positive(&mut self) -> Text {
        let two = Text::Number("2".to_owned());
        (0..2).fold(two, |sum, _| {
            let name = self.name();
            binary('+', sum, binary('*', name.clone(), name))
        })
    }

    fn step(&mut self, number: usize) {
        let text = match self.stream.below(8) {
            0 => {
                let by = self.positive();
                binary('/', self.name(), by)
            }
            1 => Text::Call("sqrt".to_owned(), vec![self.positive()]),
            2 => {
                let sign = Text::Call("sign".to_owned(), vec![self.name()]);
                binary('*', self.sum(), sign)
            }
            3 => Text::Call("atan2".to_owned(), vec![self.sum(), self.positive()]),
            4 => self.product(),
            _ => self.sum(),
        };
        self.define(format!("x{number}"), text);
    }
}
