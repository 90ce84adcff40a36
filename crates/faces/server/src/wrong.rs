//! Wrong tokens: whoever guesses is slowed, by his address.

use std::collections::HashMap;
use std::net::IpAddr;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Wrong tokens in a row that are answered at once.
pub(crate) const AT_ONCE: u32 = 10;
/// From then on one is looked at in this time.
pub(crate) const ONE_IN: Duration = Duration::from_secs(5);
/// Addresses that are remembered; of more, those go that were wrong longest ago.
const ADDRESSES: usize = 1024;

/// Who was wrong, and when all of it is forgiven.
#[derive(Debug, Default)]
pub(crate) struct Wrong {
    forgiven: Mutex<HashMap<IpAddr, Instant>>,
}

impl Wrong {
    /// How long no token of an address is looked at.
    pub fn wait(&self, address: IpAddr, now: Instant) -> Option<Duration> {
        let forgiven = self.forgiven.lock().unwrap_or_else(PoisonError::into_inner);
        let left = forgiven.get(&address)?.checked_duration_since(now)?;
        left.checked_sub(ONE_IN * (AT_ONCE - 1))
            .filter(|wait| !wait.is_zero())
    }

    /// A token of an address was wrong.
    pub fn note(&self, address: IpAddr, now: Instant) {
        let mut forgiven = self.forgiven.lock().unwrap_or_else(PoisonError::into_inner);
        if forgiven.len() >= ADDRESSES && !forgiven.contains_key(&address) {
            forgiven.retain(|_, at| *at > now);
            if forgiven.len() >= ADDRESSES
                && let Some(first) = forgiven
                    .iter()
                    .min_by_key(|(_, at)| **at)
                    .map(|(address, _)| *address)
            {
                forgiven.remove(&first);
            }
        }
        let at = forgiven.entry(address).or_insert(now);
        *at = (*at).max(now) + ONE_IN;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_at_once_and_then_one_in_five_seconds() {
        let (wrong, now) = (Wrong::default(), Instant::now());
        let [one, other] = ["10.0.0.1", "10.0.0.2"].map(|text| text.parse::<IpAddr>().unwrap());
        for _ in 0..AT_ONCE {
            assert_eq!(wrong.wait(one, now), None);
            wrong.note(one, now);
        }
        // 10 * 5 s until all is forgiven, less the 9 * 5 s that may be open.
        assert_eq!(wrong.wait(one, now), Some(ONE_IN));
        assert_eq!(wrong.wait(other, now), None);
        assert_eq!(wrong.wait(one, now + ONE_IN), None);
        wrong.note(one, now + ONE_IN);
        assert_eq!(wrong.wait(one, now + ONE_IN), Some(ONE_IN));
        assert_eq!(wrong.wait(one, now + ONE_IN * 60), None);
    }

    #[test]
    fn no_more_addresses_are_remembered_than_a_limit() {
        let (wrong, now) = (Wrong::default(), Instant::now());
        let guesses = |number: u32| IpAddr::V4(number.into());
        for number in 0..100_000 {
            wrong.note(guesses(number), now + Duration::from_millis(u64::from(number)));
        }
        assert_eq!(wrong.forgiven.lock().unwrap().len(), ADDRESSES);
    }
}
