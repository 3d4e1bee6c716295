//! Unstructured propagation: vertex by vertex, each taking the detail of the source vertex whose fan looks most alike (\[Lin2008\] §4.2).

use crate::coherence::Place;
use crate::error::Error;
use crate::fan::{Fan, NUMBERS, SAMPLES, fans};
use crate::library::{Library, Match, Query};
use crate::relief::{Detail, Relief};
use glam::DVec3;
use mesh_core::{Adjacency, Faces, VertexId, Watch};
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// How the most similar fan is searched for. Both find the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Search {
    /// By a tree over the sources' fans.
    #[default]
    Indexed,
    /// By looking at every fan.
    Exhaustive,
}

/// The source vertex that one target vertex took its detail from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// The vertex filled, by its number in the target's patch.
    pub vertex: VertexId,
    /// Which source, and the vertex by its number in that source's patch.
    pub source: (usize, VertexId),
    /// The angle from the target's frame to the source's, in radians.
    pub turn: f64,
    /// Found by search; others go on beside what a neighbour copied.
    pub jump: bool,
    /// Root mean square difference of the two fans' known samples, as a share of the sources' root mean square signal.
    pub distance: f64,
    /// Known samples, of 24.
    pub known: u32,
}

/// What a fill found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filled {
    /// The choices, in the order in which vertices were filled.
    pub choices: Vec<Choice>,
}

/// Fans of a source's region that lie on its patch in whole, with signals.
struct Exemplars {
    fans: Vec<[f32; NUMBERS]>,
    /// Source and vertex.
    names: Vec<(usize, u32)>,
    /// What a signal is divided by.
    scale: f64,
    /// Each source vertex's place in the library, or none; by source.
    entries: Vec<Vec<u32>>,
}

const NONE: u32 = u32::MAX;

/// A vertex copies on beside its neighbours for as long as no fan is so many times more like. At 1 each goes its own way, and the bends of different places
/// do not make a surface; beyond 8 hardly any leaves.
const PATIENCE: f32 = 4.0;

/// Gives detail to the vertices of `target` where `details` has none, from the sources' regions; `excluded` are vertices of each source's patch
/// whose detail is not to be used.
///
/// Vertices are filled in the order of how much of their fans is known, ties by number. Where a neighbour was filled before, the source vertex beside its own, as far
/// and turned as on the target, is taken unless another is four times more like (\[Ashikhmin2001\]'s coherence). The signal that fans are compared by is the
/// bend plus the offset over the squared anchor length. About O(n log m) for n vertices to fill and m of the sources where detail
/// resembles itself, towards O(n·m) where nothing resembles anything.
///
/// # Errors
/// [`Error::SourceTooSmall`], [`Error::Length`], [`Error::Cancelled`].
pub fn fill_unstructured(
    target: &Relief,
    details: &mut [Option<Detail>],
    sources: &[(&Relief, Vec<bool>)],
    length: f64,
    search: Search,
    watch: &Watch,
) -> Result<Filled, Error> {
    match search {
        Search::Exhaustive => fill_with(target, details, sources, length, watch, Library::exhaustive),
        Search::Indexed => fill_with(target, details, sources, length, watch, Library::search),
    }
}

fn fill_with(
    target: &Relief,
    details: &mut [Option<Detail>],
    sources: &[(&Relief, Vec<bool>)],
    length: f64,
    watch: &Watch,
    search: impl Fn(&Library, &Query, f32) -> Option<Match>,
) -> Result<Filled, Error> {
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Length { name: "fan length", value: length });
    }
    let missing: Vec<u32> = (0..details.len() as u32).filter(|&v| details[v as usize].is_none()).collect();
    if missing.is_empty() {
        return Ok(Filled::default());
    }
    watch.step("fans", 0.0)?;
    let exemplars = exemplars(target, sources, length)?;
    let library = Library::new(&exemplars.fans);
    watch.step("fans", 0.5)?;
    let mut front = Front::new(target, details, &missing, fans(target, &missing, length), exemplars.scale);
    let mut filled = Filled::default();
    let mut taken: Vec<Option<Place>> = vec![None; details.len()];
    while let Some(k) = front.next() {
        if filled.choices.len() % 256 == 0 {
            watch.step("fill", filled.choices.len() as f64 / missing.len() as f64)?;
        }
        let v = missing[k];
        let query = front.query(k);
        let beside = best_beside(target, VertexId(v), &taken, sources, &exemplars, &library, &query);
        let limit = beside.map_or(f32::INFINITY, |(_, distance)| distance / (PATIENCE * PATIENCE));
        let (place, distance, jump) = match (search(&library, &query, limit), beside) {
            (None, Some((place, distance))) => (place, distance, false),
            (Some(found), _) => {
                let (source, vertex) = exemplars.names[found.entry as usize];
                (Place::at(source, VertexId(vertex), found.turn), found.distance, true)
            }
            (None, None) => continue,
        };
        let known = u32::from(front.confidence[k]);
        let distance = (f64::from(distance) / f64::from(known.max(1))).sqrt();
        let source = (place.source, place.vertex);
        filled.choices.push(Choice { vertex: VertexId(v), source, turn: place.angle, jump, distance, known });
        let detail = place.detail(sources[place.source].0);
        details[v as usize] = Some(detail);
        taken[v as usize] = Some(place);
        front.assign(k, target.signal(&detail));
    }
    Ok(filled)
}

/// Of the source places beside those that the neighbours copied from, the one most like, and its distance.
fn best_beside(
    target: &Relief,
    v: VertexId,
    taken: &[Option<Place>],
    sources: &[(&Relief, Vec<bool>)],
    exemplars: &Exemplars,
    library: &Library,
    query: &Query,
) -> Option<(Place, f32)> {
    let mut best: Option<(Place, f32)> = None;
    for h in target.base().ring(v) {
        let n = target.base().head(h);
        let Some(place) = taken[n.index()] else { continue };
        let Some(place) = place.beside(target, n, v, sources[place.source].0) else { continue };
        let entry = exemplars.entries[place.source][place.vertex.index()];
        if entry == NONE {
            continue;
        }
        let limit = best.map_or(f32::INFINITY, |b| b.1);
        if let Some(distance) = library.distance(query, entry, place.turn(), limit).filter(|&d| d < limit) {
            best = Some((place, distance));
        }
    }
    best
}

/// How like the surroundings of `vertex` each vertex of the patch looks: root mean square difference of the fans, least over eight rotations, as
/// a share of the patch's root mean square signal. Infinite where a fan leaves the patch. O(n), parallel.
///
/// # Errors
/// [`Error::Length`].
pub fn similarity(relief: &Relief, vertex: VertexId, length: f64) -> Result<Vec<f64>, Error> {
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::Length { name: "fan length", value: length });
    }
    let mut out = vec![f64::INFINITY; relief.vertices().len()];
    let Ok(found) = exemplars(relief, &[(relief, vec![])], length) else { return Ok(out) };
    let Some(&own) = found.entries[0].get(vertex.index()).filter(|&&e| e != NONE) else { return Ok(out) };
    let query = Query { values: found.fans[own as usize], known: (0..SAMPLES as u8).collect() };
    let library = Library::new(&found.fans);
    for (entry, &(_, v)) in (0..).zip(&found.names) {
        out[v as usize] = (f64::from(library.nearest_turn(&query, entry)) / SAMPLES as f64).sqrt();
    }
    Ok(out)
}

fn exemplars(target: &Relief, sources: &[(&Relief, Vec<bool>)], length: f64) -> Result<Exemplars, Error> {
    let (mut signals, mut candidates) = (vec![], vec![]);
    let (mut squares, mut count) = (0.0, 0usize);
    for (relief, excluded) in sources {
        let usable = |i: usize| !relief.rim()[i] && excluded.get(i) != Some(&true);
        let signal: Vec<DVec3> = relief.details().iter().map(|d| target.signal(d)).collect();
        let own: Vec<u32> = relief.region_vertices(excluded).collect();
        for &v in &own {
            squares += signal[v as usize].length_squared();
        }
        count += own.len();
        let able: Vec<bool> = (0..signal.len()).map(usable).collect();
        signals.push((signal, able));
        candidates.push(own);
    }
    let scale = (squares / count.max(1) as f64).sqrt();
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let mut out = Exemplars { fans: vec![], names: vec![], scale, entries: vec![] };
    for (source, (relief, _)) in sources.iter().enumerate() {
        let (signal, able) = &signals[source];
        let field: Vec<[f32; 3]> = signal.iter().map(|s| small(*s / scale)).collect();
        let whole = |fan: &Fan| fan.iter().all(|s| !s.is_missing() && s.vertices.iter().all(|&v| able[v as usize]));
        let values: Vec<Option<[f32; NUMBERS]>> = fans(relief, &candidates[source], length)
            .par_iter()
            .map(|fan| whole(fan).then(|| read(fan, &field)))
            .collect();
        let mut entries = vec![NONE; able.len()];
        for (&v, fan) in candidates[source].iter().zip(values) {
            if let Some(fan) = fan {
                entries[v as usize] = out.fans.len() as u32;
                out.fans.push(fan);
                out.names.push((source, v));
            }
        }
        out.entries.push(entries);
    }
    if out.fans.is_empty() {
        let at = sources.first().and_then(|s| s.0.base().mesh().positions.first()).copied().unwrap_or_default();
        return Err(Error::SourceTooSmall { length, at });
    }
    Ok(out)
}

fn small(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

fn read(fan: &Fan, field: &[[f32; 3]]) -> [f32; NUMBERS] {
    let mut out = [0.0; NUMBERS];
    for (sample, numbers) in fan.iter().zip(out.chunks_exact_mut(3)) {
        numbers.copy_from_slice(&sample.of(field));
    }
    out
}

/// The vertices still to be filled and what is known around them.
struct Front {
    fans: Vec<Fan>,
    /// Unassigned vertices that each sample leans on.
    lacking: Vec<[u8; SAMPLES]>,
    /// Known samples of each fan.
    confidence: Vec<u8>,
    /// Which fans' samples lean on each missing vertex: starts, and fan and sample.
    starts: Vec<u32>,
    leaning: Vec<(u32, u8)>,
    field: Vec<[f32; 3]>,
    missing: Vec<u32>,
    done: Vec<bool>,
    /// Confidence, and how far from the end of the order.
    queue: BinaryHeap<(u8, std::cmp::Reverse<u32>)>,
    scale: f64,
}

impl Front {
    fn new(target: &Relief, details: &[Option<Detail>], missing: &[u32], fans: Vec<Fan>, scale: f64) -> Self {
        let rim = target.rim();
        let mut place = vec![NONE; details.len()];
        missing.iter().enumerate().for_each(|(k, &v)| place[v as usize] = k as u32);
        let field =
            details.iter().map(|d| small(d.as_ref().map_or(DVec3::ZERO, |d| target.signal(d)) / scale)).collect();
        // On the rim, Laplacians are cut short.
        let never = |s: &crate::fan::Sample| s.is_missing() || s.vertices.iter().any(|&v| rim[v as usize]);
        let mut counts = vec![0u32; missing.len() + 1];
        let each = |visit: &mut dyn FnMut(usize, usize, u32)| {
            for (k, fan) in fans.iter().enumerate() {
                for (i, sample) in fan.iter().enumerate().filter(|s| !never(s.1)) {
                    for &v in &sample.vertices {
                        if place[v as usize] != NONE {
                            visit(k, i, place[v as usize]);
                        }
                    }
                }
            }
        };
        each(&mut |_, _, at| counts[at as usize + 1] += 1);
        for i in 1..counts.len() {
            counts[i] += counts[i - 1];
        }
        let starts = counts.clone();
        let mut leaning = vec![(0, 0); starts[missing.len()] as usize];
        let mut lacking: Vec<[u8; SAMPLES]> =
            fans.iter().map(|fan| std::array::from_fn(|i| if never(&fan[i]) { u8::MAX } else { 0 })).collect();
        each(&mut |k, i, at| {
            leaning[counts[at as usize] as usize] = (k as u32, i as u8);
            counts[at as usize] += 1;
            lacking[k][i] += 1;
        });
        let known = |l: &[u8; SAMPLES]| l.iter().map(|&n| u8::from(n == 0)).sum();
        let confidence: Vec<u8> = lacking.iter().map(known).collect();
        let queue = confidence.iter().enumerate().map(|(k, &c)| (c, std::cmp::Reverse(k as u32))).collect();
        let done = vec![false; missing.len()];
        Self { fans, lacking, confidence, starts, leaning, field, missing: missing.to_vec(), done, queue, scale }
    }

    /// The vertex about which most is known.
    fn next(&mut self) -> Option<usize> {
        while let Some((confidence, std::cmp::Reverse(k))) = self.queue.pop() {
            let k = k as usize;
            if !self.done[k] && self.confidence[k] == confidence {
                return Some(k);
            }
        }
        None
    }

    fn query(&self, k: usize) -> Query {
        let mut query = Query { values: [0.0; NUMBERS], known: Vec::with_capacity(SAMPLES) };
        for (i, sample) in self.fans[k].iter().enumerate().filter(|(i, _)| self.lacking[k][*i] == 0) {
            query.values[3 * i..3 * i + 3].copy_from_slice(&sample.of(&self.field));
            query.known.push(i as u8);
        }
        query
    }

    fn assign(&mut self, k: usize, signal: DVec3) {
        self.done[k] = true;
        self.field[self.missing[k] as usize] = small(signal / self.scale);
        for &(fan, sample) in &self.leaning[self.starts[k] as usize..self.starts[k + 1] as usize] {
            let (fan, sample) = (fan as usize, sample as usize);
            self.lacking[fan][sample] -= 1;
            if self.lacking[fan][sample] == 0 {
                self.confidence[fan] += 1;
                if !self.done[fan] {
                    self.queue.push((self.confidence[fan], std::cmp::Reverse(fan as u32)));
                }
            }
        }
    }
}
