//! Pieces of analytic surfaces, rejoined along the surface they were cut from.

use glam::DVec3;
use lmc_tessellate::{Error, Params, Rim, Transition, suggested_cell, tessellate};
use mesh_core::{Connected, Faces, TriMesh, VertexId, Watch, boundary_loops, centroid, shapes, topology, volume};
use proptest::prelude::*;

/// The faces whose centroid passes.
fn part(mesh: &TriMesh, keep: impl Fn(DVec3) -> bool) -> Connected<TriMesh> {
    let middle = |f: &[VertexId; 3]| centroid(f.map(|v| mesh.positions[v.index()]));
    let faces = mesh.faces.iter().filter(|f| keep(middle(f))).copied().collect();
    let (whole, _) = mesh_core::split(&TriMesh { positions: mesh.positions.clone(), faces });
    Connected::new(whole).unwrap()
}

/// Rims of a mesh, and the ids of their vertices.
fn rims(mesh: &Connected<TriMesh>) -> (Vec<Rim>, Vec<VertexId>) {
    let walks = boundary_loops(mesh);
    let ids = walks.iter().flatten().map(|&h| mesh.tail(h)).collect();
    (walks.iter().map(|w| Rim::of(mesh, w)).collect(), ids)
}

/// The part and the transition as one mesh.
fn weld(part: &Connected<TriMesh>, ids: &[VertexId], transition: &Transition) -> Connected<TriMesh> {
    let mut mesh = part.mesh().clone();
    let shift = mesh.positions.len() as u32;
    let n = ids.len();
    mesh.positions.extend(&transition.mesh.positions[n..]);
    let id = |v: VertexId| ids.get(v.index()).copied().unwrap_or_else(|| VertexId(v.0 - n as u32 + shift));
    mesh.faces.extend(transition.mesh.faces.iter().map(|f| f.map(id)));
    Connected::new(mesh).unwrap()
}

fn batched(f: impl Fn(DVec3) -> f64 + Sync) -> impl Fn(&[DVec3], &mut [f64]) + Sync {
    move |points: &[DVec3], values: &mut [f64]| values.iter_mut().zip(points).for_each(|(v, &p)| *v = f(p))
}

fn rejoin(
    whole: &TriMesh,
    keep: impl Fn(DVec3) -> bool,
    f: impl Fn(DVec3) -> f64 + Sync,
    cell: Option<f64>,
) -> Result<(Connected<TriMesh>, Transition), Error> {
    let open = part(whole, keep);
    let (rims, ids) = rims(&open);
    let cell = cell.unwrap_or_else(|| suggested_cell(&rims));
    let made = tessellate(&rims, &batched(f), &Params { cell, space: 4.0, ..Params::default() }, &Watch::default())?;
    Ok((weld(&open, &ids, &made), made))
}

fn ball(p: DVec3) -> f64 {
    p.length() - 1.0
}

fn assert_whole(mesh: &Connected<TriMesh>, genus: i64) {
    let t = topology(mesh);
    assert_eq!((t.boundary_loops, t.components, t.genus()), (0, 1, genus));
}

#[test]
fn two_caps_rejoin_to_a_ball() {
    let (mesh, made) = rejoin(&shapes::icosphere(1.0, 4), |p| p.z.abs() > 0.5, ball, None).unwrap();
    assert_whole(&mesh, 0);
    assert!(made.mesh.positions.iter().all(|p| ball(*p).abs() < 1e-4));
    assert!((volume(&mesh) - 4.0 * std::f64::consts::PI / 3.0).abs() < 0.03, "{}", volume(&mesh));
}

/// Two parts of a ball with openings at any distance, in cells: all round, and on one side only.
#[test]
fn bands_of_any_width_are_closed() {
    let cap = |steps: u32, from: f64| {
        // A cylinder's rows of points moved to even latitudes, closed at the pole.
        let mut mesh = shapes::open_cylinder(1.0, 1.0, steps, 12);
        for p in &mut mesh.positions {
            let (sin, cos) = (from + (1.45 - from) * (p.z + 0.5)).sin_cos();
            *p = (cos * p.truncate().normalize()).extend(sin);
        }
        let (top, pole) = (12 * steps, VertexId(13 * steps));
        mesh.positions.push(DVec3::Z);
        mesh.faces.extend((0..steps).map(|i| [VertexId(top + i), VertexId(top + (i + 1) % steps), pole]));
        mesh
    };
    for cells in [0.3, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 10.0] {
        for tilt in [0.0, 0.1, 0.4] {
            for steps in [64, 17] {
                let gap = cells * 0.8 * std::f64::consts::TAU / 64.0;
                let low = shapes::posed(cap(64, 0.0), glam::DQuat::from_rotation_x(std::f64::consts::PI), DVec3::ZERO);
                let high = shapes::posed(cap(steps, gap + tilt), glam::DQuat::from_rotation_y(tilt), DVec3::ZERO);
                let mut both = low;
                both.append(&high);
                let (mesh, _) =
                    rejoin(&both, |_| true, ball, None).unwrap_or_else(|e| panic!("{cells} {tilt} {steps}: {e}"));
                assert_whole(&mesh, 0);
            }
        }
    }
}

#[test]
fn six_caps_rejoin() {
    let keep = |p: DVec3| p.abs().max_element() > 0.85;
    let (mesh, _) = rejoin(&shapes::icosphere(1.0, 5), keep, ball, None).unwrap();
    assert_whole(&mesh, 0);
}

#[test]
fn tori_keep_their_genus() {
    let torus = |p: DVec3| (p.truncate().length() - 2.0).hypot(p.z) - 0.7;
    let whole = shapes::torus(2.0, 0.7, 96, 36);
    for keep in
        [|p: DVec3| p.x > 0.3, |p: DVec3| p.x.abs() > 1.0, |p: DVec3| p.x > 2.5, |p: DVec3| p.z > 0.2 || p.z < -0.3]
    {
        let (mesh, _) = rejoin(&whole, keep, torus, None).unwrap();
        assert_whole(&mesh, 1);
    }
}

/// Vertices between the rims lie on the zero set; without root finding they are off by the square of the cell.
#[test]
fn linear_placement_converges() {
    let open = part(&shapes::icosphere(1.0, 4), |p| p.z.abs() > 0.6);
    let (rims, _) = rims(&open);
    let worst = |cell: f64| {
        let params = Params { cell, steps: 0, ..Params::default() };
        // Not a distance, so that linear interpolation errs along the edges too.
        let field = batched(|p: DVec3| p.length_squared() - 1.0 + 0.2 * (p.length() - 1.0) * (7.0 * p.x).sin());
        let made = tessellate(&rims, &field, &params, &Watch::default()).unwrap();
        made.mesh.positions.iter().map(|p| ball(*p).abs()).fold(0.0, f64::max)
    };
    let errors = [0.08, 0.04, 0.02].map(worst);
    assert!(errors[0] / errors[1] > 3.0 && errors[1] / errors[2] > 3.0, "{errors:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// Two caps with room between them, turned anyhow, rejoin to the ball.
    #[test]
    fn any_caps_rejoin_to_the_ball(
        heights in prop::array::uniform2(0.65f64..0.85),
        turn in prop::array::uniform3(-3.0f64..3.0),
    ) {
        let turn = glam::DQuat::from_scaled_axis(turn.into());
        let axes = [DVec3::X, DVec3::new(-0.5, 0.75f64.sqrt(), 0.0)];
        let caps = [(turn * axes[0], heights[0]), (turn * axes[1], heights[1])];
        let keep = |p: DVec3| caps.iter().any(|(axis, h)| p.normalize().dot(*axis) > *h);
        let (mesh, made) = rejoin(&shapes::icosphere(1.0, 4), keep, ball, None).unwrap();
        assert_whole(&mesh, 0);
        let off = made.mesh.positions.iter().map(|p| ball(*p).abs()).fold(0.0, f64::max);
        prop_assert!(off < 2e-3, "{off:e}");
        prop_assert!((volume(&mesh) - 4.0 * std::f64::consts::PI / 3.0).abs() < 0.03, "{}", volume(&mesh));
    }
}
