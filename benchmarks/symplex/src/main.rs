//! Optimises a model's operation count with symplex.
//!
//! Standard input has a line `NAME OPERATOR OPERAND…` for every operation, and a line `output
//! OPERAND` for every output. An operand is the name of an earlier line, a decimal number, or else
//! a symbol. Standard output has a line for every shared expression, with its name and its tree in
//! symplex's JSON, in order of dependency. A line `output` with a tree follows for every output.
//!
//! symplex flattens nested products and sums, and its `cse_many` shares whole nodes only: nothing
//! of `a*b*c` and `a*b*d`. A line that is used more than once therefore becomes a symbol, as a user
//! of symplex would write it, and `cse_many` runs over all of these. `factor_terms` takes common
//! factors out of each.

use std::collections::HashMap;
use std::error::Error;
use std::io::{BufWriter, Write};

use symplex::prelude::{Context, Ex, ExprType};

fn main() -> Result<(), Box<dyn Error>> {
    let text = std::io::read_to_string(std::io::stdin())?;
    let (names, values): (Vec<_>, Vec<_>) = read(&text)?.into_iter().unzip();
    let factored: Vec<Ex> = values.iter().map(factor).collect();
    let (shared, values) = Ex::cse_many(&factored.iter().collect::<Vec<_>>());
    let shared = shared
        .into_iter()
        .map(|(name, value)| (name.to_string(), value));
    let (outputs, named): (Vec<_>, Vec<_>) = names
        .into_iter()
        .zip(values)
        .partition(|(name, _)| name == OUTPUT);
    let mut waiting = named.into_iter().chain(shared).collect();
    let mut out = BufWriter::new(std::io::stdout().lock());
    for (name, value) in outputs {
        write(&mut out, &name, &value, &mut waiting)?;
    }
    Ok(out.flush()?)
}

/// Name of the output lines.
const OUTPUT: &str = "output";

/// Named expressions and outputs of a text, without those that no output needs.
fn read(text: &str) -> Result<Vec<(String, Ex)>, Box<dyn Error>> {
    let lines: Vec<Vec<&str>> = text
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    let uses = uses(&lines);
    let context = Context::new();
    let mut known: HashMap<&str, Ex> = HashMap::new();
    let mut found: Vec<(String, Ex)> = Vec::new();
    let mut names = HashMap::new();
    for line in &lines {
        let operand = |word: &&str| match known.get(word) {
            Some(value) => Ok(value.clone()),
            None if word.starts_with(|c: char| c == '-' || c.is_ascii_digit()) => {
                context.decimal_str(word)
            }
            None => Ok(context.symbol(word)),
        };
        match line.as_slice() {
            [OUTPUT, value] => found.push((OUTPUT.to_string(), operand(value)?)),
            [name, operator, operands @ ..] => {
                let operands = operands
                    .iter()
                    .map(operand)
                    .collect::<Result<Vec<_>, _>>()?;
                let mut value = apply(operator, &operands)
                    .ok_or_else(|| format!("`{}` is no operation", line.join(" ")))?;
                let is_simple = is_atom(&value) || is_atom(&-&value);
                if !is_simple && uses.get(name).is_some_and(|&times| times > 1) {
                    value = names
                        .entry(value.id())
                        .or_insert_with(|| {
                            found.push((name.to_string(), value));
                            context.symbol(name)
                        })
                        .clone();
                }
                known.insert(name, value);
            }
            _ => {
                return Err(
                    format!("`{}` is neither an operation nor an output", line.join(" ")).into(),
                );
            }
        }
    }
    Ok(found)
}

/// Whether an expression has no operation.
fn is_atom(expression: &Ex) -> bool {
    matches!(expression.expr_type(), ExprType::Symbol | ExprType::Number)
}

/// Number of uses of each operand by the outputs and their dependencies.
fn uses<'a>(lines: &[Vec<&'a str>]) -> HashMap<&'a str, usize> {
    let mut uses = HashMap::new();
    for line in lines.iter().rev() {
        let skipped = match line.first() {
            Some(&OUTPUT) => 1,
            Some(name) if uses.contains_key(name) => 2,
            _ => continue,
        };
        for operand in line.iter().skip(skipped) {
            *uses.entry(*operand).or_default() += 1;
        }
    }
    uses
}

/// Applies an operator to its operands.
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

/// Expression with the common factor of its terms taken out.
fn factor(expression: &Ex) -> Ex {
    let (content, primitive) = expression.factor_terms();
    content * primitive
}

/// Writes an expression's line after those of its unwritten dependencies.
fn write(
    out: &mut impl Write,
    name: &str,
    value: &Ex,
    waiting: &mut HashMap<String, Ex>,
) -> Result<(), Box<dyn Error>> {
    for symbol in value.free_symbols() {
        let symbol = symbol.to_string();
        if let Some(needed) = waiting.remove(&symbol) {
            write(out, &symbol, &needed, waiting)?;
        }
    }
    Ok(writeln!(out, "{name} {}", value.to_json()?)?)
}
