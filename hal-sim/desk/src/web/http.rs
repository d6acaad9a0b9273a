//! Connections of browsers: so many at once, and none that holds its place with a request that never comes.

use std::convert::Infallible;
use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::http::Request;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::Semaphore;
use tokio::time::{sleep, timeout};
use tower::ServiceExt;

/// Connections at once, those of viewers (WebSockets) not counted: more wait to be accepted.
const CONNECTIONS: usize = 64;
/// How long a request's head, or the next request, may take to come.
const HEAD_PATIENCE: Duration = Duration::from_secs(5);
/// How long a connection may last before it has become a viewer's: nothing that is served is large.
const LONGEST: Duration = Duration::from_secs(60);
/// How long none is accepted after one could not be.
const ACCEPT_PAUSE: Duration = Duration::from_millis(500);

/// Where a request comes from.
#[derive(Clone, Copy)]
pub(super) struct Peer(pub IpAddr);

/// Serves until it is dropped.
pub(super) async fn serve(listener: TcpListener, router: Router) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    loop {
        // The semaphore is never closed.
        let Ok(place) = Arc::clone(&places).acquire_owned().await else {
            return;
        };
        let Ok((stream, from)) = listener.accept().await else {
            sleep(ACCEPT_PAUSE).await;
            continue;
        };
        let router = router.clone();
        tokio::spawn(async move {
            // What becomes of it is the browser's affair.
            let _ = timeout(LONGEST, connection(stream, Peer(from.ip()), router)).await;
            drop(place);
        });
    }
}

/// Serves a connection until its end, or until it is a viewer's, which goes on by itself.
async fn connection(stream: TcpStream, peer: Peer, router: Router) -> Result<(), hyper::Error> {
    // An answer does not wait until the status before it has been acknowledged; where the system cannot do that, it does.
    let _ = stream.set_nodelay(true);
    let answer = service_fn(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(peer);
        let router = router.clone();
        async move { Ok::<_, Infallible>(answer(router, request).await) }
    });
    http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(HEAD_PATIENCE)
        .serve_connection(TokioIo::new(stream), answer)
        .with_upgrades()
        .await
}

async fn answer(router: Router, request: Request<Incoming>) -> axum::response::Response {
    match router.oneshot(request.map(Body::new)).await {
        Ok(response) => response,
        Err(never) => match never {},
    }
}
