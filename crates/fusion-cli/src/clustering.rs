//! How clusters are chosen and blended, as typed.

use crate::args::{Source, Target};
use clap::Args;
use fusion::cluster::Degree;
use std::path::PathBuf;

/// Arguments of `cluster`.
#[derive(Args)]
pub struct Cluster {
    /// The polyhedron: polygons, or triangles whose coplanar neighbours are merged
    pub input: PathBuf,
    #[command(flatten)]
    pub target: Target,
    #[command(flatten)]
    pub source: Source,
    /// Order of contact between patches and faces
    #[arg(long, value_name = "G", default_value = "1", value_parser = continuity)]
    pub continuity: usize,
    /// Degree of the patches, or two degrees for four-sided ones: 3, or 4,2; 2g + 1 if not given
    #[arg(long, value_name = "N|N1,N2", value_parser = degree)]
    pub degree: Option<Degree>,
    /// Take the clusters from this file (docs/cluster.md) instead of choosing them
    #[arg(long, value_name = "FILE.toml", conflicts_with = "singles")]
    pub clusters: Option<PathBuf>,
    /// Choose one cluster for each vertex
    #[arg(long)]
    pub singles: bool,
    /// How far patches reach along their open edges, as a share of the edge in (0, 1]; shortened where blends would meet
    #[arg(long, value_name = "SHARE", default_value = "0.7", value_parser = above_zero)]
    pub extent: f64,
    /// 0 for the fairest patches, towards 1 sharper ones
    #[arg(long, value_name = "B", default_value = "0", value_parser = below_one)]
    pub bulge: f64,
    /// Keep the edge between vertices A and B sharp; may be given more than once
    #[arg(long, value_name = "A-B", value_parser = edge)]
    pub sharp: Vec<[u32; 2]>,
    /// Keep all edges between clusters sharp
    #[arg(long)]
    pub all_sharp: bool,
    /// Balance of the strips along open edges, in (0, 1): above ½ they follow the first patch longer
    #[arg(long, value_name = "MU", default_value = "0.5", value_parser = inside_one)]
    pub mu: f64,
    /// Order of contact between strips and patches; that of the patches with the faces if not given
    #[arg(long, value_name = "H", value_parser = order)]
    pub order: Option<usize>,
    /// Where strips cut the patches' corners off: the share of each side, in (0, 0.5)
    #[arg(long, value_name = "SHARE", default_value = "0.36", value_parser = below_half)]
    pub cut: f64,
    /// How far into the corner a strip follows its patch, as a share of the cut, in [0, 1)
    #[arg(long, value_name = "SHARE", default_value = "0.5", value_parser = below_one)]
    pub follow: f64,
    /// Largest distance of the mesh's chords from the surface, as a share of the polyhedron's diagonal
    #[arg(long, value_name = "SHARE", default_value = "0.0002", value_parser = chord)]
    pub tolerance: f64,
    /// Write the control nets and strips here, as JSON
    #[arg(long, value_name = "NETS.json")]
    pub nets: Option<PathBuf>,
    /// Write the exact tensor-product patches and trimmed planes here, as STEP; needs --all-sharp
    #[arg(long, value_name = "FILE.step", requires = "all_sharp")]
    pub step: Option<PathBuf>,
}

fn continuity(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|g| (1..=8).contains(g)).ok_or_else(|| "the order of contact is 1 to 8".into())
}

fn order(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|h| *h <= 8).ok_or_else(|| "the order of contact is 0 to 8".into())
}

fn within(text: &str, range: &str, fits: impl Fn(f64) -> bool) -> Result<f64, String> {
    text.parse().ok().filter(|&x| fits(x)).ok_or_else(|| format!("a number in {range} is needed"))
}

fn above_zero(text: &str) -> Result<f64, String> {
    within(text, "(0, 1]", |x| x > 0.0 && x <= 1.0)
}

fn below_one(text: &str) -> Result<f64, String> {
    within(text, "[0, 1)", |x| (0.0..1.0).contains(&x))
}

fn inside_one(text: &str) -> Result<f64, String> {
    within(text, "(0, 1)", |x| x > 0.0 && x < 1.0)
}

fn below_half(text: &str) -> Result<f64, String> {
    within(text, "(0, 0.5)", |x| x > 0.0 && x < 0.5)
}

fn chord(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|t| (1e-7..=0.1).contains(t));
    share.ok_or_else(|| "the tolerance is a share of the diagonal from 1e-7 to 0.1".into())
}

/// `n`, or `n1,n2` for four-sided clusters.
fn degree(text: &str) -> Result<Degree, String> {
    let numbers: Option<Vec<usize>> = text.split(',').map(|n| n.trim().parse().ok().filter(|&n| n >= 1)).collect();
    match numbers.as_deref() {
        Some([n]) => Ok(Degree::Same(*n)),
        Some([a, b]) => Ok(Degree::Tensor(*a, *b)),
        _ => Err("a degree is a whole number, such as 3, or two for four-sided clusters, such as 4,2".into()),
    }
}

/// `a-b`, two vertices.
fn edge(text: &str) -> Result<[u32; 2], String> {
    let ends = text.split_once('-').and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    ends.ok_or_else(|| "an edge is two vertex ids, such as 4-7".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_and_edges_are_read() {
        assert_eq!((degree("3"), degree("4, 2")), (Ok(Degree::Same(3)), Ok(Degree::Tensor(4, 2))));
        assert!(["", "0", "3,", "1,2,3", "-1", "x"].iter().all(|t| degree(t).is_err()));
        assert_eq!(edge("4-17"), Ok([4, 17]));
        assert!(["4", "4-", "-4", "a-b"].iter().all(|t| edge(t).is_err()));
    }
}
