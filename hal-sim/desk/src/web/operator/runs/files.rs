//! Plots, tables and reports, for browsers to fetch: nothing of them is on the disk.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

/// A report has its style in it, and its plots; it runs nothing and asks for nothing.
const POLICY: HeaderValue =
    HeaderValue::from_static("default-src 'none'; style-src 'unsafe-inline'; sandbox");

/// See the module.
#[derive(Clone)]
pub(in crate::web) struct Files {
    /// Where they are, with a slash at both ends.
    folder: &'static str,
    kept: Arc<Mutex<Kept>>,
}

#[derive(Default)]
struct Kept {
    texts: BTreeMap<String, Arc<str>>,
    /// Plots so far.
    plots: u64,
}

impl Files {
    /// None so far.
    pub fn new(folder: &'static str) -> Self {
        Self {
            folder,
            kept: Arc::default(),
        }
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Under a name; one that had it is replaced. Where it is.
    pub fn put(&self, name: &str, text: &str) -> String {
        self.kept().texts.insert(name.to_owned(), text.into());
        format!("{}{name}", self.folder)
    }

    /// A plot, under a name of its own, so that no browser shows an earlier one for it; where it is.
    pub fn put_plot(&self, svg: &str) -> String {
        let mut kept = self.kept();
        kept.plots += 1;
        let name = format!("plot-{}.svg", kept.plots);
        kept.texts.insert(name.clone(), svg.into());
        format!("{}{name}", self.folder)
    }

    /// Forgets all plots but these, which pages show.
    pub fn keep_plots(&self, shown: &[String]) {
        let mut kept = self.kept();
        kept.texts.retain(|name, _| {
            !name.ends_with(".svg")
                || shown
                    .iter()
                    .any(|path| path.strip_prefix(self.folder) == Some(name))
        });
    }

    /// Names of the tables.
    pub fn tables(&self) -> Vec<String> {
        let kept = self.kept();
        let names = kept.texts.keys().filter(|name| name.ends_with(".csv"));
        names.map(|name| format!("{}{name}", self.folder)).collect()
    }

    /// What a browser gets.
    pub fn answer(&self, name: &str) -> Response {
        let kept = self.kept();
        let Some(text) = kept.texts.get(name).cloned() else {
            return (StatusCode::NOT_FOUND, "there is no such file\n").into_response();
        };
        let kind = match name.rsplit('.').next() {
            Some("svg") => "image/svg+xml",
            Some("html") => "text/html; charset=utf-8",
            Some("csv") => "text/csv; charset=utf-8",
            _ => "text/plain; charset=utf-8",
        };
        let kind = HeaderValue::from_static(kind);
        let headers = [
            (header::CONTENT_TYPE, kind),
            (header::CONTENT_SECURITY_POLICY, POLICY),
        ];
        (headers, text.to_string()).into_response()
    }
}
