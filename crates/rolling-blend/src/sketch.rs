//! What the stages of a blend draw for whoever wants to look: curves and meshes, above all where a blend is refused.

use crate::profiles::Profiles;
use crate::stretch::Stretch;
use crate::strip::{Fineness, Piece, profile_points};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Connected, FaceId, Faces, Positions, TriMesh, VertexId};
use spine::{BlendCurve, Halt, Patch, Rail, Sample};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// One thing to look at, in model units.
#[derive(Clone, Debug, PartialEq)]
pub enum Drawing {
    /// Chains of points, and whether each is closed.
    Lines(Vec<(Vec<DVec3>, bool)>),
    /// A surface.
    Mesh(TriMesh),
}

impl Drawing {
    fn line(points: impl IntoIterator<Item = DVec3>, closed: bool) -> Self {
        Self::Lines(vec![(points.into_iter().collect(), closed)])
    }
}

/// A sketchbook in which the stages of a blend draw; what they drew last stays, whether the blend succeeds or not.
///
/// Cheap to clone: all clones are the same book. `Sketch::default()` is none, and costs nothing.
///
/// ```
/// use rolling_blend::{Drawing, Params, Sketch, blend};
/// use mesh_core::{Connected, VertexId, Watch, shapes};
/// let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
/// let rim = rolling_blend::BlendCurve::from_vertices(&cube, &[4, 5, 7, 6].map(VertexId))?;
/// let sketch = Sketch::new();
/// blend(&cube, &[rim], &Params { sketch: sketch.clone(), ..Params::new(0.1) }, &Watch::default())?;
/// let Drawing::Lines(spine) = &sketch.drawings()["curve-0-spine"] else { panic!() };
/// assert!(spine[0].0.iter().all(|p| (p.z - 0.4).abs() < 1e-9));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Sketch(Option<Arc<Mutex<Book>>>);

#[derive(Debug, Default)]
struct Book {
    /// The first edge of every curve met so far, by which it is known again: a curve keeps its number from try to try.
    curves: Vec<[DVec3; 2]>,
    drawings: BTreeMap<String, Drawing>,
}

impl Book {
    /// A curve's number; the next free one if it is met for the first time.
    fn number(&mut self, mesh: &Connected<TriMesh>, curve: &BlendCurve) -> usize {
        let Some(&first) = curve.halfedges.first() else { return 0 };
        let key = mesh.ends(first);
        self.curves.iter().position(|k| *k == key).unwrap_or_else(|| {
            self.curves.push(key);
            self.curves.len() - 1
        })
    }
}

impl Sketch {
    /// An empty book that is drawn in.
    pub fn new() -> Self {
        Self(Some(Arc::default()))
    }

    /// Everything drawn, by names such as `curve-0-spine`; docs/blend.md lists them.
    pub fn drawings(&self) -> BTreeMap<String, Drawing> {
        self.book().map(|book| book.drawings.clone()).unwrap_or_default()
    }

    fn book(&self) -> Option<MutexGuard<'_, Book>> {
        self.0.as_ref().map(|book| book.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Begins a new try: each curve gets a fresh page with nothing but itself on it.
    pub(crate) fn begin(&self, mesh: &Connected<TriMesh>, curves: &[BlendCurve]) {
        let Some(mut book) = self.book() else { return };
        book.drawings.retain(|name, _| !name.starts_with("corner-") && name != REFUSED);
        for curve in curves {
            let mut points = curve.points(mesh);
            points.extend(curve.ends(mesh).last().map(|end| end.0));
            let number = book.number(mesh, curve);
            let own = [format!("curve-{number}-"), format!("field-{number}-")];
            book.drawings.retain(|name, _| !own.iter().any(|own| name.starts_with(own)));
            book.drawings.insert(format!("{}edges", own[0]), Drawing::line(points, curve.closed));
        }
    }

    /// The page of a curve.
    pub(crate) fn page(&self, mesh: &Connected<TriMesh>, curve: &BlendCurve) -> Page<'_> {
        Page { sketch: self, number: self.book().map_or(0, |mut book| book.number(mesh, curve)) }
    }

    /// Draws if somebody looks.
    pub(crate) fn draw(&self, name: &str, drawing: impl FnOnce() -> Drawing) {
        if self.0.is_none() {
            return;
        }
        let drawing = drawing();
        if let Some(mut book) = self.book() {
            book.drawings.insert(name.into(), drawing);
        }
    }

    /// Marks the places of trouble by crosses half a `radius` wide.
    pub(crate) fn refusal(&self, trouble: &Trouble, radius: f64) {
        let Trouble::Places { places, .. } = trouble else { return };
        let arms = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| 0.25 * radius * axis);
        let cross = |&p: &DVec3| arms.map(|arm| (vec![p - arm, p + arm], false));
        self.draw(REFUSED, || Drawing::Lines(places.iter().flat_map(cross).collect()));
    }
}

/// What the drawing of a name shows.
pub fn meaning(name: &str) -> &'static str {
    let kind = name.splitn(3, '-').nth(2).unwrap_or(name);
    match kind {
        "edges" => "the blend curve, along edges of the mesh",
        "spine" => "the way of the ball's centre, as far as it came",
        "linkage-left" | "linkage-right" | "linkages" => "where the ball touches: the borders of the blend",
        "profiles" => "cross-sections of the blend",
        "strip" | "surface" => "the surface put in",
        "patch-left" | "patch-right" => "the part of the mesh that the ball rolls on",
        "region" => "the triangles that are moved, as they were",
        "domain" => "the same triangles in the plane: along the curve, across it, 0",
        REFUSED => "a cross at each place where the last try failed",
        _ => "the patch where blends meet",
    }
}

/// The drawing of places where the last try was refused.
const REFUSED: &str = "refused-places";

/// Where one curve's drawings go.
#[derive(Clone, Copy)]
pub(crate) struct Page<'a> {
    sketch: &'a Sketch,
    number: usize,
}

impl Page<'_> {
    /// Draws `curve-N-NAME`, if somebody looks.
    pub fn draw(&self, name: &str, drawing: impl FnOnce() -> Drawing) {
        self.sketch.draw(&format!("curve-{}-{name}", self.number), drawing);
    }

    /// Draws `field-N-NAME`, where N is the field's first curve, if somebody looks.
    pub fn draw_field(&self, name: &str, drawing: impl FnOnce() -> Drawing) {
        self.sketch.draw(&format!("field-{}-{name}", self.number), drawing);
    }

    /// The ball's way, the linkages, and the base patches.
    pub fn rail(&self, mesh: &Connected<TriMesh>, rail: &Rail) {
        self.way(rail);
        self.patches(mesh, &rail.patches);
    }

    /// The ball's way and the linkages.
    fn way(&self, rail: &Rail) {
        let (samples, closed) = (&rail.samples, rail.closed);
        self.draw("spine", || Drawing::line(samples.iter().map(|s| s.center), closed));
        for (side, name) in ["linkage-left", "linkage-right"].into_iter().enumerate() {
            self.draw(name, || Drawing::line(samples.iter().map(|s| s.feet[side].point), closed));
        }
    }

    /// A rail cut to length, and its profiles as they are before they are sewn on.
    pub fn stretch(&self, stretch: &Stretch, profiles: &Profiles, fineness: Fineness) {
        self.way(&stretch.rail);
        self.draw("profiles", || {
            let row = |s: &Sample| {
                let mut row = Vec::new();
                profile_points(profiles, s, s.feet.map(|f| f.point), fineness, &mut row);
                (row, false)
            };
            Drawing::Lines(stretch.rail.samples.iter().map(row).collect())
        });
    }

    /// As far as a ball came that did not come all the way.
    pub fn halt(&self, mesh: &Connected<TriMesh>, halt: &Halt) {
        self.draw("spine", || Drawing::line(halt.balls.iter().copied(), false));
        if let Some(patches) = &halt.patches {
            self.patches(mesh, patches);
        }
    }

    fn patches(&self, mesh: &Connected<TriMesh>, patches: &[Patch; 2]) {
        for (patch, name) in patches.iter().zip(["patch-left", "patch-right"]) {
            self.draw(name, || Drawing::Mesh(some_faces(mesh, &patch.faces)));
        }
    }
}

/// Triangles to be put in, with all that were made before them.
pub(crate) fn piece_of(piece: &Piece, cut: &TriMesh, made: &[DVec3]) -> Drawing {
    let at =
        |v: VertexId| cut.positions.get(v.index()).copied().unwrap_or_else(|| made[v.index() - cut.positions.len()]);
    Drawing::Mesh(by_themselves(piece.faces.iter().copied(), at))
}

/// Some faces of a mesh by themselves.
fn some_faces(mesh: &Connected<TriMesh>, faces: &[FaceId]) -> TriMesh {
    by_themselves(faces.iter().map(|&f| mesh.corners(f)), |v| mesh.mesh().positions[v.index()])
}

/// A mesh of these faces alone, their vertices renumbered in the order of their ids.
fn by_themselves(faces: impl Iterator<Item = [VertexId; 3]> + Clone, position: impl Fn(VertexId) -> DVec3) -> TriMesh {
    let mut vertices: Vec<VertexId> = faces.clone().flatten().collect();
    vertices.sort_unstable();
    vertices.dedup();
    let number = |v: VertexId| VertexId::from(vertices.binary_search(&v).unwrap_or(0));
    TriMesh {
        faces: faces.map(|f| f.map(number)).collect(),
        positions: vertices.iter().map(|&v| position(v)).collect(),
    }
}
