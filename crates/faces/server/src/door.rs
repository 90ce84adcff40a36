//! Connections: each has a place, and time to say what it wants.

use std::convert::Infallible;
use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::response::Response;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::Service;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};
use tower_service::Service as _;

use crate::places::{Place, Places};

/// Within this time the head of a request is there; so long a connection is kept open without one.
pub(crate) const HEAD: Duration = Duration::from_secs(5);
/// Largest head of a request, bytes.
const HEAD_BYTES: usize = 16 << 10;
/// Lines of a head at most.
const HEAD_LINES: usize = 64;
/// When no connection can be taken, because the system has no more, it is tried again after this time.
const AGAIN: Duration = Duration::from_millis(50);

/// Takes connections for ever.
pub(crate) async fn serve(listener: TcpListener, router: Router) {
    let places = Arc::new(Places::default());
    loop {
        match listener.accept().await {
            Ok((stream, peer)) => {
                let place = Arc::new(places.take(peer.ip()));
                tokio::spawn(follow(stream, place, router.clone()));
            }
            Err(_) => tokio::time::sleep(AGAIN).await,
        }
    }
}

/// Answers one connection until it ends, or its place is needed.
async fn follow(stream: TcpStream, place: Arc<Place>, router: Router) {
    // A screen that is sent after the number of its key would wait until the viewer has acknowledged that, 40 ms.
    let _ = stream.set_nodelay(true);
    let visit = Visit {
        place: Arc::clone(&place),
        router,
    };
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD)
        .max_buf_size(HEAD_BYTES)
        .max_headers(HEAD_LINES)
        .serve_connection(TokioIo::new(stream), visit)
        .with_upgrades();
    tokio::select! {
        // Whatever broke it, it is gone.
        _ = connection => {}
        () = place.lost() => {}
    }
}

/// The requests of one connection.
struct Visit {
    place: Arc<Place>,
    router: Router,
}

impl Service<hyper::Request<Incoming>> for Visit {
    type Response = Response;
    type Error = Infallible;
    type Future = Pin<Box<dyn Future<Output = Result<Response, Infallible>> + Send>>;

    fn call(&self, request: hyper::Request<Incoming>) -> Self::Future {
        let mut request = request.map(Body::new);
        request.extensions_mut().insert(Arc::clone(&self.place));
        Box::pin(self.router.clone().call(request))
    }
}
