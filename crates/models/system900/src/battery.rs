//! What a battery keeps over power-off [002:441-446]: the parameters that differ from those of the data file, as a data file of
//! its own.

use std::fmt::Write as _;

use bahn_text::{Diagnostic, Severity};

use crate::file::over;
use crate::memory::{Memory, Place};
use crate::numbers::FUNCTION;

impl Memory {
    /// The parameters that differ from others, a line each; that of functions is none that lasts, and those that
    /// each channel has of an axis are states, which the control shows anew.
    ///
    /// ```
    /// use bahn_system900::DataFile;
    /// let file = DataFile::read(b"q102: 10000\nq103: 5000\nq900: 5\n");
    /// let mut memory = file.memory().clone();
    /// memory.write("q900".parse()?, "2.5".parse()?)?;
    /// let kept = memory.differing(file.memory());
    /// assert!(kept.starts_with("q900: 2.5 $"));
    /// assert_eq!(file.memory().with_kept(kept.as_bytes()).as_ref(), Ok(&memory));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn differing(&self, from: &Memory) -> String {
        let mut text = String::new();
        let count = u32::try_from(self.count()).unwrap_or(u32::MAX);
        for number in (0..count).filter(|number| *number != FUNCTION) {
            let [before, now] = [from, self].map(|memory| memory.at(Place::Q(number)));
            if before != now {
                let _ = writeln!(text, "q{number}: {} {}", now.written(), now.status());
            }
        }
        text
    }

    /// These parameters with those that were kept.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn with_kept(&self, kept: &[u8]) -> Result<Memory, Diagnostic> {
        let (memory, faults) = over(kept, self);
        let wrong = faults.into_iter().find(|fault| fault.severity == Severity::Error);
        wrong.map_or(Ok(memory), Err)
    }
}
