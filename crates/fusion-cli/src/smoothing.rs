//! Ways of smoothing as they are typed.

use crate::length::{Length, positive_length};
use fusion::remeshing::{Fairing, Fairness, Flow, Smooth, Taubin};
use std::str::FromStr;

/// A way of smoothing as it is typed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Pairs of steps.
    Taubin(usize),
    /// The length of the waves that are halved.
    Flow(Length),
    /// Fairing.
    Fair(Fairness),
}

impl FromStr for Way {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some(("flow", length)) => Ok(Self::Flow(positive_length(length)?)),
            Some(("taubin", rounds)) => match rounds.parse() {
                Ok(n) if (1..=100_000).contains(&n) => Ok(Self::Taubin(n)),
                _ => Err("rounds are a number from 1 to 100000".into()),
            },
            _ => match text {
                "taubin" => Ok(Self::Taubin(Taubin::default().rounds)),
                "harmonic" => Ok(Self::Fair(Fairness::Harmonic)),
                "biharmonic" => Ok(Self::Fair(Fairness::Biharmonic)),
                "triharmonic" => Ok(Self::Fair(Fairness::Triharmonic)),
                _ => Err("a way is taubin, taubin=ROUNDS, flow=LENGTH, harmonic, biharmonic or triharmonic".into()),
            },
        }
    }
}

impl Way {
    /// The way, with lengths in model units.
    pub fn resolve(self, diagonal: f64) -> Smooth {
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
    fn ways_are_names_with_a_number() {
        assert_eq!("taubin".parse(), Ok(Way::Taubin(10)));
        assert_eq!("taubin=30".parse(), Ok(Way::Taubin(30)));
        assert_eq!("flow=2%".parse(), Ok(Way::Flow(Length::OfDiagonal(0.02))));
        assert_eq!("triharmonic".parse(), Ok(Way::Fair(Fairness::Triharmonic)));
        for bad in ["", "flow", "flow=0", "flow=-1", "taubin=0", "taubin=x", "laplace", "harmonic=3"] {
            assert!(bad.parse::<Way>().is_err(), "{bad}");
        }
    }
}
