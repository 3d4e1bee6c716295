//! The swept surface as triangles: profiles across, cells between neighbouring profiles, sewn to the linkages' vertices.

use crate::linkage::Linkage;
use crate::profiles::Profiles;
use crate::stretch::{Ending, Stretch};
use glam::DVec3;
use mesh_core::{VertexId, centroid};
use profile_nurbs::Section;
use spine::{Convexity, Sample};

/// How finely the sweep is tessellated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fineness {
    /// Largest sagitta of a profile's chords, as a share of the ball's radius.
    pub tolerance: f64,
    /// Wanted chord length across, in model units.
    pub chord: f64,
    /// Where the profile's apex is moved; see [`super::Params::reach`].
    pub reach: Option<f64>,
    /// Shares of the radius on the left and on the right side.
    pub sides: [f64; 2],
}

/// Triangles to be put in.
#[derive(Default)]
pub(crate) struct Piece {
    /// Corners; ids from the piece's `first_new` on are its own vertices.
    pub faces: Vec<[VertexId; 3]>,
    /// Its own vertices in id order.
    pub points: Vec<DVec3>,
}

/// Triangles of one strip, and where they face the wrong way.
pub(crate) struct Strip {
    pub piece: Piece,
    /// Middles of the triangles that turn their backs to where the profile's front is: the sweep folds there.
    pub folds: Vec<DVec3>,
    /// The first and the last profile, from the left linkage to the right one.
    pub ends: [Vec<VertexId>; 2],
}

/// Profiles as vertices, from the left linkage to the right one, one after the other.
#[derive(Default)]
struct Columns {
    vertices: Vec<VertexId>,
    ends: Vec<usize>,
}

impl Columns {
    fn get(&self, i: usize) -> &[VertexId] {
        &self.vertices[if i == 0 { 0 } else { self.ends[i - 1] }..self.ends[i]]
    }
}

/// Sweeps `profiles` along a stretch. `linkages` and `stops` hold the vertices around it, `position` places them.
pub(crate) fn sweep(
    stretch: &Stretch,
    linkages: &[Linkage; 2],
    stops: &[Vec<VertexId>; 2],
    profiles: &Profiles,
    fineness: Fineness,
    first_new: u32,
    position: impl Fn(VertexId) -> DVec3,
) -> Strip {
    let mut strip = Strip { piece: Piece::default(), folds: Vec::new(), ends: [Vec::new(), Vec::new()] };
    let (mut row, mut columns) = (Vec::new(), Columns::default());
    let n = stretch.stations();
    for i in 0..n {
        match stretch.station(i) {
            Ok(ball) => {
                let feet = [0, 1].map(|side| linkages[side].foot(i));
                profile_points(profiles, ball, feet.map(&position), fineness, &mut row);
                columns.vertices.push(feet[0]);
                let first = first_new + strip.piece.points.len() as u32;
                let inner = row.len() - 2;
                columns.vertices.extend((0..inner as u32).map(|k| VertexId(first + k)));
                columns.vertices.push(feet[1]);
                strip.piece.points.extend_from_slice(&row[1..=inner]);
            }
            Err(Ending::Stop(_)) => columns.vertices.extend_from_slice(&stops[usize::from(i > 0)]),
            Err(_) => columns.vertices.push(linkages[0].foot(i)),
        }
        columns.ends.push(columns.vertices.len());
    }
    let last = n - 1;
    strip.ends = [0, last].map(|i| columns.get(i).to_vec());
    for i in 0..if stretch.rail.closed { n } else { last } {
        let next = (i + 1) % n;
        let balls = [i, next].map(|k| stretch.station(k).ok());
        let centers = [balls[0].or(balls[1]), balls[1].or(balls[0])].map(|b| b.map_or(DVec3::ZERO, |b| b.center));
        let front = Front { center: centers[0].midpoint(centers[1]), convexity: stretch.rail.convexity };
        let position = |v: VertexId| {
            if v.0 >= first_new { strip.piece.points[(v.0 - first_new) as usize] } else { position(v) }
        };
        let columns = [columns.get(i), columns.get(next)];
        // Profiles are divided evenly; where a strip stops, the edges of the surface there divide the last one anyhow.
        let stops = [i, next].iter().any(|&k| matches!(stretch.station(k), Err(Ending::Stop(_))));
        let cell = Cell {
            columns,
            lengths: stops.then(|| columns.map(|c| shares(c, position))),
            spans: [0, 1].map(|s| linkages[s].span(i)),
            at: position,
            front,
        };
        let before = strip.piece.faces.len();
        cell.triangulate(&mut strip.piece.faces);
        for face in &strip.piece.faces[before..] {
            let corners = face.map(&cell.at);
            if !front.shows(corners) {
                strip.folds.push(centroid(corners));
            }
        }
    }
    strip
}

/// Share of a chain's length up to each of its vertices.
fn shares(chain: &[VertexId], position: impl Fn(VertexId) -> DVec3) -> Vec<f64> {
    let mut length = 0.0;
    let along = chain.windows(2).map(|w| {
        length += position(w[0]).distance(position(w[1]));
        length
    });
    let at: Vec<f64> = std::iter::once(0.0).chain(along).collect();
    at.iter().map(|s| s / at[at.len() - 1].max(f64::MIN_POSITIVE)).collect()
}

/// Points of one profile, feet included.
pub(crate) fn profile_points(
    profiles: &Profiles,
    ball: &Sample,
    feet: [DVec3; 2],
    fineness: Fineness,
    row: &mut Vec<DVec3>,
) {
    row.clear();
    let section = section(ball, feet, fineness.sides);
    let section = fineness.reach.map_or(section, |reach| section.with_reach(ball.center, reach));
    let bend = (feet[0] - ball.center).angle_between(feet[1] - ball.center);
    // Chords of an arc of angle δ stand off by r·(1 − cos(δ/2)).
    let widest = 2.0 * (1.0 - fineness.tolerance.clamp(1e-9, 0.5)).acos();
    // Two at least, so that a profile next to a tip has a side for each linkage.
    let count = (bend / widest).ceil().max((bend * ball.radius / fineness.chord).round()).clamp(2.0, 4096.0);
    profiles.points(ball.center, &section, count as usize, row);
}

/// The control triangle of the profile in the plane of ball centre and feet.
///
/// P0 is where the lines through the feet square to their radii meet; for fair feet, whose distances d1, d2 from the
/// centre differ a little, that is centre + α·e1 + β·e2 with α = d̄/(1+c) + Δ/(1−c), β = d̄/(1+c) − Δ/(1−c). In shallow
/// wedges the difference Δ would throw it beyond the feet; there it is held back, at the cost of a small kink at the
/// linkage. What two radii in the ratio of `sides` differ by is no such error.
pub(crate) fn section(ball: &Sample, [p1, p2]: [DVec3; 2], sides: [f64; 2]) -> Section {
    let center = ball.center;
    let (r1, r2) = (p1 - center, p2 - center);
    let (d1, d2) = (r1.length(), r2.length());
    let (e1, e2) = (r1 / d1, r2 / d2);
    let c = e1.dot(e2);
    let mean = 0.5 * (d1 + d2) / (1.0 + c).max(1e-9);
    // At `mean` itself P0 would reach a foot, and beyond it the tangent length there would be negative.
    let meant = 0.5 * (d1 + d2) * (sides[0] - sides[1]) / (sides[0] + sides[1]) / (1.0 - c).max(1e-300);
    let meant = meant.clamp(-0.98 * mean, 0.98 * mean);
    let most = 0.5 * (mean - meant.abs());
    let skew = (0.5 * (d1 - d2) / (1.0 - c).max(1e-300)).clamp(meant - most, meant + most);
    let p0 = center + (mean + skew) * e1 + (mean - skew) * e2;
    Section { p1, p0, p2, bends: ball.bends }
}

/// Which way the surface between two profiles faces: to the ball in a valley, away from it on a ridge.
#[derive(Clone, Copy)]
struct Front {
    center: DVec3,
    convexity: Convexity,
}

impl Front {
    fn shows(&self, [a, b, c]: [DVec3; 3]) -> bool {
        let towards = (b - a).cross(c - a).dot(self.center - (a + b + c) / 3.0);
        match self.convexity {
            Convexity::Concave => towards > 0.0,
            Convexity::Convex => towards < 0.0,
        }
    }
}

/// The quadrilateral between two neighbouring profiles; a triangle where one of them is a point.
struct Cell<'a, P> {
    /// Vertices of each profile from the left linkage to the right one.
    columns: [&'a [VertexId]; 2],
    /// Share of each profile's length up to its vertices, where they are not evenly spaced.
    lengths: Option<[Vec<f64>; 2]>,
    /// Vertices of each linkage from this profile's foot to the next one's, both included.
    spans: [&'a [VertexId]; 2],
    at: P,
    front: Front,
}

impl<P: Fn(VertexId) -> DVec3> Cell<'_, P> {
    /// Zips the two columns together by their parameters, the linkages' own vertices fanned in at both ends.
    fn triangulate(&self, faces: &mut Vec<[VertexId; 3]>) {
        let [left, right] = self.columns;
        let last = [left.len() - 1, right.len() - 1];
        let (mut i, mut j) = (0, 0);
        while i < last[0] || j < last[1] {
            let (l, r) = (left[i], right[j]);
            let first = i == 0 && j == 0;
            let take_left = j == last[1] || (i < last[0] && self.left_first([i, j], last));
            let apex = if take_left {
                i += 1;
                left[i]
            } else {
                j += 1;
                right[j]
            };
            if first {
                // Seen from the strip, the left linkage runs backwards.
                let backwards: Vec<_> = self.spans[0].iter().rev().copied().collect();
                self.fan(backwards, apex, faces);
            } else if i == last[0] && j == last[1] {
                self.fan(self.spans[1].to_vec(), if take_left { l } else { r }, faces);
            } else {
                faces.push([r, l, apex]);
            }
        }
    }

    /// Joins a stretch of linkage to an apex. A path over facets can zigzag where it passes close by a vertex, so that
    /// a plain fan would fold; there the pockets of the zigzag are filled first.
    fn fan(&self, mut chain: Vec<VertexId>, apex: VertexId, faces: &mut Vec<[VertexId; 3]>) {
        let shows = |corners: [VertexId; 3]| self.front.shows(corners.map(&self.at));
        while let Some(back) = chain.windows(2).position(|w| !shows([w[0], w[1], apex])) {
            let pocket = [back, back + 1]
                .into_iter()
                .find(|&k| k > 0 && k + 1 < chain.len() && shows([chain[k - 1], chain[k], chain[k + 1]]));
            let Some(k) = pocket else { break };
            faces.push([chain[k - 1], chain[k], chain[k + 1]]);
            chain.remove(k);
        }
        faces.extend(chain.windows(2).map(|w| [w[0], w[1], apex]));
    }

    /// Which column to climb: the one that lags behind, or on a tie the one with the shorter diagonal.
    fn left_first(&self, [i, j]: [usize; 2], last: [usize; 2]) -> bool {
        if let Some([left, right]) = &self.lengths {
            return left[i + 1] + left[i] <= right[j + 1] + right[j];
        }
        let (left, right) = ((i + 1) * last[1], (j + 1) * last[0]);
        if left != right {
            return left < right;
        }
        let p = |column: usize, k: usize| (self.at)(self.columns[column][k]);
        p(0, i + 1).distance_squared(p(1, j)) <= p(1, j + 1).distance_squared(p(0, i))
    }
}
