//! What TOML cannot check: names, ranges, order.

use super::joins::split_loop;
use super::keys::check_keys;
use super::part_tables::{Part, PartCut, Plane};
use super::values::{Length, Pose};
use super::{Error, Recipe, Step};
use crate::cluster;
use crate::cut::{Cut, Keep, PathCut, PlaneCut};
use glam::DVec3;
use mesh_io::Format;
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};
use tri_intersect::Operation;

impl Recipe {
    /// Reads a recipe.
    ///
    /// # Errors
    /// [`Error`], naming line and key: what is no TOML, unknown keys, wrong types, unknown or repeated names, numbers out of range.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let tables = DeTable::parse(text).map_err(|e| Error::of(text, &e))?;
        check_keys(text, tables.get_ref())?;
        let mut recipe = Self::deserialize(Deserializer::from(tables)).map_err(|e| Error::of(text, &e))?;
        recipe.text = text.to_string();
        recipe.check()?;
        Ok(recipe)
    }

    /// The kinds of steps, in order.
    pub fn order(&self) -> Vec<Step> {
        match &self.steps {
            None => Step::ORDER.to_vec(),
            Some(steps) => steps.iter().map(|s| *s.get_ref()).filter(|&s| s != Step::Output).collect(),
        }
    }

    pub(super) fn error(&self, span: Range<usize>, message: impl Into<String>) -> Error {
        Error::at(&self.text, span, message)
    }

    fn check(&self) -> Result<(), Error> {
        if *self.version.get_ref() != 1 {
            return Err(self.error(self.version.span(), "this program reads version 1"));
        }
        if self.parts.is_empty() {
            return Err(self.error(0..0, "there is no [[part]]"));
        }
        let steps = self.steps.as_deref().unwrap_or_default();
        for (i, step) in steps.iter().enumerate() {
            if steps[..i].iter().any(|s| s.get_ref() == step.get_ref()) {
                return Err(self.error(step.span(), "each kind of step can be named once"));
            }
            if *step.get_ref() == Step::Output && i + 1 != steps.len() {
                return Err(self.error(step.span(), "output is the last step"));
            }
        }
        let mut names: Vec<&str> = vec![];
        for part in &self.parts {
            let name = part.name.get_ref().as_str();
            if names.contains(&name) || name.is_empty() {
                return Err(self.error(part.name.span(), format!("there is another part `{name}`; names must differ")));
            }
            names.push(name);
            self.pose(part)?;
            for cut in &part.cut {
                self.cut(part, cut)?;
            }
        }
        self.check_places(&names)?;
        for (i, boolean) in self.boolean.iter().enumerate() {
            self.operation(i)?;
            self.rolling_of_boolean(i, 1.0)?;
            names.extend(boolean.name.iter().map(|n| n.get_ref().as_str()));
        }
        for (i, compose) in self.compose.iter().enumerate() {
            self.composing(i, 1.0, Format::Off)?;
            names.extend(compose.name.iter().map(|n| n.get_ref().as_str()));
            for name in compose.loops.iter().flatten() {
                let part = split_loop(name.get_ref()).map_or("", |l| l.0);
                if !names.contains(&part) {
                    let known = names.join(", ");
                    let message =
                        format!("a loop is \"part:0\", or \"part\" for all of its loops, of one of the parts {known}");
                    return Err(self.error(name.span(), message));
                }
            }
        }
        for i in 0..self.blend.len() {
            self.rolling_of_blend(i, 1.0)?;
        }
        for i in 0..self.cluster.len() {
            self.clustering(i, Format::Off)?;
        }
        for table in &self.detail {
            let (target, sources, _) = self.detailing(table, 1.0)?;
            let span = table.target.as_ref().map_or(table.source.span(), Spanned::span);
            let parts: Vec<&str> = self.parts.iter().map(|p| p.name.get_ref().as_str()).collect();
            let named = sources.iter().map(|s| (s, table.source.span(), &parts)).chain([(&target, span, &names)]);
            for ((part, _), span, known) in named {
                if let Some(part) = part.as_ref().filter(|p| !known.contains(&p.as_str())) {
                    return Err(self.error(span, format!("there is no part `{part}`, only {}", known.join(", "))));
                }
            }
        }
        let used = self.boolean.iter().flat_map(|b| b.parts.iter().flatten());
        let used = used.chain(self.blend.iter().filter_map(|b| b.part.as_ref()));
        for name in used.chain(self.cluster.iter().filter_map(|c| c.part.as_ref())) {
            if !names.contains(&name.get_ref().as_str()) {
                let known = names.join(", ");
                return Err(self.error(name.span(), format!("there is no part `{}`, only {known}", name.get_ref())));
            }
        }
        Ok(())
    }

    pub(super) fn pose(&self, part: &Part) -> Result<Pose, Error> {
        let value = |s: &Option<Spanned<[f64; 3]>>| s.as_ref().map(|s| *s.get_ref());
        let pose = Pose::new(
            part.scale.as_ref().map(|s| *s.get_ref()),
            part.rotate.as_ref().map(|s| *s.get_ref()),
            value(&part.translate),
        );
        let spans = [part.scale.as_ref().map(Spanned::span), part.rotate.as_ref().map(Spanned::span)];
        pose.ok_or_else(|| {
            let span = spans.into_iter().flatten().next().unwrap_or(part.name.span());
            self.error(span, "a pose needs finite numbers, a scale above 0 and an axis other than 0, 0, 0")
        })
    }

    /// A cut of a part.
    pub(super) fn cut(&self, part: &Part, cut: &PartCut) -> Result<Cut, Error> {
        let seed = cut.seed.as_ref().map(|s| DVec3::from(*s.get_ref()));
        let smooth = cut.smooth.as_ref().map_or(0, |s| usize::from(*s.get_ref()));
        let snap = |default: f64| cut.snap.as_ref().map_or(Ok(default), |s| self.within(s, 0.0, 0.25));
        match (&cut.plane, &cut.path) {
            (Some(plane), None) => {
                let Plane { point, normal } = *plane.get_ref();
                let (point, normal) = (DVec3::from(point), DVec3::from(normal));
                if !point.is_finite() || !normal.is_finite() || normal == DVec3::ZERO {
                    let message = "a plane needs a finite point and a normal other than 0, 0, 0";
                    return Err(self.error(plane.span(), message));
                }
                let made = PlaneCut::new(point, normal);
                Ok(PlaneCut { seed, smooth, snap: snap(made.snap)?, ..made }.into())
            }
            (None, Some(path)) => {
                let picks: Vec<DVec3> = path.get_ref().iter().map(|&p| p.into()).collect();
                if picks.len() < 2 || !picks.iter().all(|p| p.is_finite()) {
                    return Err(self.error(path.span(), "a path needs two picks or more, in finite numbers"));
                }
                let mut made = PathCut { smooth, ..PathCut::new(picks) };
                made.snap = snap(made.snap)?;
                made.keep = match (&cut.keep, seed) {
                    (None, Some(seed)) => Keep::Near(seed),
                    (None, None) => Keep::Larger,
                    (Some(k), None) if k.get_ref() == "larger" => Keep::Larger,
                    (Some(k), None) if k.get_ref() == "smaller" => Keep::Smaller,
                    (Some(k), _) => {
                        return Err(self.error(k.span(), "keep is larger or smaller, and goes without a seed"));
                    }
                };
                if let Some(crease) = &cut.crease {
                    made.crease = self.within(crease, 0.0, 1e3)?;
                }
                Ok(made.into())
            }
            _ => Err(self.error(part.name.span(), "a cut needs either a plane or a path")),
        }
    }

    pub(super) fn operation(&self, i: usize) -> Result<Operation, Error> {
        let Some(name) = &self.boolean[i].operation else { return Ok(Operation::Union) };
        match name.get_ref().as_str() {
            "union" => Ok(Operation::Union),
            "difference" => Ok(Operation::Difference),
            "intersection" => Ok(Operation::Intersection),
            _ => Err(self.error(name.span(), "an operation is union, difference or intersection")),
        }
    }

    /// How a polyhedron is rounded.
    pub(super) fn clustering(&self, i: usize, format: Format) -> Result<cluster::Params, Error> {
        let c = &self.cluster[i];
        let count = |value: &Option<Spanned<u8>>, least: u8| match value {
            Some(v) if !(least..=8).contains(v.get_ref()) => {
                Err(self.error(v.span(), format!("must be a whole number from {least} to 8")))
            }
            Some(v) => Ok(Some(usize::from(*v.get_ref()))),
            None => Ok(None),
        };
        let share = |value: &Option<Spanned<f64>>, least: f64, most: f64, default: f64| match value {
            Some(v) => self.within(v, least, most),
            None => Ok(default),
        };
        let mut params = cluster::Params::new(format);
        let patch = &mut params.patch;
        patch.continuity = count(&c.continuity, 1)?.unwrap_or(patch.continuity);
        patch.degree = c.degree.as_ref().map(cluster::Degrees::degree);
        patch.extent = share(&c.extent, 1e-3, 1.0, patch.extent)?;
        patch.bulge = share(&c.bulge, 0.0, 0.99, patch.bulge)?;
        patch.sharp.clone_from(&c.sharp);
        patch.all_sharp = c.all_sharp;
        patch.strip.balance = share(&c.mu, 1e-3, 0.999, patch.strip.balance)?;
        patch.strip.order = count(&c.order, 0)?.unwrap_or(patch.continuity);
        params.tolerance = share(&c.tolerance, 1e-7, 0.1, params.tolerance)?;
        let spec = |e: &cluster::Entry| e.spec().map_err(|e| self.error(0..0, e.to_string()));
        params.clusters = c.clusters.as_ref().map(|all| all.iter().map(spec).collect()).transpose()?;
        Ok(params)
    }

    /// A length, if one is given; `diagonal` is what it may be a share of.
    pub(super) fn length(&self, length: Option<&Spanned<Length>>, diagonal: f64) -> Result<Option<f64>, Error> {
        let resolved = |l: &Spanned<Length>| {
            let message = "a length is a number above 0, or a share of the diagonal such as \"2%\"";
            l.get_ref().resolve(diagonal).ok_or_else(|| self.error(l.span(), message))
        };
        length.map(resolved).transpose()
    }

    pub(super) fn within(&self, value: &Spanned<f64>, least: f64, most: f64) -> Result<f64, Error> {
        let number = *value.get_ref();
        if (least..=most).contains(&number) {
            Ok(number)
        } else {
            Err(self.error(value.span(), format!("must be a number from {least} to {most}")))
        }
    }
}
