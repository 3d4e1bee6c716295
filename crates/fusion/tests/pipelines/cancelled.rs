//! Whoever stops a job hears that it was stopped, and no other reason, at whichever step that is.

use fusion::blend::{self, Surface, keep};
use fusion::compose::{self, compose};
use fusion::cut::{self, PlaneCut, cut};
use fusion::mesh_core::{Watch, shapes};
use fusion::{
    Choice, Error, Operation, Region, cluster, detail, detail_transfer, features, join, remesh, remeshing, round,
    sharpen,
};
use glam::{DQuat, DVec3};
use mesh_io::{Format, Model};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

type Job = Box<dyn Fn(&Watch) -> Result<(), Error>>;

/// How many of a job's steps it is stopped at.
const STOPS: usize = 24;

/// A handle that cancels itself at one step, and the count of steps.
fn stopping_at(step: usize) -> (Watch, Arc<AtomicUsize>) {
    let (own, count) = (Arc::new(OnceLock::<Watch>::new()), Arc::new(AtomicUsize::new(0)));
    let (handle, counted) = (own.clone(), count.clone());
    let watch = Watch::new(move |_, _| {
        if counted.fetch_add(1, Ordering::Relaxed) == step
            && let Some(watch) = handle.get()
        {
            watch.cancel();
        }
    });
    own.get_or_init(|| watch.clone());
    (watch, count)
}

fn joined(surface: Surface) -> Job {
    let [low, high] = [-0.6, 0.6].map(|z| {
        let ball = shapes::geodesic_sphere(1.0, 10);
        Model::from(shapes::posed(ball, DQuat::from_axis_angle(DVec3::new(0.6, 0.64, 0.48), z), DVec3::Z * z))
    });
    let blend = Some(blend::Params { surface, ..blend::Params::new(0.2) });
    let params =
        join::Params { operation: Operation::Union, blend, seams: join::SeamChoice::default(), format: Format::Obj };
    let parts = [low, high];
    Box::new(move |watch| join::join(&parts, &params, watch).map(drop))
}

fn rounded_cube() -> round::Params {
    round::Params {
        features: features::Params::default(),
        choice: Choice { near: vec![DVec3::new(0.0, 0.5, 0.5).into()], ..Choice::default() },
        blend: blend::Params::new(0.1),
        format: Format::Obj,
    }
}

fn jobs() -> Vec<(&'static str, Job)> {
    let cube = || Model::from(shapes::cuboid(DVec3::ONE));
    let ball = || Model::from(shapes::icosphere(1.0, 3));
    let tube =
        |z: f64| Model::from(shapes::posed(shapes::open_cylinder(1.0, 1.0, 24, 4), DQuat::IDENTITY, z * DVec3::Z));
    let soft = round::round(&cube(), &rounded_cube(), &Watch::default()).unwrap().model;
    let region = |center: DVec3| Region::Near { center, radius: 0.6 };
    vec![
        ("join, stitch", joined(Surface::Stitch)),
        ("join, field", joined(Surface::Field)),
        ("join, keep", joined(Surface::Keep(keep::Params::default()))),
        ("join, keep on a coarser level", joined(Surface::Keep(keep::Params { levels: 1, ..keep::Params::default() }))),
        ("round", Box::new(move |watch| round::round(&cube(), &rounded_cube(), watch).map(drop))),
        (
            "sharpen",
            Box::new(move |watch| {
                let near = vec![(0.5 - 0.1 * (1.0 - 0.5f64.sqrt())) * DVec3::new(0.0, 1.0, 1.0)];
                let params = sharpen::Params { near, radius: None, angle: 40.0, format: Format::Obj };
                sharpen::sharpen(&soft, &params, watch).map(drop)
            }),
        ),
        (
            "cluster",
            Box::new(move |watch| cluster::cluster(&cube(), &cluster::Params::new(Format::Obj), watch).map(drop)),
        ),
        (
            "cut",
            Box::new(move |watch| {
                let plane = PlaneCut::new(DVec3::ZERO, DVec3::new(0.3, 0.2, 0.9));
                cut(&ball(), &cut::Params::new(vec![plane], Format::Obj), watch).map(drop)
            }),
        ),
        ("remesh", Box::new(move |watch| remesh(&ball(), &remeshing::Params::new(0.1, Format::Obj), watch).map(drop))),
        (
            "compose",
            Box::new(move |watch| {
                compose(&[tube(-0.8), tube(0.8)], &compose::Params::new(Format::Obj), watch).map(drop)
            }),
        ),
        (
            "detail",
            Box::new(move |watch| {
                let params = detail::Params {
                    target: region(DVec3::X),
                    sources: vec![(0, region(DVec3::NEG_X))],
                    transfer: detail_transfer::Params::default(),
                    format: Format::Obj,
                };
                detail::detail(&[ball()], &params, watch).map(drop)
            }),
        ),
    ]
}

#[test]
fn every_pipeline_says_that_it_was_stopped() {
    for (name, job) in jobs() {
        let (watch, count) = stopping_at(usize::MAX);
        job(&watch).unwrap_or_else(|e| panic!("{name}: {e}"));
        let steps = count.load(Ordering::Relaxed);
        assert!(steps > 1, "{name}: {steps} steps");
        for stop in 0..STOPS.min(steps) {
            let at = stop * steps / STOPS.min(steps);
            match job(&stopping_at(at).0) {
                Ok(()) => panic!("{name} went on after step {at} of {steps}"),
                Err(e) => assert!(e.is_cancelled(), "{name}, stopped at step {at} of {steps}: {e}"),
            }
        }
        let last = job(&stopping_at(steps - 1).0);
        assert!(last.is_err_and(|e| e.is_cancelled()), "{name}, stopped at its last step");
    }
}
