//! Estimates, deviations and covariance of the filter on slices.

use super::super::{Error, triangle};
use super::SliceFilter;
use crate::float::Float;

impl<T: Float> SliceFilter<'_, T> {
    /// Writes the estimate χ = R⁻¹ z.
    ///
    /// # Errors
    /// [`Error::NotDetermined`] before R is regular, [`Error::Overflow`], or [`Error::Length`].
    pub fn estimate(&self, estimate: &mut [T]) -> Result<(), Error> {
        self.check_output(estimate)?;
        if triangle::solve(self.factor, self.side, estimate) {
            Ok(())
        } else {
            Err(Error::Overflow)
        }
    }

    /// Writes the standard deviations, the roots of the diagonal of R⁻¹R⁻ᵀ.
    ///
    /// # Errors
    /// As [`estimate`](Self::estimate).
    pub fn standard_deviations(&mut self, deviations: &mut [T]) -> Result<(), Error> {
        self.check_output(deviations)?;
        if triangle::standard_deviations(self.factor, self.work, deviations) {
            Ok(())
        } else {
            Err(Error::Overflow)
        }
    }

    /// Writes the covariance R⁻¹R⁻ᵀ, p² numbers.
    ///
    /// # Errors
    /// As [`estimate`](Self::estimate).
    ///
    /// ```
    /// use overact::online::SliceFilter;
    ///
    /// let (mut factor, mut vectors) = (vec![0.0; 4], vec![0.0; 8]);
    /// let mut filter = SliceFilter::without_prior(&mut factor, &mut vectors)?;
    /// filter.update(&[1.0, 1.0], 0.0, 1.0)?;
    /// filter.update(&[0.0, 1.0], 0.0, 1.0)?;
    /// let mut covariance = [0.0; 4];
    /// filter.covariance(&mut covariance)?;
    /// assert_eq!(covariance, [2.0, -1.0, -1.0, 1.0]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn covariance(&mut self, covariance: &mut [T]) -> Result<(), Error> {
        let count = self.side.len();
        let (expected, found) = (count * count, covariance.len());
        if expected != found {
            return Err(Error::Length { expected, found });
        }
        if !self.status.is_regular {
            return Err(Error::NotDetermined);
        }
        for (place, column) in (0..count).zip(covariance.chunks_exact_mut(count.max(1))) {
            triangle::inverse_row(self.factor, place, column);
        }
        // Rows of R⁻¹ are zero before the diagonal, so each row is overwritten after its last use.
        for place in 0..count {
            let mut rows = covariance.chunks_exact_mut(count.max(1)).skip(place);
            let Some(own) = rows.next() else { break };
            for (to, from) in self.row.iter_mut().zip(own.iter()) {
                *to = *from;
            }
            let mut entries = own.iter_mut().skip(place);
            if let Some(entry) = entries.next() {
                *entry = self.row.iter().map(|x| *x * *x).sum();
            }
            for (entry, other) in entries.zip(rows) {
                *entry = self.row.iter().zip(other).map(|(a, b)| *a * *b).sum();
            }
        }
        for row in 0..count {
            for column in 0..row {
                let upper = covariance.get(column * count + row).copied();
                let lower = covariance.get_mut(row * count + column);
                if let (Some(upper), Some(lower)) = (upper, lower) {
                    *lower = upper;
                }
            }
        }
        if covariance.iter().all(|entry| entry.is_finite()) {
            Ok(())
        } else {
            Err(Error::Overflow)
        }
    }

    /// The triangle R, row by row, and the right side z, with R χ = z.
    #[must_use]
    pub const fn factor(&self) -> (&[T], &[T]) {
        (self.factor, self.side)
    }

    /// Writes the estimates and standard deviations of the parameters that the rows determine.
    ///
    /// The others are NaN. A parameter counts as determined if its estimate depends on no
    /// undetermined one, in the order of the columns. So put columns that are excited late, such as
    /// those of a payload, last.
    ///
    /// # Errors
    /// [`Error::Length`].
    ///
    /// ```
    /// use overact::online::SliceFilter;
    ///
    /// let (mut factor, mut vectors) = (vec![0.0; 4], vec![0.0; 8]);
    /// let mut filter = SliceFilter::without_prior(&mut factor, &mut vectors)?;
    /// filter.update(&[2.0, 0.0], 6.0, 1.0)?;
    /// let (mut values, mut deviations) = ([0.0_f64; 2], [0.0_f64; 2]);
    /// filter.determined(&mut values, &mut deviations)?;
    /// assert_eq!((values[0], deviations[0]), (3.0, 0.5));
    /// assert!(values[1].is_nan() && deviations[1].is_nan());
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn determined(&mut self, values: &mut [T], deviations: &mut [T]) -> Result<(), Error> {
        self.check_length(values)?;
        self.check_length(deviations)?;
        triangle::solve_determined(self.factor, self.side, values);
        for (place, (value, deviation)) in values.iter_mut().zip(deviations).enumerate() {
            *deviation = T::NAN;
            if !value.is_finite() {
                *value = T::NAN;
            } else if triangle::inverse_row(self.factor, place, self.work) {
                let squares = self.work.iter().skip(place).map(|u| *u * *u);
                *deviation = squares.sum::<T>().sqrt();
            }
        }
        Ok(())
    }

    /// Checks that there is an estimate and that it has the length of a slice.
    fn check_output(&self, output: &[T]) -> Result<(), Error> {
        self.check_length(output)?;
        if self.status.is_regular {
            Ok(())
        } else {
            Err(Error::NotDetermined)
        }
    }
}
