//! Successive angles and rates of ball joints, and of universal joints at rods.

use crate::assembly::{motion::State, network::Network};
use nalgebra::{DMatrix, Matrix3, Rotation3, Unit, Vector3};

/// A ball joint as in the description: successive rotations, the first about a fixed axis of its
/// base.
///
/// All vectors are expressed in the world frame at home.
#[derive(Clone)]
pub(super) struct Ball {
    from: usize,
    to: usize,
    axes: Vec<Vector3<f64>>,
    /// For a rod (two angles): direction of its line at home.
    line: Option<Vector3<f64>>,
    /// If the joint starts on a rod: the universal joint of that rod. The file lets the rod spin;
    /// the description does not.
    rod: Option<Box<Ball>>,
}

impl Ball {
    /// Ball joint from one group to another, with axes at home.
    ///
    /// `None` if there are neither two nor three axes.
    pub(super) fn new(
        network: &Network<'_>,
        from: usize,
        to: usize,
        axes: &[Vector3<f64>],
        before: &[(usize, Self)],
    ) -> Option<Self> {
        let rod = before
            .iter()
            .find(|(_, own)| own.to == from && own.line.is_some());
        let line = (axes.len() == 2).then(|| network.line(to, &network.states[0]));
        (2..=3).contains(&axes.len()).then(|| Self {
            from,
            to,
            axes: axes.to_vec(),
            line,
            rod: rod.map(|(_, own)| Box::new(own.clone())),
        })
    }

    /// Rotation of a group from home.
    fn turned(network: &Network<'_>, group: usize, state: &State) -> Rotation3<f64> {
        let body = network.groups[group].bodies[0];
        state.poses[body].rotation * network.states[0].poses[body].rotation.inverse()
    }

    /// Rotation of the base body from home; a rod rotates as its universal joint does.
    fn start(&self, network: &Network<'_>, state: &State) -> Rotation3<f64> {
        match &self.rod {
            None => Self::turned(network, self.from, state),
            Some(rod) => rod.turns(network, state).1,
        }
    }

    /// Current axes, and the rotation of the carried body from home.
    fn turns(&self, network: &Network<'_>, state: &State) -> (Vec<Vector3<f64>>, Rotation3<f64>) {
        let angles = self.angles(network, state);
        let mut turned = self.start(network, state);
        let mut axes = Vec::new();
        for (axis, angle) in self.axes.iter().zip(&angles) {
            axes.push(turned * axis);
            turned *= Rotation3::from_axis_angle(&Unit::new_normalize(*axis), *angle);
        }
        (axes, turned)
    }

    /// Angular velocity of the base body for each motion.
    fn start_rates(
        &self,
        network: &Network<'_>,
        state: &State,
        twists: &[DMatrix<f64>],
    ) -> Option<DMatrix<f64>> {
        let Some(rod) = &self.rod else {
            return Some(twists[self.from].rows(3, 3).into_owned());
        };
        let (axes, _) = rod.turns(network, state);
        let mut all = rod.start_rates(network, state, twists)?;
        for (axis, rates) in axes.iter().zip(rod.rates(network, state, twists)?) {
            all += axis * DMatrix::from_row_slice(1, rates.len(), &rates);
        }
        Some(all)
    }

    /// Angles, zero at home.
    pub(super) fn angles(&self, network: &Network<'_>, state: &State) -> Vec<f64> {
        let a = self.start(network, state);
        let b = Self::turned(network, self.to, state);
        let relative = a.inverse() * b;
        match &self.line {
            None => {
                let third = self.axes[0].cross(&self.axes[1]);
                let basis = Matrix3::from_columns(&[self.axes[0], self.axes[1], third]);
                let m = basis.transpose() * relative.matrix() * basis;
                // Rx(a) Ry(b) Rz(c).
                let sign = third.dot(&self.axes[2]).signum();
                let second = m[(0, 2)].clamp(-1.0, 1.0).asin();
                vec![
                    (-m[(1, 2)]).atan2(m[(2, 2)]),
                    second,
                    sign * (-m[(0, 1)]).atan2(m[(0, 0)]),
                ]
            }
            Some(line) => {
                let first = self.axes[0];
                let across = (line - first * first.dot(line)).normalize();
                let sign = first.cross(&across).dot(&self.axes[1]).signum();
                let now = relative * line;
                let polar = |d: &Vector3<f64>| d.dot(&first).clamp(-1.0, 1.0).acos();
                let turn = now.dot(&first.cross(&across)).atan2(now.dot(&across));
                vec![turn, sign * (polar(&now) - polar(line))]
            }
        }
    }

    /// Rates of its angles for each motion, given the groups' `twists`.
    pub(super) fn rates(
        &self,
        network: &Network<'_>,
        state: &State,
        twists: &[DMatrix<f64>],
    ) -> Option<Vec<Vec<f64>>> {
        let (axes, _) = self.turns(network, state);
        let relative = twists[self.to].rows(3, 3) - self.start_rates(network, state, twists)?;
        let columns: Vec<Vector3<f64>> = match self.line {
            None => axes.clone(),
            Some(_) => {
                let line = network.line(self.to, state);
                axes.iter().map(|axis| axis.cross(&line)).collect()
            }
        };
        let matrix = DMatrix::from_fn(3, columns.len(), |i, j| columns[j][i]);
        let inverse = matrix.pseudo_inverse(1e-9).ok()?;
        let moved = DMatrix::from_fn(3, relative.ncols(), |i, j| {
            let rate = Vector3::new(relative[(0, j)], relative[(1, j)], relative[(2, j)]);
            match self.line {
                None => rate[i],
                Some(_) => rate.cross(&network.line(self.to, state))[i],
            }
        });
        let rates = inverse * moved;
        Some(
            rates
                .row_iter()
                .map(|row| row.iter().copied().collect())
                .collect(),
        )
    }
}
