//! How long a dragged radius takes: two blobs of 20 480 triangles each, their union, its seam's fillet. Prints for every value the engine's
//! time, the time until the page would have its triangles, and what the engine did.
//!
//! `cargo run --release -p fusion-studio --example drag`

#[path = "../tests/studio/client.rs"]
#[allow(dead_code)]
mod client;

use client::Client;
use fusion::mesh_core::shapes;
use glam::{DQuat, DVec3};
use serde_json::json;
use std::time::Instant;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let blob = |radius, seed, at| shapes::posed(shapes::blob(radius, 5, 0.35, seed), DQuat::IDENTITY, at).into();
    mesh_io::write(&blob(1.0, 7, DVec3::ZERO), &folder.path().join("one.ply")).unwrap();
    mesh_io::write(&blob(0.75, 12, DVec3::new(1.05, 0.45, 0.2)), &folder.path().join("two.ply")).unwrap();
    let mut options = fusion_studio::Options::default();
    options.root = Some(folder.path().into());
    options.files = ["one.ply", "two.ply"].map(|name| folder.path().join(name)).to_vec();
    let server = fusion_studio::Server::start(&options).unwrap();
    let mut page = Client::connect(server.address());
    let options = json!({ "radius": 0.08 });
    let step = json!({ "do": "add_step", "verb": "union", "of": ["one", "two"], "as": "both", "options": options });
    let version = page.ok(step)["version"].clone();
    page.evaluated(&version);
    let (mut engine, mut whole) = (vec![], vec![]);
    for n in 0..20 {
        let start = Instant::now();
        let radius = 0.081 + 0.001 * f64::from(n);
        let set = json!({ "do": "set", "table": "step", "index": 0, "key": "radius", "value": radius, "drag": 1 });
        let version = page.ok(set)["version"].clone();
        let made = page.evaluated(&version);
        let took = 1e3 * start.elapsed().as_secs_f64();
        engine.push(made["milliseconds"].as_f64().unwrap());
        whole.push(took);
        let stages = made["steps"][0]["report"]["stages"].as_array().unwrap().iter();
        let stages: Vec<String> = stages
            .map(|s| format!("{} {:.1}", s["name"].as_str().unwrap(), s["milliseconds"].as_f64().unwrap()))
            .collect();
        println!("{radius:.3}: engine {:6.1} ms, page {took:6.1} ms; {}", engine.last().unwrap(), stages.join(", "));
    }
    let median = |times: &mut Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    println!("median: engine {:.1} ms, page {:.1} ms", median(&mut engine), median(&mut whole));
}
