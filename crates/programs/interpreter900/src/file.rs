//! The files of a run: the program and the cycles that it calls.

use std::sync::Arc;

use bahn_din::system900;
use bahn_program::Program;
use bahn_text::Files;

/// A file as text and by its words.
#[derive(Clone)]
pub(crate) struct File {
    /// The cycle that it is; `None` for the program.
    pub cycle: Option<u16>,
    pub text: Arc<Program>,
    pub words: Arc<system900::Program>,
    /// The block of each line, where the text counts every line that is not empty as one.
    blocks: Arc<Vec<u32>>,
}

/// The blocks of lines by counting; empty where the text counts otherwise.
fn counted(text: &Program, words: &system900::Program) -> Vec<u32> {
    let mut blocks = vec![0];
    let mut last = [(0, 0); 2];
    for line in 1..=words.line_count() {
        let before = blocks.last().copied().unwrap_or_default();
        let is_block = !words.line(line).trim().is_empty();
        blocks.push(before + u32::from(is_block));
        if is_block {
            last = [
                (line, before + 1),
                if before % 97 == 0 {
                    (line, before + 1)
                } else {
                    last[1]
                },
            ];
        }
    }
    let fits = last
        .iter()
        .all(|(line, block)| *block == 0 || text.line_of(*block) == *line);
    if fits { blocks } else { Vec::new() }
}

impl File {
    pub fn new(cycle: Option<u16>, name: &str, bytes: &[u8]) -> File {
        let text = Program::from_bytes(name, bytes.to_vec());
        let words = system900::Program::from_bytes(name, bytes);
        File {
            cycle,
            blocks: Arc::new(counted(&text, &words)),
            text: Arc::new(text),
            words: Arc::new(words),
        }
    }

    /// The block that stands in a line or comes next after it.
    pub fn block_from(&self, line: u32, near: u32) -> u32 {
        self.block_of(line, near)
    }

    /// The block that stands in a line; each line that is not empty is one, from 1. `near` is one before it.
    pub fn block_of(&self, line: u32, near: u32) -> u32 {
        let before = line
            .checked_sub(1)
            .and_then(|before| self.blocks.get(before as usize));
        if let (Some(block), Some(before)) = (self.blocks.get(line as usize), before) {
            return if block == before { block + 1 } else { *block };
        }
        if self.text.line_of(near) == line {
            return near;
        }
        if self.text.line_of(near + 1) == line {
            return near + 1;
        }
        let (mut from, mut to) = (1, self.text.block_count());
        while from < to {
            let middle = from + (to - from) / 2;
            match self.text.line_of(middle) < line {
                true => from = middle + 1,
                false => to = middle,
            }
        }
        from
    }
}

/// All files of a run, in the order of their calls.
#[derive(Clone)]
pub(crate) struct FilesOfRun {
    files: Vec<File>,
    /// Cycles that were looked for in vain.
    absent: Vec<u16>,
    beside: Arc<dyn Files>,
}

/// Most cycles of a program (inferred).
const CYCLES_MAX: usize = 256;

impl FilesOfRun {
    pub fn new(name: &str, bytes: &[u8], beside: Arc<dyn Files>) -> FilesOfRun {
        FilesOfRun {
            files: vec![File::new(None, name, bytes)],
            absent: Vec::new(),
            beside,
        }
    }

    pub fn get(&self, index: usize) -> Option<&File> {
        self.files.get(index)
    }

    /// The index of a cycle, `Z6.900`, where it lies beside the program.
    pub fn cycle(&mut self, number: u16) -> Option<usize> {
        let known = self.files.iter().position(|file| file.cycle == Some(number));
        if known.is_some() || self.absent.contains(&number) {
            return known;
        }
        let name = format!("Z{number}.900");
        match self.beside.read(&name).filter(|_| self.files.len() < CYCLES_MAX) {
            Some(file) => {
                self.files.push(File::new(Some(number), &name, &file.bytes));
                Some(self.files.len() - 1)
            }
            None => {
                if self.absent.len() < CYCLES_MAX {
                    self.absent.push(number);
                }
                None
            }
        }
    }
}
