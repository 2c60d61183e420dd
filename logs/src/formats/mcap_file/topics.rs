//! Topics of a file, and the first message of each supported one.

use std::{
    collections::BTreeMap,
    fs::File,
    io::{Read, Seek, SeekFrom},
    sync::Arc,
};

use super::{
    fields::Fields,
    records::{FOOTER, MAGIC, Record, Records},
};

/// Supported message type and encoding.
const TYPE: &str = "sensor_msgs/msg/JointState";
const ENCODING: &str = "cdr";

/// Bytes of the last record and of the magic bytes after it.
const END: u64 = 29 + 8;

/// A topic, collected from the channels of a file.
#[derive(Debug)]
pub(super) struct TopicChannels {
    pub(super) topic: String,
    pub(super) channels: Vec<u16>,
    /// Recording time (ns) and content of the first message; `None` without a message.
    pub(super) first: Option<(u64, Vec<u8>)>,
}

/// Topics of a file.
#[derive(Debug, Default)]
pub(super) struct Topics {
    schemas: BTreeMap<u16, String>,
    /// For each channel its topic, its schema and its message encoding.
    channels: BTreeMap<u16, (String, u16, String)>,
}

impl Topics {
    /// Finds the supported topics.
    ///
    /// # Errors
    /// A description of the defect and its position.
    pub(super) fn find(
        file: &Arc<File>,
        length: u64,
    ) -> Result<(Self, Vec<TopicChannels>), String> {
        let mut topics = Self::default();
        let summary = summary(file, length)?;
        let mut content = Vec::new();
        if let Some(start) = summary {
            let mut records = Records::new(file, start, length - END);
            while let Some(record) = records.next(&mut content, &|_| false)? {
                topics.note(&record, &content);
            }
        }
        // Without a summary, later parts of the file may have more channels.
        let is_complete = !topics.channels.is_empty();
        let mut firsts: BTreeMap<u16, (u64, Vec<u8>)> = BTreeMap::new();
        let mut records = Records::new(file, MAGIC.len() as u64, length - END);
        loop {
            if is_complete && topics.joints().all(|(id, _)| firsts.contains_key(&id)) {
                break;
            }
            let wants = |channel| topics.is_joints(channel) && !firsts.contains_key(&channel);
            let Some(record) = records.next(&mut content, &wants)? else {
                break;
            };
            match record {
                Record::Message(channel, time) if wants(channel) => {
                    firsts.insert(channel, (time, std::mem::take(&mut content)));
                }
                _ => topics.note(&record, &content),
            }
        }
        let mut found: Vec<TopicChannels> = Vec::new();
        for (channel, topic) in topics.joints() {
            let first = firsts.remove(&channel);
            match found.iter_mut().find(|own| own.topic == topic) {
                None => found.push(TopicChannels {
                    topic: topic.to_owned(),
                    channels: vec![channel],
                    first,
                }),
                // A topic may have several publishers.
                Some(own) => {
                    own.channels.push(channel);
                    let time = |first: &Option<(u64, Vec<u8>)>| {
                        first.as_ref().map_or(u64::MAX, |own| own.0)
                    };
                    if time(&first) < time(&own.first) {
                        own.first = first;
                    }
                }
            }
        }
        Ok((topics, found))
    }

    /// Registers a schema or a channel.
    fn note(&mut self, record: &Record, content: &[u8]) {
        let mut fields = Fields(content);
        match record {
            Record::Schema => {
                if let (Some(id), Some(name)) = (fields.short(), fields.text()) {
                    self.schemas.insert(id, name);
                }
            }
            Record::Channel => {
                let (id, schema) = (fields.short(), fields.short());
                if let (Some(id), Some(schema), Some(topic), Some(encoding)) =
                    (id, schema, fields.text(), fields.text())
                {
                    self.channels.insert(id, (topic, schema, encoding));
                }
            }
            Record::Message(..) => {}
        }
    }

    fn is_joints(&self, channel: u16) -> bool {
        self.channels
            .get(&channel)
            .is_some_and(|(_, schema, encoding)| {
                encoding == ENCODING && self.schemas.get(schema).is_some_and(|name| name == TYPE)
            })
    }

    /// Channels of supported messages, with their topics.
    fn joints(&self) -> impl Iterator<Item = (u16, &str)> {
        let channels = self.channels.iter().filter(|(id, _)| self.is_joints(**id));
        channels.map(|(id, (topic, ..))| (*id, topic.as_str()))
    }

    /// All topics, with their message type and encoding.
    pub(super) fn told(&self) -> Vec<String> {
        let channels = self.channels.values();
        let told = channels.map(|(topic, schema, encoding)| {
            let name = self
                .schemas
                .get(schema)
                .map_or("of no type", String::as_str);
            format!("{topic} ({name}, {encoding})")
        });
        told.collect()
    }
}

/// Start of the summary of a file, if it has one.
///
/// # Errors
/// A file with an invalid end.
fn summary(file: &Arc<File>, length: u64) -> Result<Option<u64>, String> {
    let cut_off = || String::from("it is truncated: its end is missing");
    let start = length.checked_sub(END).ok_or_else(cut_off)?;
    let mut end = [0; END as usize];
    let mut input = &**file;
    let read = input
        .seek(SeekFrom::Start(start))
        .and_then(|_| input.read_exact(&mut end));
    read.map_err(|error| error.to_string())?;
    if !end.ends_with(MAGIC) {
        return Err(cut_off());
    }
    let (kind, rest) = (end[0], &end[1..]);
    let mut fields = Fields(rest);
    if kind != FOOTER || fields.long() != Some(20) {
        return Err(String::from("its last record is not a footer"));
    }
    match fields.long() {
        None | Some(0) => Ok(None),
        Some(place) if place < start => Ok(Some(place)),
        Some(place) => Err(format!(
            "its summary should start at byte {place}, after its end"
        )),
    }
}
