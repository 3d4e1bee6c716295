//! The mesh in a unit frame, its tree, and what a ray sees.

use crate::camera::{Camera, Ray, unit};
use crate::color::Paint;
use crate::normals::corner_normals;
use crate::params::{Error, Ground, Params};
use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, TriMesh, VertexId};
use mesh_query::TriBvh;

/// How far rays that gather ambient light look, in half sizes of the model.
pub(crate) const REACH: f64 = 1.0;

pub(crate) struct Scene {
    /// Centred on the origin and scaled into [−1, 1], so that no length over- or underflows.
    pub(crate) mesh: TriMesh,
    pub(crate) tree: TriBvh,
    pub(crate) paint: Paint,
    /// One per corner, three per face.
    normals: Vec<[DVec3; 3]>,
    floor: Option<Floor>,
}

/// An unseen plane that receives a shadow.
struct Floor {
    up: DVec3,
    height: f64,
    /// How clearly it is seen: 0 for a view along it.
    strength: f64,
    /// Where the model's shadow may fall.
    reach: Bounds,
}

/// What a ray sees.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sight {
    /// Nothing.
    Sky,
    /// A shadow may fall here.
    Floor(Place, f64),
    /// The model.
    Surface { place: Place, face: FaceId, barycentric: [f64; 3], shading_normal: DVec3, front: bool },
}

/// A point that light reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) point: DVec3,
    /// Of the facet, towards the camera.
    pub(crate) normal: DVec3,
}

impl Sight {
    pub(crate) fn place(&self) -> Option<&Place> {
        match self {
            Self::Sky => None,
            Self::Floor(place, _) | Self::Surface { place, .. } => Some(place),
        }
    }
}

impl Scene {
    pub(crate) fn new(mesh: &TriMesh, params: &Params) -> Result<Self, Error> {
        if mesh.faces.is_empty() {
            return Err(Error::Empty);
        }
        // The first tree is for its checks and its box alone; boxes of real meshes take a fraction of the picture.
        let bounds = TriBvh::build(mesh)?.bounds();
        let half = (0.5 * bounds.max - 0.5 * bounds.min).max_element();
        let inverse = if half > 0.0 { half.recip().min(f64::MAX) } else { 1.0 };
        // Unreferenced vertices may be anything; they must not reach the framing.
        let mut used = vec![false; mesh.vertex_count()];
        mesh.faces.iter().flatten().for_each(|v| used[v.index()] = true);
        let unit_frame = |(i, p): (usize, &DVec3)| {
            if used[i] { (*p - bounds.center()) * inverse } else { DVec3::ZERO }
        };
        let mesh = TriMesh {
            positions: mesh.positions.iter().enumerate().map(unit_frame).collect(),
            faces: mesh.faces.clone(),
        };
        let tree = TriBvh::build(&mesh)?;
        let paint = Paint::new(&mesh, &params.color)?;
        let normals = corner_normals(&mesh, params.shading);
        Ok(Self { mesh, tree, paint, normals, floor: None })
    }

    /// Puts a floor under the model, if one is wanted and the camera is above it.
    pub(crate) fn with_floor(mut self, params: &Params, camera: &Camera) -> Self {
        if let (Ground::Shadow, Some(up)) = (params.ground, unit(params.up)) {
            let height = self.mesh.faces.iter().flatten().map(|&v| self.at(v).dot(up)).fold(f64::INFINITY, f64::min);
            let strength = ((camera.axes[2].dot(up) - 0.05) / 0.2).clamp(0.0, 1.0);
            self.floor = (strength > 0.0).then(|| Floor {
                up,
                height,
                strength,
                reach: self.tree.bounds().inflated(0.75 * REACH),
            });
        }
        self
    }

    fn at(&self, v: VertexId) -> DVec3 {
        self.mesh.positions[v.index()]
    }

    pub(crate) fn look(&self, ray: &Ray) -> Sight {
        if let Some(hit) = self.tree.ray_cast(&self.mesh, ray.origin, ray.direction, f64::INFINITY) {
            let [a, b, c] = self.mesh.triangle(hit.face);
            let facing = (b - a).cross(c - a).normalize_or(-ray.direction);
            let front = facing.dot(ray.direction) < 0.0;
            let side = if front { 1.0 } else { -1.0 };
            let [na, nb, nc] = self.normals[hit.face.index()];
            let [u, v, w] = hit.barycentric;
            let shading_normal = side * (u * na + v * nb + w * nc).normalize_or(facing);
            let place = Place { point: ray.origin + hit.t * ray.direction, normal: side * facing };
            return Sight::Surface { place, face: hit.face, barycentric: hit.barycentric, shading_normal, front };
        }
        self.floor.as_ref().and_then(|floor| floor.seen_along(ray)).unwrap_or(Sight::Sky)
    }
}

impl Floor {
    fn seen_along(&self, ray: &Ray) -> Option<Sight> {
        let t = (self.height - ray.origin.dot(self.up)) / ray.direction.dot(self.up);
        let point = ray.origin + t * ray.direction;
        (t > 0.0 && self.reach.overlaps(&Bounds { min: point, max: point }))
            .then_some(Sight::Floor(Place { point, normal: self.up }, self.strength))
    }
}
