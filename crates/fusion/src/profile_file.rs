//! Profiles from files: a NURBS curve in the section's own frame, as JSON or TOML.

use glam::DVec3;
use profile_nurbs::{Nurbs, Profile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a file holds no profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProfileFileError {
    /// It is neither well-formed JSON nor well-formed TOML with the known keys.
    #[error("no profile can be read: {0}")]
    Syntax(String),
    /// Its numbers make no curve, or none that runs from foot to foot.
    #[error(transparent)]
    Curve(#[from] profile_nurbs::Error),
}

/// A curve as written. Unknown keys are refused, so that a misspelt one does not pass unseen.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CurveFile {
    degree: u8,
    points: Vec<[f64; 2]>,
    #[serde(default)]
    weights: Option<Vec<f64>>,
    #[serde(default)]
    knots: Option<Vec<f64>>,
}

impl CurveFile {
    /// The profile, if the numbers make one.
    pub(crate) fn profile(self) -> Result<Profile, profile_nurbs::Error> {
        let degree = usize::from(self.degree);
        let points: Vec<DVec3> = self.points.iter().map(|p| DVec3::new(p[0], p[1], 0.0)).collect();
        let weights = self.weights.unwrap_or_else(|| vec![1.0; points.len()]);
        let knots = self.knots.unwrap_or_else(|| clamped(degree, points.len()));
        Profile::custom(Nurbs::new(degree, &knots, &points, &weights)?)
    }

    /// A curve as it would be written.
    pub(crate) fn of(curve: &Nurbs) -> Self {
        Self {
            degree: curve.degree() as u8,
            points: curve.control_points().map(|p| [p.x, p.y]).collect(),
            weights: Some(curve.weights().collect()),
            knots: Some(curve.knots().to_vec()),
        }
    }
}

/// Reads a profile: `degree`, control `points` (pairs), and if wanted `weights` (else all 1) and `knots` (else clamped
/// and even). Text that begins with `{` is JSON, any other TOML.
///
/// The frame is the section's own: (1, 0) is the first foot (left of the curve), (0, 0) the apex where the tangents meet,
/// (0, 1) the second foot. The curve must run from (1, 0) to (0, 1); it leaves the base surfaces smoothly if its first two
/// points lie on the first axis and its last two on the second.
///
/// ```
/// use fusion::{Profile, profile_from_text};
/// let flat = profile_from_text("degree = 1\npoints = [[1, 0], [0, 1]]")?;
/// assert!(matches!(flat, Profile::Custom(_)));
/// let cubic = r#"{"degree": 3, "points": [[1, 0], [0.4, 0], [0, 0.4], [0, 1]]}"#;
/// assert!(profile_from_text(cubic).is_ok());
/// assert!(profile_from_text("degree = 1\npoints = [[1, 0], [0, 2]]").is_err());
/// # Ok::<(), fusion::ProfileFileError>(())
/// ```
///
/// # Errors
/// [`ProfileFileError`].
pub fn profile_from_text(text: &str) -> Result<Profile, ProfileFileError> {
    let syntax = |e: &dyn std::fmt::Display| ProfileFileError::Syntax(e.to_string().trim().replace('\n', "; "));
    let file: CurveFile = if text.trim_start().starts_with('{') {
        serde_json::from_str(text).map_err(|e| syntax(&e))?
    } else {
        toml::from_str(text).map_err(|e| syntax(&e))?
    };
    Ok(file.profile()?)
}

/// Even knots, the ends repeated so that the curve begins and ends in its first and last points.
fn clamped(degree: usize, points: usize) -> Vec<f64> {
    // Refused by `Nurbs::new`, which counts in the same way without these lengths.
    if degree == 0 || points <= degree {
        return Vec::new();
    }
    let inner = points - degree;
    let inside = (1..inner).map(|i| i as f64 / inner as f64);
    std::iter::repeat_n(0.0, degree + 1).chain(inside).chain(std::iter::repeat_n(1.0, degree + 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use profile_nurbs::Section;

    #[test]
    fn a_quarter_circle_by_weights_is_the_arc() {
        let text =
            format!(r#"{{"degree": 2, "points": [[1, 0], [0, 0], [0, 1]], "weights": [1, {}, 1]}}"#, 0.5f64.sqrt());
        let section = Section::from_ball(DVec3::ONE, DVec3::new(0.0, 1.0, 1.0), DVec3::new(1.0, 0.0, 1.0)).unwrap();
        let (mut own, mut arc) = (vec![], vec![]);
        profile_from_text(&text).unwrap().points(&section, 16, &mut own);
        Profile::Arc.points(&section, 16, &mut arc);
        // Both are evenly spaced, the one along chords and the other along the arc.
        assert!(own.iter().zip(&arc).all(|(p, q)| p.distance(*q) < 1e-3));
        assert!(own.iter().all(|p| (p.distance(DVec3::ONE) - 1.0).abs() < 1e-12));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let says = |text: &str| profile_from_text(text).unwrap_err().to_string();
        assert!(says("").contains("degree"));
        assert!(says("degree = 2\npoints = [[1, 0], [0, 1]]").contains("degree + 1 points"));
        assert!(says("degree = 1\npoints = [[1, 0], [0, 1]]\nweight = [1, 1]").contains("weight"));
        assert!(says("{\"degree\": 1, \"points\": [[1, 0], [0, 1]]").contains("EOF"));
        assert!(says("degree = 1\npoints = [[0, 0], [0, 1]]").contains("(1, 0, 0)"));
        assert!(says("degree = 0\npoints = [[1, 0], [0, 1]]").contains("degree"));
        assert!(says("degree = 1\npoints = [[1, 0], [0, 1]]\nweights = [1, -1]").contains("weight 1"));
        assert!(says("degree = 18446744073709551615\npoints = [[1, 0], [0, 1]]").len() > 3);
    }
}
