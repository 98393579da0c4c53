//! The connections to a server: so many at once, and none that only waits. So nobody uses up the files that a program may have open.

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;
use tokio::time::sleep;

/// At most this many at once. A browser has six.
const MOST: usize = 64;
/// The head of a request arrives within this time, and the next one begins within it; or the connection ends.
const LONGEST_HEAD: Duration = Duration::from_secs(10);
/// The bytes that the head of a request may have.
const LARGEST_HEAD: usize = 16 << 10;
/// Where the system has no connection to give, it is asked again after this time.
const AGAIN_AFTER: Duration = Duration::from_millis(100);

/// Answers all that come, for ever.
pub(super) async fn answer(listener: TcpListener, router: Router) {
    let room = Arc::new(Semaphore::new(MOST));
    while let Ok(place) = Arc::clone(&room).acquire_owned().await {
        let Ok((stream, _)) = listener.accept().await else {
            sleep(AGAIN_AFTER).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        tokio::spawn(async move {
            let mut builder = http1::Builder::new();
            builder.timer(TokioTimer::new()).header_read_timeout(LONGEST_HEAD).max_buf_size(LARGEST_HEAD);
            drop(builder.serve_connection(TokioIo::new(stream), service).await);
            drop(place);
        });
    }
}
