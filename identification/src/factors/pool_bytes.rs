//! Pools as bytes, for transfer. Little-endian; counts have 8 bytes.

use std::collections::BTreeMap;

use super::{
    packed::{from_triangle, numbers, triangle, values},
    pool::{Pool, PoolError, PoolGroup},
    record::Rest,
};
use crate::regression::{factor::Factor, projection::ModelKind};

/// Magic bytes of a pool.
const MAGIC: [u8; 4] = *b"OAP1";

impl Pool {
    /// Adds records, or a pool, from bytes.
    ///
    /// # Errors
    /// A pool that is damaged, or has a run that this one has.
    pub fn take(&mut self, bytes: &[u8]) -> Result<(), PoolError> {
        if bytes.starts_with(&MAGIC) {
            self.merge(Self::from_bytes(bytes)?)
        } else {
            self.push(bytes);
            Ok(())
        }
    }

    /// The pool as bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut own = MAGIC.to_vec();
        // Limits are never zero, so zero encodes `None`.
        let limit = self.limit.unwrap_or(0) as u64;
        let counts = [limit, self.twice, self.damaged, self.others];
        counts.iter().for_each(|count| whole(&mut own, *count));
        whole(&mut own, self.kinds.len() as u64);
        for (key, kind) in &self.kinds {
            own.extend(key.to_le_bytes());
            own.extend(kind.settings_hash.to_le_bytes());
            text(&mut own, kind.model.name());
            whole(&mut own, u64::from(kind.load.is_some()));
            text(&mut own, kind.load.as_deref().unwrap_or(""));
            text(&mut own, &kind.columns);
            whole(&mut own, kind.line_names.len() as u64);
            for (line, name) in &kind.line_names {
                whole(&mut own, u64::from(*line));
                text(&mut own, name);
            }
            whole(&mut own, kind.seen.len() as u64);
            for (key, bits) in &kind.seen {
                whole(&mut own, *key);
                whole(&mut own, *bits);
            }
            whole(&mut own, u64::from(kind.bits));
            whole(&mut own, kind.groups.len() as u64);
            for (group, lines) in &kind.groups {
                whole(&mut own, *group);
                whole(&mut own, lines.len() as u64);
                for (line, factor) in lines {
                    whole(&mut own, u64::from(*line));
                    whole(&mut own, factor.equations() as u64);
                    own.extend(values(factor.sums()));
                    own.extend(triangle(factor.matrix()));
                }
            }
        }
        own
    }

    /// Decodes [`Pool::to_bytes`].
    ///
    /// # Errors
    /// Other bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, PoolError> {
        let mut rest = Rest(bytes.strip_prefix(&MAGIC).ok_or(PoolError::Damaged)?);
        let own = read(&mut rest).ok_or(PoolError::Damaged)?;
        if rest.0.is_empty() {
            Ok(own)
        } else {
            Err(PoolError::Damaged)
        }
    }
}

fn read(rest: &mut Rest<'_>) -> Option<Pool> {
    let mut own = match usize::try_from(count(rest)?).ok()? {
        0 => Pool::default(),
        limit => Pool::new(limit),
    };
    own.twice = count(rest)?;
    own.damaged = count(rest)?;
    own.others = count(rest)?;
    for _ in 0..count(rest)? {
        let key = u128::from_le_bytes(rest.array()?);
        own.kinds.insert(key, kind(rest)?);
    }
    Some(own)
}

fn kind(rest: &mut Rest<'_>) -> Option<PoolGroup> {
    let settings_hash = u128::from_le_bytes(rest.array()?);
    let name = words(rest)?;
    let models = [ModelKind::Platform, ModelKind::Actuators, ModelKind::Joints];
    let model = models.into_iter().find(|own| own.name() == name)?;
    let loaded = count(rest)? != 0;
    let load = words(rest)?;
    let mut own = PoolGroup {
        settings_hash,
        model,
        load: loaded.then_some(load),
        columns: words(rest)?,
        line_names: BTreeMap::new(),
        seen: BTreeMap::new(),
        bits: 0,
        groups: BTreeMap::new(),
    };
    let size = own.parameters() + 1;
    for _ in 0..count(rest)? {
        let line = u16::try_from(count(rest)?).ok()?;
        own.line_names.insert(line, words(rest)?);
    }
    for _ in 0..count(rest)? {
        own.seen.insert(count(rest)?, count(rest)?);
    }
    own.bits = u32::try_from(count(rest)?)
        .ok()
        .filter(|bits| (1..=u64::BITS).contains(bits))?;
    for _ in 0..count(rest)? {
        let group = count(rest)?;
        let mut lines = BTreeMap::new();
        for _ in 0..count(rest)? {
            let line = u16::try_from(count(rest)?).ok()?;
            let equations = usize::try_from(count(rest)?).ok()?;
            let sums = numbers(rest.take(8 * size)?, size)?;
            let matrix = from_triangle(rest.take(4 * size * (size + 1))?, size)?;
            lines.insert(line, Factor::of(matrix, equations, sums));
        }
        own.groups.insert(group, lines);
    }
    Some(own)
}

fn whole(bytes: &mut Vec<u8>, value: u64) {
    bytes.extend(value.to_le_bytes());
}

fn text(bytes: &mut Vec<u8>, text: &str) {
    whole(bytes, text.len() as u64);
    bytes.extend(text.as_bytes());
}

fn count(rest: &mut Rest<'_>) -> Option<u64> {
    Some(u64::from_le_bytes(rest.array()?))
}

fn words(rest: &mut Rest<'_>) -> Option<String> {
    let length = usize::try_from(count(rest)?).ok()?;
    rest.text(length)
}
