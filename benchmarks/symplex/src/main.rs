//! Shares the subexpressions of a model by symplex's `cse_many`.
//!
//! The standard input holds a line for every operation, `NAME OPERATOR OPERAND…`, and a line `output OPERAND`
//! for every output. An operand is the name of an earlier line, a decimal number, or else a symbol. The standard
//! output gets a line for every shared expression, its name and its tree in symplex's JSON, and then a line
//! `output` with the tree of every output.

use std::collections::HashMap;
use std::error::Error;
use std::io::{BufWriter, Write};

use symplex::prelude::{Context, Ex};

fn main() -> Result<(), Box<dyn Error>> {
    let outputs = read(&std::io::read_to_string(std::io::stdin())?)?;
    let (shared, outputs) = Ex::cse_many(&outputs.iter().collect::<Vec<_>>());
    let mut out = BufWriter::new(std::io::stdout().lock());
    for (name, value) in shared {
        writeln!(out, "{name} {}", value.to_json()?)?;
    }
    for output in outputs {
        writeln!(out, "output {}", output.to_json()?)?;
    }
    Ok(out.flush()?)
}

/// The outputs that the lines of `text` describe.
fn read(text: &str) -> Result<Vec<Ex>, Box<dyn Error>> {
    let context = Context::new();
    let mut known = HashMap::new();
    let mut outputs = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut operands = Vec::new();
        for word in words.iter().skip(if words.first() == Some(&"output") {
            1
        } else {
            2
        }) {
            operands.push(match known.get(word) {
                Some(value) => Ex::clone(value),
                None if word.starts_with(|c: char| c == '-' || c.is_ascii_digit()) => {
                    context.decimal_str(word)?
                }
                None => context.symbol(word),
            });
        }
        match (words.as_slice(), operands.as_slice()) {
            (["output", _], [value]) => outputs.push(value.clone()),
            ([name, operator, ..], _) => {
                let value = apply(operator, &operands)
                    .ok_or_else(|| format!("line {}: `{line}` is no operation", number + 1))?;
                known.insert(*name, value);
            }
            _ => {
                return Err(format!(
                    "line {}: `{line}` is neither an operation nor an output",
                    number + 1
                )
                .into());
            }
        }
    }
    Ok(outputs)
}

/// The expression that an operator makes of its operands.
fn apply(operator: &str, operands: &[Ex]) -> Option<Ex> {
    Some(match (operator, operands) {
        ("add", [a, b]) => a + b,
        ("sub", [a, b]) => a - b,
        ("mul", [a, b]) => a * b,
        ("div", [a, b]) => a / b,
        ("neg", [a]) => -a,
        ("sin", [a]) => a.sin(),
        ("cos", [a]) => a.cos(),
        ("sqrt", [a]) => a.sqrt(),
        ("sign", [a]) => a.sign(),
        _ => return None,
    })
}
