//! What the stages of a blend drew, as files.

use mesh_io::{Format, Model};
use rolling_blend::{Drawing, Sketch, meaning};

/// Everything drawn as OBJ files, curves as lines, with a list of them, `contents.txt`.
pub fn drawings_to_files(sketch: &Sketch) -> Vec<(String, Vec<u8>)> {
    let drawings = sketch.drawings();
    let line = |name: &String| format!("{:<28} {}\n", format!("{name}.obj"), meaning(name));
    let contents: String = drawings.keys().map(line).collect();
    let files = drawings.iter().map(|(name, drawing)| (format!("{name}.obj"), to_obj(drawing)));
    std::iter::once(("contents.txt".into(), contents.into_bytes())).chain(files).collect()
}

fn to_obj(drawing: &Drawing) -> Vec<u8> {
    match drawing {
        Drawing::Lines(chains) => mesh_io::lines_to_obj(chains),
        // OBJ holds every mesh of triangles.
        Drawing::Mesh(mesh) => mesh_io::to_bytes(&Model::from(mesh.clone()), Format::Obj).unwrap_or_default(),
    }
}
