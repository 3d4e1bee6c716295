//! A mesh on its way through several blends, and the account of them.

use crate::blended::Blended;
use crate::curve_blend::{CurveBlend, LeftSharp, Method};
use crate::error::Error;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, Faces, HalfedgeId, Origins, Positions, Stage, TriMesh, VertexId, VertexOrigin,
};
use spine::BlendCurve;
use std::collections::BTreeMap;

/// The mesh as it is after some curves have been blended.
#[derive(Clone)]
pub(crate) struct SoFar<'a> {
    pub input: &'a Connected<TriMesh>,
    pub all: &'a [BlendCurve],
    radius: f64,
    /// The present mesh; `None` while it is the input, or until [`SoFar::connect`].
    pub mesh: Option<Connected<TriMesh>>,
    pub blended: Blended,
    /// Length of the curves blended so far.
    length: f64,
}

impl<'a> SoFar<'a> {
    pub fn new(input: &'a Connected<TriMesh>, all: &'a [BlendCurve], radius: f64) -> Self {
        let mut blended = Blended::new(TriMesh::default(), Origins::default(), FaceId(0));
        blended.curves = all.iter().map(|c| CurveBlend::sharp(c.length(input), None)).collect();
        Self { input, all, radius, mesh: None, blended, length: 0.0 }
    }

    /// Makes ready for more curves to be blended.
    pub fn connect(&mut self) -> Result<(), Error> {
        if self.mesh.is_none() && !self.blended.mesh.faces.is_empty() {
            self.mesh = Some(Connected::new(self.blended.mesh.clone())?);
        }
        Ok(())
    }

    /// Takes the input with more vertices on it for the input; nothing has been blended yet.
    pub fn refined(mut self, mesh: TriMesh, origins: Origins) -> Self {
        self.blended.first_blend_face = FaceId::from(mesh.faces.len());
        (self.blended.mesh, self.blended.origins) = (mesh, origins);
        self
    }

    /// Some of the curves, as curves of the present mesh.
    pub fn curves(&self, chosen: impl Fn(usize) -> bool) -> Result<Vec<BlendCurve>, Error> {
        let chosen = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| &self.all[i]);
        let Some(mesh) = &self.mesh else { return Ok(chosen.cloned().collect()) };
        let mut now = vec![None; self.input.vertex_count()];
        for (v, origin) in (0u32..).zip(self.blended.origins.vertices.as_slice()) {
            if let VertexOrigin::Input { vertex, .. } = origin {
                now[vertex.index()] = Some(VertexId(v));
            }
        }
        let moved = |curve: &BlendCurve| {
            let halfedge = |h| {
                let ends = [self.input.tail(h), self.input.head(h)];
                let [a, b] = [now[ends[0].index()]?, now[ends[1].index()]?];
                mesh.halfedge(a, b)
            };
            let halfedges: Option<Vec<_>> = curve.halfedges.iter().map(|&h| halfedge(h)).collect();
            let at = || curve.halfedges.first().map_or(DVec3::ZERO, |&h| self.input.position(self.input.tail(h)));
            let lost = || Trouble::at("a strip covers a neighbouring curve", vec![at()]).into_error(f64::NAN);
            Ok(BlendCurve { halfedges: halfedges.ok_or_else(lost)?, closed: curve.closed })
        };
        chosen.map(moved).collect()
    }

    /// What is left of some of the curves on the present mesh: along each of their edges the pieces of it that are edges
    /// still. One that was covered in part gives several.
    pub fn pieces(&self, chosen: impl Fn(usize) -> bool) -> Vec<BlendCurve> {
        let chosen = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| &self.all[i]);
        let Some(mesh) = &self.mesh else { return chosen.cloned().collect() };
        let mut now = vec![None; self.input.vertex_count()];
        let mut splits: BTreeMap<[VertexId; 2], Vec<(f64, VertexId)>> = BTreeMap::new();
        for (v, origin) in (0u32..).map(VertexId).zip(self.blended.origins.vertices.as_slice()) {
            match *origin {
                VertexOrigin::Input { vertex, .. } => now[vertex.index()] = Some(v),
                VertexOrigin::Edge { ends: [a, b], t, .. } if a < b => splits.entry([a, b]).or_default().push((t, v)),
                VertexOrigin::Edge { ends: [a, b], t, .. } => splits.entry([b, a]).or_default().push((1.0 - t, v)),
                _ => {}
            }
        }
        for split in splits.values_mut() {
            split.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        let mut found = vec![];
        for curve in chosen {
            let mut chain: Vec<Option<VertexId>> = vec![];
            for &h in &curve.halfedges {
                let (a, b) = (self.input.tail(h), self.input.head(h));
                chain.push(now[a.index()]);
                let mut within: Vec<VertexId> =
                    splits.get(&[a.min(b), a.max(b)]).into_iter().flatten().map(|s| s.1).collect();
                if b < a {
                    within.reverse();
                }
                chain.extend(within.into_iter().map(Some));
            }
            chain.extend(curve.halfedges.last().map(|&h| now[self.input.head(h).index()]));
            let mut halfedges = vec![];
            let mut whole = curve.closed;
            let mut close = |halfedges: &mut Vec<HalfedgeId>, closed| {
                if !halfedges.is_empty() {
                    found.push(BlendCurve { halfedges: std::mem::take(halfedges), closed });
                }
            };
            for w in chain.windows(2) {
                if let Some(h) = w[0].zip(w[1]).and_then(|(a, b)| mesh.halfedge(a, b)) {
                    halfedges.push(h);
                } else {
                    whole = false;
                    close(&mut halfedges, false);
                }
            }
            close(&mut halfedges, whole);
        }
        found
    }

    /// Notes that some of the curves stay sharp, and why.
    pub fn leave(&mut self, chosen: impl Fn(usize) -> bool, at: DVec3, what: &'static str) {
        let own = (0..self.all.len()).filter(|&i| chosen(i));
        let length: f64 = own.clone().map(|i| self.all[i].length(self.input)).sum();
        for i in own {
            let why = Some((at, LeftSharp::Stage(what)));
            self.blended.curves[i] = CurveBlend::sharp(self.blended.curves[i].length, why);
        }
        self.account(length, 0.0);
    }

    /// Notes that nothing is left of some of the curves: the blends of others cover them.
    pub fn consumed(&mut self, chosen: impl Fn(usize) -> bool, method: Method) {
        let length: f64 = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| self.all[i].length(self.input)).sum();
        for i in (0..self.all.len()).filter(|&i| chosen(i)) {
            self.blended.curves[i] = CurveBlend::made(method, self.radius, self.blended.curves[i].length, 1.0);
        }
        self.account(length, 1.0);
    }

    /// Adds `length` of curves with a share of the full ball to the account.
    fn account(&mut self, length: f64, full_share: f64) {
        let so_far = &mut self.blended;
        so_far.full_share =
            (so_far.full_share * self.length + full_share * length) / (self.length + length).max(f64::MIN_POSITIVE);
        self.length += length;
    }

    /// Adds a blend made on the present mesh, which becomes the present one.
    pub fn add(&mut self, made: Blended, chosen: impl Fn(usize) -> bool) {
        let own: f64 = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| self.all[i].length(self.input)).sum();
        let so_far = &mut self.blended;
        for (k, i) in (0..self.all.len()).filter(|&i| chosen(i)).enumerate() {
            let by_field = || {
                let least = made.shrunk.iter().map(|s| s.1).fold(self.radius, f64::min);
                CurveBlend::made(Method::Field, least, so_far.curves[i].length, made.full_share)
            };
            so_far.curves[i] = made.curves.get(k).copied().unwrap_or_else(by_field);
        }
        let before = self.mesh.take();
        so_far.origins = match &before {
            Some(before) => {
                let stage = Stage { origins: &so_far.origins, faces: before };
                made.origins.compose(&[stage], &[self.input as &dyn Faces])
            }
            None => made.origins,
        };
        if before.is_none() {
            so_far.first_blend_face = made.first_blend_face;
        }
        so_far.strips += made.strips;
        so_far.fields += made.fields;
        so_far.corners += made.corners;
        so_far.residual = so_far.residual.max(made.residual);
        so_far.bridged += made.bridged;
        so_far.shrunk.extend(made.shrunk);
        so_far.run_outs.extend(made.run_outs);
        so_far.levels = so_far.levels.max(made.levels);
        so_far.mesh = made.mesh;
        self.account(own, made.full_share);
    }
}
