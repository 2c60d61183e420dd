//! Closure of legs and reduced Jacobians, eqs. (9) to (13); velocity of platforms with parasitic
//! motion.

pub(crate) mod bias;
pub(crate) mod cable;
pub(crate) mod leg;
pub(crate) mod leg_closure;
pub(crate) mod parasitic_motion;
