//! The page that sums up the results of a batch: one HTML file that needs nothing but itself.
//!
//! | file | holds |
//! |---|---|
//! | `html.rs` | the whole page |
//! | `escape.rs` | text in HTML, numbers as read |
//! | `times.rs` | how long jobs took, as figures and a histogram |
//! | `grid.rs` | two parameters against each other |
//! | `failures.rs` | failures by reason |
//! | `table.rs` | all jobs, sortable |
//! | `pictures.rs` | outputs, and places of failures |

#![expect(clippy::format_push_string, clippy::format_collect, reason = "a page is made once")]

mod escape;
mod failures;
mod grid;
mod html;
mod pictures;
mod table;
mod times;

pub use html::page;
pub use pictures::take;
