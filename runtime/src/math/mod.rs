//! Transcendental functions of generated code.
//!
//! They come from the standard library with the feature `std`, and from `libm` with that feature
//! alone. Sines and cosines of all angles of a function come from [`sin_cos_all`].

#[cfg(any(dispatch, all(test, feature = "dispatch", target_arch = "x86_64")))]
mod detected;
#[cfg(any(test, not(vectors)))]
mod plain;
pub mod single;
mod trigonometry;
#[cfg(any(test, vectors))]
mod vectors;
pub mod wide;

pub use trigonometry::sin_cos_all;

/// Sine and cosine of an angle in radians.
#[inline]
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    #[cfg(feature = "std")]
    {
        angle.sin_cos()
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::sincos(angle)
    }
}

/// Square root; NaN of a negative number.
#[inline]
#[must_use]
pub fn sqrt(square: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        square.sqrt()
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::sqrt(square)
    }
}

/// The angle in radians of the direction (x, y), in (-π, π].
#[inline]
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        y.atan2(x)
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::atan2(y, x)
    }
}

/// Exponential function.
#[inline]
#[must_use]
pub fn exp(exponent: f64) -> f64 {
    #[cfg(feature = "std")]
    {
        exponent.exp()
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::exp(exponent)
    }
}

/// Sign of a velocity for Coulomb friction: -1, 0 or 1 (0 for NaN).
#[inline]
#[must_use]
pub fn sign(velocity: f64) -> f64 {
    f64::from(u8::from(velocity > 0.0)) - f64::from(u8::from(velocity < 0.0))
}

/// A value with the sign of a velocity.
///
/// For a processor the sign of a velocity is practically random. A selection compiles to a branch,
/// and a misprediction costs more than ten multiplications; so this is a multiplication.
#[inline]
#[must_use]
pub fn signed(value: f64, velocity: f64) -> f64 {
    value * sign(velocity)
}

/// The angle wrapped to the one nearest to zero.
#[inline]
#[must_use]
pub fn wrap_angle(angle: f64) -> f64 {
    if angle.abs() <= core::f64::consts::PI {
        return angle;
    }
    let (sine, cosine) = sin_cos(angle);
    atan2(sine, cosine)
}
