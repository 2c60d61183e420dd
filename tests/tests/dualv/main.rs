//! Tests of the DualV, the paper's robot.
//!
//! They compare it with the numeric reference and with its motion, and test blocks, base
//! parameters, all four partitions and the generator's stages.

mod agreement;
mod blocks;
mod description;
mod into;
mod motion;
mod ranks;
mod stages;
mod three_ways;
