//! Whether a page is still there: it has to answer a ping every second, which a browser does by itself as long as it and its
//! network live. A computer that sleeps and a network that is gone close nothing.

use std::time::Duration;

use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket};
use tokio::time::{Instant, Interval, interval, timeout};

/// Between two pings.
const PING_EVERY: Duration = Duration::from_secs(1);
/// Without a sign of life for so long a page is gone.
const GONE_AFTER: Duration = Duration::from_millis(2500);
/// How long it may take to read a message.
const PATIENCE: Duration = Duration::from_secs(2);

/// Sends a message; whether it has been taken in time.
pub(super) async fn send(socket: &mut WebSocket, message: Message) -> bool {
    matches!(timeout(PATIENCE, socket.send(message)).await, Ok(Ok(())))
}

/// The signs of life of one WebSocket.
pub(super) struct Life {
    pings: Interval,
    heard: Instant,
}

impl Life {
    pub fn new() -> Self {
        Self {
            pings: interval(PING_EVERY),
            heard: Instant::now(),
        }
    }

    /// Something has come from it.
    pub fn heard(&mut self) {
        self.heard = Instant::now();
    }

    /// The next ping, when it is due; `None` when the page is gone.
    pub async fn ping(&mut self) -> Option<Message> {
        let due = self.pings.tick().await;
        if due.elapsed() > PING_EVERY {
            // This server was held up itself: what has come meanwhile is not read yet.
            self.heard();
        }
        (self.heard.elapsed() <= GONE_AFTER).then(|| Message::Ping(Bytes::new()))
    }
}
