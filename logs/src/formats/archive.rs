//! Zip archives as NumPy writes them: stored or deflated members.

use std::io::Read;

use libflate::deflate::Decoder;

use crate::bytes::budget::Budget;

/// Magic numbers of the records of an archive.
const END: &[u8] = b"PK\x05\x06";
const LISTED: &[u8] = b"PK\x01\x02";
const MEMBER: &[u8] = b"PK\x03\x04";

/// Size of the end record, and largest size of the comment after it.
const END_SIZE: usize = 22;
const LONGEST_COMMENT: usize = 1 << 16;

/// Size that marks a member of more than 4 GB.
const ELSEWHERE: usize = u32::MAX as usize;

/// A member of an archive.
pub(crate) struct Member {
    pub(crate) name: String,
    /// 0 stored, 8 deflated.
    method: usize,
    packed: usize,
    size: usize,
    start: usize,
}

/// A little-endian number of two or four bytes.
fn number(bytes: &[u8], place: usize, size: usize) -> Option<usize> {
    let bytes = bytes.get(place..place.checked_add(size)?)?;
    Some(
        bytes
            .iter()
            .rev()
            .fold(0, |all, byte| all << 8 | usize::from(*byte)),
    )
}

/// Lists the members of an archive.
///
/// # Errors
/// A description of the defect.
pub(crate) fn members(archive: &[u8]) -> Result<Vec<Member>, String> {
    let cut_off = || String::from("it is truncated");
    let from = archive.len().saturating_sub(END_SIZE + LONGEST_COMMENT);
    let end = archive[from..]
        .windows(END.len())
        .rposition(|bytes| bytes == END)
        .ok_or_else(cut_off)?;
    let end = &archive[from + end..];
    let count = number(end, 10, 2).ok_or_else(cut_off)?;
    let mut place = number(end, 16, 4).ok_or_else(cut_off)?;
    let mut members = Vec::new();
    for _ in 0..count {
        let record = archive
            .get(place..)
            .filter(|record| record.starts_with(LISTED));
        let record = record.ok_or_else(cut_off)?;
        let field = |place, size| number(record, place, size).ok_or_else(cut_off);
        let name = field(28, 2)?;
        let name = record.get(46..46 + name).ok_or_else(cut_off)?;
        place += 46 + name.len() + field(30, 2)? + field(32, 2)?;
        members.push(Member {
            name: String::from_utf8_lossy(name).into_owned(),
            method: field(10, 2)?,
            packed: field(20, 4)?,
            size: field(24, 4)?,
            start: field(42, 4)?,
        });
    }
    Ok(members)
}

impl Member {
    /// Reads all bytes of the member.
    ///
    /// # Errors
    /// A description of the defect.
    pub(crate) fn content(&self, archive: &[u8], budget: &mut Budget) -> Result<Vec<u8>, String> {
        let broken = |what: &str| format!("`{}` {what}", crate::problems::shown(&self.name));
        let named = |why: &str| format!("`{}`: {why}", crate::problems::shown(&self.name));
        if self.size == ELSEWHERE || self.packed == ELSEWHERE {
            return Err(broken("has more than 4 GB"));
        }
        let record = archive
            .get(self.start..)
            .filter(|record| record.starts_with(MEMBER));
        let data = record.and_then(|record| {
            let start = 30 + number(record, 26, 2)? + number(record, 28, 2)?;
            record.get(start..start.checked_add(self.packed)?)
        });
        let data = data.ok_or_else(|| broken("is truncated"))?;
        let content = match self.method {
            0 => {
                // Several members may share the same bytes.
                budget.take(data.len() as u64).map_err(|why| named(&why))?;
                data.to_vec()
            }
            8 => {
                // One more byte shows that the member is larger than stated.
                let unpacked = Decoder::new(data).take(self.size as u64 + 1);
                budget.unpack(unpacked).map_err(|why| named(&why))?
            }
            _ => return Err(broken("is compressed with an unsupported method")),
        };
        if content.len() == self.size {
            Ok(content)
        } else {
            Err(broken("is broken"))
        }
    }
}
