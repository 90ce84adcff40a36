//! The colours of the screen: MP7350 to MP7363, six bits for each of red, green and blue [000:6289-6366].

use std::collections::BTreeMap;

use bahn_parameters::ParameterList;

/// The parameters, and how many indices each has.
const COLOURS: &[(u16, u8)] = &[
    (7350, 1),
    (7351, 1),
    (7352, 3),
    (7353, 3),
    (7354, 4),
    (7355, 4),
    (7356, 3),
    (7357, 2),
    (7358, 2),
    (7360, 5),
    (7361, 5),
    (7362, 4),
    (7363, 5),
];

/// A colour, red, green and blue from 0 to 255; `None` on a control without this parameter.
pub fn colour(list: &ParameterList, number: u16, index: u8) -> Option<[u8; 3]> {
    let packed = list.get(number, index)? as u32;
    // 3F is full.
    let part = |shift: u32| ((packed >> shift & 0x3f) * 255 / 63) as u8;
    Some([part(16), part(8), part(0)])
}

/// All of them, as `7352.1` and `#d28220`; none on a control before the TNC 407, whose screen of 12 inches has no
/// colours (inferred).
pub fn all(list: &ParameterList) -> BTreeMap<String, String> {
    if !list.model().has_windows() {
        return BTreeMap::new();
    }
    let indices = COLOURS
        .iter()
        .flat_map(|(number, count)| (0..*count).map(move |index| (*number, index)));
    let coded = indices.filter_map(|(number, index)| {
        let [red, green, blue] = colour(list, number, index)?;
        Some((
            format!("{number}.{index}"),
            format!("#{red:02x}{green:02x}{blue:02x}"),
        ))
    });
    coded.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bahn_parameters::ControlModel;

    /// The standard colours of the manual's list: MP7350 is $030200C, MP7351 $03F3F0F.
    #[test]
    fn six_bits_each_of_red_green_and_blue() {
        let list = ParameterList::smallest(ControlModel::Tnc415b);
        let full = |six: u32| (six * 255 / 63) as u8;
        assert_eq!(colour(&list, 7350, 0), Some([full(0x30), full(0x20), full(0x0c)]));
        assert_eq!(colour(&list, 7351, 0), Some([255, 255, full(0x0f)]));
        let all = all(&list);
        assert_eq!(all.len(), 42);
        assert_eq!(all["7361.4"], "#ff0000");
        assert!(super::all(&ParameterList::smallest(ControlModel::Tnc360)).is_empty());
    }
}
