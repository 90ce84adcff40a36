//! The contour subprograms of cycle 14, executed aside for a cycle that machines them.

use bahn_parameters::MessageId;
use bahn_path::{AxisSet, BlockRef};

use crate::Interpreter;
use crate::contour::Contour;
use crate::cycles::{CYLINDER_SURFACE, ContourJob, Halt, contour_plane, other_tool, take_surface};
use crate::error::Fault;
use crate::output::Output;

impl Interpreter {
    /// Executes the contour subprograms of cycle 14 aside and records their geometry; nothing else of them
    /// has an effect [003:5389-5454].
    pub(crate) fn record_contours(&mut self) -> Result<ContourJob, Halt> {
        let labels = self.run.modal.contour_labels.clone();
        if labels.is_empty() {
            return Err(no_contours().into());
        }
        let (mut c, tools, _) = self.run.parts(&self.settings);
        let other_radius = match other_tool(&c)? {
            Some(tool) => Some(tools.radius_of(&mut c, tool)?),
            None => None,
        };
        let is_cylinder = c
            .modal
            .cycle
            .machining
            .ready()
            .is_some_and(|d| d.number == CYLINDER_SURFACE);
        let mut recorder = self.run.clone();
        if is_cylinder {
            take_surface(&mut recorder.context(&self.settings))?;
        }
        recorder.pen.contour = Contour::recorder();
        recorder.pen.out = Output::default();
        recorder.modal.compensation = bahn_program::Compensation::Off;
        std::mem::swap(&mut self.run, &mut recorder);
        let job = self.record_labels(&labels);
        std::mem::swap(&mut self.run, &mut recorder);
        Ok(ContourJob { other_radius, ..job? })
    }

    /// Looks whether the contours of cycle 14 are there.
    pub(crate) fn rehearse_contours(&mut self) -> Result<(), Fault> {
        let labels = std::mem::take(&mut self.run.modal.contour_labels);
        let found = labels.iter().try_for_each(|&label| self.label(label).map(drop));
        let defined = !labels.is_empty();
        self.run.modal.contour_labels = labels;
        found?;
        if !defined {
            return Err(no_contours());
        }
        self.run.at.block += 1;
        Ok(())
    }

    fn record_labels(&mut self, labels: &[u16]) -> Result<ContourJob, Halt> {
        let home = self.run.at.clone();
        let mut job = None;
        let is_train = self.run.modal.cycle.is_contour_train();
        // A train is the first contour alone (later controls).
        let taken = if is_train { 1 } else { labels.len() };
        for &label in labels.iter().take(taken) {
            self.run.at = home.clone();
            self.run.pen.recording = Some(AxisSet::EMPTY);
            let target = self.label(label)?;
            self.run.at.call(label, target, self.settings.model.limits())?;
            while self.run.at.depth() > home.depth() {
                if self.is_interrupted() {
                    return Err(Halt::Interrupted);
                }
                let at = self.run.at.block_ref();
                self.step().map_err(|fault| fault.at(at))?;
                if self.ended.take().is_some() {
                    let detail = format!("the contour subprogram LBL {label} does not end with LBL 0");
                    return Err(Fault::new(MessageId::ExcessiveSubprogramming, detail)
                        .at(at)
                        .into());
                }
            }
            let moves = self.run.pen.contour.take_recorded(&mut self.run.pen.out)?;
            let axes = self.run.pen.recording.unwrap_or(AxisSet::EMPTY);
            let job = job.get_or_insert_with(|| ContourJob::new(contour_plane(self.run.modal.plane, axes)));
            job.cylinder = self.run.modal.surface.and_then(|surface| surface.found);
            let added = if is_train {
                job.add_train(&moves)
            } else {
                job.add(&moves)
            };
            added.map_err(|fault| {
                fault.at(BlockRef {
                    program: home.program,
                    block: target,
                })
            })?;
        }
        job.ok_or_else(|| MessageId::CyclIncomplete.into())
    }
}

fn no_contours() -> Fault {
    Fault::new(
        MessageId::CyclIncomplete,
        "cycle 14 CONTOUR GEOMETRY is not defined",
    )
}
