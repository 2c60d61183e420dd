//! Partitions of the actuators for the actuator projection.

/// Largest number of partitions that are listed.
const MAX_PARTITIONS: usize = 1000;

/// Choices of r kept actuators among n, in lexicographic order; none if r > n.
///
/// At most the first thousand choices are returned.
///
/// ```
/// assert_eq!(overact_robot::partitions(3, 2), [[0, 1], [0, 2], [1, 2]]);
/// ```
#[must_use]
pub fn partitions(n: usize, r: usize) -> Vec<Vec<usize>> {
    if r > n {
        return Vec::new();
    }
    let mut all = vec![(0..r).collect::<Vec<usize>>()];
    while all.len() < MAX_PARTITIONS
        && let Some(last) = all.last()
        && let Some(at) = (0..r).rev().find(|&i| last[i] < n - r + i)
    {
        let mut next = last.clone();
        next[at] += 1;
        for i in at + 1..r {
            next[i] = next[i - 1] + 1;
        }
        all.push(next);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::partitions;

    #[test]
    fn all_partitions_are_enumerated() {
        let four = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
        assert_eq!(partitions(4, 3), four);
        assert_eq!(partitions(8, 6).len(), 28);
        assert_eq!(partitions(2, 2), [[0, 1]]);
    }
}
