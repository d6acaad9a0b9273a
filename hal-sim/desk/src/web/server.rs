//! What is served: the page's files, the token, and the WebSocket.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};

use axum::Router;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::ws::{WebSocket, WebSocketUpgrade};
use axum::extract::{Path, Request, State};
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use tokio::runtime;
use tokio::sync::{Semaphore, oneshot};

use super::bridge::Bridge;
use super::guard::Guard;
use super::operator::calibration::Instruments;
use super::operator::runs::Person;
use super::operator::{self, Operator};
use super::password::Password;
use super::request::MESSAGE_BYTES;
use super::shared::Shared;
use super::{PageError, http, lesson, login, viewer};
use crate::assets;
use crate::line::Endpoint;
use drawing::assets::Asset;

/// What browsers are to enforce: nothing from elsewhere, and no page of somebody else's around this one.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What a handler of a WebSocket gets.
type Upgrade = Result<WebSocketUpgrade, WebSocketUpgradeRejection>;

/// WebSockets at once; a page has two.
const SOCKETS: usize = 128;

/// To pages of others.
const ONLY_OWN: &str = "only the page of this server may connect\n";
/// To one page too many.
const TOO_MANY: &str = "there are as many pages of this stage as it serves at once\n";

/// A page that is served until it is dropped.
pub struct Page {
    address: SocketAddr,
    no_controller: Arc<OnceLock<String>>,
    /// Dropped, it ends the server.
    stop: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// Where a page is, and who may see it.
#[derive(Clone)]
pub struct PageOptions {
    /// Address and port to listen at, as text; port 0 takes a free one.
    pub address: String,
    /// What a browser is asked for before it sees anything.
    pub password: Option<String>,
    /// Where browsers find it, if a proxy stands in front of it: scheme, host and port.
    pub public_url: Option<String>,
    /// Whoever does with a simulated machine what commissioning asks a person for.
    pub person: Option<Person>,
    /// What reads instruments; where nothing does, whoever looks at a page is asked.
    pub instruments: Option<Instruments>,
}

impl PageOptions {
    /// For this machine alone.
    #[must_use]
    pub fn local(address: &str) -> Self {
        Self {
            address: address.to_owned(),
            password: None,
            public_url: None,
            person: None,
            instruments: None,
        }
    }
}

impl Page {
    /// Serves the page for the controller at `endpoint`, which need not be there yet.
    ///
    /// # Errors
    /// [`PageError`].
    pub fn start(options: &PageOptions, endpoint: Endpoint) -> Result<Self, PageError> {
        let listener = TcpListener::bind(&options.address).map_err(|error| PageError::Listen {
            address: options.address.clone(),
            error,
        })?;
        Self::serve(listener, options, endpoint).map_err(PageError::Start)
    }

    fn serve(listener: TcpListener, options: &PageOptions, endpoint: Endpoint) -> io::Result<Self> {
        let place = listener.local_addr()?;
        listener.set_nonblocking(true)?;
        let runtime = runtime::Builder::new_current_thread()
            .enable_all()
            .build()?;
        let bridge = Bridge::start(endpoint)?;
        let no_controller = bridge.no_controller();
        let shared = Shared {
            guard: Arc::new(Guard::new(&options.address, options.public_url.as_deref())?),
            password: (options.password.clone().map(Password::new).transpose()?).map(Arc::new),
            operator: {
                let _within = runtime.enter();
                let (person, instruments) = (options.person.clone(), options.instruments.clone());
                Operator::start(bridge.clone(), person, instruments)?
            },
            bridge,
            sockets: Arc::new(Semaphore::new(SOCKETS)),
        };
        let (stop, stopped) = oneshot::channel::<()>();
        let thread = thread::Builder::new().name("http".into()).spawn(move || {
            runtime.block_on(async move {
                let Ok(listener) = tokio::net::TcpListener::from_std(listener) else {
                    return;
                };
                tokio::select! {
                    () = http::serve(listener, router(shared)) => {}
                    _ = stopped => {}
                }
            });
        })?;
        Ok(Self {
            address: place,
            no_controller,
            stop: Some(stop),
            thread: Some(thread),
        })
    }

    /// Why what is at the other end cannot be a controller, once that is known and none was there before.
    #[must_use]
    pub fn no_controller(&self) -> Option<&str> {
        self.no_controller.get().map(String::as_str)
    }

    /// Where it is.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // A panic there has been printed.
            let _ = thread.join();
        }
    }
}

fn router(shared: Shared) -> Router {
    let mut router = Router::new()
        .route("/token", get(token))
        .route("/live", get(live))
        .route(login::PATH, get(login::form).post(login::enter))
        .route("/operator", get(operate))
        .route("/commissioning/{file}", get(commissioning_file))
        .route("/calibration/{file}", get(calibration_file))
        .route("/lesson.json", get(lesson_frames))
        .route("/tasks.json", get(task_frames));
    for asset in assets::all() {
        router = router.route(asset.path, get(async || file(asset)));
    }
    router
        .fallback(async || (StatusCode::NOT_FOUND, "there is no such page\n"))
        .layer(middleware::from_fn_with_state(shared.clone(), login::check))
        .layer(middleware::from_fn_with_state(shared.clone(), check))
        .with_state(shared)
}

/// Turns away what names another host, and tells browsers what the page may do.
async fn check(State(shared): State<Shared>, request: Request, next: Next) -> Response {
    if !shared.guard.allows_host(request.headers()) {
        let reason = "this page is served to its own address only, not to another name\n";
        return (StatusCode::MISDIRECTED_REQUEST, reason).into_response();
    }
    let mut response = next.run(request).await;
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::X_FRAME_OPTIONS, "DENY"),
        // With none at all, browsers say that a form comes from nowhere, and the password would be refused.
        (header::REFERRER_POLICY, "same-origin"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        let headers = response.headers_mut();
        headers
            .entry(name)
            .or_insert(HeaderValue::from_static(value));
    }
    response
}

fn file(asset: &Asset) -> Response {
    ([(header::CONTENT_TYPE, asset.kind)], asset.text).into_response()
}

/// The token: pages of other origins can ask for it, but browsers do not let them read the answer.
async fn token(State(shared): State<Shared>) -> Response {
    shared.guard.token().to_owned().into_response()
}

async fn task_frames() -> Response {
    (
        [(header::CONTENT_TYPE, "application/json")],
        lesson::tasks_json(),
    )
        .into_response()
}

async fn lesson_frames() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], lesson::json()).into_response()
}

/// Plots, tables and reports of a commissioning.
async fn commissioning_file(State(shared): State<Shared>, Path(name): Path<String>) -> Response {
    shared.operator.commissioning.files().answer(&name)
}

/// What was measured for a calibration, its file and its report.
async fn calibration_file(State(shared): State<Shared>, Path(name): Path<String>) -> Response {
    shared.operator.calibration.files().answer(&name)
}

async fn live(State(shared): State<Shared>, headers: HeaderMap, upgrade: Upgrade) -> Response {
    upgraded(
        &shared.clone(),
        &headers,
        upgrade,
        MESSAGE_BYTES,
        |socket| viewer::serve(socket, shared.bridge, shared.guard, shared.operator),
    )
}

/// Sequences and the log.
async fn operate(State(shared): State<Shared>, headers: HeaderMap, upgrade: Upgrade) -> Response {
    upgraded(
        &shared.clone(),
        &headers,
        upgrade,
        operator::MESSAGE_BYTES,
        |socket| operator::serve(socket, shared.operator, shared.guard),
    )
}

/// A WebSocket for a page of this server, served so.
fn upgraded<F: Future<Output = ()> + Send + 'static>(
    shared: &Shared,
    headers: &HeaderMap,
    upgrade: Upgrade,
    message_bytes: usize,
    serve: impl FnOnce(WebSocket) -> F + Send + 'static,
) -> Response {
    if !shared.guard.allows_origin(headers) {
        return (StatusCode::FORBIDDEN, ONLY_OWN).into_response();
    }
    let Ok(place) = Arc::clone(&shared.sockets).try_acquire_owned() else {
        return (StatusCode::SERVICE_UNAVAILABLE, TOO_MANY).into_response();
    };
    let serve = async move |socket| {
        serve(socket).await;
        drop(place);
    };
    match upgrade {
        Ok(upgrade) => upgrade.max_message_size(message_bytes).on_upgrade(serve),
        Err(rejection) => rejection.into_response(),
    }
}
