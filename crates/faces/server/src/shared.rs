//! What all requests share.

use std::sync::{Arc, Mutex};

use bahn_service::Operated;
use tokio::sync::{Semaphore, watch};

use crate::about::About;
use crate::access::Access;
use crate::crew::Crew;
use crate::part::PartFeed;
use crate::pictures::Pictures;
use crate::regions::Regions;

/// What all requests share.
#[derive(Clone)]
pub(crate) struct Shared {
    /// For who may operate; each request has the role of who asks.
    pub machine: Arc<dyn Operated>,
    pub about: Arc<About>,
    pub regions: watch::Receiver<Arc<Regions>>,
    pub part: PartFeed,
    pub crew: Arc<Mutex<Crew>>,
    pub viewers: Arc<Semaphore>,
    /// Places of viewers who may only look.
    pub lookers: Arc<Semaphore>,
    pub pictures: Arc<Pictures>,
    pub access: Arc<Access>,
}
