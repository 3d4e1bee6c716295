//! One command from its arguments to its files.

use crate::args::{Common, Source, Target};
use crate::failure::Failure;
use crate::output::{self, Outputs};
use crate::progress::Progress;
use fusion::mesh_core::{Bounds, Origins, Watch, bounds};
use fusion::{Counts, Report, Stage};
use mesh_io::{Format, Model};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What every verb works with.
pub struct Session {
    common: Common,
    progress: Progress,
    /// Time spent on reading so far.
    reading: Cell<Duration>,
}

impl Session {
    /// Starts the clock of the progress bar and listens to Ctrl-C.
    pub fn start(common: Common) -> Result<Self, Failure> {
        if let Some(report) = &common.report {
            if is_stream(report) {
                return Err(Failure::usage("--report needs a file; standard output is for results"));
            }
            output::check_writable(report)?;
        }
        let progress = Progress::start(!common.no_progress && !common.quiet);
        Ok(Self { common, progress, reading: Cell::default() })
    }

    /// What long loops report to.
    pub fn watch(&self) -> &Watch {
        &self.progress.watch
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
        self.watch().step("write", 0.0).map_err(|_| Failure::cancelled())?;
        let report = &self.with_reading(report);
        let mut outputs = Outputs::default();
        for (path, bytes) in files {
            outputs.add(path, bytes);
        }
        if let Some((path, origins)) = target.origins.as_ref().zip(origins) {
            outputs.add(path, fusion::origins_to_json(origins).into_bytes());
        }
        self.add_report(&mut outputs, report);
        let written = match &target.place {
            None => mesh_io::to_bytes(model, target.format)
                .map_err(unwritable)
                .and_then(|bytes| outputs.commit_after(|| output::stream(&bytes))),
            Some(path) => {
                outputs.commit_after(|| mesh_io::write_as(model, path, target.format).map(drop).map_err(unwritable))
            }
        };
        written.map(|()| self.tell_stages(report))
    }

    /// Writes files other than meshes, and the report, all or none.
    pub fn write_files(&self, files: Vec<(PathBuf, Vec<u8>)>, report: &Report) -> Result<(), Failure> {
        self.watch().step("write", 0.0).map_err(|_| Failure::cancelled())?;
        let report = &self.with_reading(report);
        let mut outputs = Outputs::default();
        for (path, bytes) in files {
            outputs.add(path, bytes);
        }
        self.add_report(&mut outputs, report);
        outputs.commit_after(|| Ok(())).map(|()| self.tell_stages(report))
    }

    /// The report with the time of reading as its first stage.
    fn with_reading(&self, report: &Report) -> Report {
        let mut report = report.clone();
        let milliseconds = self.reading.get().as_micros() as f64 / 1e3;
        if milliseconds > 0.0 {
            report.stages.insert(0, Stage { name: "read".into(), milliseconds });
        }
        report
    }

    fn add_report(&self, outputs: &mut Outputs, report: &Report) {
        if let Some(path) = &self.common.report {
            outputs.add(path, report.to_json().into_bytes());
        }
    }

    fn tell_stages(&self, report: &Report) {
        // Places that share one trouble can be hundreds; the report keeps them all.
        const SHOWN: usize = 3;
        let trouble = |warning: &str| warning.split_once(" near ").map_or_else(|| warning.to_string(), |w| w.0.into());
        let mut met: BTreeMap<String, usize> = BTreeMap::new();
        for warning in &report.warnings {
            let seen = met.entry(trouble(warning)).or_default();
            *seen += 1;
            if *seen <= SHOWN {
                self.warn(warning);
            }
        }
        for (what, more) in met.into_iter().filter(|m| m.1 > SHOWN) {
            self.warn(&format!("{what} at {} more places, which --report lists", more - SHOWN));
        }
        for stage in &report.stages {
            self.note(&format!("{:<24} {:>10.3} ms", stage.name, stage.milliseconds));
        }
    }
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
fn unwritable(error: mesh_io::Error) -> Failure {
    match error {
        mesh_io::Error::Unrepresentable { .. } => Failure::impossible(error),
        _ => Failure::unwritable(error),
    }
}
