//! The PLC: compiles and runs the instruction list of TNC 407/415/425 machines.
//!
//! The face of this room is small:
//! - [`Compilation::compile`] turns source files into a [`PlcProgram`], with every error and warning of all
//!   files in one pass ([`Diagnostic`], [`PlcError`]);
//! - [`Machine`] runs a program scan by scan on a [`bahn_exchange::Exchange`]: timers, counters, edges, submit
//!   jobs, nominal processing time; [`Tracer`] sees every executed line;
//! - [`modules`] lists the modules 9000 to 9171; [`Nc`] is what they need from the control, with the types
//!   that it speaks in; with the feature `desk`, `TestNc` stands in for it;
//! - [`mirror_parameters`] puts the machine parameters of the PLC into its words and markers;
//! - [`Instruction`] and [`Op`] are the compiled form, for tools that list, cross-reference or translate it.
//!
//! Nothing here knows motion or part programs. Citations like `[000:12070]` name the manual and the line of
//! its text: `000` is the technical manual of the TNC 407/415/425.

#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "citations as [000:12070] look like links"
)]

mod compile;
mod error;
mod fast;
mod modules;
mod nc;
mod operand;
mod program;
mod run;
mod source;
mod syntax;

pub use compile::{Compilation, Options};
pub use error::{Detection, Diagnostic, PlcError};
pub use modules::{Module, modules};
pub use nc::{
    Bar, Cell, Column, ControlledSpindle, CoordinateKind, DataInterface, HostLink, HostMessage,
    InterfaceUser, JogLimit, LineFault, MemoryTable, Nc, NotSaved, OrientationDirection, PalletLine,
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
    Machine, OperandContent, ProcessingTime, Registers, RuntimeError, ScanReport, Start, TraceStep, Tracer,
};
pub use source::{MemoryFiles, ProgramMemory, SourceFiles};
