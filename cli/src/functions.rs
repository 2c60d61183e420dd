//! Options `--functions`, `--from` and `--columns`, which select the generated functions.

use crate::failure::{Failure, Problem};
use crate::function_options::{ColumnsOf, Source};
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
    /// Only functions that are evaluated from these, and what they call
    #[arg(long, value_enum, value_delimiter = ',', value_name = "FROM,FROM")]
    from: Vec<Source>,
    /// Only models with these columns, and dynamics that take the values of these parameters
    #[arg(long, value_enum)]
    columns: Option<ColumnsOf>,
}

impl Arguments {
    /// Selection, if there is one.
    ///
    /// # Errors
    /// All unknown function names.
    pub(crate) fn choice(&self) -> Result<Option<Choice>, Failure> {
        let mut choice = if self.functions.is_empty() {
            Choice::all()
        } else {
            self.named()?
        };
        if !self.from.is_empty() {
            choice = choice.evaluated_from(self.from.iter().map(|source| source.from()));
        }
        if let Some(columns) = self.columns {
            choice = choice.with_columns(columns.columns());
        }
        Ok((choice != Choice::all()).then_some(choice))
    }

    fn named(&self) -> Result<Choice, Failure> {
        Choice::new(self.functions.iter().map(String::as_str)).map_err(|unknown| {
            let unknown = unknown.into_iter();
            let problems = unknown
                .map(|one| Problem::new(Code::NO_SUCH_FUNCTION, one.to_string()).help(one.help));
            problems.collect::<Vec<_>>().into()
        })
    }

    /// Options as on the command line.
    pub(crate) fn words(&self) -> String {
        let from: Vec<&str> = self
            .from
            .iter()
            .map(|source| source.from().name())
            .collect();
        let columns = self.columns.map(|columns| columns.columns().name());
        let options = [
            ("functions", self.functions.join(",")),
            ("from", from.join(",")),
            ("columns", columns.unwrap_or_default().to_owned()),
        ];
        let given = options.iter().filter(|(_, value)| !value.is_empty());
        given
            .map(|(name, value)| format!(" --{name} {value}"))
            .collect()
    }
}
