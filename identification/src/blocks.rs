//! Evaluation of a model over all samples of a run, in blocks and in parallel.

use overact::{Function, Input, Model, SampleError};
use rayon::prelude::*;

/// Samples per evaluation: enough for vector units, few enough for the cache.
pub(crate) const BLOCK: usize = 128;

/// Evaluates `function` at all samples.
///
/// `inputs` have one row per sample, except [`Input::Parameters`] and [`Input::BaseParameters`].
pub(crate) fn evaluate(
    model: &dyn Model,
    function: Function,
    inputs: &[&[f64]],
    samples: usize,
) -> Result<Vec<f64>, SampleError> {
    let sizes = model.info().sizes;
    let (rows, columns) = function.shape(&sizes);
    let width = rows * columns;
    let mut output = vec![0.0; width * samples];
    if width == 0 {
        return Ok(output);
    }
    output
        .par_chunks_mut(width * BLOCK)
        .enumerate()
        .try_for_each(|(block, output)| {
            let first = block * BLOCK;
            let count = output.len() / width;
            let inputs: Vec<&[f64]> = function
                .inputs()
                .iter()
                .zip(inputs)
                .map(|(input, values)| match input {
                    Input::Parameters | Input::BaseParameters => values,
                    input => slice(values, sizes.of(*input), first, count),
                })
                .collect();
            model
                .evaluate(function, &inputs, output)
                .map_err(|error| SampleError {
                    sample: first + error.sample,
                    error: error.error,
                })
        })?;
    Ok(output)
}

/// The rows of `count` samples from sample `first` on; empty if out of range.
pub(crate) fn slice(values: &[f64], width: usize, first: usize, count: usize) -> &[f64] {
    values
        .get(first * width..(first + count) * width)
        .unwrap_or(&[])
}
