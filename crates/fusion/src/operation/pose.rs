//! Meshes moved.

use super::define::operation;
use super::linked::{Files, Linked, Solid};
use super::option_error::{Check, OptionError, ensure};
use super::options::Options;
use super::primitive::{On, Rotation, Snap};
use crate::pose::placement::Motion;
use crate::pose::pose;
use crate::pose::rest::height_above;
use crate::pose::similarity::Similarity;
use crate::{Error, Outcome};
use glam::{DQuat, DVec3};
use mesh_core::{TriMesh, Watch};
use mesh_io::Model;

operation! {
    /// Move a mesh: scale it, turn it, shift it, set it down on another
    ///
    /// ```
    /// use fusion::operation::Pose;
    /// use fusion::mesh_core::{Watch, bounds, shapes};
    /// use glam::DVec3;
    /// let pose = Pose::default().with_scale(2.0).with_translate(DVec3::X);
    /// let moved = pose.run(&shapes::cuboid(DVec3::ONE).into(), &Watch::default())?;
    /// assert_eq!(bounds(&moved.model.mesh).max, DVec3::new(2.0, 1.0, 1.0));
    /// # Ok::<(), fusion::Error>(())
    /// ```
    pub struct Pose {
        /// Scale about the origin, first
        #[schemars(extend("exclusiveMinimum" = 0))]
        #[cfg_attr(feature = "clap", arg(long, value_name = "S", default_value_t = Self::default().scale))]
        scale: f64 = 1.0;
        /// Turn about an axis through the origin by degrees, counter-clockwise seen against the axis; after scaling
        #[cfg_attr(feature = "clap", arg(long, value_name = "AX,AY,AZ,DEG", allow_hyphen_values = true))]
        rotate: Option<Rotation> = None;
        /// Shift, after turning
        #[schemars(with = "Option<[f64; 3]>")]
        #[cfg_attr(feature = "clap", arg(long, value_name = "X,Y,Z", value_parser = super::place::point,
            allow_hyphen_values = true))]
        translate: Option<DVec3> = None;
        /// Set it on a primitive, after the three
        #[cfg_attr(feature = "clap", arg(skip))]
        on: Option<On> = None;
        /// Make one of its openings face another, or a primitive, after all that
        #[cfg_attr(feature = "clap", arg(skip))]
        snap: Option<Snap> = None;
        /// Set it down on this mesh, last of all: along z, to where it would come to rest from high above, whether it stands
        /// above, within or below
        #[cfg_attr(feature = "clap", arg(long, value_name = "ONTO"))]
        drop: Option<Linked<Solid>> = None;
    }
}

impl Options for Pose {
    const NAME: &'static str = "pose";

    fn validate(&self) -> Check {
        ensure(self.scale > 0.0 && self.scale.is_finite(), "scale", || "a scale is a number above 0".into())?;
        let turns = self.rotate.is_none_or(|r| r.axis.try_normalize().is_some() && r.angle.is_finite());
        ensure(turns, "rotate", || "a turn needs an axis other than 0, 0, 0 and a finite angle".into())?;
        let shifts = self.translate.is_none_or(DVec3::is_finite);
        ensure(shifts, "translate", || "a shift is three finite numbers".into())?;
        self.on.as_ref().map_or(Ok(()), |on| on.check("on"))?;
        let gap = self.snap.as_ref().and_then(|s| s.gap).unwrap_or(0.0);
        ensure(gap.is_finite(), "snap", || "a gap is a finite number".into())
    }

    fn load(&mut self, files: &mut dyn Files) -> Check {
        self.drop.as_mut().map_or(Ok(()), |onto| onto.load("drop", |path| files.mesh(path).map(Solid)))
    }
}

impl Pose {
    /// Moves a mesh. Primitives and openings of other parts are those of documents; without one, `on` and `snap` are refused.
    ///
    /// # Errors
    /// [`Error::Option`] for an option out of its range, or for a mesh to be set on that is not below.
    pub fn run(&self, part: &Model, watch: &Watch) -> Result<Outcome, Error> {
        watch.step("pose", 0.0)?;
        let alone =
            |option| OptionError::new(option, "primitives and openings of other parts stand in documents alone");
        ensure(self.on.is_none(), "on", || alone("on").reason)?;
        ensure(self.snap.is_none(), "snap", || alone("snap").reason)?;
        let similarity = self.own()?;
        let similarity = self.dropped(similarity, &part.mesh)?;
        Ok(pose(part, &similarity))
    }

    /// Scale, turn and shift.
    pub(crate) fn own(&self) -> Result<Similarity, OptionError> {
        self.validate()?;
        let turn = self.rotate.map(|r| (r.axis, r.angle));
        let similarity = Similarity::new(self.scale, turn, self.translate.unwrap_or_default());
        similarity.ok_or_else(|| OptionError::new("scale", "a pose needs finite numbers and a scale above 0"))
    }

    /// The similarity, and then down onto another mesh.
    pub(crate) fn dropped(&self, similarity: Similarity, mesh: &TriMesh) -> Result<Similarity, OptionError> {
        let Some(onto) = &self.drop else { return Ok(similarity) };
        let moved = TriMesh {
            positions: mesh.positions.iter().map(|&p| similarity.point(p)).collect(),
            faces: mesh.faces.clone(),
        };
        let height = height_above(&moved, &onto.value("drop")?.0).ok_or_else(|| {
            OptionError::new("drop", "nothing of that mesh is below or above this one: shift it along x and y first")
        })?;
        Ok(similarity.then(Motion { rotation: DQuat::IDENTITY, translation: -height * DVec3::Z }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{bounds, shapes};

    #[test]
    fn a_ball_is_set_down_on_a_cube() {
        let cube = shapes::cuboid(DVec3::ONE);
        let ball = Model::from(shapes::icosphere(0.25, 4));
        let onto = Linked::Here(Solid(cube));
        for start in [9.0, 0.0, -9.0] {
            let pose = Pose::default().with_translate(DVec3::new(0.1, 0.2, start)).with_drop(onto.clone());
            let lowest = bounds(&pose.run(&ball, &Watch::default()).unwrap().model.mesh).min.z;
            assert!((lowest - 0.5).abs() < 1e-12, "{lowest}");
        }
        let aside = Pose::default().with_translate(2.0 * DVec3::X).with_drop(onto);
        assert!(matches!(aside.run(&ball, &Watch::default()), Err(Error::Option(e)) if e.option == "drop"));
    }

    #[test]
    fn what_does_not_move_keeps_its_bits() {
        let ball = Model::from(shapes::icosphere(0.3, 3));
        let same = Pose::default().run(&ball, &Watch::default()).unwrap();
        assert_eq!((same.model.mesh, same.report.kept_vertices), (ball.mesh.clone(), ball.mesh.positions.len()));
        let moved = Pose::default().with_translate(DVec3::X).run(&ball, &Watch::default()).unwrap();
        assert_eq!(moved.report.kept_vertices, 0);
    }
}
