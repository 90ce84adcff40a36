//! Something of each channel: of the first one, which is always there, and of those beside it.

/// One for each channel.
#[derive(Clone, Debug)]
pub struct PerChannel<T> {
    first: T,
    more: Vec<T>,
}

impl<T> PerChannel<T> {
    /// That of the first channel, and those of the others.
    pub fn new(first: T, more: Vec<T>) -> PerChannel<T> {
        PerChannel { first, more }
    }

    /// How many channels there are.
    pub fn count(&self) -> usize {
        1 + self.more.len()
    }

    /// That of one more channel.
    pub fn push(&mut self, more: T) {
        self.more.push(more);
    }

    /// That of the first channel.
    pub fn first(&self) -> &T {
        &self.first
    }

    /// That of the first channel, to be changed.
    pub fn first_mut(&mut self) -> &mut T {
        &mut self.first
    }

    /// That of the first channel, and those of the others.
    pub fn split_mut(&mut self) -> (&mut T, &mut [T]) {
        (&mut self.first, &mut self.more)
    }

    /// That of a channel; of the first one for a channel that does not exist.
    pub fn of(&self, channel: usize) -> &T {
        self.get(channel).unwrap_or(&self.first)
    }

    /// That of a channel, to be changed.
    pub fn of_mut(&mut self, channel: usize) -> &mut T {
        match channel.checked_sub(1).and_then(|place| self.more.get_mut(place)) {
            Some(other) => other,
            None => &mut self.first,
        }
    }

    /// That of a channel, if it exists.
    pub fn get(&self, channel: usize) -> Option<&T> {
        match channel.checked_sub(1) {
            None => Some(&self.first),
            Some(place) => self.more.get(place),
        }
    }

    /// That of each channel, the first one first.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.first).chain(&self.more)
    }

    /// That of each channel, to be changed.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut T> {
        std::iter::once(&mut self.first).chain(&mut self.more)
    }
}
