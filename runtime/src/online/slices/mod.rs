//! The information filter on slices of the caller.

mod outputs;

use super::{Error, Forgetting, Innovation, bounds, triangle};
use crate::float::Float;

/// Numbers of a filter other than R and z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Status<T> {
    /// How old information loses weight.
    pub(super) forgetting: Forgetting<T>,
    /// Sum of squares of the normalised residuals.
    pub(super) squares: T,
    /// Number of rows, each with its remaining weight.
    pub(super) rows: T,
    /// Whether R has been regular.
    pub(super) is_regular: bool,
}

impl<T: Float> Status<T> {
    /// A filter without rows and without forgetting.
    pub(super) const fn new(is_regular: bool) -> Self {
        Self {
            forgetting: Forgetting::None,
            squares: T::ZERO,
            rows: T::ZERO,
            is_regular,
        }
    }

    /// Standard deviation of the normalised residuals.
    pub(super) fn residual_deviation(&self) -> Option<T> {
        (self.rows > T::of(0.5)).then(|| (self.squares / self.rows).sqrt())
    }
}

/// Numbers of a [`SliceFilter`] that are not in its slices, to continue it later.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilterState<T = f64>(Status<T>);

/// Square-root information filter in slices, for a number of parameters known at run time.
///
/// It is the computation of [`Filter`](super::Filter), which has arrays of its own. p parameters
/// need slices of [`lengths`](Self::lengths): p² numbers of R, p of z, p floors of the diagonal,
/// and 2 p of working memory.
///
/// ```
/// use overact::online::SliceFilter;
///
/// let (mut factor, mut vectors) = (vec![0.0; 4], vec![0.0; 8]);
/// let mut filter = SliceFilter::without_prior(&mut factor, &mut vectors)?;
/// filter.update(&[1.0, 0.0], 2.0, 1.0)?;
/// filter.update(&[1.0, 1.0], 5.0, 1.0)?;
/// let mut estimate = [0.0; 2];
/// filter.estimate(&mut estimate)?;
/// assert!((estimate[1] - 3.0_f64).abs() < 1e-12);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug)]
pub struct SliceFilter<'a, T = f64> {
    factor: &'a mut [T],
    side: &'a mut [T],
    floors: &'a mut [T],
    row: &'a mut [T],
    work: &'a mut [T],
    status: Status<T>,
}

impl<'a, T: Float> SliceFilter<'a, T> {
    /// Lengths of the two slices for a number of parameters: p² and 4 p.
    ///
    /// ```
    /// use overact::online::SliceFilter;
    ///
    /// assert_eq!(SliceFilter::<f64>::lengths(10), [100, 40]);
    /// ```
    #[must_use]
    pub const fn lengths(parameters: usize) -> [usize; 2] {
        [parameters * parameters, 4 * parameters]
    }

    /// A filter that knows nothing. The slices are overwritten.
    ///
    /// # Errors
    /// [`Error::Length`] of slices that do not belong to one number of parameters.
    pub fn without_prior(factor: &'a mut [T], vectors: &'a mut [T]) -> Result<Self, Error> {
        Self::check_slices(factor, vectors)?;
        let parameters = vectors.len() / 4;
        factor.fill(T::ZERO);
        vectors.fill(T::ZERO);
        Self::split(factor, vectors, Status::new(parameters == 0))
    }

    /// A filter with a prior estimate and a square root S of its information, SᵀS = Λ, row by row.
    ///
    /// The slices are overwritten.
    ///
    /// # Errors
    /// [`Error::Length`], or as [`Filter::new`](super::Filter::new).
    ///
    /// ```
    /// use overact::online::SliceFilter;
    ///
    /// let (mut factor, mut vectors) = (vec![0.0; 1], vec![0.0; 4]);
    /// let mut filter = SliceFilter::with_prior(&mut factor, &mut vectors, &[3.0], &[2.0])?;
    /// let mut deviation = [0.0_f64];
    /// filter.standard_deviations(&mut deviation)?;
    /// assert_eq!(deviation, [0.5]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn with_prior(
        factor: &'a mut [T],
        vectors: &'a mut [T],
        prior: &[T],
        square_root_information: &[T],
    ) -> Result<Self, Error> {
        let mut filter = Self::without_prior(factor, vectors)?;
        filter.check_length(prior)?;
        let (expected, found) = (filter.factor.len(), square_root_information.len());
        if expected != found {
            return Err(Error::Length { expected, found });
        }
        filter.add_prior(prior, square_root_information)?;
        Ok(filter)
    }

    /// Continues a filter with its slices and [`state`](Self::state), which must not have changed.
    ///
    /// # Errors
    /// [`Error::Length`] of slices that do not belong to one number of parameters.
    ///
    /// ```
    /// use overact::online::SliceFilter;
    ///
    /// let (mut factor, mut vectors) = (vec![0.0; 1], vec![0.0; 4]);
    /// let state = SliceFilter::without_prior(&mut factor, &mut vectors)?.state();
    /// let mut filter = SliceFilter::resume(&mut factor, &mut vectors, state)?;
    /// filter.update(&[2.0], 6.0, 1.0)?;
    /// let mut estimate = [0.0];
    /// filter.estimate(&mut estimate)?;
    /// assert_eq!(estimate, [3.0]);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn resume(
        factor: &'a mut [T],
        vectors: &'a mut [T],
        state: FilterState<T>,
    ) -> Result<Self, Error> {
        Self::check_slices(factor, vectors)?;
        Self::split(factor, vectors, state.0)
    }

    /// The numbers that are not in the slices.
    #[must_use]
    pub const fn state(&self) -> FilterState<T> {
        FilterState(self.status)
    }

    fn check_slices(factor: &[T], vectors: &[T]) -> Result<(), Error> {
        let [squared, all] = Self::lengths(vectors.len() / 4);
        for (expected, found) in [(all, vectors.len()), (squared, factor.len())] {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        Ok(())
    }

    /// A filter with numbers of an earlier one.
    fn split(factor: &'a mut [T], vectors: &'a mut [T], status: Status<T>) -> Result<Self, Error> {
        let parameters = vectors.len() / 4;
        let mut parts = vectors.chunks_exact_mut(parameters.max(1));
        let mut next = || parts.next().unwrap_or_default();
        Ok(Self {
            factor,
            side: next(),
            floors: next(),
            row: next(),
            work: next(),
            status,
        })
    }

    /// A filter on the arrays of a [`Filter`](super::Filter).
    pub(super) const fn on(
        factor: &'a mut [T],
        side: &'a mut [T],
        floors: &'a mut [T],
        row: &'a mut [T],
        work: &'a mut [T],
        status: Status<T>,
    ) -> Self {
        Self {
            factor,
            side,
            floors,
            row,
            work,
            status,
        }
    }

    /// Numbers other than R and z.
    pub(super) const fn status(&self) -> Status<T> {
        self.status
    }

    /// Sets the rule of forgetting.
    ///
    /// # Errors
    /// [`Error::Setting`] for a factor outside (0, 1].
    pub fn set_forgetting(&mut self, forgetting: Forgetting<T>) -> Result<(), Error> {
        self.status.forgetting = forgetting.check()?;
        Ok(())
    }

    /// Adds the prior: rows of a square root S of the information, SᵀS = Λ, with S χ = S `prior`.
    ///
    /// The diagonal of the resulting R is the least that forgetting leaves.
    ///
    /// # Errors
    /// [`Error::NotPositiveDefinite`] of a matrix that is singular. The filter is then without
    /// information.
    pub(super) fn add_prior(&mut self, prior: &[T], square_root: &[T]) -> Result<(), Error> {
        bounds::check("prior", prior, T::of(1.0))?;
        bounds::check("square_root_information", square_root, T::of(1.0))?;
        let count = self.side.len();
        for row in square_root.chunks_exact(count.max(1)) {
            let side = row.iter().zip(prior).map(|(s, x)| *s * *x).sum();
            bounds::check("square_root_information", &[side], T::of(1.0))?;
            for (own, entry) in self.row.iter_mut().zip(row) {
                *own = *entry;
            }
            triangle::rotate_in(self.factor, self.side, self.row, side, 0);
        }
        triangle::make_diagonal_nonnegative(self.factor, self.side);
        if !triangle::is_regular(self.factor, count) {
            self.factor.fill(T::ZERO);
            self.side.fill(T::ZERO);
            return Err(Error::NotPositiveDefinite);
        }
        for (place, floor) in self.floors.iter_mut().enumerate() {
            let entry = self.factor.get(place * count + place);
            *floor = entry.copied().unwrap_or(T::ZERO);
        }
        self.status.is_regular = true;
        Ok(())
    }

    /// Adds one row: w χ = y with the standard deviation σ of y.
    ///
    /// # Errors
    /// Numbers that are not finite or too large, a σ that is not positive, or a wrong length. The
    /// state is then unchanged.
    pub fn update(&mut self, row: &[T], y: T, sigma: T) -> Result<Innovation<T>, Error> {
        self.check(row, y, sigma)?;
        self.begin();
        self.add(row, y, sigma)
    }

    /// Adds the rows of one sample: m rows, right sides, standard deviations and innovations.
    ///
    /// Exponential forgetting acts once, as in [`Filter::update_block`](super::Filter::update_block).
    ///
    /// # Errors
    /// As [`update`](Self::update), for any of the rows. The state is then unchanged.
    ///
    /// ```
    /// use overact::online::{Innovation, SliceFilter};
    ///
    /// let (mut factor, mut vectors) = (vec![0.0; 1], vec![0.0; 4]);
    /// let mut filter = SliceFilter::without_prior(&mut factor, &mut vectors)?;
    /// let mut innovations = [Innovation::<f64>::default(); 2];
    /// filter.update_block(&[1.0, 2.0], &[3.0, 6.0], &[1.0, 1.0], &mut innovations)?;
    /// assert!(innovations[1].residual.abs() < 1e-12);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update_block(
        &mut self,
        rows: &[T],
        y: &[T],
        sigma: &[T],
        innovations: &mut [Innovation<T>],
    ) -> Result<(), Error> {
        let (count, found) = (y.len(), [rows.len(), sigma.len(), innovations.len()]);
        for (expected, found) in [count * self.side.len(), count, count]
            .into_iter()
            .zip(found)
        {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        let width = self.side.len().max(1);
        let inputs = || rows.chunks_exact(width).zip(y).zip(sigma);
        for ((row, y), sigma) in inputs() {
            self.check(row, *y, *sigma)?;
        }
        self.begin();
        for (innovation, ((row, y), sigma)) in innovations.iter_mut().zip(inputs()) {
            *innovation = self.add(row, *y, *sigma)?;
        }
        Ok(())
    }

    /// Checks a row, without any change.
    ///
    /// # Errors
    /// Those of [`update`](Self::update).
    pub(super) fn check(&self, row: &[T], y: T, sigma: T) -> Result<(), Error> {
        self.check_length(row)?;
        let weight = bounds::weight(sigma)?;
        bounds::check("row", row, weight)?;
        bounds::check("y", &[y], weight)
    }

    /// Forgets once before the rows of an update.
    pub(super) fn begin(&mut self) {
        if let Forgetting::Exponential(factor) = self.status.forgetting {
            self.forget(factor);
        }
    }

    /// Multiplies all information by a factor in (0, 1], as [`Filter::discount`] does.
    ///
    /// [`Filter::discount`]: super::Filter::discount
    ///
    /// # Errors
    /// [`Error::Setting`] for another factor.
    pub fn discount(&mut self, factor: T) -> Result<(), Error> {
        Forgetting::Exponential(factor).check()?;
        self.forget(factor);
        Ok(())
    }

    /// Multiplies all information by a checked factor. The estimate stays the same.
    ///
    /// With a factor of 1 nothing is forgotten, as without a rule.
    fn forget(&mut self, factor: T) {
        if factor >= T::of(1.0) {
            return;
        }
        triangle::scale(self.factor, self.side, factor.sqrt());
        self.weigh_residuals(factor);
        self.keep_regular();
    }

    /// Multiplies the weight of earlier residuals.
    fn weigh_residuals(&mut self, factor: T) {
        self.status.squares *= factor;
        self.status.rows *= factor;
    }

    /// Adds a checked row.
    pub(super) fn add(&mut self, row: &[T], y: T, sigma: T) -> Result<Innovation<T>, Error> {
        let weight = bounds::weight(sigma)?;
        let one = T::of(1.0);
        if let Forgetting::Directional(factor) = self.status.forgetting
            && factor < one
        {
            let direction = &mut *self.work;
            triangle::forget_along(self.factor, self.side, row, factor.sqrt(), direction);
            self.weigh_residuals(factor);
            self.keep_regular();
        }
        for (own, entry) in self.row.iter_mut().zip(row) {
            *own = *entry * weight;
        }
        let rest = triangle::rotate_in(self.factor, self.side, self.row, y * weight, 0);
        if !self.status.is_regular {
            self.status.is_regular = triangle::is_regular(self.factor, self.side.len());
        }
        self.status.squares += rest.side * rest.side;
        // A row that determines one more parameter has no residual.
        if rest.cosines <= bounds::regular() {
            return Ok(Innovation::undetermined());
        }
        self.status.rows += one;
        let standard_deviation = sigma / rest.cosines;
        Ok(Innovation {
            residual: rest.side * standard_deviation,
            standard_deviation,
            normalised: rest.side,
            is_determined: true,
        })
    }

    /// Raises diagonal entries of a regular R that forgetting made too small.
    ///
    /// An entry is raised by the row √(floor² - r²) eᵢ, whose right side is that of the present
    /// estimate. So the estimate does not change.
    fn keep_regular(&mut self) {
        if !self.status.is_regular {
            return;
        }
        let count = self.side.len();
        let mut has_estimate = false;
        for place in 0..count {
            let entry = self.factor.get(place * count + place);
            let floor = self.floors.get(place);
            let (Some(&entry), Some(&floor)) = (entry, floor) else {
                return;
            };
            let length = triangle::column_length(self.factor, count, place);
            let least = (bounds::remembered::<T>() * length)
                .max(floor)
                .max(bounds::faintest());
            if entry >= least {
                continue;
            }
            if !has_estimate {
                has_estimate = true;
                triangle::solve(self.factor, self.side, self.work);
            }
            let added = (least * least - entry * entry).sqrt();
            let target = self.work.get(place).copied().unwrap_or(T::ZERO);
            let side = added * target;
            let side = if side.is_finite() { side } else { T::ZERO };
            self.row.fill(T::ZERO);
            if let Some(own) = self.row.get_mut(place) {
                *own = added;
            }
            triangle::rotate_in(self.factor, self.side, self.row, side, place);
        }
    }

    fn check_length(&self, slice: &[T]) -> Result<(), Error> {
        let (expected, found) = (self.side.len(), slice.len());
        if expected == found {
            Ok(())
        } else {
            Err(Error::Length { expected, found })
        }
    }

    /// Standard deviation of the normalised residuals so far, which is 1 if every σ is right.
    #[must_use]
    pub fn residual_deviation(&self) -> Option<T> {
        self.status.residual_deviation()
    }
}
