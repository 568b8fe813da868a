//! Numbers and names as people read them: SI prefixes, significant digits, plain words.

/// `value` with so many significant `digits`.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// Unit with a prefix: a value in the unit times `factor` is the number to show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prefixed {
    pub(crate) unit: &'static str,
    pub(crate) factor: f64,
}

/// Prefix of `unit` that suits a value of magnitude `scale`.
pub(crate) fn prefixed(unit: &str, scale: f64) -> Prefixed {
    let of = |unit, factor| Prefixed { unit, factor };
    let small = scale.abs();
    match unit {
        "s" if small < 1e-3 => of("µs", 1e6),
        "s" if small < 1.0 => of("ms", 1e3),
        "s" => of("s", 1.0),
        "m" if small < 1e-3 => of("µm", 1e6),
        "m" if small < 1.0 => of("mm", 1e3),
        "m" => of("m", 1.0),
        "m/s" if small < 10.0 => of("mm/s", 1e3),
        "m/s" => of("m/s", 1.0),
        "m/s^2" => of("m/s²", 1.0),
        "N" if small < 0.1 => of("mN", 1e3),
        "N" => of("N", 1.0),
        "N*s" => of("mN s", 1e3),
        "Hz" if small >= 1e3 => of("kHz", 1e-3),
        "Hz" => of("Hz", 1.0),
        "J" if small < 1e-3 => of("µJ", 1e6),
        "J" if small < 1.0 => of("mJ", 1e3),
        "J" => of("J", 1.0),
        "N*m" => of("mN m", 1e3),
        "Pa" if small >= 1e9 => of("GPa", 1e-9),
        "Pa" if small >= 1e6 => of("MPa", 1e-6),
        "Pa" => of("Pa", 1.0),
        "rad/s" => of("rad/s", 1.0),
        "V" => of("V", 1.0),
        "rad" => of("°", 180.0 / std::f64::consts::PI),
        _ => of("", 1.0),
    }
}

/// `value` with `digits` significant digits; a dash if it is no number.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return minus(&format!("{:.*e}", digits.saturating_sub(1), value));
    }
    let decimals = (digits as i32 - 1 - magnitude as i32).max(0) as usize;
    minus(&format!("{value:.decimals$}"))
}

/// Six significant digits without zeros behind them, for plain text.
pub(crate) fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    let plain = format!("{rounded}");
    if plain.len() <= 12 { plain } else { format!("{rounded:e}") }
}

/// A true minus sign.
pub(crate) fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// `value` in the unit, with digits and unit.
pub(crate) fn with_unit(value: f64, to: Prefixed, digits: usize) -> String {
    // Numbers of something are shown as such.
    let whole = to.unit.is_empty() && value.fract() == 0.0 && value.abs() < 1e6;
    let number = if whole { minus(&format!("{value}")) } else { significant(value * to.factor, digits) };
    match to.unit {
        _ if !value.is_finite() => number,
        "" => number,
        "°" => number + "°",
        unit => format!("{number} {unit}"),
    }
}

/// `value` in its unit with a suitable prefix and so many significant `digits`.
pub(crate) fn quantity(value: f64, unit: &str, digits: usize) -> String {
    with_unit(value, prefixed(unit, value), digits)
}

/// The `ends` of an interval in their unit, with the same prefix and four significant digits.
pub(crate) fn interval(ends: [f64; 2], unit: &str) -> [String; 2] {
    let to = prefixed(unit, ends[0].abs().max(ends[1].abs()));
    ends.map(|value| with_unit(value, to, 4))
}

/// A given value in its unit, with as many digits as it was given with.
pub(crate) fn measure(value: f64, unit: &str) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let to = prefixed(unit, value);
    let number = with_minus(&short(value * to.factor));
    match to.unit {
        "" | "°" => number + to.unit,
        unit => format!("{number} {unit}"),
    }
}

/// A relative value in per cent with its sign.
pub(crate) fn percent(relative: Option<f64>) -> String {
    match relative {
        // Beyond that the reference is nothing to compare with.
        Some(r) if r.abs() >= 100.0 => format!("{} 10⁴ %", if r > 0.0 { ">" } else { "< −" }),
        Some(r) if r.is_finite() => {
            let number =
                if r.abs() < 0.1 { format!("{:.2}", 100.0 * r) } else { format!("{:.1}", 100.0 * r) };
            // what rounds to zero has no sign
            let is_zero = !number.contains(|c: char| ('1'..='9').contains(&c));
            let sign = if r > 0.0 && !is_zero { "+" } else { "" };
            let number = if is_zero { number.trim_start_matches('-') } else { &number };
            format!("{sign}{} %", minus(number))
        }
        _ => "–".into(),
    }
}

/// A relative size in per cent with two significant digits, rounded up: what is within it is within it.
pub(crate) fn percent_above(relative: f64) -> String {
    let value = 100.0 * relative.abs();
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0 %".into() } else { "–".into() };
    }
    let unit = 10_f64.powi(value.log10().floor() as i32 - 1);
    let above = (value / unit - 1e-9).ceil() * unit;
    let decimals = 1.0 - (above * (1.0 + 1e-9)).log10().floor();
    format!("{above:.*} %", decimals.max(0.0) as usize)
}

/// Text in which a hyphen before a number, or in its exponent, is a true minus sign.
pub(crate) fn with_minus(text: &str) -> String {
    let characters: Vec<char> = text.chars().collect();
    let at = |k: Option<usize>| k.and_then(|k| characters.get(k)).copied().unwrap_or(' ');
    let is_minus = |k: usize| {
        let before = at(k.checked_sub(1));
        let exponent = before == 'e' && at(k.checked_sub(2)).is_ascii_digit();
        let sign = !(before.is_alphanumeric() || before == '-' || before == '_');
        at(Some(k + 1)).is_ascii_digit() && (exponent || sign)
    };
    characters.iter().enumerate().map(|(k, c)| if *c == '-' && is_minus(k) { '−' } else { *c }).collect()
}

/// A name of the results in words: `outer_force_peak` is "outer force, peak".
pub(crate) fn words(quantity: &str) -> String {
    for (ending, word) in [
        ("_rms", "rms distance"),
        ("_max", "largest distance"),
        ("_peak", "peak"),
        ("_final", "final"),
        ("_end", "end"),
    ] {
        if let Some(stem) = quantity.strip_suffix(ending) {
            return format!("{}, {word}", stem.replace('_', " "));
        }
    }
    quantity.replace('_', " ")
}

/// "A, 1 mode", "B, 16 modes".
pub(crate) fn model_name(model: &str, modes: Option<usize>) -> String {
    match modes {
        Some(1) => format!("{model}, 1 mode"),
        Some(n) => format!("{model}, {n} modes"),
        None => model.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{percent, percent_above, prefixed, short, significant, with_unit, words};

    #[test]
    fn sizes_are_rounded_up() {
        let sizes = [0.000_185_8, 0.0017, 0.0996, 0.406_4, 1.096_8, 0.0].map(percent_above);
        assert_eq!(sizes, ["0.019 %", "0.17 %", "10 %", "41 %", "110 %", "0 %"]);
    }

    #[test]
    fn significant_digits() {
        assert_eq!(significant(443.0961, 4), "443.1");
        assert_eq!(significant(-0.69458, 4), "−0.6946");
        assert_eq!(significant(1.25e-9, 3), "1.25e−9");
        assert_eq!(significant(41_792.0, 4), "41792");
        assert_eq!(significant(f64::NAN, 4), "–");
        assert_eq!(significant(0.0, 4), "0");
    }

    #[test]
    fn short_numbers_have_six_digits_at_most() {
        let numbers = [443.692_261_185, -3.218_453_872e-10, 0.000_180_561_77, 5.0, 0.0, 92161.0];
        assert_eq!(numbers.map(short), ["443.692", "-3.21845e-10", "0.000180562", "5", "0", "92161"]);
    }

    #[test]
    fn prefixes_suit_the_scale() {
        assert_eq!(with_unit(180.46e-6, prefixed("s", 180e-6), 4), "180.5 µs");
        assert_eq!(with_unit(-0.2958, prefixed("m/s", 0.5), 4), "−295.8 mm/s");
        assert_eq!(with_unit(4655.0, prefixed("Hz", 4655.0), 4), "4.655 kHz");
        assert_eq!(with_unit(0.6946, prefixed("1", 0.7), 4), "0.6946");
        assert_eq!(with_unit(2.0, prefixed("1", 2.0), 5), "2");
    }

    #[test]
    fn percentages_and_words() {
        assert_eq!(percent(Some(-0.0987)), "−9.87 %");
        assert_eq!(percent(Some(0.2)), "+20.0 %");
        assert_eq!(percent(None), "–");
        assert_eq!(percent(Some(1e6)), "> 10⁴ %");
        assert_eq!(words("outer_force_peak"), "outer force, peak");
        assert_eq!(words("plate_velocity_rms"), "plate velocity, rms distance");
        assert_eq!(words("efficiency"), "efficiency");
    }
}
