//! Dates and times of day as texts: `2026-03-01T10:00:00.001Z`, `01.03.2026 10:00:00`,
//! `3/1/2026 10:00:00.001 PM`, `01-Mar-2026 10:00:00`, `10:00:00.001`.
//!
//! Times of day count from midnight. Dates count from midnight (UTC) of the day on which the log
//! starts, so that steps of microseconds keep their digits. A time without a zone is taken as it is.

use jiff::{
    Timestamp,
    civil::{DateTime, Time},
};

/// Seconds of a day.
const DAY: f64 = 86_400.0;

/// A step back by more than this is midnight, s.
const MIDNIGHT: f64 = DAY / 2.0;

/// A date with a time, or a time of day.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::formats) struct Instant {
    /// Days since 1970; `None` for a time of day.
    pub(in crate::formats) day: Option<i64>,
    /// Time of the day, s.
    pub(in crate::formats) seconds: f64,
}

impl Instant {
    /// Parses a cell, if it is a date with a time, or a time of day with seconds.
    pub(in crate::formats) fn parse(cell: &str) -> Option<Self> {
        let cell = cell.trim();
        let is_digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
        if !is_digit(cell.as_bytes().first()) || cell.matches(':').count() < 2 {
            return None;
        }
        let cell = of_24_hours(&cell.replace(',', "."))?;
        let parts = cell.split_once(' ');
        let Some((date, time)) = parts.or_else(|| cell.split_once(['T', 't'])) else {
            let time: Time = cell.parse().ok()?;
            return Some(Self::of(None, time));
        };
        let text = format!("{}T{}", iso_date(date)?, time.trim());
        if let Ok(time) = text.parse::<Timestamp>() {
            let day = time.as_second().div_euclid(86_400);
            let second = time.as_second().rem_euclid(86_400) as f64;
            let seconds = second + f64::from(time.subsec_nanosecond()) * 1e-9;
            return Some(Self {
                day: Some(day),
                seconds,
            });
        }
        let time: DateTime = text.parse().ok()?;
        let first = jiff::civil::date(1970, 1, 1);
        let days = time.date().since(first).ok()?.get_days();
        Some(Self::of(Some(i64::from(days)), time.time()))
    }

    fn of(day: Option<i64>, time: Time) -> Self {
        let whole = 3600 * i32::from(time.hour())
            + 60 * i32::from(time.minute())
            + i32::from(time.second());
        Self {
            day,
            seconds: f64::from(whole) + f64::from(time.subsec_nanosecond()) * 1e-9,
        }
    }

    /// Seconds since `origin`, in s since 1970; a time of day is that since midnight.
    pub(in crate::formats) fn since(self, origin: i64) -> f64 {
        self.seconds + self.day.map_or(0, |day| 86_400 * day - origin) as f64
    }
}

/// A cell whose time of day has 24 hours; `None` for an hour that `AM` or `PM` does not allow.
fn of_24_hours(cell: &str) -> Option<String> {
    let lower = cell.to_ascii_lowercase();
    let suffixes = [("am", 0), ("a.m.", 0), ("pm", 12), ("p.m.", 12)];
    let found = suffixes
        .iter()
        .find_map(|(suffix, more)| Some((lower.strip_suffix(suffix)?, more)));
    let Some((rest, more)) = found else {
        return Some(cell.to_owned());
    };
    let rest = rest.trim_end();
    let start = rest.rfind([' ', 't']).map_or(0, |place| place + 1);
    let (date, time) = rest.split_at(start);
    let (hour, minutes) = time.split_once(':')?;
    let hour: u32 = hour.parse().ok().filter(|hour| (1..=12).contains(hour))?;
    Some(format!("{date}{:02}:{minutes}", hour % 12 + more))
}

const MONTHS: [&str; 12] = [
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
];

/// A date as `YYYY-MM-DD`.
///
/// Dates with points or hyphens start with the day, those with slashes with the month, unless a
/// number above 12 excludes that. If that is wrong, a log over midnight has a gap, which is reported.
fn iso_date(date: &str) -> Option<String> {
    let parts: Vec<&str> = date.split(['-', '/', '.']).collect();
    let [first, second, third] = parts[..] else {
        return None;
    };
    let number = |part: &str| {
        let lower = part.to_ascii_lowercase();
        let month = MONTHS.iter().position(|name| *name == lower);
        month.map(|month| month + 1).or_else(|| part.parse().ok())
    };
    let (year, month, day) = if first.len() == 4 {
        (first, number(second)?, number(third)?)
    } else if third.len() == 4 {
        let (first, second) = (number(first)?, number(second)?);
        let is_month_first = second > 12 || date.contains('/') && first <= 12;
        let (month, day) = if is_month_first {
            (first, second)
        } else {
            (second, first)
        };
        (third, month, day)
    } else {
        return None;
    };
    Some(format!("{year}-{month:02}-{day:02}"))
}

/// Times of day of one column, continued over midnight.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::formats) struct Midnights {
    days: f64,
    last: f64,
}

impl Midnights {
    /// The time of day of the next row, in seconds from the first midnight.
    pub(in crate::formats) fn next(&mut self, seconds: f64) -> f64 {
        if seconds < self.last - MIDNIGHT {
            self.days += 1.0;
        }
        self.last = seconds;
        self.days * DAY + seconds
    }
}

#[cfg(test)]
mod tests {
    use super::{Instant, Midnights};

    fn since(cell: &str, day: i64) -> Option<f64> {
        Instant::parse(cell).map(|instant| instant.since(86_400 * day))
    }

    #[test]
    fn dates_and_times_of_day_become_seconds() {
        // 2026-03-01 is day 20513 since 1970.
        for cell in [
            "2026-03-01T10:00:00.5Z",
            "2026-03-01 10:00:00,5",
            "2026/3/1 10:00:00.5",
            "01.03.2026 10:00:00.5",
            "2026-03-01T12:00:00.5+02:00",
            "3/1/2026 10:00:00.5 AM",
            "03/01/2026 10:00:00.5",
            "1-3-2026 10:00:00.5",
            "01-Mar-2026 10:00:00.5",
        ] {
            assert_eq!(since(cell, 20_513), Some(36_000.5), "{cell}");
        }
        assert_eq!(since("2026-03-02T00:00:01Z", 20_513), Some(86_401.0));
        assert_eq!(since("10:00:00.25", 20_513), Some(36_000.25));
        assert_eq!(since("10:00:00.25 pm", 20_513), Some(79_200.25));
        assert_eq!(since("12:00:01 a.m.", 20_513), Some(1.0));
        // A number above 12 is the day, wherever it is.
        for cell in [
            "28/11/2026 00:00:01",
            "11/28/2026 00:00:01",
            "28-Nov-2026 12:00:01 AM",
        ] {
            assert_eq!(since(cell, 20_785), Some(1.0), "{cell}");
        }
    }

    #[test]
    fn cells_that_are_not_times_are_rejected() {
        for cell in [
            "",
            "1.5",
            "q1",
            "10:00",
            "13/13/2026 10:00:00",
            "3/4/26 10:00:00",
            "13:00:00 PM",
            "0:00:00 AM",
            "25:00:00",
            "1:2:3:4",
            "a:b:c",
        ] {
            assert_eq!(since(cell, 0), None, "{cell}");
        }
    }

    #[test]
    fn times_of_day_continue_past_midnight() {
        let mut midnights = Midnights::default();
        let times = [86_399.0, 86_399.5, 0.0, 0.5].map(|time| midnights.next(time));
        assert_eq!(times, [86_399.0, 86_399.5, 86_400.0, 86_400.5]);
    }
}
