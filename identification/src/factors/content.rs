//! A hash of a run's numbers: by it a run that was written twice is known, under whatever name, and damage.
//!
//! XXH3 of 128 bits finds copies and accidents. It is no protection against someone who wants two runs to
//! look alike.

use twox_hash::XxHash3_128;

use super::{
    packed::{rows, triangle, values},
    run::RunFactors,
};

/// The hash of a text.
pub(super) fn hash(bytes: &[u8]) -> String {
    format!("{:032x}", XxHash3_128::oneshot(bytes))
}

/// The hash of the numbers of a run: of all that its equations are, and neither of its name nor of what was
/// told beside it.
pub(super) fn content(run: &RunFactors) -> String {
    let mut bytes = Vec::new();
    text(&mut bytes, &run.like);
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

/// A text and where it ends.
fn text(bytes: &mut Vec<u8>, text: &str) {
    whole(bytes, text.len());
    bytes.extend_from_slice(text.as_bytes());
}

fn whole(bytes: &mut Vec<u8>, value: usize) {
    bytes.extend_from_slice(&(value as u64).to_le_bytes());
}
