//! The few transcendental functions that generated code calls: those of the standard library with
//! the feature `std`, those of `libm` with the feature of that name alone. The angles of a whole function have their sines and
//! cosines from [`sin_cos_all`].

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

/// Sign of a velocity as Coulomb friction wants it: -1, 0 or 1 (0 for NaN).
#[inline]
#[must_use]
pub fn sign(velocity: f64) -> f64 {
    f64::from(u8::from(velocity > 0.0)) - f64::from(u8::from(velocity < 0.0))
}

/// A value with the sign of a velocity.
///
/// To a processor the sign of a velocity is as good as random. A selection compiles to a branch, and
/// one that is guessed wrong costs more than ten multiplications; so this is one.
#[inline]
#[must_use]
pub fn signed(value: f64, velocity: f64) -> f64 {
    value * sign(velocity)
}

/// The angle nearest to zero that differs from `angle` by whole turns.
#[inline]
#[must_use]
pub fn wrap_angle(angle: f64) -> f64 {
    if angle.abs() <= core::f64::consts::PI {
        return angle;
    }
    let (sine, cosine) = sin_cos(angle);
    atan2(sine, cosine)
}
