//! The option `--effort`.

use clap::builder::PossibleValuesParser;
use overact_codegen::Effort;

/// How hard fewer operations are searched.
#[derive(Debug, clap::Args)]
#[group(skip)]
pub(crate) struct Arguments {
    /// How hard fewer operations are searched [default: that of the description, else thorough]
    #[arg(long, value_parser = PossibleValuesParser::new(Effort::ALL.map(Effort::name)))]
    effort: Option<String>,
}

impl Arguments {
    /// The effort asked for; what is generated to be kept is worth a search.
    pub(crate) fn effort(&self, described: Option<Effort>) -> Effort {
        let asked = self.effort.as_deref().and_then(Effort::named);
        asked.or(described).unwrap_or(Effort::Thorough)
    }
}
