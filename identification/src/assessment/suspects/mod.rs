//! What the model may lack, held against what it leaves unexplained.
//!
//! A suspect is a fault with one unknown size δ: the torques come by δ seconds late, the gain of a drive
//! is wrong by a part δ, a joint has a spring of stiffness δ. To first order it adds a column z δ to
//! Y = W χ. Whether δ is zero is Wald's test: z is freed of what the columns W explain,
//! z⊥ = z - W B with B = (Wᵀ W)^-1 Wᵀ z, and held against the residual ρ,
//!
//! ```text
//! δ = z⊥ᵀ ρ/(z⊥ᵀ z⊥),   χ is off by B δ.
//! ```
//!
//! The deviation of δ is told from ρ - z⊥ δ, as if the suspect were a parameter of the model: ρ itself
//! holds the fault, which would hide itself. The second equation says what the suspect does to the
//! parameters: a fault that is there for sure and moves none of them is a remark, one that moves them by
//! several of their deviations spoils them.
//!
//! Two errors of the model are no faults, but would look like some:
//!
//! - Errors of positions come back as accelerations, with the square of the frequency, and the controller
//!   answers them with torques: what is measured of both hangs together, as a delay would make it. So the
//!   equations keep half of the estimate's band only, in which there is a thirtieth of it.
//! - A joint whose friction changes its sign sticks for a while, which no function of a filtered velocity
//!   tells. So every column w of dry friction has a column -ẇ beside it, as if it came late by a time of
//!   its own, and no suspect is held against what that explains.
//!
//! A third error returns with every period of the motion and is the same in each: friction at reversals, steps of an
//! encoder. How scores vary slowly does not tell it, and the longer a run is, the more clearly it stands out of the noise.
//! So where a motion returns the deviation is at least that of the mean over all periods (`estimation::returning`).
//!
//! - `shapes`: how something missing may depend on the motion;
//! - `columns`: the suspects and their columns;
//! - `misreading`: how the error of an encoder depends on where it stands;
//! - `nearby`: what the model would explain of a motion that is slightly different;
//! - `sections`: products of columns and residual, section by section of the time;
//! - `pairs`: residuals of actuators that hang together;
//! - `course`: how residual and motion are spread over the time;
//! - `pass`: what a pass over a run needs; `material`: what rows are made of; `run`: the pass; `scores`: what all
//!   runs tell;
//! - `beside`: the columns of the model beside which suspects are tested;
//! - `scaled`: equations between columns of different units;
//! - `spread`: how far a score strays by chance;
//! - `group`: columns that are tested together;
//! - `test`: sizes, deviations, probabilities; `accused`: what it says.
//!
//! Columns that are made of torques use torques that are freed of the residual,
//! τ - J (Jᵀ J)^-1 ρ: measured ones hold the noise of the residual itself, which would accuse every drive.

mod accused;
mod beside;
mod columns;
mod course;
mod group;
mod material;
mod misreading;
mod nearby;
mod pairs;
mod pass;
mod run;
mod scaled;
mod scores;
mod sections;
mod shapes;
mod spread;
mod test;

pub(crate) use accused::Accused;
pub(crate) use columns::Suspect;
pub(crate) use course::Pace;
pub(crate) use group::Group;
pub(crate) use misreading::Misreading;
pub(crate) use pairs::Correlation;
pub(crate) use scores::{Scores, scores};
pub(crate) use shapes::{Reach, Shape};
