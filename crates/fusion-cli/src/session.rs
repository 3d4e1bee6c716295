//! One command from its arguments to its files.

use crate::failure::{Failure, with_files};
use crate::output::{self, Outputs};
use crate::progress::Progress;
use crate::shared_args::{Common, Source, Target};
use fusion::mesh_core::{Bounds, Origins, Watch, bounds};
use fusion::{Counts, Report, Severity, Stage, look_everywhere};
use mesh_io::{AtomicFiles, Format, Model};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

/// What every verb works with.
pub struct Session {
    common: Common,
    progress: Progress,
    /// The verb.
    name: &'static str,
    /// Time spent on reading so far.
    reading: Cell<Duration>,
    /// What was read.
    inputs: RefCell<Vec<Counts>>,
}

impl Session {
    /// Starts the clock of the progress bar and listens to Ctrl-C.
    pub fn start(common: Common, name: &'static str) -> Result<Self, Failure> {
        if let Some(report) = &common.report {
            if is_stream(report) {
                return Err(Failure::usage("--report needs a file; standard output is for results"));
            }
            output::check_writable(report)?;
        }
        let report = common.report.clone();
        let give_up = move |failure: &Failure| write_failed(report.as_deref(), failure, name, vec![]);
        let progress = Progress::start(!common.no_progress && !common.quiet, common.time_limit, give_up);
        Ok(Self { common, progress, name, reading: Cell::default(), inputs: RefCell::default() })
    }

    /// Ends the job: a failure is written to the report, and one for lack of time is told as such.
    pub fn close(&self, result: Result<(), Failure>) -> Result<(), Failure> {
        let failure = match (result, self.progress.late()) {
            (Ok(()), _) => return Ok(()),
            (Err(failure), Some(after)) if failure.is_cancelled() => Failure::late(after),
            (Err(failure), _) => failure,
        };
        write_failed(self.common.report.as_deref(), &failure, self.name, self.inputs.take());
        Err(failure)
    }

    /// Any warning is a failure where the user said so.
    fn check_strict(&self, report: &Report) -> Result<(), Failure> {
        if !self.common.strict || report.warnings.is_empty() {
            return Ok(());
        }
        for warning in told(&report.warnings) {
            self.warn(&warning);
        }
        Err(Failure::strict(report))
    }

    /// What long loops report to.
    pub fn watch(&self) -> &Watch {
        &self.progress.watch
    }

    /// Set once the user or the time limit has asked to stop.
    pub fn stopped(&self) -> Arc<AtomicBool> {
        self.progress.stopped()
    }

    /// The options of every verb.
    pub fn common(&self) -> &Common {
        &self.common
    }

    /// Tells the user something, unless asked to be quiet.
    pub fn warn(&self, text: &str) {
        if !self.common.quiet {
            self.progress.suspend(|| {
                let _ = writeln!(std::io::stderr(), "warning: {text}");
            });
        }
    }

    /// Tells the user something only if asked to.
    pub fn note(&self, text: &str) {
        if self.common.verbose {
            self.progress.suspend(|| {
                let _ = writeln!(std::io::stderr(), "{text}");
            });
        }
    }

    /// Reads one mesh.
    pub fn read(&self, path: &Path, source: &Source) -> Result<Model, Failure> {
        self.read_all(std::slice::from_ref(&path.to_path_buf()), source)?.pop().ok_or_else(Failure::cancelled)
    }

    /// Reads the inputs in order.
    pub fn read_all(&self, paths: &[PathBuf], source: &Source) -> Result<Vec<Model>, Failure> {
        let from = source.from.as_deref().map(Format::from_name).transpose().map_err(Failure::usage)?;
        if paths.iter().filter(|p| is_stream(p)).count() > 1 {
            return Err(Failure::usage("only one input can be standard input"));
        }
        let start = Instant::now();
        let mut models = vec![];
        for path in paths {
            self.watch().step("read", 0.0).map_err(|_| Failure::cancelled())?;
            let model = read_model(path, from)?;
            for note in &model.notes {
                self.note(&format!("{}: {note}", path.display()));
            }
            self.inputs.borrow_mut().push(Counts::of(path.display().to_string(), &model.mesh));
            models.push(model);
        }
        self.reading.set(self.reading.get() + start.elapsed());
        Ok(models)
    }

    /// Writes the result, its origins and the report, all or none.
    pub fn write(
        &self,
        target: &Destination,
        model: &Model,
        origins: Option<&Origins>,
        report: &Report,
    ) -> Result<(), Failure> {
        self.write_with(target, model, origins, vec![], report)
    }

    /// The same, with further files.
    pub fn write_with(
        &self,
        target: &Destination,
        model: &Model,
        origins: Option<&Origins>,
        files: Vec<(PathBuf, Vec<u8>)>,
        report: &Report,
    ) -> Result<(), Failure> {
        let mut report = report.clone();
        if let Some(origins) = origins.filter(|_| report.validity.self_intersections.is_some()) {
            let looked = look_everywhere(model, origins, target.format, &mut report, self.watch());
            looked.map_err(|_| Failure::cancelled())?;
        }
        let origins = target.origins.as_ref().zip(origins);
        let origins = origins.map(|(path, origins)| (path.clone(), fusion::origins_to_json(origins).into_bytes()));
        let files = files.into_iter().chain(origins).collect();
        self.write_several(&[(target, model)], files, &report, Report::to_json)
    }

    /// Writes files other than meshes, and the report, all or none.
    pub fn write_files(&self, files: Vec<(PathBuf, Vec<u8>)>, report: &Report) -> Result<(), Failure> {
        self.write_several(&[], files, report, Report::to_json)
    }

    /// Writes several meshes and further files, and a report of all, made by `told` from one with the time of reading; all or none.
    pub fn write_several(
        &self,
        meshes: &[(&Destination, &Model)],
        files: Vec<(PathBuf, Vec<u8>)>,
        report: &Report,
        told: impl FnOnce(&Report) -> String,
    ) -> Result<(), Failure> {
        self.watch().step("write", 0.0).map_err(|_| Failure::cancelled())?;
        let report = &self.completed(report);
        self.check_strict(report)?;
        let mut outputs = Outputs::default();
        for (path, bytes) in files {
            outputs.add(path, bytes);
        }
        if let Some(path) = &self.common.report {
            outputs.add(path, told(report).into_bytes());
        }
        let written = outputs.commit_after(|| {
            let mut staged = AtomicFiles::default();
            for (target, model) in meshes {
                match &target.place {
                    Some(path) => drop(mesh_io::stage_as(model, path, target.format, &mut staged).map_err(unwritable)?),
                    None => output::stream(&mesh_io::to_bytes(model, target.format).map_err(unwritable)?)?,
                }
            }
            staged.commit().map(drop).map_err(unwritable)
        });
        written.map(|()| self.tell_stages(report))
    }

    /// Tells the user what was done, unless asked to be quiet.
    pub fn tell(&self, text: &str) {
        if !self.common.quiet {
            self.progress.suspend(|| {
                let _ = writeln!(std::io::stderr(), "{text}");
            });
        }
    }

    /// The report with the time of reading as its first stage, and files in place of the parts that warnings count.
    fn completed(&self, report: &Report) -> Report {
        let mut report = report.clone();
        let files: Vec<PathBuf> = self.inputs.borrow().iter().map(|input| PathBuf::from(&input.name)).collect();
        for warning in &mut report.warnings {
            *warning = with_files(warning, &files);
        }
        for told in report.diagnostics.iter_mut().filter(|d| d.severity == Severity::Warning) {
            told.message = with_files(&told.message, &files);
        }
        let milliseconds = self.reading.get().as_micros() as f64 / 1e3;
        if milliseconds > 0.0 {
            report.stages.insert(0, Stage { name: "read".into(), milliseconds });
        }
        report
    }

    fn tell_stages(&self, report: &Report) {
        for warning in told(&report.warnings) {
            self.warn(&warning);
        }
        for note in &report.notes {
            self.note(note);
        }
        for stage in &report.stages {
            self.note(&format!("{:<24} {:>10.3} ms", stage.name, stage.milliseconds));
        }
    }
}

/// Writes the report of a failed job, if it can be written: the failure itself matters more. Where another file could not be
/// written, none is.
fn write_failed(path: Option<&Path>, failure: &Failure, name: &str, inputs: Vec<Counts>) {
    if let Some((path, report)) = path.zip(failure.to_report(name, inputs)) {
        let mut outputs = Outputs::default();
        outputs.add(path, report.to_json().into_bytes());
        let _ = outputs.commit_after(|| Ok(()));
    }
}

/// What is printed of a report's warnings: places that share one trouble can be hundreds, and the report keeps them all.
fn told(warnings: &[String]) -> Vec<String> {
    const SHOWN: usize = 3;
    let mut met: BTreeMap<String, usize> = BTreeMap::new();
    let mut lines = vec![];
    for warning in warnings {
        let seen = met.entry(trouble(warning)).or_default();
        *seen += 1;
        if *seen <= SHOWN {
            lines.push(warning.clone());
        }
    }
    lines.extend(met.into_iter().filter(|m| m.1 > SHOWN).map(|(what, seen)| {
        let more = seen - SHOWN;
        format!("{what} at {more} more {}, which --report lists", if more == 1 { "place" } else { "places" })
    }));
    lines
}

/// A warning without its place, and without what is particular there.
fn trouble(warning: &str) -> String {
    let Some((before, after)) = warning.split_once(" near ") else { return warning.into() };
    let said = after.split_once(']').and_then(|(_, said)| said.split(':').next());
    format!("{before}{}", said.filter(|s| s.starts_with(" is ")).unwrap_or_default())
}

/// Where a mesh goes, known to be writable.
pub struct Destination {
    /// `None` for standard output.
    place: Option<PathBuf>,
    /// In which format.
    pub format: Format,
    origins: Option<PathBuf>,
}

impl Destination {
    /// Checks the output's format and that every file can be written, before any work is done.
    pub fn check(target: &Target, session: &Session) -> Result<Self, Failure> {
        let to = target.to.as_deref().map(Format::from_name).transpose().map_err(Failure::usage)?;
        let stream = is_stream(&target.output);
        let format = match Format::from_path(&target.output) {
            Ok(format) if !stream && to.is_none_or(|to| to == format) => format,
            Ok(format) if !stream => {
                return Err(Failure::usage(format!("--to says otherwise than the extension .{format} of the output")));
            }
            _ if to.is_none() && stream => return Err(Failure::usage("standard output needs --to FORMAT")),
            Err(e) if to.is_none() => return Err(Failure::usage(e)),
            _ => to.unwrap_or(Format::Obj),
        };
        let place = (!stream).then(|| target.output.clone());
        let files = [place.as_ref(), target.origins.as_ref(), session.common.report.as_ref()];
        let files: Vec<_> = files.into_iter().flatten().collect();
        if (1..files.len()).any(|i| files[..i].contains(&files[i])) {
            return Err(Failure::usage("the output, the report and the origins need different files"));
        }
        if target.origins.as_deref().is_some_and(is_stream) {
            return Err(Failure::usage("--origins needs a file; standard output is for results"));
        }
        for file in files {
            output::check_writable(file)?;
        }
        Ok(Self { place, format, origins: target.origins.clone() })
    }
}

impl Destination {
    /// Its file, or `-`.
    pub fn shown(&self) -> PathBuf {
        self.place.clone().unwrap_or_else(|| "-".into())
    }
}

/// Whether a path stands for standard input or output.
pub fn is_stream(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The counts of each input, for the report.
pub fn counts(paths: &[PathBuf], models: &[Model]) -> Vec<Counts> {
    paths.iter().zip(models).map(|(p, m)| Counts::of(p.display().to_string(), &m.mesh)).collect()
}

/// The diagonal of the box around all inputs as posed, of which lengths may be a share.
pub fn joint_diagonal(models: &[Model]) -> f64 {
    models.iter().map(|m| bounds(&m.mesh)).fold(Bounds::EMPTY, Bounds::union).diagonal()
}

fn read_model(path: &Path, from: Option<Format>) -> Result<Model, Failure> {
    if is_stream(path) {
        let format = from.ok_or_else(|| Failure::usage("standard input needs --from FORMAT"))?;
        let mut bytes = vec![];
        std::io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .map_err(|e| Failure::unreadable(format!("cannot read standard input: {e}")))?;
        return mesh_io::read_stream(&bytes, format).map_err(Failure::unreadable);
    }
    from.map_or_else(|| mesh_io::read(path), |format| mesh_io::read_as(path, format)).map_err(Failure::unreadable)
}

/// A model that the format cannot hold is the input's fault, not the disk's.
pub fn unwritable(error: mesh_io::Error) -> Failure {
    match error {
        mesh_io::Error::Unrepresentable { .. } => Failure::impossible(error),
        _ => Failure::unwritable(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three of a kind are printed, whatever comes between them; the rest is a number.
    #[test]
    fn many_warnings_of_one_kind_end_in_a_line() {
        let small =
            |i: usize| format!("a ball of radius 1 does not fit near [{i}, 0, 0]: one of radius 0.{i} is used there");
        let field = |i: usize| format!("the blend near [0, {i}, 0] is made as a field: the linkages cross {i} times");
        let warnings = |counts: [usize; 2]| {
            let kinds = (0..counts[0]).map(small).chain((0..counts[1]).map(field));
            [kinds.collect::<Vec<_>>(), vec!["the solids are apart".into()]].concat()
        };
        assert_eq!(told(&warnings([3, 3])), warnings([3, 3]));
        let lines = told(&warnings([4, 9]));
        assert_eq!(lines[..7], warnings([3, 3]));
        assert_eq!(
            lines[7..],
            [
                "a ball of radius 1 does not fit at 1 more place, which --report lists",
                "the blend is made as a field at 6 more places, which --report lists"
            ]
        );
        assert_eq!(told(&vec!["the same".to_string(); 5]).len(), 4);
    }
}
