//! MCAP files of ROS 2: topics of `sensor_msgs/msg/JointState` in CDR.
//!
//! They are read message by message, so large files stay on disk. Each topic is a table like a
//! file. Its columns are `position.JOINT`, `velocity.JOINT`, `effort.JOINT`, the time of
//! measurement `time` (the stamp of the header), and the time of recording `log_time`.

mod chunk;
mod fields;
mod joint_state;
mod records;
mod rows;
mod section;
mod topic;
mod topics;

use overact::Code;
use std::{fs::File, path::Path, sync::Arc};

use self::{
    rows::{Rows, Wanted},
    topic::{Topic, broken},
    topics::Topics,
};
use crate::{
    error::{Error, Problem},
    formats::table_file::{RowReader, TableFile},
    problems::{Existing, legible, only, shown, unreadable},
};

/// Largest number of topics listed in a message.
const MOST_TOPICS: usize = 12;

/// Opens the topics of a file.
///
/// # Errors
/// A file that cannot be read or is broken, or has no topic with joint states.
pub(crate) fn open(file: &str, path: &Path) -> Result<Vec<Topic>, Error> {
    let input = File::open(path).map_err(|error| unreadable(file, &error))?;
    let length = input
        .metadata()
        .map_err(|error| unreadable(file, &error))?
        .len();
    let (topics, found) =
        Topics::find(&Arc::new(input), length).map_err(|why| broken(file, &why))?;
    let (mut opened, mut problems) = (Vec::new(), Vec::new());
    for found in found {
        match Topic::new(file, path, found) {
            Ok(topic) => opened.extend(topic),
            Err(problem) => problems.push(problem),
        }
    }
    Error::check(problems)?;
    let parts = opened.len() as u64;
    let Some(first) = opened.first() else {
        return Err(without_joints(file, &topics).into());
    };
    let (origin, recorded_from) = (first.origin, first.recorded_from);
    for topic in &mut opened {
        (topic.origin, topic.recorded_from, topic.parts) = (origin, recorded_from, parts);
    }
    Ok(opened)
}

impl TableFile for Topic {
    fn file(&self) -> &str {
        &self.file
    }

    fn label(&self) -> String {
        format!("{} of {}", shown(&self.topic), self.file)
    }

    fn full_name(&self, column: &str) -> String {
        format!("{}.{column}", self.topic)
    }

    fn what(&self) -> &'static str {
        "an MCAP file"
    }

    fn is_part(&self) -> bool {
        true
    }

    // Joints have no fixed order, so columns cannot be numbered.
    fn columns(&self) -> usize {
        0
    }

    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let full = self.columns.iter().position(|own| own.full == name);
        if full.is_some() {
            return Ok(full);
        }
        only(
            &self.file,
            name,
            self.columns.iter().map(|own| own.name.as_str()),
        )
    }

    fn origin(&self) -> Option<i64> {
        Some(self.origin)
    }

    fn set_origin(&mut self, origin: i64) {
        if self.recorded_from == self.origin {
            self.recorded_from = origin;
        }
        self.origin = origin;
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: self.columns.iter().map(|own| own.full.as_str()).collect(),
            columns: 0,
            what: "column",
        }
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let input = File::open(&self.path).map_err(|error| unreadable(&self.file, &error))?;
        let length = input
            .metadata()
            .map_err(|error| unreadable(&self.file, &error))?
            .len();
        let wanted = wanted.iter().filter_map(|&(place, name)| {
            let source = self.columns.get(place)?.source;
            Some(Wanted { source, name })
        });
        Ok(Box::new(Rows::new(self, input, length, wanted.collect())))
    }
}

/// The problem of a file without a supported topic.
fn without_joints(file: &str, topics: &Topics) -> Problem {
    let told = topics.told();
    let more = told.len().saturating_sub(MOST_TOPICS);
    let mut listed: Vec<String> = told
        .iter()
        .take(MOST_TOPICS)
        .map(|own| legible(own))
        .collect();
    match (listed.len(), more) {
        (0, _) => listed.push(String::from("no topic")),
        (_, 0) => {}
        _ => listed.push(format!("{more} more")),
    }
    let message = format!(
        "the MCAP file has no messages of the type sensor_msgs/msg/JointState in CDR; it has {}",
        listed.join(", ")
    );
    let help = "record the topic with positions and efforts of the drives, as in ROS 2; otherwise export CSV";
    Problem::new(Code::LOG_COLUMNS, message)
        .file(file)
        .help(help)
}
