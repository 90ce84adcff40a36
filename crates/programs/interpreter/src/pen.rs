//! The pen: what the block being executed draws, on its way through the contour stages into the queue.
//!
//! Decision: On a machine the next block is read after the acknowledgement of functions at which the path stands
//! anyway; Q100-Q107 count from the strobe after the one in which the PLC wrote them (also `tnc/src/q_transfer.rs`)
//!
//! Decision: A loop that waits for the PLC or dwells takes time on a machine and is no endless one

use std::sync::Arc;

use bahn_parameters::technology::{self, Technology};
use bahn_path::{
    At, Axis, AxisSet, Barrier, BlockRef, Curve, FeedRate, Function, PathElement, Placement, Position,
    Synchronisation, TechnologyFunction,
};

use crate::block_functions::BlockFunctions;
use crate::contour::{Contour, ContourMove, CornerArcs, Side};
use crate::error::Fault;
use crate::flow::Flow;
use crate::modal::Modal;
use crate::output::Output;
use crate::settings::Settings;

/// Draws movements and functions of the block being executed.
#[derive(Clone, Debug)]
pub(crate) struct Pen {
    /// Block being executed: the call block while a cycle runs.
    pub block: BlockRef,
    /// How many blocks were executed so far.
    pub sequence: u64,
    /// Executed blocks since the last movement.
    pub since_motion: u64,
    pub contour: Contour,
    pub out: Output,
    /// The next block is a straight line with coordinates: neither a rounding nor a tangential arc can refer
    /// to the movement of this block, so nothing needs to be held back for it.
    pub line_follows: bool,
    /// The next block is a rounding or chamfer: it refers to the movement of this block.
    pub join_follows: bool,
    /// A contour subprogram is being recorded for an SL cycle: M functions, feeds and cycle calls in it
    /// are ignored [003:5389-5454]. Holds the axes of the first coordinate block.
    pub recording: Option<AxisSet>,
    /// How the coordinates of what is drawn stand in the machine, when not upright.
    pub placement: Option<Arc<Placement>>,
    /// See [`Settings::as_programmed`].
    pub as_programmed: bool,
    /// See [`Settings::machine`].
    pub machine: bool,
    /// Nothing is moved: cycles are looked at but make no path, and the tool has no radius.
    pub rehearsal: bool,
}

impl Pen {
    pub fn new(settings: &Settings) -> Pen {
        Pen {
            block: BlockRef::default(),
            sequence: 0,
            since_motion: 0,
            contour: Contour::default(),
            out: Output::default(),
            line_follows: false,
            join_follows: false,
            recording: None,
            placement: None,
            as_programmed: settings.as_programmed,
            machine: settings.machine,
            rehearsal: false,
        }
    }

    /// A function with a block of its own.
    pub fn output_function(
        &mut self,
        modal: &Modal,
        function: Function,
        block: technology::Block,
        settings: &Settings,
    ) -> Result<(), Fault> {
        let Some(technology) = Technology::of_block(settings.model, block) else {
            return Ok(());
        };
        let functions = BlockFunctions {
            output: vec![settings.rules.machine.output(function, technology)],
            ..Default::default()
        };
        self.hold(modal, functions)?;
        Ok(())
    }

    /// A block of functions without movement.
    pub fn hold(&mut self, modal: &Modal, functions: BlockFunctions) -> Result<Flow, Fault> {
        if functions.output.is_empty() && !functions.stop && !functions.end {
            return Ok(Flow::Next);
        }
        let element = self.element(Curve::Hold, modal.actual, modal.actual, FeedRate::Rapid);
        self.push(modal, element, functions, false)
    }

    /// Hands a movement or hold with the functions of its block to the contour stages.
    pub fn push(
        &mut self,
        modal: &Modal,
        mut element: PathElement,
        mut functions: BlockFunctions,
        in_plane: bool,
    ) -> Result<Flow, Fault> {
        let mut barrier = None;
        if functions.stop {
            let stop = TechnologyFunction::new(Function::Stop, At::End, Synchronisation::MnsSns);
            functions.output.push(stop);
            barrier = Some(Barrier::Stop { block: self.block });
        } else if self.machine && !functions.cycle_call && self.may_wait_for_plc(&element, &functions.output)
        {
            barrier = Some(Barrier::Acknowledge { block: self.block });
        }
        if !functions.output.is_empty() {
            element.functions = Some(functions.output.into_boxed_slice());
        }
        element.constant_speed = functions.constant_speed;
        self.note_motion(element.curve, &element.start, &element.end);
        if self.machine && barrier.is_some() {
            self.note_time();
        }
        let corner_arcs = modal.corner_arcs.map(|arcs| CornerArcs {
            // A rounding refers to the point itself.
            spacing_mm: if self.join_follows {
                0.0
            } else {
                modal.point_spacing_mm
            },
            ..arcs
        });
        let item = ContourMove {
            element,
            plane: modal.contour_plane,
            side: modal.side(),
            radius: match self.rehearsal || self.as_programmed {
                true => 0.0,
                false => modal.tool_radius(),
            },
            corner: functions.corner,
            feed_law: modal.feed_law,
            in_plane,
            smooth: None,
            barrier,
            corner_arcs,
        };
        let waits = item.barrier.is_some() && item.side == Side::Off;
        self.contour
            .push(item, &mut self.out)
            .map_err(Fault::found_ahead)?;
        if waits {
            // The run stands still here: no block after it is read before it goes on. Inside a compensated
            // contour the corner needs the next element all the same.
            self.contour.flush(&mut self.out).map_err(Fault::found_ahead)?;
        }
        Ok(if functions.end { Flow::EndOfRun } else { Flow::Next })
    }

    /// A block that leads somewhere else is a movement; `L IX+0` is none.
    #[inline]
    pub fn note_motion(&mut self, curve: Curve, start: &Position, end: &Position) {
        // An axis without a position gets one.
        let moves = |axis: Axis| start[axis] != end[axis] && !end[axis].is_nan();
        let moved = match curve {
            Curve::Hold => false,
            Curve::Line => Axis::ALL.into_iter().any(moves),
            Curve::Arc(_) | Curve::Corner(_) => curve.length(start, end) > 0.0,
        };
        if moved {
            self.since_motion = 0;
        }
    }

    /// What waits on a machine takes time: a loop of it, such as for a Q parameter of the PLC, may go on.
    pub fn note_time(&mut self) {
        self.since_motion = 0;
    }

    /// Whether the path stands until the PLC has acknowledged, so that nothing is lost when the next block is
    /// read only then. A block that goes on moving after its functions is not cut off from the next one, nor
    /// from its rounding or its cycle.
    fn may_wait_for_plc(&self, element: &PathElement, functions: &[TechnologyFunction]) -> bool {
        let stands = |function: &TechnologyFunction| {
            let waits = matches!(
                function.synchronisation,
                Synchronisation::MvsSvs | Synchronisation::MnsSns
            );
            // What goes out ahead is to be acknowledged when the path comes there: it reads on.
            let ahead = matches!(function.at, At::Ahead(_));
            waits && !ahead && (function.at == At::End || element.curve == Curve::Hold)
        };
        functions.iter().any(stands) && !self.join_follows && !self.contour.has_join()
    }

    /// An element of the current block.
    #[inline]
    pub fn element(&self, curve: Curve, start: Position, end: Position, feed: FeedRate) -> PathElement {
        let mut element = PathElement::new(self.block, self.sequence, curve, [start, end], feed);
        element.placement.clone_from(&self.placement);
        element
    }

    /// Hands out what the contour stages hold back and takes over where the tool centre really stands.
    pub fn finish_contour(&mut self) -> Result<(), Fault> {
        self.contour.flush(&mut self.out).map_err(Fault::found_ahead)
    }

    /// Where the tool centre stands after [`Pen::finish_contour`].
    pub fn tool_centre(&self, modal: &Modal) -> Position {
        let mut position = modal.actual;
        if let Some((plane, point)) = self.contour.displaced() {
            plane.set(&mut position, point);
        }
        position
    }
}
