//! How the length of geodesic fans changes what looks alike (\[Lin2008\] Fig. 14): one picture for each length, in model units.
//!
//! `cargo run --release -p fusion --example fan_lengths -- MESH X,Y,Z PREFIX LENGTH…`

use fusion::detail_transfer::{BaseParams, Relief, similarity};
use fusion::mesh_core::{Connected, FaceMap, Faces, VertexId, Watch, bounds};
use fusion::render;
use glam::DVec3;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, path, place, prefix, lengths @ ..] = &arguments[..] else {
        return Err("MESH X,Y,Z PREFIX LENGTH…".into());
    };
    let numbers: Vec<f64> = place.split(',').map(str::parse).collect::<Result<_, _>>()?;
    let at = DVec3::new(numbers[0], numbers[1], numbers[2]);
    let mesh = Connected::new(mesh_io::read(Path::new(path))?.mesh)?;
    let diagonal = bounds(&mesh).diagonal();
    let watch = Watch::default();
    let all = FaceMap::filled(mesh.face_count(), true);
    let relief = Relief::encode(&mesh, &all, &BaseParams::new(0.08 * diagonal), &watch)?;
    let positions = &mesh.mesh().positions;
    let distance = |i: &usize| positions[relief.vertices()[*i].index()].distance(at);
    let nearest = (0..relief.vertices().len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).ok_or("no vertex")?;
    for length in lengths {
        let unlike = similarity(&relief, VertexId::from(nearest), length.parse()?)?;
        let mut sorted: Vec<f64> = unlike.iter().copied().filter(|d| d.is_finite()).collect();
        sorted.sort_by(f64::total_cmp);
        // White is alike; the least similar half is all the same blue.
        let most = sorted[sorted.len() / 2].max(f64::MIN_POSITIVE);
        let mut colors = vec![[0.16, 0.27, 0.5]; positions.len()];
        for (v, d) in relief.vertices().iter().zip(&unlike) {
            let t = (d / most).min(1.0);
            colors[v.index()] = [[1.0, 0.16], [0.95, 0.27], [0.75, 0.5]].map(|[near, far]| near + t * (far - near));
        }
        colors[relief.vertices()[nearest].index()] = [0.85, 0.1, 0.1];
        let params =
            render::Params { width: 560, height: 560, color: render::Color::PerVertex(colors), ..Default::default() };
        render::save(&render::picture(mesh.mesh(), &params, &watch)?, format!("{prefix}{length}.png"))?;
    }
    Ok(())
}
