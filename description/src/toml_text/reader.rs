//! Traversal of a TOML document that records errors and continues.
//!
//! A reader requests keys of a [`Table`] and types of an [`Item`]. Missing, wrong or unused keys
//! are reported with their location, and the result is `None`.

use crate::diagnostic::Spanned;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, Source, Span, did_you_mean, nearest};
use std::cell::RefCell;
use std::collections::BTreeSet;
use toml::de::{DeTable, DeValue};

/// The source text and the errors found so far.
pub(crate) struct Context<'t> {
    source: &'t Source,
    errors: RefCell<Diagnostics>,
    /// Warnings about text that is probably not intended.
    warnings: RefCell<Vec<Spanned<String>>>,
    /// Magnitudes of the numbers that are not named constants, as bits, in SI units.
    magnitudes: RefCell<BTreeSet<u64>>,
    /// Location of the first table whose name is misspelt.
    misspelt_table: RefCell<Option<Span>>,
}

impl<'t> Context<'t> {
    pub(crate) fn new(source: &'t Source) -> Self {
        Self {
            source,
            errors: RefCell::default(),
            warnings: RefCell::default(),
            magnitudes: RefCell::default(),
            misspelt_table: RefCell::default(),
        }
    }

    /// Records a number of the text.
    pub(crate) fn record(&self, number: f64) {
        self.magnitudes.borrow_mut().insert(number.abs().to_bits());
    }

    /// Removes and returns the magnitudes of all recorded numbers, sorted.
    pub(crate) fn take_magnitudes(&self) -> Vec<f64> {
        let bits = self.magnitudes.take();
        bits.into_iter().map(f64::from_bits).collect()
    }

    pub(crate) fn report(&self, diagnostic: Diagnostic) {
        self.errors.borrow_mut().push(diagnostic);
    }

    /// Reports an error unless there is one at its location.
    ///
    /// A leg's expression is evaluated for every placement, and one message is enough.
    pub(crate) fn report_once(&self, diagnostic: Diagnostic) {
        let known = diagnostic
            .span
            .as_ref()
            .is_some_and(|s| self.errors.borrow().has_error_at(s));
        if !known {
            self.report(diagnostic);
        }
    }

    /// Records a warning, once per location.
    pub(crate) fn warn(&self, what: String, span: &Span) {
        let mut warnings = self.warnings.borrow_mut();
        if !warnings.iter().any(|known| known.span == *span) {
            warnings.push(Spanned::new(what, span.clone()));
        }
    }

    /// The warnings, in order of the text.
    pub(crate) fn warnings(&self) -> Vec<Spanned<String>> {
        let mut warnings = self.warnings.borrow().clone();
        warnings.sort_by_key(|warning| warning.span.start);
        warnings
    }

    /// Whether there is no error.
    pub(crate) fn is_clean(&self) -> bool {
        self.errors.borrow().is_empty()
    }

    pub(crate) fn text(&self, span: &Span) -> &'t str {
        self.source.text.get(span.clone()).unwrap_or("")
    }

    /// The errors; those that may follow from a misspelt table are counted, not listed.
    pub(crate) fn into_errors(self) -> Diagnostics {
        let mut errors = self.errors.into_inner();
        if let Some(table) = self.misspelt_table.into_inner() {
            let follows = [
                Code::FORMULA,
                Code::WRONG_COUNT,
                Code::UNKNOWN_NAME,
                Code::STRUCTURE,
            ];
            errors.fold(&table, &follows);
        }
        errors
    }
}

/// A table whose keys are being read.
pub(crate) struct Table<'c, 't> {
    pub(crate) context: &'c Context<'t>,
    entries: &'c DeTable<'t>,
    /// Location of errors that are not at a key.
    pub(crate) span: Span,
    /// Name of the table in messages, such as "the table `[platform]`".
    what: String,
    known: RefCell<Vec<String>>,
    /// Misspelt keys that were reported in place of a required key.
    misspelt: RefCell<Vec<String>>,
}

/// A value that is being read.
#[derive(Clone)]
pub(crate) struct Item<'c, 't> {
    pub(crate) context: &'c Context<'t>,
    pub(crate) value: &'c DeValue<'t>,
    pub(crate) span: Span,
    /// Name and location of its key.
    pub(crate) key: Spanned<String>,
}

impl<'c, 't> Table<'c, 't> {
    pub(crate) fn new(
        context: &'c Context<'t>,
        entries: &'c DeTable<'t>,
        span: Span,
        what: impl Into<String>,
    ) -> Self {
        Self {
            context,
            entries,
            span,
            what: what.into(),
            known: RefCell::default(),
            misspelt: RefCell::default(),
        }
    }

    /// The value of an optional key.
    pub(crate) fn get(&self, key: &str) -> Option<Item<'c, 't>> {
        if !self.known.borrow().iter().any(|known| known == key) {
            self.known.borrow_mut().push(key.to_owned());
        }
        let (name, value) = self.entries.get_key_value(key)?;
        let key = Spanned::new(key.to_owned(), name.span());
        Some(Item {
            context: self.context,
            value: value.get_ref(),
            span: value.span(),
            key,
        })
    }

    /// The value of a required key.
    ///
    /// If another key looks like it, only that one is reported.
    pub(crate) fn require(&self, key: &str, help: &str) -> Option<Item<'c, 't>> {
        let item = self.get(key);
        if item.is_some() {
            return item;
        }
        let mut unread = self.unread().into_iter();
        if let Some(other) = unread.find(|other| nearest(&other.key.value, [key]).is_some()) {
            self.report_unknown(&other, did_you_mean(&other.key.value, [key]));
            self.misspelt.borrow_mut().push(other.key.value);
        } else {
            let message = format!("{} has no `{key}`", self.what);
            self.context
                .report(Diagnostic::new(Code::MISSING_KEY, message, self.span.clone()).help(help));
        }
        item
    }

    /// All keys with their values, in order of the text; all count as known.
    pub(crate) fn items(&self) -> Vec<Item<'c, 't>> {
        let item = |(key, value): (&'c toml::Spanned<_>, &'c toml::Spanned<DeValue<'t>>)| {
            let name: &std::borrow::Cow<'_, str> = key.get_ref();
            Item {
                context: self.context,
                value: value.get_ref(),
                span: value.span(),
                key: Spanned::new(name.to_string(), key.span()),
            }
        };
        let mut items: Vec<_> = self.entries.iter().map(item).collect();
        items.sort_by_key(|item| item.key.span.start);
        self.known
            .borrow_mut()
            .extend(items.iter().map(|item| item.key.value.clone()));
        items
    }

    /// Keys that were not requested, in order of the text.
    pub(crate) fn unread(&self) -> Vec<Item<'c, 't>> {
        let known = self.known.borrow().clone();
        let mut items = self.items();
        items.retain(|item| !known.contains(&item.key.value));
        *self.known.borrow_mut() = known;
        items
    }

    /// Reports all keys that were not requested.
    pub(crate) fn finish(&self) {
        for item in self.unread() {
            let known = self.known.borrow();
            let suggestion = did_you_mean(&item.key.value, known.iter().map(String::as_str));
            if !self.misspelt.borrow().contains(&item.key.value) {
                self.report_unknown(&item, suggestion);
            }
        }
    }

    /// Reports an unknown key with a suggestion, or else with all keys requested so far.
    fn report_unknown(&self, item: &Item<'c, 't>, suggestion: Option<String>) {
        if suggestion.is_some() && item.is_table_or_tables() {
            let mut table = self.context.misspelt_table.borrow_mut();
            table.get_or_insert_with(|| item.key.span.clone());
        }
        let help =
            suggestion.unwrap_or_else(|| format!("known keys: {}", self.known.borrow().join(", ")));
        let message = format!("unknown key `{}`", item.key.value);
        let diagnostic = Diagnostic::new(Code::UNKNOWN_KEY, message, item.key.span.clone());
        self.context.report(
            diagnostic
                .label(format!("not a key of {}", self.what))
                .help(help),
        );
    }
}

/// Name of a type: "a string" and so on.
fn type_name(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "an integer",
        DeValue::Float(_) => "a float",
        DeValue::Boolean(_) => "a boolean",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

impl<'c, 't> Item<'c, 't> {
    pub(crate) fn error(&self, code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(code, message, self.span.clone())
    }

    /// Reports a wrong type.
    pub(crate) fn mismatch<T>(&self, expected: &str) -> Option<T> {
        self.mismatch_with(expected, None)
    }

    /// Reports a value of another type than expected, with a remedy.
    fn mismatch_with<T>(&self, expected: &str, help: Option<String>) -> Option<T> {
        let found = type_name(self.value);
        let message = format!("`{}`: expected {expected}, found {found}", self.key.value);
        let error = self
            .error(Code::WRONG_TYPE, message)
            .label(format!("this is {found}"));
        self.context.report_once(match help {
            Some(help) => error.help(help),
            None => error,
        });
        None
    }

    pub(crate) fn string(&self) -> Option<Spanned<String>> {
        match self.value {
            DeValue::String(text) => Some(Spanned::new(text.to_string(), self.span.clone())),
            _ => self.mismatch("a string"),
        }
    }

    pub(crate) fn boolean(&self) -> Option<bool> {
        self.value
            .as_bool()
            .or_else(|| self.mismatch("true or false"))
    }

    /// An integer of at least `minimum`.
    pub(crate) fn integer(&self, minimum: u64) -> Option<u64> {
        let DeValue::Integer(text) = self.value else {
            return self.mismatch("an integer");
        };
        let value = u64::from_str_radix(text.as_str().trim_start_matches('+'), text.radix()).ok();
        let value = value.filter(|v| *v >= minimum && i64::try_from(*v).is_ok());
        if value.is_none() {
            let found = self.context.text(&self.span);
            let message = format!(
                "`{}`: expected an integer of at least {minimum}, found {found}",
                self.key.value
            );
            self.context.report(self.error(Code::OUT_OF_RANGE, message));
        }
        value
    }

    /// [`Self::integer`] as a size.
    pub(crate) fn size(&self, minimum: u64) -> Option<usize> {
        let value = usize::try_from(self.integer(minimum)?);
        value.ok()
    }

    /// One of a few keywords.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Option<Spanned<T>> {
        let text = self.string()?;
        let found = choices.iter().find(|(name, _)| *name == text.value);
        if found.is_none() {
            let names = || choices.iter().map(|(name, _)| *name);
            let quoted: Vec<String> = names().map(|name| format!("\"{name}\"")).collect();
            let expected = match quoted.as_slice() {
                [first, second] => format!("{first} or {second}"),
                _ => format!("one of {}", quoted.join(", ")),
            };
            let (key, found) = (&self.key.value, &text.value);
            let message = format!("`{key}`: expected {expected}, found \"{found}\"");
            let help = did_you_mean(&text.value, names());
            self.context
                .report(self.error(Code::UNKNOWN_WORD, message).maybe_help(help));
        }
        found.map(|(_, value)| Spanned::new(*value, text.span))
    }

    /// The elements of a list.
    pub(crate) fn list(&self) -> Option<Vec<Self>> {
        let DeValue::Array(array) = self.value else {
            return self.mismatch("a list");
        };
        let element = |value: &'c toml::Spanned<DeValue<'t>>| Item {
            context: self.context,
            value: value.get_ref(),
            span: value.span(),
            key: self.key.clone(),
        };
        Some(array.iter().map(element).collect())
    }

    /// The elements of a list of three.
    pub(crate) fn triple(&self) -> Option<[Self; 3]> {
        let list = self.list()?;
        let found = list.len();
        let triple = <[Self; 3]>::try_from(list).ok();
        if triple.is_none() {
            let message = format!(
                "`{}`: expected a list of 3 values, found {found}",
                self.key.value
            );
            self.context
                .report_once(self.error(Code::WRONG_COUNT, message));
        }
        triple
    }

    pub(crate) fn strings(&self) -> Option<Vec<Spanned<String>>> {
        // All elements are read, so that each error is reported.
        let strings: Vec<_> = self.list()?.iter().map(Self::string).collect();
        strings.into_iter().collect()
    }

    pub(crate) fn is_table(&self) -> bool {
        self.value.is_table()
    }

    /// Whether the value is a table, or a list of tables.
    fn is_table_or_tables(&self) -> bool {
        match self.value {
            DeValue::Table(_) => true,
            DeValue::Array(list) => {
                let mut all = list.iter().map(|one| one.get_ref());
                !list.is_empty() && all.all(|one| matches!(one, DeValue::Table(_)))
            }
            _ => false,
        }
    }

    /// The value as a table; `what` is its name in messages.
    pub(crate) fn table(&self, what: impl Into<String>) -> Option<Table<'c, 't>> {
        let DeValue::Table(entries) = self.value else {
            let is_head = self.is_table_or_tables();
            let key = &self.key.value;
            let help = is_head.then(|| format!("write single brackets, [{key}] or [{key}.NAME]"));
            return self.mismatch_with("a table", help);
        };
        Some(Table::new(self.context, entries, self.span.clone(), what))
    }

    /// The elements of an array of tables.
    pub(crate) fn tables(&self, what: &str) -> Vec<Table<'c, 't>> {
        if matches!(self.value, DeValue::Table(_)) {
            let help = format!("write double brackets, [[{}]]", self.key.value);
            self.mismatch_with::<()>("a list of tables", Some(help));
            return Vec::new();
        }
        let Some(list) = self.list() else {
            return Vec::new();
        };
        list.iter().filter_map(|item| item.table(what)).collect()
    }
}
