//! The files of a run: the program and the cycles that it calls.

use std::sync::{Arc, OnceLock};

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
    /// The text counts every line that is not empty as one block: it has no form feed, which parts blocks, too.
    is_regular: bool,
    /// Per line, how many blocks there are up to it, for jumps: found at the first one.
    counted: Arc<OnceLock<Vec<u32>>>,
}

impl File {
    pub fn new(cycle: Option<u16>, text: Arc<Program>) -> File {
        let bytes = text.to_bytes();
        File {
            cycle,
            is_regular: memchr::memchr(b'\x0c', &bytes).is_none(),
            words: Arc::new(system900::Program::from_bytes(text.name(), &bytes)),
            text,
            counted: Arc::default(),
        }
    }

    /// Whether a line is a block of the text, as the text counts them.
    fn is_block(&self, line: u32) -> bool {
        let is_blank = |byte: u8| byte <= b' ' || byte == 0x7F;
        !self.words.line(line).bytes().all(is_blank)
    }

    /// The block that stands in a line or comes next after it, from 1.
    pub fn block_of(&self, line: u32) -> u32 {
        if self.is_regular {
            let counted = self.counted.get_or_init(|| self.counted());
            let before = line.checked_sub(1).and_then(|at| counted.get(at as usize));
            return before.or(counted.last()).map_or(1, |before| before + 1);
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

    fn counted(&self) -> Vec<u32> {
        let mut count = 0;
        let lines = 0..=self.words.line_count();
        lines
            .map(|line| {
                count += u32::from(line > 0 && self.is_block(line));
                count
            })
            .collect()
    }

    /// The block that comes next after a line, whose own or next one is said, with whether it has words.
    pub fn block_after(&self, line: u32, block: u32, has_words: bool) -> u32 {
        match self.is_regular {
            true => block + u32::from(has_words || self.is_block(line)),
            false => self.block_of(line + 1),
        }
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
    pub fn new(program: Arc<Program>, beside: Arc<dyn Files>) -> FilesOfRun {
        FilesOfRun {
            files: vec![File::new(None, program)],
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
                let text = Arc::new(Program::from_bytes(name, file.bytes));
                self.files.push(File::new(Some(number), text));
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
