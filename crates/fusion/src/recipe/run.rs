//! The steps of a recipe, in order.

use super::joins::Rims;
use super::{Recipe, Step};
use crate::cluster::cluster;
use crate::cut::{self, cut};
use crate::outcome::{Outcome, Promise, finish_as};
use crate::{Counts, Error, Report, join::join as join_parts, round};
use mesh_core::{Bounds, Faces, Origins, Stage, TriMesh, Watch, bounds};
use mesh_io::{Format, Model};
use toml::Spanned;

/// A part on its way.
pub(super) struct Piece {
    pub(super) name: String,
    pub(super) mesh: TriMesh,
    /// With respect to the recipe's parts.
    pub(super) origins: Origins,
}

/// A recipe being replayed.
pub(super) struct Replay<'a> {
    pub(super) recipe: &'a Recipe,
    /// The parts as they came, posed once the poses have been taken: what origins and attributes refer to.
    pub(super) first: Vec<Model>,
    pub(super) pieces: Vec<Piece>,
    /// The loops that parts and results had when they were named.
    pub(super) rims: Vec<Rims>,
    pub(super) format: Format,
    report: Report,
    pub(super) watch: &'a Watch,
}

impl Recipe {
    /// Replays the recipe on its parts' contents, in their order. Origins and attributes refer to the parts as posed.
    ///
    /// # Errors
    /// [`Error::Step`], naming the step; [`Error::Recipe`] where what the recipe asks for is not there at that point.
    pub fn run(&self, parts: &[Model], format: Format, watch: &Watch) -> Result<Outcome, Error> {
        if parts.len() != self.parts.len() {
            return Err(self.error(0..0, format!("{} parts are needed", self.parts.len())).into());
        }
        let piece = |(i, (part, model)): (usize, (&super::Part, &Model))| Piece {
            name: part.name.get_ref().clone(),
            mesh: model.mesh.clone(),
            origins: Origins::identity(i as u32, model.mesh.vertex_count(), model.mesh.face_count()),
        };
        let mut replay = Replay {
            recipe: self,
            first: parts.to_vec(),
            pieces: self.parts.iter().zip(parts).enumerate().map(piece).collect(),
            rims: vec![],
            format,
            report: Report::new("run", parts.iter().map(|m| Counts::of("", &m.mesh)).collect()),
            watch,
        };
        for step in self.order() {
            match step {
                Step::Cut => replay.cut()?,
                Step::Pose => replay.pose()?,
                Step::Boolean => replay.booleans()?,
                Step::Compose => replay.composes()?,
                Step::Blend => replay.blends()?,
                Step::Cluster => replay.clusters()?,
                Step::Detail => replay.details()?,
                Step::Output => {}
            }
        }
        replay.finish()
    }
}

impl Replay<'_> {
    fn cut(&mut self) -> Result<(), Error> {
        for (i, part) in self.recipe.parts.iter().enumerate().filter(|(_, p)| !p.cut.is_empty()) {
            let cuts = self.recipe.cuts(part)?;
            let params = cut::Params::new(cuts, self.format);
            let model = Model::from(std::mem::take(&mut self.pieces[i].mesh));
            let name = format!("cut of {}", self.pieces[i].name);
            let outcome = cut(&model, &params, self.watch).map_err(|e| step(&name, e))?;
            self.take_up(&[i], std::slice::from_ref(&model), &name, outcome);
        }
        Ok(())
    }

    fn pose(&mut self) -> Result<(), Error> {
        let meshes: Vec<&TriMesh> = self.first.iter().map(|m| &m.mesh).collect();
        // Openings are those of the cut parts, if they have been cut.
        let pieces = |i: usize| self.pieces.iter().find(|p| p.name == *self.recipe.parts[i].name.get_ref());
        let cut: Vec<&TriMesh> = (0..meshes.len()).map(|i| pieces(i).map_or(meshes[i], |p| &p.mesh)).collect();
        let poses = self.recipe.poses(&cut)?;
        for (i, (part, pose)) in self.recipe.parts.iter().zip(poses).enumerate() {
            self.first[i] = pose.model(std::mem::take(&mut self.first[i]));
            if let Some(piece) = self.pieces.iter_mut().find(|p| p.name == *part.name.get_ref()) {
                piece.mesh = pose.mesh(std::mem::take(&mut piece.mesh));
            }
        }
        Ok(())
    }

    fn booleans(&mut self) -> Result<(), Error> {
        for boolean in &self.recipe.boolean {
            let which = match &boolean.pieces.parts {
                None => (0..self.pieces.len()).collect(),
                Some(names) => names.iter().map(|n| self.find(n)).collect::<Result<Vec<_>, _>>()?,
            };
            let params = boolean.operation.params(self.diagonal(), self.format);
            let params = params.map_err(|e| boolean.wrong(self.recipe, &e))?;
            let at = self.step("boolean", &which, |models, watch| join_parts(models, &params, watch))?;
            self.rename(at, boolean.pieces.name.as_ref());
        }
        Ok(())
    }

    fn blends(&mut self) -> Result<(), Error> {
        for blend in &self.recipe.blend {
            let at = self.named_or_only(blend.pieces.part.as_ref(), "name the part to blend")?;
            let params = blend.operation.params(self.diagonal(), self.format);
            let params = params.map_err(|e| blend.wrong(self.recipe, &e))?;
            self.step("blend", &[at], |models, watch| round::round(&models[0], &params, watch))?;
        }
        Ok(())
    }

    fn clusters(&mut self) -> Result<(), Error> {
        for table in &self.recipe.cluster {
            let at = self.named_or_only(table.pieces.part.as_ref(), "name the part to round")?;
            let params = table.operation.params(self.format).map_err(|e| table.wrong(self.recipe, &e))?;
            self.step("clusters", &[at], |models, watch| Ok(cluster(&models[0], &params, watch)?.outcome))?;
        }
        Ok(())
    }

    /// Validates and describes the one piece that is left.
    fn finish(mut self) -> Result<Outcome, Error> {
        let last = self.only("join what is left over")?;
        let piece = self.pieces.swap_remove(last);
        finish_as(Promise::Manifold, &self.first[..], piece.mesh, piece.origins, self.format, self.report, self.watch)
    }

    /// Takes one step with some pieces, and puts what it makes in their place; gives that place.
    pub(super) fn step(
        &mut self,
        kind: &str,
        which: &[usize],
        make: impl FnOnce(&[Model], &Watch) -> Result<Outcome, Error>,
    ) -> Result<usize, Error> {
        let names: Vec<&str> = which.iter().map(|&w| self.pieces[w].name.as_str()).collect();
        let name = format!("{kind} of {}", names.join(", "));
        let models: Vec<Model> = which.iter().map(|&w| Model::from(self.pieces[w].mesh.clone())).collect();
        let outcome = make(&models, self.watch).map_err(|e| step(&name, e))?;
        Ok(self.take_up(which, &models, &name, outcome))
    }

    pub(super) fn rename(&mut self, piece: usize, name: Option<&Spanned<String>>) {
        if let Some(name) = name {
            self.pieces[piece].name.clone_from(name.get_ref());
        }
    }

    /// Puts a step's result in the place of the pieces it was made of; gives its place.
    pub(super) fn take_up(&mut self, which: &[usize], models: &[Model], name: &str, outcome: Outcome) -> usize {
        let inputs: Vec<&dyn Faces> = self.first.iter().map(|m| &m.mesh as &dyn Faces).collect();
        let stages: Vec<Stage<'_>> = which
            .iter()
            .zip(models)
            .map(|(&w, m)| Stage { origins: &self.pieces[w].origins, faces: &m.mesh })
            .collect();
        let origins = outcome.origins.compose(&stages, &inputs);
        let (report, given) = (&mut self.report, outcome.report);
        report.warnings.extend(given.warnings);
        report.residuals.extend(given.residuals);
        report.figures.extend(given.figures);
        report.notes.extend(given.notes);
        report.curves.extend(given.curves);
        report.diagnostics.extend(given.diagnostics);
        for mut stage in given.stages {
            stage.name = format!("{name}: {}", stage.name);
            report.stages.push(stage);
        }
        let piece = Piece { name: self.pieces[which[0]].name.clone(), mesh: outcome.model.mesh, origins };
        let mut gone = which.to_vec();
        gone.sort_unstable();
        gone.dedup();
        for &w in gone.iter().rev() {
            self.pieces.remove(w);
        }
        self.pieces.insert(gone[0], piece);
        gone[0]
    }

    fn named_or_only(&self, name: Option<&Spanned<String>>, remedy: &str) -> Result<usize, Error> {
        name.map_or_else(|| self.only(remedy), |name| self.find(name))
    }

    fn find(&self, name: &Spanned<String>) -> Result<usize, Error> {
        self.pieces.iter().position(|p| p.name == *name.get_ref()).ok_or_else(|| {
            let left = self.pieces.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
            let message = format!("part `{}` has gone into another by now; there are {left}", name.get_ref());
            self.recipe.error(name.span(), message).into()
        })
    }

    pub(super) fn only(&self, remedy: &str) -> Result<usize, Error> {
        if self.pieces.len() == 1 {
            return Ok(0);
        }
        let names = self.pieces.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", ");
        Err(self.recipe.error(0..0, format!("there are several parts at this point ({names}); {remedy}")).into())
    }

    /// The diagonal of the box around all pieces, in model units.
    pub(super) fn diagonal(&self) -> f64 {
        self.pieces.iter().map(|p| bounds(&p.mesh)).fold(Bounds::EMPTY, Bounds::union).diagonal()
    }
}

pub(super) fn step(name: &str, source: Error) -> Error {
    Error::Step { name: name.into(), source: Box::new(source) }
}

#[cfg(test)]
mod tests {
    use super::super::Error as Wrong;
    use super::*;
    use glam::DVec3;
    use mesh_core::{VertexOrigin, shapes, volume};

    const HEAD: &str = "version = 1\noutput = \"out.off\"\n";

    fn run(text: &str, parts: &[Model]) -> Result<Outcome, Error> {
        Recipe::parse(&format!("{HEAD}{text}"))?.run(parts, Format::Off, &Watch::default())
    }

    fn wrong(text: &str) -> Wrong {
        Recipe::parse(text).unwrap_err()
    }

    #[test]
    fn cut_pose_and_union_in_order() {
        let (ball, cube) = (Model::from(shapes::icosphere(1.0, 3)), Model::from(shapes::cuboid(DVec3::ONE)));
        let text = "
            [[part]]
            name = \"ball\"
            mesh = \"ball.off\"
            scale = 2.0
            rotate = { axis = [0, 0, 3], angle = 90 }
            translate = [10.0, 0.0, 0.0]
            [[part.cut]]
            plane = { point = [0.5, 0, 0], normal = [1, 0, 0] }
        ";
        let posed = run(text, std::slice::from_ref(&ball)).unwrap();
        // What was cut off at x = 0.5 is, turned and scaled, what lies beyond y = 1.
        let top = posed.model.mesh.positions.iter().map(|p| p.y).fold(f64::MIN, f64::max);
        assert!((top - 1.0).abs() < 1e-12, "{top}");
        for (p, origin) in posed.model.mesh.positions.iter().zip(posed.origins.vertices.as_slice()) {
            if let VertexOrigin::Input { vertex, .. } = origin {
                let raw = ball.mesh.positions[vertex.index()];
                assert!(p.distance(2.0 * DVec3::new(-raw.y, raw.x, raw.z) + 10.0 * DVec3::X) < 1e-14);
            }
        }
        let both = "
            [[part]]
            name = \"a\"
            mesh = \"cube.off\"
            [[part]]
            name = \"b\"
            mesh = \"cube.off\"
            translate = [0.5, 0.5, 0.5]
            [[boolean]]
            operation = \"difference\"
            parts = [\"b\", \"a\"]
        ";
        let rest = run(both, &[cube.clone(), cube.clone()]).unwrap();
        assert!((volume(&rest.model.mesh) - 0.875).abs() < 1e-14);
        // The same bits where nothing was posed.
        let same = run("[[part]]\nname = \"a\"\nmesh = \"cube.off\"", std::slice::from_ref(&cube)).unwrap();
        assert_eq!(same.model.mesh, cube.mesh);
    }

    #[test]
    fn a_cube_is_rounded_by_clusters() {
        let cube = Model::from(shapes::cuboid(DVec3::ONE));
        let text = "
            [[part]]
            name = \"cube\"
            mesh = \"cube.off\"
            scale = 2.0
            [[cluster]]
            extent = 0.5
            tolerance = 1e-3
            clusters = [{ vertices = [0] }, { vertices = [1, 3], degree = [4, 2] }]
        ";
        let round = run(text, &[cube]).unwrap();
        assert_eq!((round.report.figures["patches"], round.report.figures["strips"]), (2.0, 1.0));
        let rest = volume(&round.model.mesh);
        assert!(rest > 7.0 && rest < 8.0, "{rest}");
        // The five vertices in no cluster are still the input's.
        assert_eq!(round.report.kept_vertices, 5);
    }

    #[test]
    fn what_is_wrong_is_named_by_line_and_key() {
        for (text, line, key, says) in [
            ("version = 2\noutput = \"a.off\"", 1, "version", "version 1"),
            ("version = 1\noutput = \"a.off\"\nfoo = 3", 3, "foo", "unknown key `foo`; here may stand version, output"),
            ("version = 1\noutput = 7", 2, "output", "string"),
            ("version = 1\noutput = \"a.off\"", 1, "version", "[[part]]"),
            (
                "version = 1\noutput = \"a.off\"\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\nscale = 0.0",
                6,
                "scale",
                "above 0",
            ),
            (
                "version = 1\noutput = \"a.off\"\n[[part]]\nname = \"a\"\nmesh = \"a.off\"\n[[boolean]]\nparts = [\"a\",\n \"b\"]",
                8,
                "\"b\"",
                "no part `b`",
            ),
            (
                "version = 1\noutput = \"a.off\"\nsteps = [\"cut\", \"cut\"]\n[[part]]\nname = \"a\"\nmesh = \"a.off\"",
                3,
                "steps",
                "once",
            ),
        ] {
            let error = wrong(text);
            assert_eq!((error.line, error.key.as_str()), (line, key), "{error}");
            assert!(error.message.contains(says), "{error}");
        }
    }

    /// One tube joined to two balls, one end after the other: the second join names a loop of a part that the first has used up.
    #[test]
    fn openings_are_named_by_their_parts_through_several_joins() {
        let part = |name: &str, mesh: &str, at: f64, normal: f64| {
            format!(
                "[[part]]\nname = \"{name}\"\nmesh = \"{mesh}.off\"\ntranslate = [0, 0, {at:?}]\n[[part.cut]]\nplane = {{ point = [0, 0, {:?}], normal = [0, 0, {normal:?}] }}\n",
                0.8 * normal
            )
        };
        let text = [
            part("low", "ball", -2.5, 1.0),
            "[[part]]\nname = \"tube\"\nmesh = \"tube.off\"\n".into(),
            part("high", "ball", 2.5, -1.0),
            "[[compose]]\nloops = [\"low:0\", \"tube:0\"]\n[[compose]]\nloops = [\"tube:1\", \"high\"]\nname = \"all\"\n".into(),
        ]
        .concat();
        let (ball, tube) = (shapes::icosphere(1.0, 3), shapes::open_cylinder(0.6, 1.6, 24, 8));
        let middle = 0.5 * (bounds(&tube).min.z + bounds(&tube).max.z);
        let tube = shapes::posed(tube, glam::DQuat::IDENTITY, DVec3::NEG_Z * middle);
        // Whichever end of the tube is loop 0.
        let turned = text.replace("tube:0", "tube:x").replace("tube:1", "tube:0").replace("tube:x", "tube:1");
        let parts = [Model::from(ball.clone()), Model::from(tube), Model::from(ball)];
        let both = [run(&text, &parts), run(&turned, &parts)];
        let whole = both.into_iter().find_map(Result::ok).expect("one of the two ends is near");
        assert_eq!(whole.report.validity.closed, Some(true));
        assert_eq!(crate::Info::of(&whole.model.mesh, &Watch::default()).unwrap().genus, Some(0));
    }

    #[test]
    fn leftovers_and_spent_parts_are_refused() {
        let cube = Model::from(shapes::cuboid(DVec3::ONE));
        let two = "[[part]]\nname = \"a\"\nmesh = \"c.off\"\n[[part]]\nname = \"b\"\nmesh = \"c.off\"\ntranslate = [0.5, 0.3, 0.2]\n";
        let error = run(two, &[cube.clone(), cube.clone()]).unwrap_err();
        assert!(matches!(&error, Error::Recipe(e) if e.message.contains("a, b")), "{error}");
        let spent = format!("{two}[[boolean]]\n[[blend]]\npart = \"b\"\nradius = 0.1\n");
        let error = run(&spent, &[cube.clone(), cube]).unwrap_err();
        assert!(matches!(&error, Error::Recipe(e) if e.message.contains("by now")), "{error}");
    }
}
