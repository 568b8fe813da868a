//! Quantities with units as they stand in a scene file: `"33 mm"`, `"7780 kg/m^3"`, `"1 mPa*s"`.
//!
//! Prefixes shift the decimal exponent of the text before it is parsed, so `"33 mm"` is exactly
//! the number `0.033`. Products (`*`, `·`, a space) and quotients (`/`) bind from left to right.
//! Units and prefixes: BIPM, The International System of Units, 9th edition, tables 2, 4 and 7.

/// Dimension: exponents of metre, kilogram, second, radian and ampere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimension(pub [i32; 5]);

impl Dimension {
    /// A pure number.
    pub const NONE: Dimension = Dimension([0, 0, 0, 0, 0]);
    /// Length, m.
    pub const LENGTH: Dimension = Dimension([1, 0, 0, 0, 0]);
    /// Mass, kg.
    pub const MASS: Dimension = Dimension([0, 1, 0, 0, 0]);
    /// Time, s.
    pub const TIME: Dimension = Dimension([0, 0, 1, 0, 0]);
    /// Speed, m/s.
    pub const SPEED: Dimension = Dimension([1, 0, -1, 0, 0]);
    /// Pressure or modulus, Pa.
    pub const PRESSURE: Dimension = Dimension([-1, 1, -2, 0, 0]);
    /// Density, kg/m^3.
    pub const DENSITY: Dimension = Dimension([-3, 1, 0, 0, 0]);
    /// Dynamic viscosity, Pa s.
    pub const VISCOSITY: Dimension = Dimension([-1, 1, -1, 0, 0]);
    /// Force, N.
    pub const FORCE: Dimension = Dimension([1, 1, -2, 0, 0]);
    /// Torque, N m.
    pub const TORQUE: Dimension = Dimension([2, 1, -2, 0, 0]);
    /// Stiffness, N/m.
    pub const STIFFNESS: Dimension = Dimension([0, 1, -2, 0, 0]);
    /// Bending stiffness of a beam, N m^2.
    pub const BENDING_STIFFNESS: Dimension = Dimension([3, 1, -2, 0, 0]);
    /// Mass per length, kg/m.
    pub const LINE_MASS: Dimension = Dimension([-1, 1, 0, 0, 0]);
    /// Frequency, Hz.
    pub const FREQUENCY: Dimension = Dimension([0, 0, -1, 0, 0]);
    /// Plane angle, rad.
    pub const ANGLE: Dimension = Dimension([0, 0, 0, 1, 0]);
    /// Acceleration, m/s^2.
    pub const ACCELERATION: Dimension = Dimension([1, 0, -2, 0, 0]);
    /// Impulse, N s.
    pub const IMPULSE: Dimension = Dimension([1, 1, -1, 0, 0]);
    /// Area, m^2.
    pub const AREA: Dimension = Dimension([2, 0, 0, 0, 0]);
    /// Voltage, V.
    pub const VOLTAGE: Dimension = Dimension([2, 1, -3, 0, -1]);
    /// Capacitance, F.
    pub const CAPACITANCE: Dimension = Dimension([-2, -1, 4, 0, 2]);
    /// Resistance, Ohm.
    pub const RESISTANCE: Dimension = Dimension([2, 1, -3, 0, -2]);
    /// Inductance, H.
    pub const INDUCTANCE: Dimension = Dimension([2, 1, -2, 0, -2]);
    /// Angle per time, rad/s.
    pub const SPIN: Dimension = Dimension([0, 0, -1, 1, 0]);
    /// kg m^2.
    pub const MOMENT_OF_INERTIA: Dimension = Dimension([2, 1, 0, 0, 0]);

    /// What a message calls it: name with article, SI unit, an example.
    pub fn describe(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Dimension::NONE => ("a pure number", "1", "0.3"),
            Dimension::LENGTH => ("a length", "m", "33 mm"),
            Dimension::MASS => ("a mass", "kg", "0.11 g"),
            Dimension::TIME => ("a time", "s", "250 us"),
            Dimension::SPEED => ("a speed", "m/s", "550 mm/s"),
            Dimension::PRESSURE => ("a modulus", "Pa", "210 GPa"),
            Dimension::DENSITY => ("a density", "kg/m^3", "7780 kg/m^3"),
            Dimension::VISCOSITY => ("a dynamic viscosity", "Pa*s", "1 mPa*s"),
            Dimension::FORCE => ("a force", "N", "440 N"),
            Dimension::TORQUE => ("a torque", "N*m", "4 N*mm"),
            Dimension::STIFFNESS => ("a stiffness", "N/m", "2.5 N/mm"),
            Dimension::BENDING_STIFFNESS => ("a bending stiffness", "N*m^2", "2100 N*mm^2"),
            Dimension::LINE_MASS => ("a mass per length", "kg/m", "40 g/m"),
            Dimension::FREQUENCY => ("a frequency", "Hz", "4.6 kHz"),
            Dimension::ANGLE => ("an angle", "rad", "15 deg"),
            Dimension::IMPULSE => ("an impulse", "N*s", "0.2 mN*s"),
            Dimension::ACCELERATION => ("an acceleration", "m/s^2", "9.81 m/s^2"),
            Dimension::AREA => ("an area", "m^2", "25 mm^2"),
            Dimension::VOLTAGE => ("a voltage", "V", "150 V"),
            Dimension::CAPACITANCE => ("a capacitance", "F", "1.4 uF"),
            Dimension::RESISTANCE => ("a resistance", "Ohm", "10 Ohm"),
            Dimension::INDUCTANCE => ("an inductance", "H", "20 mH"),
            Dimension::SPIN => ("a spin", "rad/s", "200 rad/s"),
            Dimension::MOMENT_OF_INERTIA => ("a moment of inertia", "kg*m^2", "2 g*mm^2"),
            _ => ("a quantity", "SI", "1"),
        }
    }
}

impl Dimension {
    /// Least and largest magnitude, in SI, that a scene may have besides 0: far beyond what anybody strikes and measures, so
    /// that what lies outside is a slip of the pen, and within what the methods can be tried on.
    pub fn span(self) -> [f64; 2] {
        match self {
            Dimension::LENGTH => [1e-9, 1e3],
            Dimension::MASS => [1e-15, 1e6],
            Dimension::TIME => [1e-12, 1e6],
            Dimension::SPEED => [1e-9, 1e5],
            Dimension::PRESSURE => [1.0, 1e18],
            Dimension::DENSITY => [1e-6, 1e9],
            Dimension::VISCOSITY => [1e-18, 1e6],
            Dimension::FREQUENCY => [1e-6, 1e12],
            Dimension::NONE => [0.0, 1e6],
            _ => [1e-30, 1e30],
        }
    }

    /// Whether `value` is 0 or lies in the [span](Self::span).
    pub fn is_plausible(self, value: f64) -> bool {
        let [low, high] = self.span();
        value == 0.0 || (low..=high).contains(&value.abs())
    }

    /// Base units of the SI, and the radian, with their exponents; those that are not 0.
    pub fn bases(self) -> impl Iterator<Item = (&'static str, i32)> {
        ["m", "kg", "s", "rad", "A"].into_iter().zip(self.0).filter(|(_, exponent)| *exponent != 0)
    }

    /// The SI unit behind a number; nothing for a pure number.
    pub fn suffix(self) -> String {
        if self == Dimension::NONE { String::new() } else { format!(" {}", self.describe().1) }
    }

    /// "a length in m", "a pure number".
    pub fn in_words(self) -> String {
        let (what, unit, _) = self.describe();
        if self == Dimension::NONE { what.to_owned() } else { format!("{what} in {unit}") }
    }
}

/// A unit: its dimension and its size `factor * 10^exponent` in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Unit {
    dimension: Dimension,
    exponent: i32,
    factor: f64,
}

/// Symbol, dimension, decimal exponent of the SI size, whether prefixes may stand before it.
const UNITS: [(&str, [i32; 5], i32, bool); 16] = [
    ("m", [1, 0, 0, 0, 0], 0, true),
    ("g", [0, 1, 0, 0, 0], -3, true),
    ("s", [0, 0, 1, 0, 0], 0, true),
    ("rad", [0, 0, 0, 1, 0], 0, true),
    ("deg", [0, 0, 0, 1, 0], 0, false),
    ("Hz", [0, 0, -1, 0, 0], 0, true),
    ("N", [1, 1, -2, 0, 0], 0, true),
    ("Pa", [-1, 1, -2, 0, 0], 0, true),
    ("J", [2, 1, -2, 0, 0], 0, true),
    ("W", [2, 1, -3, 0, 0], 0, true),
    ("V", [2, 1, -3, 0, -1], 0, true),
    ("A", [0, 0, 0, 0, 1], 0, true),
    ("F", [-2, -1, 4, 0, 2], 0, true),
    ("Ohm", [2, 1, -3, 0, -2], 0, true),
    ("H", [2, 1, -2, 0, -2], 0, true),
    ("%", [0, 0, 0, 0, 0], -2, false),
];

const PREFIXES: [(&str, i32); 12] = [
    ("T", 12),
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("\u{b5}", -6),
    ("\u{3bc}", -6),
    ("n", -9),
    ("p", -12),
];

/// The units of `dimension` that have a symbol of their own, and whether prefixes may stand before them.
pub(crate) fn symbols(dimension: Dimension) -> impl Iterator<Item = (&'static str, bool)> {
    UNITS
        .iter()
        .filter(move |(_, of, ..)| *of == dimension.0)
        .map(|(symbol, .., prefixed)| (*symbol, *prefixed))
}

/// The prefixes.
pub(crate) fn prefixes() -> [&'static str; PREFIXES.len()] {
    PREFIXES.map(|(prefix, _)| prefix)
}

/// Why a text is not the quantity that is needed.
#[derive(Debug, Clone, PartialEq)]
pub enum QuantityError {
    /// The text does not begin with a decimal number.
    NotANumber,
    /// A unit that is not known.
    UnknownUnit(String),
    /// An exponent that is not a small whole number, or a product that breaks off.
    MalformedUnit(String),
    /// A number of another dimension; the unit as written.
    WrongDimension(String),
    /// Beyond the range of double precision.
    OutOfRange,
}

/// Reads `text`, a decimal number and a unit, as a number in the SI unit of `dimension`.
/// Without unit it is taken to be in SI.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let text = text.trim();
    let (mantissa, exponent, rest) = split_number(text).ok_or(QuantityError::NotANumber)?;
    let written = rest.trim();
    let unit =
        if written.is_empty() { Unit { dimension, exponent: 0, factor: 1.0 } } else { parse_unit(written)? };
    if unit.dimension != dimension {
        return Err(QuantityError::WrongDimension(written.to_owned()));
    }
    let shifted = exponent.checked_add(unit.exponent).ok_or(QuantityError::OutOfRange)?;
    let value: f64 = format!("{mantissa}e{shifted}").parse().map_err(|_| QuantityError::NotANumber)?;
    let value = value * unit.factor;
    let is_zero = !mantissa.bytes().any(|b| (b'1'..=b'9').contains(&b));
    if !value.is_finite() || (value == 0.0 && !is_zero) {
        return Err(QuantityError::OutOfRange);
    }
    // -0 would give two scenes that are the same different hashes.
    Ok(value + 0.0)
}

/// Dimension of a unit written as in scene files; "1" is the pure number.
pub fn dimension_of(unit: &str) -> Option<Dimension> {
    if unit == "1" {
        return Some(Dimension::NONE);
    }
    parse_unit(unit).ok().map(|u| u.dimension)
}

/// Reads `text`, a decimal number with a unit of the same dimension as `unit`, in SI.
///
/// # Errors
/// A clause that says what is wrong and what is needed.
pub fn in_unit(text: &str, unit: &str) -> Result<f64, String> {
    let dimension = dimension_of(unit).unwrap_or(Dimension::NONE);
    let needed = dimension.in_words();
    parse(text, dimension).map_err(|error| match error {
        QuantityError::NotANumber => format!("`{text}` is not {needed}"),
        QuantityError::UnknownUnit(u) => format!("`{u}` is not a known unit; {needed} is needed"),
        QuantityError::MalformedUnit(u) => format!("`{u}` is not a product of units; {needed} is needed"),
        QuantityError::WrongDimension(u) => {
            format!("`{u}` is the unit of something else; {needed} is needed")
        }
        QuantityError::OutOfRange => format!("double precision can't hold `{text}`"),
    })
}

/// Splits a decimal number off the front: mantissa, decimal exponent, rest.
fn split_number(text: &str) -> Option<(&str, i32, &str)> {
    let bytes = text.as_bytes();
    let digits = |mut i: usize| {
        while bytes.get(i).is_some_and(u8::is_ascii_digit) {
            i += 1;
        }
        i
    };
    let start = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits(start);
    let mut count = end - start;
    if bytes.get(end) == Some(&b'.') {
        let fraction = digits(end + 1);
        count += fraction - end - 1;
        end = fraction;
    }
    if count == 0 {
        return None;
    }
    let mantissa = &text[..end];
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let stop = digits(end + 1 + sign);
        if stop > end + 1 + sign {
            let exponent = text[end + 1..stop].parse().ok()?;
            return Some((mantissa, exponent, &text[stop..]));
        }
    }
    Some((mantissa, 0, &text[end..]))
}

/// Reads a product of powers of units: `kg/m^3`, `mPa*s`, `m s^-2`, `m/s²`, `1/s`.
fn parse_unit(text: &str) -> Result<Unit, QuantityError> {
    let malformed = || QuantityError::MalformedUnit(text.to_owned());
    let mut total = Unit { dimension: Dimension::NONE, exponent: 0, factor: 1.0 };
    let reciprocal = text.strip_prefix('1').and_then(|rest| rest.trim_start().strip_prefix('/'));
    let mut rest = reciprocal.map_or(text, str::trim_start);
    let mut sign = if reciprocal.is_some() { -1 } else { 1 };
    loop {
        let end = rest.find(['*', '\u{b7}', '\u{22c5}', '/', ' ', '\t']).unwrap_or(rest.len());
        let (symbol, power) = split_power(&rest[..end]).ok_or_else(malformed)?;
        let unit = lookup(symbol).ok_or_else(|| QuantityError::UnknownUnit(symbol.to_owned()))?;
        let power = sign * power;
        for (t, u) in total.dimension.0.iter_mut().zip(unit.dimension.0) {
            *t += power * u;
        }
        total.exponent += power * unit.exponent;
        total.factor *= unit.factor.powi(power);
        rest = rest[end..].trim_start();
        let Some(operator) = rest.chars().next() else { return Ok(total) };
        sign = if operator == '/' { -1 } else { 1 };
        if matches!(operator, '*' | '/' | '\u{b7}' | '\u{22c5}') {
            rest = rest[operator.len_utf8()..].trim_start();
        }
        if rest.is_empty() {
            return Err(malformed());
        }
    }
}

/// Splits `m^-3` or `m³` into the symbol and a power in -9..=9, not 0.
fn split_power(factor: &str) -> Option<(&str, i32)> {
    let (symbol, power) = match factor.split_once('^') {
        Some((symbol, power)) => (symbol, power.parse().ok()?),
        None => match factor.char_indices().last()? {
            (at, '\u{b2}') => (&factor[..at], 2),
            (at, '\u{b3}') => (&factor[..at], 3),
            _ => (factor, 1),
        },
    };
    (power != 0 && (-9..=9).contains(&power) && !symbol.is_empty()).then_some((symbol, power))
}

/// Finds a unit, alone or behind a prefix.
fn lookup(symbol: &str) -> Option<Unit> {
    let find = |name: &str| UNITS.iter().find(|(unit, ..)| *unit == name);
    let (&(name, dimension, exponent, _), shift) = match find(symbol) {
        Some(unit) => (unit, 0),
        None => PREFIXES.iter().find_map(|(prefix, shift)| {
            let unit = find(symbol.strip_prefix(prefix)?)?;
            unit.3.then_some((unit, *shift))
        })?,
    };
    let factor = if name == "deg" { std::f64::consts::PI / 180.0 } else { 1.0 };
    Some(Unit { dimension: Dimension(dimension), exponent: exponent + shift, factor })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversion_is_exact_in_decimal() {
        for (text, dimension, expected) in [
            ("33 mm", Dimension::LENGTH, 0.033),
            ("0.25 um", Dimension::LENGTH, 0.25e-6),
            ("0.25 \u{b5}m", Dimension::LENGTH, 0.25e-6),
            ("0.25\u{3bc}m", Dimension::LENGTH, 0.25e-6),
            ("6.35 mm", Dimension::LENGTH, 0.00635),
            ("550 mm/s", Dimension::SPEED, 0.55),
            ("437mm/s", Dimension::SPEED, 0.437),
            ("55 cm s^-1", Dimension::SPEED, 0.55),
            ("210 GPa", Dimension::PRESSURE, 210e9),
            ("210 kN/mm^2", Dimension::PRESSURE, 210e9),
            ("7780 kg/m^3", Dimension::DENSITY, 7780.0),
            ("7.78 g/cm\u{b3}", Dimension::DENSITY, 7780.0),
            ("1 mPa*s", Dimension::VISCOSITY, 1e-3),
            ("1 mPa\u{b7}s", Dimension::VISCOSITY, 1e-3),
            ("1 mPa s", Dimension::VISCOSITY, 1e-3),
            ("1 g/m/s", Dimension::VISCOSITY, 1e-3),
            ("0.110 g", Dimension::MASS, 0.00011),
            ("110 mg", Dimension::MASS, 0.00011),
            ("4.0 N*mm", Dimension([2, 1, -2, 0, 0]), 0.004),
            ("4 mJ", Dimension([2, 1, -2, 0, 0]), 0.004),
            ("2.5e2 us", Dimension::TIME, 250e-6),
            ("-1.5E-3 m", Dimension::LENGTH, -1.5e-3),
            ("3 %", Dimension::NONE, 0.03),
            ("1.4 uF", Dimension::CAPACITANCE, 1.4e-6),
            ("10 V/A", Dimension::RESISTANCE, 10.0),
            ("2.2 kOhm", Dimension::RESISTANCE, 2200.0),
            ("20 mH", Dimension::INDUCTANCE, 0.02),
            ("25 mm^2", Dimension::AREA, 25e-6),
            ("180 deg", Dimension([0, 0, 0, 1, 0]), std::f64::consts::PI),
            ("33", Dimension::LENGTH, 33.0),
            (".5 m", Dimension::LENGTH, 0.5),
        ] {
            assert_eq!(parse(text, dimension), Ok(expected), "{text}");
        }
    }

    #[test]
    fn every_prefix_shifts_the_exponent() {
        for (prefix, exponent) in PREFIXES {
            let expected: f64 = format!("7.3e{exponent}").parse().expect("literal");
            assert_eq!(parse(&format!("7.3 {prefix}Pa"), Dimension::PRESSURE), Ok(expected));
        }
    }

    #[test]
    fn faults_have_different_messages() {
        use QuantityError::*;
        let length = |text| parse(text, Dimension::LENGTH);
        assert_eq!(length("33 kg"), Err(WrongDimension("kg".into())));
        assert_eq!(length("33 m^2"), Err(WrongDimension("m^2".into())));
        assert_eq!(length("33 inch"), Err(UnknownUnit("inch".into())));
        assert_eq!(length("33 mdeg"), Err(UnknownUnit("mdeg".into())));
        assert_eq!(length("33 kg*"), Err(MalformedUnit("kg*".into())));
        assert_eq!(length("33 m^x"), Err(MalformedUnit("m^x".into())));
        assert_eq!(length("33 m^0"), Err(MalformedUnit("m^0".into())));
        assert_eq!(length("33 /s"), Err(MalformedUnit("/s".into())));
        for text in ["", "mm", "nan m", "inf", "-", ".", "e3 m", "0x10 m"] {
            let found = length(text);
            assert!(found.is_err(), "{text}: {found:?}");
        }
        assert_eq!(length("1e400 m"), Err(OutOfRange));
        assert_eq!(length("1e-400 m"), Err(OutOfRange));
        assert_eq!(length("1e2147483647 Tm"), Err(OutOfRange));
        assert_eq!(length("-0 mm").map(f64::is_sign_positive), Ok(true));
    }
}
