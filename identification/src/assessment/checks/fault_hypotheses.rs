//! Consequences of a fault hypothesis: significance and unusable parameters.

use super::Context;
use crate::{
    assessment::{
        check::{Check, Grade},
        detectable::{Detectable, DetectableShift},
        evidence::{Axis, Curve, Evidence},
        hypotheses::{FaultHypothesis, Group, Scores, WaldTest},
    },
    estimation::correlation::NORMAL_95,
    result::{Estimate, ParameterEstimate, Stage},
};

/// Half width of a 95 % interval, in standard deviations.
const HALF_WIDTH: f64 = 1.96;

/// A detected fault that shifts a parameter by more than its interval spoils all parameters that it
/// shifts by more than this many standard deviations.
const SPOILING: f64 = 1.0;

/// Another hypothesis is likely if it explains this fraction of the best one's part.
pub(super) const LIKELY: f64 = 0.5;

/// A tested fault hypothesis.
pub(super) struct TestedHypothesis {
    pub(super) group: Group,
    pub(super) wald: WaldTest,
    /// Size to use instead of the fitted one, if another test determines it better.
    pub(super) size: Option<f64>,
    /// Factor of the parameter shifts in the estimate, whose band is wider than the test's.
    pub(super) band_factor: f64,
}

impl TestedHypothesis {
    /// The fault; not for a payload.
    pub(super) fn hypothesis(&self, scores: &Scores) -> FaultHypothesis {
        self.group.fault_hypothesis(scores)
    }

    /// Detection limit of the fault with this `name`, and with `size` as the detectable size.
    pub(super) fn detectable(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        unit: &'static str,
        size: f64,
    ) -> Detectable {
        self.limit(context, scores, unit, size, &self.shifts(context, scores))
    }

    /// The same from the shifts of the base parameters alone, which is faster.
    pub(super) fn detectable_in_base(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        unit: &'static str,
        size: f64,
    ) -> Option<Detectable> {
        let base = context.estimates_of(Stage::Base).next()?;
        let mut all = self.shifts_of(base, &self.wald);
        all.sort_by(|a, b| b.deviations.total_cmp(&a.deviations));
        Some(self.limit(context, scores, unit, size, &all))
    }

    /// Detection limit from parameter shifts, largest first.
    fn limit(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        unit: &'static str,
        size: f64,
        shifts: &[ParameterShift],
    ) -> Detectable {
        let own = self.size.unwrap_or_else(|| self.wald.size());
        let factor = size / own.abs().max(f64::MIN_POSITIVE);
        let at_limit = shifts.iter().map(|shift| ParameterShift {
            deviations: shift.deviations * factor,
            ..*shift
        });
        self.limit_of(context, scores, unit, size, at_limit)
    }

    /// Detection limit in the worst combination of several columns.
    ///
    /// `amplitude` is the size of a combination, which has the sizes of some columns by place.
    pub(super) fn detectable_in_worst(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        unit: &'static str,
        level: f64,
        amplitude: impl Fn(&[(usize, f64)]) -> f64,
    ) -> Option<Detectable> {
        let base = context.estimates_of(Stage::Base).next()?;
        let worst = self.wald.worst_sizes(level);
        let mut shifts: Vec<(ParameterShift, f64)> = worst
            .iter()
            .map(|one| {
                let shift = ParameterShift::new(base, one.parameter, self.band_factor * one.shift);
                (shift, amplitude(&one.sizes))
            })
            .filter(|(shift, _)| shift.deviations.is_finite())
            .collect();
        shifts.sort_by(|(a, _), (b, _)| b.deviations.total_cmp(&a.deviations));
        let size = shifts.first()?.1;
        let shifts = shifts.into_iter().map(|(shift, _)| shift);
        Some(self.limit_of(context, scores, unit, size, shifts))
    }

    /// Detection limit from the parameter shifts by a fault of this size, largest first.
    fn limit_of(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        unit: &'static str,
        size: f64,
        shifts: impl Iterator<Item = ParameterShift>,
    ) -> Detectable {
        let base = context.estimates_of(Stage::Base).next();
        let named = |shift: ParameterShift| DetectableShift {
            parameter: base.map_or_else(String::new, |base| name(base, shift.column)),
            deviations: shift.deviations,
        };
        let finite = shifts.filter(|shift| shift.deviations.is_finite());
        let limit = Detectable {
            deviation: self.wald.deviation,
            ..Detectable::new(self.hypothesis(scores), unit, size)
        };
        limit.shifting(finite.map(named))
    }

    /// Shifts of base and recommended parameters of the first model, largest first.
    fn shifts(&self, context: &Context<'_>, scores: &Scores) -> Vec<ParameterShift> {
        let Some(base) = context.estimates_of(Stage::Base).next() else {
            return Vec::new();
        };
        let mut recommended = context.estimates_of(Stage::Recommended);
        let smaller = recommended.find(|one| one.model == base.model);
        let mut all = self.shifts_of(base, &self.wald);
        if let Some(one) = smaller
            && let Some(wald) = scores.test(&self.group, &one.columns())
        {
            all.extend(self.shifts_of(one, &wald));
        }
        all.sort_by(|a, b| b.deviations.total_cmp(&a.deviations));
        all
    }

    /// Base parameters that a fault at its detection limit would shift.
    pub(super) fn shifted_at_limit(
        &self,
        context: &Context<'_>,
        scores: &Scores,
        level: f64,
    ) -> Vec<String> {
        let visible = self.wald.visible(level);
        let limit = self.detectable_in_base(context, scores, "", visible);
        let harmful = limit.filter(Detectable::is_harmful);
        let names = |limit: Detectable| limit.parameters().map(str::to_owned).collect();
        harmful.map_or_else(Vec::new, names)
    }

    /// Shifts of the parameters of an estimate, from the test with its columns.
    fn shifts_of(&self, estimate: &Estimate, wald: &WaldTest) -> Vec<ParameterShift> {
        let factor = self.band_factor * self.size.map_or(1.0, |size| size / wald.size());
        let shift =
            |&(column, by): &(usize, f64)| ParameterShift::new(estimate, column, by * factor);
        wald.shifts.iter().map(shift).collect()
    }
}

/// Absolute shift of a parameter by a fault.
#[derive(Debug, Clone, Copy)]
struct ParameterShift {
    /// Column of the parameter.
    column: usize,
    /// Shift in standard deviations of the parameter.
    deviations: f64,
}

impl ParameterShift {
    /// The shift of the parameter with this `column` in an estimate, in the unit of the parameter.
    fn new(estimate: &Estimate, column: usize, shift: f64) -> Self {
        let own = estimate.parameters.iter().find(|one| one.column == column);
        let half = own.map(|one| 0.5 * (one.interval_95[1] - one.interval_95[0]));
        let deviation = half.map_or(f64::INFINITY, |half| half / NORMAL_95);
        Self {
            column,
            deviations: shift.abs() / deviation,
        }
    }
}

/// Effect of a fault on the parameters.
pub(super) struct Harm {
    /// Fraction of the squared residual that the likeliest fault explains.
    pub(super) explained: f64,
    /// Largest shift of a parameter in standard deviations, and the parameter.
    pub(super) worst: f64,
    pub(super) parameter: String,
    /// Unusable parameters.
    pub(super) spoiled: Vec<String>,
    pub(super) grade: Grade,
}

/// Tests groups of columns against the base parameters; skips untestable ones.
pub(super) fn tested(
    scores: &Scores,
    groups: impl Iterator<Item = Group>,
) -> Vec<TestedHypothesis> {
    groups
        .filter_map(|group| {
            let wald = scores.test(&group, scores.selected())?;
            let size = None;
            Some(TestedHypothesis {
                group,
                wald,
                size,
                band_factor: 1.0,
            })
        })
        .collect()
}

/// Tests one hypothesis against the base parameters; `None` if absent or untestable.
pub(super) fn only(scores: &Scores, wanted: FaultHypothesis) -> Option<TestedHypothesis> {
    let place = scores.hypotheses.iter().position(|one| *one == wanted)?;
    tested(scores, std::iter::once(Group::hypothesis(place))).pop()
}

/// The hypothesis that explains most of the residual, among those significant at `level`.
pub(super) fn most_significant(all: &[TestedHypothesis], level: f64) -> Option<&TestedHypothesis> {
    let beyond = all.iter().filter(|one| one.wald.probability < level);
    beyond.max_by(|a, b| a.wald.evidence().total_cmp(&b.wald.evidence()))
}

/// Names of the base parameters of dry friction.
pub(super) fn dry_friction(context: &Context<'_>) -> Vec<String> {
    let Some(base) = context.estimates_of(Stage::Base).next() else {
        return Vec::new();
    };
    let is_dry = |one: &&ParameterEstimate| {
        let column = context.base.columns.get(one.column);
        let column = column.and_then(|&column| context.columns.as_slice().get(column));
        column.is_some_and(|column| column.symbol.has_sign())
    };
    let dry = base.parameters.iter().filter(is_dry);
    dry.map(|one| one.name.clone()).collect()
}

/// Effect of all likely faults: the worst shift, and all parameters that any of them spoils.
pub(super) fn worst_harm(
    context: &Context<'_>,
    scores: &Scores,
    all: &[TestedHypothesis],
    most_significant: &TestedHypothesis,
    level: f64,
) -> Harm {
    let likely = all.iter().filter(|one| {
        one.wald.probability < level
            && one.wald.explained >= LIKELY * most_significant.wald.explained
    });
    let harms: Vec<Harm> = likely.map(|one| harm(context, scores, one)).collect();
    let count = context
        .estimates_of(Stage::Base)
        .next()
        .map_or(0, |one| one.parameters.len());
    let mut spoiled: Vec<String> = Vec::new();
    for name in harms.iter().flat_map(|harm| &harm.spoiled) {
        if !spoiled.contains(name) {
            spoiled.push(name.clone());
        }
    }
    let worst = harms
        .into_iter()
        .max_by(|a, b| a.worst.total_cmp(&b.worst))
        .unwrap_or_else(Harm::none);
    Harm {
        grade: Harm::grade(spoiled.len(), count),
        explained: most_significant.wald.explained,
        spoiled,
        ..worst
    }
}

/// Effect of a fault on the base and recommended parameters of the first model.
pub(super) fn harm(context: &Context<'_>, scores: &Scores, tested: &TestedHypothesis) -> Harm {
    let Some(base) = context.estimates_of(Stage::Base).next() else {
        return Harm::none();
    };
    let all = tested.shifts(context, scores);
    let Some(worst) = all.first() else {
        return Harm::none();
    };
    let name = |column: usize| name(base, column);
    let mut harm = Harm {
        explained: tested.wald.explained,
        worst: worst.deviations,
        parameter: name(worst.column),
        ..Harm::none()
    };
    if harm.worst <= HALF_WIDTH {
        return harm;
    }
    for shift in all {
        let name = name(shift.column);
        if shift.deviations > SPOILING && !harm.spoiled.contains(&name) {
            harm.spoiled.push(name);
        }
    }
    harm.grade = Harm::grade(harm.spoiled.len(), base.parameters.len());
    harm
}

impl Check {
    /// Sets the grade that the harm allows.
    pub(super) fn with_harm(self, harm: &Harm) -> Self {
        let mut check = self
            .with_grade(harm.grade)
            .with_unusable_parameters(harm.spoiled.clone());
        check.explained = Some(harm.explained);
        if harm.counts() { check.found() } else { check }
    }
}

impl Harm {
    /// No effect.
    fn none() -> Self {
        Self {
            explained: 0.0,
            worst: 0.0,
            parameter: String::new(),
            spoiled: Vec::new(),
            grade: Grade::Use,
        }
    }

    /// Adds unusable parameters.
    pub(super) fn spoil(&mut self, names: Vec<String>) {
        if !names.is_empty() {
            self.grade = self.grade.max(Grade::UseListed);
        }
        for name in names {
            if !self.spoiled.contains(&name) {
                self.spoiled.push(name);
            }
        }
    }

    /// Adds the effect of another fault.
    pub(super) fn with(&mut self, context: &Context<'_>, other: &Self) {
        self.spoil(other.spoiled.clone());
        let base = context.estimates_of(Stage::Base).next();
        let count = base.map_or(0, |one| one.parameters.len());
        self.grade = self.grade.max(Self::grade(self.spoiled.len(), count));
        if other.worst > self.worst {
            self.worst = other.worst;
            self.parameter.clone_from(&other.parameter);
        }
    }

    /// The grade for a number of spoiled parameters among all.
    pub(super) fn grade(spoiled: usize, parameters: usize) -> Grade {
        match spoiled {
            0 => Grade::Use,
            _ if 2 * spoiled > parameters => Grade::DoNotUse,
            _ => Grade::UseListed,
        }
    }

    /// Whether a parameter shifts by more than one standard deviation.
    pub(super) fn counts(&self) -> bool {
        self.worst > SPOILING
    }

    /// The effect as the end of a sentence.
    pub(super) fn words(&self) -> String {
        if self.grade == Grade::Use {
            return format!("it shifts no parameter by more than {:.1} σ", self.worst);
        }
        format!("it shifts `{}` by {:.0} σ", self.parameter, self.worst)
    }
}

fn name(estimate: &Estimate, column: usize) -> String {
    let own = estimate.parameters.iter().find(|one| one.column == column);
    own.map_or_else(String::new, |one: &ParameterEstimate| one.name.clone())
}

/// Plot of the squared residual over the size of a fault.
///
/// It is a parabola with its minimum at the fitted size. `label` names the size, and `scale`
/// converts it to `unit`.
pub(super) fn parabola(
    wald: &WaldTest,
    title: &str,
    label: &str,
    unit: &str,
    scale: f64,
) -> Evidence {
    const POINTS: usize = 41;
    let (size, reach) = (wald.size(), 2.0 * wald.size().abs() + 6.0 * wald.deviation);
    let x: Vec<f64> = (0..POINTS)
        .map(|i| reach * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0))
        .collect();
    let remaining = |at: f64| {
        let off = if size == 0.0 { 0.0 } else { 1.0 - at / size };
        100.0 * (1.0 - wald.explained * (1.0 - off * off)).max(0.0).sqrt()
    };
    let y: Vec<f64> = x.iter().map(|at| remaining(*at)).collect();
    let x: Vec<f64> = x.iter().map(|at| scale * at).collect();
    Evidence {
        title: title.to_owned(),
        x: Axis::new(label, unit),
        y: Axis::new("remaining residual", "%"),
        lines: vec![Curve::new("", &x, &y)],
        ..Evidence::default()
    }
}
