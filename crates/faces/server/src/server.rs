//! Listens and serves.

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::middleware;
use axum::routing::{any, get, post};
use bahn_service::{Operated, Tokens};
use tokio::net::{TcpListener, TcpSocket};
use tokio::runtime::Runtime;
use tokio::sync::{Semaphore, watch};

use crate::about::About;
use crate::access::Access;
use crate::part::PartFeed;
use crate::regions::Regions;
use crate::shared::Shared;
use crate::{api, assets, door, gate, socket};

/// Viewers at once, at most.
const VIEWERS: usize = 32;
/// Those of them who may only look: the other places are kept for who operates.
const LOOKERS: usize = 24;
/// What is in transit to a viewer who reads slowly, bytes: what is newer than that he gets at once when he has it, instead of
/// megabytes of what was.
const UNDERWAY: u32 = 256 << 10;
/// Connections that wait until they are taken.
const BACKLOG: u32 = 1024;
/// A viewer without news is sent nothing for so long at most.
const QUIET: Duration = Duration::from_secs(1);

/// Where to listen, and who may come in.
pub struct ServerOptions {
    /// The address; port 0 takes a free one.
    pub listen: SocketAddr,
    /// What others than this computer must know; one is needed for any address but loopback.
    pub tokens: Tokens,
}

impl ServerOptions {
    /// Whether the address may be listened on.
    ///
    /// # Errors
    /// [`ServerError::NoToken`], [`ServerError::OneToken`].
    pub fn check(&self) -> Result<(), ServerError> {
        if self.tokens.any() && self.tokens.operate == self.tokens.look {
            return Err(ServerError::OneToken);
        }
        match self.listen.ip().is_loopback() || self.tokens.any() {
            true => Ok(()),
            false => Err(ServerError::NoToken(self.listen)),
        }
    }
}

/// Why a server cannot begin.
#[derive(Debug, thiserror::Error)]
pub enum ServerError {
    /// Others can reach the address, and there is no token.
    #[error("{0} can be reached by others: it needs a token")]
    NoToken(SocketAddr),
    /// Who looks would operate.
    #[error("the token for looking is the one for operating")]
    OneToken,
    /// The address cannot be listened on.
    #[error("cannot listen on {0}: {1}")]
    Address(SocketAddr, std::io::Error),
    /// No thread can be started.
    #[error("cannot begin: {0}")]
    Runtime(std::io::Error),
}

/// A machine that is served.
pub struct Server {
    address: SocketAddr,
    runtime: Runtime,
}

impl Server {
    /// Serves a machine that runs.
    ///
    /// # Errors
    /// [`ServerError`].
    pub fn start(machine: impl Operated + 'static, options: ServerOptions) -> Result<Server, ServerError> {
        let machine: Arc<dyn Operated> = Arc::new(machine);
        options.check()?;
        let listen = options.listen;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()
            .map_err(ServerError::Runtime)?;
        let listener = runtime
            .block_on(async { listener(listen) })
            .map_err(|error| ServerError::Address(listen, error))?;
        let address = listener
            .local_addr()
            .map_err(|error| ServerError::Address(listen, error))?;
        let shared = Shared {
            regions: follow(Arc::clone(&machine)),
            part: PartFeed::start(Arc::clone(&machine)),
            about: Arc::new(About::of(machine.surface())),
            machine,
            crew: Arc::default(),
            viewers: Arc::new(Semaphore::new(VIEWERS)),
            lookers: Arc::new(Semaphore::new(LOOKERS)),
            pictures: Arc::default(),
            access: Arc::new(Access::new(address, options.tokens)),
        };
        let router = router(shared);
        // It ends with the runtime.
        runtime.spawn(door::serve(listener, router));
        Ok(Server { address, runtime })
    }

    /// The address at which it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Ends; the machine goes on.
    pub fn end(self) {
        self.runtime.shutdown_timeout(QUIET);
    }
}

fn listener(listen: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = match listen {
        SocketAddr::V4(_) => TcpSocket::new_v4()?,
        SocketAddr::V6(_) => TcpSocket::new_v6()?,
    };
    // An address that was listened on a moment ago is free; elsewhere that would mean another thing.
    #[cfg(unix)]
    socket.set_reuseaddr(true)?;
    // Connections inherit it.
    socket.set_send_buffer_size(UNDERWAY)?;
    socket.bind(listen)?;
    socket.listen(BACKLOG)
}

fn router(shared: Shared) -> Router {
    Router::new()
        .route("/", get(assets::page))
        .route("/web/{name}", get(assets::module))
        .route("/web/viewer/{name}", get(assets::viewer))
        .route("/api/station", get(api::station))
        .route("/api/texts", get(api::texts))
        .route("/api/screen", get(api::screen))
        .route("/api/snapshot", get(api::snapshot))
        .route("/api/graphics.png", get(api::graphics))
        .route("/api/drawer", get(api::drawer))
        .route("/api/lessons", get(api::lessons))
        .route("/api/key", post(api::input))
        .route("/api/command", post(api::input))
        .route("/ws", any(socket::open))
        .layer(middleware::from_fn_with_state(shared.clone(), gate::guard))
        .with_state(shared)
}

/// Encodes every screen once, on a thread of its own.
fn follow(machine: Arc<dyn Operated>) -> watch::Receiver<Arc<Regions>> {
    let (sender, receiver) = watch::channel(Arc::new(Regions::default()));
    std::thread::spawn(move || {
        let mut regions = Regions::default();
        while !sender.is_closed() {
            let screen = machine.next_screen(regions.serial(), QUIET);
            if screen.serial > regions.serial() {
                regions = regions.next(&screen);
                sender.send_replace(Arc::new(regions.clone()));
            }
        }
    });
    receiver
}
