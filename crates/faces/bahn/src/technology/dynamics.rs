//! From a list of machine parameters, which may hold changes only, to the limits of motion.
//!
//! Decision: `bahn technology` moves by the reference list of a TNC 415 B with MP1010 10 m/min, MP1060 and MP1070 1
//! m/s² for all axes, and the lines of `--parameters` over it

use std::path::Path;

use bahn_motion::Limits;
use bahn_parameters::{ControlModel, ParameterList};
use bahn_report::test_run;

use crate::{UsageError, files, settings};

/// What axes do that no list says anything of: rapid traverse 10 m/min, acceleration 1 m/s², on circles too.
const PLAIN: [&str; 11] = [
    "1010.0=10000",
    "1010.1=10000",
    "1010.2=10000",
    "1010.3=10000",
    "1010.4=10000",
    "1060.0=1",
    "1060.1=1",
    "1060.2=1",
    "1060.3=1",
    "1060.4=1",
    "1070=1",
];

/// Plain dynamics, with the lines of a list over them.
pub(super) fn limits(list: Option<&Path>) -> Result<Limits, UsageError> {
    let bytes = list.map(files::read_table).transpose()?;
    let named = bytes.as_deref().and_then(ControlModel::named_in);
    let model = named.unwrap_or_default();
    let mut parameters = ParameterList::reference(model);
    for assignment in PLAIN {
        // Lists of the first controls have other numbers: they begin with their reference list.
        let _ = parameters.assign(assignment);
    }
    if let Some((path, bytes)) = list.zip(bytes) {
        settings::read_lines(&mut parameters, path, &bytes)?;
    }
    Ok(test_run::limits(&parameters, 100.0))
}

#[cfg(test)]
mod tests {
    use bahn_path::Axis;

    use super::*;

    #[test]
    fn a_list_changes_only_what_it_says() {
        let plain = limits(None).unwrap();
        for axis in [Axis::X, Axis::Y, Axis::Z, Axis::C, Axis::W] {
            assert_eq!(
                (plain.max_feed_mm_min[axis], plain.acceleration_m_s2[axis]),
                (10_000.0, 1.0),
                "{axis}"
            );
        }
        let path = std::env::temp_dir().join(format!("bahn-dynamics-{}.mp", std::process::id()));
        std::fs::write(&path, "MP1010.0 : 5000\nMP1060.1 : 2.5\nMP7460 : 30\n").unwrap();
        let changed = limits(Some(&path)).unwrap();
        assert_eq!(changed.max_feed_mm_min[Axis::X], 5000.0);
        assert_eq!(changed.max_feed_mm_min[Axis::Y], 10_000.0);
        assert_eq!(changed.acceleration_m_s2[Axis::Y], 2.5);
        assert_eq!(changed.corner_angle_deg, 30.0);
        assert_eq!(changed.radial_acceleration_m_s2, plain.radial_acceleration_m_s2);
        std::fs::write(&path, "MP1010.0 : fast\n").unwrap();
        assert!(limits(Some(&path)).unwrap_err().to_string().contains("MP1010.0"));
        std::fs::remove_file(&path).unwrap();
    }
}
