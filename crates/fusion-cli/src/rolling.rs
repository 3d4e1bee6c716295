//! How a ball is rolled, as typed: the options that `blend` and the booleans share.

use crate::failure::Failure;
use crate::length::{Length, point, radius_at};
use crate::output::{self, Outputs};
use crate::text_file::read_text;
use clap::{Args, ValueEnum};
use fusion::blend::{self, Sketch};
use fusion::{Profile, Solver, profile_from_text};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Options of every verb that blends.
#[derive(Args)]
#[command(next_help_heading = "Blend options")]
pub struct Rolling {
    /// Cross-section of the blend [default: arc]: arc, g2 (curvature-continuous), chamfer, sharp, hermite, conic=W, whose apex weighs W
    /// times that of the arc (below 1 flatter, above 1 sharper), or a FILE with a NURBS curve (docs/keep.md). With
    /// `,reach=R` behind it the apex is moved out to R radii from the ball's centre
    #[arg(long, value_name = "PROFILE", value_parser = section)]
    pub profile: Option<Section>,
    /// The radius at the place of a curve nearest to X,Y,Z; may be given more than once. Between such places it changes
    /// smoothly, to that of --radius at the ends of an open curve and half-way round a closed one with a single place
    #[arg(long, value_name = "X,Y,Z=R", value_parser = radius_at, requires = "ball", allow_hyphen_values = true)]
    pub radius_at: Vec<(DVec3, Length)>,
    /// The cross-section at the place of a curve nearest to X,Y,Z; may be given more than once. Between such places, and to
    /// that of --profile at the ends of an open curve and half-way round a closed one with a single place, one changes
    /// smoothly into the other
    #[arg(long, value_name = "X,Y,Z=PROFILE", value_parser = profile_at, requires = "ball", allow_hyphen_values = true)]
    pub profile_at: Vec<(DVec3, Curve)>,
    /// What to do where a ball of the full radius does not fit: `full` keeps the radius and puts in the envelope of all balls
    /// that fit, with a smaller radius along a whole curve or none at all as the last resort; `shrink` uses a smaller radius
    /// there and fades into the full one; `error` stops with the place and a radius that works
    #[arg(long, value_name = "OVERLAP", default_value = "full", value_parser = overlap, requires = "ball")]
    pub overlap: Overlap,
    /// What finds the way of the ball's centre
    #[arg(long, value_enum, default_value_t = Spine::Contact, requires = "ball")]
    pub spine: Spine,
    /// How the surface is put in: `stitch` cuts along the ball's contact curves and sews in the sweep; `field` cuts along
    /// level sets and draws what is between onto the balls, which cannot fold; `auto` stitches, and takes the field where
    /// that fails; `keep` moves the mesh's own vertices onto the sweep, all faces kept
    #[arg(long, value_name = "SURFACE", default_value = "auto", value_parser = surface, requires = "ball")]
    pub surface: Surface,
    /// Least reach of the two sides the ball rolls on, in radii; grows by itself where more is needed
    #[arg(long, value_name = "RADII", default_value = "1.75", value_parser = alpha, requires = "ball")]
    pub alpha: f64,
    /// Largest distance of the blend's chords from its cross-section, as a share of the radius
    #[arg(long, value_name = "SHARE", default_value = "0.005", value_parser = tolerance, requires = "ball")]
    pub tolerance: f64,
    /// Blend on the coarsest level of a decimation hierarchy that is fine enough for the radius, and put the finer levels'
    /// details back; with `--surface keep`
    #[arg(long, requires_all = ["ball", "surface"])]
    pub multiresolution: bool,
    /// Write what the stages of the blend drew into this folder as OBJ files: the ball's way, the contact curves,
    /// profiles, patches and surfaces, even where the blend is refused (docs/blend.md lists them)
    #[arg(long, value_name = "DIR", requires = "ball")]
    pub debug_geometry: Option<PathBuf>,
}

impl Rolling {
    /// The same for the library; `diagonal` is what lengths may be a share of.
    pub fn with_radius(&self, sides: [f64; 2], diagonal: f64) -> Result<blend::Params, Failure> {
        if self.multiresolution && !matches!(self.surface, Surface::Keep) {
            return Err(Failure::usage(
                "--multiresolution needs --surface keep: details are put back on the same triangles",
            ));
        }
        let keep = blend::keep::Params { levels: if self.multiresolution { LEVELS } else { 0 }, ..Default::default() };
        let at: Vec<_> = self.radius_at.iter().map(|&(p, r)| (p, r.resolve(diagonal))).collect();
        let (radius, radii) = blend::Radii::of(sides, &at);
        Ok(blend::Params {
            radii,
            profile: self.profile.as_ref().map_or(Ok(Profile::Arc), |p| p.curve.profile())?,
            profile_at: self
                .profile_at
                .iter()
                .map(|(at, c)| Ok((*at, c.profile()?)))
                .collect::<Result<_, Failure>>()?,
            reach: self.profile.as_ref().and_then(|p| p.reach),
            overlap: match self.overlap {
                Overlap::Full => blend::Overlap::Full,
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
                Surface::Auto => blend::Surface::Auto,
                Surface::Stitch => blend::Surface::Stitch,
                Surface::Keep => blend::Surface::Keep(keep),
                Surface::Field => blend::Surface::Field,
            },
            sketch: if self.debug_geometry.is_some() { Sketch::new() } else { Sketch::default() },
            ..blend::Params::new(radius)
        })
    }

    /// Makes the section a straight chord, where none was given. Returns false where another one was.
    pub fn make_chamfer(&mut self) -> bool {
        let chamfer = Section { curve: Curve::Known(Profile::Chamfer), reach: None };
        *self.profile.get_or_insert(chamfer.clone()) == chamfer
    }

    /// Whether the section is the prolonged sides, as they are.
    pub fn is_sharp(&self) -> bool {
        let sharp = Section { curve: Curve::Known(Profile::Sharp), reach: None };
        self.profile.as_ref() == Some(&sharp)
    }

    /// Makes the folder for drawings, if one is asked for, before any work is done.
    pub fn prepare(&self) -> Result<(), Failure> {
        let Some(folder) = &self.debug_geometry else { return Ok(()) };
        output::make_folder(folder)
    }

    /// Writes what was drawn, whatever came of the blend, and passes that on.
    pub fn keep_drawings<T>(&self, sketch: &Sketch, result: Result<T, Failure>) -> Result<T, Failure> {
        let Some(folder) = &self.debug_geometry else { return result };
        let mut outputs = Outputs::default();
        for (name, bytes) in fusion::drawings_to_files(sketch) {
            outputs.add(folder.join(name), bytes);
        }
        let written = outputs.commit_after(|| Ok(()));
        result.and_then(|value| written.map(|()| value))
    }
}

/// Most levels of a hierarchy, each of about two thirds of the vertices of the one before.
const LEVELS: usize = 6;

/// The cross-section as typed.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    curve: Curve,
    /// Distance of the apex from the ball's centre, in radii.
    reach: Option<f64>,
}

/// A profile by its name, or the file it stands in.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// By its name.
    Known(Profile),
    /// By its file.
    File(PathBuf),
}

impl Curve {
    fn profile(&self) -> Result<Profile, Failure> {
        match self {
            Self::Known(profile) => Ok(profile.clone()),
            Self::File(path) => read_text(path, profile_from_text),
        }
    }
}

/// What to do where the ball does not fit.
#[derive(Clone, Copy)]
pub enum Overlap {
    /// The envelope of the full ball.
    Full,
    /// A smaller ball there.
    Shrink,
    /// Stop.
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
    /// Swept, or a field where that fails.
    Auto,
    /// Swept, and sewn between exact cuts.
    Stitch,
    /// The mesh's own vertices moved onto the sweep.
    Keep,
    /// A field of balls.
    Field,
}

fn section(text: &str) -> Result<Section, String> {
    let (curve, reach) = match text.split_once(",reach=") {
        None => (text, None),
        Some((curve, reach)) => {
            let reach =
                within(reach, 0.1, 100.0).ok_or("the reach of a profile is a number of radii from 0.1 to 100")?;
            (curve, Some(reach))
        }
    };
    Ok(Section { curve: profile(curve)?, reach })
}

/// A profile at a place, `x,y,z=PROFILE`.
fn profile_at(text: &str) -> Result<(DVec3, Curve), String> {
    let (at, curve) = text.split_once('=').ok_or("a profile at a place is X,Y,Z=PROFILE, such as 0,1.5,-2=chamfer")?;
    Ok((point(at)?, profile(curve)?))
}

fn profile(text: &str) -> Result<Curve, String> {
    let is_file = Path::new(text).extension().is_some() && !text.starts_with("conic=");
    match Profile::named(text) {
        Some(profile) => Ok(Curve::Known(profile)),
        None if is_file => Ok(Curve::File(text.into())),
        None => Err("a profile is arc, g2, chamfer, sharp, hermite, conic=W with W ≥ 0, such as conic=2, or a file with an extension, such as curve.json".into()),
    }
}

fn surface(text: &str) -> Result<Surface, String> {
    match text {
        "auto" => Ok(Surface::Auto),
        "stitch" => Ok(Surface::Stitch),
        "keep" => Ok(Surface::Keep),
        "field" => Ok(Surface::Field),
        _ => Err("a surface is auto, stitch, field or keep".into()),
    }
}

fn overlap(text: &str) -> Result<Overlap, String> {
    match text {
        "full" => Ok(Overlap::Full),
        "shrink" => Ok(Overlap::Shrink),
        "error" => Ok(Overlap::Error),
        "trim" => Err("`full`, the default, stands for the former `trim`".into()),
        _ => Err("an overlap is full, shrink or error".into()),
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
        let known = |text: &str| match section(text) {
            Ok(Section { curve: Curve::Known(profile), reach }) => Some((profile, reach)),
            _ => None,
        };
        assert_eq!(known("g2"), Some((Profile::G2, None)));
        assert_eq!(known("conic=0.5"), Some((Profile::Conic(0.5), None)));
        assert_eq!(known("conic=2,reach=2.4"), Some((Profile::Conic(2.0), Some(2.4))));
        assert_eq!(section("curve.json").map(|s| s.curve), Ok(Curve::File("curve.json".into())));
        assert!(section("arc,reach=0").is_err_and(|e| e.contains("radii")));
        for bad in ["", "conic", "conic=", "conic=-1", "conic=nan", "conic=inf", "round"] {
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
