//! Intermediate results for the tests of this repository. Not part of the interface: it changes
//! with any version.

pub use crate::cas::{Arena, Stream};
pub use crate::derivation::{Derived, derive};
pub use crate::mechanism::states::{State, pose_towards, random_states};
pub use crate::selection::{Assembler, Search, formulations, sample};
