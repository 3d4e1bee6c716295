//! The part of the jobs that one machine takes.

use std::fmt::{self, Display};
use std::str::FromStr;

/// Every n-th job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1 to `count`.
    index: usize,
    count: usize,
}

impl Shard {
    /// Everything.
    pub const ALL: Self = Self { index: 1, count: 1 };

    /// Whether the job at a place, counted from 0, belongs to it.
    pub fn takes(self, place: usize) -> bool {
        place % self.count == self.index - 1
    }

    /// What the scheduler of an array of jobs has put into the environment, and the name of that variable.
    ///
    /// # Errors
    /// An index without a count, or one that is no share of it.
    pub fn from_environment(get: impl Fn(&str) -> Option<String>) -> Result<Option<(Self, &'static str)>, String> {
        let number = |name: &str| get(name).and_then(|text| text.trim().parse::<usize>().ok());
        for (index, count, first, step) in [
            ("JOB_COMPLETION_INDEX", "JOB_COMPLETIONS", "", ""),
            ("SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP"),
            ("AWS_BATCH_JOB_ARRAY_INDEX", "AWS_BATCH_JOB_ARRAY_SIZE", "", ""),
        ] {
            let Some(text) = get(index) else { continue };
            let count = number(count).filter(|c| *c > 0).ok_or_else(|| {
                format!("{index} is set and {count} is not: say --shard {text}/N, or --shard 1/1 for all jobs")
            })?;
            let first = number(first).unwrap_or(0);
            let place = number(index).and_then(|i| i.checked_sub(first)).map(|i| i / number(step).unwrap_or(1).max(1));
            let place = place.filter(|p| *p < count).ok_or_else(|| {
                format!("{index} is {text}, which is none of {count} in a row from {first}: say --shard i/n")
            })?;
            return Ok(Some((Self { index: place + 1, count }, index)));
        }
        Ok(None)
    }
}

impl Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    /// `i/n` with i from 1 to n, or from 0 to n - 1: `0/n` is the same shard as `n/n`.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse::<usize>().ok()?, n.parse::<usize>().ok()?)));
        match parts {
            Some((index, count)) if count > 0 && index <= count => {
                Ok(Self { index: if index == 0 { count } else { index }, count })
            }
            _ => Err("must be i/n with i from 1 to n, or from 0 to n - 1".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_every_job_once_counted_from_zero_or_one() {
        for shards in [["1/3", "2/3", "3/3"], ["0/3", "1/3", "2/3"]] {
            let shards = shards.map(|s| s.parse::<Shard>().unwrap());
            assert!((0..10).all(|place| shards.iter().filter(|s| s.takes(place)).count() == 1));
        }
        assert!(["4/3", "1/0", "1", "a/b", "-1/2"].iter().all(|s| s.parse::<Shard>().is_err()));
    }

    #[test]
    fn schedulers_tell_the_shard() {
        let ask = |variables: &[(&str, &str)]| {
            let found = |name: &str| variables.iter().find(|v| v.0 == name).map(|v| v.1.to_string());
            Shard::from_environment(found).map(|found| found.map(|(shard, _)| shard.to_string()))
        };
        let said = |text: &str| Ok(Some(text.to_string()));
        assert_eq!(ask(&[("JOB_COMPLETION_INDEX", "0"), ("JOB_COMPLETIONS", "4")]), said("1/4"));
        assert_eq!(ask(&[("AWS_BATCH_JOB_ARRAY_INDEX", "3"), ("AWS_BATCH_JOB_ARRAY_SIZE", "4")]), said("4/4"));
        let slurm = |id, min, step| {
            let names = ["ID", "COUNT", "MIN", "STEP"].map(|n| format!("SLURM_ARRAY_TASK_{n}"));
            ask(&[(&names[0], id), (&names[1], "5"), (&names[2], min), (&names[3], step)])
        };
        assert_eq!((slurm("7", "3", "1"), slurm("11", "3", "2")), (said("5/5"), said("5/5")));
        assert!(slurm("30", "3", "1").is_err() && slurm("1", "3", "1").is_err());
        assert!(ask(&[("JOB_COMPLETION_INDEX", "0")]).unwrap_err().contains("JOB_COMPLETIONS"));
        assert_eq!(ask(&[]), Ok(None));
    }
}
