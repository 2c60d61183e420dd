//! The information filter with arrays of its own.

use super::slices::Status;
use super::{Error, Forgetting, Innovation, SliceFilter, bounds, triangle};
use crate::float::Float;

/// Square-root information filter for P parameters.
///
/// Its state is an upper triangular R (P × P) and z (P) with R χ = z; the covariance of χ is
/// R⁻¹R⁻ᵀ. Each row takes about 2 P² multiplications.
///
/// ```
/// use overact::online::Filter;
///
/// // y = 2 a + b, measured with a standard deviation of 0.1.
/// let mut filter = Filter::<2>::from_standard_deviations(&[0.0, 0.0], &[100.0, 100.0])?;
/// for step in 0..1000 {
///     let a = f64::from(step % 7);
///     filter.update(&[a, 1.0], 2.0 * a + 1.0, 0.1)?;
/// }
/// let [slope, offset] = filter.estimate()?;
/// assert!((slope - 2.0).abs() < 1e-4 && (offset - 1.0).abs() < 1e-4);
/// assert!(filter.standard_deviations()?[0] < 0.002);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter<const P: usize, T = f64> {
    factor: [[T; P]; P],
    side: [T; P],
    floors: [T; P],
    status: Status<T>,
}

impl<const P: usize, T: Float> Filter<P, T> {
    /// A filter with a prior estimate and a square root S of its information, SᵀS = Λ.
    ///
    /// S may be any regular P × P matrix, for example the triangular factor of an earlier
    /// identification with rows over their standard deviations.
    ///
    /// # Errors
    /// [`Error::NotPositiveDefinite`] if S is singular, [`Error::NotFinite`] or
    /// [`Error::OutOfRange`] for other numbers.
    ///
    /// ```
    /// use overact::online::{Error, Filter};
    ///
    /// let filter = Filter::new([1.0, 2.0], [[2.0, 0.0], [0.0, 4.0]])?;
    /// assert_eq!(filter.estimate()?, [1.0, 2.0]);
    /// assert_eq!(filter.standard_deviations()?, [0.5, 0.25]);
    /// let singular = Filter::new([1.0, 2.0], [[1.0, 1.0], [1.0, 1.0]]);
    /// assert_eq!(singular, Err(Error::NotPositiveDefinite));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn new(prior: [T; P], square_root_information: [[T; P]; P]) -> Result<Self, Error> {
        let mut filter = Self::without_prior();
        filter.change(|slices| slices.add_prior(&prior, square_root_information.as_flattened()))?;
        Ok(filter)
    }

    /// A filter with a prior of independent parameters with these standard deviations.
    ///
    /// # Errors
    /// Standard deviations that are not positive and finite.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let filter = Filter::<1>::from_standard_deviations(&[3.0], &[0.5])?;
    /// assert_eq!(filter.covariance()?, [[0.25]]);
    /// assert!(Filter::<1>::from_standard_deviations(&[3.0], &[0.0]).is_err());
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn from_standard_deviations(prior: &[T; P], deviations: &[T; P]) -> Result<Self, Error> {
        let mut square_root = [[T::ZERO; P]; P];
        for (place, (row, deviation)) in square_root.iter_mut().zip(deviations).enumerate() {
            let weight = bounds::weight(*deviation).map_err(|_| Error::NotPositiveDefinite)?;
            row.iter_mut().skip(place).take(1).for_each(|s| *s = weight);
        }
        Self::new(*prior, square_root)
    }

    /// A filter with a prior estimate and its covariance, of which the lower triangle is read.
    ///
    /// With the Cholesky factor L of the covariance, S = L⁻¹.
    ///
    /// # Errors
    /// [`Error::NotPositiveDefinite`], also for numbers that are not finite.
    ///
    /// ```
    /// use overact::online::{Error, Filter};
    ///
    /// let covariance = [[4.0, 1.0], [1.0, 1.0]];
    /// let filter = Filter::from_covariance([0.0, 0.0], covariance)?;
    /// assert!((filter.covariance()?[1][0] - 1.0_f64).abs() < 1e-14);
    /// let indefinite = Filter::from_covariance([0.0, 0.0], [[1.0, 2.0], [2.0, 1.0]]);
    /// assert_eq!(indefinite, Err(Error::NotPositiveDefinite));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn from_covariance(prior: [T; P], covariance: [[T; P]; P]) -> Result<Self, Error> {
        let lower = cholesky(&covariance).ok_or(Error::NotPositiveDefinite)?;
        let mut inverse = [[T::ZERO; P]; P];
        for place in 0..P {
            // Column `place` of L⁻¹, from L x = e.
            let mut column = [T::ZERO; P];
            let rows = lower.iter().enumerate().skip(place);
            for (row, entries) in rows {
                let known = entries.iter().zip(&column).take(row).map(|(l, x)| *l * *x);
                let mut rest = -known.sum::<T>();
                if row == place {
                    rest += T::of(1.0);
                }
                let diagonal = entries.get(row).copied().unwrap_or(T::ZERO);
                column
                    .iter_mut()
                    .skip(row)
                    .take(1)
                    .for_each(|x| *x = rest / diagonal);
            }
            for (row, x) in inverse.iter_mut().zip(&column) {
                row.iter_mut().skip(place).take(1).for_each(|to| *to = *x);
            }
        }
        Self::new(prior, inverse)
    }

    /// A filter that knows nothing: [`estimate`](Self::estimate) returns an error until the rows
    /// determine all parameters.
    ///
    /// ```
    /// use overact::online::{Error, Filter};
    ///
    /// let mut filter = Filter::<2>::without_prior();
    /// filter.update(&[1.0, 1.0], 3.0, 1.0)?;
    /// assert_eq!(filter.estimate(), Err(Error::NotDetermined));
    /// filter.update(&[1.0, 0.0], 1.0, 1.0)?;
    /// assert!(filter.estimate().is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub const fn without_prior() -> Self {
        Self {
            factor: [[T::ZERO; P]; P],
            side: [T::ZERO; P],
            floors: [T::ZERO; P],
            status: Status::new(P == 0),
        }
    }

    /// The filter with a rule of forgetting; see [`Forgetting`].
    ///
    /// # Errors
    /// [`Error::Setting`] for a factor outside (0, 1].
    ///
    /// ```
    /// use overact::online::{Filter, Forgetting};
    ///
    /// let filter = Filter::<3>::without_prior();
    /// assert!(filter.with_forgetting(Forgetting::Exponential(0.999)).is_ok());
    /// assert!(filter.with_forgetting(Forgetting::Exponential(1.5)).is_err());
    /// ```
    pub fn with_forgetting(mut self, forgetting: Forgetting<T>) -> Result<Self, Error> {
        self.status.forgetting = forgetting.check()?;
        Ok(self)
    }

    /// Adds one row: w χ = y with the standard deviation σ of y.
    ///
    /// # Errors
    /// Numbers that are not finite or too large, or a σ that is not positive. The state is then
    /// unchanged.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::from_standard_deviations(&[0.0], &[1.0])?;
    /// let before = filter;
    /// assert!(filter.update(&[f64::INFINITY], 0.0, 1.0).is_err());
    /// assert_eq!(filter, before);
    /// filter.update(&[1.0], 2.0, 1.0)?;
    /// assert!((filter.estimate()?[0] - 1.0_f64).abs() < 1e-15);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[inline]
    pub fn update(&mut self, row: &[T; P], y: T, sigma: T) -> Result<Innovation<T>, Error> {
        self.change(|slices| slices.update(row, y, sigma))
    }

    /// Adds the rows of one sample, for example one per joint.
    ///
    /// Exponential forgetting acts once. An innovation compares a row with all rows before it, so
    /// the innovations of a block are independent of each other.
    ///
    /// # Errors
    /// As [`update`](Self::update), for any of the rows. The state is then unchanged.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<2>::without_prior();
    /// filter.update_block(&[[1.0, 0.0], [1.0, 2.0]], &[1.0, 5.0], &[0.1, 0.2])?;
    /// let [a, b] = filter.estimate()?;
    /// assert!((a - 1.0_f64).abs() < 1e-12 && (b - 2.0_f64).abs() < 1e-12);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update_block<const M: usize>(
        &mut self,
        rows: &[[T; P]; M],
        y: &[T; M],
        sigma: &[T; M],
    ) -> Result<[Innovation<T>; M], Error> {
        self.change(|slices| {
            for ((row, y), sigma) in rows.iter().zip(y).zip(sigma) {
                slices.check(row, *y, *sigma)?;
            }
            slices.begin();
            let mut innovations = [Innovation::undetermined(); M];
            let inputs = rows.iter().zip(y).zip(sigma);
            for (innovation, ((row, y), sigma)) in innovations.iter_mut().zip(inputs) {
                *innovation = slices.add(row, *y, *sigma)?;
            }
            Ok(innovations)
        })
    }

    /// Adds the rows of one sample, whose number is known at run time, and writes the innovations.
    ///
    /// # Errors
    /// As [`update_block`](Self::update_block); [`Error::Length`] of slices of different lengths.
    ///
    /// ```
    /// use overact::online::{Filter, Innovation};
    ///
    /// let mut filter = Filter::<1>::from_standard_deviations(&[0.0], &[10.0])?;
    /// let mut innovations = [Innovation::default(); 2];
    /// filter.update_slices(&[[1.0], [2.0]], &[3.0, 6.0], &[0.1, 0.1], &mut innovations)?;
    /// assert!((filter.estimate()?[0] - 3.0_f64).abs() < 1e-3);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update_slices(
        &mut self,
        rows: &[[T; P]],
        y: &[T],
        sigma: &[T],
        innovations: &mut [Innovation<T>],
    ) -> Result<(), Error> {
        self.change(|slices| slices.update_block(rows.as_flattened(), y, sigma, innovations))
    }

    /// Multiplies all information by a factor in (0, 1], for example after a detected change.
    ///
    /// The estimate stays the same. Standard deviations grow by 1/√factor, up to those of the
    /// prior.
    ///
    /// # Errors
    /// [`Error::Setting`] for another factor.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::from_standard_deviations(&[0.0], &[1.0])?;
    /// filter.update(&[1.0], 2.0, 0.01)?;
    /// filter.discount(0.01)?;
    /// assert!((filter.standard_deviations()?[0] - 0.1_f64).abs() < 1e-4);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn discount(&mut self, factor: T) -> Result<(), Error> {
        self.change(|slices| slices.discount(factor))
    }

    /// The estimate χ = R⁻¹ z.
    ///
    /// # Errors
    /// [`Error::NotDetermined`] without prior before the rows determine all parameters;
    /// [`Error::Overflow`] of an estimate that is not finite.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::without_prior();
    /// filter.update(&[2.0], 6.0, 1.0)?;
    /// assert_eq!(filter.estimate()?, [3.0]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn estimate(&self) -> Result<[T; P], Error> {
        if !self.status.is_regular {
            return Err(Error::NotDetermined);
        }
        let mut estimate = [T::ZERO; P];
        if triangle::solve(self.factor.as_flattened(), &self.side, &mut estimate) {
            Ok(estimate)
        } else {
            Err(Error::Overflow)
        }
    }

    /// The standard deviations, in the units of the parameters.
    ///
    /// # Errors
    /// As [`estimate`](Self::estimate).
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::without_prior();
    /// filter.update(&[2.0], 6.0, 0.5)?;
    /// assert_eq!(filter.standard_deviations()?, [0.25]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn standard_deviations(&self) -> Result<[T; P], Error> {
        if !self.status.is_regular {
            return Err(Error::NotDetermined);
        }
        let (mut deviations, mut work) = ([T::ZERO; P], [T::ZERO; P]);
        let factor = self.factor.as_flattened();
        if triangle::standard_deviations(factor, &mut work, &mut deviations) {
            Ok(deviations)
        } else {
            Err(Error::Overflow)
        }
    }

    /// The covariance R⁻¹R⁻ᵀ (P × P).
    ///
    /// # Errors
    /// As [`estimate`](Self::estimate).
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<2>::without_prior();
    /// filter.update_block(&[[1.0, 1.0], [0.0, 1.0]], &[0.0, 0.0], &[1.0, 1.0])?;
    /// assert_eq!(filter.covariance()?, [[2.0, -1.0], [-1.0, 1.0]]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn covariance(&self) -> Result<[[T; P]; P], Error> {
        if !self.status.is_regular {
            return Err(Error::NotDetermined);
        }
        let mut inverse = [[T::ZERO; P]; P];
        for (place, row) in inverse.iter_mut().enumerate() {
            triangle::inverse_row(self.factor.as_flattened(), place, row);
        }
        let mut covariance = [[T::ZERO; P]; P];
        for (row, own) in covariance.iter_mut().zip(&inverse) {
            for (entry, other) in row.iter_mut().zip(&inverse) {
                *entry = own.iter().zip(other).map(|(a, b)| *a * *b).sum();
                if !entry.is_finite() {
                    return Err(Error::Overflow);
                }
            }
        }
        Ok(covariance)
    }

    /// The triangle R and the right side z, with R χ = z.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::without_prior();
    /// filter.update(&[3.0], 6.0, 1.0)?;
    /// assert_eq!(filter.factor(), (&[[3.0]], &[6.0]));
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[must_use]
    pub const fn factor(&self) -> (&[[T; P]; P], &[T; P]) {
        (&self.factor, &self.side)
    }

    /// Standard deviation of the normalised residuals so far, which is 1 if every σ is right.
    ///
    /// Without prior and forgetting, its square times σ² is the residual variance of batch least
    /// squares, the sum of squares over rows minus P.
    ///
    /// ```
    /// use overact::online::Filter;
    ///
    /// let mut filter = Filter::<1>::without_prior();
    /// for y in [1.0, 3.0] {
    ///     filter.update(&[1.0], y, 1.0)?;
    /// }
    /// let deviation: f64 = filter.residual_deviation().unwrap();
    /// assert!((deviation - 2.0_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[must_use]
    pub fn residual_deviation(&self) -> Option<T> {
        self.status.residual_deviation()
    }

    /// Runs a computation on the arrays as slices.
    #[inline]
    fn change<O>(&mut self, compute: impl FnOnce(&mut SliceFilter<'_, T>) -> O) -> O {
        let (mut row, mut work) = ([T::ZERO; P], [T::ZERO; P]);
        let mut slices = SliceFilter::on(
            self.factor.as_flattened_mut(),
            &mut self.side,
            &mut self.floors,
            &mut row,
            &mut work,
            self.status,
        );
        let result = compute(&mut slices);
        self.status = slices.status();
        result
    }
}

/// L with L Lᵀ = A of a symmetric A, whose lower triangle is read; `None` unless A is positive
/// definite within rounding.
fn cholesky<const P: usize, T: Float>(matrix: &[[T; P]; P]) -> Option<[[T; P]; P]> {
    let mut lower = [[T::ZERO; P]; P];
    for (place, entries) in matrix.iter().enumerate() {
        let mut row = [T::ZERO; P];
        for (column, other) in lower.iter().enumerate().take(place) {
            let known = row.iter().zip(other).take(column).map(|(a, b)| *a * *b);
            let rest = *entries.get(column)? - known.sum::<T>();
            *row.get_mut(column)? = rest / *other.get(column)?;
        }
        let square = row.iter().take(place).map(|x| *x * *x).sum::<T>();
        let diagonal = *entries.get(place)?;
        let rest = diagonal - square;
        if !(rest > T::of(T::LIMITS.pivot) * diagonal && rest.is_finite()) {
            return None;
        }
        *row.get_mut(place)? = rest.sqrt();
        *lower.get_mut(place)? = row;
    }
    Some(lower)
}
