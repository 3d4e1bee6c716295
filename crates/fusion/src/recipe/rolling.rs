//! How a ball is rolled, in recipes: the keys that blends and booleans share.

use super::tables::{BallRadius, Blend, Boolean, ProfileAt, RadiusAt};
use super::values::Length;
use super::{Error, Recipe};
use crate::{blend, picked_from_text};
use glam::DVec3;
use profile_nurbs::Profile;
use spine::{OffsetParams, Solver};
use std::path::Path;
use toml::Spanned;

/// The keys.
struct Keys<'a> {
    radius: &'a Spanned<BallRadius>,
    radius_at: &'a [Spanned<RadiusAt>],
    profile_at: &'a [Spanned<ProfileAt>],
    profile: &'a Option<Spanned<String>>,
    overlap: &'a Option<Spanned<String>>,
    surface: &'a Option<Spanned<String>>,
    spine: &'a Option<Spanned<String>>,
    alpha: &'a Option<Spanned<f64>>,
    tolerance: &'a Option<Spanned<f64>>,
    reach: &'a Option<Spanned<f64>>,
}

/// The keys of a table that has them all.
macro_rules! keys {
    ($table:expr, $radius:expr) => {
        Keys {
            radius: $radius,
            radius_at: &$table.radius_at,
            profile_at: &$table.profile_at,
            profile: &$table.profile,
            overlap: &$table.overlap,
            surface: &$table.surface,
            spine: &$table.spine,
            alpha: &$table.alpha,
            tolerance: &$table.tolerance,
            reach: &$table.reach,
        }
    };
}

impl Recipe {
    /// Reads the files of curves that blends name; `read` gives the text of one, by its path in the recipe. Without this
    /// such blends find no curve.
    ///
    /// # Errors
    /// [`Error`] with the line and key that names the file, and what is wrong with it.
    pub fn read_curves(&mut self, mut read: impl FnMut(&Path) -> Result<String, String>) -> Result<(), Error> {
        for i in 0..self.blend.len() {
            let Some(path) = self.blend[i].curves.clone() else { continue };
            let picked = read(path.get_ref()).and_then(|text| picked_from_text(&text));
            let wrong = |e| self.error(path.span(), format!("{}: {e}", path.get_ref().display()));
            self.blend[i].picked = picked.map_err(wrong)?;
        }
        Ok(())
    }

    /// How the seam of a boolean is blended; `diagonal` is what lengths may be a share of.
    pub(super) fn rolling_of_boolean(&self, i: usize, diagonal: f64) -> Result<Option<blend::Params>, Error> {
        let table: &Boolean = &self.boolean[i];
        table.radius.as_ref().map(|radius| self.rolling(&keys!(table, radius), diagonal)).transpose()
    }

    /// How a blend rolls.
    pub(super) fn rolling_of_blend(&self, i: usize, diagonal: f64) -> Result<blend::Params, Error> {
        let table: &Blend = &self.blend[i];
        self.rolling(&keys!(table, &table.radius), diagonal)
    }

    fn rolling(&self, keys: &Keys<'_>, diagonal: f64) -> Result<blend::Params, Error> {
        let length = |length: &Length, span: std::ops::Range<usize>| {
            let message = "a radius is a number above 0, or a share of the diagonal such as \"2%\"";
            length.resolve(diagonal).ok_or_else(|| self.error(span, message))
        };
        let sides = match keys.radius.get_ref() {
            BallRadius::One(r) => [length(r, keys.radius.span())?; 2],
            BallRadius::Two([left, right]) => [length(left, keys.radius.span())?, length(right, keys.radius.span())?],
        };
        let place = |at: [f64; 3], span: std::ops::Range<usize>| match DVec3::from(at) {
            place if place.is_finite() => Ok(place),
            _ => Err(self.error(span, "a place is three finite numbers")),
        };
        let mut at = vec![];
        for key in keys.radius_at {
            at.push((place(key.get_ref().at, key.span())?, length(&key.get_ref().radius, key.span())?));
        }
        let (radius, radii) = blend::Radii::of(sides, &at);
        let mut params = blend::Params { radii, ..blend::Params::new(radius) };
        let profile = |text: &str, span: std::ops::Range<usize>| {
            let message = "a profile is arc, g2, chamfer, sharp, hermite, or conic=W with W of 0 or more";
            Profile::named(text).ok_or_else(|| self.error(span, message))
        };
        if let Some(text) = keys.profile {
            params.profile = profile(text.get_ref(), text.span())?;
        }
        for key in keys.profile_at {
            let here = place(key.get_ref().at, key.span())?;
            params.profile_at.push((here, profile(&key.get_ref().profile, key.span())?));
        }
        if let Some(text) = keys.overlap {
            params.overlap = match text.get_ref().as_str() {
                "shrink" => blend::Overlap::Shrink,
                "error" => blend::Overlap::Error,
                "full" => blend::Overlap::Full,
                "trim" => return Err(self.error(text.span(), "overlap = \"full\" stands for the former \"trim\"")),
                _ => return Err(self.error(text.span(), "overlap is full, shrink or error")),
            };
        }
        if let Some(text) = keys.surface {
            params.surface = match text.get_ref().as_str() {
                "auto" => blend::Surface::Auto,
                "stitch" => blend::Surface::Stitch,
                "field" => blend::Surface::Field,
                "keep" => blend::Surface::Keep(blend::keep::Params::default()),
                _ => return Err(self.error(text.span(), "a surface is auto, stitch, field or keep")),
            };
        }
        if let Some(text) = keys.spine {
            params.solver = match text.get_ref().as_str() {
                "contact" => Solver::Contact,
                "offset" => Solver::Offset(OffsetParams::default()),
                _ => return Err(self.error(text.span(), "a spine is found by contact or offset")),
            };
        }
        if let Some(alpha) = keys.alpha {
            params.alpha = self.within(alpha, 1.0, 16.0)?;
        }
        if let Some(tolerance) = keys.tolerance {
            params.tolerance = self.within(tolerance, 1e-6, 0.5)?;
        }
        if let Some(reach) = keys.reach {
            params.reach = Some(self.within(reach, 0.1, 100.0)?);
        }
        Ok(params)
    }
}
