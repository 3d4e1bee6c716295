//! One watertight mesh of patches, strips and planar faces: every curve they share is sampled once.

use crate::error::Error;
use crate::hartmann::Strip;
use crate::layout::Layout;
use crate::patch::Patch;
use crate::planar::triangulate;
use crate::polyhedron::Polyhedron;
use crate::rings::{Segment, Sheet, cover};
use crate::sample::shares;
use glam::DVec3;
use mesh_core::{TriMesh, VertexId, Watch};
use rayon::prelude::*;

/// What a triangle belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The patch of a cluster.
    Patch(u32),
    /// A strip along an open edge.
    Strip(u32),
    /// A planar face of the polyhedron.
    Face(u32),
}

/// Where a vertex stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// On a vertex of the polyhedron, bit for bit.
    Vertex(u32),
    /// On an edge of the polyhedron, at the end of a patch.
    Edge(u32),
    /// On the boundary between blend and planar faces.
    Face(u32),
    /// Inside a blend.
    Blend,
}

/// A blended polyhedron.
#[derive(Clone, Debug, Default)]
pub struct Woven {
    /// The mesh; planar faces first, then patches, then strips.
    pub mesh: TriMesh,
    /// What each triangle belongs to.
    pub parts: Vec<Part>,
    /// Where each vertex stands.
    pub places: Vec<Place>,
    /// For each planar face whose blends meet, where.
    pub crowded: Vec<(u32, DVec3)>,
}

/// Meshes a layout to chords within `tolerance`, in model units. If blends meet within planar faces, only
/// [`Woven::crowded`] is filled.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn weave(solid: &Polyhedron, layout: &Layout, tolerance: f64, watch: &Watch) -> Result<Woven, Error> {
    let mut loom = Loom { solid, layout, tolerance, woven: Woven::default(), curves: Curves::default() };
    loom.lay_curves();
    watch.step("faces", 0.3)?;
    let positions = &loom.woven.mesh.positions;
    let flat = |f: usize| {
        let face = &solid.faces[f];
        let loops: Vec<Vec<VertexId>> = face.loops.iter().map(|&h| loom.outline(h)).collect();
        triangulate(face.plane, &loops, positions)
    };
    let flats: Vec<_> = (0..solid.faces.len()).into_par_iter().map(flat).collect();
    let crowded = flats.iter().enumerate().filter_map(|(f, r)| Some((f as u32, *r.as_ref().err()?)));
    let crowded: Vec<_> = crowded.collect();
    if !crowded.is_empty() {
        return Ok(Woven { crowded, ..Woven::default() });
    }
    watch.step("patches", 0.5)?;
    let sheets: Vec<Sheet> = (0..layout.patches.len())
        .into_par_iter()
        .map(|c| cover(&layout.patches[c], &loom.border(c), tolerance, FRESH))
        .collect();
    let grids: Vec<Sheet> = (0..layout.strips.len()).into_par_iter().map(|s| loom.grid(s)).collect();
    let mut woven = loom.woven;
    for (f, faces) in (0..).zip(flats.into_iter().flatten()) {
        woven.add(faces, Part::Face(f));
    }
    // Sheets were numbered as if each were alone: ids from FRESH on are their own points.
    for (parts, sheets) in [(Part::Patch as fn(u32) -> Part, sheets), (Part::Strip as fn(u32) -> Part, grids)] {
        for (i, sheet) in (0..).zip(sheets) {
            let start = woven.mesh.positions.len() as u32;
            woven.places.resize(start as usize + sheet.points.len(), Place::Blend);
            woven.mesh.positions.extend(sheet.points);
            let renumber = |v: VertexId| if v.0 >= FRESH { VertexId(v.0 - FRESH + start) } else { v };
            woven.add(sheet.faces.into_iter().map(|t| t.map(renumber)).collect(), parts(i));
        }
    }
    Ok(woven)
}

/// Ids of points that a sheet has for itself, before they are renumbered.
pub(crate) const FRESH: u32 = 1 << 31;

impl Woven {
    fn add(&mut self, faces: Vec<[VertexId; 3]>, part: Part) {
        self.parts.resize(self.parts.len() + faces.len(), part);
        self.mesh.faces.extend(faces);
    }

    fn vertex(&mut self, at: DVec3, place: Place) -> VertexId {
        self.mesh.positions.push(at);
        self.places.push(place);
        VertexId(self.mesh.positions.len() as u32 - 1)
    }
}

/// A row of vertices at shares of a curve.
type Row = (Vec<f64>, Vec<VertexId>);

/// The points of a row before they are numbered, and their shares.
type Drawn = (Vec<DVec3>, Vec<f64>);

struct DrawnStrip {
    across: [Drawn; 2],
    along: [Drawn; 2],
}

fn draw_strip(strip: &Strip, patches: &[Patch], tolerance: f64) -> DrawnStrip {
    let along_t = |s: f64| move |at: &[f64]| strip.points(patches, &at.iter().map(|&t| [s, t]).collect::<Vec<_>>());
    let across = |t: f64| move |at: &[f64]| strip.points(patches, &at.iter().map(|&s| [s, t]).collect::<Vec<_>>());
    let side = |left: usize| move |at: &[f64]| at.iter().map(|&t| strip.side(patches, left, t)).collect::<Vec<_>>();
    let cut = shares(&[&across(0.0), &across(0.5), &across(1.0)], 0.5 * tolerance, 4);
    let ends = [0.0, 1.0].map(|t| (across(t)(&cut), cut.clone()));
    let cut = shares(&[&side(0), &side(1), &along_t(0.5)], 0.5 * tolerance, 4);
    DrawnStrip { across: ends, along: [0, 1].map(|left| (side(left)(&cut), cut.clone())) }
}

#[derive(Default)]
struct Curves {
    /// The vertex of the polyhedron itself, where it is kept.
    kept: Vec<Option<VertexId>>,
    /// For each patch and side, from corner k to corner k + 1.
    sides: Vec<Vec<Row>>,
    /// For each strip, the cuts across the first and second patch, from s = 0 to 1.
    across: Vec<[Row; 2]>,
    /// For each strip, its sides to the right and left, from t = 0 to 1.
    along: Vec<[Row; 2]>,
}

struct Loom<'a> {
    solid: &'a Polyhedron,
    layout: &'a Layout,
    tolerance: f64,
    woven: Woven,
    curves: Curves,
}

impl Loom<'_> {
    /// Every vertex that two sheets share.
    fn lay_curves(&mut self) {
        let Self { solid, layout, .. } = *self;
        let mut kept = vec![None; solid.positions.len()];
        for v in solid.vertices().filter(|&v| layout.cluster_of[v as usize].is_none()) {
            kept[v as usize] = Some(self.woven.vertex(solid.positions[v as usize], Place::Vertex(v)));
        }
        self.curves.kept = kept;
        // Corners first: the tips of patches, or where strips begin.
        let mut ends: Vec<Vec<[VertexId; 2]>> = vec![];
        for (c, cluster) in layout.clusters.iter().enumerate() {
            let m = cluster.sides();
            // For corner k: the end of side k − 1, and the beginning of side k.
            let corner = |k: usize, woven: &mut Woven| {
                let patch = &layout.patches[c];
                let h = cluster.open[k];
                if layout.strip_at[c][k].is_none() {
                    return [woven.vertex(layout.tip(c, k), Place::Edge(h)); 2];
                }
                let (before, after) = (layout.side_range(c, k + m - 1)[1], layout.side_range(c, k)[0]);
                let right = solid.halfedges[solid.halfedges[h as usize].twin as usize].face;
                let left = solid.halfedges[h as usize].face;
                [
                    woven.vertex(patch.border(k + m - 1, before), Place::Face(right)),
                    woven.vertex(patch.border(k, after), Place::Face(left)),
                ]
            };
            ends.push((0..m).map(|k| corner(k, &mut self.woven)).collect());
        }
        let patches = &layout.patches;
        let draw_side = |c: usize, k: usize| {
            let [low, high] = layout.side_range(c, k);
            let curve = |at: &[f64]| at.iter().map(|x| patches[c].border(k, low + x * (high - low))).collect();
            let cut = shares(&[&curve], self.tolerance, 4);
            (curve(&cut), cut)
        };
        let draw_sides = |c: usize| (0..layout.clusters[c].sides()).map(|k| draw_side(c, k)).collect();
        let drawn: Vec<Vec<Drawn>> = (0..patches.len()).into_par_iter().map(draw_sides).collect();
        let drawn_strips: Vec<_> = layout.strips.par_iter().map(|s| draw_strip(s, patches, self.tolerance)).collect();
        for ((cluster, ends), sides) in layout.clusters.iter().zip(&ends).zip(drawn) {
            let m = cluster.sides();
            let number = |(k, side): (usize, Drawn)| {
                let place = Place::Face(solid.halfedges[cluster.open[k] as usize].face);
                self.number(side, [ends[k][1], ends[(k + 1) % m][0]], place)
            };
            let sides = sides.into_iter().enumerate().map(number).collect();
            self.curves.sides.push(sides);
        }
        for (strip, drawn) in layout.strips.iter().zip(drawn_strips) {
            let at = |end: usize| ends[strip.ends[end].0][strip.ends[end].1];
            // Right and left seen along the edge from the first patch to the second.
            let [first, second] = [at(0), [at(1)[1], at(1)[0]]];
            let [start, end] = drawn.across;
            let rows = [(start, first), (end, second)].map(|(row, ends)| self.number(row, ends, Place::Blend));
            self.curves.across.push(rows);
            let h = layout.clusters[strip.ends[0].0].open[strip.ends[0].1];
            let [left, right] = [h, solid.halfedges[h as usize].twin].map(|h| solid.halfedges[h as usize].face);
            let [on_right, on_left] = drawn.along;
            let rows = [(0, on_right, right), (1, on_left, left)]
                .map(|(i, row, face)| self.number(row, [first[i], second[i]], Place::Face(face)));
            self.curves.along.push(rows);
        }
    }

    fn number(&mut self, (points, shares): Drawn, ends: [VertexId; 2], place: Place) -> Row {
        let last = points.len() - 1;
        let vertex = |(i, point)| match i {
            0 => ends[0],
            _ if i == last => ends[1],
            _ => self.woven.vertex(point, place),
        };
        (shares, points.into_iter().enumerate().map(vertex).collect())
    }

    /// The boundary of a planar face, beginning at a halfedge of one of its loops.
    fn outline(&self, start: u32) -> Vec<VertexId> {
        let Self { solid, layout, curves, .. } = self;
        let mut line = vec![];
        for h in solid.loop_from(start) {
            let half = solid.halfedges[h as usize];
            let (near, far) = (layout.corner_of[h as usize], layout.corner_of[half.twin as usize]);
            line.extend(curves.kept[half.tail as usize]);
            if let Some((s, end)) = near.and_then(|(c, k)| layout.strip_at[c][k]) {
                // The face is to the left of h: to the left of the strip if h runs with it, else to its right.
                let along = &curves.along[s][1 - end].1;
                let inner = &along[1..along.len() - 1];
                if end == 0 { line.extend(inner) } else { line.extend(inner.iter().rev()) }
            }
            if let Some((c, l)) = far {
                // Around the cluster ahead, against its sense.
                let m = layout.clusters[c].sides();
                line.extend(curves.sides[c][(l + m - 1) % m].1.iter().rev());
            }
        }
        line
    }

    /// The boundary of a patch's domain, corner by corner.
    fn border(&self, c: usize) -> Vec<Segment> {
        let Self { layout, curves, .. } = self;
        let (patch, m) = (&layout.patches[c], layout.clusters[c].sides());
        let mut border = vec![];
        for k in 0..m {
            let [low, high] = layout.side_range(c, k);
            if let Some((s, end)) = layout.strip_at[c][k] {
                let before = layout.side_range(c, k + m - 1)[1];
                let (mut shares, mut vertices) = curves.across[s][end].clone();
                if end == 1 {
                    shares = shares.iter().rev().map(|x| 1.0 - x).collect();
                    vertices.reverse();
                }
                border.push(Segment { ends: [patch.side(k + m - 1, before), patch.side(k, low)], shares, vertices });
            }
            let (shares, vertices) = curves.sides[c][k].clone();
            border.push(Segment { ends: [patch.side(k, low), patch.side(k, high)], shares, vertices });
        }
        border
    }

    /// The inside of a strip.
    fn grid(&self, s: usize) -> Sheet {
        let (strip, patches) = (&self.layout.strips[s], &self.layout.patches);
        let ([start, end], [right, left]) = (&self.curves.across[s], &self.curves.along[s]);
        let (columns, rows) = (start.0.len(), right.0.len());
        let inner = |t: f64| start.0[1..columns - 1].iter().map(move |&s| [s, t]);
        let points = strip.points(patches, &right.0[1..rows - 1].iter().flat_map(|&t| inner(t)).collect::<Vec<_>>());
        let vertex = |row: usize, column: usize| {
            if row == 0 {
                start.1[column]
            } else if row == rows - 1 {
                end.1[column]
            } else if column == 0 {
                right.1[row]
            } else if column == columns - 1 {
                left.1[row]
            } else {
                VertexId(FRESH + ((row - 1) * (columns - 2) + column - 1) as u32)
            }
        };
        let mut faces = vec![];
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                // Counter-clockwise with s running from right to left and t ahead; diagonals mirror at the middle.
                let [a, b] = [vertex(row, column), vertex(row, column + 1)];
                let [c, d] = [vertex(row + 1, column), vertex(row + 1, column + 1)];
                if (2 * column + 1 < columns - 1) == (2 * row + 1 < rows - 1) {
                    faces.extend([[a, c, d], [a, d, b]]);
                } else {
                    faces.extend([[a, c, b], [b, c, d]]);
                }
            }
        }
        Sheet { points, faces }
    }
}
