//! How the cross-section varies along a curve: profiles at places, mixed point by point in between.

use crate::params::Params;
use crate::radii::{chain, of_nearest};
use glam::DVec3;
use mesh_core::{Connected, TriMesh};
use profile_nurbs::{Profile, Section};
use spine::{BlendCurve, Law};

/// The cross-sections along one curve.
#[derive(Clone, Debug)]
pub(crate) struct Profiles {
    /// Those at the keys, and last the one away from them.
    all: Vec<Profile>,
    /// By key: where along the curve each holds.
    law: Option<Law>,
}

impl Profiles {
    /// For each curve of a blend.
    pub fn of(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params) -> Vec<Self> {
        let own = of_nearest(mesh, curves, params.profile_at.iter().map(|k| k.0));
        let profiles = |(curve, own): (&BlendCurve, Vec<usize>)| {
            let keys: Vec<(DVec3, f64)> =
                own.iter().enumerate().map(|(i, &k)| (params.profile_at[k].0, i as f64)).collect();
            let mut all: Vec<Profile> = own.iter().map(|&k| params.profile_at[k].1.clone()).collect();
            let law = if keys.is_empty() {
                None
            } else {
                Law::new(chain(mesh, curve), curve.closed, &keys, all.len() as f64)
            };
            all.push(params.profile.clone());
            Self { all, law }
        };
        curves.iter().zip(own).map(profiles).collect()
    }

    /// Appends the profile of a ball at `center`, as [`Profile::points`] does.
    pub fn points(&self, center: DVec3, section: &Section, count: usize, out: &mut Vec<DVec3>) {
        let rest = self.all.len() - 1;
        let ([before, after], t) = self.law.as_ref().map_or(([rest as f64; 2], 0.0), |law| law.between(center));
        let profile = |key: f64| &self.all[(key as usize).min(rest)];
        let first = out.len();
        profile(before).points(section, count, out);
        if t > 0.0 {
            let mut other = Vec::with_capacity(count + 1);
            profile(after).points(section, count, &mut other);
            out[first..].iter_mut().zip(other).for_each(|(p, q)| *p = p.lerp(q, t));
        }
    }
}
