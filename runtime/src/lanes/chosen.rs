//! Which vectors a function's legs are computed in.

#[cfg(dispatch)]
use super::detected;
use super::{Few, Many, SideBySide, Vector as _};

/// Whether four legs and more run side by side.
#[inline(always)]
#[must_use]
pub fn four() -> bool {
    #[cfg(dispatch)]
    if detected::avx2().is_some() {
        return true;
    }
    Few::WIDTH >= 4
}

/// Runs a function of at most four legs: of so few a wider register would be half empty.
#[inline(always)]
pub fn few<W: SideBySide>(work: W) -> W::Output {
    #[cfg(dispatch)]
    if let Some(proof) = detected::avx2() {
        return detected::by_four(work, proof);
    }
    work.run::<Few>(())
}

/// Runs a function of any number of legs, as many at once as the processor's registers hold numbers.
#[inline(always)]
pub fn many<W: SideBySide>(work: W) -> W::Output {
    #[cfg(dispatch)]
    {
        if let Some(proof) = detected::avx512() {
            return detected::by_eight(work, proof);
        }
        if let Some(proof) = detected::avx2() {
            return detected::by_four(work, proof);
        }
    }
    work.run::<Many>(())
}
