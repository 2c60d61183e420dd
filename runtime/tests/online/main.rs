//! Online estimation: filter, forgetting, change test and state-variable filters.

mod c;
mod change;
mod filter;
mod forgetting;
mod payload;
mod pick_up;
mod random;
mod robustness;
mod state_variable;
