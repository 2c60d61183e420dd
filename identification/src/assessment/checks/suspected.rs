//! What follows from a suspect: whether chance explains it, and which parameters it spoils.

use super::Context;
use crate::{
    assessment::{
        check::{Check, Detectable, Grade},
        evidence::{Axis, Curve, Evidence},
        suspects::{Accused, Group, Scores, Suspect},
    },
    result::{Estimate, ParameterEstimate, Stage},
};

/// A fault that moves no parameter by so many of its deviations does no harm.
pub(in crate::assessment) const HARMFUL: f64 = 3.0;

/// Where a fault does harm, parameters are spoiled that it moves by more than so many.
const SPOILING: f64 = 1.0;

/// Of what speaks against the first suspect, so much speaks against another one that is likely, too.
const LIKELY: f64 = 0.5;

/// By how much the half width of a 95 % interval exceeds a deviation.
const HALF_WIDTH: f64 = 1.96;

/// A suspect that was tested.
pub(super) struct Tested {
    pub(super) group: Group,
    pub(super) accused: Accused,
    /// What its size is, where another one tells it better.
    pub(super) size: Option<f64>,
    /// By how many times more than in its own test it moves parameters in the estimate, whose band is wider.
    pub(super) more: f64,
}

impl Tested {
    /// How well the data tell its size, `size` being what they would have shown.
    pub(super) fn detectable(
        &self,
        (context, scores): (&Context<'_>, &Scores),
        (name, unit): (String, &'static str),
        size: f64,
    ) -> Detectable {
        let all = self.moves(context, scores);
        let most = all.iter().find(|(by, _)| by.is_finite());
        let base = context.estimates_of(Stage::Base).next();
        Detectable {
            name,
            unit,
            is_length: false,
            deviation: self.accused.deviation,
            size,
            parameter: base
                .zip(most)
                .map_or_else(String::new, |(base, (_, column))| self::name(base, *column)),
            moves: most.map_or(0.0, |(by, _)| {
                let own = self.size.unwrap_or_else(|| self.accused.size());
                by * size / own.abs().max(f64::MIN_POSITIVE)
            }),
        }
    }

    /// By how many of their deviations it moves the base and the recommended parameters of the first model, with
    /// their columns, the largest first.
    fn moves(&self, context: &Context<'_>, scores: &Scores) -> Vec<(f64, usize)> {
        let Some(base) = context.estimates_of(Stage::Base).next() else {
            return Vec::new();
        };
        let mut recommended = context.estimates_of(Stage::Recommended);
        let smaller = recommended.find(|one| one.model == base.model);
        let of_size = |accused: &Accused| -> Vec<(usize, f64)> {
            let factor = self.more * self.size.map_or(1.0, |size| size / accused.size());
            let moves = accused.moves.iter();
            moves.map(|(column, by)| (*column, by * factor)).collect()
        };
        let beside = smaller.and_then(|one| {
            let accused = scores.test(&self.group, &one.columns())?;
            Some((one, of_size(&accused)))
        });
        let mut all = by_deviation(base, &of_size(&self.accused));
        all.extend(
            beside
                .iter()
                .flat_map(|(one, moves)| by_deviation(one, moves)),
        );
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all
    }
}

/// What a suspect does to the parameters.
pub(super) struct Harm {
    /// The part of the residual's square that the likeliest suspect explains.
    pub(super) explained: f64,
    /// The largest move of a parameter by its deviation, and the parameter.
    pub(super) worst: f64,
    pub(super) parameter: String,
    /// Parameters that are not to be used.
    pub(super) spoiled: Vec<String>,
    pub(super) grade: Grade,
}

/// Tests groups beside the base parameters; those that the data can't tell are left out.
pub(super) fn tested(scores: &Scores, groups: impl Iterator<Item = Group>) -> Vec<Tested> {
    groups
        .filter_map(|group| {
            let accused = scores.test(&group, scores.selected())?;
            let size = None;
            Some(Tested {
                group,
                accused,
                size,
                more: 1.0,
            })
        })
        .collect()
}

/// Tests one suspect beside the base parameters; none where there is no such one, or the data can't tell it.
pub(super) fn only(scores: &Scores, wanted: Suspect) -> Option<Tested> {
    let place = scores.suspects.iter().position(|one| *one == wanted)?;
    tested(scores, std::iter::once(Group::suspect(place))).pop()
}

/// The one that explains most of the residual, of those that chance explains less often than `level`.
pub(super) fn guilty(all: &[Tested], level: f64) -> Option<&Tested> {
    let beyond = all.iter().filter(|one| one.accused.probability < level);
    beyond.max_by(|a, b| a.accused.explained.total_cmp(&b.accused.explained))
}

/// Names of the base parameters that are dry friction.
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

/// What suspects that may well be there do to the parameters: the worst of it, and all that any of them
/// spoils.
pub(super) fn worst_harm(
    context: &Context<'_>,
    scores: &Scores,
    (all, guilty): (&[Tested], &Tested),
    level: f64,
) -> Harm {
    let likely = all.iter().filter(|one| {
        one.accused.probability < level
            && one.accused.explained >= LIKELY * guilty.accused.explained
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
        explained: guilty.accused.explained,
        spoiled,
        ..worst
    }
}

/// What a suspect does to the base and the recommended parameters of the first model.
pub(super) fn harm(context: &Context<'_>, scores: &Scores, tested: &Tested) -> Harm {
    let Some(base) = context.estimates_of(Stage::Base).next() else {
        return Harm::none();
    };
    let all = tested.moves(context, scores);
    let Some(&(worst, column)) = all.first() else {
        return Harm::none();
    };
    let name = |column: usize| name(base, column);
    let mut harm = Harm {
        explained: tested.accused.explained,
        worst,
        parameter: name(column),
        ..Harm::none()
    };
    if worst <= HARMFUL {
        return harm;
    }
    for (by, column) in all {
        let name = name(column);
        if by > SPOILING && !harm.spoiled.contains(&name) {
            harm.spoiled.push(name);
        }
    }
    harm.grade = Harm::grade(harm.spoiled.len(), base.parameters.len());
    harm
}

impl Check {
    /// With the grade that a suspect's harm allows.
    pub(super) fn because(self, harm: &Harm) -> Self {
        let mut check = self.allowing(harm.grade).spoiling(harm.spoiled.clone());
        check.explained = Some(harm.explained);
        if harm.counts() { check.found() } else { check }
    }
}

impl Harm {
    /// That of nothing.
    fn none() -> Self {
        Self {
            explained: 0.0,
            worst: 0.0,
            parameter: String::new(),
            spoiled: Vec::new(),
            grade: Grade::Use,
        }
    }

    /// Adds parameters that are not to be used.
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

    /// Together with what another fault spoils.
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

    /// What so many spoiled ones of so many parameters leave.
    fn grade(spoiled: usize, parameters: usize) -> Grade {
        match spoiled {
            0 => Grade::Use,
            _ if 2 * spoiled > parameters => Grade::DoNotUse,
            _ => Grade::UseListed,
        }
    }

    /// Whether it is worth a remark: not where no parameter moves by one deviation.
    pub(super) fn counts(&self) -> bool {
        self.worst > SPOILING
    }

    /// What it means, as the end of a sentence.
    pub(super) fn words(&self) -> String {
        if self.grade == Grade::Use {
            return format!(
                "it moves no parameter by more than {:.1} of its standard deviations",
                self.worst
            );
        }
        format!(
            "it moves `{}` by {:.0} of its standard deviations",
            self.parameter, self.worst
        )
    }
}

/// Moves of an estimate's parameters by their deviations, each with its column.
fn by_deviation(estimate: &Estimate, moves: &[(usize, f64)]) -> Vec<(f64, usize)> {
    let deviation = |column: usize| {
        let own = estimate.parameters.iter().find(|one| one.column == column);
        let half = own.map(|one| 0.5 * (one.interval_95[1] - one.interval_95[0]));
        half.map_or(f64::INFINITY, |half| half / HALF_WIDTH)
    };
    let moves = moves.iter();
    moves
        .map(|(column, by)| (by.abs() / deviation(*column), *column))
        .collect()
}

fn name(estimate: &Estimate, column: usize) -> String {
    let own = estimate.parameters.iter().find(|one| one.column == column);
    own.map_or_else(String::new, |one: &ParameterEstimate| one.name.clone())
}

/// How the residual depends on the size of a suspect: a parabola with its lowest point at the size that
/// fits best.
pub(super) fn parabola(accused: &Accused, title: &str, axis: (&str, &str, f64)) -> Evidence {
    const POINTS: usize = 41;
    let (label, unit, scale) = axis;
    let (size, reach) = (
        accused.size(),
        2.0 * accused.size().abs() + 6.0 * accused.deviation,
    );
    let x: Vec<f64> = (0..POINTS)
        .map(|i| reach * (2.0 * i as f64 / (POINTS - 1) as f64 - 1.0))
        .collect();
    let remaining = |at: f64| {
        let off = if size == 0.0 { 0.0 } else { 1.0 - at / size };
        100.0
            * (1.0 - accused.explained * (1.0 - off * off))
                .max(0.0)
                .sqrt()
    };
    let y: Vec<f64> = x.iter().map(|at| remaining(*at)).collect();
    let x: Vec<f64> = x.iter().map(|at| scale * at).collect();
    Evidence {
        title: title.to_owned(),
        x: Axis::new(label, unit),
        y: Axis::new("residual that is left", "%"),
        lines: vec![Curve::new("", &x, &y)],
        ..Evidence::default()
    }
}
