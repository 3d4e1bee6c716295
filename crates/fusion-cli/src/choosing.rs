//! Which curves are blended, as typed.

use crate::args::Source;
use crate::failure::Failure;
use crate::length::{Length, direction, near, point, positive_length};
use crate::session::Session;
use crate::text_file::read_text;
use clap::Args;
use fusion::choice::{Choice, Near};
use fusion::features::Convexity;
use fusion::{parts_of_faces, picked_from_text};
use glam::DVec3;
use std::path::PathBuf;

/// Options that choose curves of a mesh. Those that name curves add up; those that filter keep what passes all.
#[derive(Args)]
#[command(next_help_heading = "Which curves")]
pub struct Choosing {
    /// Blend only the feature curve nearest this point; may be given more than once, each with a radius of its own. With
    /// `--profile sharp`, a place on a fillet
    #[arg(long, value_name = "X,Y,Z[=R]", value_parser = near, allow_hyphen_values = true, group = "ball")]
    pub near: Vec<(DVec3, Option<Length>)>,
    /// Blend only these feature curves, by the ids that `features` lists at the same --angle
    #[arg(long, value_name = "ID,ID...", value_delimiter = ',')]
    pub ids: Vec<usize>,
    /// Blend the curves in this file, as `features -o` writes them: points at vertices, or far apart, to be joined by the
    /// cheapest way along sharp edges
    #[arg(long, value_name = "CURVES.json")]
    pub curves: Option<PathBuf>,
    /// Blend the seams of an earlier boolean: the edges between faces of different parts in the file that its --origins wrote
    #[arg(long, value_name = "ORIGINS.json")]
    pub seams: Option<PathBuf>,
    /// Take the feature curves that continue a named one, too: from its end, within 25 degrees
    #[arg(long)]
    pub chain: bool,
    /// Only curves longer than this
    #[arg(long, value_name = "L", value_parser = positive_length)]
    pub longer: Option<Length>,
    /// Only curves whose every edge is parallel to this direction, or to one of several, within 5 degrees
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub along: Vec<DVec3>,
    /// Only curves inside or on this closed solid
    #[arg(long, value_name = "MESH")]
    pub within: Option<PathBuf>,
    /// Only ridges, as the edges of a box
    #[arg(long, conflicts_with = "concave")]
    pub convex: bool,
    /// Only valleys, as between a post and a plate
    #[arg(long)]
    pub concave: bool,
}

impl Choosing {
    /// The same for the library; `diagonal` is what lengths may be a share of.
    pub fn choice(&self, session: &Session, diagonal: f64) -> Result<Choice, Failure> {
        let near = |&(at, radius): &(DVec3, Option<Length>)| Near { at, radius: radius.map(|r| r.resolve(diagonal)) };
        let solid = |path: &PathBuf| session.read(path, &Source { from: None }).map(|m| m.mesh);
        let picked = self.curves.as_ref().map(|path| read_text(path, picked_from_text)).transpose()?;
        Ok(Choice {
            ids: self.ids.clone(),
            near: self.near.iter().map(near).collect(),
            picked: picked.unwrap_or_default(),
            seams: self.seams.as_ref().map(|path| read_text(path, parts_of_faces)).transpose()?,
            chain: self.chain,
            longer: self.longer.map(|l| l.resolve(diagonal)),
            along: self.along.clone(),
            within: self.within.as_ref().map(solid).transpose()?,
            convexity: match (self.convex, self.concave) {
                (true, _) => Some(Convexity::Convex),
                (_, true) => Some(Convexity::Concave),
                _ => None,
            },
        })
    }

    /// The places, without their radii.
    pub fn places(&self) -> Vec<DVec3> {
        self.near.iter().map(|n| n.0).collect()
    }

    /// The largest radius of its own that a curve has, if every named one has one.
    pub fn own_radius(&self, diagonal: f64) -> Option<f64> {
        let named_otherwise = !self.ids.is_empty() || self.curves.is_some() || self.seams.is_some();
        let radii: Option<Vec<f64>> = self.near.iter().map(|n| n.1.map(|r| r.resolve(diagonal))).collect();
        radii.filter(|r| !r.is_empty() && !named_otherwise).map(|r| r.into_iter().fold(0.0, f64::max))
    }
}

/// Options that choose seams of a boolean.
#[derive(Args)]
#[command(next_help_heading = "Which seams")]
pub struct ChoosingSeams {
    /// Blend only the seam nearest this point; may be given more than once
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub near: Vec<DVec3>,
    /// Only seams longer than this
    #[arg(long, value_name = "L", value_parser = positive_length)]
    pub longer: Option<Length>,
}
