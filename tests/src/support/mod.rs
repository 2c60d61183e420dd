//! Shared test support: descriptions, models, samples, backends and expected values.

pub mod accuracy;
pub mod agreement;
pub mod all_functions;
pub mod backend;
pub mod comparison;
pub mod conversion;
pub mod dependent;
pub mod derivatives;
pub mod elements;
pub mod expected;
pub mod frames;
pub mod imports;
pub mod library;
pub mod motors;
pub mod precise;
pub mod random;
pub mod rank;
pub mod sample;
pub mod served;
pub mod tree;

pub use agreement::Agreement;
pub use backend::{Backend, Evaluated};
pub use comparison::Comparison;
pub use sample::{Parameters, Sample};
pub use served::Served;

use overact_codegen::{Effort, Request, RobotModel, Source, compile_with};
use overact_tier::by_tier;
use std::error::Error;
use std::path::PathBuf;
use std::{fs, sync::OnceLock};

/// Any error of a helper.
pub type Failure = Box<dyn Error + Send + Sync>;

/// Path of a file or folder of the repository, from its path relative to the root.
#[must_use]
pub fn repository(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(path)
}

/// A description in `robots/`, with the name used in the headers of `generated/`.
///
/// # Errors
///
/// If there is no such file.
pub fn description(stem: &str) -> Result<Source, Failure> {
    let name = format!("robots/{stem}.toml");
    let text = fs::read_to_string(repository(&name))?;
    Ok(Source::new(name, text))
}

/// The model of a description.
///
/// # Errors
///
/// The description's errors as text.
pub fn model_of(source: &Source) -> Result<RobotModel, Failure> {
    model_with(source, &Request::default())
}

/// Model of a description for a request.
///
/// # Errors
///
/// The description's errors as text.
pub fn model_with(source: &Source, request: &Request<'_>) -> Result<RobotModel, Failure> {
    match compile_with(source, request) {
        Ok(compiled) => Ok(compiled.model),
        Err(errors) => Err(errors.render_plain(source).into()),
    }
}

/// Model of the DualV, compiled once.
///
/// In the full tier all operations are searched, as in the checked-in module.
///
/// # Errors
///
/// The description's errors as text.
pub fn dualv() -> Result<&'static RobotModel, Failure> {
    static MODEL: OnceLock<Result<RobotModel, String>> = OnceLock::new();
    let compiled = MODEL.get_or_init(|| {
        let request = Request::with_effort(by_tier([Effort::None, Effort::Thorough]));
        description("dualv")
            .and_then(|source| model_with(&source, &request))
            .map_err(|error| error.to_string())
    });
    compiled.as_ref().map_err(|error| error.as_str().into())
}
