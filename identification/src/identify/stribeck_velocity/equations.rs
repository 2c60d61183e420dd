//! Equations of all runs in any columns of the model.

use overact_logs::{Error, Log};

use crate::regression::{
    observation::MeasuredRun, observer::Observer, projection::Projection, system::System,
};

/// Equations of each projection in the columns of an observer.
pub(super) fn systems(
    observer: &Observer<'_>,
    runs: &[Log],
) -> Result<Vec<Result<System, Error>>, Error> {
    let info = observer.model.info();
    let new = |projection: &Projection| {
        let system = System::new(projection.clone(), &info, observer.base.len());
        Ok(system)
    };
    let mut systems: Vec<Result<System, Error>> = observer.projections.iter().map(new).collect();
    for (number, log) in runs.iter().enumerate() {
        let run = MeasuredRun {
            number,
            log,
            instruments: None,
            budget: 0,
            periodic_motion: None,
        };
        let (equations, _) = observer.run(&run, &|_, _| {})?;
        for (system, own) in systems.iter_mut().zip(equations) {
            match (system.as_mut(), own) {
                (Ok(system), Ok(own)) => system.extend(own),
                (Ok(_), Err(error)) => *system = Err(error),
                (Err(_), _) => {}
            }
        }
    }
    Ok(systems)
}
