//! Why a command stopped, and the exit code that says so.

use std::fmt::Display;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

/// A failed command: one exit code and one sentence.
#[derive(Debug, PartialEq, Eq)]
pub struct Failure {
    code: u8,
    message: String,
}

impl Failure {
    /// 2: wrong usage.
    pub fn usage(message: impl Display) -> Self {
        Self { code: 2, message: message.to_string() }
    }

    /// 3: an input is unreadable or malformed.
    pub fn unreadable(message: impl Display) -> Self {
        Self { code: 3, message: message.to_string() }
    }

    /// 4: impossible on this input.
    pub fn impossible(message: impl Display) -> Self {
        Self { code: 4, message: message.to_string() }
    }

    /// 5: the result failed its own validation.
    pub fn invalid(message: impl Display) -> Self {
        Self { code: 5, message: message.to_string() }
    }

    /// 6: an output cannot be written.
    pub fn unwritable(message: impl Display) -> Self {
        Self { code: 6, message: message.to_string() }
    }

    /// 130: the user asked to stop.
    pub fn cancelled() -> Self {
        Self { code: 130, message: "cancelled".into() }
    }

    /// The code that a pipeline's error deserves, with its sentence as the user should read it.
    pub fn of(error: &fusion::Error, sentence: String) -> Self {
        match error {
            e if e.is_cancelled() => Self::cancelled(),
            e if e.is_invalid_result() => Self::invalid(sentence),
            _ => Self::impossible(sentence),
        }
    }

    /// The same with the files that the user knows in place of the parts that the pipeline counts.
    pub fn of_files(error: &fusion::Error, files: &[PathBuf]) -> Self {
        Self::of(error, with_files(&error.to_string(), files))
    }

    /// Says the sentence on standard error and gives the exit code.
    pub fn report(&self) -> ExitCode {
        let mut stderr = std::io::stderr();
        let bold = anstyle::AnsiColor::Red.on_default().bold();
        // A closed standard error is no reason to fail differently.
        let _ = if stderr.is_terminal() && std::env::var_os("NO_COLOR").is_none() {
            writeln!(stderr, "{bold}error:{bold:#} {}", self.message)
        } else {
            writeln!(stderr, "error: {}", self.message)
        };
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
