//! Which colour shows where a face comes from.

/// The renderer's palette index of faces of input `part`, or of new faces.
///
/// ```
/// assert_ne!(fusion::palette_index(Some(0)), fusion::palette_index(Some(1)));
/// assert_ne!(fusion::palette_index(Some(1)), fusion::palette_index(None));
/// ```
pub fn palette_index(part: Option<u32>) -> u32 {
    // New faces take the second, warm colour, which stands out beside the others.
    match part {
        None => 1,
        Some(0) => 0,
        Some(part) => part.saturating_add(2),
    }
}
