//! Equations of one line of a part of a run, as self-contained bytes for a database.
//!
//! A record contains what it is, a checksum, and the run's hash for duplicate detection.
//! Little-endian:
//!
//! | bytes | content |
//! |---|---|
//! | 4 | `OAR1` |
//! | 4 | length of the record |
//! | 8 | low half of XXH3 (128 bits) of everything after it |
//! | 16, 16 | hash of description and settings; hash of the run's numbers |
//! | 1, 1 | model: 0 platform, 1 actuators, 2 joints; 1 if the robot carried a payload |
//! | 2, 2, 2 | part of the run, line of Γ, number of columns p |
//! | 8 | equations |
//! | 2, 2, 4 | lengths of the texts that follow |
//! | | name of the payload, name of the line, names of the columns with commas |
//! | 8 (p + 1) | sums of the columns and of Y, doubles |
//! | 4 (p + 1)(p + 2) | upper triangle of R row by row, doubles |

use twox_hash::XxHash3_128;

use super::packed::{from_triangle, numbers, triangle, values};
use crate::regression::{factor::Factor, projection::ModelKind};

/// Magic bytes of a record.
const MAGIC: [u8; 4] = *b"OAR1";

/// Bytes before the hashed ones.
const FRONT: usize = 16;

/// Bytes before the texts.
const HEAD: usize = FRONT + 56;

/// Models by number.
const MODELS: [ModelKind; 3] = [ModelKind::Platform, ModelKind::Actuators, ModelKind::Joints];

/// Equations of one line of a part of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Record {
    /// Hash of the description and of the settings that affect the equations.
    pub settings_hash: u128,
    /// Hash of the run's numbers.
    pub content: u128,
    /// Model.
    pub model: ModelKind,
    /// Payload name, empty if it has none; `None` without payload.
    pub load: Option<String>,
    /// Number of the part of the run.
    pub part: u16,
    /// Number of the line of Γ.
    pub line: u16,
    /// Name of the line.
    pub line_name: String,
    /// Names of the columns, separated by commas.
    pub columns: String,
    /// R factor of [W Y].
    pub factor: Factor,
}

/// Reason why bytes are no record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoRecord {
    /// Cut off, of another kind, or not what was written.
    Damaged,
    /// Numbers that are not finite.
    NotFinite,
}

impl Record {
    /// Hash of description, settings, model, payload and columns; equal for compatible records.
    #[must_use]
    pub fn kind(&self) -> u128 {
        let load = self.load.as_ref().map(|name| format!("+{name}"));
        let text = format!(
            "{:032x}\n{}\n{}\n{}",
            self.settings_hash,
            self.model.name(),
            load.unwrap_or_default(),
            self.columns
        );
        XxHash3_128::oneshot(text.as_bytes())
    }

    /// The record as bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let load = self.load.as_deref().unwrap_or("");
        let model = MODELS.iter().position(|own| *own == self.model);
        let mut own = vec![0; FRONT];
        own.extend(self.settings_hash.to_le_bytes());
        own.extend(self.content.to_le_bytes());
        own.extend([model.unwrap_or(0) as u8, u8::from(self.load.is_some())]);
        for value in [self.part, self.line, self.factor.parameters() as u16] {
            own.extend(value.to_le_bytes());
        }
        own.extend((self.factor.equations() as u64).to_le_bytes());
        own.extend((load.len() as u16).to_le_bytes());
        own.extend((self.line_name.len() as u16).to_le_bytes());
        own.extend((self.columns.len() as u32).to_le_bytes());
        for text in [load, &self.line_name, &self.columns] {
            own.extend(text.as_bytes());
        }
        own.extend(values(self.factor.sums()));
        own.extend(triangle(self.factor.matrix()));
        let length = own.len() as u32;
        let check = XxHash3_128::oneshot(&own[FRONT..]) as u64;
        own[..4].copy_from_slice(&MAGIC);
        own[4..8].copy_from_slice(&length.to_le_bytes());
        own[8..FRONT].copy_from_slice(&check.to_le_bytes());
        own
    }

    /// All records in some bytes; reading ends after one of unknown length.
    #[must_use]
    pub fn all(bytes: &[u8]) -> Vec<Result<Self, NoRecord>> {
        let mut found = Vec::new();
        let mut rest = bytes;
        while !rest.is_empty() {
            let length = rest.get(4..8).and_then(|own| own.try_into().ok());
            let length = length.map_or(0, |own| u32::from_le_bytes(own) as usize);
            if rest.get(..4) != Some(&MAGIC[..]) || length < HEAD || length > rest.len() {
                found.push(Err(NoRecord::Damaged));
                break;
            }
            let (own, more) = rest.split_at(length);
            found.push(Self::of(own));
            rest = more;
        }
        found
    }

    /// The single record in some bytes.
    pub(super) fn one(bytes: &[u8]) -> Option<Self> {
        let mut all = Self::all(bytes);
        match all.len() {
            1 => all.pop()?.ok(),
            _ => None,
        }
    }

    /// Decodes a record from its bytes, at least those of the head.
    fn of(bytes: &[u8]) -> Result<Self, NoRecord> {
        let check = XxHash3_128::oneshot(&bytes[FRONT..]) as u64;
        let whole = check.to_le_bytes() == bytes[8..FRONT];
        if !whole {
            return Err(NoRecord::Damaged);
        }
        let own = Self::checked(bytes).ok_or(NoRecord::Damaged)?;
        let finite = |own: &Self| {
            let mut all = own.factor.matrix().iter().chain(own.factor.sums());
            all.all(|value| value.is_finite())
        };
        if finite(&own) {
            Ok(own)
        } else {
            Err(NoRecord::NotFinite)
        }
    }

    fn checked(bytes: &[u8]) -> Option<Self> {
        let mut rest = Rest(&bytes[FRONT..]);
        let settings_hash = u128::from_le_bytes(rest.array()?);
        let content = u128::from_le_bytes(rest.array()?);
        let [model, loaded] = rest.array()?;
        let [part, line, columns] = [rest.short()?, rest.short()?, rest.short()?];
        let equations = usize::try_from(u64::from_le_bytes(rest.array()?)).ok()?;
        let lengths = [rest.short()? as usize, rest.short()? as usize];
        let names = u32::from_le_bytes(rest.array()?) as usize;
        let load = rest.text(lengths[0])?;
        let line_name = rest.text(lengths[1])?;
        let names = rest.text(names)?;
        let named = names.split(',').filter(|name| !name.is_empty()).count();
        let size = (named == usize::from(columns)).then_some(named + 1)?;
        let sums = numbers(rest.take(8 * size)?, size)?;
        let matrix = from_triangle(rest.0, size)?;
        Some(Self {
            settings_hash,
            content,
            model: *MODELS.get(usize::from(model))?,
            load: (loaded != 0).then_some(load),
            part,
            line,
            line_name,
            columns: names,
            factor: Factor::of(matrix, equations, sums),
        })
    }
}

/// Unread bytes.
pub(super) struct Rest<'a>(pub(super) &'a [u8]);

impl<'a> Rest<'a> {
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (own, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(own)
    }

    pub(super) fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    fn short(&mut self) -> Option<u16> {
        Some(u16::from_le_bytes(self.array()?))
    }

    pub(super) fn text(&mut self, length: usize) -> Option<String> {
        String::from_utf8(self.take(length)?.to_vec()).ok()
    }
}
