//! The PLC: compiles and runs the instruction list of TNC 407/415/425 machines.
//!
//! The face of this room is small:
//! - [`Compilation::compile`] turns source files into a [`PlcProgram`], with every error and warning of all
//!   files in one pass ([`Fault`], [`PlcError`]);
//! - [`Machine`] runs a program scan by scan on a [`bahn_exchange::Exchange`]: timers, counters, edges, submit
//!   jobs, nominal processing time; [`Tracer`] sees every executed line, [`CodeTrace`] is a scan as the instruction list shows it;
//! - [`modules`] lists the modules 9000 to 9171; [`Nc`] is what they need from the control, with the types
//!   that it speaks in; with the feature `desk`, `TestNc` stands in for it;
//! - [`DataLines`] is what comes over the data interfaces to it, [`OrderedLines`] what it wants of them;
//! - [`mirror_parameters`] puts the machine parameters of the PLC into its words and markers;
//! - [`Instruction`] and [`Op`] are the compiled form, for tools that list, cross-reference or translate it; [`accesses`]
//!   are the operands of an instruction; [`line_words`] are the words of a line, [`instructions`] what they mean.
//!
//! ```
//! use bahn_exchange::Exchange;
//! use bahn_parameters::{ControlModel, ParameterList};
//! use bahn_plc::{Compilation, Machine, MemoryFiles, Options, Start, TestNc};
//! // O2 follows I4 while I5 is off.
//! let files = MemoryFiles::from([("MAIN.PLC", "L I4\nAN I5\n= O2\nEM\n")]);
//! let program = Compilation::compile(&files, "MAIN.PLC", Options::default()).program.unwrap();
//! let mut machine = Machine::new(program.into(), Start::PowerOn);
//! let mut nc = TestNc::new(ParameterList::reference(ControlModel::Tnc415b));
//! let mut exchange = Exchange::default();
//! exchange.nc_set("I4".parse()?, true);
//! machine.scan(&mut exchange, &mut nc)?;
//! assert!(exchange.nc().bit("O2".parse()?));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing here knows motion or part programs. Citations like `[000:12070]` name the manual and the line of
//! its text: `000` is the technical manual of the TNC 407/415/425.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:12070] look like links"
)]

mod access;
mod compile;
mod data_line;
mod error;
mod fast;
mod fault;
mod modules;
mod nc;
mod operand;
mod program;
mod run;
mod source;
mod standard;
mod syntax;

pub use access::{Access, Memory, Subject, accesses};
pub use bahn_text::MemoryFiles;
pub use compile::{Compilation, Options};
pub use data_line::{DataLineEvent, DataLineOrder, DataLines, HostEvent, LineEvent, LineSetup, OrderedLines};
pub use error::{Detection, PlcError};
pub use fault::Fault;
pub use modules::{Module, modules};
pub use nc::{
    Bar, Cell, Column, CompensationExcess, CompensationSize, ControlledSpindle, CoordinateKind,
    DataInterface, HostLink, HostMessage, InterfaceUser, JogLimit, LineFault, MemoryTable, Nc, NcInterfaces,
    NcMemory, NcMotion, NcParameters, NcScreen, NcStatus, NotSaved, OrientationDirection, PalletLine,
    ParameterFault, ParameterFileFault, PlcAxisCommand, PlcAxisStatus, PlcWindow, SpindleOrientation,
    SpindlePosition, StatusChange, StatusItem, TableFile, TableKind, TextFile, ToolCallBlock, WindowView,
    mirror_parameters,
};
#[cfg(feature = "desk")]
pub use nc::{TestAxis, TestNc};
pub use operand::{BitOperand, NumberOperand, TextOperand, Value};
pub use program::{
    Arithmetic, BitOperation, Comparison, Condition, Field, Gate, Instruction, Label, LabelPlace, Op,
    PlcProgram, SourceLine, SourceText, Target, Transform,
};
pub use run::{
    CodeTrace, Executed, Machine, OperandContent, ProcessingTime, Registers, RuntimeError, ScanReport, Start,
    TraceStep, Tracer,
};
pub use source::{Memories, ProgramMemory};
pub use standard::standard_program;
pub use syntax::{
    InstructionForm, LineOperand, LineWords, Nesting, check_line, code_of_line, instructions, line_words,
    listed_code, nesting, split_comment,
};
