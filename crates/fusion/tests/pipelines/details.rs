//! Geometry detail in documents.

use fusion::document::{Cache, Document, Given, Precisions};
use fusion::mesh_core::{FaceOrigin, TriMesh, Watch, shapes};
use glam::DVec3;
use mesh_io::Model;
use std::sync::Arc;

/// A tube open at both ends, with bumps.
fn bumpy() -> Model {
    let mut tube: TriMesh = shapes::open_cylinder(1.0, 3.0, 72, 36);
    for p in &mut tube.positions {
        let around = p.y.atan2(p.x);
        let out = DVec3::new(p.x, p.y, 0.0).normalize_or_zero();
        *p += 0.03 * (9.0 * around).sin() * (9.0 * p.z).sin() * out;
    }
    tube.into()
}

const PARTS: &str = "
version = 2
[[part]]
name = \"low\"
mesh = \"tube.off\"
[[part]]
name = \"high\"
mesh = \"tube.off\"
translate = [0, 0, 4.2]
[[step]]
do = \"compose\"
of = [\"low:TOP\", \"high:BOTTOM\"]
as = \"tubes\"
";

fn run(detail: &str) -> Result<fusion::Outcome, fusion::Error> {
    let tube = bumpy();
    let one = |top: usize| {
        let text = PARTS.replace("TOP", &top.to_string()).replace("BOTTOM", &(1 - top).to_string()) + detail;
        let mut given = Given::default();
        given.0.insert("tube.off".into(), Arc::new(tube.clone()));
        let document = Document::parse(&format!("{text}\n[[output]]\nof = \"tubes\"\nfile = \"out.off\""))?;
        let made = document.evaluate_from(&mut given, &Cache::default(), Precisions::ByFile, &Watch::default());
        made.map(|mut made| made.outputs.remove(0).outcome)
    };
    // The upper end of the lower tube, whichever loop that is.
    let loops = fusion::Info::of(&tube.mesh, &Watch::default()).unwrap().boundary_loops.unwrap();
    one(usize::from(loops[0].at[2] < loops[1].at[2]))
}

#[test]
fn a_transition_gets_the_detail_of_a_part() {
    let smooth = run("").unwrap();
    let rough =
        run("[[step]]\ndo = \"detail\"\nof = \"tubes\"\nsource = { part = \"low\", near = [1, 0, 1.5], radius = 3.0 }\nwavelength = 1.5").unwrap();
    let figure = |name: &str| rough.report.figures[name];
    assert!((figure("roughness") / figure("roughness_source") - 1.0).abs() < 0.2, "{:?}", rough.report.figures);
    assert!(figure("roughness_before") < 0.3 * figure("roughness_source"));
    assert_eq!(smooth.model.mesh.faces, rough.model.mesh.faces);
    let new = |o: &FaceOrigin| matches!(o, FaceOrigin::New { stage: "transition" });
    assert_eq!(
        smooth.origins.faces.as_slice().iter().filter(|o| new(o)).count(),
        rough.origins.faces.as_slice().iter().filter(|o| new(o)).count()
    );
    let parts = 2 * bumpy().mesh.positions.len();
    assert_eq!(smooth.model.mesh.positions[..parts], rough.model.mesh.positions[..parts]);
}

#[test]
fn what_is_wrong_with_a_detail_is_named() {
    for (table, says) in [
        ("source = { near = [0, 0, 0] }", "near and radius"),
        ("source = [{ part = \"middle\", group = \"a\" }]", "no shape `middle`"),
        ("source = { origin = \"blend\" }\nmode = \"structured\"", "along"),
        ("source = { origin = \"blend\" }\nintensity = nan", "number from"),
        ("source = { origin = \"blend\" }\nwavelength = 0.0", "above 0"),
        ("mode = \"unstructured\"", "source"),
    ] {
        let text =
            PARTS.replace("TOP", "0").replace("BOTTOM", "1") + "[[step]]\ndo = \"detail\"\nof = \"tubes\"\n" + table;
        let error = Document::parse(&text).unwrap_err();
        assert!(error.to_string().contains(says), "{table}: {error}");
    }
}

const LOW: &str = "[[step]]\ndo = \"detail\"\nof = \"tubes\"\nsource = { part = \"low\", near = [1, 0, 1.5], radius = 3.0 }\nwavelength = 1.5\n";

/// Lengths, shares and names; the figure tells which was taken.
#[test]
fn fans_are_as_long_as_the_document_says() {
    let fan = |line: &str| run(&format!("{LOW}{line}")).unwrap().report.figures["fan"];
    assert_eq!(fan("fan = 0.25"), 0.25);
    // One and a half of the longest edges, of 0.087; a hundredth of the diagonal is less than that, and so is not taken.
    let edges = fan("fan = \"edges\"");
    assert!((0.1..0.25).contains(&edges), "{edges}");
    assert_eq!(fan("fan = \"diagonal\""), edges);
    assert_eq!(fan(""), edges);
    let error = run(&format!("{LOW}fan = \"branches\"")).unwrap_err();
    assert!(error.to_string().contains("length"), "{error}");
}

/// The index finds what looking at everything finds, so the meshes are the same to the bit.
#[test]
fn both_searches_make_the_same_mesh() {
    let [indexed, exhaustive] =
        ["indexed", "exhaustive"].map(|name| run(&format!("{LOW}search = \"{name}\"")).unwrap());
    assert_eq!(indexed.model.mesh, exhaustive.model.mesh);
    assert_eq!(indexed.report.figures, exhaustive.report.figures);
    let error = run(&format!("{LOW}search = \"random\"")).unwrap_err();
    assert!(error.to_string().contains("indexed or exhaustive"), "{error}");
}

/// A curve on the part that lends and one on the transition: rectangles of the one are copied to the other.
#[test]
fn detail_follows_a_curve_from_another_part() {
    let curves = "mode = \"structured\"\nalong = [[1, 0, BELOW], [1, 0, ABOVE]]\nwidth = 0.8\nspacing = 0.2\n";
    let tube = bumpy().mesh;
    let heights = tube.positions.iter().map(|p| p.z);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
    let curves = curves.replace("BELOW", &(high - 0.3).to_string()).replace("ABOVE", &(high + 1.5).to_string());
    let source = format!("source_along = [[1, 0, {}], [1, 0, {}]]", low + 0.5, high - 0.5);
    let with = run(&format!("{LOW}{curves}{source}")).unwrap();
    assert!(with.report.figures["patches"] >= 2.0, "{:?}", with.report.figures);
    let share = with.report.figures["roughness"] / with.report.figures["roughness_source"];
    assert!((0.7..1.3).contains(&share), "{:?}", with.report.figures);
    // Elsewhere on the part there is no curve to copy along.
    let nowhere = run(&format!("{LOW}{curves}source_along = [[9, 0, 0], [9, 0, 1]]")).unwrap_err();
    assert!(nowhere.to_string().contains("governing curve has 0 anchors on the source"), "{nowhere}");
}
