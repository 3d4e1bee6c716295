//! A picture's pixels, and PNG files of them.

use crate::params::Error;
use std::fs;
use std::io;
use std::path::Path;

/// Pixels in sRGB, eight bits for each of red, green and blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Picture {
    /// Three bytes for each pixel, row by row from the top left.
    pub(crate) fn new(width: u32, height: u32, rgb: Vec<u8>) -> Self {
        Self { width, height, rgb }
    }

    /// Width and height in pixels.
    pub fn dimensions(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Red, green and blue of all pixels, row by row from the top left.
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// Every pixel, row by row from the top left.
    pub fn pixels(&self) -> impl ExactSizeIterator<Item = [u8; 3]> + '_ {
        self.rgb.as_chunks::<3>().0.iter().copied()
    }

    /// The pixel `x` from the left and `y` from the top; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        let inside = x < self.width && y < self.height;
        self.pixels().nth(y as usize * self.width as usize + x as usize).filter(|_| inside)
    }

    /// The bytes of a PNG file.
    ///
    /// # Errors
    /// What the encoder refuses, such as a picture beyond its limits.
    pub fn to_png(&self) -> io::Result<Vec<u8>> {
        let mut bytes = vec![];
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(bytes)
    }
}

/// Writes a picture as PNG.
///
/// # Errors
/// [`Error::Save`] when the file cannot be written.
pub fn save(picture: &Picture, path: impl AsRef<Path>) -> Result<(), Error> {
    let path = path.as_ref();
    let write = || fs::write(path, picture.to_png()?);
    write().map_err(|source| Error::Save { path: path.to_path_buf(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was written is read back by a decoder.
    #[test]
    fn png_files_hold_the_pixels() {
        let rgb: Vec<u8> = (0..5 * 7 * 3).map(|i| (i * 37 % 251) as u8).collect();
        let picture = Picture::new(5, 7, rgb.clone());
        assert_eq!(picture.pixel(4, 6), Some([rgb[102], rgb[103], rgb[104]]));
        assert_eq!((picture.pixel(5, 0), picture.pixels().len()), (None, 35));
        let bytes = picture.to_png().unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
        let mut back = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut back).unwrap();
        assert_eq!((info.width, info.height, info.color_type, back), (5, 7, png::ColorType::Rgb, rgb));
    }

    #[test]
    fn a_place_that_cannot_be_written_is_named() {
        let missing = Path::new("no such folder").join("a.png");
        assert!(
            matches!(save(&Picture::new(1, 1, vec![0; 3]), &missing), Err(Error::Save { path, .. }) if path == missing)
        );
    }
}
