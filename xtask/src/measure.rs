//! Measures the generated code of a description: operations of every function, size of the module.

use crate::Failure;
use crate::files::read;
use overact_codegen::{Effort, Request, Source, backends::rust, compile_with};
use serde_json::json;

/// Prints a JSON document on a description.
pub(crate) fn print(effort: &str, file: &str) -> Result<(), Failure> {
    let effort = Effort::named(effort).ok_or("an effort is none, quick or thorough")?;
    let source = Source::new(file, read(file)?);
    let compiled = compile_with(&source, &Request::with_effort(effort));
    let model = compiled
        .map_err(|errors| errors.render_plain(&source))?
        .model;
    let functions = model.functions.iter().map(|function| {
        let cost = model.cost(function);
        let pieces = function.program.pieces;
        let summary =
            json!({ "operations": cost.once.operations(), "cost": cost, "pieces": pieces });
        (function.name.clone(), summary)
    });
    let functions: serde_json::Map<String, serde_json::Value> = functions.collect();
    let code = rust::file(&model, file);
    let document = json!({
        "joints": model.mechanism.joints().len(),
        "dof": model.mechanism.dof(),
        "parameters": model.selection.standard.len(),
        "base_parameters": model.base.len(),
        "functions": functions,
        "bytes": code.len(),
    });
    println!("{document}");
    Ok(())
}
