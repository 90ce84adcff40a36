//! Superposition of the subcontours of cycle 14 CONTOUR GEOMETRY.
//!
//! Decision: Subcontours superimpose by their start points

use super::effort::{Effort, Unlimited};
use super::index::{Bounds, Index};
use super::vector::*;
use super::{Contour, Location, RESOLUTION_MM, Region};
use crate::Point2;

/// What a subcontour bounds [003:5444-5447].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The area inside is machined.
    Pocket,
    /// The area inside stays.
    Island,
}

/// A subcontour of an SL contour. Its start point is the start of the contour.
#[derive(Clone, Debug, PartialEq)]
pub struct SubContour {
    /// Programmed contour, in either sense; an open one is closed by a line.
    pub contour: Contour,
    /// Whether it is a pocket or an island.
    pub kind: Kind,
}

impl SubContour {
    /// A subcontour as programmed: where the tool runs inside the contour it is a pocket, where it runs
    /// outside an island. So RL counter-clockwise and RR clockwise are pockets [003:5444-5447].
    pub fn programmed(contour: Contour, tool_left: bool) -> SubContour {
        let inside = tool_left == contour.is_counter_clockwise();
        SubContour {
            contour,
            kind: if inside { Kind::Pocket } else { Kind::Island },
        }
    }
}

/// When pockets merge: bit 2 of MP7420 [000:6720-6747].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merge {
    /// +0: every contour is compensated first, contours merge if the tool centre paths intersect.
    /// Material stays in the inside corners of a narrow overlap.
    CentrePaths,
    /// +4: programmed contours are merged if they overlap, and the merged contour is compensated.
    ProgrammedContours,
}

/// A connected area that the tool centre may sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct PocketArea {
    /// The area, of one part.
    pub region: Region,
    /// Its boundaries in the order in which they are milled: by the subcontour that starts them.
    pub outlines: Vec<Outline>,
}

/// A boundary of a [`PocketArea`]: a channel that the tool mills.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The boundary, from the infeed point and with the area on the left: counter-clockwise around a
    /// pocket, clockwise around islands (MP7420 bit 0 = 0 [003:7375-7385]).
    pub contour: Contour,
    /// Index of the subcontour whose start point the infeed point belongs to. For overlapping
    /// contours it is the first one in the list [003:5993-5999].
    pub leader: usize,
    /// Indices of all subcontours that the outline follows, in the order of the list.
    pub members: Vec<usize>,
}

impl Outline {
    /// Infeed point: the start point of the leader on the outline.
    pub fn infeed(&self) -> Point2 {
        self.contour.start()
    }
}

/// The areas that result from subcontours in the order of their list, for a tool centre that keeps
/// `distance` (tool radius plus allowance, mm; 0 gives the programmed area) to every contour. Areas and
/// their outlines come in the order of the list; nothing results without a pocket or where the tool
/// does not fit.
///
/// # Start point rules
///
/// The manual gives six cases of two overlapping contours [003:5619] [003:5741-5927]:
///
/// | A | B | condition | machined | unmachined |
/// |---|---|---|---|---|
/// | pocket | pocket | A starts outside B | A ∪ B | |
/// | pocket | pocket | A starts inside B | A ∩ B | |
/// | pocket | island | A starts outside B | A \ B | |
/// | island | island | A starts outside B | | A ∪ B |
/// | island | island | A starts inside B | | A ∩ B |
/// | island | pocket | B starts inside A | | A \ B |
///
/// All of them say that the start point of the first contour lies on the boundary of the result. For any
/// number of subcontours this becomes (inferred):
///
/// 1. Two contours *overlap* when they share area and neither contains the other. What only contains,
///    touches or is apart needs no rule: pockets count together, an island in a pocket stays.
/// 2. Pockets that overlap directly or through others are a group, likewise islands. The first of
///    the list leads. The group starts as the leader's area; each further member in the order of the list
///    is intersected if it overlaps the leader and the leader starts inside it, else united.
/// 3. A pocket takes nothing from an island, except a pocket that starts inside an island: it *reduces*
///    that island, and each other island that does not start inside the pocket [003:5805-5809].
/// 4. Machined is what lies in any group of pockets and in no group of (reduced) islands.
/// 5. A start point on the other contour counts as outside. Whether it is inside is decided by the
///    programmed contours also when compensated ones are merged.
///
/// ```
/// use bahn_path::Sense;
/// use bahn_path::region::{Contour, Merge, SubContour, superimpose};
/// let a = SubContour::programmed(Contour::circle([35.0, 50.0], 25.0, 180.0, Sense::CounterClockwise), true);
/// let b = SubContour::programmed(Contour::circle([65.0, 50.0], 25.0, 0.0, Sense::CounterClockwise), true);
/// let areas = superimpose(&[a, b], 3.0, Merge::ProgrammedContours);
/// assert_eq!(areas.len(), 1);
/// let infeed = areas[0].outlines[0].infeed();
/// assert!((infeed[0] - 13.0).abs() < 1e-9 && (infeed[1] - 50.0).abs() < 1e-9);
/// ```
pub fn superimpose(subcontours: &[SubContour], distance: f64, merge: Merge) -> Vec<PocketArea> {
    let Ok(result) = Superposition::new(subcontours, distance, merge, &Unlimited);
    result.areas
}

/// The result of [`superimpose`], and what of the subcontours is not in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Superposition {
    /// The areas of the tool centre.
    pub areas: Vec<PocketArea>,
    /// Indices of the pockets into which the tool does not fit.
    pub too_narrow: Vec<usize>,
}

impl Superposition {
    /// See [`superimpose`].
    ///
    /// # Errors
    /// When the effort ends it.
    pub fn new<E: Effort>(
        subcontours: &[SubContour],
        distance: f64,
        merge: Merge,
        effort: &E,
    ) -> Result<Superposition, E::Stop> {
        let mut programmed: Vec<Region> = Vec::with_capacity(subcontours.len());
        let mut compensated: Vec<Region> = Vec::with_capacity(subcontours.len());
        for subcontour in subcontours {
            let region = Region::from_contour_within(&subcontour.contour, effort)?;
            let shrinks = subcontour.kind == Kind::Pocket;
            let by = if shrinks { -distance } else { distance };
            compensated.push(region.offset_within(by, effort)?);
            programmed.push(region);
        }
        let plan = Plan::new(&Relations::new(subcontours, &programmed, effort)?);
        let combine = |regions: &[Region]| {
            let regions: Vec<&Region> = regions.iter().collect();
            Region::combine_within(&regions, &|inside| plan.machined(inside), effort)
        };
        let result = match merge {
            Merge::CentrePaths => combine(&compensated)?,
            Merge::ProgrammedContours => combine(&programmed)?.offset_within(-distance, effort)?,
        };
        let pairs = subcontours.iter().zip(&compensated);
        let indices = subcontours
            .iter()
            .map(|s| Index::new(s.contour.segments().iter().copied(), effort));
        let sources = Sources {
            starts: pairs
                .clone()
                .map(|(s, region)| compensated_start(s, region, distance))
                .collect(),
            contours: indices.collect::<Result<_, _>>()?,
            distance,
        };
        let mut areas: Vec<PocketArea> = Vec::new();
        for region in result.parts() {
            let mut outlines: Vec<Outline> = Vec::with_capacity(region.contours().len());
            for contour in region.contours() {
                outlines.push(sources.outline(contour, effort)?);
            }
            outlines.sort_by_key(|outline| outline.leader);
            areas.push(PocketArea { region, outlines });
        }
        areas.sort_by_key(|area| area.outlines.first().map(|outline| outline.leader));
        let narrow = pairs
            .enumerate()
            .filter(|(_, (s, region))| s.kind == Kind::Pocket && region.is_empty());
        Ok(Superposition {
            areas,
            too_narrow: narrow.map(|(index, _)| index).collect(),
        })
    }
}

/// What the start point rules ask of pairs of subcontours.
struct Relations {
    kinds: Vec<Kind>,
    /// Whether the row starts inside the column.
    starts_inside: Vec<Vec<bool>>,
    /// Whether two of one kind overlap.
    overlaps: Vec<Vec<bool>>,
}

impl Relations {
    fn new<E: Effort>(
        subcontours: &[SubContour],
        programmed: &[Region],
        effort: &E,
    ) -> Result<Relations, E::Stop> {
        let count = subcontours.len();
        let mut relations = Relations {
            kinds: subcontours.iter().map(|s| s.kind).collect(),
            starts_inside: vec![vec![false; count]; count],
            overlaps: vec![vec![false; count]; count],
        };
        for (b, region) in programmed.iter().enumerate() {
            let segments = region.contours().iter().flat_map(Contour::segments);
            let index = Index::new(segments.copied(), effort)?;
            let rows = relations.starts_inside.iter_mut();
            for (row, subcontour) in rows.zip(subcontours) {
                if let Some(inside) = row.get_mut(b) {
                    *inside = index.locate(subcontour.contour.start(), effort)? == Location::Inside;
                }
            }
            let rows = relations.overlaps.iter_mut().zip(subcontours).zip(programmed);
            for ((row, subcontour), other) in rows.skip(b + 1) {
                if let Some(overlaps) = row.get_mut(b)
                    && subcontours.get(b).is_some_and(|s| s.kind == subcontour.kind)
                {
                    *overlaps = overlap(region, other, effort)?;
                }
            }
        }
        Ok(relations)
    }

    fn is(&self, index: usize, kind: Kind) -> bool {
        self.kinds.get(index) == Some(&kind)
    }

    fn starts_inside(&self, a: usize, b: usize) -> bool {
        self.starts_inside.get(a).and_then(|row| row.get(b)) == Some(&true)
    }

    fn overlap(&self, a: usize, b: usize) -> bool {
        self.overlaps.get(a.max(b)).and_then(|row| row.get(a.min(b))) == Some(&true)
    }
}

/// How the subcontours combine, decided by the start point rules.
struct Plan {
    pockets: Vec<Group>,
    islands: Vec<Group>,
    /// For each subcontour the groups of pockets that reduce it.
    reduced_by: Vec<Vec<usize>>,
}

/// Overlapping subcontours of one kind: the leader and how each further one joins.
struct Group {
    leader: usize,
    joined: Vec<(usize, Join)>,
}

#[derive(Clone, Copy)]
enum Join {
    Unite,
    Intersect,
}

impl Group {
    fn members(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.leader).chain(self.joined.iter().map(|(member, _)| *member))
    }

    /// Whether a point that lies inside these subcontours lies inside the group.
    fn holds(&self, inside: &dyn Fn(usize) -> bool) -> bool {
        self.joined
            .iter()
            .fold(inside(self.leader), |held, (member, join)| match join {
                Join::Unite => held || inside(*member),
                Join::Intersect => held && inside(*member),
            })
    }
}

impl Plan {
    fn new(relations: &Relations) -> Plan {
        let indices = || 0..relations.kinds.len();
        let is = |i: usize, kind: Kind| relations.is(i, kind);
        let starts_inside = |a: usize, b: usize| relations.starts_inside(a, b);
        let overlap = |a: usize, b: usize| relations.overlap(a, b);
        let starts_in_island = |p: usize| indices().any(|i| is(i, Kind::Island) && starts_inside(p, i));
        let (reducing, ordinary) = indices()
            .filter(|i| is(*i, Kind::Pocket))
            .partition(|p| starts_in_island(*p));
        let islands = indices().filter(|i| is(*i, Kind::Island)).collect();

        let mut pockets = groups(reducing, &overlap, &starts_inside);
        let reducing_groups = pockets.len();
        pockets.extend(groups(ordinary, &overlap, &starts_inside));
        let reduces = |p: usize, i: usize| starts_inside(p, i) || !starts_inside(i, p);
        let reduced_by = indices()
            .map(|i| {
                let reducing = pockets.iter().take(reducing_groups).enumerate();
                reducing
                    .filter(|(_, group)| group.members().any(|p| reduces(p, i)))
                    .map(|(g, _)| g)
                    .collect()
            })
            .collect();
        Plan {
            islands: groups(islands, &overlap, &starts_inside),
            pockets,
            reduced_by,
        }
    }

    /// Whether a point that lies in these subcontours is machined.
    fn machined(&self, inside: &[bool]) -> bool {
        let inside = |i: usize| inside.get(i).copied().unwrap_or(false);
        let in_pocket = |group: usize| self.pockets.get(group).is_some_and(|group| group.holds(&inside));
        let in_reduced_island = |i: usize| {
            inside(i)
                && !self
                    .reduced_by
                    .get(i)
                    .is_some_and(|groups| groups.iter().any(|group| in_pocket(*group)))
        };
        (0..self.pockets.len()).any(in_pocket)
            && !self.islands.iter().any(|group| group.holds(&in_reduced_island))
    }
}

/// Groups of subcontours that overlap directly or through others, in the order of the list.
fn groups(
    list: Vec<usize>,
    overlap: &dyn Fn(usize, usize) -> bool,
    starts_inside: &dyn Fn(usize, usize) -> bool,
) -> Vec<Group> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for index in list {
        let (joining, mut apart): (Vec<_>, Vec<_>) = groups
            .into_iter()
            .partition(|group| group.iter().any(|member| overlap(*member, index)));
        let mut group: Vec<usize> = joining.into_iter().flatten().chain([index]).collect();
        group.sort_unstable();
        apart.push(group);
        groups = apart;
    }
    groups.sort();
    let lead = |group: Vec<usize>| {
        let (leader, members) = group.split_first()?;
        let join = |member: usize| {
            if overlap(*leader, member) && starts_inside(*leader, member) {
                Join::Intersect
            } else {
                Join::Unite
            }
        };
        Some(Group {
            leader: *leader,
            joined: members.iter().map(|m| (*m, join(*m))).collect(),
        })
    };
    groups.into_iter().filter_map(lead).collect()
}

/// Whether two areas share some area and neither contains the other.
fn overlap<E: Effort>(a: &Region, b: &Region, effort: &E) -> Result<bool, E::Stop> {
    let bounds = |region: &Region| region.bounding_box().map(|(min, max)| Bounds::between(min, max));
    if !matches!((bounds(a), bounds(b)), (Some(a), Some(b)) if a.touches(&b)) {
        return Ok(false);
    }
    let negligible = RESOLUTION_MM * (a.perimeter() + b.perimeter());
    let both = |inside: &[bool]| !inside.contains(&false);
    let shared = Region::combine_within(&[a, b], &both, effort)?.area();
    Ok(shared > negligible && shared < a.area().min(b.area()) - negligible)
}

/// Start point of the compensated subcontour: beside the start of the first element, or where the
/// compensated contour comes nearest to the start point, which is the intersection in an inside corner.
fn compensated_start(subcontour: &SubContour, compensated: &Region, distance: f64) -> Point2 {
    let contour = &subcontour.contour;
    let tool_left = (subcontour.kind == Kind::Pocket) == contour.is_counter_clockwise();
    let side = if tool_left { distance } else { -distance };
    let beside = along(contour.start(), left(contour.start_tangent()), side);
    if compensated.boundary_distance(beside) <= ON_OUTLINE_MM {
        return beside;
    }
    nearest(compensated.contours(), contour.start()).unwrap_or(contour.start())
}

fn nearest(contours: &[Contour], point: Point2) -> Option<Point2> {
    let points = contours.iter().map(|contour| contour.nearest(point));
    points.min_by(|a, b| distance(*a, point).total_cmp(&distance(*b, point)))
}

/// A point belongs to an outline when it is no farther from it than this, mm.
const ON_OUTLINE_MM: f64 = 1e-5;

/// The subcontours as an outline sees them.
struct Sources {
    /// Their compensated start points.
    starts: Vec<Point2>,
    contours: Vec<Index>,
    distance: f64,
}

impl Sources {
    /// The outline of a result contour, started at the start point of the first member that has its
    /// start point on it; if none has, nearest to the start point of the first member (inferred).
    fn outline<E: Effort>(&self, contour: &Contour, effort: &E) -> Result<Outline, E::Stop> {
        let mut members: Vec<usize> = Vec::new();
        for (index, source) in self.contours.iter().enumerate() {
            if self.follows(contour, source, effort)? {
                members.push(index);
            }
        }
        let start_of = |member: &usize| self.starts.get(*member).copied().unwrap_or(contour.start());
        let with_start = members
            .iter()
            .find(|member| contour.distance(start_of(member)) <= ON_OUTLINE_MM);
        let leader = with_start.or(members.first()).copied().unwrap_or(0);
        Ok(Outline {
            contour: contour.starting_near(start_of(&leader)),
            leader,
            members,
        })
    }

    /// Whether a contour keeps the distance to a subcontour along one of its segments.
    fn follows<E: Effort>(&self, contour: &Contour, source: &Index, effort: &E) -> Result<bool, E::Stop> {
        let on = |point: Point2| -> Result<bool, E::Stop> {
            let near = source.nearest(point, self.distance + 2.0 * ON_OUTLINE_MM, effort)?;
            Ok(near.is_some_and(|(gap, _)| (gap - self.distance).abs() <= ON_OUTLINE_MM))
        };
        for segment in contour.segments() {
            if on(segment.point(0.5))? && on(segment.point(0.3))? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}
