//! Submit jobs: modules that run beside the cyclic program [000:14301-14400].

use std::collections::VecDeque;

use bahn_exchange::{Bit, Image, signal};

use super::registers::Registers;

/// Jobs in the queue, the running one included (inferred) [000:14325].
const JOBS_MAX: usize = 8;

/// The error markers that every job has of its own [000:14303-14317].
pub(super) const OWN_MARKERS: [Bit; 5] = [
    signal::MULTIPLICATION_ERROR,
    signal::DIVISION_ERROR,
    signal::MODULO_ERROR,
    signal::MODULE_ERROR,
    signal::PROGRAMMER_ERROR,
];

/// A job: the first one of the queue runs.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) identifier: u8,
    pub(super) registers: Registers,
    /// Its error markers while it does not run.
    pub(super) markers: [bool; OWN_MARKERS.len()],
}

/// The queue of jobs.
#[derive(Clone, Debug)]
pub(crate) struct Queue {
    jobs: VecDeque<Job>,
    last_identifier: u8,
}

impl Default for Queue {
    fn default() -> Queue {
        Queue {
            jobs: VecDeque::with_capacity(JOBS_MAX),
            last_identifier: 0,
        }
    }
}

impl Queue {
    /// Queues a module; its identifier, or 0 when the queue is full.
    pub(super) fn submit(&mut self, target: usize) -> i32 {
        if self.jobs.len() >= JOBS_MAX {
            return 0;
        }
        let identifier = self.free_identifier();
        self.last_identifier = identifier;
        self.jobs.push_back(Job {
            identifier,
            registers: Registers {
                next: target,
                ..Registers::default()
            },
            markers: [false; OWN_MARKERS.len()],
        });
        identifier.into()
    }

    /// 0: finished or not known; 1: running; 2: queued.
    pub(super) fn reply(&self, identifier: i32) -> i32 {
        match self.position(identifier) {
            None => 0,
            Some(0) => 1,
            Some(_) => 2,
        }
    }

    /// Takes a job out of the queue.
    pub(super) fn cancel(&mut self, identifier: i32) {
        if let Some(position) = self.position(identifier) {
            self.jobs.remove(position);
        }
    }

    /// The job that runs.
    pub(super) fn running(&mut self) -> Option<&mut Job> {
        self.jobs.front_mut()
    }

    fn position(&self, identifier: i32) -> Option<usize> {
        self.jobs
            .iter()
            .position(|job| i32::from(job.identifier) == identifier)
    }

    /// The next number from 1 to 255 that no job of the queue has (inferred).
    fn free_identifier(&self) -> u8 {
        let mut identifier = self.last_identifier;
        loop {
            identifier = identifier.checked_add(1).unwrap_or(1);
            if self.position(identifier.into()).is_none() {
                return identifier;
            }
        }
    }
}

/// Exchanges the error markers of the image with those of a job.
pub(super) fn swap_markers(image: &mut Image, markers: &mut [bool; OWN_MARKERS.len()]) {
    for (bit, own) in OWN_MARKERS.into_iter().zip(markers) {
        let value = image.bit(bit);
        image.set_bit(bit, *own);
        *own = value;
    }
}
