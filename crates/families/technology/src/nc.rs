//! Programs of a run from `.nc` files.

use std::sync::Arc;

use bahn_din::{BlockFault, Decoder, Place, Program, Section, Step, Unit, Variables};
use bahn_path::{AxisSet, Position};
use bahn_text::Files;

use crate::report::Fault;
use crate::run::{Blocks, Sequence};

/// The code of what is wrong with the text of a block: the manuals have no number for it.
const SYNTAX: &str = "syntax";

/// The programs of files, one after the other: of a file with several all of them.
pub struct NcPrograms {
    list: Vec<(Arc<Program>, Section)>,
    beside: Arc<dyn Files>,
}

impl NcPrograms {
    /// The programs of these files; subroutines are found `beside` them.
    ///
    /// # Errors
    /// When a file has no program but subroutines alone.
    pub fn new(files: &[Arc<Program>], beside: Arc<dyn Files>) -> Result<NcPrograms, Fault> {
        let mut list = Vec::new();
        for file in files {
            let before = list.len();
            list.extend(file.mains().map(|main| (file.clone(), main.clone())));
            if list.len() == before {
                return Err(Fault {
                    code: SYNTAX.to_owned(),
                    message: "the file has no program".to_owned(),
                    program: file.name().to_string(),
                    block: "#1".to_owned(),
                    line: 1,
                });
            }
        }
        Ok(NcPrograms { list, beside })
    }

    /// The axes that their files name.
    pub fn axes(&self) -> AxisSet {
        let files = self.list.iter().map(|(file, _)| file.axes());
        files.fold(AxisSet::EMPTY, |all, axes| axes.iter().fold(all, AxisSet::with))
    }
}

impl Sequence for NcPrograms {
    fn count(&self) -> usize {
        self.list.len()
    }

    fn name(&self, index: usize) -> String {
        self.list
            .get(index)
            .map_or_else(String::new, |(file, _)| file.name().to_string())
    }

    fn open(&self, index: usize, start: &Position) -> Result<Box<dyn Blocks + '_>, Fault> {
        let Some((file, main)) = self.list.get(index) else {
            return Err(Fault {
                code: SYNTAX.to_owned(),
                message: "there is no such program".to_owned(),
                program: String::new(),
                block: String::new(),
                line: 0,
            });
        };
        let decoder = Decoder::new(file.clone(), main, *start, self.beside.clone());
        Ok(Box::new(NcBlocks { decoder }))
    }
}

/// A program that is read.
struct NcBlocks {
    decoder: Decoder,
}

impl Blocks for NcBlocks {
    fn next(&mut self, variables: &mut dyn Variables) -> Result<Option<Unit>, Fault> {
        match self.decoder.next(variables) {
            Step::Unit(unit) => Ok(Some(*unit)),
            Step::End => Ok(None),
            Step::Fault(fault) => Err(of(fault)),
        }
    }

    fn next_is(&mut self, block: &str) -> bool {
        self.decoder.next_is(block)
    }

    fn position(&self) -> Position {
        self.decoder.position()
    }

    fn not_found(&self, block: &str) -> Fault {
        of(BlockFault {
            place: self.decoder.begin(),
            column: 1,
            length: 1,
            message: format!("block {block} is not in the program"),
        })
    }
}

fn of(fault: BlockFault) -> Fault {
    let Place { program, block, line } = fault.place;
    Fault {
        code: SYNTAX.to_owned(),
        message: fault.message,
        program: program.to_string(),
        block: block.to_string(),
        line,
    }
}
