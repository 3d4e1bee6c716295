//! Models from polygons in memory.

use crate::error::Error;
use crate::model::Model;
use crate::notes::Notes;
use crate::soup::Soup;
use glam::DVec3;

impl Model {
    /// A model from polygons, cut into triangles as the readers cut those of files. `sizes` holds each polygon's number of
    /// corners, `corners` the vertices of all polygons one after the other.
    ///
    /// ```
    /// use glam::DVec3;
    /// let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// let model = mesh_io::Model::from_polygons(square.into(), vec![4], vec![0, 1, 2, 3])?;
    /// assert_eq!((model.mesh.faces.len(), model.polygons.map(|p| p.len())), (2, Some(1)));
    /// assert!(mesh_io::Model::from_polygons(square.into(), vec![3], vec![0, 1, 4]).is_err());
    /// # Ok::<(), mesh_io::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Malformed`] where a corner names a missing vertex, where `sizes` does not add up to the number of corners, or for
    /// more than 32-bit ids can name.
    pub fn from_polygons(positions: Vec<DVec3>, sizes: Vec<u32>, corners: Vec<u32>) -> Result<Self, Error> {
        let malformed = |reason| Error::Malformed { file: "polygons".into(), at: None, reason };
        if sizes.iter().map(|&n| u64::from(n)).sum::<u64>() != corners.len() as u64 {
            return Err(malformed(format!("the sizes do not add up to the {} corners", corners.len())));
        }
        if let Some(&v) = corners.iter().find(|&&v| v as usize >= positions.len()) {
            let last = positions.len();
            return Err(malformed(format!("a polygon names vertex {v} of {last} (counted from 0)")));
        }
        let sizes = sizes.iter().any(|&n| n != 3).then_some(sizes);
        let mut notes = Notes::default();
        let cut =
            Soup { positions, sizes, corners }.triangulate(&mut notes, |_| None).map_err(|f| malformed(f.reason))?;
        Ok(Self { mesh: cut.mesh, polygons: cut.polygons, notes: notes.resolve(&[]), ..Self::default() })
    }
}
