//! Axes: range, round ticks and labels.

/// Smallest relative range; below it, only rounding would be visible.
const NARROWEST: f64 = 1e-9;

/// Values from this magnitude on count as not finite, because they would overflow in the layout.
const LARGEST: f64 = 1e150;

/// Largest number of decades of a logarithmic axis.
const MOST_DECADES: f64 = 9.0;

/// Type of scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ScaleKind {
    /// Linear.
    Linear,
    /// Logarithmic; values that are not positive are omitted.
    Logarithmic,
}

/// An axis.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// Label with unit.
    pub(crate) label: String,
    /// Type of scale.
    pub(crate) kind: ScaleKind,
    /// Values that the range must include.
    pub(crate) includes: Vec<f64>,
}

impl Axis {
    /// A linear axis.
    pub(crate) fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            kind: ScaleKind::Linear,
            includes: Vec::new(),
        }
    }

    /// A logarithmic axis.
    pub(crate) fn logarithmic(label: impl Into<String>) -> Self {
        Self {
            kind: ScaleKind::Logarithmic,
            ..Self::linear(label)
        }
    }

    /// Extends the range to include values.
    pub(crate) fn including(mut self, values: &[f64]) -> Self {
        self.includes.extend_from_slice(values);
        self
    }

    /// Scale for all `values`, drawn from `from` to `to` in SVG units, with about `count` ticks.
    ///
    /// A `tight` scale ends at the data, others at ticks.
    pub(super) fn scale(
        &self,
        values: impl Iterator<Item = f64>,
        from: f64,
        to: f64,
        count: usize,
        tight: bool,
    ) -> Scale {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut least_step = 1.0;
        for value in values.chain(self.includes.iter().copied()) {
            let fits = value.abs() < LARGEST && (self.kind == ScaleKind::Linear || value > 0.0);
            if fits {
                (low, high) = (low.min(value), high.max(value));
                // Integer data have no ticks between integers.
                if value.fract() != 0.0 {
                    least_step = 0.0;
                }
            }
        }
        let (low, high, ticks) = match self.kind {
            ScaleKind::Linear => linear(low, high, count, least_step, tight),
            ScaleKind::Logarithmic => logarithmic(low, high, count),
        };
        Scale {
            kind: self.kind,
            low,
            high,
            from,
            to,
            ticks,
        }
    }
}

/// Scale of an axis with range and ticks.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    kind: ScaleKind,
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    /// Values and labels of the ticks.
    pub(super) ticks: Vec<(f64, String)>,
}

impl Scale {
    /// Position of a value; `None` if the scale cannot show it.
    pub(super) fn at(&self, value: f64) -> Option<f64> {
        let part = match self.kind {
            _ if value.abs() >= LARGEST => return None,
            ScaleKind::Linear => (value - self.low) / (self.high - self.low),
            ScaleKind::Logarithmic if value > 0.0 => {
                (value / self.low).ln().max(0.0) / (self.high / self.low).ln()
            }
            ScaleKind::Logarithmic => return None,
        };
        part.is_finite()
            .then_some(self.from + part * (self.to - self.from))
    }
}

/// Range and ticks of a linear scale with a smallest tick step; from 0 to 1 without data.
fn linear(
    low: f64,
    high: f64,
    count: usize,
    least_step: f64,
    tight: bool,
) -> (f64, f64, Vec<(f64, String)>) {
    let (mut low, mut high) = if low <= high { (low, high) } else { (0.0, 1.0) };
    let size = low.abs().max(high.abs());
    if high - low <= NARROWEST * size || high == low {
        let half = if size > 0.0 { 0.5 * size } else { 1.0 };
        (low, high) = (low - half, high + half);
    }
    let step = round_step((high - low) / count.max(1) as f64).max(least_step);
    if !tight {
        low = (low / step + NARROWEST).floor() * step;
        high = (high / step - NARROWEST).ceil() * step;
    }
    let first = (low / step - NARROWEST).ceil() as i64;
    let last = (high / step + NARROWEST).floor() as i64;
    let ticks = (first..=last.min(first.saturating_add(50)))
        .map(|index| {
            let value = index as f64 * step;
            (value, label(value, step, size))
        })
        .collect();
    (low, high, ticks)
}

/// Smallest step of 1, 2 or 5 times a power of ten that is not below `rough`.
fn round_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    let mantissa = rough / power;
    let round = [1.0, 2.0, 5.0].into_iter().find(|m| mantissa <= m * 1.0001);
    round.unwrap_or(10.0) * power
}

/// Label of a tick with the decimals of its step; scientific if that would be long.
fn label(value: f64, step: f64, size: f64) -> String {
    let exponent = step.log10().floor() as i32;
    if size >= 1e5 || exponent < -4 {
        return scientific(value);
    }
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    // Typographic minus sign.
    format!("{value:.decimals$}").replace('-', "−")
}

/// `2·10⁻⁵`.
fn scientific(value: f64) -> String {
    if value == 0.0 {
        return String::from("0");
    }
    let text = format!("{value:.1e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = mantissa.strip_suffix(".0").unwrap_or(mantissa);
    let power = power_of_ten(exponent);
    match mantissa {
        "1" => power,
        "-1" => format!("−{power}"),
        other => format!("{}·{power}", other.replace('-', "−")),
    }
}

/// `10⁻⁵` from `-5`.
pub(crate) fn power_of_ten(exponent: &str) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = exponent.chars().map(|c| match c.to_digit(10) {
        Some(digit) => DIGITS[digit as usize % 10],
        None => '⁻',
    });
    format!("10{}", raised.collect::<String>())
}

/// Range and ticks of a logarithmic scale: whole decades.
fn logarithmic(low: f64, high: f64, count: usize) -> (f64, f64, Vec<(f64, String)>) {
    let (low, high) = if low <= high {
        (low, high)
    } else {
        (1.0, 10.0)
    };
    let last = (high.log10() - NARROWEST).ceil();
    let mut first = (low.log10() + NARROWEST)
        .floor()
        .max(last - MOST_DECADES)
        .min(last - 1.0);
    if !first.is_finite() {
        first = last - 1.0;
    }
    let decades = (last - first) as i32;
    let every = (decades as usize).div_ceil(count.max(1)).max(1);
    let ticks = (0..=decades)
        .step_by(every)
        .map(|decade| {
            let exponent = first as i32 + decade;
            let value = 10_f64.powi(exponent);
            let text = match exponent {
                -1..=3 => format!("{value}"),
                _ => power_of_ten(&exponent.to_string()),
            };
            (value, text)
        })
        .collect();
    (10_f64.powf(first), 10_f64.powf(last), ticks)
}

#[cfg(test)]
mod tests {
    use super::{Axis, scientific};

    fn labels(axis: &Axis, values: &[f64]) -> Vec<String> {
        let scale = axis.scale(values.iter().copied(), 0.0, 100.0, 5, false);
        scale.ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_span_the_data() {
        let axis = Axis::linear("x");
        assert_eq!(
            labels(&axis, &[-0.31, 0.42]),
            ["−0.4", "−0.2", "0.0", "0.2", "0.4", "0.6"]
        );
        assert_eq!(
            labels(&axis, &[0.0, 3e-6]),
            ["0", "10⁻⁶", "2·10⁻⁶", "3·10⁻⁶"]
        );
        assert_eq!(
            labels(&Axis::logarithmic("x"), &[0.02, 300.0]),
            ["10⁻²", "0.1", "1", "10", "100", "1000"]
        );
        assert_eq!(labels(&axis, &[1.0, 2.0, 3.0]), ["1", "2", "3"]);
        assert_eq!(scientific(-2.5e5), "−2.5·10⁵");
    }

    #[test]
    fn degenerate_data_have_a_finite_scale() {
        for axis in [Axis::linear("x"), Axis::logarithmic("x")] {
            for values in [
                vec![],
                vec![f64::NAN, f64::INFINITY],
                vec![0.0],
                vec![5.0, 5.0],
                vec![1e-300, 1e300],
                vec![1e-300, 1e140],
                vec![-1e308, 1e308],
            ] {
                let scale = axis.scale(values.iter().copied(), 0.0, 100.0, 5, false);
                assert!(scale.ticks.len() < 60, "{values:?}");
                for value in &values {
                    if let Some(place) = scale.at(*value) {
                        assert!(place.is_finite(), "{values:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn values_are_mapped_to_axis_positions() {
        let linear = Axis::linear("x").scale([0.0, 10.0].into_iter(), 0.0, 100.0, 5, true);
        assert_eq!(linear.at(2.5), Some(25.0));
        let log = Axis::logarithmic("x").scale([1.0, 100.0].into_iter(), 0.0, 100.0, 5, false);
        assert!(
            log.at(10.0)
                .is_some_and(|place| (place - 50.0).abs() < 1e-9)
        );
        assert_eq!(log.at(-1.0), None);
    }
}
