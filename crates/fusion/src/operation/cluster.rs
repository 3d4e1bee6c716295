//! Polyhedra rounded cluster by cluster.

use super::Precision;
use super::define::operation;
use super::linked::{Files, Linked, parsed};
use super::option_error::{Check, OptionError, ensure, within};
use super::options::Options;
use crate::Error;
use crate::cluster::{
    self, Clustered, CoverParams, Degrees, Entry, Params, PatchParams, StripParams, entries_from_toml,
};
use mesh_core::Watch;
use mesh_io::{Format, Model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Orders of contact with the faces.
const CONTINUITY: RangeInclusive<usize> = 1..=8;
/// Orders of contact of strips.
const ORDER: RangeInclusive<usize> = 0..=8;
/// Chord tolerances, as shares of the diagonal.
const TOLERANCE: RangeInclusive<f64> = 1e-7..=0.1;

/// An edge of a polyhedron by its two vertices, `4-7` in text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "pair of vertices")]
pub struct Edge(pub [u32; 2]);

operation! {
    /// Round a polyhedron: one patch for each cluster of its edges, in contact with the faces around
    ///
    /// ```
    /// use fusion::operation::{Cluster, Precision};
    /// use fusion::mesh_core::{Watch, shapes};
    /// let cube = shapes::cuboid(glam::DVec3::ONE).into();
    /// let round = Cluster::default().run(&cube, Precision::F64, &Watch::default())?;
    /// assert_eq!(round.outcome.report.figures["patches"], 8.0);
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Cluster {
        /// Order of contact between patches and faces
        #[schemars(range(min = *CONTINUITY.start(), max = *CONTINUITY.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "G", default_value_t = Self::default().continuity))]
        continuity: usize = PatchParams::default().continuity;
        /// Degree of the patches, or two degrees for four-sided ones; 2g + 1 where left out
        #[cfg_attr(feature = "clap", arg(long, value_name = "N|N1,N2"))]
        degree: Option<Degrees> = None;
        /// Take the clusters from this file (docs/cluster.md) instead of choosing them
        #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.toml", conflicts_with = "singles"))]
        clusters: Option<Linked<Vec<Entry>>> = None;
        /// Choose one cluster for each vertex
        #[cfg_attr(feature = "clap", arg(long))]
        singles: bool = false;
        /// How far patches reach along their open edges, as a share of the edge in (0, 1]; shortened where blends would meet
        #[schemars(extend("exclusiveMinimum" = 0, "maximum" = 1))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = Self::default().extent))]
        extent: f64 = PatchParams::default().extent;
        /// 0 for the fairest patches, towards 1 sharper ones
        #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "B", default_value_t = Self::default().bulge))]
        bulge: f64 = PatchParams::default().bulge;
        /// Keep the edge between vertices A and B sharp; may be given more than once
        #[cfg_attr(feature = "clap", arg(long, value_name = "A-B"))]
        sharp: Vec<Edge> = vec![];
        /// Keep all edges between clusters sharp
        #[cfg_attr(feature = "clap", arg(long))]
        all_sharp: bool = false;
        /// Balance of the strips along open edges, in (0, 1): above ½ they follow the first patch longer
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 1))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "MU", default_value_t = Self::default().mu,
            hide_short_help = true))]
        mu: f64 = StripParams::default().balance;
        /// Order of contact between strips and patches; that of the patches with the faces where left out
        #[schemars(range(min = *ORDER.start(), max = *ORDER.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "H", hide_short_help = true))]
        order: Option<usize> = None;
        /// Where strips cut the patches' corners off: the share of each side, in (0, 0.5)
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 0.5))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = Self::default().cut,
            hide_short_help = true))]
        cut: f64 = StripParams::default().cut;
        /// How far into the corner a strip follows its patch, as a share of the cut, in [0, 1)
        #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = Self::default().follow,
            hide_short_help = true))]
        follow: f64 = StripParams::default().follow;
        /// Largest distance of the mesh's chords from the surface, as a share of the polyhedron's diagonal
        #[schemars(range(min = *TOLERANCE.start(), max = *TOLERANCE.end()))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = Self::default().tolerance))]
        tolerance: f64 = Params::new(Format::Ply).tolerance;
    }
}

impl Options for Cluster {
    const NAME: &'static str = "cluster";

    fn validate(&self) -> Check {
        let order = |n: usize, range: &RangeInclusive<usize>, option| {
            let says = || format!("the order of contact is {} to {}", range.start(), range.end());
            ensure(range.contains(&n), option, says)
        };
        order(self.continuity, &CONTINUITY, "continuity")?;
        self.order.map_or(Ok(()), |h| order(h, &ORDER, "order"))?;
        if let Some(Degrees::Same(0) | Degrees::Tensor([0, _] | [_, 0])) = self.degree {
            return Err(OptionError::new("degree", DEGREE));
        }
        ensure(self.clusters.is_none() || !self.singles, "singles", || {
            "clusters are either given or chosen, one for each vertex".into()
        })?;
        for (number, fits, range, option) in [
            (self.extent, self.extent > 0.0 && self.extent <= 1.0, "(0, 1]", "extent"),
            (self.bulge, (0.0..1.0).contains(&self.bulge), "[0, 1)", "bulge"),
            (self.mu, self.mu > 0.0 && self.mu < 1.0, "(0, 1)", "mu"),
            (self.cut, self.cut > 0.0 && self.cut < 0.5, "(0, 0.5)", "cut"),
            (self.follow, (0.0..1.0).contains(&self.follow), "[0, 1)", "follow"),
        ] {
            ensure(fits, option, || format!("a number in {range} is needed, not {number}"))?;
        }
        within(self.tolerance, &TOLERANCE, "tolerance", "the tolerance is a share of the diagonal")
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        let Some(clusters) = &mut self.clusters else { return Ok(()) };
        clusters.load("clusters", |path| parsed(files, path, entries_from_toml))
    }
}

impl Cluster {
    /// Rounds a closed polyhedron.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`cluster::cluster`].
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Clustered, Error> {
        cluster::cluster(part, &self.params(precision.into())?, watch)
    }

    /// The same for [`cluster::cluster`].
    ///
    /// # Errors
    /// As [`Options::validate`], and for files that have not been read.
    pub fn params(&self, format: Format) -> Result<Params, OptionError> {
        self.validate()?;
        let entries = self.clusters.as_ref().map(|c| c.value("clusters")).transpose()?;
        let wrong = |e: cluster::FileError| OptionError::new("clusters", e.to_string());
        let specs = entries.map(|all| all.iter().map(|e| e.spec().map_err(wrong)).collect()).transpose()?;
        let strip = StripParams {
            order: self.order.unwrap_or(self.continuity),
            balance: self.mu,
            cut: self.cut,
            follow: self.follow,
        };
        Ok(Params {
            clusters: specs,
            cover: if self.singles { CoverParams { distortion: 0.0, short: 0.0 } } else { CoverParams::default() },
            patch: PatchParams {
                continuity: self.continuity,
                degree: self.degree.as_ref().map(Degrees::degree),
                extent: self.extent,
                bulge: self.bulge,
                sharp: self.sharp.iter().map(|e| e.0).collect(),
                all_sharp: self.all_sharp,
                strip,
            },
            tolerance: self.tolerance,
            ..Params::new(format)
        })
    }
}

const DEGREE: &str = "a degree is a whole number, such as 3, or two for four-sided clusters, such as 4,2";

impl FromStr for Degrees {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<usize>> = text.split(',').map(|n| n.trim().parse().ok().filter(|&n| n >= 1)).collect();
        match numbers.as_deref() {
            Some(&[n]) => Ok(Self::Same(n)),
            Some(&[a, b]) => Ok(Self::Tensor([a, b])),
            _ => Err(DEGREE.into()),
        }
    }
}

impl FromStr for Edge {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once('-').and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
        ends.map(Self).ok_or_else(|| "an edge is two vertex ids, such as 4-7".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_and_edges_are_read() {
        assert!(matches!("3".parse(), Ok(Degrees::Same(3))) && matches!("4, 2".parse(), Ok(Degrees::Tensor([4, 2]))));
        assert!(["", "0", "3,", "1,2,3", "-1", "x"].iter().all(|t| t.parse::<Degrees>().is_err()));
        assert_eq!("4-17".parse(), Ok(Edge([4, 17])));
        assert!(["4", "4-", "-4", "a-b"].iter().all(|t| t.parse::<Edge>().is_err()));
        assert_eq!(serde_json::from_str::<Edge>("[4, 17]").unwrap(), Edge([4, 17]));
    }
}
