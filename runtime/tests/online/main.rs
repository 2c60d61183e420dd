//! Online estimation: filter, forgetting, change test and state-variable filters.

mod c;
mod change;
mod filter;
mod forgetting;
mod payload;
mod random;
mod robustness;
mod state_variable;
