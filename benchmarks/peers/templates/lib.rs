//! Generated models to be timed.

/// Result of a model, with or without a check of the configuration.
pub trait Output {
    /// The numbers, row by row.
    fn numbers(&self) -> Result<Vec<f64>, overact::Error>;
}

impl<const R: usize, const C: usize> Output for [[f64; C]; R] {
    fn numbers(&self) -> Result<Vec<f64>, overact::Error> {
        Ok(self.as_flattened().to_vec())
    }
}

impl<const N: usize> Output for [f64; N] {
    fn numbers(&self) -> Result<Vec<f64>, overact::Error> {
        Ok(self.to_vec())
    }
}

/// For a function that writes into the caller's matrix.
impl Output for () {
    fn numbers(&self) -> Result<Vec<f64>, overact::Error> {
        Ok(Vec::new())
    }
}

impl<T: Output> Output for Result<T, overact::Error> {
    fn numbers(&self) -> Result<Vec<f64>, overact::Error> {
        self.as_ref().map_err(Clone::clone)?.numbers()
    }
}

