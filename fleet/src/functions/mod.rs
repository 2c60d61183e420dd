//! SQL functions, for one machine and for clusters.

mod arrays;
mod factor;
mod gather;
mod scalars;

pub use arrays::pooled;

use crate::robots::Robots;
use datafusion::{
    execution::FunctionRegistry,
    logical_expr::{AggregateUDF, ScalarUDF},
};
use std::sync::Arc;

/// Aggregate functions.
#[must_use]
pub fn aggregates(robots: &Robots) -> Vec<Arc<AggregateUDF>> {
    vec![
        Arc::new(AggregateUDF::from(gather::Gather::estimate())),
        Arc::new(AggregateUDF::from(gather::Gather::merge_r())),
        Arc::new(AggregateUDF::from(factor::FactorOfLog::new(robots.clone()))),
    ]
}

/// Scalar functions.
#[must_use]
pub fn scalars() -> Vec<Arc<ScalarUDF>> {
    vec![
        Arc::new(ScalarUDF::from(scalars::ParameterOf::default())),
        Arc::new(ScalarUDF::from(scalars::FTest::default())),
    ]
}

/// Registers all functions.
///
/// # Errors
/// A registry that accepts no functions.
pub fn register(
    registry: &mut dyn FunctionRegistry,
    robots: &Robots,
) -> datafusion::error::Result<()> {
    for own in aggregates(robots) {
        registry.register_udaf(own)?;
    }
    for own in scalars() {
        registry.register_udf(own)?;
    }
    Ok(())
}
