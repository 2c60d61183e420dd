//! Iterate of the interior-point method, and its steps.

use nalgebra::{DMatrix, DVector};

use super::{
    bound::BoundDistance,
    cones::{BodyCone, Cone, FreeCone, PositiveCone},
    equations::Equations,
    pseudo_inertia::{Inertia, Metric},
    unknowns::{UnknownGroup, UnknownKind, Unknowns},
};

/// Largest fraction of the distance to the boundary in one step.
const CLEAR: f64 = 0.9;

/// Unknowns that are constrained together.
struct Block {
    first: usize,
    len: usize,
    cone: Box<dyn Cone>,
    distances: Vec<BoundDistance>,
}

impl Block {
    fn new(group: &UnknownGroup, values: &DVector<f64>, weight: f64, cost: f64) -> Option<Self> {
        let own = values.rows(group.first, group.len());
        let cone: Box<dyn Cone> = match &group.kind {
            UnknownKind::Body { prior } => {
                let own = own.fixed_rows::<10>(0).into_owned();
                Box::new(BodyCone::new(prior, &own, weight)?)
            }
            UnknownKind::Positive { prior } => Box::new(PositiveCone::new(*prior, own[0], weight)?),
            UnknownKind::Free { scale } => Box::new(FreeCone::new(*scale, own[0], cost)),
        };
        let bounds = group.bounds.iter();
        let bounds = bounds.flat_map(|(k, [low, high])| [(*k, 1.0, *low), (*k, -1.0, *high)]);
        let bounds = bounds.filter(|(_, _, limit)| limit.is_finite());
        let distances = bounds
            .map(|(k, sign, limit)| BoundDistance::new(k, sign, sign * (own[k] - limit), weight));
        Some(Self {
            first: group.first,
            len: group.len(),
            cone,
            distances: distances.collect::<Option<_>>()?,
        })
    }
}

/// An iterate with its multipliers.
pub(super) struct Point {
    blocks: Vec<Block>,
    /// Number of unknowns.
    len: usize,
    /// Weight of the divergence without its logarithms.
    cost: f64,
}

/// A completed step.
pub(super) struct Step {
    /// Length in the metric of D.
    pub(super) length: f64,
    /// Fraction that was made.
    pub(super) part: f64,
}

impl Point {
    /// A point on the central path of a weight; `None` outside cones and bounds.
    ///
    /// `cost` is the weight of the divergence without its logarithms.
    pub(super) fn new(
        unknowns: &Unknowns,
        values: &DVector<f64>,
        weight: f64,
        cost: f64,
    ) -> Option<Self> {
        let groups = unknowns.groups.iter();
        let blocks = groups.map(|group| Block::new(group, values, weight, cost));
        Some(Self {
            blocks: blocks.collect::<Option<_>>()?,
            len: unknowns.len(),
            cost,
        })
    }

    /// Values of the unknowns.
    pub(super) fn values(&self) -> DVector<f64> {
        self.gathered(|block| block.cone.values())
    }

    /// Collects a vector over all unknowns from the cones.
    fn gathered(&self, own: impl Fn(&Block) -> Inertia) -> DVector<f64> {
        let mut all = DVector::zeros(self.len);
        for block in &self.blocks {
            let own = own(block);
            all.rows_mut(block.first, block.len)
                .copy_from(&own.rows(0, block.len));
        }
        all
    }

    /// Weight of the nearest point of the central path.
    pub(super) fn weight(&self) -> f64 {
        let (mut count, mut sum) = (0, 0.0);
        for block in &self.blocks {
            let (own, product) = block.cone.products();
            let distances: f64 = block.distances.iter().map(BoundDistance::product).sum();
            count += own + block.distances.len();
            sum += product + distances;
        }
        sum / count.max(1) as f64
    }

    /// One step towards the point of a weight.
    pub(super) fn advance(
        &mut self,
        a: &DMatrix<f64>,
        b: &DVector<f64>,
        weight: f64,
    ) -> Option<Step> {
        let equations = self.equations(a)?;
        let slope = self.slope(weight);
        let step = equations.solved(&(b - a * self.values()), &slope);
        let square = step.norm_squared() + (&equations.matrix * &step).norm_squared();
        let mut reach = f64::INFINITY;
        for block in &mut self.blocks {
            let mut own = Inertia::zeros();
            own.rows_mut(0, block.len)
                .copy_from(&step.rows(block.first, block.len));
            let change = block.cone.scaling() * own;
            reach = reach.min(block.cone.propose(&own, weight));
            for distance in &mut block.distances {
                reach = reach.min(distance.propose(change[distance.place], weight));
            }
        }
        let part = (CLEAR * reach).min(1.0);
        for block in &mut self.blocks {
            block.cone.advance(part)?;
            block
                .distances
                .iter_mut()
                .for_each(|distance| distance.advance(part));
        }
        let length = (square / self.cost).sqrt();
        (length.is_finite() && part > 0.0).then_some(Step { length, part })
    }

    /// Equations of a step: M, with an additional row for each bound.
    pub(super) fn equations(&self, a: &DMatrix<f64>) -> Option<Equations> {
        let distances: usize = self.blocks.iter().map(|block| block.distances.len()).sum();
        let mut all = DMatrix::zeros(a.nrows() + distances, self.len);
        all.rows_mut(0, a.nrows()).copy_from(a);
        let mut row = a.nrows();
        for block in &self.blocks {
            for distance in &block.distances {
                all[(row, block.first + distance.place)] = distance.stiffness().sqrt();
                row += 1;
            }
        }
        let scalings: Vec<Metric> = self.blocks.iter().map(|one| one.cone.scaling()).collect();
        for (block, scaling) in self.blocks.iter().zip(&scalings) {
            let own = scaling.view((0, 0), (block.len, block.len));
            let scaled = all.columns(block.first, block.len) * own;
            all.columns_mut(block.first, block.len).copy_from(&scaled);
        }
        let blocks = self.blocks.iter().zip(scalings);
        let scalings = blocks.map(|(block, scaling)| (block.first, block.len, scaling));
        Equations::new(all, scalings.collect())
    }

    /// Gradient in step coordinates.
    fn slope(&self, weight: f64) -> DVector<f64> {
        self.gathered(|block| {
            let mut slope = block.cone.slope(self.cost, weight);
            let scaling = block.cone.scaling();
            for distance in &block.distances {
                slope += scaling.row(distance.place).transpose() * distance.slope(weight);
            }
            slope
        })
    }
}
