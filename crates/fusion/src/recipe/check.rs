//! What TOML cannot check: names, ranges, order.

use super::keys::check_keys;
use super::part_tables::Part;
use super::step_table::StepTable;
use super::values::Pose;
use super::vocabulary::{PIECES_OF_BLEND, PIECES_OF_BOOLEAN, PIECES_OF_COMPOSE};
use super::{Error, Recipe, Step};
use crate::cut::Cut;
use crate::operation::{self, Detail, Files, OptionError, Options};
use serde::Deserialize;
use std::mem::take;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

impl Recipe {
    /// Reads a recipe.
    ///
    /// # Errors
    /// [`Error`], naming line and key: what is no TOML, unknown keys, wrong types, unknown or repeated names, numbers out of range.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut tables = DeTable::parse(text).map_err(|e| Error::of(text, &e))?;
        check_keys(text, tables.get_ref())?;
        let boolean = StepTable::take(text, tables.get_mut(), "boolean", PIECES_OF_BOOLEAN)?;
        let compose = StepTable::take(text, tables.get_mut(), "compose", PIECES_OF_COMPOSE)?;
        let blend = StepTable::take(text, tables.get_mut(), "blend", PIECES_OF_BLEND)?;
        let cluster = StepTable::take(text, tables.get_mut(), "cluster", PIECES_OF_BLEND)?;
        let detail = StepTable::take(text, tables.get_mut(), "detail", &[])?;
        let mut recipe = Self::deserialize(Deserializer::from(tables)).map_err(|e| Error::of(text, &e))?;
        recipe.text = text.to_string();
        (recipe.boolean, recipe.compose, recipe.blend) = (boolean, compose, blend);
        (recipe.cluster, recipe.detail) = (cluster, detail);
        recipe.check()?;
        Ok(recipe)
    }

    /// Reads the files that steps name, by their paths in the recipe. Without this such steps are refused.
    ///
    /// # Errors
    /// [`Error`] with the line and key that names the file, and what is wrong with it.
    pub fn load(&mut self, files: &mut dyn Files) -> Result<(), Error> {
        let mut blend = take(&mut self.blend);
        let (mut boolean, mut cluster, mut detail) =
            (take(&mut self.boolean), take(&mut self.cluster), take(&mut self.detail));
        boolean.iter_mut().try_for_each(|step| step.load(self, files))?;
        blend.iter_mut().try_for_each(|step| step.load(self, files))?;
        cluster.iter_mut().try_for_each(|step| step.load(self, files))?;
        detail.iter_mut().try_for_each(|step| step.load(self, files))?;
        (self.boolean, self.blend, self.cluster, self.detail) = (boolean, blend, cluster, detail);
        Ok(())
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
            self.cuts(part)?;
        }
        self.check_places(&names)?;
        for boolean in &self.boolean {
            boolean.operation.validate().map_err(|e| boolean.wrong(self, &e))?;
            names.extend(boolean.pieces.name.iter().map(|n| n.get_ref().as_str()));
        }
        for compose in &self.compose {
            compose.operation.validate().map_err(|e| compose.wrong(self, &e))?;
            names.extend(compose.pieces.name.iter().map(|n| n.get_ref().as_str()));
            if compose.operation.loops.iter().any(|name| !names.contains(&name.part.as_str())) {
                let known = names.join(", ");
                let says =
                    format!("a loop is \"part:0\", or \"part\" for all of its loops, of one of the parts {known}");
                return Err(compose.wrong(self, &OptionError::new("loops", says)));
            }
        }
        for blend in &self.blend {
            blend.operation.validate().map_err(|e| blend.wrong(self, &e))?;
        }
        for cluster in &self.cluster {
            cluster.operation.validate().map_err(|e| cluster.wrong(self, &e))?;
        }
        let parts: Vec<&str> = self.parts.iter().map(|p| p.name.get_ref().as_str()).collect();
        for table in &self.detail {
            let Detail { source, target, .. } = &table.operation;
            table.operation.validate().map_err(|e| table.wrong(self, &e))?;
            let sources = source.iter().map(|s| (s, "source", &parts));
            for (region, option, known) in sources.chain(target.iter().map(|t| (t, "target", &names))) {
                if let Some(part) = region.part.as_ref().filter(|p| !known.contains(&p.as_str())) {
                    let says = format!("there is no part `{part}`, only {}", known.join(", "));
                    return Err(table.wrong(self, &OptionError::new(option, says)));
                }
            }
        }
        let used = self.boolean.iter().flat_map(|b| b.pieces.parts.iter().flatten());
        let used = used.chain(self.blend.iter().filter_map(|b| b.pieces.part.as_ref()));
        for name in used.chain(self.cluster.iter().filter_map(|c| c.pieces.part.as_ref())) {
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

    /// What a part is cut by, first to last.
    pub(super) fn cuts(&self, part: &Part) -> Result<Vec<Cut>, Error> {
        let wrong = |cut: &Spanned<operation::Cut>, e: OptionError| self.error(cut.span(), e.to_string());
        part.cut.iter().map(|cut| cut.get_ref().cut().map_err(|e| wrong(cut, e))).collect()
    }
}
