//! The steps of a repair. What a step does not name it does not touch.

use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::{Error, carry};
use mesh_core::{Connected, FaceId, FaceOrigin, Faces, Origins, TriMesh, VertexId, VertexOrigin, Watch, orient, split};
use mesh_io::{Model, weld_within};
use mesh_repair::{
    Mended, Unfilled, Why, close_cracks, drop_duplicates, drop_flat, drop_specks, drop_unusable, drop_unused_vertices,
    fill_holes,
};

/// One step of a repair. O(n log n) each, unless it says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Drop faces that name a missing vertex or one vertex twice, or have a corner that is no point in space.
    Unusable,
    /// Merge vertices no further apart than this, in model units; 0 merges those at the same place.
    Weld(f64),
    /// Take out faces without area, and split their neighbours where they had a corner.
    Flat,
    /// Drop faces that repeat another.
    Duplicates,
    /// Drop components whose bounding box has a smaller diagonal than this, in model units.
    Specks(f64),
    /// Join boundary edges no further apart than this, in model units.
    Cracks(f64),
    /// Turn faces so that neighbours agree and closed parts face outward.
    Orient,
    /// Take apart edges with more than two faces and vertices with more than one fan, by copying vertices.
    Split,
    /// Fill boundary loops one by one with smooth surfaces; see [`fill_holes`].
    Holes,
    /// Drop vertices that no face uses.
    Unused,
}

/// What a step did.
pub(super) struct Done {
    pub(super) model: Model,
    /// With respect to the mesh before the step.
    pub(super) origins: Origins,
    /// How many of what.
    pub(super) mended: (usize, &'static str),
    /// What it could not mend.
    pub(super) left: Vec<Diagnostic>,
}

impl Step {
    /// Its name in reports.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Unusable => "unusable",
            Self::Weld(_) => "weld",
            Self::Flat => "flat",
            Self::Duplicates => "duplicates",
            Self::Specks(_) => "specks",
            Self::Cracks(_) => "cracks",
            Self::Orient => "orient",
            Self::Split => "split",
            Self::Holes => "holes",
            Self::Unused => "unused",
        }
    }

    /// Does it; `None` where there was nothing to do.
    pub(super) fn apply(self, model: &Model, watch: &Watch) -> Result<Option<Done>, Error> {
        let mesh = &model.mesh;
        let made = |(made, origins): (TriMesh, Origins), mended, left| {
            let model = carry(std::slice::from_ref(model), made, &origins);
            Some(Done { model, origins, mended, left })
        };
        let mended =
            |m: Mended, what| if m.count == 0 { None } else { made((m.mesh, m.origins), (m.count, what), vec![]) };
        Ok(match self {
            Self::Unusable => mended(drop_unusable(mesh), "unusable faces dropped"),
            Self::Weld(tolerance) => weld(model, tolerance),
            Self::Flat => mended(drop_flat(mesh), "faces without area taken out"),
            Self::Duplicates => mended(drop_duplicates(mesh), "duplicate faces dropped"),
            Self::Specks(size) => mended(drop_specks(mesh, size), "small components dropped"),
            Self::Cracks(gap) => mended(close_cracks(mesh, gap, watch)?, "boundary edges closed"),
            Self::Orient => {
                let oriented = orient(mesh);
                let turned = part_turned(mesh, &oriented.0);
                if turned == 0 { None } else { made(oriented, (turned, "turned faces"), vec![]) }
            }
            Self::Split => {
                if Connected::new(mesh).is_ok() {
                    return Ok(None);
                }
                let apart = split(mesh);
                let copies = apart.0.vertex_count() - mesh.vertex_count();
                made(apart, (copies, "vertices copied"), vec![])
            }
            Self::Holes => {
                let Ok(connected) = Connected::new(mesh.clone()) else { return Ok(None) };
                let filled = fill_holes(&connected, watch)?;
                let left = filled.left.iter().map(not_filled).collect();
                made((filled.mesh, filled.origins), (filled.count, "holes filled"), left)
            }
            Self::Unused => mended(drop_unused_vertices(mesh), "unused vertices dropped"),
        })
    }
}

fn not_filled(hole: &Unfilled) -> Diagnostic {
    let why = match hole.why {
        Why::NoSurface => "no triangles between its vertices make a surface",
        Why::Crosses => "every surface tried crosses the mesh or another one",
    };
    let message = format!("the hole of {} edges near {} is left open: {why}", hole.edges, hole.at);
    Diagnostic::new(Code::HoleLeft, Severity::Warning, message).at(hole.at).with("edges", hole.edges as f64)
}

fn weld(model: &Model, tolerance: f64) -> Option<Done> {
    let mut welded = model.clone();
    let done = weld_within(&mut welded, tolerance);
    if done.merged == 0 {
        return None;
    }
    let vertex_of = done.vertex_of;
    let mut first = vec![VertexOrigin::New { stage: "weld" }; welded.mesh.vertex_count()];
    for v in (0..model.mesh.vertex_count()).rev().map(VertexId::from) {
        first[vertex_of[v].index()] = VertexOrigin::Input { part: 0, vertex: v };
    }
    let kept = |f: &FaceId| {
        let [a, b, c] = model.mesh.corners(*f).map(|v| vertex_of[v]);
        a != b && b != c && c != a
    };
    let face = |f: FaceId| {
        let moved = |v: VertexId| model.mesh.positions[v.index()] != welded.mesh.positions[vertex_of[v].index()];
        if tolerance > 0.0 && model.mesh.corners(f).into_iter().any(moved) {
            FaceOrigin::Piece { part: 0, face: f }
        } else {
            FaceOrigin::Input { part: 0, face: f }
        }
    };
    let faces: Vec<_> = model.mesh.face_ids().filter(kept).map(face).collect();
    let origins = Origins { vertices: first.into(), faces: faces.into() };
    Some(Done { model: welded, origins, mended: (done.merged, "merged vertices"), left: vec![] })
}

/// How many faces run the other way round, where the faces are the same ones.
fn part_turned(before: &TriMesh, after: &TriMesh) -> usize {
    let same_count = before.faces.len() == after.faces.len();
    let turned = |(a, b): &(&[VertexId; 3], &[VertexId; 3])| {
        (0..3).any(|k| [a[0], a[2], a[1]] == [b[k], b[(k + 1) % 3], b[(k + 2) % 3]])
    };
    before.faces.iter().zip(&after.faces).filter(turned).count() * usize::from(same_count)
}
