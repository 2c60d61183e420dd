//! Problems of files that cannot be used.

use overact::Code;
use std::path::Path;

use crate::error::{Problem, suggestion};

/// Largest number of cells reported individually.
pub(crate) const LARGEST_NUMBER_OF_PROBLEMS: usize = 20;

/// Problems of a file's lines; equal ones are reported once with their number.
#[derive(Default)]
pub(crate) struct Collected {
    /// Each problem with the number of later lines that have it, too.
    all: Vec<(Problem, usize)>,
}

impl Collected {
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Number of different problems.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    pub(crate) fn extend(&mut self, problems: impl IntoIterator<Item = Problem>) {
        for problem in problems {
            let is_same = |one: &Problem| {
                let place = |own: &Problem| (own.file.clone(), own.column.clone());
                one.code == problem.code
                    && one.message == problem.message
                    && place(one) == place(&problem)
                    && problem.line.is_some()
            };
            match self.all.iter_mut().find(|(one, _)| is_same(one)) {
                Some((_, more)) => *more += 1,
                None => self.all.push((problem, 0)),
            }
        }
    }

    /// The merged problems.
    pub(crate) fn told(self) -> Vec<Problem> {
        let told = |(mut problem, more): (Problem, usize)| {
            match more {
                0 => {}
                1 => problem.message += ", here and in one line further down",
                _ => problem.message += &format!(", here and in {more} lines further down"),
            }
            problem
        };
        self.all.into_iter().map(told).collect()
    }
}

/// Largest number of listed names.
const LARGEST_NUMBER_OF_NAMES: usize = 40;

/// Largest number of displayed characters of a cell or a name.
const LONGEST_SHOWN: usize = 40;

/// Largest number of displayed characters of a library's message.
const LONGEST_REASON: usize = 200;

/// Text from a file for a terminal: short, and without control characters.
pub(crate) fn shown(piece: &str) -> String {
    let mut text: String = piece
        .chars()
        .take(LONGEST_SHOWN)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if piece.chars().nth(LONGEST_SHOWN).is_some() {
        text.push('…');
    }
    text
}

/// A library's message for a terminal.
pub(crate) fn legible(why: &str) -> String {
    let letters = why.chars().take(LONGEST_REASON);
    letters
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect()
}

/// Name of a file in messages, as the caller gave it.
pub(crate) fn display_name(path: &Path) -> String {
    path.display().to_string()
}

/// The problem of a file that cannot be opened or read.
pub(crate) fn unreadable(file: &str, error: &std::io::Error) -> Problem {
    let problem = Problem::new(
        Code::UNREADABLE_LOG,
        format!("the file can't be read: {error}"),
    )
    .file(file);
    if error.kind() == std::io::ErrorKind::NotFound {
        problem.help(not_found(file))
    } else {
        problem
    }
}

/// Help for a missing file, whose name may be a list of files.
fn not_found(file: &str) -> String {
    if file == "-" {
        return String::from("standard input can't be joined with files: write it to a file first");
    }
    let bracketed = file.strip_suffix(']').and_then(|own| own.rsplit_once('['));
    if bracketed.is_some_and(|(own, _)| Path::new(own).exists()) {
        return String::from(
            "a range of time, in s, follows the last file of a run: `log.csv[10:60]`, `a.csv+b.csv[10:60]`",
        );
    }
    let pieces: Vec<&str> = file.split(['+', ',', ';', ' ']).map(str::trim).collect();
    let pieces: Vec<&str> = pieces
        .into_iter()
        .filter(|piece| !piece.is_empty())
        .collect();
    if pieces.len() > 1 && pieces.iter().all(|piece| Path::new(piece).exists()) {
        return format!(
            "files of one run are joined by `+` without blanks: `{}`; of several runs give each file with its own --data",
            pieces.join("+")
        );
    }
    String::from("check the path, which is relative to the folder in which the program was started")
}

/// A list of quoted names.
pub(crate) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let all: Vec<String> = names
        .into_iter()
        .map(|name| format!("`{}`", shown(name)))
        .collect();
    match all.len().checked_sub(LARGEST_NUMBER_OF_NAMES) {
        Some(more) if more > 0 => format!(
            "{} and {more} more",
            all[..LARGEST_NUMBER_OF_NAMES].join(", ")
        ),
        _ => all.join(", "),
    }
}

/// Index of the column `name` among `names`, if it exists.
///
/// # Errors
/// Two columns of this name.
pub(crate) fn only<'a>(
    file: &str,
    name: &str,
    names: impl Iterator<Item = &'a str>,
) -> Result<Option<usize>, Problem> {
    let mut places = names.enumerate().filter(|(_, own)| *own == name);
    let first = places.next().map(|(place, _)| place);
    match places.count() {
        0 => Ok(first),
        more => {
            let message = format!("the file has {} columns `{}`", more + 1, shown(name));
            let problem = Problem::new(Code::SAME_COLUMN, message)
                .file(file)
                .column(name);
            Err(problem
                .help("give each column a unique name, or use its number, `$1` for the first one"))
        }
    }
}

/// Existing columns of a file.
pub(crate) struct Existing<'a> {
    pub(crate) names: Vec<&'a str>,
    /// Number of columns; all or none have a name.
    pub(crate) columns: usize,
    /// Word for a column in this format.
    pub(crate) what: &'static str,
}

/// The problem of missing columns, with all existing ones, for one file or several joined ones.
///
/// Names in `used` are not suggested.
pub(crate) fn missing_columns(
    file: &str,
    missing: &[&str],
    existing: &Existing<'_>,
    used: &[&str],
) -> Problem {
    let Existing {
        names,
        columns,
        what,
    } = existing;
    let problem = no_columns(
        file,
        missing,
        what,
        &match (names.is_empty(), columns) {
            (false, _) => format!("the file has {}", quoted(names.iter().copied())),
            (true, 0) => String::from("the file has none"),
            (true, 1) => String::from("the file has one column, without a name"),
            (true, count) => format!("the file has {count} columns, without names"),
        },
    );
    if *columns > 0 && missing.iter().any(|name| name.starts_with('$')) {
        problem.help(format!(
            "columns have the numbers `$1` to `${columns}`; if others are in another file of this run, join both files, `a.csv+b.csv`"
        ))
    } else if let Some(guesses) = guesses(missing, names, used) {
        problem.help(guesses)
    } else if are_default(names) {
        problem.help("the file has the columns of a log without [data], as `overact simulate` writes it: name these columns in [data], without `position_scale` and `torque_gain`, or leave out the table")
    } else if names.is_empty() && *columns > 0 {
        problem.help(
            "name the columns in the table [data] by their numbers: `$1` is the first one, `$2` the next",
        )
    } else {
        problem.help("name the columns in the table [data]")
    }
}

/// Whether columns have the names of a log without a table `[data]`.
fn are_default(names: &[&str]) -> bool {
    let begins = |start: &str| names.iter().any(|name| name.starts_with(start));
    names.contains(&"time") && begins("q_") && begins("tau_")
}

/// The problem of missing columns, with the text `existing`.
pub(crate) fn no_columns(file: &str, missing: &[&str], what: &str, existing: &str) -> Problem {
    let (is, s) = match missing.len() {
        1 => ("is", ""),
        _ => ("are", "s"),
    };
    let names = quoted(missing.iter().copied());
    let message = format!("there {is} no {what}{s} {names}; {existing}");
    let problem = Problem::new(Code::LOG_COLUMNS, message).file(file);
    match missing.first() {
        Some(first) => problem.column(*first),
        None => problem,
    }
}

/// Suggests existing names for missing ones, each for one of them, and none in `used`.
pub(crate) fn guesses(missing: &[&str], names: &[&str], used: &[&str]) -> Option<String> {
    let mut free: Vec<&str> = names.to_vec();
    free.retain(|name| !used.contains(name));
    let near = missing.iter().filter_map(|name| {
        // A name with its unit, as `q [deg]`, is meant rather than a similar one.
        let is_with_unit = |own: &&str| {
            let rest = own.strip_prefix(name);
            rest.is_some_and(|rest| rest.trim_start().starts_with(['[', '(', '/']))
        };
        let with_unit = free.iter().copied().find(is_with_unit);
        let near = with_unit.or_else(|| suggestion(name, free.iter().copied()))?;
        free.retain(|own| *own != near);
        Some(format!("`{}` for `{}`", shown(near), shown(name)))
    });
    let near: Vec<String> = near.collect();
    (!near.is_empty()).then(|| format!("did you mean {}?", near.join(", ")))
}
