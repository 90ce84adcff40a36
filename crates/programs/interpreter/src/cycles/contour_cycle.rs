//! Which cycle machines the contours of cycle 14.

use bahn_parameters::MessageId;

use super::contour_data::CYLINDER_SURFACE;
use super::contour_finish::contour_data_cycle;
use super::contour_pocket::{ContourJob, Halt, Watch, contour_milling, pilot_drilling, rough_out};
use super::contour_train::contour_train;
use super::cylinder::cylinder_surface;
use super::machining::Machining;
use crate::context::Context;

/// Runs cycle 6, 15, 16, 21 to 25 or 27 on the contours of cycle 14.
pub(crate) fn contour_cycle(c: &mut Context<'_>, job: &ContourJob, watch: &Watch<'_>) -> Result<(), Halt> {
    let Some(definition) = c.modal.cycle.machining.ready().cloned() else {
        return Err(MessageId::CyclIncomplete.into());
    };
    let queued = c.pen.out.queue.len();
    let result = match definition.number {
        6 => rough_out(&mut Machining::new(c), job, &definition, watch),
        15 => pilot_drilling(&mut Machining::new(c), job, &definition, watch),
        16 => contour_milling(&mut Machining::new(c), job, &definition, watch),
        25 => contour_train(c, job, watch),
        CYLINDER_SURFACE => cylinder_surface(c, job, watch),
        _ => contour_data_cycle(c, job, &definition, watch),
    };
    if let Err(Halt::Interrupted) = result {
        c.pen.out.queue.truncate(queued);
    }
    result
}
