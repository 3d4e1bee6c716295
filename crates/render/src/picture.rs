//! The picture, pass by pass: one ray per pixel, ambient light, colour, and more rays where there are edges.

use crate::ambient::openness;
use crate::camera::Camera;
use crate::color::{Paint, over};
use crate::light::{bytes, display, linear, shade};
use crate::params::{Error, MAX_SIDE, Params};
use crate::raster::Picture;
use crate::scene::{Scene, Sight};
use crate::wire::line_over;
use glam::{DVec2, DVec3};
use mesh_core::{Cancelled, TriMesh, Watch};
use rayon::prelude::*;

/// Largest difference between neighbouring pixels, in sRGB, that is left as it is.
const EDGE: f64 = 0.03;

/// Draws a mesh.
///
/// Time is O(pixels · log faces), two to three seconds for 1024² pixels on two cores, most of it for ambient
/// occlusion; memory about 250 bytes per pixel and 300 per face.
///
/// # Errors
/// [`Error`] for an empty mesh, corners that are not points, a size or view out of range, colours that do not fit the
/// mesh, and on cancellation.
pub fn picture(mesh: &TriMesh, params: &Params, watch: &Watch) -> Result<Picture, Error> {
    let (width, height) = (params.width, params.height);
    if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
        return Err(Error::Size { width, height });
    }
    let scene = Scene::new(mesh, params)?;
    let camera = Camera::framing(&scene.mesh.positions, params)?;
    let view = View { scene: &scene.with_floor(params, &camera), camera: &camera, params };
    let sights = view.first_look(watch)?;
    let open = openness(view.scene, &sights, width as usize, params.ambient_samples, watch)?;
    let coarse = view.colors(&sights, &open);
    let fine = view.refined(&coarse, &sights, &open, watch)?;
    Ok(Picture::new(width, height, fine.into_iter().flat_map(bytes).collect()))
}

struct View<'a> {
    scene: &'a Scene,
    camera: &'a Camera,
    params: &'a Params,
}

impl View<'_> {
    fn width(&self) -> usize {
        self.params.width as usize
    }

    /// What the middle of each pixel sees.
    fn first_look(&self, watch: &Watch) -> Result<Vec<Sight>, Cancelled> {
        self.rows(watch, "first look", |x, y| self.scene.look(&self.camera.ray(middle(x, y))))
    }

    /// The colour of the middle of each pixel, sRGB.
    fn colors(&self, sights: &[Sight], open: &[f32]) -> Vec<DVec3> {
        let width = self.width();
        (0..sights.len())
            .into_par_iter()
            .with_min_len(width)
            .map(|i| display(self.color(&sights[i], middle(i % width, i / width), f64::from(open[i]))))
            .collect()
    }

    /// The same, with more rays where neighbours differ.
    fn refined(
        &self,
        coarse: &[DVec3],
        sights: &[Sight],
        open: &[f32],
        watch: &Watch,
    ) -> Result<Vec<DVec3>, Cancelled> {
        let count = self.params.supersampling.clamp(1, 16);
        self.rows(watch, "edges", |x, y| {
            let here = coarse[y * self.width() + x];
            let differs = |i: usize| (coarse[i] - here).abs().max_element() > EDGE;
            if count == 1 || !self.around(x, y).any(differs) {
                return here;
            }
            // Averaged as displayed: light that is averaged linearly makes thin dark lines disappear.
            let mut sum = DVec3::ZERO;
            for sub in 0..count * count {
                let offset = DVec2::new(f64::from(sub % count) + 0.5, f64::from(sub / count) + 0.5) / f64::from(count);
                let at = DVec2::new(x as f64, y as f64) + offset;
                let sight = self.scene.look(&self.camera.ray(at));
                let open = self.open_like(&sight, sights, open, x, y);
                sum += display(self.color(&sight, at, open));
            }
            sum / f64::from(count * count)
        })
    }

    /// The openness of whichever pixel here or around sees the place most like this one.
    fn open_like(&self, sight: &Sight, sights: &[Sight], open: &[f32], x: usize, y: usize) -> f64 {
        let Some(place) = sight.place() else { return 1.0 };
        let difference = |i: usize| {
            let there = sights[i].place()?;
            Some((there.point - place.point).length() + 0.1 * (there.normal - place.normal).length())
        };
        self.around(x, y)
            .filter_map(|i| Some((difference(i)?, i)))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map_or(1.0, |(_, i)| f64::from(open[i]))
    }

    /// A pixel and its up to eight neighbours.
    fn around(&self, x: usize, y: usize) -> impl Iterator<Item = usize> {
        let (width, height) = (self.width(), self.params.height as usize);
        let columns = x.saturating_sub(1)..width.min(x + 2);
        (y.saturating_sub(1)..height.min(y + 2)).flat_map(move |v| columns.clone().map(move |u| v * width + u))
    }

    /// The colour of what is seen at a place of the picture, in linear light.
    fn color(&self, sight: &Sight, at: DVec2, open: f64) -> DVec3 {
        match *sight {
            Sight::Sky => self.background(at),
            Sight::Floor(_, strength) => self.background(at) * (1.0 - 0.75 * strength * (1.0 - open)),
            Sight::Surface { face, barycentric, shading_normal, front, .. } => {
                let in_camera = |v: DVec3| DVec3::from_array(self.camera.axes.map(|axis| v.dot(axis)));
                let eye = in_camera(-self.camera.ray(at).direction);
                let normal = in_camera(shading_normal);
                let base = if front {
                    self.scene.paint.at(&self.scene.mesh, face, barycentric, normal, eye)
                } else {
                    Paint::inside()
                };
                let lit = shade(base, normal, eye, open);
                self.params
                    .wireframe
                    .as_ref()
                    .map_or(lit, |wire| over(lit, line_over(self.camera, wire, self.scene.mesh.triangle(face), at)))
            }
        }
    }

    fn background(&self, at: DVec2) -> DVec3 {
        let [top, bottom] = self.params.background.map(linear);
        top.lerp(bottom, at.y / f64::from(self.params.height))
    }

    /// One value per pixel, rows in parallel.
    fn rows<T: Send>(
        &self,
        watch: &Watch,
        stage: &'static str,
        pixel: impl Fn(usize, usize) -> T + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        let height = self.params.height as usize;
        let rows: Result<Vec<Vec<T>>, Cancelled> = (0..height)
            .into_par_iter()
            .map(|y| {
                watch.step(stage, y as f64 / height as f64)?;
                Ok((0..self.width()).map(|x| pixel(x, y)).collect())
            })
            .collect();
        Ok(rows?.into_iter().flatten().collect())
    }
}

/// The middle of a pixel, in pixels from the top left.
fn middle(x: usize, y: usize) -> DVec2 {
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}
