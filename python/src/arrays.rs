//! NumPy arrays as rows of numbers.
//!
//! C-contiguous float64 arrays are used without a copy; others are converted once. Values that are
//! not real arrays are rejected by name.

use numpy::{
    PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    intern,
    prelude::*,
};

/// An input: a row of numbers for each sample, or one row for all.
pub(crate) struct Rows<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
    name: String,
    width: usize,
}

impl<'py> Rows<'py> {
    /// Rows of a value with `width` numbers each; `what` describes them.
    ///
    /// # Errors
    /// A value that is not a real array, or has another shape.
    pub(crate) fn new(
        value: &Bound<'py, PyAny>,
        name: &str,
        (width, what): (usize, &str),
    ) -> PyResult<Self> {
        let array = match as_it_lies(value) {
            Some(array) => array,
            None => converted(value, name)?,
        };
        let shape = array.shape();
        if shape.last() != Some(&width) {
            return Err(wrong_shape(name, shape, width, what));
        }
        let array = array.try_readonly().map_err(|_| {
            PyValueError::new_err(format!("`{name}` is being written by another call"))
        })?;
        let name = name.to_owned();
        Ok(Self { array, name, width })
    }

    /// Shape of the samples; empty for a single row.
    fn samples(&self) -> &[usize] {
        self.array.shape().split_last().map_or(&[], |(_, all)| all)
    }

    /// All numbers, row-major.
    pub(crate) fn values(&self) -> PyResult<&[f64]> {
        Ok(self.array.as_slice()?)
    }

    /// Whether one row serves all samples.
    pub(crate) fn is_shared(&self) -> bool {
        self.array.ndim() == 1
    }

    /// Numbers per row.
    pub(crate) const fn width(&self) -> usize {
        self.width
    }
}

/// Common shape of all inputs with more than one row.
///
/// # Errors
/// Inputs of different shapes.
pub(crate) fn common_samples(inputs: &[Rows<'_>]) -> PyResult<Vec<usize>> {
    let mut found: Option<&Rows<'_>> = None;
    for input in inputs.iter().filter(|input| !input.is_shared()) {
        match found {
            None => found = Some(input),
            Some(first) if first.samples() == input.samples() => {}
            Some(first) => {
                return Err(PyValueError::new_err(format!(
                    "`{}` and `{}` have different samples: their shapes are {} and {}. A row for all samples has the shape ({},)",
                    first.name,
                    input.name,
                    shown(first.array.shape()),
                    shown(input.array.shape()),
                    input.width
                )));
            }
        }
    }
    Ok(found.map_or_else(Vec::new, |input| input.samples().to_vec()))
}

/// The array, if it can be read in place.
fn as_it_lies<'py>(value: &Bound<'py, PyAny>) -> Option<Bound<'py, PyArrayDyn<f64>>> {
    // Subclasses may give the same numbers another meaning.
    let array = value.cast::<PyArrayDyn<f64>>().ok()?;
    let is_plain = value.is_exact_instance_of::<PyUntypedArray>();
    let lies_right = is_plain && array.is_c_contiguous() && array.is_aligned();
    lies_right.then(|| array.clone())
}

/// Copy as float64, row-major.
fn converted<'py>(value: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let py = value.py();
    if value.hasattr(intern!(py, "mask"))? && value.hasattr(intern!(py, "filled"))? {
        return Err(PyTypeError::new_err(format!(
            "`{name}` is a masked array; fill it first, `{name}.filled(...)`"
        )));
    }
    let numpy = py.import(intern!(py, "numpy"))?;
    let array = numpy
        .call_method1(intern!(py, "asarray"), (value,))
        .map_err(|error| {
            PyTypeError::new_err(format!("`{name}` is not an array of numbers: {error}"))
        })?;
    let kind = array.getattr("dtype")?.getattr("kind")?;
    if !matches!(kind.extract::<&str>()?, "f" | "i" | "u" | "b") {
        return Err(PyTypeError::new_err(format!(
            "`{name}` has the dtype {}; expected are real numbers (float64)",
            array.getattr("dtype")?.str()?
        )));
    }
    let wanted = numpy.getattr("float64")?;
    let array = numpy.call_method1(intern!(py, "require"), (array, wanted, "CA"))?;
    Ok(array.cast_into::<PyArrayDyn<f64>>()?)
}

fn wrong_shape(name: &str, shape: &[usize], width: usize, what: &str) -> PyErr {
    let hint = match shape {
        [_] if width == 1 => {
            format!("; one number per sample has the shape (N, 1): `{name}[:, None]`")
        }
        [first, .., _] if *first == width => format!("; is it transposed? `{name}.T`"),
        _ => String::new(),
    };
    let numbers = if width == 1 { "number" } else { "numbers" };
    PyValueError::new_err(format!(
        "`{name}` has the shape {}, but its last axis must have {width} {numbers}{what}{hint}",
        shown(shape)
    ))
}

/// Output array: the caller's, or a new one.
///
/// # Errors
/// An array that is not float64, C-contiguous, writable and of the right shape.
pub(crate) fn output<'py>(
    py: Python<'py>,
    given: Option<&Bound<'py, PyAny>>,
    shape: &[usize],
) -> PyResult<PyReadwriteArrayDyn<'py, f64>> {
    let array = match given {
        None => py
            .import(intern!(py, "numpy"))?
            .call_method1(intern!(py, "empty"), (shape.to_vec(),))?
            .cast_into::<PyArrayDyn<f64>>()?,
        Some(given) => right_output(given, shape)?,
    };
    array.try_readwrite().map_err(|error| {
        PyValueError::new_err(format!(
            "`out` can't be written: {error}; it may be read-only, or share memory with an input"
        ))
    })
}

fn right_output<'py>(
    given: &Bound<'py, PyAny>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let Ok(array) = given.cast::<PyArrayDyn<f64>>() else {
        let found = match given.getattr("dtype") {
            Ok(dtype) => format!("an array of {}", dtype.str()?),
            Err(_) => format!("a {}", given.get_type().name()?),
        };
        return Err(PyTypeError::new_err(format!(
            "`out` must be an array of float64, not {found}"
        )));
    };
    if array.shape() != shape {
        return Err(PyValueError::new_err(format!(
            "`out` has the shape {}, but the result has {}",
            shown(array.shape()),
            shown(shape)
        )));
    }
    if !(array.is_c_contiguous() && array.is_aligned()) {
        return Err(PyValueError::new_err(
            "`out` must be contiguous in memory (C order)",
        ));
    }
    Ok(array.clone())
}

/// Shape in Python notation.
pub(crate) fn shown(shape: &[usize]) -> String {
    let parts: Vec<String> = shape.iter().map(ToString::to_string).collect();
    match parts.as_slice() {
        [one] => format!("({one},)"),
        all => format!("({})", all.join(", ")),
    }
}
