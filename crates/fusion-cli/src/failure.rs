//! Why a command stopped, and the exit code that says so.

use fusion::{Code, Counts, Diagnostic, Report, Severity};
use std::fmt::{self, Display};
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// A failed command: one exit code, one sentence, and the same as data.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    message: String,
    /// Boxed: most results are no failures. `None` for wrong usage.
    report: Option<Box<Report>>,
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Failure {
    /// 2: wrong usage.
    pub fn usage(message: impl Display) -> Self {
        Self { code: 2, message: message.to_string(), report: None }
    }

    /// 3: an input is unreadable or malformed.
    pub fn unreadable(message: impl Display) -> Self {
        Self::told(3, Diagnostic::new(Code::Unreadable, Severity::Error, message.to_string()))
    }

    /// 4: impossible on this input.
    pub fn impossible(message: impl Display) -> Self {
        Self::told(4, Diagnostic::new(Code::Impossible, Severity::Error, message.to_string()))
    }

    /// 4: a result that comes with warnings, where none is allowed.
    pub fn strict(report: &Report) -> Self {
        let (first, count) = (report.warnings.first().map_or("", String::as_str), report.warnings.len());
        let noun = if count == 1 { "warning, which counts as a failure" } else { "warnings, which count as failures" };
        let message = format!("{count} {noun} with --strict: {first}");
        let told = Diagnostic::new(Code::Strict, Severity::Error, message.clone()).with("warnings", count as f64);
        let mut report = report.clone();
        report.diagnostics.push(told.remedy("leave out --strict, or remove the cause of the warnings"));
        Self { code: 4, message, report: Some(Box::new(report)) }
    }

    /// 4: the time is up.
    pub fn late(after: Duration) -> Self {
        let seconds = after.as_secs_f64();
        let message = format!("stopped after {seconds:.1} s by --time-limit; nothing was written");
        let told = Diagnostic::new(Code::TimeLimit, Severity::Error, message).with("seconds", seconds);
        Self::told(4, told.remedy("allow more time, or ask for less: fewer curves, a larger radius, a coarser mesh"))
    }

    /// 6: an output cannot be written.
    pub fn unwritable(message: impl Display) -> Self {
        Self::told(6, Diagnostic::new(Code::Unwritable, Severity::Error, message.to_string()))
    }

    /// 130: the user asked to stop.
    pub fn cancelled() -> Self {
        Self::told(130, Diagnostic::new(Code::Cancelled, Severity::Error, "cancelled"))
    }

    fn told(code: u8, told: Diagnostic) -> Self {
        let message = told.message.clone();
        Self { code, message, report: Some(Box::new(Report { diagnostics: vec![told], ..Report::default() })) }
    }

    /// The code that a pipeline's error deserves, with its sentence as the user should read it.
    pub fn of(error: &fusion::Error, sentence: String) -> Self {
        let code = match error {
            e if e.is_cancelled() => 130,
            e if e.is_invalid_result() => 5,
            _ => 4,
        };
        let message = if code == 130 { "cancelled".into() } else { sentence };
        Self::told(code, Diagnostic { message, ..Diagnostic::of(error) })
    }

    /// The same with the files that the user knows in place of the parts that the pipeline counts.
    pub fn of_files(error: &fusion::Error, files: &[PathBuf]) -> Self {
        Self::of(error, with_files(&error.to_string(), files))
    }

    /// Whether the job was asked to stop.
    pub fn is_cancelled(&self) -> bool {
        self.code == 130
    }

    /// The report of the job that failed; `None` for wrong usage, and where outputs could not be written: those come all or none.
    pub fn to_report(&self, command: &str, inputs: Vec<Counts>) -> Option<Report> {
        let report = self.report.as_deref().filter(|_| self.code != 6)?.clone();
        Some(Report { command: command.into(), inputs, exit_code: self.code, ..report })
    }

    /// The exit code.
    pub fn code(&self) -> u8 {
        self.code
    }

    /// Says the sentence on standard error.
    pub fn say(&self) {
        let mut stderr = std::io::stderr();
        let bold = anstyle::AnsiColor::Red.on_default().bold();
        // A closed standard error is no reason to fail differently.
        let _ = if stderr.is_terminal() && std::env::var_os("NO_COLOR").is_none() {
            writeln!(stderr, "{bold}error:{bold:#} {}", self.message)
        } else {
            writeln!(stderr, "error: {}", self.message)
        };
    }

    /// Says the sentence and gives the exit code.
    pub fn report(&self) -> ExitCode {
        self.say();
        ExitCode::from(self.code)
    }
}

/// A sentence of the library, which counts parts, with the files in their place.
pub fn with_files(text: &str, files: &[PathBuf]) -> String {
    let mut text = text.to_string();
    for (i, path) in files.iter().enumerate() {
        for end in [" ", ",", ":"] {
            text = text.replace(&format!("part {i}{end}"), &format!("{}{end}", path.display()));
        }
    }
    text
}
