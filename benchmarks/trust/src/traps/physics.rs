//! Effects that a model lacks, of one drive or of all, and motions that excite too little.

use super::{Trap, alter, known_fault::KnownFault};
use crate::{Failure, Subject};
use overact::{Columns, Function, Model};
use overact_identification::FaultKind;
use overact_simulation::{Experiment, Record, Trajectory};

/// Ratio of a gear that is wrong by one tooth of 50.
const TOOTH: f64 = 51.0 / 50.0;

/// Constant force on a body, N.
const FORCE: f64 = 5.0;

/// Faults for a robot.
///
/// # Errors
/// A robot that cannot be evaluated in another gravity.
pub fn physics(subject: &Subject) -> Result<Vec<Trap>, Failure> {
    let drives = subject.info().sizes.actuators;
    let mut all = torque_sensing(drives);
    all.extend((0..2).map(gear));
    let load = |drive: usize| KnownFault::torque("load", drive, Some(0.02));
    all.push(
        Trap::each("load-dependent friction of 2 % at drive 2", |run| {
            alter::load_friction(run, 1, 0.02);
        })
        .known([load(1)]),
    );
    all.push(
        Trap::each("load-dependent friction of 2 % at all drives", |run| {
            of_all(run, |run, i| alter::load_friction(run, i, 0.02));
        })
        .known((0..drives).map(load)),
    );
    let coordinates = subject.info().coordinates;
    all.extend(coordinates.iter().map(|name| still(name)));
    all.extend(forces(subject)?);
    Ok(all)
}

/// Errors of the measured torques of a robot with this number of drives.
fn torque_sensing(drives: usize) -> Vec<Trap> {
    let ripple = |torque: f64, position: f64| torque * (1.0 + 0.03 * (12.0 * position).sin());
    let saturation = |drive: usize| KnownFault::torque("saturation", drive, None);
    let drift = |drive: usize| KnownFault::torque("gain-time", drive, None);
    let waves = |drive: usize| KnownFault::torque("load-waves", drive, None);
    let neighbours: Vec<(usize, usize)> =
        (1..drives).flat_map(|i| [(i - 1, i), (i, i - 1)]).collect();
    let crosstalk =
        |&(to, _): &(usize, usize)| KnownFault::of_actuator(FaultKind::Crosstalk, to, 0.04);
    let known_crosstalk: Vec<KnownFault> = neighbours.iter().map(crosstalk).collect();
    vec![
        Trap::each("torque constant of drive 1 saturates by 10 %", |run| {
            alter::saturating_constant(run, 0, 0.1);
        })
        .known([saturation(0)]),
        Trap::each("torque constants of all drives saturate by 10 %", |run| {
            of_all(run, |run, i| alter::saturating_constant(run, i, 0.1));
        })
        .known((0..drives).map(saturation)),
        Trap::each("crosstalk of 4 % from drive 2 to drive 1", |run| {
            alter::crosstalk(run, &[(0, 1)], 0.04);
        })
        .known([crosstalk(&(0, 1))]),
        Trap::each("crosstalk of 4 % between neighbouring drives", move |run| {
            alter::crosstalk(run, &neighbours, 0.04);
        })
        .known(known_crosstalk),
        Trap::each("all gains fall by 10 % during each run", |run| {
            of_all(run, |run, i| {
                alter::torque_in_time(run, i, |torque, part| torque * (1.0 - 0.1 * part));
            });
        })
        .known((0..drives).map(drift)),
        Trap::each("load-dependent ripple of 3 % at drive 1", move |run| {
            alter::torque_at_position(run, 0, ripple);
        })
        .known([waves(0)]),
        Trap::each("load-dependent ripple of 3 % at all drives", move |run| {
            of_all(run, |run, i| alter::torque_at_position(run, i, ripple));
        })
        .known((0..drives).map(waves)),
    ]
}

/// Applies a change to every actuator.
fn of_all(run: &mut Record, change: impl Fn(&mut Record, usize)) {
    (0..run.actuators.len()).for_each(|actuator| change(run, actuator));
}

/// Position and torque of a drive behind a gear with one tooth more.
fn gear(drive: usize) -> Trap {
    let name = format!("gear of drive {} wrong by one tooth", drive + 1);
    let trap = Trap::each(&name, move |run| {
        alter::position(run, drive, |q| TOOTH * q);
        alter::torque(run, drive, |torque| torque / TOOTH);
    });
    trap.known([KnownFault::of_actuator(
        FaultKind::GearRatio,
        drive,
        TOOTH - 1.0,
    )])
}

/// A coordinate that never moves.
fn still(coordinate: &str) -> Trap {
    let own = coordinate.to_owned();
    let change = move |plan: &mut Experiment| {
        for run in &mut plan.runs {
            let Trajectory::Periodic { terms, .. } = &mut run.trajectory else {
                continue;
            };
            let own = terms.iter_mut().filter(|term| term.coordinate == own);
            own.for_each(|term| term.amplitude = 0.0);
        }
    };
    Trap::plan(&format!("coordinate {coordinate} never moves"), change)
}

/// Constant forces on the last body with a mass, along each axis of the base.
///
/// A weight on the body at rest, in a gravity along the axis, has the same torques.
fn forces(subject: &Subject) -> Result<Vec<Trap>, Failure> {
    let info = subject.info();
    let mut traps = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let mut gravity = [0.0; 3];
        gravity[axis] = 1.0;
        let [weighed, weightless] = [gravity, [0.0; 3]].map(|own| subject.in_gravity(own));
        let (weighed, weightless) = (weighed?, weightless?);
        let parameters = weighed.model().info().parameters;
        let mut masses = parameters.iter().map(|one| one.name);
        let Some(body) = masses.rfind(|one| one.starts_with("m_")).map(str::to_owned) else {
            continue;
        };
        let pose = info.home_pose.to_vec();
        traps.push(Trap::each(
            &format!("constant force of 5 N along {name} at the last body"),
            move |run| {
                let models = [weighed.model() as &dyn Model, weightless.model()];
                // Poses within the workspace, as the simulated robot reached them.
                let added = weights(models, &body, &pose, run).unwrap_or_default();
                let both = run.torques.iter_mut().zip(added);
                both.for_each(|(torque, added)| *torque -= FORCE * added);
            },
        ));
    }
    Ok(traps)
}

/// Torques of a unit mass of a body at rest in the first model's gravity, without the second's.
fn weights(
    models: [&dyn Model; 2],
    body: &str,
    home: &[f64],
    run: &Record,
) -> Result<Vec<f64>, overact::Error> {
    let sizes = models[0].info().sizes;
    let (n, mut pose) = (sizes.actuators, home.to_vec());
    let rest = vec![0.0; sizes.dof];
    let mut all = Vec::with_capacity(run.torques.len());
    for actuators in run.positions.chunks_exact(n) {
        models[0].pose_from_actuators(actuators, &mut pose)?;
        let mut torques = [vec![0.0; n], vec![0.0; n]];
        for (model, torques) in models.into_iter().zip(&mut torques) {
            let of_body = |one: &&str| **one == *body;
            let names = model.info().parameters.iter().map(|one| one.name);
            let unit: Vec<f64> = names.map(|one| f64::from(of_body(&one))).collect();
            let function = Function::InverseDynamics(Columns::Standard);
            model
                .evaluate(function, &[&pose, &rest, &rest, &unit], torques)
                .map_err(|error| error.error)?;
        }
        all.extend(torques[0].iter().zip(&torques[1]).map(|(a, b)| a - b));
    }
    Ok(all)
}
