//! Linkage curves on the surface: fair feet joined by short walks, then made edges of the mesh.

use super::trouble::Trouble;
use mesh_core::{Adjacency, Positions, TraceError, TraceLimits, VertexId, Watch};
use spine::Rail;
use tri_intersect::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};

/// One linkage as vertices of the cut mesh.
pub(crate) struct Linkage {
    /// The closed chain, its first vertex repeated at the end.
    chain: Vec<VertexId>,
    /// For each profile, its foot's index in the chain; one more for the first profile again.
    feet: Vec<usize>,
}

impl Linkage {
    /// The foot of profile `i`.
    pub fn foot(&self, i: usize) -> VertexId {
        self.chain[self.feet[i]]
    }

    /// The chain from the foot of profile `i` to that of the next, both included.
    pub fn span(&self, i: usize) -> &[VertexId] {
        &self.chain[self.feet[i]..=self.feet[i + 1]]
    }

    /// The closed chain, its first vertex repeated at the end.
    pub fn chain(&self) -> &[VertexId] {
        &self.chain
    }
}

/// The mesh with all linkages cut into it.
pub(crate) struct Opened {
    pub embedded: Embedded,
    /// Left and right linkage of every rail.
    pub linkages: Vec<[Linkage; 2]>,
}

/// Cuts both linkages of every rail into the mesh. Their points move at most `snap` radii to spare slivers.
pub(crate) fn cut_linkages<M: Adjacency + Positions + Sync>(
    mesh: &M,
    rails: &[&Rail],
    snap: f64,
    radius: f64,
    watch: &Watch,
) -> Result<Opened, Trouble> {
    let mut curves = Vec::new();
    let mut feet = Vec::new();
    for rail in rails {
        for side in 0..2 {
            let samples: Vec<_> = rail
                .samples
                .iter()
                .map(|s| (s.feet[side].surface_point(mesh), (s.center - s.feet[side].point).normalize_or_zero()))
                .collect();
            let (curve, places) =
                SurfaceCurve::through(mesh, &samples, true, &TraceLimits::default()).map_err(|e| match e {
                    TraceError::Lost { from, to, .. } => {
                        Trouble::at("a linkage leaves the surface", vec![from.midpoint(to)])
                    }
                    TraceError::BadPoint { point } => {
                        Trouble::at("a linkage leaves the surface", vec![point.position(mesh)])
                    }
                })?;
            curves.push(curve);
            feet.push(places);
        }
    }
    let embedded =
        embed(mesh, &curves, &EmbedParams { snap: (2.5 * snap).clamp(0.01, 0.1), reach: snap * radius }, watch)
            .map_err(|e| match e {
                EmbedError::Crossings(found) => Trouble::at("linkages cross", found.iter().map(|c| c.place).collect()),
                EmbedError::Apart { place, .. } | EmbedError::TooSmall { place, .. } => {
                    Trouble::at("a linkage cannot be cut into the mesh", vec![place])
                }
                EmbedError::Collapsed { curve } => {
                    Trouble::at("a linkage shrinks to a point", vec![rails[curve / 2].samples[0].center])
                }
                EmbedError::Cancelled(c) => Trouble::Cancelled(c),
                e @ (EmbedError::BadPoint { .. } | EmbedError::TooMany) => Trouble::Embed(e),
            })?;
    let mut sides = (0..curves.len()).map(|c| {
        let mut chain = embedded.curves[c].clone();
        let places: Vec<usize> = feet[c].iter().map(|&p| embedded.places[c][p]).collect();
        // Merging may have moved the first foot to the end of the chain: turn the chain to begin with it.
        chain.rotate_left(places[0]);
        let n = chain.len();
        let mut feet: Vec<usize> = places.iter().map(|&p| (p + n - places[0]) % n).collect();
        // Feet merged with the first one across the closure belong to the end.
        let mut highest = 0;
        for f in &mut feet {
            if *f < highest {
                *f = n;
            }
            highest = *f;
        }
        feet.push(n);
        chain.push(chain[0]);
        Linkage { chain, feet }
    });
    let mut linkages = Vec::with_capacity(rails.len());
    while let (Some(left), Some(right)) = (sides.next(), sides.next()) {
        linkages.push([left, right]);
    }
    drop(sides);
    Ok(Opened { embedded, linkages })
}
