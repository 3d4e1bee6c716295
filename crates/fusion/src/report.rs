//! The machine-readable account of one job: what came in, what went out, what changed, how long it took.

use crate::blend::Method;
use crate::choice::Source;
use crate::diagnostic::{Code, Diagnostic, Severity};
use crate::inherited::Inherited;
use mesh_core::{FaceOrigin, Faces, Origins, TriMesh, VertexOrigin};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::time::Instant;

/// What a job did. Its keys are the ones of `--report`, documented in `docs/report.md`; keys are added, never renamed.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Report {
    /// Version of the set of keys. Rises only when a key changes its meaning.
    pub version: u32,
    /// The verb that ran, such as `"union"`.
    pub command: String,
    /// The inputs in order.
    pub inputs: Vec<Counts>,
    /// The result.
    pub output: Counts,
    /// What the result was found to be, in the coordinates that were written.
    pub validity: Validity,
    /// Where the result crosses itself because its inputs do, by input.
    #[serde(default)]
    pub inherited: Vec<Inherited>,
    /// Vertices of the result that are an input vertex, bit for bit.
    pub kept_vertices: usize,
    /// Faces of the result that are not a whole input face.
    pub changed_faces: usize,
    /// Largest residuals by name, in the unit each stage documents; `contact` is |distance − r| / r of the ball centres.
    pub residuals: BTreeMap<String, f64>,
    /// Shape of the changed faces.
    pub quality: Quality,
    /// Other figures by name, such as `seams`, `radius` in model units, or `volume`.
    pub figures: BTreeMap<String, f64>,
    /// Every curve that was chosen to be blended.
    #[serde(default)]
    pub curves: Vec<CurveReport>,
    /// All that is told, as data. Every warning and note that has a place or a number is here as well.
    #[serde(default)]
    pub diagnostics: Vec<Diagnostic>,
    /// The exit code of the program; 0 where there is a result.
    #[serde(default)]
    pub exit_code: u8,
    /// What the user should know although the job succeeded, as sentences.
    pub warnings: Vec<String>,
    /// Choices that were made and why, as sentences.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Wall-clock time of each stage, in the order they ran.
    pub stages: Vec<Stage>,
}

/// Size of one mesh.
#[derive(Clone, Debug, Default, Serialize, Deserialize, PartialEq, Eq)]
pub struct Counts {
    /// Its file, or empty.
    pub name: String,
    /// How many vertices.
    pub vertices: usize,
    /// How many triangles.
    pub faces: usize,
}

impl Counts {
    /// The counts of `mesh` under `name`.
    pub fn of(name: impl Into<String>, mesh: &TriMesh) -> Self {
        Self { name: name.into(), vertices: mesh.vertex_count(), faces: mesh.face_count() }
    }
}

/// What a mesh was found to be. `None` means not checked.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, PartialEq, Eq)]
pub struct Validity {
    /// Oriented 2-manifold, possibly with boundary.
    pub manifold: Option<bool>,
    /// Without boundary.
    pub closed: Option<bool>,
    /// How many pairs of faces meet where they should not: in the whole mesh after [`look_everywhere`](crate::look_everywhere), else where it was changed.
    pub self_intersections: Option<usize>,
}

/// One curve of a blend.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct CurveReport {
    /// Its number: of a feature curve in the list at the same angle, else in the order of its file or of the seams.
    pub id: usize,
    /// What it was named by.
    pub source: Source,
    /// In model units.
    pub length: f64,
    /// What it was blended by.
    pub method: Method,
    /// The smallest radius used along it, in model units; 0 where it is left sharp.
    pub radius: f64,
    /// Share of its length that is blended at all.
    pub blended_share: f64,
    /// Share of its length along which the blend lies on balls of the radius asked for, within 5%; `None` where that cannot be
    /// told: other cross-sections than an arc, radii that vary along a curve.
    pub full_share: Option<f64>,
    /// The ball error of its blend that 50, 90 and 99% of the area keep, as shares of the radius; `None` as above, or where
    /// the blend has no vertex of its own.
    pub ball_error: Option<[f64; 3]>,
    /// Where and why it is left sharp.
    pub left_sharp: Option<(String, [f64; 3])>,
}

/// Angles of triangles, in degrees.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, PartialEq)]
pub struct Quality {
    /// The smallest corner angle; 0 where there is no face.
    pub smallest_angle: f64,
    /// Mean over faces of each face's smallest angle; 60 is best.
    pub mean_smallest_angle: f64,
    /// How many faces have an angle under 5 degrees.
    pub slivers: usize,
}

/// One stage's time.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Stage {
    /// The stage, such as `"boolean"`.
    pub name: String,
    /// Wall-clock milliseconds.
    pub milliseconds: f64,
}

impl Default for Report {
    fn default() -> Self {
        Self {
            version: 1,
            command: String::new(),
            inputs: vec![],
            output: Counts::default(),
            validity: Validity::default(),
            inherited: vec![],
            kept_vertices: 0,
            changed_faces: 0,
            residuals: BTreeMap::new(),
            quality: Quality::default(),
            figures: BTreeMap::new(),
            curves: vec![],
            diagnostics: vec![],
            exit_code: 0,
            warnings: vec![],
            notes: vec![],
            stages: vec![],
        }
    }
}

impl Report {
    /// An empty report of `command` on `inputs`.
    pub fn new(command: impl Into<String>, inputs: Vec<Counts>) -> Self {
        Self { command: command.into(), inputs, ..Self::default() }
    }

    /// Adds a diagnostic, and its sentence to the warnings or notes.
    pub fn tell(&mut self, diagnostic: Diagnostic) {
        match diagnostic.severity {
            Severity::Note => self.notes.push(diagnostic.message.clone()),
            Severity::Warning => self.warnings.push(diagnostic.message.clone()),
            Severity::Error => {}
        }
        self.diagnostics.push(diagnostic);
    }

    /// Takes back the diagnostics of one kind, with their sentences.
    pub(crate) fn forget(&mut self, code: Code) {
        let told: Vec<String> = self.diagnostics.iter().filter(|d| d.code == code).map(|d| d.message.clone()).collect();
        self.warnings.retain(|message| !told.contains(message));
        self.notes.retain(|message| !told.contains(message));
        self.diagnostics.retain(|d| d.code != code);
    }

    /// Takes what a check found, and tells what the inputs brought along.
    pub(crate) fn checked(&mut self, (validity, inherited): (Validity, Vec<Inherited>)) {
        self.validity = validity;
        for crossings in &inherited {
            self.tell(Diagnostic::inherited(crossings));
        }
        self.inherited = inherited;
    }

    /// Runs `stage` and notes its time under `name`, whether or not it succeeds.
    pub fn time<T>(&mut self, name: &str, stage: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = stage();
        let milliseconds = start.elapsed().as_micros() as f64 / 1e3;
        self.stages.push(Stage { name: name.into(), milliseconds });
        result
    }

    /// Fills in what follows from the result and its origins: counts, what was kept, the shape of what changed. O(n).
    pub fn describe(&mut self, mesh: &TriMesh, origins: &Origins) {
        self.output = Counts::of(std::mem::take(&mut self.output.name), mesh);
        self.kept_vertices =
            origins.vertices.as_slice().iter().filter(|o| matches!(o, VertexOrigin::Input { .. })).count();
        let changed = origins.faces.as_slice().iter().map(|o| !matches!(o, FaceOrigin::Input { .. }));
        let changed: Vec<_> = mesh.face_ids().zip(changed).filter_map(|(f, c)| c.then_some(f)).collect();
        self.changed_faces = changed.len();
        self.quality = Quality::of(changed.iter().map(|&f| mesh.triangle(f)));
    }

    /// Total of all stages, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.stages.iter().map(|s| s.milliseconds).sum()
    }

    /// The report as indented JSON, ending in a line break. Numbers that are not finite become `null`.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self)
            .map_or_else(|e| format!("{{\"error\": {:?}}}\n", e.to_string()), |s| s + "\n")
    }
}

impl Quality {
    /// The quality of some triangles. A triangle without area has angle 0.
    pub fn of(triangles: impl IntoIterator<Item = [glam::DVec3; 3]>) -> Self {
        let (mut smallest, mut sum, mut count, mut slivers) = (f64::INFINITY, 0.0, 0usize, 0);
        for t in triangles {
            let angle = (0..3)
                .map(|k| (t[(k + 1) % 3] - t[k]).angle_between(t[(k + 2) % 3] - t[k]).to_degrees())
                .fold(f64::INFINITY, f64::min);
            let angle = if angle.is_finite() { angle } else { 0.0 };
            smallest = smallest.min(angle);
            sum += angle;
            count += 1;
            slivers += usize::from(angle < 5.0);
        }
        if count == 0 {
            return Self::default();
        }
        Self { smallest_angle: smallest, mean_smallest_angle: sum / count as f64, slivers }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::{FaceId, VertexId, shapes};

    #[test]
    fn a_report_survives_json() {
        let mut report = Report::new("union", vec![Counts::of("a.obj", &shapes::cuboid(DVec3::ONE))]);
        report.residuals.insert("contact".into(), 1e-12);
        assert_eq!(report.time("boolean", || 7), 7);
        assert_eq!(serde_json::from_str::<Report>(&report.to_json()).unwrap(), report);
    }

    #[test]
    fn describe_counts_what_changed() {
        let mesh = shapes::cuboid(DVec3::ONE);
        let mut origins = Origins::identity(0, 8, 12);
        origins.vertices[VertexId(3)] = VertexOrigin::New { stage: "blend" };
        origins.faces[FaceId(0)] = FaceOrigin::New { stage: "blend" };
        origins.faces[FaceId(5)] = FaceOrigin::Piece { part: 0, face: FaceId(5) };
        let mut report = Report::default();
        report.describe(&mesh, &origins);
        assert_eq!((report.kept_vertices, report.changed_faces), (7, 2));
        assert_eq!((report.output.vertices, report.output.faces), (8, 12));
        assert!((report.quality.smallest_angle - 45.0).abs() < 1e-9);
    }

    #[test]
    fn flat_triangles_are_slivers_not_nan() {
        let q = Quality::of([[DVec3::ZERO, DVec3::ZERO, DVec3::X]]);
        assert_eq!((q.smallest_angle, q.slivers), (0.0, 1));
    }
}
