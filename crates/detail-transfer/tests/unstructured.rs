//! Vertex-by-vertex propagation.

use detail_transfer::{BaseParams, Detail, Exemplar, FanLength, Params, Relief, Search, fill_unstructured, transfer};
use glam::DVec3;
use mesh_core::{Connected, FaceMap, Faces, Stopwatch, TriMesh, Watch, centroid, shapes};

/// Band-limited noise: waves of one length in all directions.
fn noise(p: DVec3, wavelength: f64, seed: u32) -> f64 {
    let waves = (0..24u32).map(|k| {
        let turn = f64::from(k) * 2.399_963 + f64::from(seed);
        let length = wavelength * (0.8 + 0.4 * (f64::from(k) * 0.618).fract());
        let along = p.x * turn.cos() + p.y * turn.sin();
        (std::f64::consts::TAU * along / length + 1.7 * f64::from(k * k + seed)).sin()
    });
    waves.sum::<f64>() / 24f64.sqrt()
}

/// A square of side 2 with noise on it, of about n² vertices, vertices a little off the grid.
pub fn noisy(n: u32, height: f64, wavelength: f64) -> Connected<TriMesh> {
    let mut plane = shapes::grid(2.0, 2.0, n, n);
    let step = 2.0 / f64::from(n);
    for p in &mut plane.positions {
        if p.x.abs() < 0.999 && p.y.abs() < 0.999 {
            let jitter = |s: f64| 0.25 * step * (1e4 * (s * p.x + 3.1 * p.y) + 5.0 * s).sin();
            *p += DVec3::new(jitter(1.3), jitter(2.9), 0.0);
        }
        p.z = height * noise(*p, wavelength, 1);
    }
    Connected::new(plane).unwrap()
}

#[test]
#[ignore = "a measurement: run with --ignored --nocapture"]
fn time_ten_thousand() {
    let mesh = noisy(160, 0.01, 0.1);
    let middle = |f| centroid(mesh.mesh().triangle(f));
    let target: FaceMap<bool> = mesh.face_ids().map(|f| middle(f).x < -0.2).collect::<Vec<_>>().into();
    let source: FaceMap<bool> = mesh.face_ids().map(|f| middle(f).x > 0.22).collect::<Vec<_>>().into();
    let start = Stopwatch::start();
    let params = BaseParams::new(0.2);
    let [mut a, b] = [&target, &source].map(|r| Relief::encode(&mesh, r, &params, &Watch::default()).unwrap());
    println!("encode {:?}", start.elapsed());
    let free = a.interior();
    let known: Vec<Option<Detail>> = a.details().iter().zip(&free).map(|(d, f)| (!f).then_some(*d)).collect();
    println!("to fill {}, source {}", free.iter().filter(|f| **f).count(), b.interior().iter().filter(|f| **f).count());
    let sources = [(&b, vec![])];
    a.weigh(&sources);
    let start = Stopwatch::start();
    let exemplar = Exemplar { mesh: &mesh, inside: &source };
    let params = Params { wavelength: Some(0.2), fan: FanLength::Units(0.03), ..Params::default() };
    transfer(&mesh, &target, &[exemplar], &params, &Watch::default()).unwrap();
    println!("the whole transfer {:?}", start.elapsed());
    let mut both = vec![];
    for search in [Search::Indexed, Search::Exhaustive] {
        let mut details = known.clone();
        let start = Stopwatch::start();
        let filled = fill_unstructured(&a, &mut details, &sources, 0.03, search, &Watch::default()).unwrap();
        println!("jumps {}", filled.choices.iter().filter(|c| c.jump).count());
        println!("{search:?} {:?} {}", start.elapsed(), filled.choices.len());
        let mean = |f: &dyn Fn(&detail_transfer::Choice) -> f64| {
            filled.choices.iter().map(f).sum::<f64>() / filled.choices.len() as f64
        };
        println!("mean distance {} mean known {}", mean(&|c| c.distance), mean(&|c| f64::from(c.known)));
        both.push(filled);
    }
    assert_eq!(both[0], both[1]);
}
