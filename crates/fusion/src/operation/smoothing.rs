//! How vertices are moved before a mesh is remeshed.

use super::define::as_text;
use super::length::Length;
use crate::remeshing::{Fairing, Fairness, Flow, Smooth, Taubin};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// A method of smoothing.
///
/// ```
/// use fusion::operation::{Length, SmoothMethod};
/// assert_eq!("flow=2%".parse(), Ok(SmoothMethod::Flow(Length::OfDiagonal(0.02))));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SmoothMethod {
    /// Taubin's pairs of steps, so many.
    Taubin(usize),
    /// Curvature flow: the wavelength that is halved.
    Flow(Length),
    /// Fairing.
    Fair(Fairness),
}

as_text! { SmoothMethod }

impl FromStr for SmoothMethod {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some(("flow", length)) => Ok(Self::Flow(Length::positive(length)?)),
            Some(("taubin", rounds)) => match rounds.parse() {
                Ok(n) if (1..=100_000).contains(&n) => Ok(Self::Taubin(n)),
                _ => Err("rounds are a number from 1 to 100000".into()),
            },
            _ => match text {
                "taubin" => Ok(Self::Taubin(Taubin::default().rounds)),
                "harmonic" => Ok(Self::Fair(Fairness::Harmonic)),
                "biharmonic" => Ok(Self::Fair(Fairness::Biharmonic)),
                "triharmonic" => Ok(Self::Fair(Fairness::Triharmonic)),
                _ => Err("a method is taubin, taubin=ROUNDS, flow=LENGTH, harmonic, biharmonic or triharmonic".into()),
            },
        }
    }
}

impl fmt::Display for SmoothMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Taubin(rounds) => write!(f, "taubin={rounds}"),
            Self::Flow(length) => write!(f, "flow={length}"),
            Self::Fair(Fairness::Harmonic) => f.write_str("harmonic"),
            Self::Fair(Fairness::Biharmonic) => f.write_str("biharmonic"),
            Self::Fair(Fairness::Triharmonic) => f.write_str("triharmonic"),
        }
    }
}

impl JsonSchema for SmoothMethod {
    fn schema_name() -> Cow<'static, str> {
        "SmoothMethod".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "title": "`taubin`, `taubin=ROUNDS`, `flow=LENGTH`, `harmonic`, `biharmonic`, `triharmonic`",
            "type": "string",
        })
    }
}

impl SmoothMethod {
    /// The method with lengths in model units.
    pub(super) fn resolve(self, diagonal: f64) -> Smooth {
        match self {
            Self::Taubin(rounds) => Smooth::Taubin(Taubin { rounds, ..Taubin::default() }),
            Self::Flow(length) => Smooth::Flow(Flow::halving(length.resolve(diagonal))),
            Self::Fair(fairness) => Smooth::Fair(Fairing { fairness, ..Fairing::default() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_names_with_a_number() {
        assert_eq!("taubin".parse(), Ok(SmoothMethod::Taubin(10)));
        for text in ["taubin=30", "flow=2%", "triharmonic"] {
            assert_eq!(text.parse::<SmoothMethod>().map(|m| m.to_string()), Ok(text.into()));
        }
        for bad in ["", "flow", "flow=0", "flow=-1", "taubin=0", "taubin=x", "laplace", "harmonic=3"] {
            assert!(bad.parse::<SmoothMethod>().is_err(), "{bad}");
        }
    }
}
