//! What the handlers of the server share.

use std::sync::Arc;

use tokio::sync::Semaphore;

use super::bridge::Bridge;
use super::guard::Guard;
use super::operator::Operator;
use super::password::Password;

/// What handlers share.
#[derive(Clone)]
pub(super) struct Shared {
    pub bridge: Bridge,
    pub guard: Arc<Guard>,
    pub password: Option<Arc<Password>>,
    pub operator: Operator,
    /// Places for WebSockets: each may have a thread and a connection to the controller.
    pub sockets: Arc<Semaphore>,
}
