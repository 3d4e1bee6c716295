//! Many jobs in worker processes: a crash, a hang or too much memory costs one line.
//!
//! | file | holds |
//! |---|---|
//! | `outcome.rs` | the outcome of a job, as a line of the results |
//! | `results.rs` | the file of results: locked, only appended to, cut where a line is torn |
//! | `folders.rs` | where jobs write: folders beside, renamed at the end |
//! | `shard.rs` | the part of the jobs that one machine takes |
//! | `program.rs` | the program that workers run |
//! | `work.rs` | the inside of a worker |
//! | `seat.rs` | the outside of a worker: limits, and who follows when it is gone |
//! | `memory.rs` | resident memory of a process |
//! | `pool.rs` | all seats, the queue, and the end of each job |
//! | `meter.rs` | rate, time left, failures so far |

pub mod folders;
pub mod memory;
pub mod meter;
pub mod outcome;
pub mod pool;
pub mod program;
pub mod results;
pub mod seat;
pub mod shard;
pub mod work;
