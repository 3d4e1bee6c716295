//! A document from its text.

use super::names::Names;
use super::parameters::Parameters;
use super::parts::{Named, Output, Part, Step};
use super::table::{check_keys, take, take_tables};
use super::{Document, Error};
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys at the top.
pub(super) const TOP: [&str; 6] = ["version", "parameters", "part", "primitive", "step", "output"];

/// What a document of version 1 is told.
const FORMER: &str = "write `version = 2`; what stood in [[part.cut]], [[boolean]], [[compose]], [[blend]], [[cluster]] and \
    [[detail]] is a [[step]] each, in the order in which it is done, with `do = \"cut\"` or another verb and `of = \"NAME\"`; \
    a part that is cut before it is posed takes a step `do = \"pose\"` after that; `output` is an [[output]] with `file`. \
    docs/documents.md shows one";

impl Document {
    /// Reads a document.
    ///
    /// # Errors
    /// [`Error`] with line, column and key: what is no TOML, unknown keys, wrong types, unknown or repeated names, numbers out of
    /// range, circles.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut root = DeTable::parse(text).map_err(|e| Error::of(text, &e))?.into_inner();
        check_version(text, &mut root)?;
        check_keys(text, &root, &TOP)?;
        let mut parameters = Parameters::take(text, &mut root)?;
        parameters.fill(&mut root)?;
        let parts = take_tables(text, &mut root, "part")?.into_iter();
        let parts = parts.map(|(span, table)| Part::read(text, span, table)).collect::<Result<Vec<_>, _>>()?;
        let primitives = primitives(text, &mut root)?;
        let steps = take_tables(text, &mut root, "step")?.into_iter();
        let mut steps = steps.map(|(span, table)| Step::read(text, span, table)).collect::<Result<Vec<_>, _>>()?;
        let outputs = take_tables(text, &mut root, "output")?.into_iter();
        let mut outputs =
            outputs.map(|(span, table)| Output::read(text, span, table)).collect::<Result<Vec<_>, _>>()?;
        let mut names = Names::new(text, &parts, &primitives)?;
        let order = names.order(&parts)?;
        steps.iter_mut().try_for_each(|step| names.step(step))?;
        outputs.iter_mut().try_for_each(|output| names.output(output))?;
        names.check_openings()?;
        let left = names.left();
        let (parameters, unused) = parameters.finish();
        Ok(Self { text: text.into(), parameters, unused, parts, order, primitives, steps, outputs, left })
    }
}

fn check_version(text: &str, root: &mut DeTable<'_>) -> Result<(), Error> {
    let version: Option<Spanned<i64>> = take(text, root, "version")?;
    match version.as_ref().map(|v| (*v.get_ref(), v.span())) {
        Some((2, _)) => Ok(()),
        Some((1, span)) => Err(Error::at(text, span, "this is a document of version 1").remedy(FORMER)),
        Some((other, span)) => {
            Err(Error::at(text, span, format!("there is no version {other}")).remedy("this program reads version 2"))
        }
        None => Err(Error::at(text, 0..0, "the version is missing").remedy("write `version = 2` at the top")),
    }
}

fn primitives(text: &str, root: &mut DeTable<'_>) -> Result<BTreeMap<String, Named>, Error> {
    let Some(written) = root.remove("primitive") else { return Ok(BTreeMap::new()) };
    let wrong = |span| Error::at(text, span, "every primitive is a table of its own, `[primitive.NAME]`");
    let span = written.span();
    let DeValue::Table(all) = written.into_inner() else { return Err(wrong(span)) };
    let one = |(name, value): (Spanned<std::borrow::Cow<'_, str>>, Spanned<DeValue<'_>>)| {
        let span = value.span();
        match value.into_inner() {
            DeValue::Table(table) => Ok((name.into_inner().into_owned(), Named::read(text, span, table)?)),
            _ => Err(wrong(span)),
        }
    };
    all.into_iter().map(one).collect()
}
