//! Geometry detail in recipes.

use super::run::{Replay, step};
use super::tables::{Detail, DetailRegion};
use super::{Error as Wrong, Length, Recipe};
use crate::compose::TRANSITION;
use crate::detail::{Params, detail};
use crate::{Error, Region, carry};
use detail_transfer::{FanLength, Ribbon, Search};
use glam::DVec3;
use mesh_core::{FaceOrigin, Faces};
use mesh_io::Model;
use std::ops::Range;
use toml::Spanned;

/// A table that says where: the part if it names one, and the region.
type Place = (Option<String>, Region);

impl Recipe {
    /// Ranges and regions of a `[[detail]]` table; lengths resolve against `diagonal`.
    pub(super) fn detailing(
        &self,
        table: &Detail,
        diagonal: f64,
    ) -> Result<(Place, Vec<Place>, detail_transfer::Params), Wrong> {
        let length = |length: &Option<Spanned<Length>>| self.length(length.as_ref(), diagonal);
        let region = |at: &DetailRegion, span: Range<usize>| -> Result<Place, Wrong> {
            let one = match (&at.near, &at.radius, &at.group, &at.origin) {
                (Some(center), Some(radius), None, None) => {
                    radius.resolve(diagonal).map(|radius| Region::Near { center: DVec3::from(*center), radius })
                }
                (None, None, Some(name), None) => Some(Region::Group(name.clone())),
                (None, None, None, Some(stage)) => Some(Region::Origin(stage.clone())),
                _ => None,
            };
            let one =
                one.ok_or_else(|| self.error(span, "a region is near and radius (above 0), or group, or origin"))?;
            Ok((at.part.clone(), one))
        };
        let structured = match table.mode.as_ref().map(|m| (m.get_ref().as_str(), m.span())) {
            None => !table.along.is_empty(),
            Some(("structured", _)) if !table.along.is_empty() => true,
            Some(("unstructured", _)) if table.along.is_empty() => false,
            Some((_, span)) => {
                return Err(self
                    .error(span, "a mode is unstructured, or structured with a curve `along` of two points or more"));
            }
        };
        let points = |all: &[[f64; 3]]| all.iter().map(|&p| DVec3::from(p)).collect::<Vec<_>>();
        let ribbon = if structured {
            let source_curve = (!table.source_along.is_empty()).then(|| points(&table.source_along));
            let (width, spacing) = (length(&table.width)?, length(&table.spacing)?);
            Some(Ribbon { source_curve, width, spacing, ..Ribbon::along(points(&table.along)) })
        } else {
            None
        };
        let fan = match table.fan.as_ref().map(Spanned::get_ref) {
            None => FanLength::default(),
            Some(Length::Share(name)) if name == "diagonal" => FanLength::Diagonal,
            Some(Length::Share(name)) if name == "edges" => FanLength::Edges,
            Some(_) => length(&table.fan)?.map_or(FanLength::default(), FanLength::Units),
        };
        let search = match table.search.as_ref().map(|s| (s.get_ref().as_str(), s.span())) {
            None | Some(("indexed", _)) => Search::Indexed,
            Some(("exhaustive", _)) => Search::Exhaustive,
            Some((_, span)) => return Err(self.error(span, "a search is indexed or exhaustive")),
        };
        let intensity = table.intensity.as_ref().map(|factor| self.within(factor, -100.0, 100.0)).transpose()?;
        let params = detail_transfer::Params {
            wavelength: length(&table.wavelength)?,
            fan,
            search,
            intensity,
            ribbon,
            ..detail_transfer::Params::default()
        };
        let target = match &table.target {
            Some(r) => region(r.get_ref(), r.span())?,
            None => (None, Region::Origin(TRANSITION.into())),
        };
        let sources = table.source.get_ref().all().iter().map(|r| region(r, table.source.span()));
        Ok((target, sources.collect::<Result<_, _>>()?, params))
    }
}

impl Replay<'_> {
    /// Takes every `[[detail]]` in order. Sources that name a part are that part as it was posed, whole; others lie on the target's piece.
    pub(super) fn details(&mut self) -> Result<(), Error> {
        for table in &self.recipe.detail {
            let (target, sources, transfer) = self.recipe.detailing(table, self.diagonal())?;
            let at = match target.0.as_ref().and_then(|name| self.pieces.iter().position(|p| p.name == *name)) {
                Some(at) => at,
                None => self.only("name the part that gets detail")?,
            };
            let mut parts = vec![self.dressed(at)];
            let target = self.named_faces(at, target.1);
            let mut regions = vec![];
            for (part, region) in sources {
                let first = part.and_then(|name| self.recipe.parts.iter().position(|p| *p.name.get_ref() == name));
                match first {
                    Some(i) => {
                        regions.push((parts.len(), region));
                        parts.push(self.first[i].clone());
                    }
                    None => regions.push((0, self.named_faces(at, region))),
                }
            }
            let params = Params { target, sources: regions, transfer, format: self.format };
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
