//! Factors of many runs in bounded memory: the state of a database aggregate.
//!
//! Runs may come in any order and in several places. The estimate only needs the sum of all
//! factors. Its standard deviation for correlated residuals needs independent groups
//! (`estimation/intervals/parts.rs`), which are the parts of the runs while these are few.
//!
//! Later, parts are merged at random, by the leading bits of a hash of run and part. Sums over
//! groups of independent parts are independent, too. The grouping depends on the set of parts, not
//! on their order. Pools of several places therefore merge to the pool of a single place.
//!
//! A run counts once. A record that comes again to the same place is skipped and counted. If two
//! places have the same record, their sums cannot be separated, which is an error.

use std::collections::BTreeMap;

use twox_hash::XxHash3_128;

use super::record::{NoRecord, Record};
use crate::regression::{factor::Factor, projection::ModelKind};

/// Largest number of kinds of factors kept apart.
const MOST_KINDS: usize = 8;

/// Error of a pool.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum PoolError {
    /// The same run is in two pools.
    Twice,
    /// The bytes are no pool.
    Damaged,
}

/// Default number of groups, about equal to the degrees of freedom.
const GROUPS: usize = 16;

/// Smallest number of groups.
const FEWEST_GROUPS: usize = 4;

/// Factors of many runs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pool {
    /// Largest number of groups; `None` for the default.
    pub(super) limit: Option<usize>,
    /// Kinds, by [`Record::kind`].
    pub(super) kinds: BTreeMap<u128, PoolGroup>,
    /// Number of duplicate records.
    pub(super) twice: u64,
    /// Number of records that were damaged or not finite.
    pub(super) damaged: u64,
    /// Number of records of further kinds.
    pub(super) others: u64,
}

/// Factors of one kind.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PoolGroup {
    pub(super) settings_hash: u128,
    pub(super) model: ModelKind,
    pub(super) load: Option<String>,
    pub(super) columns: String,
    pub(super) line_names: BTreeMap<u16, String>,
    /// Parts and lines of each run that are included.
    ///
    /// The key is from the run's hash; the value has a bit for each of 8 × 8 parts and lines.
    pub(super) seen: BTreeMap<u64, u64>,
    /// Bits of the hash that define the groups.
    pub(super) bits: u32,
    /// Factors of the lines of each group, by these bits.
    pub(super) groups: BTreeMap<u64, BTreeMap<u16, Factor>>,
}

impl PoolGroup {
    fn of(record: &Record) -> Self {
        Self {
            settings_hash: record.settings_hash,
            model: record.model,
            load: record.load.clone(),
            columns: record.columns.clone(),
            line_names: BTreeMap::new(),
            seen: BTreeMap::new(),
            bits: u64::BITS,
            groups: BTreeMap::new(),
        }
    }

    /// Whether a record is new; registers it.
    fn note(&mut self, record: &Record) -> bool {
        let (key, bit) = place(record);
        let seen = self.seen.entry(key).or_default();
        let new = *seen & bit == 0;
        *seen |= bit;
        new
    }

    fn add(&mut self, limit: usize, record: Record) -> bool {
        if !self.note(&record) {
            return false;
        }
        let mut bytes = record.content.to_le_bytes().to_vec();
        bytes.extend(record.part.to_le_bytes());
        let group = (XxHash3_128::oneshot(&bytes) as u64) >> (u64::BITS - self.bits);
        self.line_names
            .entry(record.line)
            .or_insert(record.line_name);
        add_line(
            self.groups.entry(group).or_default(),
            record.line,
            &record.factor,
        );
        self.shrink(limit);
        true
    }

    /// Merges groups until there are few enough.
    fn shrink(&mut self, limit: usize) {
        while self.groups.len() > limit && self.bits > 1 {
            self.coarsen(self.bits - 1);
        }
    }

    fn coarsen(&mut self, bits: u32) {
        let shift = self.bits.saturating_sub(bits);
        self.bits = self.bits.min(bits);
        if shift == 0 {
            return;
        }
        let own = std::mem::take(&mut self.groups);
        for (group, lines) in own {
            let to = self.groups.entry(group >> shift).or_default();
            for (line, factor) in &lines {
                add_line(to, *line, factor);
            }
        }
    }

    fn merge(&mut self, limit: usize, mut other: Self) -> Result<(), PoolError> {
        for (key, bits) in &other.seen {
            let own = self.seen.entry(*key).or_default();
            if *own & bits != 0 {
                return Err(PoolError::Twice);
            }
            *own |= bits;
        }
        let bits = self.bits.min(other.bits);
        self.coarsen(bits);
        other.coarsen(bits);
        for (group, lines) in &other.groups {
            let to = self.groups.entry(*group).or_default();
            for (line, factor) in lines {
                add_line(to, *line, factor);
            }
        }
        for (line, name) in other.line_names {
            self.line_names.entry(line).or_insert(name);
        }
        self.shrink(limit);
        Ok(())
    }

    /// Number of runs.
    pub(super) fn runs(&self) -> usize {
        self.seen.len()
    }

    /// Number of columns.
    pub(super) fn parameters(&self) -> usize {
        let names = self.columns.split(',');
        names.filter(|name| !name.is_empty()).count()
    }
}

fn add_line(lines: &mut BTreeMap<u16, Factor>, line: u16, factor: &Factor) {
    match lines.get_mut(&line) {
        Some(own) => own.add(factor),
        None => {
            lines.insert(line, factor.clone());
        }
    }
}

/// Key and bit of a record; a run with more than 8 × 8 parts and lines has several keys.
fn place(record: &Record) -> (u64, u64) {
    let block = u64::from(record.part / 8) << 16 | u64::from(record.line / 8);
    let key = (record.content >> 64) as u64 ^ block.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let bit = u32::from(record.part % 8) * 8 + u32::from(record.line % 8);
    (key, 1 << bit)
}

impl Pool {
    /// A pool with at most `limit` groups, but at least four.
    ///
    /// [`Pool::default`] has no limit of its own: it uses 16, or the limit of pools merged into it.
    #[must_use]
    pub fn new(limit: usize) -> Self {
        Self {
            limit: Some(limit.max(FEWEST_GROUPS)),
            ..Self::default()
        }
    }

    /// Adds all records in some bytes; counts invalid ones.
    pub fn push(&mut self, bytes: &[u8]) {
        for record in Record::all(bytes) {
            match record {
                Ok(record) => self.add(record),
                Err(NoRecord::Damaged | NoRecord::NotFinite) => self.damaged += 1,
            }
        }
    }

    /// Sets the largest number of groups, at least four.
    ///
    /// Merged groups cannot be separated again, so the smallest of several limits applies.
    pub fn limit(&mut self, limit: usize) {
        self.at_most(Some(limit.max(FEWEST_GROUPS)));
    }

    /// The effective limit, if it was set or the pool has records.
    fn held_to(&self) -> Option<usize> {
        let usual = (!self.kinds.is_empty()).then_some(GROUPS);
        self.limit.or(usual)
    }

    fn at_most(&mut self, limit: Option<usize>) {
        let before = self.held_to();
        self.limit = [before, limit].into_iter().flatten().min();
        if let (Some(limit), true) = (self.limit, self.limit != before) {
            self.kinds.values_mut().for_each(|kind| kind.shrink(limit));
        }
    }

    /// Adds a record.
    pub fn add(&mut self, record: Record) {
        let key = record.kind();
        let full = self.kinds.len() >= MOST_KINDS && !self.kinds.contains_key(&key);
        if full {
            self.others += 1;
            return;
        }
        let kind = self
            .kinds
            .entry(key)
            .or_insert_with(|| PoolGroup::of(&record));
        if !kind.add(self.limit.unwrap_or(GROUPS), record) {
            self.twice += 1;
        }
    }

    /// Adds another pool.
    ///
    /// # Errors
    /// A run that both have.
    pub fn merge(&mut self, other: Self) -> Result<(), PoolError> {
        // An empty pool without a limit has no influence.
        self.at_most(other.held_to());
        let limit = self.limit.unwrap_or(GROUPS);
        self.twice += other.twice;
        self.damaged += other.damaged;
        self.others += other.others;
        for (key, own) in other.kinds {
            let full = self.kinds.len() >= MOST_KINDS;
            match self.kinds.get_mut(&key) {
                Some(kind) => kind.merge(limit, own)?,
                None if full => self.others += own.runs() as u64,
                None => self.kinds.entry(key).or_insert(own).shrink(limit),
            }
        }
        Ok(())
    }

    /// Approximate memory in bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        let kinds = self.kinds.values().map(|kind| {
            let factors: usize = kind.groups.values().map(BTreeMap::len).sum();
            let size = kind.parameters() + 1;
            factors * (8 * size * (size + 1) + 64) + kind.seen.len() * 24
        });
        size_of::<Self>() + kinds.sum::<usize>()
    }
}
