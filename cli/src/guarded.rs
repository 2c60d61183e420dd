//! Converts panics of a command to internal errors with location.
//!
//! No partial output remains, because results are written at the end and all at once.

use crate::{commands::Command, failure::Failure};
use overact_codegen::diagnostic::InternalError;
use std::{
    panic::{self, AssertUnwindSafe, PanicHookInfo},
    sync::{Arc, Mutex},
};

/// Runs a command.
///
/// # Errors
/// As the command, or an internal error.
pub(crate) fn run(command: &Command, as_json: bool) -> Result<(), Failure> {
    guarded(command.name(), &command.descriptions(), || {
        command.run(as_json)
    })
}

/// Runs a function that may panic; the first panic of any thread is reported.
fn guarded(
    stage: &str,
    descriptions: &str,
    work: impl FnOnce() -> Result<(), Failure>,
) -> Result<(), Failure> {
    let first: Arc<Mutex<Option<String>>> = Arc::default();
    let seen = Arc::clone(&first);
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if let Ok(mut first) = seen.lock() {
            first.get_or_insert_with(|| described(info));
        }
    }));
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    panic::set_hook(usual);
    result.unwrap_or_else(|_| {
        let first = first.lock().ok().and_then(|mut first| first.take());
        let message = first.unwrap_or_else(|| "a panic without a message".to_owned());
        let error = InternalError::new(stage, message);
        Err(Failure::Internal(error.of_robot(descriptions)))
    })
}

/// Message and location of a panic.
fn described(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let message = text.unwrap_or("a panic without a message");
    match info.location() {
        Some(place) => format!("{message} ({}:{})", place.file(), place.line()),
        None => message.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::guarded;
    use crate::failure::{Failure, Problem};
    use overact_codegen::diagnostic::Code;

    #[test]
    fn panics_become_internal_errors_and_other_results_are_unchanged() {
        let empty: &[f64] = &[];
        let panics = || Err(Problem::new(Code::USAGE, format!("{}", empty[3])).into());
        let failure = guarded("identify", "dualv.toml", panics).expect_err("a panic");
        assert_eq!(failure.exit_code(), 4);
        let text = failure.render(false);
        for part in [
            "internal error of overact",
            "`identify`",
            "`dualv.toml`",
            "guarded.rs:",
            "index out of bounds",
            "please report it",
        ] {
            assert!(text.contains(part), "{part} in {text}");
        }
        // The first panic of several threads is reported.
        let threads = || {
            std::thread::scope(|scope| {
                let _ = scope.spawn(|| panic!("in a thread")).join();
                panic!("afterwards")
            })
        };
        let failure = guarded("check", "a.toml", threads).expect_err("a panic");
        assert!(failure.render(false).contains("in a thread"));
        assert!(guarded("check", "a.toml", || Ok(())).is_ok());
        let usage = guarded("check", "a.toml", || Err(Failure::Usage("no".into())));
        assert_eq!(usage.expect_err("a failure").exit_code(), 2);
    }
}
