//! Parses and formats dates.

use crate::failure::{Failure, Problem};
use overact_codegen::diagnostic::Code;

/// Days from 1970-01-01 to a Gregorian date; `None` if the date does not exist.
fn days(year: i64, month: i64, day: i64) -> Option<i64> {
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let february = if leap { 29 } else { 28 };
    let months = [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let place = usize::try_from(month - 1).ok()?;
    let longest = *months.get(place)?;
    if !(1970..=9999).contains(&year) || !(1..=longest).contains(&day) {
        return None;
    }
    let before = year - 1;
    let leaps = before / 4 - before / 100 + before / 400;
    let to_1970 = 719_162;
    let own: i64 = months[..place].iter().sum();
    Some(before * 365 + leaps - to_1970 + own + day - 1)
}

/// Instant in µs since 1970 from `2026-03-02` or `2026-03-02T14:05:00`, UTC.
///
/// # Errors
/// A text of another form.
pub(crate) fn instant(text: &str) -> Result<i64, Failure> {
    let none = || {
        let help = "write `2026-03-02` or `2026-03-02T14:05:00`, UTC";
        Failure::from(Problem::new(Code::USAGE, format!("`{text}` is not a time")).help(help))
    };
    let plain = text.strip_suffix('Z').unwrap_or(text);
    let (day, time) = plain.split_once('T').unwrap_or((plain, "00:00:00"));
    let three = |text: &str, mark: char| -> Option<[i64; 3]> {
        let digits = |one: &str| one.bytes().all(|byte| byte.is_ascii_digit());
        let parts = text
            .split(mark)
            .map(|one| digits(one).then(|| one.parse().ok())?);
        parts.collect::<Option<Vec<i64>>>()?.try_into().ok()
    };
    let [year, month, day] = three(day, '-').ok_or_else(none)?;
    let [hour, minute, second] = three(time, ':').ok_or_else(none)?;
    let fits = hour < 24 && minute < 60 && second < 60;
    let days = days(year, month, day).filter(|_| fits).ok_or_else(none)?;
    Ok((((days * 24 + hour) * 60 + minute) * 60 + second) * 1_000_000)
}

/// Date of an instant (µs since 1970), as `2026-03-02`, UTC.
pub(crate) fn date(instant: i64) -> String {
    let mut rest = instant.div_euclid(86_400_000_000);
    let mut year = 1970 + rest.div_euclid(366);
    // The first guess is never late; advance to the right year.
    while days(year + 1, 1, 1).is_some_and(|next| next <= rest) {
        year += 1;
    }
    rest -= days(year, 1, 1).unwrap_or(0);
    let lengths = (1..=12).map(|month| {
        (28..=31)
            .rev()
            .find(|day| days(year, month, *day).is_some())
    });
    let mut month = 1;
    for length in lengths.flatten() {
        if rest < length {
            break;
        }
        rest -= length;
        month += 1;
    }
    format!("{year:04}-{month:02}-{:02}", rest + 1)
}

#[cfg(test)]
mod tests {
    use super::{date, instant};

    #[test]
    fn days_survive_conversion_to_instants_and_back() {
        for day in [
            "1970-01-01",
            "2000-02-29",
            "2026-03-02",
            "2027-12-31",
            "2100-03-01",
        ] {
            assert_eq!(instant(day).ok().map(date).as_deref(), Some(day));
        }
    }

    #[test]
    fn instants_are_microseconds_since_1970() {
        assert_eq!(instant("1970-01-01").ok(), Some(0));
        // date -u -d 2026-03-02T14:05:00 +%s
        assert_eq!(
            instant("2026-03-02T14:05:00Z").ok(),
            Some(1_772_460_300_000_000)
        );
        for wrong in [
            "2026-02-29",
            "2026-3",
            "yesterday",
            "2026-03-02T24:00:00",
            "2026-13-01",
        ] {
            assert!(instant(wrong).is_err(), "{wrong}");
        }
    }
}
