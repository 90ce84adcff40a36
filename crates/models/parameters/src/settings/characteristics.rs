//! The characteristics of M202: which voltage output S gives at which velocity, MP3013 and MP3014 [000:9862-9898].

use bahn_path::Characteristic;

use crate::ParameterList;

/// How many there are at most.
const CURVES: usize = 3;

/// Up to three characteristics with up to four points, numbered from 1.
///
/// ```
/// use bahn_parameters::{ControlModel, ParameterList};
///
/// let mut list = ParameterList::reference(ControlModel::Tnc415b);
/// // The first of the manual: 0 V up to 25 mm/min, 4.5 V at 500, 9.999 V at 1000.
/// for (index, [velocity, volts]) in [[0.0, 0.0], [25.0, 0.0], [500.0, 4.5], [1000.0, 9.999]].into_iter().enumerate() {
///     list.set(3013, index as u8, velocity).unwrap();
///     list.set(3014, index as u8, volts).unwrap();
/// }
/// let volts = list.characteristics().get(1).unwrap().volts(750.0);
/// assert!((volts - 7.2495).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Characteristics {
    curves: [Option<Characteristic>; CURVES],
}

impl Characteristics {
    /// The characteristic with a number; `None` when there is none.
    pub fn get(&self, number: u8) -> Option<Characteristic> {
        let curve = self.curves.get(usize::from(number).checked_sub(1)?)?;
        // A point at velocity 0 alone is the end of the table.
        curve.filter(|curve| curve.points().len() > 1)
    }
}

impl ParameterList {
    /// MP3013 and MP3014. The first point of each has velocity 0, those of the others rise; what is after the points
    /// that belong to a characteristic is not looked at [000:9876-9898].
    pub fn characteristics(&self) -> Characteristics {
        let mut curves = [None; CURVES];
        let mut number = 0;
        let mut last = f64::NAN;
        let points = (0u8..).map_while(|at| Some([self.get_new(3013, at)?, self.get_new(3014, at)?]));
        for point in points {
            if point[0] == 0.0 {
                number += 1;
            } else if point[0] <= last || last.is_nan() {
                break;
            }
            last = point[0];
            if let Some(curve) = curves.get_mut(number - 1) {
                curve
                    .get_or_insert_with(Characteristic::default)
                    .push(point[0], point[1]);
            }
        }
        Characteristics { curves }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ControlModel;

    /// The table of the manual: characteristic 1 at 750 mm/min 7.2495 V, 3 at 175 mm/min 1.0 V and at 25 mm/min
    /// 4.75 V [000:9876-9890].
    #[test]
    fn the_table_of_the_manual() {
        let mut list = ParameterList::reference(ControlModel::Tnc415b);
        let velocities = [0, 25, 500, 1000, 0, 10_000, 0, 50, 300, 5000, 0, 0];
        let volts = [0.0, 0.0, 4.5, 9.999, 0.0, 9.999, 9.0, 0.5, 1.5, 9.999, 0.0, 0.0];
        for (index, (velocity, volts)) in (0u8..).zip(velocities.into_iter().zip(volts)) {
            list.set(3013, index, f64::from(velocity)).unwrap();
            list.set(3014, index, volts).unwrap();
        }
        let all = list.characteristics();
        for (number, mm_min, volts) in [
            (1, 750.0, 7.2495),
            (1, 10.0, 0.0),
            (1, 2000.0, 9.999),
            (2, 5000.0, 4.9995),
            (3, 0.0, 9.0),
            (3, 25.0, 4.75),
            (3, 175.0, 1.0),
        ] {
            let found = all.get(number).unwrap().volts(mm_min);
            assert!((found - volts).abs() < 1e-9, "{number} at {mm_min}: {found}");
        }
        assert_eq!(
            [0, 1, 2, 3, 4].map(|number| all.get(number).is_some()),
            [false, true, true, true, false]
        );
    }
}
