//! Hash of a run's numbers: detects damage, and runs that were written twice under any name.
//!
//! 128-bit XXH3 finds copies and accidental changes. It does not protect against deliberate
//! collisions.

use twox_hash::XxHash3_128;

use super::{
    packed::{rows, triangle, values},
    run::RunFactors,
};

/// Hash of a text.
pub(super) fn hash(bytes: &[u8]) -> String {
    format!("{:032x}", XxHash3_128::oneshot(bytes))
}

/// Hash of a run's equations, without its name and other metadata.
pub(super) fn content(run: &RunFactors) -> String {
    let mut bytes = Vec::new();
    text(&mut bytes, &run.settings_hash);
    text(
        &mut bytes,
        run.summary.payload_name.as_deref().unwrap_or(""),
    );
    bytes.push(u8::from(run.summary.payload));
    whole(&mut bytes, run.summary.samples);
    run.columns.iter().for_each(|name| text(&mut bytes, name));
    for model in &run.models {
        text(&mut bytes, model.model.name());
        let parts = match &model.parts {
            Ok(parts) => parts.as_slice(),
            Err(why) => {
                text(&mut bytes, why);
                &[]
            }
        };
        whole(&mut bytes, parts.len());
        for factor in parts.iter().flat_map(|part| &part.lines) {
            whole(&mut bytes, factor.equations());
            bytes.extend(triangle(factor.matrix()));
            bytes.extend(values(factor.sums()));
        }
        whole(&mut bytes, model.stretches.len());
        let lines = model.stretches.iter().flat_map(|stretch| &stretch.lines);
        lines.for_each(|own| bytes.extend(rows(own)));
    }
    hash(&bytes)
}

/// Appends a text, preceded by its length.
fn text(bytes: &mut Vec<u8>, text: &str) {
    whole(bytes, text.len());
    bytes.extend_from_slice(text.as_bytes());
}

fn whole(bytes: &mut Vec<u8>, value: usize) {
    bytes.extend_from_slice(&(value as u64).to_le_bytes());
}
