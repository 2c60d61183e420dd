//! `overact explain`: explains errors by their codes.

use crate::{
    failure::Failure,
    output::{json, print},
};
use overact_codegen::diagnostic::{Code, Explanation};
use overact_report::layout::definitions;
use serde_json::{Value, json as document};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Error codes, such as OA102; without any, all codes are listed
    #[arg(value_name = "CODE")]
    codes: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// Unknown codes.
pub(super) fn run(arguments: &Arguments, as_json: bool) -> Result<(), Failure> {
    let explanation = |text: &String| match Code::named(text) {
        Some(code) => Ok(code.explanation()),
        None => Err(format!("`{text}` is not an error code")),
    };
    let mut wanted = Vec::new();
    let mut unknown = Vec::new();
    for text in &arguments.codes {
        match explanation(text) {
            Ok(one) => wanted.push(one),
            Err(message) => unknown.push(message),
        }
    }
    if !unknown.is_empty() {
        let help = "`overact explain` without a code lists all of them";
        return Err(Failure::Usage(format!("{}; {help}", unknown.join(", "))));
    }
    if arguments.codes.is_empty() {
        wanted = Code::all().collect();
    }
    if as_json {
        let all: Vec<Value> = wanted.iter().map(|one| as_document(one)).collect();
        return print(&json(&document!({ "codes": all }))?);
    }
    if arguments.codes.is_empty() {
        let row = |one: &&Explanation| (one.code.to_string(), one.title.to_owned());
        let rows: Vec<(String, String)> = wanted.iter().map(row).collect();
        return print(&definitions(&rows, "  "));
    }
    let texts: Vec<String> = wanted.iter().map(|one| as_text(one)).collect();
    print(&texts.join("\n"))
}

fn as_document(one: &Explanation) -> Value {
    document!({
        "code": one.code.to_string(),
        "title": one.title,
        "cause": one.cause,
        "remedy": one.cure,
    })
}

fn as_text(one: &Explanation) -> String {
    let paragraph = |heading: &str, text: &str| {
        let indented: Vec<String> = wrapped(text).iter().map(|l| format!("  {l}\n")).collect();
        format!("{heading}\n{}", indented.concat())
    };
    format!(
        "{}: {}\n\n{}\n{}",
        one.code,
        one.title,
        paragraph("Cause", one.cause),
        paragraph("Remedy", one.cure)
    )
}

/// Wraps a text for a terminal.
fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 90;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= WIDTH => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
