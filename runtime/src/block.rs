//! Blocks of samples for compiled robots: generated functions take one state; [`crate::Model`] hands
//! over slices of many.

use crate::{Error, SampleError};

/// An output as a flat slice, row-major.
pub trait Flat {
    /// The numbers.
    fn flat(&self) -> &[f64];
}

impl<const N: usize> Flat for [f64; N] {
    fn flat(&self) -> &[f64] {
        self
    }
}

impl<const R: usize, const C: usize> Flat for [[f64; C]; R] {
    fn flat(&self) -> &[f64] {
        self.as_flattened()
    }
}

/// The row of an input for a sample; an input of a single row serves all samples.
fn row<'a, const N: usize>(
    input: Option<&&'a [f64]>,
    sample: usize,
) -> Result<&'a [f64; N], Error> {
    let input: &'a [f64] = input.copied().unwrap_or_default();
    let start = if input.len() == N { 0 } else { sample * N };
    let rest = input.get(start..).unwrap_or_default();
    rest.first_chunk::<N>().ok_or(Error::Length {
        expected: start + N,
        found: input.len(),
    })
}

/// A slice as an array.
///
/// # Errors
/// [`Error::Length`].
pub fn array<const N: usize>(slice: &[f64]) -> Result<&[f64; N], Error> {
    slice.try_into().map_err(|_| Error::Length {
        expected: N,
        found: slice.len(),
    })
}

/// Writes an output into a slice of its length.
pub fn write(value: &impl Flat, out: &mut [f64]) {
    for (slot, value) in out.iter_mut().zip(value.flat()) {
        *slot = *value;
    }
}

/// Evaluates a function sample by sample; `size` is the number of its results.
fn each<O: Flat>(
    size: usize,
    output: &mut [f64],
    mut f: impl FnMut(usize) -> Result<O, Error>,
) -> Result<(), SampleError> {
    if size == 0 {
        return Ok(());
    }
    for (sample, out) in output.chunks_mut(size).enumerate() {
        let value = f(sample).map_err(|error| SampleError { sample, error })?;
        let value = value.flat();
        if out.len() != value.len() {
            let error = Error::Length {
                expected: value.len(),
                found: out.len(),
            };
            return Err(SampleError { sample, error });
        }
        out.copy_from_slice(value);
    }
    Ok(())
}

/// A function of one input.
///
/// # Errors
/// The first sample at which the function fails.
pub fn map1<const A: usize, O: Flat>(
    size: usize,
    inputs: &[&[f64]],
    output: &mut [f64],
    f: impl Fn(&[f64; A]) -> Result<O, Error>,
) -> Result<(), SampleError> {
    each(size, output, |i| f(row(inputs.first(), i)?))
}

/// A function of two inputs.
///
/// # Errors
/// The first sample at which the function fails.
pub fn map2<const A: usize, const B: usize, O: Flat>(
    size: usize,
    inputs: &[&[f64]],
    output: &mut [f64],
    f: impl Fn(&[f64; A], &[f64; B]) -> Result<O, Error>,
) -> Result<(), SampleError> {
    each(size, output, |i| {
        f(row(inputs.first(), i)?, row(inputs.get(1), i)?)
    })
}

/// A function of three inputs.
///
/// # Errors
/// The first sample at which the function fails.
pub fn map3<const A: usize, const B: usize, const C: usize, O: Flat>(
    size: usize,
    inputs: &[&[f64]],
    output: &mut [f64],
    f: impl Fn(&[f64; A], &[f64; B], &[f64; C]) -> Result<O, Error>,
) -> Result<(), SampleError> {
    each(size, output, |i| {
        f(
            row(inputs.first(), i)?,
            row(inputs.get(1), i)?,
            row(inputs.get(2), i)?,
        )
    })
}

/// A function of four inputs.
///
/// # Errors
/// The first sample at which the function fails.
pub fn map4<const A: usize, const B: usize, const C: usize, const D: usize, O: Flat>(
    size: usize,
    inputs: &[&[f64]],
    output: &mut [f64],
    f: impl Fn(&[f64; A], &[f64; B], &[f64; C], &[f64; D]) -> Result<O, Error>,
) -> Result<(), SampleError> {
    each(size, output, |i| {
        f(
            row(inputs.first(), i)?,
            row(inputs.get(1), i)?,
            row(inputs.get(2), i)?,
            row(inputs.get(3), i)?,
        )
    })
}
