//! Fillets along feature curves.

use super::define::operation;
use super::linked::{Files, Linked, Solid, parsed};
use super::option_error::{Check, OptionError, ensure, finite, positive};
use super::options::Options;
use super::rolling::{self, Overlap, Rolling, Spine, Surface};
use super::section::{ProfileAt, Section};
use super::{Length, Near, Precision, Radius, RadiusAt};
use crate::blend::Limit;
use crate::choice::{self, Choice};
use crate::features::{self, Convexity};
use crate::{Error, Outcome, Picked, Profile, parts_of_faces, picked_from_text, round, sharpen};
use glam::DVec3;
use mesh_core::{Watch, bounds};
use mesh_io::{Format, Model};

operation! {
    [rolling]
    /// Fillet feature curves with a rolling ball
    ///
    /// ```
    /// use fusion::operation::{Blend, Precision};
    /// use fusion::mesh_core::{Watch, shapes};
    /// let cube = shapes::cuboid(glam::DVec3::ONE);
    /// let round = Blend::default().with_radius(0.1).run(&cube.into(), Precision::F64, &Watch::default())?;
    /// assert_eq!(round.report.figures["strips"], 12.0);
    /// # Ok::<(), fusion::Error>(())
    /// ```
    #[cfg_attr(feature = "clap", command(group(clap::ArgGroup::new("ball").multiple(true))))]
    pub struct Blend {
        /// Radius of the ball; with `R1,R2` its centre keeps R1 from the side to the left of a curve and R2 from the other
        ///
        /// Left is seen from outside along the points that `features` lists. With the profile `sharp` at a point on a fillet:
        /// what is rounded by R or less is taken back to an edge; where left out, as it is rounded at that point.
        #[cfg_attr(feature = "clap", arg(long, value_name = "R[,R2]", group = "ball"))]
        radius: Option<Radius> = None;
        /// Least angle between the normals of two neighbouring faces that makes their edge a feature, in degrees
        #[schemars(extend("exclusiveMinimum" = 0, "exclusiveMaximum" = 180))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "DEG", default_value_t = Self::default().angle,
            help_heading = "Which curves"))]
        angle: f64 = features::Params::default().angle;
        /// Blend only the feature curve nearest this point; may be given more than once, each with a radius of its own
        ///
        /// With the profile `sharp`, a point on a fillet.
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z[=R]", allow_hyphen_values = true, group = "ball",
            help_heading = "Which curves"))]
        near: Vec<Near> = vec![];
        /// Blend only these feature curves, by the ids that `features` lists at the same angle
        #[cfg_attr(feature = "clap", arg(long, value_name = "ID,ID...", value_delimiter = ',',
            help_heading = "Which curves"))]
        ids: Vec<usize> = vec![];
        /// Blend the curves in this file, as `features` writes them
        ///
        /// Their points are at vertices, or far apart, to be joined by the cheapest path along sharp edges.
        #[cfg_attr(feature = "clap", arg(long, value_name = "CURVES.json", help_heading = "Which curves"))]
        curves: Option<Linked<Vec<Picked>>> = None;
        /// Blend the seams of an earlier boolean: the edges between faces of different parts in the file of its origins
        #[cfg_attr(feature = "clap", arg(long, hide_short_help = true, value_name = "ORIGINS.json", help_heading = "Which curves"))]
        seams: Option<Linked<Vec<Option<u32>>>> = None;
        /// Take the feature curves that continue a named one, too: from its end, within 25 degrees
        #[cfg_attr(feature = "clap", arg(long, help_heading = "Which curves"))]
        chain: bool = false;
        /// Only curves longer than this
        #[cfg_attr(feature = "clap", arg(long, value_name = "L", value_parser = Length::positive,
            help_heading = "Which curves"))]
        longer: Option<Length> = None;
        /// Only curves whose every edge is parallel to this direction, or to one of several, within 5 degrees
        #[schemars(with = "Vec<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, hide_short_help = true, value_name = "X,Y,Z", value_parser = super::place::direction,
            allow_hyphen_values = true, help_heading = "Which curves"))]
        along: Vec<DVec3> = vec![];
        /// Only curves inside or on this closed solid
        #[cfg_attr(feature = "clap", arg(long, hide_short_help = true, value_name = "MESH", help_heading = "Which curves"))]
        within: Option<Linked<Solid>> = None;
        /// Only ridges, as the edges of a box
        #[cfg_attr(feature = "clap", arg(long, conflicts_with = "concave", help_heading = "Which curves"))]
        convex: bool = false;
        /// Only valleys, as between a post and a plate
        #[cfg_attr(feature = "clap", arg(long, help_heading = "Which curves"))]
        concave: bool = false;
    }
}

impl Options for Blend {
    const NAME: &'static str = "blend";

    fn validate(&self) -> Check {
        let radii = self.near.iter().filter_map(|n| n.radius);
        radii.clone().try_for_each(|r| positive(r, "near"))?;
        if let Some(radius) = self.radius {
            radius.sides().into_iter().try_for_each(|r| positive(r, "radius"))?;
        } else {
            let named_otherwise = !self.ids.is_empty() || self.curves.is_some() || self.seams.is_some();
            let all = radii.count() == self.near.len() && !self.near.is_empty() && !named_otherwise;
            ensure(all || self.sharpens(), "radius", || {
                "a radius is needed, for all curves or for every point that names one".into()
            })?;
        }
        let angle = self.angle > 0.0 && self.angle < 180.0;
        ensure(angle, "angle", || "an angle is a number of degrees between 0 and 180".into())?;
        self.near.iter().try_for_each(|n| finite(n.at, "near"))?;
        self.longer.map_or(Ok(()), |l| positive(l, "longer"))?;
        let directed = self.along.iter().all(|d| d.try_normalize().is_some());
        ensure(directed, "along", || "a direction must not be 0,0,0".into())?;
        ensure(!(self.convex && self.concave), "convex", || "no curve is both convex and concave".into())?;
        Rolling::from(self).check()
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        rolling::load(&mut self.profile, &mut self.profile_at, files)?;
        if let Some(curves) = &mut self.curves {
            curves.load("curves", |path| parsed(files, path, picked_from_text))?;
        }
        if let Some(seams) = &mut self.seams {
            seams.load("seams", |path| parsed(files, path, parts_of_faces))?;
        }
        if let Some(within) = &mut self.within {
            within.load("within", |path| files.mesh(path).map(Solid))?;
        }
        Ok(())
    }
}

impl Blend {
    /// Blends the chosen feature curves of a solid, all at once; lengths may be a share of its diagonal.
    ///
    /// With the profile `sharp` and points on fillets, these are taken back to edges.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range; else as [`round`] or [`sharpen()`](crate::sharpen()).
    pub fn run(&self, part: &Model, precision: Precision, watch: &Watch) -> Result<Outcome, Error> {
        let (diagonal, format) = (bounds(&part.mesh).diagonal(), precision.into());
        self.validate()?;
        match self.sharpened(part, diagonal, format, watch)? {
            Some(outcome) => Ok(outcome),
            None => round(part, &self.params(diagonal, format)?, watch),
        }
    }

    /// The mesh with its fillets at the points taken back to edges. `None` unless the profile is `sharp` and points say where, and
    /// if the first point is on no fillet and there is a radius, which then means a blend with a sharp section along feature curves.
    ///
    /// # Errors
    /// As [`sharpen()`](crate::sharpen()).
    pub fn sharpened(
        &self,
        part: &Model,
        diagonal: f64,
        format: Format,
        watch: &Watch,
    ) -> Result<Option<Outcome>, Error> {
        if !self.sharpens() {
            return Ok(None);
        }
        let radius = self.radius.map(|r| r.sides().map(|r| r.resolve(diagonal)));
        let params = sharpen::Params {
            near: self.near.iter().map(|n| n.at).collect(),
            radius: radius.map(|[one, other]| one.max(other)),
            angle: self.angle,
            format,
        };
        match sharpen::sharpen(part, &params, watch) {
            Ok(outcome) => Ok(Some(outcome)),
            Err(Error::Sharpen(sharpen::Refusal::NotRounded { at })) if radius.is_some() && at == params.near[0] => {
                Ok(None)
            }
            Err(e) => Err(e),
        }
    }

    fn sharpens(&self) -> bool {
        self.profile == Profile::Sharp.into() && !self.near.is_empty() && self.curves.is_none()
    }

    /// The largest radius at which the chosen curves can be blended; see [`round::max_radius`].
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn max_radius(&self, part: &Model, watch: &Watch) -> Result<Limit, Error> {
        let diagonal = bounds(&part.mesh).diagonal();
        let unit = Self { radius: Some(1.0.into()), ..self.clone() };
        round::max_radius(part, &unit.params(diagonal, Format::Obj)?, watch)
    }

    /// The same for [`round`], with lengths in model units; `diagonal` is what they may be a share of.
    ///
    /// # Errors
    /// As [`Self::validate`], and for files that have not been read.
    pub fn params(&self, diagonal: f64, format: Format) -> Result<round::Params, OptionError> {
        self.validate()?;
        let largest = |a: Length, b: Length| if a.resolve(diagonal) < b.resolve(diagonal) { b } else { a };
        let own = self.near.iter().filter_map(|n| n.radius).reduce(largest);
        let radius = self.radius.or(own.map(Radius::Both)).unwrap_or(Radius::Both(Length::Units(0.0)));
        Ok(round::Params {
            features: features::Params { angle: self.angle, ..features::Params::default() },
            choice: self.choice(diagonal)?,
            blend: Rolling::from(self).params(radius.sides(), diagonal)?,
            format,
        })
    }

    fn choice(&self, diagonal: f64) -> Result<Choice, OptionError> {
        let near = |n: &Near| choice::Near { at: n.at, radius: n.radius.map(|r| r.resolve(diagonal)) };
        let picked = self.curves.as_ref().map(|c| c.value("curves")).transpose()?;
        Ok(Choice {
            ids: self.ids.clone(),
            near: self.near.iter().map(near).collect(),
            picked: picked.cloned().unwrap_or_default(),
            seams: self.seams.as_ref().map(|s| s.value("seams").cloned()).transpose()?,
            chain: self.chain,
            longer: self.longer.map(|l| l.resolve(diagonal)),
            along: self.along.clone(),
            within: self.within.as_ref().map(|s| s.value("within").map(|s| s.0.clone())).transpose()?,
            convexity: match (self.convex, self.concave) {
                (true, _) => Some(Convexity::Convex),
                (_, true) => Some(Convexity::Concave),
                _ => None,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn defaults_are_the_engine_s() {
        let made = Blend::default().with_radius(0.25).params(1.0, Format::Obj).unwrap();
        let engine = crate::blend::Params::new(0.25);
        assert_eq!((made.blend.alpha, made.blend.tolerance), (engine.alpha, engine.tolerance));
        assert_eq!((made.blend.profile, made.blend.overlap), (engine.profile, engine.overlap));
        assert_eq!(made.features.angle, features::Params::default().angle);
    }

    #[test]
    fn options_out_of_range_are_named() {
        let radius = || Blend::default().with_radius(0.1);
        let near = |at: [f64; 3]| vec![Near::from(DVec3::from(at))];
        for (operation, option) in [
            (Blend::default(), "radius"),
            (Blend::default().with_near(near([0.0; 3])), "radius"),
            (Blend::default().with_radius(-1.0), "radius"),
            (radius().with_near(near([f64::NAN; 3])), "near"),
            (radius().with_angle(180.0), "angle"),
            (radius().with_alpha(0.5), "alpha"),
            (radius().with_tolerance(f64::NAN), "tolerance"),
            (radius().with_reach(0.0), "reach"),
            (radius().with_longer(0.0), "longer"),
            (radius().with_along(vec![DVec3::ZERO]), "along"),
            (radius().with_convex(true).with_concave(true), "convex"),
            (radius().with_multiresolution(true), "multiresolution"),
        ] {
            assert_eq!(operation.validate().map_err(|e| e.option), Err(option), "{operation:?}");
        }
        assert_eq!(radius().validate(), Ok(()));
    }

    #[test]
    fn a_fillet_is_taken_back_by_a_sharp_profile() {
        let cube = mesh_core::shapes::cuboid(DVec3::ONE);
        let near = |x: f64| vec![Near::from(DVec3::new(x, x, 0.0))];
        let run = |blend: Blend, part: &Model| blend.run(part, Precision::F64, &Watch::default());
        let round = run(Blend::default().with_radius(0.2).with_near(near(0.5)), &cube.into()).unwrap().model;
        let sharp = run(Blend::default().with_profile(Profile::Sharp).with_near(near(0.45)), &round).unwrap();
        assert!((mesh_core::volume(&sharp.model.mesh) - 1.0).abs() < 1e-12);
        // A flat face is no fillet.
        let flat = Blend::default().with_profile(Profile::Sharp).with_near(vec![DVec3::new(0.0, 0.0, 0.5).into()]);
        assert!(matches!(run(flat, &round), Err(Error::Sharpen(sharpen::Refusal::NotRounded { .. }))));
    }

    /// A document holds a blend whole, and nothing that is no option.
    #[test]
    fn a_blend_survives_json() {
        let blend = Blend::default().with_radius([Length::Units(0.1), Length::OfDiagonal(0.02)]);
        let blend = blend.with_near(vec![Near { at: DVec3::X, radius: Some(0.3.into()) }]).with_ids(vec![1, 3]);
        let json = serde_json::to_string(&blend).unwrap();
        assert_eq!(serde_json::from_str::<Blend>(&json).unwrap(), blend, "{json}");
        assert!(serde_json::from_str::<Blend>("{\"radios\": 1}").is_err_and(|e| e.to_string().contains("radios")));
    }
}
