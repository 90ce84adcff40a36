//! From options to what programs run on.

use bahn_report::solid;
use bahn_report::test_run::{Bench, System900, limits};
use bahn_workpiece::{Columns, Memory};

use super::options::TestOptions;
use crate::settings::{self, Equipment};
use crate::{UsageError, cutting};

/// What the options say; `columns` are those of the part unless they give a resolution.
pub(crate) fn bench(
    options: &TestOptions,
    equipment: Equipment,
    columns: Columns,
) -> Result<Bench, UsageError> {
    let machine = &options.machine;
    let wanted = options.output.resolution.map_or(columns, Columns::Millimetres);
    let mut settings = settings::interpreter(&equipment, &options.run)?;
    settings.point_angles_deg = machine.point_angle.iter().copied().collect();
    Ok(Bench {
        settings,
        left_hand: settings::left_hand(equipment.tools.as_ref()),
        limits: limits(&equipment.list, machine.override_percent),
        times: settings::times(machine),
        memory: match &options.html {
            Some(_) => Memory {
                tools: true,
                ..cutting::memory(&options.output)
            },
            None => cutting::memory(&options.output),
        },
        columns: (!options.output.no_graphics).then_some(wanted),
        ends_at_stop: options.run.stop,
        digitized: options.output.digitized.clone(),
        solid: match &options.output.solid {
            Some(path) => Some(solid::read(path, options.output.resolution)?),
            None => None,
        },
        block_time: machine.block_time,
        system900: equipment.system900.as_ref().map(System900::of),
        list: equipment.list,
    })
}
