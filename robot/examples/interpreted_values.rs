//! Evaluates interpreted robots for `tests/languages/compare.py`.
//!
//! `cargo run -p overact-robot --example interpreted_values -- ROBOTS < questions`. A question is a
//! line `STEM FUNCTION SAMPLES INPUTS` and a line of numbers for each input, sample by sample, as
//! for `tests/compiled/examples/values.rs`. The answer is a line of numbers, or one that begins
//! with `error`.

use overact_codegen::{Effort, Request};
use overact_robot::{CompiledFile, InterpretedRobot, values};
use std::{
    error::Error,
    io::{self, BufRead, Write},
    path::PathBuf,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.ok_or("the folder of the descriptions is missing")?;
    let mut lines = io::stdin().lock().lines();
    let mut out = io::stdout().lock();
    let mut last: Option<(String, InterpretedRobot)> = None;
    while let Some(question) = lines.next().transpose()? {
        let words: Vec<&str> = question.split_whitespace().collect();
        let &[stem, function, samples, count] = words.as_slice() else {
            return Err(format!("no question: {question}").into());
        };
        let mut inputs: Vec<f64> = Vec::new();
        for line in lines.by_ref().take(count.parse()?) {
            for word in line?.split_whitespace() {
                inputs.push(word.parse()?);
            }
        }
        if last.as_ref().is_none_or(|(known, _)| known != stem) {
            let file = folder.join(format!("{stem}.toml"));
            let compiled = CompiledFile::read(&file, &Request::with_effort(Effort::None))?;
            last = Some((stem.to_owned(), InterpretedRobot::new(compiled.model)));
        }
        let Some((_, robot)) = &last else { continue };
        match values(robot, function, samples.parse()?, &inputs) {
            Ok(values) => {
                let words: Vec<String> = values.iter().map(|one| format!("{one:?}")).collect();
                writeln!(out, "{}", words.join(" "))?;
            }
            Err(problem) => writeln!(out, "error: {}", problem.message)?,
        }
    }
    Ok(())
}
