//! Documents evaluated: names, edits, results kept.

use fusion::Error;
use fusion::document::{Cache, Document, Evaluation, Given, Output, Precisions};
use fusion::mesh_core::{FaceOrigin, VertexOrigin, Watch, bounds, shapes, volume};
use fusion::operation::{Blend, Boolean, Cut, Linked, Plane, Pose, Precision, SetOperation};
use glam::DVec3;
use mesh_io::Model;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

/// Every part is a unit cube, but `ball`.
pub fn sources() -> Given {
    let mut given = Given::default();
    let mut cube = Model::from(shapes::cuboid(DVec3::ONE));
    cube.uvs = Some((0..36).map(|i| [f64::from(i), 0.5]).collect::<Vec<_>>().into());
    given.0.insert("cube.off".into(), Arc::new(cube));
    given.0.insert("ball.off".into(), Arc::new(shapes::icosphere(1.0, 3).into()));
    given
}

pub fn evaluate(document: &Document, cache: &Cache) -> Result<Evaluation, Error> {
    document.evaluate_from(&mut sources(), cache, Precisions::ByFile, &Watch::default())
}

fn run(text: &str) -> Result<Evaluation, Error> {
    evaluate(&Document::parse(&format!("version = 2\n{text}"))?, &Cache::in_memory(0))
}

/// All that a result is, without times.
pub fn bytes(made: &Result<Evaluation, Error>) -> String {
    let made = match made {
        Ok(made) => made,
        Err(error) => return error.to_string(),
    };
    let mut text = String::new();
    for output in &made.outputs {
        let outcome = &output.outcome;
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        let places: Vec<_> = outcome.model.mesh.positions.iter().map(bits).collect();
        let mut report = outcome.report.clone();
        report.stages.iter_mut().for_each(|s| s.milliseconds = 0.0);
        let model = &outcome.model;
        let rest = (&model.mesh.faces, &model.uvs, &outcome.origins);
        writeln!(text, "{places:?} {rest:?} {report:?}").unwrap();
    }
    text
}

pub const CUBES: &str = "
[[part]]
name = \"a\"
mesh = \"cube.off\"
[[part]]
name = \"b\"
mesh = \"cube.off\"
translate = [0.5, 0.25, 0.125]
";

/// Cut, pose, compose, blend, pose again and subtract: anything follows anything.
#[test]
fn anything_follows_anything() {
    let text = "
        [parameters]
        soft = 0.05
        unused = 1
        [[part]]
        name = \"low\"
        mesh = \"ball.off\"
        [[part]]
        name = \"high\"
        mesh = \"ball.off\"
        [[part]]
        name = \"tool\"
        mesh = \"cube.off\"
        scale = 0.5
        [[step]]
        do = \"cut\"
        of = \"low\"
        plane = { point = [0, 0, 0.6], normal = [0, 0, 1] }
        [[step]]
        do = \"cut\"
        of = \"high\"
        plane = { point = [0, 0, -0.6], normal = [0, 0, -1] }
        [[step]]
        do = \"pose\"
        of = \"high\"
        snap = { to = \"low:0\", gap = 0.5 }
        [[step]]
        do = \"compose\"
        of = [\"low:0\", \"high\"]
        as = \"peanut\"
        [[step]]
        do = \"pose\"
        of = \"tool\"
        translate = [0.9, 0, 0]
        [[step]]
        do = \"difference\"
        of = [\"peanut\", \"tool\"]
        [[step]]
        do = \"blend\"
        of = \"peanut\"
        near = [[0.65, 0.25, 0.0]]
        radius = \"$soft\"
        [[step]]
        do = \"pose\"
        of = \"peanut\"
        translate = [0, 0, 7]
        [[step]]
        do = \"difference\"
        of = [\"peanut\", \"tool\"]
        as = \"same\"
        [[output]]
        of = \"same\"
        file = \"same.off\"
        [[output]]
        of = \"tool\"
        file = \"tool.stl\"
    ";
    let text = format!("version = 2\n{text}");
    let document = Document::parse(&text).unwrap();
    assert_eq!(document.unused_parameters(), ["unused"]);
    assert_eq!(document.left_over(), ["same"]);
    let mut short = document.clone();
    // The last subtraction takes nothing away.
    short.set("9.off", "true").unwrap();
    let made = evaluate(&short, &Cache::default()).unwrap();
    let whole = &made.outputs[0].outcome;
    assert_eq!(whole.report.validity.closed, Some(true));
    assert!(bounds(&whole.model.mesh).min.z > 5.0, "posed after all");
    // Origins are those of the files, through every step.
    let parts = |o: &VertexOrigin| matches!(o, VertexOrigin::Input { part: 0 | 1, .. });
    assert!(whole.origins.vertices.as_slice().iter().filter(|o| parts(o)).count() > 800);
    let stages =
        |s: &str| whole.origins.faces.as_slice().iter().any(|o| matches!(o, FaceOrigin::New { stage } if *stage == s));
    assert!(stages("transition") && stages("blend"));
    assert!((volume(&made.outputs[1].outcome.model.mesh) - 0.125).abs() < 1e-12);
    assert_eq!(made.steps.iter().map(|s| s.number).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6, 7, 8]);
}

#[test]
fn a_document_is_built_by_a_program() {
    let mut document = Document::new();
    let moved = Pose::default().with_translate(DVec3::new(0.5, 0.25, 0.125));
    document.push_part("a", Path::new("cube.off"), &Pose::default()).unwrap();
    document.push_part("b", Path::new("cube.off"), &moved).unwrap();
    let less = Boolean::default().with_operation(SetOperation::Difference);
    document.push_step(&["a", "b"], less, Some("rest")).unwrap();
    let cut = Cut::default().with_plane(Plane { point: DVec3::new(0.0, 0.0, -0.25), normal: DVec3::Z });
    document.push_step(&["rest"], cut, None).unwrap();
    document.push_output(None, Path::new("rest.off")).unwrap();
    let made = evaluate(&document, &Cache::default()).unwrap();
    let again = evaluate(&Document::parse(&document.to_toml()).unwrap(), &Cache::default());
    assert_eq!(bytes(&Ok(made.clone())), bytes(&again));
    assert_eq!(made.outputs[0].outcome.report.validity.closed, Some(false));
    let before = document.to_toml();
    let error = document.push_step(&["nobody"], Blend::default().with_radius(0.1), None).unwrap_err();
    assert!(error.message.contains("`nobody`") && document.to_toml() == before, "{error}");
}

/// What is set stays where it stood, with the comments around it.
#[test]
fn values_are_set_from_outside() {
    let text = format!("version = 2\n[parameters]\nr = 0.1 # soft\n{CUBES}[[step]]\ndo = \"union\"\nradius = \"$r\"\n");
    let mut document = Document::parse(&text).unwrap();
    let radius = |d: &Document| evaluate(d, &Cache::default()).unwrap().steps[0].report.figures["radius"];
    assert_eq!(radius(&document), 0.1);
    document.set("r", "0.05").unwrap();
    assert_eq!(radius(&document), 0.05);
    assert!(document.to_toml().contains("r = 0.05 # soft"), "{}", document.to_toml());
    document.set("r", "2%").unwrap();
    document.set("1.radius", "0.07").unwrap();
    assert_eq!(radius(&document), 0.07);
    assert_eq!(document.unused_parameters(), ["r"]);
    for (name, value, says) in [
        ("q", "1", "no parameter `q`"),
        ("2.radius", "1", "no step 2"),
        ("0.radius", "1", "no step 0"),
        ("1.radios", "1", "did you mean `radius`"),
        ("1.radius", "-1", "above 0"),
    ] {
        let error = document.set(name, value).unwrap_err().to_string();
        assert!(error.contains(says), "{name}: {error}");
    }
    assert_eq!(radius(&document), 0.07);
}

#[test]
fn what_is_wrong_is_named_by_line_column_and_key() {
    let head = "version = 2\n[[part]]\nname = \"a\"\nmesh = \"cube.off\"\n";
    let with = |rest: &str| format!("{head}{rest}");
    let circle = "[primitive.p]\nshape = \"sphere\"\nradius = 1\non = { primitive = \"q\", at = [0, 1] }\n[primitive.q]\nshape = \"sphere\"\nradius = 1\non = { primitive = \"p\", at = [0, 1] }\n";
    for (text, line, column, says) in [
        ("version = 1\noutput = \"a.off\"".into(), 1, 11, "[[step]]"),
        ("version = 3".into(), 1, 11, "version 2"),
        (String::new(), 1, 1, "version = 2"),
        ("version = 2\nfoo = 3".into(), 2, 1, "unknown key `foo`"),
        ("version = 2\npartz = 3".into(), 2, 1, "did you mean `part`"),
        (with("scale = 0.0"), 5, 9, "above 0"),
        (with("rotate = { axis = [0, 0, 1], angle = 3, degrees = 3 }"), 5, 41, "unknown key `degrees`"),
        (with("[[part]]\nname = \"a\"\nmesh = \"b.off\""), 6, 8, "another part `a`"),
        (with("[[part]]\nname = \"a:0\"\nmesh = \"b.off\""), 6, 8, "no colon"),
        (with("[[step]]\nof = \"a\""), 5, 1, "`do` is missing"),
        (with("[[step]]\ndo = \"unoin\""), 6, 6, "did you mean `union`"),
        (with("[[step]]\ndo = \"blend\"\nradios = 1"), 7, 1, "did you mean `radius`"),
        (
            with("[[step]]\ndo = \"blend\"\nradius = 1\nradius_at = [{ at = [0, 0, 0], radius = 1, r = 2 }]"),
            8,
            44,
            "unknown key `r`",
        ),
        (with("[[step]]\ndo = \"blend\"\nradius = \"$soft\""), 7, 10, "no parameter `soft`"),
        (with("[[step]]\ndo = \"blend\"\nradius = -1"), 7, 10, "above 0"),
        (with("[[step]]\ndo = \"union\"\noperation = \"union\"\nof = [\"a\", \"a\"]"), 7, 1, "unknown key `operation`"),
        (with("[[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]"), 7, 6, "no shape `b`"),
        (with("[[step]]\ndo = \"union\"\nof = [\"a\"]"), 7, 6, "two shapes or more"),
        (with("[[step]]\ndo = \"blend\"\nof = \"a:0\"\nradius = 1"), 7, 6, "only `compose`"),
        (with("[[step]]\ndo = \"detail\"\nsource = { part = \"c\", group = \"x\" }"), 7, 10, "no shape `c`"),
        (with("[[output]]\nof = \"b\"\nfile = \"b.off\""), 6, 6, "no shape `b`"),
        (with("[[output]]\nof = \"a\""), 5, 1, "`file` is missing"),
        (with("on = { primitive = \"q\", at = [0, 0] }"), 5, 6, "no [primitive.q]"),
        (with(&format!("on = {{ primitive = \"p\", at = [0, 0] }}\n{circle}")), 9, 6, "circle"),
        (
            with("snap = { to = \"b:0\" }\n[[part]]\nname = \"b\"\nmesh = \"c.off\"\nsnap = { to = \"a:0\" }"),
            2,
            1,
            "circle",
        ),
        (with("[primitive.a]\nshape = \"sphere\"\nradius = 1"), 5, 1, "is a part, too"),
        (with("[primitive.b]\nshape = \"ball\"\nradius = 1"), 6, 9, "sphere"),
    ] {
        let error = Document::parse(&text).unwrap_err();
        assert!(error.to_string().contains(says), "{text}: {error}");
        assert_eq!((error.line, error.column), (line, column), "{text}: {error}");
    }
}

/// What can be known only when the step is taken.
#[test]
fn what_is_not_there_at_that_point_is_named_by_its_line() {
    for (text, says) in [
        (format!("{CUBES}[[step]]\ndo = \"compose\"\nof = [\"a:0\", \"b:0\"]"), "`a` has 0 loops"),
        (format!("{CUBES}[[step]]\ndo = \"pose\"\nof = \"a\"\nsnap = {{ to = \"b:0\" }}"), "loops at this point"),
        ("[[part]]\nname = \"a\"\nmesh = \"none.off\"".into(), "none.off"),
        (format!("{CUBES}[[step]]\ndo = \"blend\"\nof = \"a\"\nradius = 0.1\ncurves = \"none.json\""), "none.json"),
    ] {
        let error = run(&text).unwrap_err();
        assert!(matches!(&error, Error::Document(e) if e.line > 0), "{error}");
        assert!(error.to_string().contains(says), "{says}: {error}");
    }
    let error = run(&format!("{CUBES}[[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]\n[[step]]\ndo = \"blend\"\nof = \"b\"\nradius = 5\noverlap = \"error\"")).unwrap_err();
    assert!(matches!(&error, Error::Step { name, .. } if name.contains("step 2, blend of b")), "{error}");
}

/// The tool goes into both, and the first result is named like its first shape.
#[test]
fn a_name_means_its_latest_shape() {
    let made = run(&format!(
        "{CUBES}[[step]]\ndo = \"difference\"\nof = [\"a\", \"b\"]\n[[step]]\ndo = \"pose\"\nof = \"b\"\ntranslate = [0.3, 0.4, 0.35]\n\
         [[step]]\ndo = \"union\"\nof = [\"a\", \"b\"]\nas = \"both\"\n[[output]]\nfile = \"both.off\"\n[[output]]\nof = \"a\"\nfile = \"a.off\"\n"
    ))
    .unwrap();
    let volumes = made.outputs.iter().map(|o| volume(&o.outcome.model.mesh)).collect::<Vec<_>>();
    let shared = 0.5 * 0.75 * 0.875;
    // Where the tool, moved, lies in the first cube, it lies in the bite.
    let sizes = [2.0 - shared, 1.0 - shared];
    assert!((volumes[1] - sizes[1]).abs() < 1e-12 && (volumes[0] - sizes[0]).abs() < 1e-12, "{volumes:?} {sizes:?}");
}

#[test]
fn a_part_is_set_down_on_another() {
    let text = "[[part]]\nname = \"b\"\nmesh = \"ball.off\"\nscale = 0.25\ntranslate = [0.1, 0.2, -9]\ndrop = \"a\"\n[[part]]\nname = \"a\"\nmesh = \"cube.off\"\ntranslate = [0, 0, 3]\n[[output]]\nof = \"b\"\nfile = \"b.off\"";
    let made = run(text).unwrap();
    let lowest = bounds(&made.outputs[0].outcome.model.mesh).min.z;
    assert!((lowest - 3.5).abs() < 1e-12, "{lowest}");
    assert!(matches!(
        Document::parse(&format!("version = 2\n{text}")).unwrap().parts()[0].pose.drop,
        Some(Linked::File(_))
    ));
}

/// Outputs in formats of both kinds are each made for what they hold.
#[test]
fn each_output_survives_its_own_format() {
    let text = format!(
        "{CUBES}[[step]]\ndo = \"union\"\nradius = 0.1\n[[output]]\nfile = \"a.off\"\n[[output]]\nfile = \"a.stl\"\n"
    );
    let document = Document::parse(&format!("version = 2\n{text}")).unwrap();
    assert_eq!(document.outputs().iter().map(Output::precision).collect::<Vec<_>>(), [Precision::F64, Precision::F32]);
    let made = evaluate(&document, &Cache::default()).unwrap();
    assert!(made.outputs.iter().all(|o| o.outcome.report.validity.self_intersections == Some(0)));
}
