//! The option `--functions`.

use crate::failure::{Failure, Problem};
use overact_codegen::Choice;
use overact_codegen::diagnostic::Code;

/// Which functions are written.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(crate) struct Arguments {
    /// Only these functions and what they call: names as `inspect` lists them, or the groups `control`,
    /// `identification` and `kinematics`
    #[arg(long, value_name = "NAME,NAME", value_delimiter = ',')]
    functions: Vec<String>,
}

impl Arguments {
    /// The choice, where there is one.
    ///
    /// # Errors
    /// Every name that no robot's function has.
    pub(crate) fn choice(&self) -> Result<Option<Choice>, Failure> {
        if self.functions.is_empty() {
            return Ok(None);
        }
        match Choice::new(self.functions.iter().map(String::as_str)) {
            Ok(choice) => Ok(Some(choice)),
            Err(unknown) => {
                let unknown = unknown.into_iter();
                let problems = unknown.map(|one| {
                    Problem::new(Code::NO_SUCH_FUNCTION, one.to_string()).help(one.help)
                });
                Err(problems.collect::<Vec<_>>().into())
            }
        }
    }

    /// The option as it stands on the command line.
    pub(crate) fn words(&self) -> String {
        match self.functions.is_empty() {
            true => String::new(),
            false => format!(" --functions {}", self.functions.join(",")),
        }
    }
}
