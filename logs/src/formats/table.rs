//! A file of any format as a table of columns.

use overact::Code;
use std::{ops::Deref, sync::Arc};

use crate::{error::Problem, formats::table_file::TableFile};

/// An open file, or one of its parts; clones share it.
#[derive(Debug, Clone)]
pub(crate) struct Table(Arc<dyn TableFile>);

impl Table {
    pub(crate) fn new(file: impl TableFile + 'static) -> Self {
        Self(Arc::new(file))
    }

    /// Sets the origin of instants, unless the table is shared.
    pub(crate) fn set_origin(&mut self, origin: i64) {
        if let Some(file) = Arc::get_mut(&mut self.0) {
            file.set_origin(origin);
        }
    }

    /// The problem of a file without content.
    pub(crate) fn without_content(&self) -> Option<Problem> {
        let problem = Problem::new(Code::LOG_TOO_SHORT, "the file is empty").file(self.file());
        let help = "give a log with the samples of a whole motion";
        self.is_empty().then(|| problem.help(help))
    }
}

impl Deref for Table {
    type Target = dyn TableFile;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        let key = |table: &Self| (table.label(), table.what(), table.origin());
        Arc::ptr_eq(&self.0, &other.0) || key(self) == key(other)
    }
}
