#![no_main]
//! Lines of jobs: what is read is written and read again as the same; what is not names a line that is there.

/// The file itself: the crate it belongs to takes minutes to build.
#[path = "../../crates/fusion-cli/src/job_line.rs"]
#[allow(dead_code)]
mod job_line;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    match job_line::parse(bytes) {
        Ok(jobs) => {
            let lines: String = jobs.iter().map(|job| serde_json::to_string(job).expect("a job is plain data") + "\n").collect();
            assert_eq!(job_line::parse(lines.as_bytes()).expect("what was written can be read"), jobs);
            assert!(jobs.iter().all(|job| job.sets().len() == job.parameters.len()));
        }
        Err(faults) => {
            let count = bytes.split(|b| *b == b'\n').count();
            assert!(faults.iter().all(|fault| (1..=count).contains(&fault.line) && !fault.reason.is_empty()));
        }
    }
});
