//! Pictures against what geometry says must be in them.

use glam::DVec3;
use mesh_core::{TriMesh, VertexId, Watch, shapes};
use proptest::prelude::*;
use render::{Color, Error, Ground, Params, Picture, Projection, Shading, Wireframe, picture};
use std::f64::consts::PI;

const GREEN: [f64; 3] = [0.0, 1.0, 0.0];

/// A small picture on a green screen.
fn studio() -> Params {
    Params {
        width: 120,
        height: 120,
        background: [GREEN; 2],
        ground: Ground::None,
        ambient_samples: 2,
        ..Params::default()
    }
}

fn draw(mesh: &TriMesh, params: &Params) -> Picture {
    picture(mesh, params, &Watch::default()).unwrap()
}

/// How much of a picture is not background.
fn covered(picture: &Picture) -> f64 {
    picture.pixels().filter(|p| *p != [0, 255, 0]).count() as f64
}

#[test]
fn a_sphere_covers_its_disc() {
    // Parallel rays: a disc of radius 0.43 of the height, whatever the sphere's size and place.
    for (size, offset) in [(1.0, 0.0), (1e200, 0.0), (1e-200, 0.0), (1.0, 1e9)] {
        let mut sphere = shapes::icosphere(1.0, 5);
        sphere.positions.iter_mut().for_each(|p| *p = *p * size + offset);
        let params = Params { projection: Projection::Orthographic, ..studio() };
        let radius = 0.43 * 120.0;
        let disc = PI * radius * radius;
        let found = covered(&draw(&sphere, &params));
        // Every pixel touched counts: up to one ring too many.
        assert!(found >= disc && found <= disc + 2.0 * PI * (radius + 2.0), "{found} {disc} at {size}, {offset}");
    }
}

#[test]
fn light_moves_with_the_camera() {
    let cube = shapes::cuboid(DVec3::splat(2.0));
    let front = draw(&cube, &Params { view: DVec3::Z, ..studio() });
    for view in [DVec3::NEG_Z, DVec3::X, DVec3::NEG_X, 1e-300 * DVec3::Z] {
        assert!(front == draw(&cube, &Params { view, ..studio() }), "{view}");
    }
}

#[test]
fn straight_up_and_down_are_views() {
    let cube = shapes::cuboid(DVec3::new(2.0, 1.0, 2.0));
    for view in [DVec3::Y, DVec3::NEG_Y] {
        assert!(covered(&draw(&cube, &Params { view, ..studio() })) > 0.5 * 120.0 * 120.0);
    }
}

#[test]
fn the_picture_frames_wide_and_tall_models() {
    let bar = shapes::cuboid(DVec3::new(10.0, 1.0, 1.0));
    for (width, height) in [(200, 50), (50, 200)] {
        for projection in [Projection::Orthographic, Projection::default()] {
            let seen = draw(&bar, &Params { width, height, projection, ..studio() });
            let border = |x: u32, y: u32| x == 0 || y == 0 || x == width - 1 || y == height - 1;
            let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
            assert!(places.filter(|&(x, y)| border(x, y)).all(|(x, y)| seen.pixel(x, y) == Some([0, 255, 0])));
            assert!(covered(&seen) > 100.0);
        }
    }
}

#[test]
fn threads_change_nothing() {
    let sphere = shapes::icosphere(1.0, 4);
    let params = Params {
        color: Color::Curvature,
        wireframe: Some(Wireframe::default()),
        ground: Ground::Shadow,
        ambient_samples: 4,
        ..studio()
    };
    let run = |threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| draw(&sphere, &params))
    };
    assert!(run(1) == run(2));
}

#[test]
fn inside_out_shows() {
    let sphere = shapes::icosphere(1.0, 3);
    let mut flipped = sphere.clone();
    flipped.faces.iter_mut().for_each(|f| f.swap(0, 1));
    let middle = |mesh| draw(mesh, &studio()).pixel(60, 60).unwrap();
    let ([r, _, b], [fr, _, fb]) = (middle(&sphere), middle(&flipped));
    assert!(b > r && fr > fb, "blue-grey outside, red inside");
}

#[test]
fn smooth_shading_hides_facets_and_keeps_creases() {
    let steps = |mesh: &TriMesh, shading| {
        let seen = draw(mesh, &Params { shading, ambient_samples: 0, view: DVec3::new(1.0, 1.0, 1.2), ..studio() });
        // The largest step between neighbouring pixels well inside.
        let level = |x: u32, y: u32| i32::from(seen.pixel(x, y).unwrap()[1]);
        (40..80).flat_map(|y| (40..80).map(move |x| (level(x, y) - level(x + 1, y)).abs())).max().unwrap()
    };
    let sphere = shapes::icosphere(1.0, 2);
    assert!(steps(&sphere, Shading::default()) <= 4);
    assert!(steps(&sphere, Shading::Flat) >= 8);
    assert!(steps(&shapes::cuboid(DVec3::ONE), Shading::default()) >= 8);
}

#[test]
fn colours_are_those_asked_for() {
    let mut two = shapes::icosphere(1.0, 3);
    let count = two.faces.len();
    let red = Color::PerFace(vec![[1.0, 0.0, 0.0]; count]);
    let params = |color| Params { color, ..studio() };
    let [r, g, b] = draw(&two, &params(red)).pixel(60, 60).unwrap();
    assert!(r > 150 && g < 80 && b < 80, "{r} {g} {b}");
    let same = Color::PerVertex(vec![[1.0, 0.0, 0.0]; two.positions.len()]);
    assert_eq!([r, g, b], draw(&two, &params(same)).pixel(60, 60).unwrap());
    // A sphere bulges everywhere, seen from outside.
    let [r, _, b] = draw(&two, &params(Color::Curvature)).pixel(60, 60).unwrap();
    assert!(r > b);
    two.faces.truncate(10);
    let refused = picture(&two, &params(Color::Origin(vec![0; 9])), &Watch::default());
    assert!(matches!(refused, Err(Error::ColorCount { per: "faces", expected: 10, found: 9 })));
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let watch = Watch::default();
    let cube = shapes::cuboid(DVec3::ONE);
    let try_with = |mesh: &TriMesh, params: Params| picture(mesh, &params, &watch).unwrap_err();
    assert!(matches!(try_with(&TriMesh::default(), studio()), Error::Empty));
    assert!(matches!(try_with(&cube, Params { width: 0, ..studio() }), Error::Size { width: 0, .. }));
    for view in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert!(matches!(try_with(&cube, Params { view, ..studio() }), Error::View { .. }));
    }
    let mut broken = cube.clone();
    broken.positions[2].x = f64::NAN;
    assert!(matches!(
        try_with(&broken, studio()),
        Error::Mesh(mesh_query::Error::NotFinite { vertex: VertexId(2), .. })
    ));
    watch.cancel();
    assert!(matches!(try_with(&cube, studio()), Error::Cancelled(_)));
}

#[test]
fn degenerate_meshes_draw() {
    let point = TriMesh::from_arrays(vec![DVec3::splat(1e300); 3], [[0, 1, 2]]);
    let line = TriMesh::from_arrays(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], [[0, 1, 2], [0, 0, 1]]);
    for mesh in [point, line] {
        for color in [Color::Plain, Color::Curvature, Color::Quality, Color::Zebra] {
            let params = Params { color, wireframe: Some(Wireframe::default()), ..studio() };
            assert_eq!(draw(&mesh, &params).dimensions(), (120, 120));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever hangs together how, of any size and colour: a picture, and the same one from any number of threads.
    #[test]
    fn any_soup_is_drawn(
        points in prop::collection::vec(prop::array::uniform3(-1.0f64..1.0), 3..20),
        corners in prop::collection::vec(prop::array::uniform3(0usize..20), 1..30),
        power in -300i32..300,
        view in prop::array::uniform3(-1.0f64..1.0),
        color in prop::sample::select(vec![Color::Curvature, Color::Quality, Color::Zebra]),
    ) {
        let positions: Vec<DVec3> = points.iter().map(|p| 2f64.powi(power) * DVec3::from(*p)).collect();
        let faces = corners.iter().map(|f| f.map(|v| (v % positions.len()) as u32)).collect::<Vec<_>>();
        let mesh = TriMesh::from_arrays(positions, faces);
        let params = Params { width: 24, height: 16, view: view.into(), color, ..studio() };
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| picture(&mesh, &params, &Watch::default()))
        });
        let (one, two) = (one.unwrap(), two.unwrap());
        prop_assert_eq!(one.dimensions(), (24, 16));
        prop_assert!(one == two);
    }
}
