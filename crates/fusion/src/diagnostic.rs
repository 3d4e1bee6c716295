//! What a job has to tell, as data: a code, a place, numbers, a sentence and a way out. All sentences are made here.

use crate::choice_refusal::Refusal as ChoiceRefusal;
use crate::inherited::Inherited;
use crate::repair_refusal::{Refusal as RepairRefusal, remedy};
use crate::{Error, blend};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// A choice that was made.
    Note,
    /// The result may not be what was wanted.
    Warning,
    /// There is no result.
    Error,
}

/// What a diagnostic is about.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, PartialEq, Eq, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Code {
    /// Which curve a point named, and how far away it is.
    CurveTaken,
    /// A point named a curve that is far away.
    CurveFar,
    /// A smaller radius was used at a place.
    RadiusReduced,
    /// A chosen curve was left sharp.
    LeftSharp,
    /// A field took the place of a strip.
    BlendedAsField,
    /// A blend runs out in a point.
    RunOut,
    /// Contact curves were moved to survive 32-bit coordinates.
    MovedForRounding,
    /// The solids do not cross.
    Apart,
    /// What one step of a repair mended.
    Repaired,
    /// A hole could not be filled.
    HoleLeft,
    /// An input crosses itself, and so does the result there.
    Inherited,
    /// Another warning, told by its sentence.
    Other,
    /// No edge of the mesh turns by the angle.
    NoEdges,
    /// A curve of this number does not exist.
    NoSuchCurve,
    /// No curve passes the filters.
    NothingChosen,
    /// A file of origins belongs to another mesh, or shows no seam.
    NoSeams,
    /// A solid that is to hold curves is open.
    OpenSolid,
    /// A ball of the radius asked for does not fit.
    RadiusTooLarge,
    /// A connectivity-preserving blend is impossible there.
    NotByKeep,
    /// An input is not an oriented 2-manifold.
    NotManifold,
    /// A repair leaves holes.
    Holes,
    /// The operation is impossible on this input, for the reason in the sentence.
    Impossible,
    /// The result failed its own validation.
    Invalid,
    /// An input cannot be read.
    Unreadable,
    /// An output cannot be written.
    Unwritable,
    /// The job was cancelled.
    Cancelled,
    /// The time limit ended the job.
    TimeLimit,
    /// Warnings were to count as failures.
    Strict,
}

/// One thing to tell.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq)]
pub struct Diagnostic {
    /// What it is about.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// The sentence.
    pub message: String,
    /// Where, in model units.
    pub at: Option<[f64; 3]>,
    /// The numbers in the sentence, by name; lengths in model units.
    pub numbers: BTreeMap<String, f64>,
    /// What to do about it.
    pub remedy: Option<String>,
}

impl Diagnostic {
    /// A diagnostic without a place, numbers or a remedy.
    pub fn new(code: Code, severity: Severity, message: impl Into<String>) -> Self {
        Self { code, severity, message: message.into(), at: None, numbers: BTreeMap::new(), remedy: None }
    }

    /// The same at a place.
    #[must_use]
    pub fn at(self, at: impl Into<Option<DVec3>>) -> Self {
        Self { at: at.into().map(|p| p.to_array()), ..self }
    }

    /// The same with a number.
    #[must_use]
    pub fn with(mut self, name: &str, value: f64) -> Self {
        self.numbers.insert(name.into(), value);
        self
    }

    /// The same with a way out.
    #[must_use]
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }

    /// What an error says.
    pub fn of(error: &Error) -> Self {
        let told = |code| Self::new(code, Severity::Error, error.to_string()).at(error.place());
        match error {
            e if e.is_cancelled() => told(Code::Cancelled),
            e if e.is_invalid_result() => told(Code::Invalid),
            Error::Step { source, .. } => Self { message: error.to_string(), ..Self::of(source) },
            Error::NotManifold { part, .. } => {
                told(Code::NotManifold).with("part", *part as f64).remedy("repair the mesh first")
            }
            Error::Choice(refusal) => of_choice(refusal, told),
            Error::Blend(blend::Error::DoesNotFit { radius, workable, .. }) => {
                let told = told(Code::RadiusTooLarge).with("radius", *radius);
                match workable {
                    Some(r) => told.with("workable", *r).remedy(format!("use a radius of {r}")),
                    None => told.remedy("use a smaller radius, or blend fewer curves"),
                }
            }
            Error::Repair(RepairRefusal::Open { loops, edges, torn, unfilled, .. }) => told(Code::Holes)
                .with("loops", *loops as f64)
                .with("edges", *edges as f64)
                .with("torn", *torn as f64)
                .with("unfilled", *unfilled as f64)
                .remedy(remedy(*unfilled)),
            Error::Blend(blend::Error::Keep(_)) => told(Code::NotByKeep).remedy("let the surface be stitched"),
            _ => told(Code::Impossible),
        }
    }

    /// The curve that a point names.
    pub(crate) fn curve_taken(point: DVec3, what: &str, id: usize, place: DVec3, distance: f64, far: f64) -> Self {
        let message = format!("the {what} nearest to {point} is {id}, {distance:.4e} away at {place}");
        let (code, severity) =
            if distance > far { (Code::CurveFar, Severity::Warning) } else { (Code::CurveTaken, Severity::Note) };
        let told = Self::new(code, severity, message).at(place).with("curve", id as f64).with("distance", distance);
        if distance > far { told.remedy("name a point on the curve, or the curve by its id") } else { told }
    }

    /// Crossings that the inputs brought along.
    pub(crate) fn inherited(crossings: &Inherited) -> Self {
        let Inherited { part, with, count, ref places } = *crossings;
        let at = places.first().map(|&p| DVec3::from(p));
        let what = match with {
            Some(other) => format!("part {part} and part {other} cross each other"),
            None => format!("part {part} crosses itself"),
        };
        let noun = if count == 1 { "pair" } else { "pairs" };
        let place = at.map_or(String::new(), |p| format!(" near {p}"));
        let message = format!("{what} in {count} {noun} of faces, and so does the result{place}");
        let told = Self::new(Code::Inherited, Severity::Warning, message).at(at).with("part", part as f64);
        let told = with.map_or(told.clone(), |other| told.with("with", other as f64));
        told.with("pairs", count as f64).remedy("repair the part first")
    }

    pub(crate) fn run_out(at: DVec3) -> Self {
        let message = format!("the blend runs out in a point at {at}, where no surface ends it");
        Self::new(Code::RunOut, Severity::Note, message).at(at)
    }

    pub(crate) fn blended_as_field(at: DVec3, what: &str) -> Self {
        let message = format!("the blend near {at} is made as a field: {what}");
        Self::new(Code::BlendedAsField, Severity::Warning, message).at(at)
    }

    pub(crate) fn radius_reduced(at: DVec3, asked: f64, used: f64) -> Self {
        let instead = if used > 0.0 {
            format!("one of radius {used} is used there, fading into the full one")
        } else {
            "the curve stays sharp there".to_string()
        };
        let message = format!("a ball of radius {asked} does not fit near {at}: {instead}");
        Self::new(Code::RadiusReduced, Severity::Warning, message)
            .at(at)
            .with("radius", asked)
            .with("used", used)
            .remedy("use a smaller radius")
    }

    pub(crate) fn left_sharp(at: DVec3, curves: usize, length: f64, what: &str) -> Self {
        let (noun, verb) = if curves == 1 { ("curve", "is") } else { ("curves", "are") };
        let message = format!("{curves} {noun} of {length:.4e} in length {verb} left sharp: {what} near {at}");
        Self::new(Code::LeftSharp, Severity::Warning, message)
            .at(at)
            .with("curves", curves as f64)
            .with("length", length)
            .remedy("use a smaller radius, or blend fewer curves")
    }

    pub(crate) fn moved_for_rounding(snap: f64) -> Self {
        let message = format!(
            "the linkages were moved by up to {snap} of the radius onto edges and vertices, to survive 32-bit coordinates"
        );
        Self::new(Code::MovedForRounding, Severity::Warning, message)
            .with("snap", snap)
            .remedy("write a format with 64-bit coordinates")
    }
}

fn of_choice(refusal: &ChoiceRefusal, told: impl Fn(Code) -> Diagnostic) -> Diagnostic {
    use ChoiceRefusal as R;
    match *refusal {
        R::NoEdges { angle, sharpest } => {
            let told = told(Code::NoEdges).with("angle", angle).with("sharpest", sharpest);
            told.remedy(format!("choose an angle below {sharpest:.1} degrees"))
        }
        R::NoSuchCurve { id, count } => told(Code::NoSuchCurve)
            .with("id", id as f64)
            .with("count", count as f64)
            .remedy("list the feature curves at the same angle"),
        R::NothingPasses { longest, .. } => {
            told(Code::NothingChosen).with("longest", longest).remedy("loosen the filters")
        }
        R::Open { .. } => told(Code::OpenSolid).remedy("give a closed solid"),
        R::OriginsOfAnother { faces, entries } => told(Code::NoSeams)
            .with("faces", faces as f64)
            .with("entries", entries as f64)
            .remedy("give the origins that were written together with this mesh"),
        R::NoSeams => told(Code::NoSeams).remedy("give the origins of a boolean of several solids"),
    }
}
