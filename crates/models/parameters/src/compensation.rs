//! Non-linear axis errors as the machine builder writes them down: tables in text form [000:3770-3887].

mod correction;
mod table;

pub use correction::CorrectionTables;
pub use table::{CompensationAssignment, CompensationError, CompensationTable};

/// How large a compensation table (.COM) is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CompensationSize {
    /// Axes that depend on the one that it is assigned to.
    pub dependencies: usize,
    /// Points of each dependency.
    pub points: usize,
}

/// What there is too much of in the compensation tables of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompensationExcess {
    /// A dependency has more than 256 points.
    PointsOfDependency,
    /// There are more than ten dependencies.
    Dependencies,
    /// There are more than 640 points.
    Points,
}

impl CompensationExcess {
    /// What tables that shall be active together have too much of: at most ten dependencies and 640 points, 256 for each
    /// dependency [000:3770].
    ///
    /// ```
    /// use bahn_parameters::compensation::{CompensationExcess, CompensationSize};
    /// let table = CompensationSize { dependencies: 3, points: 200 };
    /// assert_eq!(CompensationExcess::of(&[table]), None);
    /// assert_eq!(CompensationExcess::of(&[table, table]), Some(CompensationExcess::Points));
    /// ```
    pub fn of(tables: &[CompensationSize]) -> Option<CompensationExcess> {
        const POINTS_OF_DEPENDENCY_MAX: usize = 256;
        const DEPENDENCIES_MAX: usize = 10;
        const POINTS_MAX: usize = 640;
        let dependencies: usize = tables.iter().map(|table| table.dependencies).sum();
        let points: usize = tables.iter().map(|table| table.dependencies * table.points).sum();
        if tables.iter().any(|table| table.points > POINTS_OF_DEPENDENCY_MAX) {
            Some(CompensationExcess::PointsOfDependency)
        } else if dependencies > DEPENDENCIES_MAX {
            Some(CompensationExcess::Dependencies)
        } else if points > POINTS_MAX {
            Some(CompensationExcess::Points)
        } else {
            None
        }
    }
}
