//! Columns of each line that are not zero at all states.
//!
//! Lines of a robot without loops are the equations of its actuators. The torques of other actuators
//! do not enter them, nor do the parameters of bodies nearer to the base. Decimation and products
//! leave out these columns.

use overact::Model;

use crate::{
    assessment::hypotheses::columns::{FaultHypothesis, Layout},
    regression::{columns::ColumnSet, states::random_states},
};

/// Number of random states at which a column that is not zero has to show.
const STATES: usize = 64;

/// All columns of the lines.
pub(crate) struct AllColumns<'a> {
    /// Columns of the model, and the base parameters among them.
    pub(crate) columns: &'a ColumnSet,
    pub(crate) base: &'a [usize],
    /// Indices of the dry friction columns among the base parameters.
    pub(crate) friction: &'a [usize],
    pub(crate) hypotheses: &'a [FaultHypothesis],
    pub(crate) layout: &'a Layout,
}

/// The columns of one line that are not always zero.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LiveColumns {
    /// Indices among the base parameters, and among the friction rates.
    pub(crate) base: Vec<usize>,
    pub(crate) friction: Vec<usize>,
    /// Hypotheses with one column, with their indices among these.
    pub(crate) hypotheses: Vec<FaultHypothesis>,
    pub(crate) places: Vec<usize>,
    /// Indices among all columns, ascending.
    pub(crate) columns: Vec<usize>,
    /// Number of decimated columns, without Y.
    pub(crate) decimated: usize,
}

impl AllColumns<'_> {
    /// All columns for each of `lines` lines.
    pub(crate) fn in_all(&self, lines: usize) -> Vec<LiveColumns> {
        let base: Vec<usize> = (0..self.base.len()).collect();
        vec![self.live(base, |_| true); lines]
    }

    /// Those of the lines of a robot without loops; `None` if no random state has a value.
    pub(crate) fn of_actuators(&self, model: &dyn Model, seed: u64) -> Option<Vec<LiveColumns>> {
        let states = random_states(model, STATES, seed).ok()?;
        let rows = self
            .columns
            .evaluate(model, &states.sampled(), self.base, 0);
        let p = self.base.len();
        let one = |(line, rows): (usize, &Vec<f64>)| {
            let is_live = |column: &usize| {
                let mut values = rows.iter().skip(*column).step_by(p);
                values.any(|value| *value != 0.0)
            };
            let base = (0..p).filter(is_live).collect();
            self.live(base, |hypothesis| enters(hypothesis, line))
        };
        Some(rows.ok()?.iter().enumerate().map(one).collect())
    }

    /// The base parameters `base`, their friction rates, and the hypotheses that `is_live` accepts.
    fn live(&self, base: Vec<usize>, is_live: impl Fn(FaultHypothesis) -> bool) -> LiveColumns {
        let (p, layout) = (self.base.len(), self.layout);
        let friction = self.friction.iter().enumerate();
        let friction = friction.filter(|(_, place)| base.contains(place));
        let friction: Vec<usize> = friction.map(|(rate, _)| rate).collect();
        let payload = layout.blocks.last().map_or(&[][..], Vec::as_slice);
        let narrow = layout.decimated - layout.base - payload.len();
        let own = self.hypotheses[..narrow].iter().copied().enumerate();
        let (places, hypotheses): (Vec<usize>, Vec<FaultHypothesis>) =
            own.filter(|(_, one)| is_live(*one)).unzip();
        let mut columns = base.clone();
        columns.extend(friction.iter().map(|rate| p + rate));
        columns.extend(places.iter().map(|place| layout.base + place));
        columns.extend(payload);
        let decimated = columns.len();
        let wide = self.hypotheses.iter().zip(&layout.blocks).skip(narrow);
        let wide = wide.filter(|(one, _)| one.width() > 1 && is_live(**one));
        columns.extend(wide.flat_map(|(_, block)| block));
        LiveColumns {
            base,
            friction,
            hypotheses,
            places,
            columns,
            decimated,
        }
    }
}

impl LiveColumns {
    /// Number of base parameters and friction rates; Y follows them.
    pub(crate) fn models(&self) -> usize {
        self.base.len() + self.friction.len()
    }

    /// Index of each of the `all` columns among those of the line.
    pub(crate) fn indices(&self, all: usize) -> Vec<Option<usize>> {
        let mut indices = vec![None; all];
        for (place, column) in self.columns.iter().enumerate() {
            indices[*column] = Some(place);
        }
        indices
    }
}

/// Whether the columns of a hypothesis enter the equation of an actuator.
fn enters(hypothesis: FaultHypothesis, line: usize) -> bool {
    match hypothesis {
        FaultHypothesis::DriveDelay(actuator)
        | FaultHypothesis::Gain(actuator)
        | FaultHypothesis::Torque(actuator, _)
        | FaultHypothesis::Force(actuator, _)
        | FaultHypothesis::Crosstalk { to: actuator, .. } => actuator == line,
        FaultHypothesis::Potential(joints) => line < joints.count(),
        _ => true,
    }
}
