//! Lengths and radii, in model units or as a share of the inputs' size.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// A length in model units, or a share of the diagonal of the box around all inputs as posed.
///
/// ```
/// use fusion::operation::Length;
/// assert_eq!("2%".parse(), Ok(Length::OfDiagonal(0.02)));
/// assert_eq!(Length::OfDiagonal(0.02).resolve(50.0), 1.0);
/// assert!("2mm".parse::<Length>().is_err_and(|e| e.contains("write 2")));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Model units.
    Units(f64),
    /// A share of the diagonal; 0.02 is `"2%"` in text.
    OfDiagonal(f64),
}

impl Length {
    /// The length in model units.
    pub fn resolve(self, diagonal: f64) -> f64 {
        match self {
            Self::Units(length) => length,
            Self::OfDiagonal(share) => share * diagonal,
        }
    }

    /// Its number: model units, or the share.
    pub(super) fn number(self) -> f64 {
        match self {
            Self::Units(x) | Self::OfDiagonal(x) => x,
        }
    }

    /// A length above zero from text.
    ///
    /// # Errors
    /// A sentence that says what is right.
    pub fn positive(text: &str) -> Result<Self, String> {
        let length: Self = text.parse()?;
        if length.number() > 0.0 { Ok(length) } else { Err("must be above zero".into()) }
    }
}

impl From<f64> for Length {
    fn from(units: f64) -> Self {
        Self::Units(units)
    }
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, scale): (_, fn(f64) -> Self) = match text.strip_suffix('%') {
            Some(percent) => (percent, |p| Self::OfDiagonal(p / 100.0)),
            None => (text, Self::Units),
        };
        let value: f64 = number.trim().parse().map_err(|_| hint(text))?;
        if value.is_finite() && value >= 0.0 {
            Ok(scale(value))
        } else {
            Err("a length must be finite and not negative".into())
        }
    }
}

/// What is right in place of a text that is no length.
fn hint(text: &str) -> String {
    let known = "a length is a number of model units, such as 0.25, or a share of the diagonal, such as 2%";
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == ' ' || c == '"');
    let is_number = |text: &str| text.parse().is_ok_and(f64::is_finite);
    if number != text && is_number(number) {
        return format!("lengths have no unit, they are in the unit of the model: write {number}; {known}");
    }
    if text.contains(',') && is_number(&text.replace(',', ".")) {
        return format!("the decimal sign is a point: write {}; {known}", text.replace(',', "."));
    }
    known.into()
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Units(length) => write!(f, "{length}"),
            Self::OfDiagonal(share) => {
                // The percentage that is read as this very share.
                let near = 100.0 * share;
                let same = [near, near.next_up(), near.next_down()].into_iter().find(|p| p / 100.0 == share);
                write!(f, "{}%", same.unwrap_or(near))
            }
        }
    }
}

impl Serialize for Length {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Units(length) => serializer.serialize_f64(*length),
            Self::OfDiagonal(_) => serializer.collect_str(self),
        }
    }
}

impl<'de> Deserialize<'de> for Length {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl Visitor<'_> for Either {
            type Value = Length;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number above 0, or a share of the diagonal such as \"2%\"")
            }

            fn visit_f64<E: Error>(self, units: f64) -> Result<Length, E> {
                Ok(Length::Units(units))
            }

            fn visit_i64<E: Error>(self, units: i64) -> Result<Length, E> {
                Ok(Length::Units(units as f64))
            }

            fn visit_u64<E: Error>(self, units: u64) -> Result<Length, E> {
                Ok(Length::Units(units as f64))
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Length, E> {
                text.parse().map_err(E::custom)
            }
        }

        deserializer.deserialize_any(Either)
    }
}

impl JsonSchema for Length {
    fn schema_name() -> Cow<'static, str> {
        "Length".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "title": "length",
            "description": "Model units, or a share of the diagonal of the box around all inputs, such as \"2%\".",
            "anyOf": [
                { "type": "number", "minimum": 0 },
                { "type": "string", "pattern": "^[0-9.eE+-]+ *%?$" },
            ],
        })
    }
}

/// The radius of a ball, or how far its centre keeps from the left and from the right side of a curve.
///
/// ```
/// use fusion::operation::{Length, Radius};
/// assert_eq!("0.1,2%".parse(), Ok(Radius::from([Length::Units(0.1), Length::OfDiagonal(0.02)])));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a radius is a number above 0, a share of the diagonal such as \"2%\", or two of these")]
#[schemars(title = "length, or two")]
pub enum Radius {
    /// On both sides.
    Both(Length),
    /// On the left and on the right.
    Each([Length; 2]),
}

impl Radius {
    /// Left and right.
    pub fn sides(self) -> [Length; 2] {
        match self {
            Self::Both(length) => [length; 2],
            Self::Each(sides) => sides,
        }
    }
}

impl From<f64> for Radius {
    fn from(units: f64) -> Self {
        Self::Both(units.into())
    }
}

impl From<Length> for Radius {
    fn from(length: Length) -> Self {
        Self::Both(length)
    }
}

impl From<[Length; 2]> for Radius {
    fn from(sides: [Length; 2]) -> Self {
        Self::Each(sides)
    }
}

impl FromStr for Radius {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let Some((left, right)) = text.split_once(',') else { return Length::positive(text).map(Self::Both) };
        let sides = [Length::positive(left), Length::positive(right)];
        let decimal = text.replace(',', ".");
        match sides {
            [Ok(left), Ok(right)] => Ok(Self::Each([left, right])),
            _ if left.trim() == "0" && Length::positive(&decimal).is_ok() => Err(format!(
                "two numbers are the radii on the left and on the right, both above zero; with a decimal point, write {decimal}"
            )),
            [Err(e), _] | [_, Err(e)] => Err(e),
        }
    }
}

impl fmt::Display for Radius {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Both(length) => length.fmt(f),
            Self::Each([left, right]) => write!(f, "{left},{right}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_units_or_shares() {
        assert_eq!("0.25".parse(), Ok(Length::Units(0.25)));
        assert_eq!("2%".parse::<Length>().map(|l| l.resolve(50.0)), Ok(1.0));
        for bad in ["", "%", "2%%", "nan", "inf", "-1", "-1%", "two", "2mm", "2 cm", "0,5"] {
            assert!(bad.parse::<Length>().is_err(), "{bad}");
        }
        assert!(Length::positive("0").is_err() && Length::positive("0%").is_err());
    }

    #[test]
    fn what_people_type_gets_a_helpful_answer() {
        let says = |text: &str| text.parse::<Radius>().unwrap_err();
        assert!(says("2mm").contains("write 2;"), "{}", says("2mm"));
        assert!(says("0,5").contains("write 0.5"), "{}", says("0,5"));
    }

    #[test]
    fn a_share_survives_text() {
        for text in ["2%", "0.5%", "7%", "33.333333333333336%", "12.3456789%"] {
            let length: Length = text.parse().unwrap();
            assert_eq!(length.to_string().parse(), Ok(length));
            assert_eq!(serde_json::from_str::<Length>(&serde_json::to_string(&length).unwrap()).unwrap(), length);
        }
    }
}
