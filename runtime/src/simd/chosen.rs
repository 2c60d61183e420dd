//! Choice of the vectors for a function's legs.

#[cfg(dispatch)]
use super::detected;
use super::{Narrow, SideBySide, Vector as _, Wide};

/// Whether at least four lanes are available.
#[inline(always)]
#[must_use]
pub fn four() -> bool {
    #[cfg(dispatch)]
    if detected::avx2().is_some() {
        return true;
    }
    Narrow::WIDTH >= 4
}

/// Runs a function of at most four legs, for which a wider register would be half empty.
#[inline(always)]
pub fn few<W: SideBySide>(work: W) -> W::Output {
    #[cfg(dispatch)]
    if let Some(proof) = detected::avx2() {
        return detected::by_four(work, proof);
    }
    work.run::<Narrow>(())
}

/// Runs a function of any number of legs in the widest registers of the processor.
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
    work.run::<Wide>(())
}
