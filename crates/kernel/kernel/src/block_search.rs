//! Block search: what stands before the block with which a run begins is passed over without a movement, and what it leaves in
//! force stays.
//!
//! How a block is passed over, a family says by its [`PassOver`]: one hands its functions on, another only lists them.

/// What a family passes over.
pub trait PassOver {
    /// Why a block cannot be passed over.
    type Fault;

    /// Passes over the next block, unless it is the one that is looked for.
    ///
    /// # Errors
    /// When the block is refused.
    fn pass(&mut self) -> Result<Passed, Self::Fault>;

    /// A program is over: begins the next one that is searched. Whether there is one.
    ///
    /// # Errors
    /// When it cannot begin.
    fn begin_next(&mut self) -> Result<bool, Self::Fault>;
}

/// What came of a step of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// A block was passed over.
    Block,
    /// The block that is looked for comes next.
    Found,
    /// Something has to be waited for first.
    Waits,
    /// The program is over.
    End,
}

/// What a search has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// The block that is looked for comes next.
    Found,
    /// It goes on later.
    Open,
    /// No program has the block.
    Missing,
}

/// Passes over blocks up to the one that is looked for, so many steps at most.
///
/// # Errors
/// When a block is refused.
pub fn search<P: PassOver>(over: &mut P, most: usize) -> Result<Search, P::Fault> {
    for _ in 0..most {
        match over.pass()? {
            Passed::Block => {}
            Passed::Found => return Ok(Search::Found),
            Passed::Waits => return Ok(Search::Open),
            Passed::End if over.begin_next()? => {}
            Passed::End => return Ok(Search::Missing),
        }
    }
    Ok(Search::Open)
}

/// What stays in force of all that was passed over, the last of each kind, in the order in which it came.
#[derive(Clone, Debug)]
pub struct Latest<T>(Vec<T>);

impl<T> Default for Latest<T> {
    fn default() -> Latest<T> {
        Latest(Vec::new())
    }
}

impl<T> Latest<T> {
    /// One comes, and replaces those of its kind.
    pub fn put(&mut self, one: T, replaces: impl Fn(&T) -> bool) {
        self.end(replaces);
        self.0.push(one);
    }

    /// These are over.
    pub fn end(&mut self, is_over: impl Fn(&T) -> bool) {
        self.0.retain(|one| !is_over(one));
    }

    /// All of them.
    pub fn into_vec(self) -> Vec<T> {
        self.0
    }
}
