//! The programs of a run and their decoded blocks.

use std::collections::VecDeque;
use std::sync::Arc;

use bahn_parameters::ControlModel;
use bahn_program::{Block, Chunk, InputSteps, Program};
use bahn_reader::Programs;

/// Chunks of decoded blocks kept at once over all programs: programs up to this size run from memory,
/// larger ones are decoded again where loops come back. Bounds the memory of a run.
const CHUNKS_KEPT: usize = 128;

/// The programs of a run; index 0 is the main program.
#[derive(Clone)]
pub(crate) struct Code {
    model: ControlModel,
    input_step_mm: Option<f64>,
    programs: Vec<Loaded>,
    /// Programs that were called at least once, and the main program.
    called: usize,
    /// Chunks in memory in the order they came: the oldest goes first.
    kept: VecDeque<(u16, usize)>,
    /// More of the main program may come.
    growing: bool,
}

#[derive(Clone)]
struct Loaded {
    program: Arc<Program>,
    /// Copies of a run share them: every saved moment of a machine is one.
    chunks: Vec<Option<Arc<Decoded>>>,
}

/// Blocks as the control takes them in.
struct Decoded {
    chunk: Chunk,
    /// Blocks with numbers that were rounded, bit by bit.
    rounded: [u64; ROUNDED_WORDS],
}

const WORD_BITS: usize = u64::BITS as usize;
const ROUNDED_WORDS: usize = (Program::CHUNK_SIZE as usize).div_ceil(WORD_BITS);

impl Decoded {
    fn new(mut chunk: Chunk, steps: InputSteps) -> Decoded {
        let mut rounded = [0; ROUNDED_WORDS];
        for (place, block) in chunk.blocks.iter_mut().enumerate() {
            if steps.round(&mut block.operation)
                && let Some(word) = rounded.get_mut(place / WORD_BITS)
            {
                *word |= 1 << (place % WORD_BITS);
            }
        }
        Decoded { chunk, rounded }
    }

    fn is_rounded(&self, place: usize) -> bool {
        let word = self.rounded.get(place / WORD_BITS);
        word.is_some_and(|word| word >> (place % WORD_BITS) & 1 != 0)
    }
}

/// A block to be executed.
pub(crate) struct Fetched<'a> {
    pub block: &'a Block,
    /// The one after it, where that is at hand.
    pub next: Option<&'a Block>,
    /// It has numbers that were rounded to the input step.
    pub rounded: bool,
}

impl Code {
    /// A main program on a control, whose lengths may have a coarser step than its model, mm.
    pub fn new(main: Arc<Program>, model: ControlModel, input_step_mm: Option<f64>) -> Code {
        let mut code = Code {
            model,
            input_step_mm,
            programs: Vec::new(),
            called: 1,
            kept: VecDeque::new(),
            growing: main.is_growing(),
        };
        code.add(main);
        code
    }

    fn add(&mut self, program: Arc<Program>) -> u16 {
        let chunks = program.chunk_count() as usize;
        self.programs.push(Loaded {
            program,
            chunks: std::iter::repeat_with(|| None).take(chunks).collect(),
        });
        (self.programs.len() - 1) as u16
    }

    /// The index of a called program; loads it when it is called for the first time.
    pub fn open(&mut self, name: &str, caller: u16, programs: &dyn Programs) -> Result<Option<u16>, String> {
        if let Some(index) = self.programs.iter().position(|p| p.program.name() == name) {
            return Ok(Some(index as u16));
        }
        if self.programs.len() > usize::from(u16::MAX) {
            return Err("too many programs".into());
        }
        let found = programs.open(name, &self.name_of(caller))?;
        Ok(found.map(|program| self.index_of(program)))
    }

    /// The index of a program in the EPROM.
    pub fn open_eprom(
        &mut self,
        name: &str,
        caller: u16,
        programs: &dyn Programs,
    ) -> Result<Option<u16>, String> {
        let found = programs.open_in_eprom(name, &self.name_of(caller))?;
        Ok(found.map(|program| self.index_of(program)))
    }

    pub fn names(&self) -> impl Iterator<Item = String> + '_ {
        self.programs
            .iter()
            .map(|loaded| loaded.program.name().to_owned())
    }

    pub fn name_of(&self, program: u16) -> String {
        self.program(program)
            .map(|p| p.name().to_owned())
            .unwrap_or_default()
    }

    /// The same file under another spelling of its name is the same program.
    fn index_of(&mut self, program: Arc<Program>) -> u16 {
        let known = self
            .programs
            .iter()
            .position(|p| Arc::ptr_eq(&p.program, &program));
        known.map_or_else(|| self.add(program), |index| index as u16)
    }

    /// Whether a program is called for the first time; only once so.
    pub fn is_new(&mut self, index: u16) -> bool {
        let new = usize::from(index) >= self.called;
        self.called = self.called.max(usize::from(index) + 1);
        new
    }

    /// Whether more of the main program may come.
    #[inline]
    pub fn is_growing(&self) -> bool {
        self.growing
    }

    /// A later version of the main program. The chunk at the end of what was known is decoded again.
    pub fn grow(&mut self, program: Arc<Program>) {
        self.growing = program.is_growing();
        let Some(main) = self.programs.first_mut() else {
            return;
        };
        let known = (main.program.known().end / Program::CHUNK_SIZE) as usize;
        main.chunks.truncate(known);
        main.chunks.resize_with(program.chunk_count() as usize, || None);
        main.program = program;
        self.kept
            .retain(|(program, chunk)| *program != 0 || *chunk < known);
    }

    pub fn program(&self, index: u16) -> Option<&Arc<Program>> {
        self.programs
            .get(usize::from(index))
            .map(|loaded| &loaded.program)
    }

    /// The block at a place; `None` after the last one.
    #[inline]
    pub fn block(&mut self, program: u16, number: u32) -> Option<Fetched<'_>> {
        let loaded = self.programs.get_mut(usize::from(program))?;
        let chunk = (number / Program::CHUNK_SIZE) as usize;
        let offset = (number % Program::CHUNK_SIZE) as usize;
        if loaded.chunks.get(chunk)?.is_none() {
            self.load(program, chunk);
        }
        let loaded = self.programs.get(usize::from(program))?;
        let decoded = loaded.chunks.get(chunk)?.as_ref()?;
        let blocks = &decoded.chunk.blocks;
        Some(Fetched {
            block: blocks.get(offset)?,
            next: blocks.get(offset + 1),
            rounded: decoded.is_rounded(offset),
        })
    }

    #[cold]
    fn load(&mut self, program: u16, chunk: usize) {
        if self.kept.len() >= CHUNKS_KEPT
            && let Some((old_program, old_chunk)) = self.kept.pop_front()
            && let Some(slot) = self
                .programs
                .get_mut(usize::from(old_program))
                .and_then(|p| p.chunks.get_mut(old_chunk))
        {
            *slot = None;
        }
        if let Some(loaded) = self.programs.get_mut(usize::from(program)) {
            let steps =
                InputSteps::of(self.model, loaded.program.unit()).not_finer(self.input_step_mm, self.model);
            let chunk_read = loaded.program.decode_for(chunk as u32, self.model.limits());
            let decoded = Arc::new(Decoded::new(chunk_read, steps));
            if let Some(slot) = loaded.chunks.get_mut(chunk) {
                *slot = Some(decoded);
                self.kept.push_back((program, chunk));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_share_what_is_decoded() {
        let blocks: String = (0..2000).map(|k| format!("L X+{k} Y+{k} F100\n")).collect();
        let text = format!("BEGIN PGM LONG MM\n{blocks}END PGM LONG MM\n");
        let program = Program::from_bytes("LONG.H", text.into_bytes());
        let program = Arc::new(program);
        let mut code = Code::new(Arc::clone(&program), ControlModel::Tnc415b, None);
        for number in 0..program.block_count() {
            assert!(code.block(0, number).is_some());
        }
        let copy = code.clone();
        let shared = code.programs.iter().zip(&copy.programs);
        let chunks = shared.flat_map(|(one, other)| one.chunks.iter().zip(&other.chunks));
        let mut count = 0;
        for (one, other) in chunks {
            assert!(Arc::ptr_eq(one.as_ref().unwrap(), other.as_ref().unwrap()));
            count += 1;
        }
        assert_eq!(count, program.block_count().div_ceil(Program::CHUNK_SIZE));
    }
}
