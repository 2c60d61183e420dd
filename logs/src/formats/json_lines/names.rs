//! Columns of JSON objects: paths to values that are neither objects nor lists.

use std::{collections::HashSet, fmt, fmt::Write};

use overact::Code;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::{
    parse::parse,
    records::{Fault, Record},
};
use crate::error::{Error, Problem};

/// Largest depth of objects and lists.
pub(super) const LARGEST_DEPTH: usize = 16;

/// Largest number of columns.
const MOST_COLUMNS: usize = 20_000;

/// A step from an object or list to its content.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Step {
    Key(String),
    /// Place in a list, counted from 0.
    Item(usize),
}

/// A column: its name, and the steps to its value in each object.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) path: Vec<Step>,
}

/// Columns of the objects seen so far, in order.
#[derive(Debug, Default)]
pub(super) struct Names {
    paths: Vec<Vec<Step>>,
    seen: HashSet<Vec<Step>>,
    /// Whether objects and lists are nested too deeply, with the line.
    too_deep: Option<usize>,
}

impl Names {
    /// Adds the columns of an object.
    ///
    /// # Errors
    /// Text that is not JSON.
    pub(super) fn add(&mut self, record: &Record<'_>) -> Result<(), Fault> {
        let mut found = Vec::new();
        let mut is_too_deep = false;
        parse(record, &mut |input| {
            found.clear();
            let leaves = Leaves {
                path: Vec::new(),
                found: &mut found,
                is_too_deep: &mut is_too_deep,
            };
            leaves.deserialize(input)
        })?;
        if is_too_deep {
            self.too_deep = self.too_deep.or(Some(record.line));
        }
        for path in found {
            if self.seen.insert(path.clone()) {
                self.paths.push(path);
            }
        }
        Ok(())
    }

    /// Whether there are too many columns.
    pub(super) fn is_full(&self) -> bool {
        self.paths.len() > MOST_COLUMNS
    }

    /// The columns.
    ///
    /// # Errors
    /// Too many of them, or too deeply nested ones.
    pub(super) fn columns(self, file: &str) -> Result<Vec<Column>, Error> {
        let refused = |what: String| Problem::new(Code::LOG_FORMAT, what).file(file);
        let help = "write an object with the numbers of one sample per line";
        if let Some(line) = self.too_deep {
            let what = format!("objects and lists are nested more than {LARGEST_DEPTH} deep");
            return Err(refused(what).line(line).help(help).into());
        }
        if self.is_full() {
            let what = format!("an object has more than {MOST_COLUMNS} values");
            return Err(refused(what).help(help).into());
        }
        let column = |path: Vec<Step>| Column {
            name: name(&path),
            path,
        };
        Ok(self.paths.into_iter().map(column).collect())
    }
}

/// Name of a column: `a.b` or `position[0]`.
fn name(path: &[Step]) -> String {
    let mut name = String::new();
    for step in path {
        match step {
            Step::Key(key) if name.is_empty() => name.push_str(key),
            Step::Key(key) => {
                name.push('.');
                name.push_str(key);
            }
            Step::Item(place) => {
                let _ = write!(name, "[{place}]");
            }
        }
    }
    name
}

/// Collects the paths of all values.
struct Leaves<'f> {
    path: Vec<Step>,
    found: &'f mut Vec<Vec<Step>>,
    is_too_deep: &'f mut bool,
}

impl Leaves<'_> {
    fn inner(&mut self, step: Step) -> Leaves<'_> {
        let path = [&self.path[..], &[step]].concat();
        Leaves {
            path,
            found: self.found,
            is_too_deep: self.is_too_deep,
        }
    }

    fn leaf(self) {
        if self.found.len() <= MOST_COLUMNS {
            self.found.push(self.path);
        }
    }
}

impl<'de> DeserializeSeed<'de> for Leaves<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, input: D) -> Result<(), D::Error> {
        if self.path.len() > LARGEST_DEPTH {
            *self.is_too_deep = true;
            return input.deserialize_ignored_any(IgnoredAny).map(|_| ());
        }
        input.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Leaves<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        self.leaf();
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key()? {
            map.next_value_seed(self.inner(Step::Key(key)))?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> Result<(), A::Error> {
        let mut place = 0;
        while list
            .next_element_seed(self.inner(Step::Item(place)))?
            .is_some()
        {
            place += 1;
        }
        Ok(())
    }
}
