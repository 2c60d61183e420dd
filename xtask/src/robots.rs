//! Generates the modules of the descriptions in `robots/`.

use crate::Failure;
use crate::files::{read, stems};
use crate::hash::hash;
use overact_codegen::{Effort, Request, Source, TotalCost, backends::rust, compile_with};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Robots that `generated/` keeps as text for reading and comparison.
pub(crate) const TEXT: [&str; 5] = ["dualv", "emps", "five_bar", "rx90", "three_leg_point"];

/// Module of a robot with the cost of its functions.
pub(crate) struct Module {
    /// Stem of the description's file name, and name of the module.
    pub(crate) stem: String,
    /// Hash of the description.
    pub(crate) description: u64,
    /// Source text.
    pub(crate) text: String,
    /// Name and cost of each function.
    pub(crate) functions: Vec<(String, TotalCost)>,
}

/// Modules of all robots in the order of their names, generated on all processors.
pub(crate) fn all() -> Result<Vec<Module>, Failure> {
    several(&stems("robots", "toml")?)
}

/// Modules of some robots in the given order; threads take robots from a queue.
pub(crate) fn several(stems: &[String]) -> Result<Vec<Module>, Failure> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let work = || {
        while let Some(stem) = stems.get(next.fetch_add(1, Ordering::Relaxed)) {
            let module = module(stem).map_err(|failure| failure.to_string());
            done.lock()
                .unwrap_or_else(|e| e.into_inner())
                .push((stem, module));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(work);
        }
    });
    let mut done = done.into_inner().unwrap_or_else(|e| e.into_inner());
    done.sort_by_key(|(stem, _)| stems.iter().position(|s| s == *stem));
    done.into_iter().map(|(_, module)| Ok(module?)).collect()
}

/// Module of a robot, with thorough optimisation unless its description says otherwise.
fn module(stem: &str) -> Result<Module, Failure> {
    let name = format!("robots/{stem}.toml");
    let text = read(&name)?;
    let description = hash(&text);
    let source = Source::new(name.as_str(), text);
    let request = Request {
        otherwise: Effort::Thorough,
        ..Request::default()
    };
    let compiled =
        compile_with(&source, &request).map_err(|errors| errors.render_plain(&source))?;
    let model = compiled.model;
    let functions = model.functions.iter();
    let functions = functions.map(|function| (function.name.clone(), model.cost(function)));
    Ok(Module {
        stem: stem.to_owned(),
        description,
        functions: functions.collect(),
        text: rust::file(&model, &name),
    })
}
