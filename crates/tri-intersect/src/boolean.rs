//! Union, difference and intersection of two solids.

use crate::arrange::{self, Arrangement, Part};
use crate::assemble::{Assembly, assemble};
use crate::classify::{CUT, Flood, SeamTable};
use crate::cut::Snaps;
use crate::error::Error;
use crate::near::near;
use crate::options::{Contact, Operation, Params, Slivers};
use crate::seam::Seam;
use crate::{check, cut, pinch, seam, tidy};
use glam::DVec3;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, Faces, HalfedgeId, Origins, Positions, Stopwatch, TriMesh, Watch,
};
use mesh_query::TriBvh;
use rayon::prelude::*;
use std::sync::LazyLock;

/// The result of a boolean.
#[derive(Clone, Debug)]
pub struct Boolean {
    /// A closed, oriented 2-manifold. Vertices and faces of a first, then of b, then new ones.
    pub mesh: TriMesh,
    /// Where everything came from: part 0 is a, part 1 is b.
    pub origins: Origins,
    /// The closed curves in which the surfaces meet, as far as they are on the result.
    pub seams: Vec<Seam>,
    /// What was done and how long it took.
    pub report: Report,
}

/// What a boolean did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Pairs of faces whose boxes overlap.
    pub candidate_pairs: usize,
    /// Pairs of faces that meet in a segment or an area.
    pub crossing_pairs: usize,
    /// Faces of a and of b that were cut or lie along the seam.
    pub cut_faces: [usize; 2],
    /// New vertices.
    pub new_vertices: usize,
    /// Stages in order, with milliseconds.
    pub stages: Vec<(&'static str, f64)>,
    /// What the caller may want to know.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// Adds what a later step did.
    pub(crate) fn append(&mut self, step: Self) {
        self.candidate_pairs += step.candidate_pairs;
        self.crossing_pairs += step.crossing_pairs;
        self.cut_faces = [0, 1].map(|w| self.cut_faces[w] + step.cut_faces[w]);
        self.new_vertices += step.new_vertices;
        self.stages.extend(step.stages);
        self.warnings.extend(step.warnings);
    }
}

/// Something unusual that was dealt with.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// Faces of the two parts lie in one plane and overlap.
    Coplanar {
        /// Pairs of such faces.
        pairs: usize,
        /// One of the places.
        at: DVec3,
    },
    /// The parts touch along edges or at vertices; the sheets got their own vertices there.
    Contact {
        /// Vertices that were duplicated.
        vertices: usize,
        /// One of the places.
        at: DVec3,
    },
    /// Points that 64-bit coordinates could not keep apart were merged.
    Merged {
        /// How many.
        points: usize,
        /// One of the places.
        at: DVec3,
    },
    /// Short edges along the seam were collapsed.
    Collapsed {
        /// How many.
        edges: usize,
    },
}

/// Joins, subtracts or intersects two solids.
///
/// Crossings are decided by exact predicates on the input points, with explicit cases for coplanar and touching faces;
/// only crossed faces are cut, everything else keeps its bits. Costs O(n log n) for the trees and the flood over whole
/// faces, and beyond that time in proportion to the seam. The same input gives the same bits on any number of threads.
///
/// # Errors
/// See [`Error`]. Nothing left is [`Error::Empty`], not an empty mesh.
pub fn boolean(
    a: &Connected<TriMesh>,
    b: &Connected<TriMesh>,
    operation: Operation,
    params: &Params,
    watch: &Watch,
) -> Result<Boolean, Error> {
    let mut clock = Clock { stopwatch: Stopwatch::start(), report: Report::default() };
    let parts = arrange::parts(a, b)?;
    let bounds = check_solid(&parts)?;
    clock.lap("check");
    let near = near(a.mesh(), b.mesh(), bounds);
    clock.lap("pairs");
    let crossings = arrange::crossings(&parts, &near.pairs, watch)?;
    if let Some(error) = crossings.degenerate_error(&parts) {
        return Err(error);
    }
    clock.lap("crossings");
    let arrangement = Arrangement::new(&parts, &crossings);
    clock.lap("arrangement");
    let mut snaps = Snaps::new(&arrangement);
    let mut pieces = cut::cut(&parts, &arrangement, &mut snaps)?;
    watch.step("cut", 1.0)?;
    clock.lap("cut");
    let seams = SeamTable::new(&arrangement, &snaps);
    let flood = |which| Flood { parts: &parts, arrangement: &arrangement, seams: &seams, which };
    let [pa, pb] = &mut pieces;
    // Whole trees are needed only for components that no seam passes.
    let trees = [a, b].map(|m| LazyLock::new(move || TriBvh::build(m.mesh()).ok()));
    let (ca, cb) = rayon::join(
        || flood(0).run(pa, bounds[1], || trees[1].as_ref()),
        || flood(1).run(pb, bounds[0], || trees[0].as_ref()),
    );
    // Where points were snapped, disagreement is rounding's fault and not the part's.
    let blame = |e: Error| match e {
        Error::Tangled { at, .. } if snaps.count > 0 => Error::Rounding { at },
        e => e,
    };
    let classes = [ca.map_err(blame)?, cb.map_err(blame)?];
    watch.step("classify", 1.0)?;
    clock.lap("classify");
    let mut result = assemble(&parts, &arrangement, &snaps, &pieces, &classes, operation);
    if result.mesh.faces.is_empty() {
        return Err(Error::Empty(match operation {
            Operation::Difference => "part 1 covers part 0",
            _ => "the parts do not overlap",
        }));
    }
    clock.lap("assemble");
    let checked = |result: &Assembly| check::check(result, &arrangement, &parts, &pieces, &near.faces);
    let mut fault = checked(&result).err();
    watch.step("check", 1.0)?;
    clock.lap("validate");
    if let Slivers::Collapse { tolerance } = params.slivers
        && (fault.is_some() || !arrangement.degenerate)
    {
        let length = tolerance * bounds[0].union(bounds[1]).diagonal();
        let short = tidy::short_edges(&result, arrangement.counts[0] + arrangement.counts[1], length);
        if !short.is_empty() {
            let before = result.clone();
            let edges = tidy::collapse(&mut result, &arrangement, &parts, &short, length);
            // Better a short edge than an intersection; but slivers that rounding folded meet until they are gone.
            if checked(&result).is_err() {
                result = before;
            } else if edges > 0 {
                fault = None;
                clock.report.warnings.push(Warning::Collapsed { edges });
            }
        }
        clock.lap("slivers");
    }
    if let Some(fault) = fault {
        return Err(fault);
    }
    if arrangement.degenerate || snaps.count > 0 {
        let first = arrangement.counts[0] + arrangement.counts[1];
        let mut suspect = vec![false; result.nodes.len()];
        for n in arrangement.segments.iter().flat_map(|s| s.ends).chain(first..first + arrangement.places.len() as u32)
        {
            let v = result.vertices[snaps.find(n) as usize];
            if v != u32::MAX {
                suspect[v as usize] = true;
            }
        }
        let copies = pinch::split(&mut result, &suspect);
        if let Some(&v) = copies.first() {
            clock.contact(params, result.mesh.positions[v.index()], copies.len())?;
        }
        // Snapping can pinch in ways that no predicate foresees.
        if let Err(e) = Connected::new(&result.mesh) {
            let at = e.place.unwrap_or(DVec3::ZERO);
            return Err(if snaps.count > 0 { Error::Rounding { at } } else { Error::Contact { at } });
        }
        clock.lap("contacts");
    }
    // Lone points of contact count if both faces are still there.
    let stays = |w: usize, f: u32| match classes[w][f as usize] {
        CUT => result.pieces_of_face(w, f),
        _ => result.whole[w].binary_search(&f).is_ok(),
    };
    let touches: Vec<DVec3> =
        arrangement.touches.iter().filter(|t| stays(0, t.0[0]) && stays(1, t.0[1])).map(|t| t.1).collect();
    if let Some(&at) = touches.first() {
        clock.contact(params, at, 0)?;
    }
    let seams = seam::chain(&seam::seam_edges(&result.pieces_of(0), &result.pieces_of(1)));
    if let Some(open) = seams.iter().find(|s| !s.closed) {
        return Err(Error::Tangled { part: 0, at: result.mesh.positions[open.vertices[0].index()] });
    }
    clock.lap("seams");

    let report = &mut clock.report;
    report.candidate_pairs = near.pairs.len();
    report.crossing_pairs = crossings.segments.len();
    report.cut_faces = [0, 1].map(|w| pieces[w].faces.len());
    report.new_vertices = result.nodes.iter().filter(|&&n| n >= arrangement.counts[0] + arrangement.counts[1]).count();
    if let Some(cell) = arrangement.cells.first() {
        let at = arrangement.position(&parts, cell.corners[0]);
        report.warnings.push(Warning::Coplanar { pairs: arrangement.cells.len(), at });
    }
    if let Some(node) = snaps.example {
        report.warnings.push(Warning::Merged { points: snaps.count, at: arrangement.position(&parts, node) });
    }
    Ok(Boolean { mesh: result.mesh, origins: result.origins, seams, report: clock.report })
}

/// Notes how long each stage took.
struct Clock {
    stopwatch: Stopwatch,
    report: Report,
}

impl Clock {
    fn lap(&mut self, stage: &'static str) {
        self.report.stages.push((stage, self.stopwatch.lap().as_secs_f64() * 1e3));
    }

    /// Refuses or notes a place where sheets touch.
    fn contact(&mut self, params: &Params, at: DVec3, vertices: usize) -> Result<(), Error> {
        if params.contact == Contact::Refuse {
            return Err(Error::Contact { at });
        }
        self.report.warnings.push(Warning::Contact { vertices, at });
        Ok(())
    }
}

/// Closed, and with the normals outward. Returns the boxes.
fn check_solid(parts: &[Part; 2]) -> Result<[Bounds; 2], Error> {
    let mut bounds = [Bounds::EMPTY; 2];
    for (part, Part { mesh, .. }) in parts.iter().enumerate() {
        let part = part as u32;
        let points = &mesh.mesh().positions;
        let origin = mesh.mesh().faces.first().map_or(DVec3::ZERO, |c| points[c[0].index()]);
        let chunks: Vec<(f64, Option<u32>, Bounds)> = mesh
            .mesh()
            .faces
            .par_chunks(1 << 14)
            .enumerate()
            .map(|(i, faces)| {
                let mut volume = 0.0;
                let mut border = None;
                let mut bounds = Bounds::EMPTY;
                for (j, c) in faces.iter().enumerate() {
                    let corners = c.map(|v| points[v.index()]);
                    bounds = bounds.union(Bounds::of(corners));
                    let [p, q, r] = corners.map(|p| p - origin);
                    volume += p.dot(q.cross(r));
                    let f = FaceId(((i << 14) + j) as u32);
                    border = border.or(f.halfedges().into_iter().find(|&h| mesh.twin(h).is_none()));
                }
                (volume, border.map(|h| h.0), bounds)
            })
            .collect();
        if let Some(h) = chunks.iter().find_map(|c| c.1) {
            return Err(Error::Open { part, at: mesh.position(mesh.tail(HalfedgeId(h))) });
        }
        let volume = chunks.iter().map(|c| c.0).sum::<f64>() / 6.0;
        if volume < 0.0 {
            return Err(Error::InsideOut { part, volume });
        }
        bounds[part as usize] = chunks.iter().fold(Bounds::EMPTY, |b, c| b.union(c.2));
    }
    Ok(bounds)
}
