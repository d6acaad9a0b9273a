//! Ends of clients that were never told: a cable pulled, a machine that is off.

use std::io;
use std::net::TcpStream;

/// Has the system ask a silent client every two seconds from the sixth on whether it is there; without an answer for some six
/// seconds the connection is over.
#[cfg(target_os = "linux")]
pub(super) fn keep_alive(stream: &TcpStream) -> io::Result<()> {
    use rustix::net::sockopt;
    use std::time::Duration;

    sockopt::set_socket_keepalive(stream, true)?;
    sockopt::set_tcp_keepidle(stream, Duration::from_secs(6))?;
    sockopt::set_tcp_keepintvl(stream, Duration::from_secs(2))?;
    sockopt::set_tcp_keepcnt(stream, 3)?;
    // The same for replies that nobody acknowledges.
    sockopt::set_tcp_user_timeout(stream, 12_000)?;
    Ok(())
}

/// As the system has it.
#[cfg(not(target_os = "linux"))]
pub(super) fn keep_alive(stream: &TcpStream) -> io::Result<()> {
    rustix::net::sockopt::set_socket_keepalive(stream, true)?;
    Ok(())
}
