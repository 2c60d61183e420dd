//! Evaluates compiled robots for the tests of the Python package.
//!
//! `cargo run -p overact-compiled --example values < questions`. A question is a line `STEM
//! FUNCTION SAMPLES INPUTS` and a line of numbers for each input, sample by sample. FUNCTION is the
//! name in the table of functions, with `_base` for base parameters. The answer is a line of
//! numbers, or one that begins with `error`.

use overact::Function;
use std::io::{self, BufRead, Write};

fn main() -> io::Result<()> {
    let mut lines = io::stdin().lock().lines();
    let mut out = io::stdout().lock();
    while let Some(question) = lines.next().transpose()? {
        let words: Vec<&str> = question.split_whitespace().collect();
        let &[stem, function, samples, count] = words.as_slice() else {
            return Err(io::Error::other(format!("no question: {question}")));
        };
        let count: usize = count.parse().map_err(io::Error::other)?;
        let inputs = lines.by_ref().take(count);
        let inputs: Vec<String> = inputs.collect::<io::Result<_>>()?;
        match answer(stem, function, samples, &inputs) {
            Ok(values) => {
                let words: Vec<String> = values.iter().map(|one| format!("{one:?}")).collect();
                writeln!(out, "{}", words.join(" "))?;
            }
            Err(error) => writeln!(out, "error: {error}")?,
        }
    }
    Ok(())
}

fn answer(
    stem: &str,
    function: &str,
    samples: &str,
    inputs: &[String],
) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let robot = overact_compiled::by_stem(stem).ok_or("no such robot")?;
    let name = |one: &Function| {
        if one.is_of_base_parameters() {
            format!("{}_base", one.name())
        } else {
            one.name().to_owned()
        }
    };
    let found = Function::ALL.into_iter().find(|one| name(one) == function);
    let found = found.ok_or("no such function")?;
    let numbers = |line: &String| -> Result<Vec<f64>, std::num::ParseFloatError> {
        line.split_whitespace().map(str::parse).collect()
    };
    let rows: Vec<Vec<f64>> = inputs.iter().map(numbers).collect::<Result<_, _>>()?;
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    let (height, width) = found.shape(&robot.info().sizes);
    let mut output = vec![0.0; samples.parse::<usize>()? * height * width];
    robot.evaluate(found, &rows, &mut output)?;
    Ok(output)
}
