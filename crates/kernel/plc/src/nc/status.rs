//! Status and coordinates that modules 9035 to 9042 read and write.

macro_rules! numbered {
    ($(#[$doc:meta])* $name:ident { $($(#[$item_doc:meta])* $item:ident,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name {
            $($(#[$item_doc])* $item,)+
        }

        impl $name {
            /// All in the order of their numbers, which count from 0.
            pub const ALL: &[$name] = &[$($name::$item),+];

            /// The one with a number of the manual.
            pub fn numbered(number: i32) -> Option<$name> {
                $name::ALL.get(usize::try_from(number).ok()?).copied()
            }
        }
    };
}

numbered! {
    /// What 9035 reads; values as the manual codes them [000:14899-14916]. The meanings of 0 and 1 are
    /// lost (inferred).
    StatusItem {
        /// Basic mode of the editing screen.
        EditingMode,
        /// Basic mode of the machine screen, coded as W272.
        MachineMode,
        /// Mode over the editing screen: 0 none, 1 mode, 2 directory, 3 machine parameters, 4 PLC.
        EditingOverlay,
        /// Mode over the machine screen: 0 none, 1 mode, 2 directory, 3 tool table.
        MachineOverlay,
        /// Windows of both screens, bit by bit.
        Windows,
        /// File in editing or test run: 0 none, 1 .H, 2 .I, 3 .T, 4 .D, 5 .P, 6 .A, 7 .S.
        EditedFile,
        /// File in single block or full sequence: 0 none, 1 .H, 2 .I.
        ExecutedFile,
        /// Axis for the transfer of actual values while editing.
        EditingAxis,
        /// Axis for the transfer of actual values on the machine screen.
        MachineAxis,
        /// Axis of the handwheel; -1 none or several.
        HandwheelAxis,
        /// Axes of the handwheel, bit by bit.
        HandwheelAxes,
        /// Handwheel subdivision of X, 0 to 10.
        SubdivisionX,
        /// Handwheel subdivision of Y, 0 to 10.
        SubdivisionY,
        /// Handwheel subdivision of Z, 0 to 10.
        SubdivisionZ,
        /// Handwheel subdivision of axis 4, 0 to 10.
        Subdivision4,
        /// Handwheel subdivision of axis 5, 0 to 10.
        Subdivision5,
        /// Format of $MDI: 0 .H, 1 .I.
        MdiFormat,
        /// Units of the display: 0 mm, 1 inch.
        Units,
        /// Tilted working plane: bit 0 active, 1 for manual operation, 2 for program run.
        WorkingPlane,
    }
}

numbered! {
    /// Which coordinates 9040 and 9041 read [000:14998-15006].
    CoordinateKind {
        /// Actual values, mm or degrees.
        Actual,
        /// Nominal values, mm or degrees.
        Nominal,
        /// Actual values in the reference system.
        Reference,
        /// Trailing errors (servo lag).
        TrailingError,
        /// Distances to go, mm or degrees.
        DistanceToGo,
        /// Deflections of a measuring touch probe.
        Deflection,
        /// Actual values in the shifted datum system.
        ShiftedDatum,
    }
}

/// What 9036 changes [000:14935-14953].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StatusChange {
    /// The subdivision of the handwheel.
    Subdivision {
        /// The axis; `None` means all.
        axis: Option<usize>,
        /// Number of the subdivision, 0 to 10.
        factor: u8,
    },
    /// The handwheel moves this axis.
    HandwheelAxis(usize),
    /// The limit of the jog increment.
    JogLimit(JogLimit),
}

/// The limit of the jog increment [000:14948].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JogLimit {
    /// This limit in mm, 0 to 50.
    At(f64),
    /// No limit; the increment that was entered last is active.
    LastIncrement,
    /// No limit; the smaller one of the last increment and the last limit is active.
    SmallerOfLastIncrementAndLimit,
}

/// Angles of the spindle in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpindlePosition {
    /// Actual angle, degrees.
    pub actual: f64,
    /// Actual angle in the reference system.
    pub reference: f64,
    /// What holds while its position is controlled; `None` with open loop.
    pub closed_loop: Option<ControlledSpindle>,
}

/// Angles of a spindle whose position is controlled, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControlledSpindle {
    /// Nominal angle, degrees.
    pub nominal: f64,
    /// Trailing error (servo lag).
    pub trailing_error: f64,
    /// What is left to the target.
    pub distance_to_go: f64,
}
