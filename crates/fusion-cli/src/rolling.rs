//! How a ball is rolled, as typed: the options that `blend` and the booleans share.

use clap::{Args, ValueEnum};
use fusion::{Profile, Solver, blend};

/// Options of every verb that blends.
#[derive(Args)]
#[command(next_help_heading = "Blend options")]
pub struct Rolling {
    /// Cross-section of the blend: arc, g2 (curvature-continuous), chamfer, sharp, or conic=W, whose apex weighs W times
    /// that of the arc (below 1 flatter, above 1 sharper)
    #[arg(long, value_name = "PROFILE", default_value = "arc", value_parser = profile, requires = "radius")]
    pub profile: Profile,
    /// What to do where a full-size ball does not fit
    #[arg(long, value_enum, default_value_t = Overlap::Shrink, requires = "radius")]
    pub overlap: Overlap,
    /// What finds the way of the ball's centre
    #[arg(long, value_enum, default_value_t = Spine::Contact, requires = "radius")]
    pub spine: Spine,
    /// How the surface is put in: `stitch` cuts along the ball's contact curves and sews in the sweep; `keep` moves the
    /// mesh's own vertices onto it, all faces kept
    #[arg(long, value_name = "SURFACE", default_value = "stitch", value_parser = surface, requires = "radius")]
    pub surface: Surface,
    /// Least reach of the two sides the ball rolls on, in radii; grows by itself where more is needed
    #[arg(long, value_name = "RADII", default_value = "1.75", value_parser = alpha, requires = "radius")]
    pub alpha: f64,
    /// Largest distance of the blend's chords from its cross-section, as a share of the radius
    #[arg(long, value_name = "SHARE", default_value = "0.005", value_parser = tolerance, requires = "radius")]
    pub tolerance: f64,
}

impl Rolling {
    /// The same for the library, for a ball of `radius` in model units.
    pub fn with_radius(&self, radius: f64) -> blend::Params {
        blend::Params {
            profile: self.profile.clone(),
            overlap: match self.overlap {
                Overlap::Shrink => blend::Overlap::Shrink,
                Overlap::Error => blend::Overlap::Error,
            },
            solver: match self.spine {
                Spine::Contact => Solver::Contact,
                Spine::Offset => Solver::Offset(fusion::OffsetParams::default()),
            },
            alpha: self.alpha,
            tolerance: self.tolerance,
            surface: match self.surface {
                Surface::Stitch => blend::Surface::Stitch,
                Surface::Keep => blend::Surface::Keep(blend::keep::Params::default()),
            },
            ..blend::Params::new(radius)
        }
    }
}

/// What to do where the ball does not fit.
#[derive(Clone, Copy, ValueEnum)]
pub enum Overlap {
    /// Use a smaller ball there, fading into the full one; warnings and the report say where and how small
    Shrink,
    /// Stop, naming the place and a radius that works
    Error,
}

/// What finds the spine.
#[derive(Clone, Copy, ValueEnum)]
pub enum Spine {
    /// Newton on closest points, exact on the mesh
    Contact,
    /// The crossing of the two sides moved by the radius, off by the sagitta of the facets
    Offset,
}

/// How the surface is put in.
#[derive(Clone, Copy)]
pub enum Surface {
    /// Swept, and sewn between exact cuts.
    Stitch,
    /// The mesh's own vertices moved onto the sweep.
    Keep,
}

fn profile(text: &str) -> Result<Profile, String> {
    let conic = |w: &str| w.parse().ok().filter(|w: &f64| w.is_finite() && *w >= 0.0).map(Profile::Conic);
    match text {
        "arc" => Some(Profile::Arc),
        "g2" => Some(Profile::G2),
        "chamfer" => Some(Profile::Chamfer),
        "sharp" => Some(Profile::Sharp),
        _ => text.strip_prefix("conic=").and_then(conic),
    }
    .ok_or_else(|| {
        "a profile is arc, g2, chamfer, sharp, or conic=W with W ≥ 0, such as conic=2; this version reads none from files"
            .into()
    })
}

fn surface(text: &str) -> Result<Surface, String> {
    match text {
        "stitch" => Ok(Surface::Stitch),
        "keep" => Ok(Surface::Keep),
        _ => Err("a surface is stitch or keep".into()),
    }
}

fn alpha(text: &str) -> Result<f64, String> {
    within(text, 1.0, 16.0).ok_or_else(|| "the reach is a number of radii from 1 to 16".into())
}

fn tolerance(text: &str) -> Result<f64, String> {
    within(text, 1e-6, 0.5).ok_or_else(|| "the tolerance is a share of the radius from 1e-6 to 0.5".into())
}

fn within(text: &str, least: f64, most: f64) -> Option<f64> {
    text.parse().ok().filter(|x| (least..=most).contains(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_by_name() {
        assert_eq!(profile("g2"), Ok(Profile::G2));
        assert_eq!(profile("conic=0.5"), Ok(Profile::Conic(0.5)));
        for bad in ["", "conic", "conic=", "conic=-1", "conic=nan", "conic=inf", "round", "curve.json"] {
            assert!(profile(bad).is_err_and(|e| e.contains("chamfer")), "{bad}");
        }
    }

    #[test]
    fn numbers_in_range() {
        assert_eq!((alpha("3"), tolerance("1e-4")), (Ok(3.0), Ok(1e-4)));
        assert!(["0", "17", "nan", "x"].iter().all(|t| alpha(t).is_err()));
        assert!(["0", "0.6", "nan", "-1", "x"].iter().all(|t| tolerance(t).is_err()));
    }
}
