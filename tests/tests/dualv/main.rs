//! The DualV, the paper's robot, in every way that there is to have it: against the numeric reference,
//! against motion, in blocks, its base parameters, its four partitions; and what each stage of the
//! generator hands to the next.

mod agreement;
mod blocks;
mod description;
mod into;
mod motion;
mod ranks;
mod stages;
mod three_ways;
