//! The outside of a worker: it is started when there is a job for it, watched while it works, and replaced when it is gone.

use crate::batch::memory::resident_megabytes;
use crate::batch::outcome::{Outcome, State, error};
use crate::batch::work::Request;
use crate::failure::Failure;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// Between two looks at a worker.
const LOOK: Duration = Duration::from_millis(20);
/// Time for a worker that has closed its pipes, or seen them closed, to be gone.
const GRACE: Duration = Duration::from_millis(200);
/// How much of what a worker said is kept for the case of a crash.
const LAST_WORDS: usize = 2000;

/// How workers are started, and what a job may take.
pub struct Terms {
    /// The program.
    pub program: PathBuf,
    /// Threads of each worker.
    pub threads: usize,
    /// The folder of finished steps.
    pub cache: Option<PathBuf>,
    /// Most time for a job.
    pub timeout: Option<Duration>,
    /// Most resident memory of a worker, in megabytes.
    pub memory: Option<f64>,
}

/// One of several places for a worker.
pub struct Seat<'a> {
    terms: &'a Terms,
    worker: Option<Worker>,
}

struct Worker {
    child: Child,
    requests: ChildStdin,
    answers: Receiver<String>,
    last_words: Receiver<String>,
}

/// Why a worker has ended.
enum End {
    Answer(String),
    Gone,
    Late,
    Large(f64),
    Stopped,
}

impl<'a> Seat<'a> {
    /// An empty seat.
    pub fn new(terms: &'a Terms) -> Self {
        Self { terms, worker: None }
    }

    /// Has a job done, whatever becomes of the worker. `None` if `stop` said so before the end.
    pub fn run(&mut self, request: &Request, stop: impl Fn() -> bool) -> Result<Option<Outcome>, Failure> {
        let line = serde_json::to_string(request).map_err(Failure::impossible)? + "\n";
        let mut worker = match self.worker.take() {
            Some(worker) => worker,
            None => Worker::start(self.terms)?,
        };
        let start = Instant::now();
        // A worker that cannot be written to is gone, which shows below.
        let _ = worker.requests.write_all(line.as_bytes());
        let end = worker.wait(start, self.terms, stop);
        let milliseconds = start.elapsed().as_micros() as f64 / 1e3;
        let id = &request.job.id;
        let lost = |state, code, diagnostic| Outcome::told(id, state, code, milliseconds, diagnostic);
        let outcome = match end {
            End::Stopped => {
                worker.end(Duration::ZERO);
                return Ok(None);
            }
            End::Answer(line) => match serde_json::from_str::<Outcome>(&line) {
                Ok(outcome) if outcome.id == *id => {
                    self.worker = Some(worker);
                    return Ok(Some(outcome));
                }
                _ => {
                    worker.end(Duration::ZERO);
                    let said = format!("the worker answered what is no result of this job: {}", tail(&line));
                    lost(State::Crashed, 1, error("crashed", &said, None))
                }
            },
            End::Gone => {
                let (code, how, words) = worker.end(GRACE);
                let words = if words.is_empty() { String::new() } else { format!(": {words}") };
                let said = format!("the worker {how}{words}");
                lost(State::Crashed, code, error("crashed", &said, Some("report this document and its parts")))
            }
            End::Late => {
                worker.end(Duration::ZERO);
                let said = format!("ended after {:.1} s by --timeout", milliseconds / 1e3);
                lost(State::Timeout, 4, error("time_limit", &said, Some("allow more time, or ask for less")))
            }
            End::Large(megabytes) => {
                worker.end(Duration::ZERO);
                let said = format!("ended at {megabytes:.0} MB of memory by --memory");
                lost(State::Memory, 4, error("memory_limit", &said, Some("allow more memory, or ask for less")))
            }
        };
        Ok(Some(Outcome { parameters: request.job.parameters.clone(), ..outcome }))
    }
}

impl Drop for Seat<'_> {
    fn drop(&mut self) {
        if let Some(worker) = self.worker.take() {
            worker.end(GRACE);
        }
    }
}

impl Worker {
    fn start(terms: &Terms) -> Result<Self, Failure> {
        let mut command = Command::new(&terms.program);
        command.args(["worker", "--quiet", "--threads", &terms.threads.to_string()]);
        if let Some(cache) = &terms.cache {
            command.arg("--cache").arg(cache);
        }
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Ctrl-C is the batch's to hear: a job that it ends is no job that failed.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let cannot = |e: String| Failure::impossible(format!("cannot start {}: {e}", terms.program.display()));
        let mut child = command.spawn().map_err(|e| cannot(e.to_string()))?;
        let pipes = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (Some(requests), Some(out), Some(err)) = pipes else { return Err(cannot("it has no pipes".into())) };
        Ok(Self { child, requests, answers: lines(out), last_words: last_words(err) })
    }

    /// Waits for the answer or for a reason not to.
    fn wait(&mut self, start: Instant, terms: &Terms, stop: impl Fn() -> bool) -> End {
        loop {
            let left = terms.timeout.map_or(LOOK, |limit| limit.saturating_sub(start.elapsed()));
            match self.answers.recv_timeout(left.min(LOOK)) {
                Ok(line) => return End::Answer(line),
                Err(RecvTimeoutError::Disconnected) => return End::Gone,
                Err(RecvTimeoutError::Timeout) => {}
            }
            if stop() {
                return End::Stopped;
            }
            if terms.timeout.is_some_and(|limit| start.elapsed() >= limit) {
                return End::Late;
            }
            let held = terms.memory.and_then(|limit| resident_megabytes(self.child.id()).filter(|held| *held > limit));
            if let Some(megabytes) = held {
                return End::Large(megabytes);
            }
        }
    }

    /// Waits for it to exit within `grace`, then kills it. Gives its exit code, how it ended, and what it said last.
    fn end(self, grace: Duration) -> (i32, String, String) {
        let Self { mut child, requests, last_words, .. } = self;
        drop(requests);
        let start = Instant::now();
        while matches!(child.try_wait(), Ok(None)) && start.elapsed() < grace {
            std::thread::sleep(Duration::from_millis(1));
        }
        // One that is gone cannot be ended.
        let _ = child.kill();
        let (code, how) = match child.wait() {
            Ok(status) => ending(status),
            Err(e) => (1, format!("is lost ({e})")),
        };
        (code, how, last_words.recv_timeout(LOOK).unwrap_or_default())
    }
}

fn ending(status: ExitStatus) -> (i32, String) {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return (128 + signal, format!("was ended by signal {signal}"));
    }
    let code = status.code().unwrap_or(1);
    (code, format!("exited with code {code}"))
}

fn lines(out: ChildStdout) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        for line in BufReader::new(out).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}

/// The end of what is said until the pipe is closed.
fn last_words(mut err: ChildStderr) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        let (mut said, mut buffer) = (vec![], [0; 4096]);
        while let Ok(count) = err.read(&mut buffer) {
            if count == 0 {
                break;
            }
            said.extend_from_slice(&buffer[..count]);
            said.drain(..said.len().saturating_sub(LAST_WORDS));
        }
        let _ = sender.send(String::from_utf8_lossy(&said).trim().to_string());
    });
    receiver
}

fn tail(text: &str) -> String {
    text.chars().take(200).collect()
}
