//! The option `--effort`.

use clap::builder::PossibleValuesParser;
use overact_codegen::{Effort, Request};

/// Effort of the search for fewer operations.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(crate) struct Arguments {
    /// Effort of the search for fewer operations [default: that of the description, else thorough]
    #[arg(long, value_parser = PossibleValuesParser::new(Effort::ALL.map(Effort::name)))]
    effort: Option<String>,
}

impl Arguments {
    /// Request for all functions with this effort, since generated code is kept.
    pub(crate) fn request(&self) -> Request<'static> {
        Request {
            effort: self.effort.as_deref().and_then(Effort::named),
            otherwise: Effort::Thorough,
            ..Request::default()
        }
    }
}
