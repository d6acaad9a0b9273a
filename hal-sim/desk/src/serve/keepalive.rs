//! Ends of clients that were never told: a cable pulled, a machine that is off.

use std::io;
use std::net::TcpStream;

/// Has the system ask a silent client every two seconds from the sixth on whether it is there; without an answer for some six
/// seconds the connection is over.
///
/// # Errors
/// Those of the system.
#[cfg(target_os = "linux")]
pub fn keep_alive(stream: &TcpStream) -> io::Result<()> {
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
///
/// # Errors
/// Those of the system.
#[cfg(not(target_os = "linux"))]
pub fn keep_alive(stream: &TcpStream) -> io::Result<()> {
    rustix::net::sockopt::set_socket_keepalive(stream, true)?;
    Ok(())
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use rustix::net::sockopt;
    use std::net::TcpListener;
    use std::time::Duration;

    /// Pulling a cable takes another machine; that the system was told is seen here.
    #[test]
    fn a_silent_client_is_asked_after_six_seconds_and_given_up_after_twelve() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let stream = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        keep_alive(&stream).unwrap();
        assert!(sockopt::socket_keepalive(&stream).unwrap());
        let idle = sockopt::tcp_keepidle(&stream).unwrap();
        let every = sockopt::tcp_keepintvl(&stream).unwrap();
        let times = sockopt::tcp_keepcnt(&stream).unwrap();
        assert_eq!(idle + every * times, Duration::from_secs(12));
        assert_eq!(sockopt::tcp_user_timeout(&stream).unwrap(), 12_000);
    }
}
