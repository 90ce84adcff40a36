//! Who has a place: connections in bounds, whoever they belong to.
//!
//! Whoever comes gets in. When all places are taken, or all that one address may have, somebody goes for him: those who have
//! never said a word before those who look, these before those who operate, those who wait before those who are being
//! answered, and of alike ones whoever is silent longest. So connections that are opened and left open push each other
//! out, and nobody who operates.
//!
//! Decision: A connection that comes to the panel always gets a place: who has never asked goes first, then who
//! looks, who operates last, of alike ones the longest silent

use std::collections::HashMap;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use bahn_service::Role;
use tokio::sync::Notify;

/// Connections at most that are no web sockets.
pub(crate) const PLACES: usize = 256;
/// Those of one address.
pub(crate) const PLACES_OF_AN_ADDRESS: usize = 64;

/// The connections that may be open at once.
#[derive(Default)]
pub(crate) struct Places {
    guests: Mutex<Guests>,
}

#[derive(Default)]
struct Guests {
    /// Counts what guests do.
    count: u64,
    there: HashMap<u64, Guest>,
}

struct Guest {
    address: IpAddr,
    /// What he may do, as soon as he has asked for something that he may have.
    role: Option<Role>,
    is_answered: bool,
    /// When he was last heard.
    heard: u64,
    leaves: Arc<Notify>,
}

/// A place that is taken, until it is dropped.
pub(crate) struct Place {
    places: Arc<Places>,
    number: u64,
    address: IpAddr,
    leaves: Arc<Notify>,
}

impl Places {
    /// A place for somebody who comes; somebody else may have to go.
    pub fn take(self: &Arc<Places>, address: IpAddr) -> Place {
        let address = network(address);
        let mut guests = self.lock();
        let of_address = guests.there.values().filter(|guest| guest.address == address);
        match of_address.count() {
            PLACES_OF_AN_ADDRESS.. => guests.send_away(|guest| guest.address == address),
            _ if guests.there.len() >= PLACES => guests.send_away(|_| true),
            _ => {}
        }
        guests.count += 1;
        let number = guests.count;
        let leaves = Arc::new(Notify::new());
        let guest = Guest {
            address,
            role: None,
            is_answered: false,
            heard: number,
            leaves: Arc::clone(&leaves),
        };
        guests.there.insert(number, guest);
        Place {
            places: Arc::clone(self),
            number,
            address,
            leaves,
        }
    }

    fn lock(&self) -> MutexGuard<'_, Guests> {
        self.guests.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Guests {
    fn send_away(&mut self, of: impl Fn(&Guest) -> bool) {
        let there = self.there.iter().filter(|(_, guest)| of(guest));
        let least = there.min_by_key(|(_, guest)| (guest.is_answered, guest.role, guest.heard));
        if let Some(number) = least.map(|(number, _)| *number)
            && let Some(guest) = self.there.remove(&number)
        {
            guest.leaves.notify_one();
        }
    }
}

impl Place {
    /// Where he comes from.
    pub fn address(&self) -> IpAddr {
        self.address
    }

    /// He may do that, and is being answered.
    pub fn begin(&self, role: Role) {
        self.heard(|guest| {
            guest.role = Some(role);
            guest.is_answered = true;
        });
    }

    /// The answer was sent: the place is free again.
    pub fn end(&self) {
        self.heard(|guest| guest.is_answered = false);
    }

    fn heard(&self, what: impl FnOnce(&mut Guest)) {
        let mut guests = self.places.lock();
        guests.count += 1;
        let now = guests.count;
        if let Some(guest) = guests.there.get_mut(&self.number) {
            guest.heard = now;
            what(guest);
        }
    }

    /// Waits until he has to go.
    pub async fn lost(&self) {
        self.leaves.notified().await;
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.places.lock().there.remove(&self.number);
    }
}

/// What counts as one address: of IPv6 the network that is given to one customer, 64 bits.
pub(crate) fn network(address: IpAddr) -> IpAddr {
    match address.to_canonical() {
        IpAddr::V6(address) => IpAddr::V6(Ipv6Addr::from_bits(address.to_bits() & (u128::MAX << 64))),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(last: usize) -> IpAddr {
        format!("192.168.{}.{}", last / 200, last % 200 + 1)
            .parse()
            .unwrap()
    }

    fn is_there(place: &Place) -> bool {
        place.places.lock().there.contains_key(&place.number)
    }

    #[test]
    fn who_is_silent_longest_goes_for_who_comes() {
        let places = Arc::new(Places::default());
        let one: Vec<_> = (0..=PLACES_OF_AN_ADDRESS)
            .map(|_| places.take(address(0)))
            .collect();
        assert!(
            !is_there(&one[0]) && one[1..].iter().all(is_there),
            "of one address"
        );
        let others: Vec<_> = (1..=PLACES).map(|last| places.take(address(last))).collect();
        assert_eq!(places.lock().there.len(), PLACES);
        assert!(
            !one.iter().any(is_there) && others.iter().all(is_there),
            "the oldest of all"
        );
        drop(others);
        assert_eq!(places.lock().there.len(), 0);
    }

    #[test]
    fn who_operates_goes_last() {
        let places = Arc::new(Places::default());
        let operates = places.take(address(0));
        operates.begin(Role::Operate);
        operates.end();
        let looks = places.take(address(0));
        looks.begin(Role::Look);
        looks.end();
        let silent: Vec<_> = (0..1000).map(|_| places.take(address(0))).collect();
        assert!(is_there(&operates) && is_there(&looks));
        assert_eq!(
            silent.iter().filter(|place| is_there(place)).count(),
            PLACES_OF_AN_ADDRESS - 2
        );
        let many: Vec<_> = (0..1000)
            .map(|_| {
                let place = places.take(address(0));
                place.begin(Role::Look);
                place.end();
                place
            })
            .collect();
        assert!(
            is_there(&operates) && !is_there(&looks),
            "those who look push each other out"
        );
        drop((silent, many));
    }

    #[test]
    fn an_address_of_ipv6_is_its_network() {
        let parsed = |text: &str| text.parse::<IpAddr>().unwrap();
        assert_eq!(network(parsed("2001:db8:1:2:3:4:5:6")), parsed("2001:db8:1:2::"));
        assert_eq!(network(parsed("::ffff:10.0.0.7")), parsed("10.0.0.7"));
    }
}
