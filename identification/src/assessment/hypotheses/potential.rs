//! Potentials of the first joints of a tree: constant forces and weights that the model lacks.
//!
//! A constant force f on a point p of a body does the work f · p(q). Each coordinate of p is a sum
//! of products with one factor of each joint between base and body: 1, sin q or cos q of a revolute
//! joint, 1 or q of a prismatic one. The torques of any such force, at any point and in any
//! direction of the base frame, are therefore combinations of the gradients of these products.

use overact::Model;

use crate::kinematics::conditioning::couples;

/// Largest number of joints; the number of products grows exponentially.
pub(super) const MOST: usize = 3;

/// The first joints of a tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FirstJoints {
    count: usize,
    is_revolute: [bool; MOST],
}

impl FirstJoints {
    /// The first joints of a robot; `None` for loops, and for fewer than two joints.
    pub(super) fn new(model: &dyn Model) -> Option<Self> {
        let info = model.info();
        let sizes = info.sizes;
        let is_tree = sizes.actuators == sizes.dof && !couples(model);
        let mut is_revolute = [true; MOST];
        let known = is_revolute.iter_mut().zip(info.actuator_is_revolute);
        known.for_each(|(own, revolute)| *own = *revolute);
        let count = sizes.actuators.min(MOST);
        (is_tree && count > 1).then_some(Self { count, is_revolute })
    }

    /// Number of these joints.
    pub(super) const fn count(self) -> usize {
        self.count
    }

    /// Number of factors of a joint.
    const fn factors(self, joint: usize) -> usize {
        if self.is_revolute[joint] { 3 } else { 2 }
    }

    /// Number of products that are not constant.
    pub(super) const fn products(self) -> usize {
        let (mut all, mut joint) = (1, 0);
        while joint < self.count {
            all *= self.factors(joint);
            joint += 1;
        }
        all - 1
    }

    /// Derivatives of a product by the positions of these joints.
    pub(super) fn gradient(self, product: usize, positions: &[f64]) -> [f64; MOST] {
        let mut rest = product + 1;
        let mut factors = [(1.0, 0.0); MOST];
        for (joint, factor) in factors.iter_mut().enumerate().take(self.count) {
            let position = positions[joint];
            let (sine, cosine) = position.sin_cos();
            *factor = match (rest % self.factors(joint), self.is_revolute[joint]) {
                (0, _) => (1.0, 0.0),
                (1, true) => (sine, cosine),
                (_, true) => (cosine, -sine),
                (_, false) => (position, 1.0),
            };
            rest /= self.factors(joint);
        }
        std::array::from_fn(|joint| {
            let others = factors.iter().enumerate().filter(|(own, _)| *own != joint);
            let others: f64 = others.map(|(_, (value, _))| value).product();
            others * factors[joint].1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::FirstJoints;

    #[test]
    fn gradients_agree_with_differences_of_the_products() {
        let joints = FirstJoints {
            count: 3,
            is_revolute: [true, false, true],
        };
        assert_eq!(joints.products(), 17);
        let at = [0.3, 0.2, -0.7];
        // sin q1 · q2 · cos q3 has the digits 1, 1 and 2.
        let product = 1 + 3 + 2 * 6 - 1;
        let value = |q: [f64; 3]| q[0].sin() * q[1] * q[2].cos();
        let gradient = joints.gradient(product, &at);
        for joint in 0..3 {
            let mut moved = at;
            moved[joint] += 1e-6;
            let difference = (value(moved) - value(at)) / 1e-6;
            assert!((gradient[joint] - difference).abs() < 1e-5);
        }
        let joints = FirstJoints { count: 2, ..joints };
        assert_eq!(joints.products(), 5);
        assert_eq!(joints.gradient(0, &at), [0.3_f64.cos(), 0.0, 0.0]);
    }
}
