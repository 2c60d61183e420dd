//! Runs of a fleet of virtual robots.

use crate::{error::Error, experiment::VirtualExperiment};
use overact::Model;
use overact_simulation::{Fleet, Member, Record};
use rayon::prelude::*;

impl VirtualExperiment<'_> {
    /// A robot of a fleet with parameters distributed around those of the experiment.
    #[must_use]
    pub fn member(&self, fleet: &Fleet, number: usize) -> Member {
        let info = self.robot().model().info();
        fleet.member(number, &info, &self.plan().parameters)
    }

    /// Simulates the run of a robot of the fleet on a day.
    ///
    /// The runs of the experiment alternate over the days. The controller is designed for the
    /// experiment's parameters.
    ///
    /// # Errors
    /// An invalid experiment, or a run that failed.
    pub fn day(&self, fleet: &Fleet, member: &Member, day: usize) -> Result<Record, Error> {
        let mut own = self.clone();
        let plan = own.plan_mut();
        let nominal = plan.nominal_parameters.take();
        plan.nominal_parameters = nominal.or_else(|| Some(plan.parameters.clone()));
        plan.parameters = fleet.on(member, day);
        plan.seed = fleet.noise(member, day);
        let turn = day % plan.runs.len().max(1);
        plan.runs = plan.runs.drain(..).skip(turn).take(1).collect();
        let mut records = own.records(&|_, _| ())?;
        // An experiment has at least one run, and each gives a record or an error.
        let mut record = records.swap_remove(0);
        fleet.spoil(member, day, &mut record);
        Ok(record)
    }
}

impl VirtualExperiment<'_> {
    /// Processes the records of many robots on a day, robot by robot; `made` converts each record.
    pub fn days<T: Send>(
        &self,
        fleet: &Fleet,
        members: &[Member],
        day: usize,
        made: &(dyn Fn(&Member, Record) -> Result<T, Error> + Sync),
    ) -> Vec<Result<T, Error>> {
        let one = |member: &Member| made(member, self.day(fleet, member, day)?);
        members.par_iter().map(one).collect()
    }
}
