//! Geometry detail in recipes.

use super::run::{Replay, step};
use crate::detail::detail;
use crate::{Error, Region, carry};
use mesh_core::{FaceOrigin, Faces};
use mesh_io::Model;

impl Replay<'_> {
    /// Takes every `[[detail]]` in order. Sources that name a part are that part as it was posed, whole; others lie on the target's piece.
    pub(super) fn details(&mut self) -> Result<(), Error> {
        for table in &self.recipe.detail {
            let target = table.operation.target();
            let at = match target.part.and_then(|name| self.pieces.iter().position(|p| p.name == name)) {
                Some(at) => at,
                None => self.only("name the part that gets detail")?,
            };
            let mut parts = vec![self.dressed(at)];
            let named = |name: Option<&str>| {
                let part = name.and_then(|name| self.recipe.parts.iter().position(|p| p.name.get_ref() == name));
                part.map_or(0, |i| {
                    parts.push(self.first[i].clone());
                    parts.len() - 1
                })
            };
            let params = table.operation.params(self.diagonal(), self.format, named);
            let mut params = params.map_err(|e| table.wrong(self.recipe, &e))?;
            params.target = self.named_faces(at, params.target);
            for (_, region) in params.sources.iter_mut().filter(|s| s.0 == 0) {
                *region = self.named_faces(at, region.clone());
            }
            let name = format!("detail of {}", self.pieces[at].name);
            let outcome = detail(&parts, &params, self.watch).map_err(|e| step(&name, e))?;
            self.take_up(&[at], &parts[..1], &name, outcome);
        }
        Ok(())
    }

    /// A piece with the attributes that its origins lead to.
    fn dressed(&self, at: usize) -> Model {
        let piece = &self.pieces[at];
        carry(&self.first, piece.mesh.clone(), &piece.origins)
    }

    /// What a stage made, by origins, which are known whatever the inputs' attributes.
    fn named_faces(&self, at: usize, region: Region) -> Region {
        let Region::Origin(name) = region else { return region };
        let piece = &self.pieces[at];
        let of_stage = |o: &FaceOrigin| matches!(o, FaceOrigin::New { stage } if *stage == name);
        Region::Faces(piece.mesh.face_ids().filter(|&f| of_stage(&piece.origins.faces[f])).collect())
    }
}
