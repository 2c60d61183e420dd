//! Writes MCAP files record by record, valid or not.
#![allow(dead_code, reason = "each test file uses its part")]

/// The supported message type.
pub(crate) const JOINT_STATE: &str = "sensor_msgs/msg/JointState";

/// Magic bytes at both ends of a file.
pub(crate) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

/// Start of the logs, s since 1970.
pub(crate) const START: u64 = 1_700_000_000;

fn text(text: &str) -> Vec<u8> {
    let mut bytes = (text.len() as u32).to_le_bytes().to_vec();
    bytes.extend(text.as_bytes());
    bytes
}

/// A record of a kind.
pub(crate) fn record(kind: u8, content: &[u8]) -> Vec<u8> {
    let mut bytes = vec![kind];
    bytes.extend((content.len() as u64).to_le_bytes());
    bytes.extend(content);
    bytes
}

/// A schema and a topic with it, both with the number `id`.
pub(crate) fn topic(id: u16, name: &str, (kind, encoding): (&str, &str)) -> Vec<u8> {
    let schema = [
        &id.to_le_bytes()[..],
        &text(kind),
        &text("ros2msg"),
        &text(""),
    ]
    .concat();
    let empty = 0_u32.to_le_bytes();
    let channel = [
        &id.to_le_bytes()[..],
        &id.to_le_bytes(),
        &text(name),
        &text(encoding),
        &empty,
    ]
    .concat();
    [record(3, &schema), record(4, &channel)].concat()
}

/// A message on a topic, recorded `nanos` after the start.
pub(crate) fn message(id: u16, nanos: u64, content: &[u8]) -> Vec<u8> {
    let time = (START * 1_000_000_000 + nanos).to_le_bytes();
    record(
        5,
        &[&id.to_le_bytes()[..], &[0; 4], &time, &time, content].concat(),
    )
}

/// Joint states, stamped `nanos` after the start.
pub(crate) fn state(nanos: u64, names: &[&str], lists: [&[f64]; 3]) -> Vec<u8> {
    let second = (START + nanos / 1_000_000_000) as u32;
    stamped((second, (nanos % 1_000_000_000) as u32), names, lists)
}

/// The same with a given stamp.
pub(crate) fn stamped(stamp: (u32, u32), names: &[&str], lists: [&[f64]; 3]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let align = |bytes: &mut Vec<u8>, to: usize| bytes.resize(bytes.len().next_multiple_of(to), 0);
    let word = |bytes: &mut Vec<u8>, value: u32| {
        align(bytes, 4);
        bytes.extend(value.to_le_bytes());
    };
    word(&mut bytes, stamp.0);
    word(&mut bytes, stamp.1);
    word(&mut bytes, 5);
    bytes.extend(b"base\0");
    word(&mut bytes, names.len() as u32);
    for name in names {
        word(&mut bytes, name.len() as u32 + 1);
        bytes.extend(name.as_bytes());
        bytes.push(0);
    }
    for list in lists {
        word(&mut bytes, list.len() as u32);
        if !list.is_empty() {
            align(&mut bytes, 8);
        }
        list.iter()
            .for_each(|value| bytes.extend(value.to_le_bytes()));
    }
    [&[0, 1, 0, 0][..], &bytes].concat()
}

/// A chunk of compressed records, with their size and checksum (or zero).
pub(crate) fn chunk(packing: &str, packed: &[u8], (size, sum): (u64, u32)) -> Vec<u8> {
    let length = (packed.len() as u64).to_le_bytes();
    record(
        6,
        &[
            &[0; 16][..],
            &size.to_le_bytes(),
            &sum.to_le_bytes(),
            &text(packing),
            &length,
            packed,
        ]
        .concat(),
    )
}

/// Start of a file.
pub(crate) fn beginning() -> Vec<u8> {
    [MAGIC, &record(1, &[text("ros2"), text("test")].concat())].concat()
}

/// End of a file of `before` bytes: a summary with these records, or none.
pub(crate) fn end(before: u64, summary: &[u8]) -> Vec<u8> {
    let data_end = record(15, &[0; 4]);
    let place = if summary.is_empty() {
        0
    } else {
        before + data_end.len() as u64
    };
    let footer = record(2, &[&place.to_le_bytes()[..], &[0; 12]].concat());
    [&data_end, summary, &footer, MAGIC].concat()
}

/// A file of records without summary.
pub(crate) fn file(records: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = beginning();
    bytes.extend(records.concat());
    let end = end(bytes.len() as u64, &[]);
    bytes.extend(end);
    bytes
}
