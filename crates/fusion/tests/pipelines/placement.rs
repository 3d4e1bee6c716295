//! Parts on primitives, and parts that snap to openings.

use fusion::Error;
use fusion::document::{Cache, Document, Given, Precisions};
use fusion::mesh_core::{TriMesh, Watch, shapes, topology};
use glam::DVec3;
use std::sync::Arc;

fn run(body: &str, parts: &[TriMesh]) -> Result<TriMesh, Error> {
    let document = Document::parse(&format!("version = 2\n{body}"))?;
    let mut given = Given::default();
    for (name, mesh) in ["a.off", "b.off"].into_iter().zip(parts) {
        given.0.insert(name.into(), Arc::new(mesh.clone().into()));
    }
    let made = document.evaluate_from(&mut given, &Cache::default(), Precisions::ByFile, &Watch::default())?;
    assert_eq!(made.outputs.len(), 1, "all in one shape");
    Ok(made.outputs[0].outcome.model.mesh.clone())
}

fn middle(mesh: &TriMesh) -> DVec3 {
    mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64
}

/// A box on a primitive: its middle and its upward edge.
fn rider(primitive: &str, on: &str) -> [DVec3; 2] {
    let text = format!(
        "[[part]]\nname = \"a\"\nmesh = \"a.off\"\non = {{ primitive = \"p\", {on} }}\n[primitive.p]\n{primitive}"
    );
    let made = run(&text, &[shapes::cuboid(DVec3::new(0.1, 0.2, 0.3))]).unwrap();
    let longest = made.faces.iter().flat_map(|f| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]]);
    let edge = |[a, b]: [fusion::mesh_core::VertexId; 2]| made.positions[b.index()] - made.positions[a.index()];
    let up = longest.map(edge).find(|e| (e.length() - 0.3).abs() < 1e-12).unwrap();
    [middle(&made), up.normalize()]
}

/// What rides follows when the primitive is resized, and stands upright on it.
#[test]
fn riders_follow_their_primitive() {
    for r in [1.0, 2.5] {
        let [at, up] =
            rider(&format!("shape = \"sphere\"\nradius = {r:?}\nbase = [1, 2, 3]"), "at = [0.25, 0.5], offset = 0.5");
        assert!(
            at.distance(DVec3::new(1.0, 2.0 + r + 0.5, 3.0)) < 1e-12 && up.cross(DVec3::Y).length() < 1e-12,
            "{at} {up}"
        );
    }
    for h in [1.0, 3.0] {
        let [at, _] =
            rider(&format!("shape = \"cone\"\nradius = [2.0, 1.0]\nheight = {h:?}\naxis = [0, 1, 0]"), "at = [0, 0.5]");
        assert!(at.distance(DVec3::new(1.5, 0.5 * h, 0.0)) < 1e-12, "{at}");
        let [at, up] =
            rider(&format!("shape = \"cylinder\"\nradius = 1.0\nheight = {h:?}"), "at = [0.3, 2], offset = 1");
        assert!(at.distance(DVec3::new(0.0, 0.0, h + 1.0)) < 1e-12 && up.cross(DVec3::Z).length() < 1e-12, "{at}");
    }
    let [at, up] = rider("shape = \"box\"\nsize = [2, 4, 6]", "at = [0, 0.5], spin = 30");
    assert!(at.distance(DVec3::new(1.0, 0.0, 3.0)) < 1e-12 && up.cross(DVec3::X).length() < 1e-12, "{at} {up}");
}

/// A sphere on a cone on an opening: all of it follows the opening's part.
#[test]
fn primitives_stand_on_openings_and_on_each_other() {
    let made = |lift: f64| {
        let text = format!(
            "[[part]]\nname = \"rider\"\nmesh = \"a.off\"\n\
             [[part]]\nname = \"cup\"\nmesh = \"b.off\"\n\
             [[step]]\ndo = \"cut\"\nof = \"cup\"\nplane = {{ point = [0, 0, 0.5], normal = [0, 0, 1] }}\n\
             [[step]]\ndo = \"pose\"\nof = \"cup\"\ntranslate = [0, 0, {lift:?}]\n\
             [[step]]\ndo = \"pose\"\nof = \"rider\"\non = {{ primitive = \"ball\", at = [0, 1] }}\n\
             [primitive.neck]\nshape = \"cone\"\nloop = \"cup:0\"\nheight = 2.0\n\
             [primitive.ball]\nshape = \"sphere\"\nradius = 0.5\non = {{ primitive = \"neck\", at = [0, 2] }}\nbase = [0, 0, 0.5]\n\
             [[step]]\ndo = \"compose\"\nof = [\"cup\"]\n[[step]]\ndo = \"union\"\nof = [\"rider\", \"cup\"]\n"
        );
        run(&text, &[shapes::icosphere(3.0, 2), shapes::icosphere(1.0, 3)]).unwrap()
    };
    // The rider's middle is at 0.5 (the cut), plus the cone, plus the ball; it is large enough to swallow the cup.
    for lift in [0.0, 1.5] {
        let whole = made(lift);
        let top = whole.positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
        assert!((top - (lift + 0.5 + 2.0 + 1.0 + 3.0)).abs() < 1e-6, "{top}");
    }
}

/// Two half balls, one anywhere, snap rim to rim and join to one closed body.
#[test]
fn openings_snap_together() {
    let half = |name: &str, extra: &str| {
        format!(
            "[[part]]\nname = \"{name}\"\nmesh = \"a.off\"\n[[step]]\ndo = \"cut\"\nof = \"{name}\"\nplane = {{ point = [0, 0, 0.1], normal = [0, 0, 1] }}\n\
             [[step]]\ndo = \"pose\"\nof = \"{name}\"\n{extra}\n"
        )
    };
    let loose =
        "translate = [3, -2, 1]\nrotate = { axis = [1, 2, 3], angle = 77 }\nsnap = { to = \"low:0\", gap = 0.4 }";
    let text = [half("low", ""), half("high", loose), "[[step]]\ndo = \"compose\"\n".into()].concat();
    let ball = shapes::icosphere(1.0, 3);
    let made = run(&text, &[ball.clone(), ball]).unwrap();
    let counts = topology(&fusion::mesh_core::Connected::new(&made).unwrap());
    assert_eq!((counts.components, counts.boundary_loops, counts.genus()), (1, 0, 0));
    // Rims at 0.1 and 0.5, then the other's 1.1 of height.
    let top = made.positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
    assert!((top - 1.6).abs() < 0.02, "{top}");
    let off = made.positions.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    assert!(off < 1.05, "{off}");
}

#[test]
fn places_that_cannot_be_are_named() {
    let part = |extra: &str| format!("[[part]]\nname = \"a\"\nmesh = \"a.off\"\n{extra}\n");
    let ball = "[primitive.p]\nshape = \"sphere\"\nradius = 1.0\n";
    for (text, says) in [
        (part("on = { primitive = \"q\", at = [0, 0] }") + ball, "no [primitive.q]"),
        (part("") + "[primitive.p]\nshape = \"ball\"\nradius = 1.0\n", "box, cylinder, sphere or cone"),
        (part("") + "[primitive.p]\nshape = \"cone\"\nradius = [1.0, -1.0]\nheight = 1.0\n", "radius"),
        (part("") + "[primitive.p]\nshape = \"box\"\n", "size"),
        (part("") + "[primitive.p]\nshape = \"sphere\"\nradius = 1.0\nloop = \"b:0\"\n", "no shape `b`"),
        (part("snap = { to = \"b:0\" }"), "no shape `b`"),
        (part("snap = { to = \"a:0\" }"), "circle"),
        (
            part("on = { primitive = \"p\", at = [0, 0] }")
                + "[primitive.p]\nshape = \"sphere\"\nradius = 1.0\non = { primitive = \"p\", at = [0, 0] }\n",
            "circle",
        ),
    ] {
        let error = run(&text, &[shapes::cuboid(DVec3::ONE)]).unwrap_err();
        assert!(matches!(&error, Error::Document(e) if e.to_string().contains(says)), "{says}: {error}");
    }
}
