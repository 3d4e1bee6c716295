//! A surface taken apart into a smooth base and the detail on it.

use crate::error::Error;
use crate::operator::{Diffusion, Operator};
use crate::patch::{Patch, patch};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, Positions, TriMesh, VertexId, Watch, centroid, triangle_normal,
    vertex_normals,
};
use mesh_operators::Submesh;
use std::f64::consts::TAU;

/// How a base surface is found.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseParams {
    /// What is shorter than this wavelength is detail, what is longer is shape: at it, three tenths of a wave's height count as
    /// detail, at half of it eight tenths. In model units, positive.
    pub wavelength: f64,
    /// The share of the source's area that may fold over its base before it is refused, in [0, 1].
    pub most_folded: f64,
}

impl BaseParams {
    /// With no more than 2% folded over.
    pub fn new(wavelength: f64) -> Self {
        Self { wavelength, most_folded: 0.02 }
    }

    /// The length over which a wave turns by one radian.
    fn radius(&self) -> f64 {
        self.wavelength / TAU
    }
}

/// Implicit steps of a round, rounds, and the length of a step in squared wavelengths over (2π)², so that half of a wave of the very
/// wavelength is base: 1 − (1 − (1 + t)⁻³)⁴ = ½.
const STEPS: usize = 3;
const ROUNDS: usize = 4;
const STEP: f64 = 0.846;

/// How far around a region its base surface is found, in wavelengths: the rim of the patch, where the base is held to the
/// surface, is felt no farther.
const MARGIN: f64 = 1.25;

/// The detail at one vertex, in the frame of the base surface there: along its tangent, across, and along its normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail {
    /// Difference of the Laplacian coordinates of surface and base, both by the base's operator (\[Lin2008\] §4.2's ξ), in 1/model unit: of
    /// a bump of height h and wavelength λ, h·(2π/λ)².
    pub bend: DVec3,
    /// Offset of the surface from its base, in model units.
    pub offset: DVec3,
}

impl Detail {
    /// The same detail, times a factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { bend: factor * self.bend, offset: factor * self.offset }
    }
}

/// A local frame on the base surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Unit tangent; neighbouring vertices have nearly parallel ones.
    pub tangent: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

impl Frame {
    /// A world vector by its coordinates here.
    pub fn local(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.tangent), v.dot(self.normal.cross(self.tangent)), v.dot(self.normal))
    }

    /// The world vector of coordinates here.
    pub fn world(&self, v: DVec3) -> DVec3 {
        v.x * self.tangent + v.y * self.normal.cross(self.tangent) + v.z * self.normal
    }

    /// The frame turned least so that its normal becomes `normal`.
    pub(crate) fn carried(&self, normal: DVec3) -> Self {
        let axis = self.normal.cross(normal);
        let turned = self.tangent
            + axis.cross(self.tangent)
            + axis.cross(axis.cross(self.tangent)) / (1.0 + self.normal.dot(normal)).max(1e-9);
        Self { tangent: tangent_to(turned, normal), normal }
    }
}

/// The unit vector across `normal` closest to `v`, or any.
fn tangent_to(v: DVec3, normal: DVec3) -> DVec3 {
    (v - v.dot(normal) * normal).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector())
}

/// A patch of a surface: its smooth base and the detail on it.
#[derive(Debug)]
pub struct Relief {
    base: Connected<TriMesh>,
    vertices: Vec<VertexId>,
    faces: Vec<FaceId>,
    inside: Vec<bool>,
    rim: Vec<bool>,
    operator: Operator,
    frames: Vec<Frame>,
    /// The surface minus its base, in world coordinates.
    offsets: Vec<DVec3>,
    details: Vec<Detail>,
    wavelength: f64,
    anchor: f64,
}

impl Relief {
    /// Takes the region `inside` of a mesh, and as much around it as its base depends on, apart.
    ///
    /// The base is that of implicit curvature flow (\[Desbrun1999\]): two implicit steps, and the same two again for what they
    /// took away, so that shapes longer than the wavelength hardly shrink. Boundaries of the mesh are held. One sparse factor serves all four steps;
    /// O(n^1.5) in the patch's vertices.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NotFinite`], [`Error::Length`], [`Error::Singular`], [`Error::Cancelled`].
    pub fn encode(
        mesh: &Connected<TriMesh>,
        inside: &FaceMap<bool>,
        params: &BaseParams,
        watch: &Watch,
    ) -> Result<Self, Error> {
        Self::encode_as("source", mesh, inside, params, 0.0, watch)
    }

    pub(crate) fn encode_as(
        which: &'static str,
        mesh: &Connected<TriMesh>,
        inside: &FaceMap<bool>,
        params: &BaseParams,
        reach: f64,
        watch: &Watch,
    ) -> Result<Self, Error> {
        let wavelength = params.wavelength;
        if !(wavelength > 0.0 && wavelength.is_finite()) {
            return Err(Error::Length { name: "wavelength", value: wavelength });
        }
        watch.step("base", 0.0)?;
        let Patch { mesh: own, vertices, faces, inside, rim } =
            patch(mesh, inside, MARGIN * wavelength + reach, which)?;
        let surface = &own.mesh().positions;
        let at = surface[0];
        let smooth = {
            let operator = Operator::new(&own);
            let time = STEP * params.radius() * params.radius();
            let flow = Diffusion::new(&operator, &rim, time).ok_or(Error::Singular { at })?;
            let mut smooth = vec![DVec3::ZERO; surface.len()];
            for round in 0..ROUNDS {
                watch.step("base", round as f64 / ROUNDS as f64)?;
                let mut taken: Vec<DVec3> = surface.iter().zip(&smooth).map(|(p, s)| *p - *s).collect();
                for _ in 0..STEPS {
                    taken = flow.step(&taken);
                }
                smooth.iter_mut().zip(taken).for_each(|(s, t)| *s += t);
            }
            smooth
        };
        let offsets: Vec<DVec3> = surface.iter().zip(&smooth).map(|(p, s)| *p - *s).collect();
        let base = TriMesh { positions: smooth, faces: own.into_mesh().faces };
        let base = Connected::new(base).map_err(|_| Error::Singular { at })?;
        let operator = Operator::new(&base);
        let frames = frames(&base);
        let detail = |i: usize| Detail {
            bend: frames[i].local(operator.laplacian(&offsets, i)),
            offset: frames[i].local(offsets[i]),
        };
        let details: Vec<Detail> = (0..offsets.len()).map(detail).collect();
        if let Some(i) = details.iter().position(|d| !d.bend.is_finite()) {
            return Err(Error::Singular { at: base.position(VertexId::from(i)) });
        }
        watch.step("base", 1.0)?;
        let anchor = params.radius();
        Ok(Self { base, vertices, faces, inside, rim, operator, frames, offsets, details, wavelength, anchor })
    }

    /// The base surface of the patch, with numbers of its own.
    pub fn base(&self) -> &Connected<TriMesh> {
        &self.base
    }

    /// The names that the patch's vertices have in the mesh they come from, ascending.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// The names of the patch's faces.
    pub fn faces(&self) -> &[FaceId] {
        &self.faces
    }

    /// The detail at each vertex of the patch.
    pub fn details(&self) -> &[Detail] {
        &self.details
    }

    /// The frame of the base at each vertex of the patch.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Which of the patch's faces belong to the region.
    pub fn inside(&self) -> &[bool] {
        &self.inside
    }

    /// Vertices of the patch all of whose faces belong to the region and none of which lies on a boundary.
    pub fn interior(&self) -> Vec<bool> {
        let inner = |v: VertexId| !self.rim[v.index()] && self.base.ring(v).all(|h| self.inside[h.face().index()]);
        self.base.vertex_ids().map(inner).collect()
    }

    /// The share of the region's area that looks away from its base, a place there, and the region's handles: what no
    /// displacement of the base can carry.
    pub fn folded(&self) -> Option<(f64, DVec3, usize)> {
        let surface: Vec<DVec3> = self.base.mesh().positions.iter().zip(&self.offsets).map(|(b, d)| *b + *d).collect();
        let (mut area, mut folded, mut place) = (0.0, 0.0, None);
        for f in self.base.face_ids().filter(|f| self.inside[f.index()]) {
            let corners = self.base.corners(f).map(|v| surface[v.index()]);
            let own = mesh_core::area_vector(corners).length();
            area += own;
            if triangle_normal(corners).dot(triangle_normal(self.base.triangle(f))) <= 0.0 {
                folded += own;
                place = place.or(Some(centroid(corners)));
            }
        }
        place.map(|at| (folded / area, at, self.handles()))
    }

    fn handles(&self) -> usize {
        let region = Submesh::new(&self.base, |f| self.inside[f.index()]);
        let genus = Connected::new(region.mesh).map_or(0, |m| mesh_core::topology(&m).genus());
        usize::try_from(genus).unwrap_or(0)
    }

    pub(crate) fn operator(&self) -> &Operator {
        &self.operator
    }

    pub(crate) fn offsets(&self) -> &[DVec3] {
        &self.offsets
    }

    pub(crate) fn rim(&self) -> &[bool] {
        &self.rim
    }

    pub(crate) fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// The length over which bend and offset weigh the same, in model units: a radian of the wavelength, if [`Relief::weigh`] did not set it.
    pub fn anchor(&self) -> f64 {
        self.anchor
    }

    /// Weighs bends and offsets as errors of details like those of `sources` deserve, which is by their variances: sets [`Relief::anchor`] to the fourth root of
    /// the offsets' mean square over the bends'.
    pub fn weigh(&mut self, sources: &[(&Self, Vec<bool>)]) {
        let mut squares = [0.0; 2];
        for (relief, excluded) in sources {
            for v in relief.region_vertices(excluded) {
                let d = relief.details[v as usize];
                let area = relief.operator.area(v as usize);
                squares[0] += area * d.offset.length_squared();
                squares[1] += area * d.bend.length_squared();
            }
        }
        let length = (squares[0] / squares[1]).sqrt().sqrt();
        if length > 0.0 && length < self.anchor {
            self.anchor = length;
        }
    }

    /// What details are compared by: bend, and offset where waves are long. In 1/model unit.
    pub(crate) fn signal(&self, d: &Detail) -> DVec3 {
        d.bend + d.offset / (self.anchor * self.anchor)
    }

    /// The longest edge of the region's base, the longest hundredth left aside: a needle of a cut says nothing about the rest.
    pub(crate) fn longest_edge(&self) -> f64 {
        let inside = self.base.face_ids().filter(|f| self.inside[f.index()]);
        let sides = |p: [DVec3; 3]| [0, 1, 2].map(|k| p[k].distance(p[(k + 1) % 3]));
        let mut lengths: Vec<f64> = inside.flat_map(|f| sides(self.base.triangle(f))).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        lengths.get(lengths.len() * 99 / 100).copied().unwrap_or_default()
    }

    /// Vertices of the region's faces that are neither on the rim nor `excluded`.
    pub(crate) fn region_vertices<'a>(&'a self, excluded: &'a [bool]) -> impl Iterator<Item = u32> + 'a {
        let in_region = |v: VertexId| self.base.ring(v).any(|h| self.inside[h.face().index()]);
        let usable = |v: &VertexId| !self.rim[v.index()] && excluded.get(v.index()) != Some(&true);
        self.base.vertex_ids().filter(usable).filter(move |&v| in_region(v)).map(|v| v.0)
    }
}

/// Frames carried from vertex to vertex, breadth first from the lowest of each piece, so that neighbours are nearly parallel. The first
/// tangent runs along an edge: frames turn with the surface.
fn frames(base: &Connected<TriMesh>) -> Vec<Frame> {
    let normals = vertex_normals(base);
    let mut out: Vec<Option<Frame>> = vec![None; base.vertex_count()];
    for first in base.vertex_ids() {
        if out[first.index()].is_some() {
            continue;
        }
        let along = base.outgoing(first).map_or(DVec3::X, |h| base.position(base.head(h)) - base.position(first));
        let normal = unit(normals[first]);
        let mut last = Frame { tangent: tangent_to(along, normal), normal };
        out[first.index()] = Some(last);
        let mut queue = std::collections::VecDeque::from([first]);
        while let Some(v) = queue.pop_front() {
            last = out[v.index()].unwrap_or(last);
            for h in base.ring(v) {
                for w in [base.head(h), base.tail(h.prev())] {
                    if out[w.index()].is_none() {
                        out[w.index()] = Some(last.carried(unit(normals[w])));
                        queue.push_back(w);
                    }
                }
            }
        }
    }
    out.into_iter().map(|f| f.unwrap_or(Frame { tangent: DVec3::X, normal: DVec3::Z })).collect()
}

fn unit(normal: DVec3) -> DVec3 {
    if normal == DVec3::ZERO { DVec3::Z } else { normal }
}
