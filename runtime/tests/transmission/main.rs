//! Transmissions: power, round trips, gains, limits, errors, and agreement of C with Rust.

mod c;
mod errors;
mod gains;
mod limits;
mod random;
