//! States of a robot from JSON or CSV.
//!
//! JSON files have an array of objects keyed by input name; CSV files have a column `pose[0]` for
//! each number.

use crate::failure::{Failure, Problem};
use overact_codegen::diagnostic::{Code, did_you_mean};
use serde::{
    Deserialize, Deserializer,
    de::{Error as _, MapAccess, Visitor},
};
use serde_json::{Value, error::Category};
use std::{
    collections::BTreeMap,
    fmt::{self, Formatter},
    fs,
    io::{self, Read},
    path::Path,
};

/// States of a file.
#[derive(Debug)]
pub(crate) struct States {
    file: String,
    format: Format,
    states: Vec<State>,
}

/// Format of a file of states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Json,
    Csv,
}

/// One state: quantities by name; unused ones may have any value.
#[derive(Debug, Default)]
struct State {
    line: Option<usize>,
    quantities: BTreeMap<String, Quantity>,
}

/// Numbers of a quantity, or why they are invalid.
type Quantity = Result<Vec<f64>, String>;

impl States {
    /// Reads states from a file, or from stdin if the path is `-`.
    ///
    /// # Errors
    /// A file that cannot be read, or that is neither JSON nor CSV with a header.
    pub(crate) fn read(path: &Path) -> Result<Self, Failure> {
        let file = path.display().to_string();
        let text = if file == "-" {
            let mut text = String::new();
            io::stdin().read_to_string(&mut text).map(|_| text)
        } else {
            fs::read_to_string(path)
        };
        let problem =
            |error| Problem::new(Code::STATES, format!("the states can't be read: {error}"));
        let text = text.map_err(|error| problem(error).file(file.as_str()))?;
        Self::parse(file, &text)
    }

    fn parse(file: String, text: &str) -> Result<Self, Failure> {
        let text = text.trim_start_matches('\u{feff}');
        let format = if text.trim_start().starts_with(['[', '{']) {
            Format::Json
        } else {
            Format::Csv
        };
        let states = match format {
            Format::Json => from_json(text),
            Format::Csv => from_csv(text),
        };
        match states {
            Ok(states) if states.is_empty() => {
                let help = "give a JSON array of objects keyed by input name, or CSV with a header such as `pose[0],pose[1]`";
                Err(Problem::new(Code::STATES, "the file contains no state")
                    .file(file)
                    .help(help)
                    .into())
            }
            Ok(states) => Ok(Self {
                file,
                format,
                states,
            }),
            Err(problem) => Err(problem.file(file).into()),
        }
    }

    /// Number of states.
    pub(crate) const fn len(&self) -> usize {
        self.states.len()
    }

    /// Whether the first state contains a quantity.
    pub(crate) fn hold(&self, name: &str) -> bool {
        self.states
            .first()
            .is_some_and(|state| state.quantities.contains_key(name))
    }

    /// Notation of a quantity in this format.
    pub(crate) fn form(&self, name: &str, length: usize) -> String {
        match (self.format, length) {
            (Format::Csv, 2..) => format!("`{name}[0]` to `{name}[{}]`", length - 1),
            (Format::Csv, _) => format!("`{name}[0]`"),
            (Format::Json, 1) => format!("`{name}` (1 number)"),
            (Format::Json, _) => format!("`{name}` ({length} numbers)"),
        }
    }

    /// Names of a state's contents, as in the file.
    pub(crate) fn found(&self, at: usize) -> Vec<&str> {
        let quantities = self.states.get(at).map(|state| state.quantities.keys());
        quantities
            .into_iter()
            .flatten()
            .map(String::as_str)
            .collect()
    }

    /// Sentence on contents of a JSON file that no function uses, if any.
    ///
    /// CSV tables often have other columns, so they are not checked.
    pub(crate) fn unknown(&self, known: &[&str]) -> Option<String> {
        let states = self.states.iter().filter(|_| self.format == Format::Json);
        let names = states.flat_map(|state| state.quantities.keys());
        let mut names: Vec<&str> = names.map(String::as_str).collect();
        names.retain(|name| !known.contains(name));
        names.sort_unstable();
        names.dedup();
        let (first, more) = (names.first()?, names.len() - 1);
        let near = did_you_mean(first, known.iter().copied());
        let near = near.map_or_else(String::new, |near| format!(": {near}"));
        let others = match more {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let file = &self.file;
        Some(format!(
            "{file}: no function has the input `{first}`{others} of the states{near}"
        ))
    }

    /// Numbers of a quantity in a state; `None` if it is absent.
    ///
    /// # Errors
    /// Anything other than `length` finite numbers.
    pub(crate) fn get(
        &self,
        at: usize,
        name: &str,
        length: usize,
    ) -> Result<Option<&[f64]>, Problem> {
        let Some(quantity) = self.states.get(at).and_then(|s| s.quantities.get(name)) else {
            return Ok(None);
        };
        let values = match quantity {
            Ok(values) => values,
            Err(message) => return Err(self.problem(at, &format!("`{name}` {message}"))),
        };
        if values.len() != length {
            let found = match values.len() {
                1 => "1 number".to_owned(),
                count => format!("{count} numbers"),
            };
            let message = format!("`{name}` has {found}, expected {length}");
            return Err(self.problem(at, &message));
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let message = format!("`{name}[{index}]` is not a finite number");
            return Err(self.problem(at, &message));
        }
        Ok(Some(values))
    }

    /// A problem with a state.
    pub(crate) fn problem(&self, at: usize, message: &str) -> Problem {
        let count = self.len();
        let problem = Problem::new(
            Code::STATES,
            format!("state {} of {count}: {message}", at + 1),
        );
        let line = self.states.get(at).and_then(|state| state.line);
        problem.file(self.file.as_str()).line(line)
    }
}

fn from_json(text: &str) -> Result<Vec<State>, Problem> {
    // A single object is one state.
    let states = if text.trim_start().starts_with('[') {
        serde_json::from_str::<Vec<State>>(text)
    } else {
        serde_json::from_str(text).map(|state| vec![state])
    };
    states.map_err(|error| {
        let line = Some(error.line()).filter(|line| *line > 0);
        let what = match error.classify() {
            Category::Data => "the states can't be used",
            _ => "the states are not JSON",
        };
        Problem::new(Code::STATES, format!("{what}: {error}"))
            .line(line)
            .help("write [{ \"pose\": [0.1, 0.2, 0.3], ... }, ...], each name once in a state")
    })
}

/// Rejects two values under one name, because either could be intended.
impl<'de> Deserialize<'de> for State {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Quantities)
    }
}

struct Quantities;

impl<'de> Visitor<'de> for Quantities {
    type Value = State;

    fn expecting(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str("a state, an object of quantities")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<State, A::Error> {
        let mut state = State::default();
        while let Some(name) = object.next_key::<String>()? {
            if state.quantities.contains_key(&name) {
                return Err(A::Error::custom(format!(
                    "`{name}` occurs twice in a state"
                )));
            }
            let value: Value = object.next_value()?;
            state.quantities.insert(name, numbers(&value));
        }
        Ok(state)
    }
}

/// An array of numbers, or one number.
fn numbers(value: &Value) -> Quantity {
    let one = |value: &Value| {
        value
            .as_f64()
            .ok_or_else(|| format!("has {value}, which is not a number"))
    };
    match value {
        Value::Array(all) => all.iter().map(one).collect(),
        value => Ok(vec![one(value)?]),
    }
}

fn from_csv(text: &str) -> Result<Vec<State>, Problem> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .flexible(true)
        .comment(Some(b'#'))
        .delimiter(separator(text))
        .from_reader(text.as_bytes());
    let broken = |error: csv::Error| {
        let line = error.position().map(|position| position.line() as usize);
        Problem::new(Code::STATES, format!("the states are not CSV: {error}")).line(line)
    };
    let header: Vec<(String, usize)> = reader
        .headers()
        .map_err(broken)?
        .iter()
        .map(cell_name)
        .collect();
    let mut states = Vec::new();
    for record in reader.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map(|position| first_line(text, position));
        if record
            .iter()
            .skip(header.len())
            .any(|cell| !cell.is_empty())
        {
            let (found, named) = (record.len(), header.len());
            let message = format!("{found} cells in a line, but {named} names in the header");
            let help = "name every column, or remove columns without a name; use decimal points";
            return Err(Problem::new(Code::STATES, message).line(line).help(help));
        }
        let mut cells: BTreeMap<&str, Vec<(usize, &str)>> = BTreeMap::new();
        for ((name, index), cell) in header.iter().zip(&record) {
            cells.entry(name).or_default().push((*index, cell));
        }
        // A quantity with only empty cells is absent from this state.
        cells.retain(|_, cells| cells.iter().any(|(_, cell)| !cell.is_empty()));
        let quantities = cells
            .into_iter()
            .map(|(name, cells)| (name.to_owned(), from_cells(cells)));
        states.push(State {
            line,
            quantities: quantities.collect(),
        });
    }
    Ok(states)
}

/// Separator of the header: `,`, `;` or a tab.
fn separator(text: &str) -> u8 {
    let mut lines = text.lines();
    let header = lines.find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let holds = |separator: &&u8| header.is_some_and(|own| own.as_bytes().contains(separator));
    b";\t".iter().find(holds).copied().unwrap_or(b',')
}

/// Line of a record; the reader's position is before preceding comments and empty lines.
fn first_line(text: &str, position: &csv::Position) -> usize {
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(start..).unwrap_or_default();
    let is_skipped = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    // The number of lines is far below 2^64.
    position.line() as usize + rest.lines().take_while(is_skipped).count()
}

/// Name and index of a column: `pose[1]`, or `pose` for its first number.
fn cell_name(column: &str) -> (String, usize) {
    let indexed = column.strip_suffix(']').and_then(|rest| {
        let (name, index) = rest.split_once('[')?;
        Some((name.trim().to_owned(), index.trim().parse().ok()?))
    });
    indexed.unwrap_or_else(|| (column.to_owned(), 0))
}

/// Numbers of a quantity by index, which must count from 0 without gaps.
fn from_cells(mut cells: Vec<(usize, &str)>) -> Quantity {
    cells.sort_by_key(|(index, _)| *index);
    let one = |(expected, (index, cell)): (usize, (usize, &str))| {
        if index > expected {
            return Err(format!("has no column [{expected}]"));
        }
        if index < expected {
            return Err(format!("has two columns [{index}]"));
        }
        cell.parse::<f64>()
            .map_err(|_| format!("has \"{cell}\", which is not a number"))
    };
    cells.into_iter().enumerate().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::States;

    #[test]
    fn csv_and_json_states_are_equal() {
        let csv = "pose[1],pose[0],note,twist[0]\n2,1,x,3\n# c\n5,4,,nan\n";
        let json = r#"[{"pose":[1,2],"note":"x","twist":3},{"pose":[4,5],"twist":[1e999]}]"#;
        let csv = States::parse("a.csv".into(), csv).unwrap();
        assert_eq!(csv.get(0, "pose", 2).unwrap(), Some(&[1.0, 2.0][..]));
        assert_eq!(csv.get(1, "pose", 2).unwrap(), Some(&[4.0, 5.0][..]));
        assert_eq!(csv.get(1, "twist", 1).unwrap_err().line, Some(4));
        assert!(csv.get(0, "note", 1).is_err() && csv.get(1, "note", 1).unwrap().is_none());
        for separator in [";", "\t"] {
            let text = "# c\n\npose[1],pose[0],note\n2,1,x\n".replace(',', separator);
            let other = States::parse("a.csv".into(), &text).unwrap();
            assert_eq!(other.get(0, "pose", 2).unwrap(), Some(&[1.0, 2.0][..]));
        }
        assert!(
            States::parse("a.json".into(), json).is_err(),
            "1e999 is not a number"
        );
        let json = States::parse("a.json".into(), &json.replace("1e999", "7")).unwrap();
        assert_eq!(
            json.get(0, "pose", 2).unwrap(),
            csv.get(0, "pose", 2).unwrap()
        );
        assert_eq!(json.get(0, "twist", 1).unwrap(), Some(&[3.0][..]));
    }

    #[test]
    fn duplicate_names_are_located() {
        let text = "[\n{\"pose\": [1, 2]},\n{\"pose\": [3, 4],\n\"pose\": [5, 6]}]";
        let problems = States::parse("s.json".into(), text).unwrap_err().problems();
        assert_eq!((problems.len(), problems[0].line), (1, Some(4)));
        let text_of_problem = &problems[0].message;
        assert!(
            text_of_problem.contains("`pose` occurs twice in a state"),
            "{text_of_problem}"
        );
        let corrected = text.replace(",\n\"pose\"", ",\n\"twist\"");
        assert_eq!(States::parse("s.json".into(), &corrected).unwrap().len(), 2);
    }

    #[test]
    fn unknown_json_quantities_are_reported_with_suggestions() {
        let message_of = |text: &str| {
            let states = States::parse("s.json".into(), text).unwrap();
            states.unknown(&["pose", "twist"])
        };
        assert_eq!(message_of("[{\"pose\": [1], \"twist\": [2]}]"), None);
        assert_eq!(message_of("pose[0],note\n1,2\n"), None);
        let expected =
            "s.json: no function has the input `twits` of the states: did you mean `twist`?";
        assert_eq!(
            message_of("[{\"pose\": [1], \"twits\": [2]}]").as_deref(),
            Some(expected)
        );
        let two = message_of("[{\"a1\": 1}, {\"b\": 1}]");
        assert_eq!(
            two.as_deref(),
            Some("s.json: no function has the input `a1` and 1 more of the states")
        );
    }

    #[test]
    fn invalid_states_are_rejected_with_their_location() {
        let message = |text: &str, name| {
            let states = States::parse("s".into(), text).unwrap();
            states.get(0, name, 3).unwrap_err().message
        };
        assert!(message("pose[0],pose[2]\n1,2\n", "pose").contains("no column [1]"));
        assert!(message("[{\"pose\":[1,2]}]", "pose").contains("has 2 numbers, expected 3"));
        assert!(message("[{\"pose\":[1,\"a\",3]}]", "pose").contains("not a number"));
        for text in [
            "",
            "[]",
            "pose[0]\n",
            "[1]",
            "[{",
            "pose[0],pose[1]\n1,2,3\n",
        ] {
            assert!(States::parse("s".into(), text).is_err(), "{text}");
        }
    }
}
