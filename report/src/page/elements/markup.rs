//! Markup helpers: escaped text, figures, sections, numbers with intervals.
//!
//! All markup is well-formed XML, so that tests can parse it.

use crate::{plot::power_of_ten, text::escape};
use overact_identification::significant;

/// Plots with one caption; `key` explains the lines and may be empty.
pub(crate) fn figure(id: &str, plots: &[String], key: &str, caption: &str) -> String {
    let columns = match plots.len() {
        0 | 1 => "one",
        2 | 4 => "two",
        _ => "three",
    };
    format!(
        "<figure id=\"{id}\">{key}<div class=\"plots {columns}\">{}</div><figcaption>{caption}</figcaption></figure>\n",
        plots.concat()
    )
}

/// Key of a figure: line classes and names.
pub(crate) fn key<Name: AsRef<str>>(entries: &[(&str, Name)]) -> String {
    let entry = |(class, name): &(&str, Name)| {
        format!(
            "<li><i class=\"swatch {class}\"></i>{}</li>",
            escape(name.as_ref())
        )
    };
    format!(
        "<ul class=\"key\">{}</ul>",
        entries.iter().map(entry).collect::<String>()
    )
}

/// Section of the page with a heading.
#[derive(Debug, Clone)]
pub(crate) struct Section {
    /// Anchor.
    pub(crate) id: &'static str,
    /// Heading.
    pub(crate) title: &'static str,
    /// Contents; sections without contents are omitted.
    pub(crate) body: String,
}

impl Section {
    /// HTML element.
    pub(crate) fn html(&self) -> String {
        format!(
            "<section id=\"{}\" aria-labelledby=\"{}-title\"><h2 id=\"{}-title\">{}</h2>\n{}</section>\n",
            self.id,
            self.id,
            self.id,
            escape(self.title),
            self.body
        )
    }
}

/// Text as markup; backticks mark code, and numbers keep their percent sign.
pub(crate) fn prose(text: &str) -> String {
    let text = text.replace(" %", "\u{a0}%");
    let mut html = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once('`') {
        let Some((code, after)) = after.split_once('`') else {
            break;
        };
        html.push_str(&escape(before));
        html.push_str("<code>");
        html.push_str(&escape(code));
        html.push_str("</code>");
        rest = after;
    }
    html + &escape(rest)
}

/// A paragraph of text.
pub(crate) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", prose(text))
}

/// Note below a table or a figure.
pub(crate) fn note(text: &str) -> String {
    format!("<p class=\"note\">{}</p>\n", prose(text))
}

/// Collapsed contents.
pub(crate) fn details(summary: &str, body: &str) -> String {
    format!(
        "<details><summary>{}</summary>\n{body}</details>\n",
        escape(summary)
    )
}

/// Capitalises the first letter.
pub(crate) fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(characters).collect()
    })
}

/// Largest number of decimals of a value beyond those of its interval.
const MOST_MORE: usize = 3;

/// Value and interval, rounded by the interval's width.
///
/// An example is `0.044641` and `0.044570 … 0.044712`. The interval is `None` if unknown.
pub(crate) fn with_interval(value: f64, low: f64, high: f64) -> (String, Option<String>) {
    let half = 0.5 * (high - low);
    let known = value.is_finite() && half.is_finite() && half > 0.0;
    if !known {
        return (significant(value, 5).replace('-', "−"), None);
    }
    let size = value.abs().max(low.abs()).max(high.abs());
    let exponent = size.log10().floor() as i32;
    // Two digits of the half width, at most eight digits of the value.
    let last = (half.log10().floor() as i32 - 1).max(exponent - 7);
    let fixed = (-4..6).contains(&exponent) && last <= 0;
    let (scale, decimals) = if fixed {
        (1.0, -last)
    } else {
        (10_f64.powi(exponent), exponent - last)
    };
    let decimals = usize::try_from(decimals).unwrap_or(0);
    let rounded =
        |value: f64, decimals: usize| format!("{:.decimals$}", value / scale).replace('-', "−");
    let digits = |value: f64| rounded(value, decimals);
    let interval = format!("{} … {}", digits(low), digits(high));
    // A value far below the width of its interval keeps two digits.
    let first = (value / scale).abs().log10().floor();
    let own = if first.is_finite() {
        usize::try_from(1 - first as i32).unwrap_or(0)
    } else {
        0
    };
    let value = rounded(value, decimals.max(own.min(decimals + MOST_MORE)));
    if fixed {
        return (value, Some(interval));
    }
    let power = power_of_ten(&exponent.to_string());
    let interval = format!("({interval})·{power}");
    (format!("{value}·{power}"), Some(interval))
}

#[cfg(test)]
mod tests {
    use super::{prose, with_interval};

    #[test]
    fn paired_backticks_become_code() {
        assert_eq!(
            prose("set `a<b` or `c`"),
            "set <code>a&lt;b</code> or <code>c</code>"
        );
        assert_eq!(
            prose("a ` alone, `b` & c"),
            "a <code> alone, </code>b` &amp; c"
        );
        assert_eq!(prose("5` <"), "5` &lt;");
    }

    #[test]
    fn values_are_rounded_to_the_precision_of_their_interval() {
        let both = |value, [low, high]: [f64; 2]| {
            let (value, interval) = with_interval(value, low, high);
            format!("{value} in {}", interval.unwrap_or_default())
        };
        assert_eq!(
            both(0.044_641_2, [0.044_57, 0.044_712]),
            "0.044641 in 0.044570 … 0.044712"
        );
        assert_eq!(
            both(-5.417_766, [-5.4237, -5.4118]),
            "−5.4178 in −5.4237 … −5.4118"
        );
        assert_eq!(
            both(1.234e-6, [1.13e-6, 1.336e-6]),
            "1.23·10⁻⁶ in (1.13 … 1.34)·10⁻⁶"
        );
        assert_eq!(both(12.0, [-588.0, 612.0]), "0.12·10² in (−5.9 … 6.1)·10²");
        assert_eq!(both(-0.346, [-12.1, 11.4]), "−0.35 in −12 … 11");
        assert_eq!(both(1.5, [1.5, 1.5]), "1.5 in ");
        assert_eq!(both(f64::NAN, [0.0, 1.0]), "undefined in ");
    }
}
