//! Silhouettes, as options give them.

use super::option_error::{Check, ensure};
use crate::compose::Silhouette;
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A silhouette that a surface shall have, drawn as a stroke or as several that are chained.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SilhouetteArg {
    /// Direction of the view.
    #[schemars(with = "[f64; 3]")]
    pub view: DVec3,
    /// One stroke.
    #[schemars(with = "Vec<[f64; 3]>")]
    pub stroke: Vec<DVec3>,
    /// Several that are chained.
    #[schemars(with = "Vec<Vec<[f64; 3]>>")]
    pub strokes: Vec<Vec<DVec3>>,
    /// Whether they outline a hole; told by the strokes where left out.
    pub hole: Option<bool>,
    /// Other places for the two middle control points.
    #[schemars(with = "Option<[[f64; 3]; 2]>")]
    pub control: Option<[DVec3; 2]>,
    /// Moves of the two along the view; a hole takes one number.
    pub depth: Depth,
}

/// One move along a view, or two.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "moves along the view are a number, or two")]
#[schemars(title = "number, or two")]
pub enum Depth {
    /// Everything by as much.
    One(f64),
    /// Each of the two middle control points.
    Two([f64; 2]),
}

impl Default for Depth {
    fn default() -> Self {
        Self::One(0.0)
    }
}

impl Depth {
    fn moves(self) -> [f64; 2] {
        match self {
            Self::One(x) => [x; 2],
            Self::Two(both) => both,
        }
    }
}

impl SilhouetteArg {
    fn all(&self) -> Vec<Vec<DVec3>> {
        if self.stroke.is_empty() { self.strokes.clone() } else { vec![self.stroke.clone()] }
    }

    pub(super) fn check(&self) -> Check {
        let wrong = |holds, says: &str| ensure(holds, "silhouette", || says.into());
        wrong(self.view.is_finite() && self.view != DVec3::ZERO, "a view is a direction other than 0, 0, 0")?;
        wrong(self.stroke.is_empty() != self.strokes.is_empty(), "a silhouette needs either a stroke or strokes")?;
        let points: Vec<DVec3> = self.all().concat();
        let finite = points.iter().all(|p| p.is_finite());
        wrong(points.len() >= 2 && finite, "a stroke needs two points or more, in finite numbers")?;
        let control = self.control.iter().flatten().all(|p| p.is_finite());
        wrong(control, "control points are two points in finite numbers")?;
        let moves = self.depth.moves().iter().all(|x| x.is_finite());
        wrong(moves, "moves along the view are finite numbers")
    }

    pub(super) fn resolve(&self) -> Silhouette {
        Silhouette {
            view: self.view,
            strokes: self.all(),
            hole: self.hole,
            control: self.control,
            depth: self.depth.moves(),
        }
    }
}
