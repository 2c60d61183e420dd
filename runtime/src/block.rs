//! Blocks of samples for compiled robots: generated functions take one state, [`crate::Model`]
//! passes slices of many.

use crate::float::Float;
use crate::{Error, Function, SampleError, Sizes};

/// An output as a flat slice, row-major.
pub trait Flat<T> {
    /// Number of elements.
    const LEN: usize;

    /// The elements.
    fn flat(&self) -> &[T];

    /// The first elements of a slice as an output, if there are enough.
    fn place(numbers: &mut [T]) -> Option<&mut Self>;
}

impl<T: Float, const N: usize> Flat<T> for [T; N] {
    const LEN: usize = N;

    fn flat(&self) -> &[T] {
        self
    }

    fn place(numbers: &mut [T]) -> Option<&mut Self> {
        numbers.first_chunk_mut()
    }
}

impl<T: Float, const R: usize, const C: usize> Flat<T> for [[T; C]; R] {
    const LEN: usize = R * C;

    fn flat(&self) -> &[T] {
        self.as_flattened()
    }

    fn place(numbers: &mut [T]) -> Option<&mut Self> {
        numbers.as_chunks_mut::<C>().0.first_chunk_mut()
    }
}

/// A slice as an array.
///
/// # Errors
/// [`Error::Length`].
pub fn array<T: Float, const N: usize>(slice: &[T]) -> Result<&[T; N], Error> {
    slice.try_into().map_err(|_| Error::Length {
        expected: N,
        found: slice.len(),
    })
}

/// Writes an output into a slice of its length.
pub fn write<T: Float>(value: &impl Flat<T>, out: &mut [T]) {
    for (slot, value) in out.iter_mut().zip(value.flat()) {
        *slot = *value;
    }
}

/// Number of samples in a call of [`crate::Model::evaluate`], from the length of the output.
///
/// Each input has to contain one row per sample, or one row for all.
///
/// # Errors
/// [`Error::Inputs`] or [`Error::Length`], for sample 0.
pub fn samples(
    function: Function,
    sizes: &Sizes,
    inputs: &[&[f64]],
    output: &[f64],
) -> Result<usize, SampleError> {
    let whole = |error| SampleError { sample: 0, error };
    let kinds = function.inputs();
    if inputs.len() != kinds.len() {
        return Err(whole(Error::Inputs {
            expected: kinds.len(),
            found: inputs.len(),
        }));
    }
    let length = |expected, found| whole(Error::Length { expected, found });
    let (rows, columns) = function.shape(sizes);
    let width = rows * columns;
    let samples = output.len().checked_div(width).unwrap_or(0);
    if output.len() != samples * width {
        let whole_samples = samples + usize::from(width > 0);
        return Err(length(whole_samples * width, output.len()));
    }
    for (kind, values) in kinds.iter().zip(inputs) {
        let row = sizes.of(*kind);
        if values.len() != row && values.len() != row * samples {
            return Err(length(row * samples, values.len()));
        }
    }
    Ok(samples)
}

/// Inputs and output of a call of [`crate::Model::evaluate`], with valid lengths.
#[derive(Debug)]
pub struct Block<'a> {
    inputs: &'a [&'a [f64]],
    output: &'a mut [f64],
}

/// The inputs of one sample.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    inputs: &'a [&'a [f64]],
    sample: usize,
}

impl<'a> Inputs<'a> {
    /// The row of an input; an input with a single row is shared by all samples.
    ///
    /// # Errors
    /// [`Error::Length`].
    pub fn row<const N: usize>(&self, input: usize) -> Result<&'a [f64; N], Error> {
        let input = self.inputs.get(input).copied().unwrap_or_default();
        let start = if input.len() == N { 0 } else { self.sample * N };
        let rest = input.get(start..).unwrap_or_default();
        rest.first_chunk::<N>().ok_or(Error::Length {
            expected: start + N,
            found: input.len(),
        })
    }
}

impl<'a> Block<'a> {
    /// A call of a function for a robot of these sizes.
    ///
    /// # Errors
    /// See [`samples`].
    pub fn new(
        function: Function,
        sizes: &Sizes,
        inputs: &'a [&'a [f64]],
        output: &'a mut [f64],
    ) -> Result<Self, SampleError> {
        samples(function, sizes, inputs, output)?;
        Ok(Self { inputs, output })
    }

    /// Evaluates a generated function sample by sample.
    ///
    /// # Errors
    /// The first sample at which the function fails.
    pub fn each<O: Flat<f64>>(
        self,
        function: impl Fn(Inputs<'a>) -> Result<O, Error>,
    ) -> Result<(), SampleError> {
        let inputs = self.inputs;
        // An output without elements has no samples.
        for (sample, out) in self.output.chunks_mut(O::LEN.max(1)).enumerate() {
            let value = function(Inputs { inputs, sample });
            let value = value.map_err(|error| SampleError { sample, error })?;
            write(&value, out);
        }
        Ok(())
    }

    /// Calls a generated function that writes its output, sample by sample.
    ///
    /// # Errors
    /// The first sample at which the function fails.
    pub fn fill<O: Flat<f64>>(
        self,
        function: impl Fn(Inputs<'a>, &mut O) -> Result<(), Error>,
    ) -> Result<(), SampleError> {
        let inputs = self.inputs;
        for (sample, out) in self.output.chunks_mut(O::LEN.max(1)).enumerate() {
            let length = Error::Length {
                expected: O::LEN,
                found: out.len(),
            };
            let place = O::place(out).ok_or(length);
            let filled = place.and_then(|place| function(Inputs { inputs, sample }, place));
            filled.map_err(|error| SampleError { sample, error })?;
        }
        Ok(())
    }
}
