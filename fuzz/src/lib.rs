//! What every reader is held to.

use mesh_io::{Format, read_stream, to_bytes};

/// Reads bytes as a format. What is accepted must be sound, and survive being written in every format and read again.
pub fn read(bytes: &[u8], format: Format) {
    let Ok(model) = read_stream(bytes, format) else { return };
    let count = model.mesh.positions.len();
    assert!(model.mesh.faces.iter().flatten().all(|v| v.index() < count));
    assert!(model.mesh.positions.iter().all(|p| p.is_finite()));
    for format in Format::ALL {
        let Ok(written) = to_bytes(&model, format) else { continue };
        // 3MF and glTF leave out what has no triangles.
        let again = read_stream(&written, format);
        if format.is_lossless() && !model.mesh.faces.is_empty() {
            let again = again.expect("what was written can be read");
            assert_eq!(again.mesh.positions, model.mesh.positions);
            assert_eq!(again.mesh.faces, model.mesh.faces);
        }
    }
}
