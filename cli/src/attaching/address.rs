//! Addresses of viewers, as people give them.

use std::net::{IpAddr, SocketAddr, ToSocketAddrs};

/// The port of an address that names none.
const USUAL_PORT: u16 = 7117;

/// Where the page of a program is.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct ViewerAddress {
    /// The host as its pages are reached: `localhost`, or an address of numbers.
    host: String,
    port: u16,
    /// The secret part; empty for a page without.
    token: String,
}

impl ViewerAddress {
    /// Reads `text`; a `token` beside it is its secret part. A name of a machine is looked up, since viewers answer to no name but
    /// `localhost`: others may lead here from anywhere.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn read(text: &str, token: Option<&str>) -> Result<ViewerAddress, String> {
        if text.starts_with("https://") {
            return Err("viewers speak plain HTTP: begin it with `http://`".to_owned());
        }
        let rest = text.strip_prefix("http://").unwrap_or(text);
        let end = rest.find(['/', '?', '#']).unwrap_or(rest.len());
        let (place, path) = rest.split_at(end);
        let in_path = path.trim_start_matches('/').split(['/', '?', '#']).next().unwrap_or_default();
        let token = match (token, in_path) {
            (Some(token), "") => token,
            (Some(token), other) if token != other => {
                return Err("it has another secret part than `--token`".to_owned());
            }
            (_, in_path) => in_path,
        };
        if !token.chars().all(|letter| letter.is_ascii_alphanumeric()) {
            return Err("its secret part has letters and digits alone".to_owned());
        }
        let (host, port) = split(place)?;
        Ok(ViewerAddress { host: reached(&host, port)?, port, token: token.to_owned() })
    }

    /// The address of the page.
    pub(super) fn url(&self) -> String {
        let slash = if self.token.is_empty() { "" } else { "/" };
        format!("http://{}:{}/{}{slash}", self.host, self.port, self.token)
    }
}

/// Host and port.
fn split(place: &str) -> Result<(String, u16), String> {
    if let Ok(address) = place.parse::<SocketAddr>() {
        return Ok((address.ip().to_string(), address.port()));
    }
    if let Ok(address) = place.trim_matches(['[', ']']).parse::<IpAddr>() {
        return Ok((address.to_string(), USUAL_PORT));
    }
    let (host, port) = match place.split_once(':') {
        Some((host, port)) => (host, port.parse().map_err(|_| "its port is no number from 0 to 65535".to_owned())?),
        None => (place, USUAL_PORT),
    };
    let is_name = |letter: char| letter.is_ascii_alphanumeric() || "-._".contains(letter);
    if host.is_empty() || !host.chars().all(is_name) {
        return Err("it names no machine".to_owned());
    }
    Ok((host.to_owned(), port))
}

/// The host that a viewer answers to.
fn reached(host: &str, port: u16) -> Result<String, String> {
    let shown = |address: IpAddr| match address {
        IpAddr::V4(address) => address.to_string(),
        IpAddr::V6(address) => format!("[{address}]"),
    };
    if host.eq_ignore_ascii_case("localhost") {
        return Ok("localhost".to_owned());
    }
    if let Ok(address) = host.parse() {
        return Ok(shown(address));
    }
    let found = (host, port).to_socket_addrs().ok().and_then(|mut all| all.next());
    found.map(|address| shown(address.ip())).ok_or_else(|| "no machine of that name is known".to_owned())
}

#[cfg(test)]
mod tests {
    use super::ViewerAddress;

    #[test]
    fn lv_1_addresses_are_read_as_people_give_them() {
        let url = |text: &str, token: Option<&str>| ViewerAddress::read(text, token).map(|address| address.url());
        for (text, token, wanted) in [
            ("http://127.0.0.1:7117/0af3/", None, "http://127.0.0.1:7117/0af3/"),
            ("http://localhost:9000/0af3/#view=graph", None, "http://localhost:9000/0af3/"),
            ("127.0.0.1:7117", Some("0af3"), "http://127.0.0.1:7117/0af3/"),
            ("127.0.0.1", Some("0af3"), "http://127.0.0.1:7117/0af3/"),
            ("http://[::1]:80/0af3/", Some("0af3"), "http://[::1]:80/0af3/"),
            ("::1", Some("0af3"), "http://[::1]:7117/0af3/"),
            ("localhost", None, "http://localhost:7117/"),
        ] {
            assert_eq!(url(text, token).as_deref(), Ok(wanted), "{text}");
        }
        for (text, token) in [
            ("https://127.0.0.1/0af3/", None),
            ("http://127.0.0.1:7117/0af3/", Some("1b")),
            ("127.0.0.1:70000", None),
            ("http://user@127.0.0.1:7117/0af3/", None),
            ("http://127.0.0.1:7117/..%2F/", None),
            ("http://127.0.0.1:7117/\r\nHost:evil/", None),
            ("a name with spaces:1", None),
            ("", None),
        ] {
            assert!(url(text, token).is_err(), "{text}");
        }
    }
}
