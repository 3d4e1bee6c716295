//! A session from two files to one: what a modeller does with the page, by the page's own protocol.

use crate::client::{Client, get, post, union_of_balls};
use fusion::mesh_core::{Connected, Watch, volume};
use fusion_studio::{Options, Server};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Evaluates a document as `fusion-cli run` does, and gives the bytes that it writes.
fn replayed(document: &Path, into: &Path) -> Vec<u8> {
    use fusion::document::{Cache, Document, Precisions};
    let text = fs::read_to_string(document).unwrap();
    let made = Document::parse(&text)
        .unwrap()
        .evaluate(document.parent().unwrap(), &Cache::default(), Precisions::ByFile, &Watch::default())
        .unwrap();
    let [output] = &made.outputs[..] else { panic!("one output") };
    let file = into.join(output.file.file_name().unwrap());
    mesh_io::write(&output.outcome.model, &file).unwrap();
    fs::read(file).unwrap()
}

#[test]
fn drop_union_drag_undo_export_and_replay() {
    let folder = tempfile::tempdir().unwrap();
    let files = tempfile::tempdir().unwrap();
    crate::client::two_balls(files.path(), 3);
    let mut options = Options::default();
    options.root = Some(folder.path().into());
    let server = Server::start(&options).unwrap();
    let mut page = Client::connect(server.address());
    let schema: Value = serde_json::from_slice(&get(server.address(), "/schema", &[]).1).unwrap();
    assert_eq!(schema, fusion::document::schema());
    for name in ["one.obj", "two.obj"] {
        let bytes = fs::read(files.path().join(name)).unwrap();
        assert_eq!(post(server.address(), &format!("/upload?name={name}"), &bytes), (200, json!({ "path": name })));
        page.ok(json!({ "do": "add_part", "mesh": name }));
    }
    page.ok(json!({ "do": "set", "table": "part", "index": 1, "key": "translate", "value": [0.1, 0, 0], "drag": 1 }));
    let step = json!({ "do": "add_step", "verb": "union", "of": ["one", "two"], "as": "both" });
    page.ok(step);
    let mut version = json!(0);
    for n in 0..10 {
        let set = json!({
            "do": "set", "table": "step", "index": 0, "key": "radius", "value": 0.05 + 0.01 * f64::from(n), "drag": 10 + n
        });
        version = page.ok(set)["version"].clone();
    }
    page.evaluated(&version);
    for _ in 0..5 {
        version = page.ok(json!({ "do": "undo" }))["version"].clone();
    }
    for _ in 0..2 {
        version = page.ok(json!({ "do": "redo" }))["version"].clone();
    }
    let document = page.wait(|e| e["event"] == "document" && e["version"] == version);
    assert_eq!(document["steps"][0]["options"]["radius"], 0.05 + 0.01 * 6.0);
    assert_eq!((&document["can_undo"], &document["can_redo"]), (&json!(true), &json!(true)));
    let evaluated = page.evaluated(&version);
    assert_eq!(evaluated["shapes"][0]["name"], "both");
    assert_eq!(evaluated["shapes"][0]["closed"], true);
    let frame = page.shapes["both"].clone();
    assert_eq!(frame.header["revision"], evaluated["shapes"][0]["revision"]);
    for file in ["both.glb", "both.ply"] {
        let exported = page.ok(json!({ "do": "export", "of": "both", "file": file }));
        assert_eq!(exported["path"], file);
        page.ok(json!({ "do": "save", "path": "model.toml" }));
        let out = tempfile::tempdir().unwrap();
        let again = replayed(&folder.path().join("model.toml"), out.path());
        assert!(fs::read(folder.path().join(file)).unwrap() == again, "{file}");
        assert!(get(server.address(), &format!("/file?path={file}"), &[]).1 == again, "{file}");
        page.ok(json!({ "do": "undo" }));
    }
}

/// The frame is the exact mesh, shifted and rounded, in the same order.
#[test]
fn frames_are_the_exact_mesh_near_the_origin() {
    let folder = tempfile::tempdir().unwrap();
    let far = fusion::mesh_core::shapes::posed(
        fusion::mesh_core::shapes::icosphere(1.0, 2),
        glam::DQuat::IDENTITY,
        glam::DVec3::new(4e6, -5e6, 6e6),
    );
    mesh_io::write(&far.clone().into(), &folder.path().join("far.ply")).unwrap();
    let mut options = Options::default();
    options.root = Some(folder.path().into());
    let server = Server::start(&options).unwrap();
    let mut page = Client::connect(server.address());
    let version = page.ok(json!({ "do": "add_part", "mesh": "far.ply" }))["version"].clone();
    page.evaluated(&version);
    let frame = &page.shapes["far"];
    let origin: [f64; 3] = serde_json::from_value(frame.header["origin"].clone()).unwrap();
    let origin = glam::DVec3::from(origin);
    for (drawn, exact) in frame.f32("positions").chunks_exact(3).zip(&far.positions) {
        let drawn = glam::DVec3::new(drawn[0].into(), drawn[1].into(), drawn[2].into());
        assert!((origin + drawn).distance(*exact) < 1e-6, "{drawn} {exact}");
    }
    assert_eq!(frame.u32("faces"), far.faces.as_flattened().iter().map(|v| v.0).collect::<Vec<_>>());
    assert!(frame.u32("face_origin").iter().all(|&part| part == 1));
    let picked = page.ok(json!({ "do": "pick", "shape": "far", "face": 5, "bary": [1, 0, 0] }))["point"].clone();
    assert_eq!(picked, json!(far.positions[far.faces[5][0].index()].to_array()));
}

/// A volume, from a frame alone.
fn drawn_volume(frame: &crate::client::Frame) -> f64 {
    let p = frame.f32("positions");
    let at = |v: u32| glam::DVec3::from_array([0, 1, 2].map(|k| f64::from(p[3 * v as usize + k])));
    frame.u32("faces").chunks_exact(3).map(|f| at(f[0]).dot(at(f[1]).cross(at(f[2]))) / 6.0).sum()
}

#[test]
fn only_what_changed_is_sent_and_every_client_sees_it() {
    let folder = tempfile::tempdir().unwrap();
    let (server, mut one) = union_of_balls(folder.path());
    let mut other = Client::connect(server.address());
    other.wait(|e| e["event"] == "evaluated");
    assert_eq!(other.shapes["both"].header, one.shapes["both"].header);
    let version = one.ok(json!({ "do": "add_part", "mesh": "one.obj", "name": "alone" }))["version"].clone();
    one.evaluated(&version);
    other.evaluated(&version);
    let before = (one.frames, other.frames);
    let add = json!({ "do": "set", "table": "part", "index": 2, "key": "translate", "value": [5, 0, 0] });
    let version = other.ok(add)["version"].clone();
    one.evaluated(&version);
    other.evaluated(&version);
    assert_eq!((one.frames, other.frames), (before.0 + 1, before.1 + 1), "the union is not sent again");
    let smaller = drawn_volume(&one.shapes["both"]);
    let set = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": 0.2 });
    let version = one.ok(set)["version"].clone();
    other.evaluated(&version);
    assert!(drawn_volume(&other.shapes["both"]) > smaller, "a larger fillet fills more of the groove");
    other.ok(json!({ "do": "show", "names": ["part:two", "step:0"] }));
    let shown = other.wait(|e| e["event"] == "evaluated" && e["shapes"].as_array().unwrap().len() == 4);
    assert_eq!(shown["shapes"][3]["result"], false);
    assert!(other.shapes.contains_key("part:two"));
}

#[test]
#[ignore = "rewritten and not yet run: a radius that is too large is reduced, and fails nothing"]
fn a_step_that_fails_says_why_and_what_would_work() {
    let folder = tempfile::tempdir().unwrap();
    let (_server, mut page) = union_of_balls(folder.path());
    let before = page.shapes["both"].header.clone();
    page.ok(json!({ "do": "add_step", "verb": "blend", "of": ["both"], "options": { "angle": 170, "radius": 0.01 } }));
    let failed = page.wait(|e| e["event"] == "failed");
    assert_eq!(failed["step"], 1);
    assert!(failed["sentence"].as_str().unwrap().starts_with("step 2, blend of both: "), "{failed}");
    assert_eq!(page.shapes["both"].header, before, "the last result stays");
    assert_eq!(failed["remedy"]["edit"]["key"], "angle", "{failed}");
    let version = page.ok(json!({ "do": "undo" }))["version"].clone();
    page.evaluated(&version);
    let gone = page.refused(json!({ "do": "set", "table": "step", "index": 0, "key": "radios", "value": 1 }));
    assert!(gone.contains("did you mean `radius`"), "{gone}");
    let none = page.refused(json!({ "do": "remove", "table": "part", "index": 0 }));
    assert!(none.contains("there is no shape `one`"), "{none}");
}

#[test]
fn questions_about_shapes_are_answered_from_the_exact_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let (_server, mut page) = union_of_balls(folder.path());
    let off = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": null });
    let version = page.ok(off)["version"].clone();
    page.evaluated(&version);
    let listed = page.ok(json!({ "do": "curves", "shape": "both", "angle": 20 }));
    let [curve] = &listed["curves"].as_array().unwrap()[..] else { panic!("{listed}") };
    assert_eq!((&curve["closed"], &curve["convex"], &curve["seam"]), (&json!(true), &json!(false), &json!(true)));
    // Unit balls at distance d cross in a circle of radius √(1 − d²/4).
    let d2 = 0.9f64.powi(2) + 0.31f64.powi(2) + 0.17f64.powi(2);
    let circle = std::f64::consts::TAU * (1.0 - d2 / 4.0).sqrt();
    let length = curve["length"].as_f64().unwrap();
    assert!((length / circle - 1.0).abs() < 0.02, "{length} {circle}");
    // A blended union still tells the seam that it was blended along.
    let seams = page.ok(json!({ "do": "curves", "step": 0 }));
    let set = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": 0.1 });
    let version = page.ok(set)["version"].clone();
    page.evaluated(&version);
    assert_eq!(page.ok(json!({ "do": "curves", "step": 0 })), seams);
    assert_eq!((&seams["curves"][0]["length"], &seams["curves"][0]["convex"]), (&curve["length"], &json!(false)));
    page.ok(json!({ "do": "undo" }));
    let largest = page.ok(json!({ "do": "max_radius", "step": 0, "curves": [0] }));
    let again = page.ok(json!({ "do": "max_radius", "shape": "both", "curves": [curve["id"]], "angle": 20 }));
    let [a, b] = [&largest, &again].map(|r| r["radius"].as_f64().unwrap());
    assert!(a > 0.1 && (a / b - 1.0).abs() < 0.02, "{largest} {again}");
    let info = page.ok(json!({ "do": "info", "shape": "both" }));
    assert_eq!(
        (&info["closed"], &info["self_intersections"], &info["crossings"]),
        (&json!(true), &json!(0), &json!([]))
    );
    assert_eq!(page.ok(json!({ "do": "loops", "shape": "both" }))["loops"], json!([]));
    let across = page.ok(json!({
        "do": "measure", "shape_a": "part:one", "face_a": 0, "bary_a": [1, 0, 0], "shape_b": "part:one", "face_b": 0, "bary_b": [0, 1, 0]
    }));
    let ball = mesh_io::read(&folder.path().join("one.obj")).unwrap().mesh;
    let [p, q] = [0, 1].map(|k| ball.positions[ball.faces[0][k].index()]);
    assert_eq!(across["distance"], p.distance(q));
    assert_eq!(across["angle"], 0.0);
    page.ok(json!({ "do": "curvature", "shape": "part:one" }));
    let curvature = page.shapes["curvature"].f32("values");
    assert!(curvature.iter().all(|h| (h - 1.0).abs() < 0.05), "a ball of radius 1");
    page.ok(json!({ "do": "quality", "shape": "part:one" }));
    assert!(page.shapes["quality"].f32("values").iter().all(|&q| q > 0.7 && q <= 1.0));
    assert!(Connected::new(&ball).is_ok() && volume(&ball) > 4.0);
    let old = page.refused(json!({ "do": "pick", "shape": "both", "revision": "0", "face": 0, "bary": [1, 0, 0] }));
    assert_eq!(old, "`both` has changed");
}
