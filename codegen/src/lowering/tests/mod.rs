//! Tests of the optimiser: each pass on small expressions ([`cases`]), and invariants of all passes
//! on random ones ([`properties`]).

mod build;
mod cases;
mod damage;
mod digits;
mod dominators;
mod language;
mod listing;
mod min_live_order;
mod properties;
mod random;
mod simd;
