//! The rolling-ball blend of boolean seams against closed forms: planes, spheres and cylinders that cross in circles,
//! and pairs of perpendicular cylinders, with the ball outside (valleys) and inside (ridges).
//!
//! | file | holds |
//! |---|---|
//! | `truth.rs` | the exact ball's way and the canal surface around it |
//! | `cases.rs` | the solids, at any resolution, in a generic pose |
//! | `measure.rs` | errors and angles of a result against the truth |
//! | `mod.rs` | bounds, order, validity and locality of every case |
//! | `balls.rs` | balls against the input's triangles |
//! | `volume.rs` | material added and taken |
//! | `curvature.rs` | jumps of curvature at the linkages |
//! | `field.rs` | the blend as a field |
//! | `symmetry.rs` | threads, order of the parts, quarter turns |
//!
//! `cargo test -p fusion --test pipelines analytic -- --nocapture` prints the figures.

mod balls;
mod cases;
mod curvature;
mod field;
mod measure;
mod symmetry;
mod truth;
mod volume;

use cases::Pair::{Branch, Cross, PlateCylinder, PlateSphere, Spheres};
use cases::{COARSE, Case, Pair, RADIUS, SMALLER};
use fusion::blend;
use measure::{Measured, Run, measure, run};
use mesh_core::{FaceOrigin, Faces, Positions, VertexOrigin, Watch, validate};
use tri_intersect::Operation::{self, Difference, Intersection, Union};

/// What is asserted of a case beyond what holds for all.
struct Expect {
    /// Average order of convergence over two halvings, of the maximum and of the root mean square.
    order: f64,
    /// By how many facet angles a blend face at the linkage may be turned from the kept face beside it, besides half
    /// the turn of the exact blend across it.
    facets: f64,
}

/// What the closed form asks for. Where the ball is inside a curved part, its feet jump over the edges between facets and
/// the blend's normals there miss the facets' by more; such cases state by how much.
const EXACT: Expect = Expect { order: 1.8, facets: 1.0 };

/// Three resolutions of one case: bounds, order, validity, locality, normals.
fn check(name: &str, pair: Pair, operation: Operation, expect: &Expect) {
    let measured: Vec<Measured> = [1, 2, 4]
        .map(|k| {
            let case = Case::new(pair, operation, k * COARSE, RADIUS);
            let run = run(&case, |_| {}).unwrap_or_else(|e| panic!("{name}: {e}"));
            let m = measure(&case, &run);
            println!("{name} | {} | {}", k * COARSE, row(&m, run.milliseconds));
            assert_valid(&run);
            assert!(assert_local(&case, &run) > 0 || k == 1, "{name}: nothing is out of reach");
            assert!(run.blended.residual <= 1e-9, "{name}: residual {}", run.blended.residual);
            assert!(
                run.blended.shrunk.is_empty() && run.blended.full_share == 1.0,
                "{name}: the ball was made smaller"
            );
            assert!(m.inner_share <= 1.0, "{name}: {m:?}");
            assert!(m.linkage_share <= 1.0, "{name}: {m:?}");
            assert!(m.kink_beyond_chord <= expect.facets * m.facet_angle, "{name}: {m:?}");
            m
        })
        .into();
    for (kind, get) in [("largest", 0), ("root mean square", 1)] {
        let order = 0.5 * (measured[0].inner[get] / measured[2].inner[get]).log2();
        println!("{name} | order of the {kind} error {order:.2}");
        assert!(order >= expect.order, "{name}: order of the {kind} error {order}");
    }
}

fn row(m: &Measured, ms: f64) -> String {
    format!(
        "sagitta {:.2e} | largest {:.2e}, share of the bound {:.2} | rms {:.2e} | linkage {:.2e}, {:.2}, drift {:.2e} | \
         facet {:.1}°, kink {:.1}°, beyond the chord {:.1}° | {ms:.1} ms",
        m.sagitta,
        m.inner[0],
        m.inner_share,
        m.inner[1],
        m.linkage[0],
        m.linkage_share,
        m.drift,
        m.facet_angle.to_degrees(),
        m.kink.to_degrees(),
        m.kink_beyond_chord.to_degrees(),
    )
}

fn assert_valid(run: &Run) {
    let report = validate(&run.blended.mesh);
    assert!(report.is_closed() && report.is_clean(), "{report}");
    let hits = tri_intersect::self_intersections(&run.blended.mesh, &Watch::default()).expect("finite");
    assert!(hits.is_empty(), "{hits:?}");
}

/// What the ball does not reach is the same, bit for bit. Returns how many vertices that is.
fn assert_local(case: &Case, run: &Run) -> usize {
    let (before, after) = (run.joined.mesh(), &run.blended.mesh);
    let origins = &run.blended.origins;
    let mut kept_vertices = vec![false; before.vertex_count()];
    for v in after.vertex_ids() {
        if let VertexOrigin::Input { part: 0, vertex } = origins.vertices[v] {
            assert!(!std::mem::replace(&mut kept_vertices[vertex.index()], true));
            assert_eq!(
                after.position(v).to_array().map(f64::to_bits),
                before.position(vertex).to_array().map(f64::to_bits)
            );
        }
    }
    let mut kept_faces = vec![false; before.face_count()];
    for f in after.face_ids() {
        if let FaceOrigin::Input { part: 0, face } = origins.faces[f] {
            assert!(!std::mem::replace(&mut kept_faces[face.index()], true));
            assert_eq!(after.triangle(f), before.triangle(face));
        }
    }
    // What is replaced is seen from the ball between its feet, and no farther away than the seam.
    let truth = &case.truth;
    let seam = run.curves.iter().flat_map(|c| c.points(&run.joined));
    let reach = 1.05 * seam.map(|p| truth.near(p).distance).fold(0.0, f64::max);
    let mut untouched = 0;
    for v in before.vertex_ids() {
        let near = truth.near(before.position(v));
        let middle = near.to_feet[0] + near.to_feet[1];
        let aside = middle.angle_between(near.to_point) - middle.angle_between(near.to_feet[0]);
        if near.distance > reach || aside > 0.2 {
            assert!(kept_vertices[v.index()], "{v:?} at {} is gone", before.position(v));
            untouched += 1;
        }
    }
    untouched
}

#[test]
fn plate_plus_sphere() {
    check("plate + sphere", PlateSphere, Union, &EXACT);
}

#[test]
fn plate_minus_sphere() {
    check("plate - sphere", PlateSphere, Difference, &EXACT);
}

#[test]
fn plate_and_sphere() {
    check("plate & sphere", PlateSphere, Intersection, &Expect { order: 1.75, facets: 2.0 });
}

#[test]
fn plate_plus_cylinder() {
    check("plate + cylinder", PlateCylinder, Union, &EXACT);
}

#[test]
fn plate_minus_cylinder() {
    check("plate - cylinder", PlateCylinder, Difference, &EXACT);
}

#[test]
fn plate_and_cylinder() {
    check("plate & cylinder", PlateCylinder, Intersection, &EXACT);
}

#[test]
fn sphere_plus_sphere() {
    check("sphere + sphere", Spheres, Union, &EXACT);
}

#[test]
fn sphere_minus_sphere() {
    check("sphere - sphere", Spheres, Difference, &Expect { facets: 1.5, ..EXACT });
}

#[test]
fn sphere_and_sphere() {
    check("sphere & sphere", Spheres, Intersection, &Expect { facets: 1.8, ..EXACT });
}

#[test]
fn cylinder_plus_branch() {
    check("cylinder + cylinder of 2/3", Branch(SMALLER), Union, &EXACT);
}

#[test]
fn cylinder_minus_cylinder() {
    check("cylinder of 2/3 - cylinder", Cross(SMALLER), Difference, &EXACT);
}

#[test]
fn cylinder_and_cylinder() {
    check("cylinder of 2/3 & cylinder", Cross(SMALLER), Intersection, &EXACT);
}

#[test]
fn equal_cylinders_apart() {
    check("cylinder - equal cylinder", Cross(1.0), Difference, &Expect { facets: 1.25, ..EXACT });
}

/// Where two equal cylinders touch, the ball touches both at one point: the blend has no width there.
#[test]
fn equal_cylinders_blend_or_are_refused_with_a_place() {
    for (pair, operation) in [(Branch(1.0), Union), (Cross(1.0), Intersection)] {
        for n in [COARSE, 2 * COARSE] {
            let case = Case::new(pair, operation, n, RADIUS);
            match run(&case, |p| p.overlap = blend::Overlap::Error) {
                Ok(run) => assert_valid(&run),
                Err(blend::Error::DoesNotFit { at, .. }) => {
                    // The tangent point is at y = ±1 in the case's frame.
                    let p = case.truth.pose.inverse().transform_point3(at);
                    assert!(p.with_y(p.y.abs()).distance(glam::DVec3::Y) < 4.0 * RADIUS, "{p}");
                }
                Err(e) => panic!("{e}"),
            }
        }
    }
}

/// Small and large balls, half an edge and several edges wide.
#[test]
fn bounds_hold_for_other_radii() {
    for r in [0.1, 0.4] {
        for (pair, operation) in [
            (PlateSphere, Union),
            (PlateSphere, Difference),
            (PlateCylinder, Union),
            (PlateCylinder, Intersection),
            (Spheres, Union),
            (Spheres, Difference),
            (Branch(SMALLER), Union),
            (Cross(SMALLER), Difference),
        ] {
            let case = Case::new(pair, operation, 2 * COARSE, r);
            let run = run(&case, |_| {}).unwrap_or_else(|e| panic!("{pair:?} {operation:?} {r}: {e}"));
            let m = measure(&case, &run);
            println!("{pair:?} {operation:?} r = {r} | {}", row(&m, run.milliseconds));
            assert_valid(&run);
            assert_local(&case, &run);
            assert!(run.blended.shrunk.is_empty() && run.blended.full_share == 1.0);
            assert!(m.inner_share <= 1.0 && m.linkage_share <= 1.0, "{pair:?} {operation:?} {r}: {m:?}");
        }
    }
}
