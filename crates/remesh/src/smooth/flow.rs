//! Smoothing by implicit curvature flow.

use super::held::{Task, inner_areas};
use crate::{Error, Frozen};
use glam::DVec3;
use mesh_core::{Adjacency, Positions, Watch};
use mesh_operators::Laplacian;

/// How far the curvature flow goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Duration in square model units. A wave of length l on a flat surface keeps 1 / (1 + time · (2π/l)²) of its height
    /// in one step; a ball of radius R becomes one of √(R² − 4·time) in many.
    pub time: f64,
    /// Steps that the time is divided into. One is stable for any time; more follow the true flow more closely.
    pub steps: usize,
}

impl Flow {
    /// A single step that halves waves of a length and all but removes much shorter ones.
    pub fn halving(wavelength: f64) -> Self {
        Self { time: (wavelength / std::f64::consts::TAU).powi(2), steps: 1 }
    }
}

/// The vertices' places after mean-curvature flow ∂x/∂t = −2H·n by implicit steps (\[Desbrun1999\]).
///
/// The boundary and what is frozen keep their bits. Each step solves one sparse system; O(n^1.5) for n free vertices.
/// The same input gives the same bits for any number of threads.
///
/// ```
/// use mesh_core::{Connected, Watch, shapes};
/// let ball = Connected::new(shapes::icosphere(1.0, 4))?;
/// let flow = remesh::Flow { time: 0.1, steps: 50 };
/// let points = remesh::curvature_flow(&ball, &remesh::Frozen::default(), &flow, &Watch::default())?;
/// assert!(points.iter().all(|p| (p.length() - (1.0f64 - 0.4).sqrt()).abs() < 5e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::NotPositive`], [`Error::NotFinite`], [`Error::Count`], [`Error::IllConditioned`], [`Error::Cancelled`].
pub fn curvature_flow<M: Adjacency + Positions + Sync>(
    mesh: &M,
    frozen: &Frozen,
    flow: &Flow,
    watch: &Watch,
) -> Result<Vec<DVec3>, Error> {
    if !(flow.time > 0.0 && flow.time.is_finite()) {
        return Err(Error::NotPositive { name: "time", value: flow.time });
    }
    let mut task = Task::new(mesh, frozen)?;
    let step = flow.time / flow.steps.max(1) as f64 / (task.scale * task.scale);
    let mut before = None;
    for done in 0..flow.steps {
        watch.step("smooth", done as f64 / flow.steps as f64)?;
        if task.free().is_empty() {
            break;
        }
        let (laplacian, areas) = (Laplacian::cotangent(&task.moved), inner_areas(&task.moved));
        let system = task.prepared(before.take(), |v, row| {
            row.push((v, areas[v as usize]));
            laplacian.add_row(v, step, row);
        })?;
        let right: Vec<DVec3> =
            task.free().iter().map(|&v| areas[v as usize] * task.moved.points[v as usize]).collect();
        system.solve(&mut task.moved.points, &right, 1);
        before = Some(system);
    }
    Ok(task.finish())
}
