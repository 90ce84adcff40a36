//! The table of cycles whose parameters are assignments to Q parameters: what 20 to 25 and 27 are given (later controls; the
//! manuals here name the cycles only [000:847] [000:652]).

/// What a Q parameter is to a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AssignedParameter {
    /// Number of the Q parameter.
    pub number: u16,
    /// Its name in the dialogue.
    pub name: &'static str,
}

/// The Q parameters that a cycle must be given, in their order; none where it takes no assignments.
///
/// ```
/// use bahn_program::assigned_parameters;
///
/// let numbers: Vec<_> = assigned_parameters(23).iter().map(|parameter| parameter.number).collect();
/// assert_eq!(numbers, [11, 12]);
/// ```
pub fn assigned_parameters(cycle: u16) -> &'static [AssignedParameter] {
    let row = TABLE.iter().find(|(number, _)| *number == cycle);
    row.map_or(&[], |(_, parameters)| parameters)
}

const fn q(number: u16, name: &'static str) -> AssignedParameter {
    AssignedParameter { number, name }
}

const TABLE: &[(u16, &[AssignedParameter])] = &[
    (
        20,
        &[
            q(1, "MILLING DEPTH"),
            q(2, "TOOL PATH OVERLAP"),
            q(3, "ALLOWANCE FOR SIDE"),
            q(4, "ALLOWANCE FOR FLOOR"),
            q(5, "SURFACE COORDINATE"),
            q(6, "SET-UP CLEARANCE"),
            q(7, "CLEARANCE HEIGHT"),
            q(8, "ROUNDING RADIUS"),
            q(9, "DIRECTION OF ROTATION"),
        ],
    ),
    (
        21,
        &[
            q(10, "PLUNGING DEPTH"),
            q(11, "FEED RATE FOR PLUNGING"),
            q(13, "ROUGH-OUT TOOL"),
        ],
    ),
    (
        22,
        &[
            q(10, "PLUNGING DEPTH"),
            q(11, "FEED RATE FOR PLUNGING"),
            q(12, "FEED RATE FOR ROUGHING"),
        ],
    ),
    (
        23,
        &[q(11, "FEED RATE FOR PLUNGING"), q(12, "FEED RATE FOR ROUGHING")],
    ),
    (
        24,
        &[
            q(9, "DIRECTION OF ROTATION"),
            q(10, "PLUNGING DEPTH"),
            q(11, "FEED RATE FOR PLUNGING"),
            q(12, "FEED RATE FOR MILLING"),
            q(14, "ALLOWANCE FOR SIDE"),
        ],
    ),
    (
        25,
        &[
            q(1, "MILLING DEPTH"),
            q(3, "ALLOWANCE FOR SIDE"),
            q(5, "SURFACE COORDINATE"),
            q(7, "CLEARANCE HEIGHT"),
            q(10, "PLUNGING DEPTH"),
            q(11, "FEED RATE FOR PLUNGING"),
            q(12, "FEED RATE FOR MILLING"),
            q(15, "CLIMB OR UP-CUT"),
        ],
    ),
    (
        27,
        &[
            q(1, "MILLING DEPTH"),
            q(3, "ALLOWANCE FOR SIDE"),
            q(6, "SET-UP CLEARANCE"),
            q(10, "PLUNGING DEPTH"),
            q(11, "FEED RATE FOR PLUNGING"),
            q(12, "FEED RATE FOR MILLING"),
            q(16, "CYLINDER RADIUS"),
            q(17, "TYPE OF DIMENSION"),
        ],
    ),
];
