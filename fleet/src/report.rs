//! Page of a fleet: drifts and outliers first, then every parameter over days and robots.

use crate::{
    catalog::LeftOut,
    chart::{Chart, Outlier, Point, Rule},
    functions::pooled,
    session::Fleet,
};
use arrow::{
    array::{Array, AsArray},
    compute::cast,
    datatypes::{DataType, Int64Type},
};
use datafusion::error::Result;
use std::{collections::BTreeMap, fmt::Write, time::Instant};

/// Distance from the fleet's median of an outlier, in standard deviations: one of 500 million
/// robots of a normal fleet.
pub const BEYOND: f64 = 6.0;

/// Largest number of robots with plots of their own.
const MOST_PLOTS: usize = 60;

/// Query for the page: estimates of each robot and day.
const QUERY: &str = "SELECT serial, CAST(date_trunc('day', time) AS BIGINT) AS day, estimate(factor) AS e \
                     FROM factors GROUP BY serial, date_trunc('day', time)";

/// Microseconds of a day.
const DAY: f64 = 86_400e6;

/// Parameters of all robots and days.
#[derive(Debug, Clone, Default)]
pub struct Days {
    /// Estimates of each robot and day.
    pub points: Vec<Point>,
    /// Robots and days without an estimate, with the reason.
    pub problems: Vec<(String, f64, String)>,
    /// Counts: runs used, duplicate records used once, damaged records, incompatible runs.
    pub counts: [u64; 4],
    /// Relative residual of each robot in percent, the largest of its days.
    pub errors: BTreeMap<String, f64>,
    /// Duration of the query, s.
    pub seconds: f64,
}

/// Queries the parameters of a fleet.
///
/// # Errors
/// Errors of the query.
pub async fn days(fleet: &mut Fleet) -> Result<Days> {
    let start = Instant::now();
    let rows = fleet.sql(QUERY).await?;
    let mut own = Days::default();
    for batch in rows {
        let serials = cast(batch.column(0), &DataType::Utf8)?;
        let days = cast(batch.column(1), &DataType::Int64)?;
        let (serials, days) = (serials.as_string::<i32>(), days.as_primitive::<Int64Type>());
        let estimates = batch.column(2).as_struct();
        for row in 0..batch.num_rows() {
            let Some(told) = pooled(estimates, row).filter(|_| days.is_valid(row)) else {
                continue;
            };
            let counts = [told.runs, told.twice, told.damaged, told.unlike];
            own.counts
                .iter_mut()
                .zip(counts)
                .for_each(|(sum, count)| *sum += count);
            let (serial, day) = (serials.value(row).to_owned(), days.value(row) as f64 / DAY);
            if !told.problem.is_empty() {
                own.problems.push((serial, day, told.problem));
                continue;
            }
            let error = own.errors.entry(serial.clone()).or_default();
            *error = error.max(told.relative_error_percent);
            let values = told.parameters.into_iter().map(|one| (one.name, one.value));
            own.points.push(Point {
                serial,
                day,
                values: values.collect(),
            });
        }
    }
    let first = own
        .points
        .iter()
        .map(|own| own.day)
        .fold(f64::INFINITY, f64::min);
    own.points.iter_mut().for_each(|own| own.day -= first);
    own.points
        .sort_by(|a, b| a.serial.cmp(&b.serial).then(a.day.total_cmp(&b.day)));
    own.seconds = start.elapsed().as_secs_f64();
    Ok(own)
}

/// Escapes a text for HTML.
fn safe(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Number with four digits.
fn short(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = (3.0 - size.log10().floor()).clamp(0.0, 7.0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.3e}"),
    }
}

/// Serial number of a robot, linked to its own report.
fn robot(serial: &str, link: Option<&str>) -> String {
    match link {
        Some(link) => {
            let link = link.replace("{serial}", serial);
            format!("<a href=\"{}\">{}</a>", safe(&link), safe(serial))
        }
        None => safe(serial),
    }
}

/// The page.
#[must_use]
pub fn page(
    days: &Days,
    (charts, outliers): (&[Chart], &[Outlier]),
    (rule, left_out): (&Rule, &[LeftOut]),
    link: Option<&str>,
) -> String {
    let mut html = String::from(HEAD);
    let alarms: Vec<&Chart> = charts.iter().filter(|own| own.alarm.is_some()).collect();
    let robots: std::collections::BTreeSet<&str> =
        days.points.iter().map(|own| own.serial.as_str()).collect();
    let [runs, twice, damaged, unlike] = days.counts;
    let _ = write!(
        html,
        "<h1>Fleet of {} robots</h1><p>{runs} runs on {} days. {} alarms of drift, {} outliers, {} days without an \
         estimate. Skipped: {} files, {twice} copies, {damaged} damaged records, {unlike} runs of another description.</p>",
        robots.len(),
        days.points
            .iter()
            .map(|own| own.day as i64 + 1)
            .max()
            .unwrap_or(0),
        alarms.len(),
        outliers.len(),
        days.problems.len(),
        left_out.len(),
    );
    drifts(&mut html, &alarms, rule, link);
    unlike_others(&mut html, outliers, link);
    troubles(&mut html, days, left_out, link);
    html.push_str("<h2>Parameters over the days</h2><p>Grey: the middle 95 % and the median of all robots; red: robots \
                   with an alarm.</p><div class=\"plots\">");
    let mut names: Vec<&str> = charts.iter().map(|own| own.parameter.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let own: Vec<&Chart> = charts.iter().filter(|own| own.parameter == name).collect();
        let accused: Vec<&Chart> = own
            .iter()
            .copied()
            .filter(|own| own.alarm.is_some())
            .collect();
        html.push_str(&plot(name, &own, &accused));
    }
    html.push_str("</div></body></html>\n");
    html
}

fn drifts(html: &mut String, alarms: &[&Chart], rule: &Rule, link: Option<&str>) {
    let _ = write!(
        html,
        "<h2>Drifts</h2><p>The probability of an alarm for a robot without drift is at most {} over all looks and parameters.</p>",
        rule.false_alarms
    );
    if alarms.is_empty() {
        html.push_str("<p>None.</p>");
        return;
    }
    html.push_str(
        "<div class=\"scroll\" tabindex=\"0\"><table><tr><th>robot<th>parameter<th>change<th>alarm on day<th>probability \
         without drift<th class=\"days\">days</tr>",
    );
    for (place, own) in alarms.iter().enumerate() {
        let plot = if place < MOST_PLOTS {
            line(own)
        } else {
            String::new()
        };
        let _ = write!(
            html,
            "<tr><td>{}<td>{}<td class=\"n\">{:+.1} %<td class=\"n\">{:.0}<td class=\"n\">{:.1e}<td class=\"days\">{plot}</tr>",
            robot(&own.serial, link),
            safe(&own.parameter),
            own.change_percent,
            own.alarm.unwrap_or(0.0).floor() + 1.0,
            own.probability,
        );
    }
    html.push_str("</table></div>");
}

fn unlike_others(html: &mut String, outliers: &[Outlier], link: Option<&str>) {
    let _ = write!(
        html,
        "<h2>Outliers</h2><p>Medians over the days that are further than {BEYOND} standard deviations of the fleet from its median.</p>"
    );
    if outliers.is_empty() {
        html.push_str("<p>None.</p>");
        return;
    }
    html.push_str(
        "<div class=\"scroll\" tabindex=\"0\"><table><tr><th>robot<th>parameter<th>value<th>fleet<th>σ</tr>",
    );
    for own in outliers {
        let _ = write!(
            html,
            "<tr><td>{}<td>{}<td class=\"n\">{}<td class=\"n\">{}<td class=\"n\">{:+.1}</tr>",
            robot(&own.serial, link),
            safe(&own.parameter),
            short(own.value),
            short(own.fleet),
            own.deviations,
        );
    }
    html.push_str("</table></div>");
}

fn troubles(html: &mut String, days: &Days, left_out: &[LeftOut], link: Option<&str>) {
    if days.problems.is_empty() && left_out.is_empty() {
        return;
    }
    html.push_str("<h2>Skipped</h2><details><summary>All</summary><table class=\"long\">");
    for own in left_out {
        let runs = match own.runs.len() {
            0 => String::new(),
            count => format!("{count} runs: "),
        };
        let _ = write!(
            html,
            "<tr><td>{}<td>{runs}{}</tr>",
            safe(&own.file),
            safe(&own.why)
        );
    }
    for (serial, _, why) in &days.problems {
        let _ = write!(
            html,
            "<tr><td>{}<td>{}</tr>",
            robot(serial, link),
            safe(why)
        );
    }
    html.push_str("</table></details>");
}

/// Scale of a plot.
struct Scale {
    days: f64,
    low: f64,
    high: f64,
    width: f64,
    height: f64,
}

impl Scale {
    fn new<'a>(all: impl Iterator<Item = &'a (f64, f64)>, (width, height): (f64, f64)) -> Self {
        let mut own = Self {
            days: 1.0,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            width,
            height,
        };
        for (day, value) in all {
            own.days = own.days.max(*day);
            own.low = own.low.min(*value);
            own.high = own.high.max(*value);
        }
        let room = ((own.high - own.low) * 0.05).max(f64::MIN_POSITIVE);
        (own.low, own.high) = (own.low - room, own.high + room);
        own
    }

    fn at(&self, day: f64, value: f64) -> String {
        let x = self.width * day / self.days;
        let y = self.height * (self.high - value) / (self.high - self.low);
        format!("{x:.1},{y:.1} ")
    }

    fn path(&self, days: &[(f64, f64)]) -> String {
        days.iter().map(|own| self.at(own.0, own.1)).collect()
    }
}

/// Small line plot of a robot's days.
fn line(own: &Chart) -> String {
    let scale = Scale::new(own.days.iter(), (160.0, 28.0));
    format!(
        "<svg viewBox=\"0 0 160 28\" preserveAspectRatio=\"none\" class=\"line\"><polyline class=\"own\" points=\"{}\"/></svg>",
        scale.path(&own.days)
    )
}

/// Plot of a parameter of all robots, with those that raised alarms.
fn plot(name: &str, all: &[&Chart], accused: &[&Chart]) -> String {
    let mut of_day: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
    for (day, value) in all.iter().flat_map(|own| &own.days) {
        of_day.entry(day.floor() as i64).or_default().push(*value);
    }
    let quantile =
        |values: &[f64], part: f64| values[((values.len() - 1) as f64 * part).round() as usize];
    let bands = of_day.into_iter().map(|(day, mut values)| {
        values.sort_by(f64::total_cmp);
        let own = [0.025, 0.5, 0.975].map(|part| quantile(&values, part));
        (day as f64, own)
    });
    let bands: Vec<(f64, [f64; 3])> = bands.collect();
    let of = |which: usize| -> Vec<(f64, f64)> {
        bands.iter().map(|own| (own.0, own.1[which])).collect()
    };
    let (low, middle, high) = (of(0), of(1), of(2));
    let lines = accused.iter().flat_map(|own| &own.days);
    let scale = Scale::new(low.iter().chain(&high).chain(lines), (300.0, 120.0));
    let back: Vec<(f64, f64)> = high.iter().rev().copied().collect();
    let mut svg = format!(
        "<figure><figcaption>{}</figcaption><svg viewBox=\"0 0 300 120\" class=\"plot\"><polygon class=\"band\" points=\"{}{}\"/>\
         <polyline class=\"middle\" points=\"{}\"/>",
        safe(name),
        scale.path(&low),
        scale.path(&back),
        scale.path(&middle)
    );
    for own in accused {
        let _ = write!(
            svg,
            "<polyline class=\"own\" points=\"{}\"><title>{}</title></polyline>",
            scale.path(&own.days),
            safe(&own.serial)
        );
    }
    let _ = write!(
        svg,
        "</svg><small>{} to {}, days 1 to {:.0}</small></figure>",
        short(scale.low),
        short(scale.high),
        scale.days.floor() + 1.0
    );
    svg
}

/// Start of the HTML document.
const HEAD: &str = "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
content=\"width=device-width\"><title>Fleet</title><style>:root{color-scheme:light dark;--own:#b22;--band:#8884}\
@media(prefers-color-scheme:dark){:root{--own:#f77}}body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;\
max-width:70em;padding:0 1em}.scroll{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums}\
td,th{padding:.15em .8em .15em 0;text-align:left;white-space:nowrap;vertical-align:middle}th{vertical-align:bottom;\
border-bottom:1px solid #8888;white-space:normal}.n{text-align:right}.long td{white-space:normal;overflow-wrap:anywhere;\
vertical-align:top}.plots{display:flex;flex-wrap:wrap;gap:1em 1.5em}figure{margin:0;width:300px;max-width:100%;\
break-inside:avoid}figure small{display:block}svg{display:block;overflow:visible}.line{width:160px;height:28px}.plot{\
width:100%;height:auto}polyline{fill:none;stroke-width:1.5;vector-effect:non-scaling-stroke}.band{fill:var(--band)}\
.middle{stroke:#888}.own{stroke:var(--own)}@media(max-width:40em){body{font-size:13px}td,th{padding-right:.5em}.days{\
display:none}}@media print{:root{color-scheme:light;--own:#b22;--band:#ccc}body{font-size:10pt;margin:0;\
max-width:none}.scroll{overflow:visible}tr{break-inside:avoid}h2{break-after:avoid}a{color:inherit}}</style></head><body>";
