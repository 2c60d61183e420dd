//! What is chosen for a robot before its functions are written: the form of its model and its columns.
//!
//! The standard regressor of case 1, eq. (30), has a column per standard parameter. [`columns`] drops those
//! that are identically zero and finds the independent ones in the symmetric order (43); [`base`] says what
//! the others are made of, and [`combine`] writes such a column as a combination of others where that takes
//! fewer operations. [`formulation`] chooses among equal forms of the closures, eq. (9), and of the moments
//! about axes that meet. All of them judge by one measure, the operations of the program that [`assemble`]
//! makes of a function.

pub mod assemble;
pub mod base;
pub mod columns;
pub mod combine;
pub mod formulation;
