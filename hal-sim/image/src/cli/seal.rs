//! `cargo seal`: gives the image its checksum.

use std::fs;
use std::process::ExitCode;

use super::error::CliError;
use crate::chip::elf_file;
use crate::seal::seal;

pub(super) fn run() -> Result<ExitCode, CliError> {
    let path = elf_file::find();
    let path = path.ok_or_else(|| CliError::Value("no image: `cargo stage` builds it".into()))?;
    let wrong = |what: String| CliError::Value(format!("{}: {what}", path.display()));
    let image = fs::read(&path).map_err(|error| wrong(error.to_string()))?;
    let sealed = seal(image).map_err(wrong)?;
    fs::write(&path, sealed).map_err(|error| wrong(error.to_string()))?;
    println!("{} has its checksum", path.display());
    Ok(ExitCode::SUCCESS)
}
