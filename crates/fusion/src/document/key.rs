//! What a result depends on, as one number: the same key, the same bytes.

use super::entry;
use crate::operation::Precision;
use crate::pose::similarity::Similarity;
use mesh_io::Model;

/// A hash of all that a shape depends on.
pub(super) type Key = [u8; 32];

/// The key of a part: its contents, side files included, whatever its file is called.
pub(super) fn of_part(model: &Model) -> Key {
    let mut bytes = vec![];
    entry::put_model(&mut bytes, model);
    let mut hash = start("part");
    hash.update(&bytes);
    hash.finalize().into()
}

/// The key of a step: its operation with every option and the contents of the files that they name, where a pose takes it,
/// its shapes in order, what the result must survive, and the engine.
pub(super) fn of_step(
    verb: &str,
    options: &str,
    motion: Option<&Similarity>,
    inputs: &[Key],
    precision: Precision,
) -> Key {
    let mut hash = start("step");
    for text in [verb, options, &precision.to_string(), env!("CARGO_PKG_VERSION"), env!("FUSION_BUILD"), &processor()] {
        put(&mut hash, text.as_bytes());
    }
    if let Some(motion) = motion {
        let numbers = [motion.rotation.to_array().to_vec(), motion.translation.to_array().to_vec(), vec![motion.scale]];
        for number in numbers.concat() {
            hash.update(&number.to_bits().to_le_bytes());
        }
    }
    put(&mut hash, &(inputs.len() as u64).to_le_bytes());
    for key in inputs {
        hash.update(key);
    }
    hash.finalize().into()
}

/// The key of what a boolean makes of its first two shapes before it blends: in 64 bits, whatever the result must survive.
pub(super) fn of_first(verb: &str, inputs: &[Key]) -> Key {
    let mut hash = start("first");
    put(&mut hash, verb.as_bytes());
    for key in inputs {
        hash.update(key);
    }
    hash.finalize().into()
}

fn start(kind: &str) -> blake3::Hasher {
    blake3::Hasher::new_derive_key(&format!("fusion documents, {kind}, 1"))
}

/// Bytes behind their number, so that no two lists run into the same.
fn put(hash: &mut blake3::Hasher, bytes: &[u8]) {
    hash.update(&(bytes.len() as u64).to_le_bytes()).update(bytes);
}

/// Linear solvers choose their kernels by what the processor can do, and other kernels give other last bits.
fn processor() -> String {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let can = [
        std::is_x86_feature_detected!("avx2"),
        std::is_x86_feature_detected!("fma"),
        std::is_x86_feature_detected!("avx512f"),
    ];
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let can = [false; 3];
    format!("{} {} {can:?}", std::env::consts::ARCH, std::env::consts::OS)
}
