//! Tests of the optimiser: what each pass makes of small expressions ([`cases`]), and what all passes
//! keep on random ones ([`properties`]).

mod build;
mod cases;
mod damage;
mod digits;
mod dominators;
mod lanes;
mod language;
mod listing;
mod min_live_order;
mod properties;
mod random;
