//! The server of the page: for pages of its own alone. Where it has a token, all addresses begin with it.
//!
//! | address | answer |
//! |---|---|
//! | `GET /` | the page |
//! | `GET /state/N` | the state, as soon as its number is another one than N; 204 if that takes long |
//! | `GET /state/SERVER/N` | the same; at once, if N is a number of another server |
//! | `GET /picture/…` | a picture of the last good frame |
//! | `GET /frame.html` | the last good frame as a page of one file; with `?sources=no` without texts of files; 404 before the first |
//! | `GET /about` | what answers here, as JSON: see [`About`] |
//! | `POST /choose` | takes a [`Choice`] as JSON; 503 while too many wait |
//! | `POST /look` | takes a [`LookChange`] as JSON |
//! | `POST /pictures` | takes [`AskedPictures`] as JSON, and answers with the pictures |

use super::about::About;
use super::connections;
use super::controls::Choice;
use super::look::{Look, LookChange};
use super::published_state::PublishedState;
use super::questions::{AskedPictures, MOST_PICTURES, Question};
use super::saved_frame;
use crate::page;
use axum::Router;
use axum::body::Bytes;
use axum::extract::{DefaultBodyLimit, Path, Request, State};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, HOST, HeaderName, HeaderValue, ORIGIN,
    REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{Method, StatusCode, Uri};
use axum::middleware::{Next, from_fn_with_state};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use std::io;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::time::{Duration, Instant};
use tokio::sync::watch::{self, Receiver, Sender};
use tokio::time::timeout;

/// A question for the state is answered after this time at the latest.
const LONGEST_WAIT: Duration = Duration::from_secs(25);
/// This many questions for pictures may wait.
const MOST_QUESTIONS: usize = 16;
/// A choice, or a question for pictures, has at most this many bytes.
const LARGEST_CHOICE: usize = 64 << 10;
/// What is sent arrives within this time, or is refused.
const LONGEST_SENDING: Duration = Duration::from_secs(10);
/// At most this many choices wait for the program.
const MOST_CHOICES: usize = 256;

/// Nobody looks any more when nobody asked for this long: browsers ask again at once.
const GONE_AFTER: Duration = Duration::from_secs(40);

/// What answers are made of.
#[derive(Clone)]
struct ServerState {
    address: SocketAddr,
    token: Option<Arc<str>>,
    /// When somebody asked last.
    asked: Arc<Mutex<Option<Instant>>>,
    watched: Arc<AtomicBool>,
    /// Whether pictures of outputs were fetched since the server was asked for that.
    fetched: Arc<AtomicBool>,
    page: Bytes,
    shown: Receiver<PublishedState>,
    choices: mpsc::SyncSender<Choice>,
    questions: mpsc::SyncSender<Question>,
    look: Arc<Mutex<Look>>,
}

/// A server of the live page, on a thread of its own, as long as this lives.
#[derive(Debug)]
pub struct Server {
    address: SocketAddr,
    token: Option<Arc<str>>,
    publish: Sender<PublishedState>,
    choices: mpsc::Receiver<Choice>,
    questions: mpsc::Receiver<Question>,
    look: Arc<Mutex<Look>>,
    watched: Arc<AtomicBool>,
    fetched: Arc<AtomicBool>,
}

impl Server {
    /// A server at this address. For port 0 it takes a port that is free. A server with a `token` answers whoever knows it, through a
    /// tunnel too. One without answers browsers of this machine alone.
    ///
    /// # Errors
    /// If the address can't be had.
    pub fn start(address: SocketAddr, token: Option<&str>) -> io::Result<Server> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let (publish, shown) = watch::channel(PublishedState::default());
        let (send, choices) = mpsc::sync_channel(MOST_CHOICES);
        let (ask, questions) = mpsc::sync_channel(MOST_QUESTIONS);
        let look = Arc::<Mutex<Look>>::default();
        let page = page::live_page(About::FORMAT_VERSION)?.into();
        let (token, watched) = (token.map(Arc::from), Arc::new(AtomicBool::new(false)));
        let fetched = Arc::<AtomicBool>::default();
        let shared = ServerState {
            address,
            token: token.clone(),
            asked: Arc::default(),
            watched: Arc::clone(&watched),
            fetched: Arc::clone(&fetched),
            page,
            shown,
            choices: send,
            questions: ask,
            look: Arc::clone(&look),
        };
        let listener = {
            let _entered = runtime.enter();
            tokio::net::TcpListener::from_std(listener)?
        };
        std::thread::Builder::new().name("framewright viewer".to_owned()).spawn(move || {
            runtime.block_on(async {
                let mut shown = shared.shown.clone();
                tokio::spawn(forget_who_left(shared.clone()));
                tokio::spawn(connections::answer(listener, routes(shared)));
                // It ends with whom publishes; what is on its way ends with it.
                while shown.changed().await.is_ok() {}
            });
        })?;
        Ok(Server { address, token, publish, choices, questions, look, watched, fetched })
    }

    /// Where the page is, as a browser takes it.
    #[must_use]
    pub fn url(&self) -> String {
        let token = self.token.iter().map(|token| format!("{token}/")).collect::<String>();
        format!("http://{}/{token}", self.address)
    }

    /// Where it listens.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Whether a page was open a moment ago.
    #[must_use]
    pub fn is_watched(&self) -> bool {
        self.watched.load(Ordering::Relaxed)
    }

    /// Shows `state` to all browsers, in place of the one before.
    pub fn publish(&self, state: PublishedState) {
        self.publish.send_replace(state);
    }

    /// What people chose in the page, in the order in which they did.
    #[must_use]
    pub fn choices(&self) -> &mpsc::Receiver<Choice> {
        &self.choices
    }

    /// Questions for pictures, in the order in which they were asked.
    #[must_use]
    pub fn questions(&self) -> &mpsc::Receiver<Question> {
        &self.questions
    }

    /// Whether somebody fetched a picture of an output since the last call.
    pub(crate) fn take_fetched(&self) -> bool {
        self.fetched.swap(false, Ordering::Relaxed)
    }

    /// What people look at.
    pub(crate) fn look(&self) -> Look {
        *self.look.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The state that all browsers have.
    pub(crate) fn published(&self) -> PublishedState {
        self.publish.borrow().clone()
    }
}

impl ServerState {
    /// Notes that somebody looks.
    fn is_asked(&self) {
        *self.asked.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        self.watched.store(true, Ordering::Relaxed);
    }
}

fn routes(shared: ServerState) -> Router {
    let prefix = shared.token.iter().map(|token| format!("/{token}")).collect::<String>();
    let at = |path: &str| format!("{prefix}{path}");
    Router::new()
        .route(&at("/"), get(whole_page))
        .route(&at("/state/{after}"), get(|shared, Path(after): Path<u64>| state(shared, None, after)))
        .route(
            &at("/state/{server}/{after}"),
            get(|shared, Path((server, after)): Path<(String, u64)>| state(shared, Some(server), after)),
        )
        .route(&at("/picture/{*name}"), get(picture))
        .route(&at("/frame.html"), get(frame))
        .route(&at("/about"), get(about))
        .route(&at("/compare/{a}/{b}"), get(compare))
        .route(&at("/choose"), post(choose))
        .route(&at("/look"), post(look))
        .route(&at("/pictures"), post(pictures))
        // Browsers ask for an icon, and complain where there is no answer.
        .route("/favicon.ico", get(StatusCode::NO_CONTENT))
        .layer(DefaultBodyLimit::max(LARGEST_CHOICE))
        .layer(from_fn_with_state(shared.clone(), own_pages_alone))
        .with_state(shared)
}

/// Notices, every second, that nobody asks any more.
async fn forget_who_left(shared: ServerState) {
    loop {
        tokio::time::sleep(Duration::from_secs(1)).await;
        let asked = *shared.asked.lock().unwrap_or_else(PoisonError::into_inner);
        if asked.is_some_and(|asked| asked.elapsed() > GONE_AFTER) {
            shared.watched.store(false, Ordering::Relaxed);
        }
    }
}

/// Refuses requests of other sites' pages, by whatever name they reach this address; and forbids browsers to keep or frame answers.
async fn own_pages_alone(State(shared): State<ServerState>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
    let host = text(HOST).filter(|host| is_own(&shared, host));
    let origin =
        text(ORIGIN).is_none_or(|origin| origin.strip_prefix("http://").is_some_and(|from| Some(from) == host));
    let is_sent = request.method() == Method::POST;
    let form = !is_sent || text(CONTENT_TYPE) == Some("application/json");
    let mut answer = match host.is_some() && origin && form {
        true if is_sent => match timeout(LONGEST_SENDING, next.run(request)).await {
            Ok(answer) => answer,
            Err(_) => StatusCode::REQUEST_TIMEOUT.into_response(),
        },
        true => next.run(request).await,
        false => (StatusCode::FORBIDDEN, "only pages of this server are answered").into_response(),
    };
    let same_origin = HeaderName::from_static("cross-origin-resource-policy");
    for (name, value) in [
        (CACHE_CONTROL, "no-store"),
        (CONTENT_SECURITY_POLICY, "frame-ancestors 'none'"),
        (REFERRER_POLICY, "no-referrer"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (same_origin, "same-origin"),
    ] {
        answer.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    answer
}

/// Whether a request's host is one that pages of this server have. A name of somebody else's may lead to this address, and an address of
/// numbers is nobody's: with a token it may be the end of a tunnel.
fn is_own(shared: &ServerState, host: &str) -> bool {
    let port = shared.address.port();
    // Browsers leave out the port that HTTP has anyway.
    let end = if port == 80 { String::new() } else { format!(":{port}") };
    if shared.token.is_none() {
        return ["127.0.0.1", "localhost"].iter().any(|name| *host == format!("{name}{end}"));
    }
    let name = host.rsplit_once(':').filter(|(_, port)| port.parse::<u16>().is_ok()).map_or(host, |(name, _)| name);
    name == "localhost" || name.trim_matches(['[', ']']).parse::<IpAddr>().is_ok()
}

async fn whole_page(State(shared): State<ServerState>) -> impl IntoResponse {
    ([(CONTENT_TYPE, "text/html; charset=utf-8")], shared.page)
}

async fn state(State(mut shared): State<ServerState>, server: Option<String>, after: u64) -> Response {
    shared.is_asked();
    // A browser that outlived a server at the same address knows numbers of that one.
    let newer = shared.shown.wait_for(|shown| {
        let is_own = server.as_ref().is_none_or(|server| **server == *shown.server);
        shown.version != if is_own { after } else { 0 }
    });
    match timeout(LONGEST_WAIT, newer).await {
        Ok(Ok(shown)) => ([(CONTENT_TYPE, "application/json")], shown.json.to_string()).into_response(),
        Ok(Err(_)) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
        Err(_) => StatusCode::NO_CONTENT.into_response(),
    }
}

async fn picture(State(shared): State<ServerState>, Path(name): Path<String>) -> Response {
    let picture = shared.shown.borrow().pictures.get(&name).cloned();
    shared.fetched.store(true, Ordering::Relaxed);
    match picture {
        Some(png) => ([(CONTENT_TYPE, "image/png")], Bytes::from_owner(png)).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

/// The last good frame as a file.
async fn frame(State(shared): State<ServerState>, uri: Uri) -> Response {
    let shown = shared.shown.borrow().clone();
    let with_sources = uri.query() != Some("sources=no");
    // It takes a moment: meanwhile others are answered.
    let page = tokio::task::spawn_blocking(move || saved_frame::saved_page(&shown, with_sources, None)).await;
    match page {
        Ok(Ok(Some(page))) => {
            let headers = [
                (CONTENT_TYPE, "text/html; charset=utf-8"),
                (CONTENT_DISPOSITION, "attachment; filename=\"frame.html\""),
            ];
            (headers, page).into_response()
        }
        Ok(Ok(None)) => (StatusCode::NOT_FOUND, "there is no frame yet").into_response(),
        Ok(Err(_)) | Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

async fn about() -> Response {
    match serde_json::to_string(&About::own()) {
        Ok(about) => ([(CONTENT_TYPE, "application/json")], about).into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

async fn look(State(shared): State<ServerState>, body: Bytes) -> Response {
    match serde_json::from_slice::<LookChange>(&body) {
        Ok(change) => {
            shared.look.lock().unwrap_or_else(PoisonError::into_inner).take(change);
            StatusCode::NO_CONTENT.into_response()
        }
        Err(problem) => (StatusCode::BAD_REQUEST, format!("no look: {problem}")).into_response(),
    }
}

async fn compare(State(shared): State<ServerState>, Path((a, b)): Path<(u64, u64)>) -> Response {
    let history = Arc::clone(&shared.shown.borrow().history);
    match history.compared(a, b) {
        Ok(Some(data)) => ([(CONTENT_TYPE, "application/json")], data).into_response(),
        Ok(None) => (StatusCode::NOT_FOUND, "one of the states is forgotten").into_response(),
        Err(_) => StatusCode::INTERNAL_SERVER_ERROR.into_response(),
    }
}

async fn choose(State(shared): State<ServerState>, body: Bytes) -> Response {
    match serde_json::from_slice(&body) {
        Ok(choice) => match shared.choices.try_send(choice) {
            Ok(()) => StatusCode::NO_CONTENT.into_response(),
            Err(mpsc::TrySendError::Full(_)) => {
                (StatusCode::SERVICE_UNAVAILABLE, "the program takes no choices: it ends no frame").into_response()
            }
            Err(mpsc::TrySendError::Disconnected(_)) => StatusCode::SERVICE_UNAVAILABLE.into_response(),
        },
        Err(problem) => (StatusCode::BAD_REQUEST, format!("no choice: {problem}")).into_response(),
    }
}

async fn pictures(State(shared): State<ServerState>, body: Bytes) -> Response {
    let asked: AskedPictures = match serde_json::from_slice(&body) {
        Ok(asked) => asked,
        Err(problem) => return (StatusCode::BAD_REQUEST, format!("no question: {problem}")).into_response(),
    };
    if asked.pictures.len() > MOST_PICTURES {
        let words = format!("a question asks for at most {MOST_PICTURES} pictures");
        return (StatusCode::BAD_REQUEST, words).into_response();
    }
    shared.is_asked();
    let (question, answered) = Question::new(asked);
    if shared.questions.try_send(question).is_err() {
        return (StatusCode::SERVICE_UNAVAILABLE, "too many pictures are asked for at once").into_response();
    }
    match timeout(LONGEST_WAIT, answered).await {
        Ok(Ok(answer)) => ([(CONTENT_TYPE, "application/json")], answer).into_response(),
        Ok(Err(_)) => (StatusCode::SERVICE_UNAVAILABLE, "nothing is drawn any more").into_response(),
        Err(_) => (StatusCode::GATEWAY_TIMEOUT, "no frame ended in the meantime").into_response(),
    }
}
