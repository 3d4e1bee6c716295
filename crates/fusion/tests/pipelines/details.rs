//! Geometry detail in recipes.

use fusion::Recipe;
use fusion::mesh_core::{FaceOrigin, TriMesh, Watch, shapes};
use glam::DVec3;
use mesh_io::{Format, Model};

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
version = 1
output = \"out.off\"
[[part]]
name = \"low\"
mesh = \"tube.off\"
[[part]]
name = \"high\"
mesh = \"tube.off\"
translate = [0, 0, 4.2]
[[compose]]
loops = [\"low:TOP\", \"high:BOTTOM\"]
";

fn run(detail: &str) -> Result<fusion::Outcome, fusion::Error> {
    let tube = bumpy();
    let one = |top: usize| {
        let text = PARTS.replace("TOP", &top.to_string()).replace("BOTTOM", &(1 - top).to_string()) + detail;
        Recipe::parse(&text)?.run(&[tube.clone(), tube.clone()], Format::Off, &Watch::default())
    };
    // The upper end of the lower tube, whichever loop that is.
    let loops = fusion::Info::of(&tube.mesh, &Watch::default()).unwrap().boundary_loops.unwrap();
    one(usize::from(loops[0].at[2] < loops[1].at[2]))
}

#[test]
fn a_transition_gets_the_detail_of_a_part() {
    let smooth = run("").unwrap();
    let rough =
        run("[[detail]]\nsource = { part = \"low\", near = [1, 0, 1.5], radius = 3.0 }\nwavelength = 1.5").unwrap();
    let figure = |name: &str| rough.report.figures[name];
    assert!((figure("roughness") / figure("roughness_source") - 1.0).abs() < 0.25, "{:?}", rough.report.figures);
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
        ("source = [{ part = \"middle\", group = \"a\" }]", "no part `middle`"),
        ("source = { origin = \"blend\" }\nmode = \"structured\"", "along"),
        ("source = { origin = \"blend\" }\nintensity = nan", "number from"),
        ("source = { origin = \"blend\" }\nwavelength = 0.0", "above 0"),
        ("mode = \"unstructured\"", "source"),
    ] {
        let text = PARTS.replace("TOP", "0").replace("BOTTOM", "1") + "[[detail]]\n" + table;
        let error = Recipe::parse(&text).unwrap_err();
        assert!(error.message.contains(says), "{table}: {error}");
    }
}
