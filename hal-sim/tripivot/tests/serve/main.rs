//! `tripivot serve`, in a thread of the test or as a program of its own, as its clients and others meet it.
//!
//! | file | idea |
//! |---|---|
//! | `served` | a server in a thread of the test, and clients that wait for their answers |
//! | `clients` | several clients at once, some of them badly behaved |
//! | `ports` | dead, flooding and half-open clients |
//! | `foreign` | whoever is no client of the command language |
//! | `files` | files that are written or read |
#![cfg(unix)]

mod clients;
mod files;
mod foreign;
mod ports;
mod served;
