//! The progress bar of long runs: on the terminal only, and only after a while.

use std::time::{Duration, Instant};

use bahn_report::Follower;
use bahn_report::text::clock;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::diagnostics;
use crate::interrupt::Interrupt;

/// Runs that are done sooner show nothing.
const QUIET: Duration = Duration::from_millis(700);
/// How often the bar is drawn.
const PERIOD: Duration = Duration::from_millis(100);
/// Path elements between two looks at the clock.
const ELEMENTS: u32 = 1024;

/// Shows how far the main program has come and what happens, and ends the run on Ctrl-C.
pub(crate) struct Progress {
    interrupt: Interrupt,
    started: Instant,
    blocks: u32,
    farthest: u32,
    until_look: u32,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Of a run that Ctrl-C ends.
    pub fn new(interrupt: &Interrupt) -> Progress {
        Progress {
            interrupt: interrupt.clone(),
            started: Instant::now(),
            blocks: 0,
            farthest: 0,
            until_look: ELEMENTS,
            bar: None,
        }
    }

    #[cold]
    fn look(&mut self, machining_time_s: f64) {
        if self.bar.is_none() && self.started.elapsed() >= QUIET {
            self.bar = Some(new_bar(self.blocks));
        }
        if let Some(bar) = &self.bar {
            bar.set_position(u64::from(self.farthest));
            bar.set_message(clock(machining_time_s));
        }
    }
}

impl Follower for Progress {
    fn begin(&mut self, blocks: u32) {
        // Reading a large program is no part of its run.
        (self.started, self.blocks) = (Instant::now(), blocks);
    }

    #[inline]
    fn element(&mut self, block: Option<u32>, machining_time_s: f64) {
        // Loops go back; the bar does not.
        self.farthest = self.farthest.max(block.unwrap_or(0));
        self.until_look -= 1;
        if self.until_look == 0 {
            self.until_look = ELEMENTS;
            self.look(machining_time_s);
        }
    }

    fn say(&mut self, line: &str) {
        diagnostics::print_line(line);
    }

    fn is_interrupted(&self) -> bool {
        self.interrupt.is_requested()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn new_bar(blocks: u32) -> ProgressBar {
    // Standard error; hidden when that is no terminal.
    let target = ProgressDrawTarget::stderr_with_hz(10);
    let bar = ProgressBar::with_draw_target(Some(u64::from(blocks)), target).with_elapsed(QUIET);
    if let Ok(style) = ProgressStyle::with_template(
        "{spinner} [{bar:20}] block {human_pos} of {human_len}, machining time {msg}, {elapsed}",
    ) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(PERIOD);
    bar
}

/// The progress of many programs, on the terminal.
pub(crate) fn of_programs(programs: usize) -> ProgressBar {
    // Standard error; hidden when that is no terminal.
    let bar = ProgressBar::with_draw_target(Some(programs as u64), ProgressDrawTarget::stderr_with_hz(10));
    if let Ok(style) =
        ProgressStyle::with_template("{spinner} [{bar:20}] program {human_pos} of {human_len}, {elapsed}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
