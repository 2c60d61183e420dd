//! Whether the measured positions close the loops.

use super::Context;
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        positions,
    },
    error::Error,
    kinematics::conditioning::couples,
    significant,
    thresholds::Thresholds,
};

/// Looks at all runs of a robot whose actuators are more than its degrees of freedom.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let sizes = context.model.info().sizes;
    let mut checks = Vec::new();
    if sizes.actuators <= sizes.dof || !couples(context.model) {
        return Ok(checks);
    }
    let limit = Thresholds::default().closure_residual;
    for (log, watched) in context.runs() {
        let residual = watched.closure_residual;
        let misses = residual > limit;
        let words = if misses {
            format!(
                "the actuator positions miss the closure of the loops by up to {residual:.3} m or rad; check the geometry and the offsets of the encoders"
            )
        } else {
            format!(
                "the actuator positions close the loops to {} m or rad",
                significant(residual, 3)
            )
        };
        checks.push(
            Check::new(CheckKind::Closure, About::Model, words)
                .in_run(log.name())
                .measured(residual, "m or rad")
                .against(limit, "a hundredth of the usual range")
                .allowing(if misses { Grade::DoNotUse } else { Grade::Use }),
        );
        if misses {
            checks.extend(positions::explanation(context.model, log)?);
        }
    }
    Ok(checks)
}
