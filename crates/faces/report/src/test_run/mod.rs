//! Programs without a machine, each run to its end: report, part, files of the path.
//!
//! - `bench`: what programs run on, and one run; `limits`: how fast it may be; `digitizing`: what the stylus scans
//!   meanwhile; `system900`: the machine of another family;
//! - `outputs`: files of the path; `part_page`: the page for a browser; `survey`: what a table says beyond the report.

mod bench;
mod digitizing;
mod limits;
mod outputs;
mod part_page;
mod survey;
mod system900;

pub(crate) use bench::stop_function;
pub use bench::{Bench, Company, Tested};
pub use limits::limits;
pub use outputs::{Outputs, PathFile};
pub use part_page::write_page;
pub(crate) use survey::Survey;
pub use system900::System900;
