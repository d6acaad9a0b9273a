//! What queries about parameters answer.

use super::address::{Address, Addresses};
use super::descriptor::Parameter;
use super::table::PARAMETERS;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::output::{Output, WriteFailed};
use crate::gcs::reply_writer::{ReplyWriter, one_line};

impl Interpreter {
    /// Answers `SPA?`.
    pub(in crate::gcs) fn reply_parameters(
        &self,
        addresses: &Addresses,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        for &Address { item, id } in addresses.iter().flatten() {
            if let Some(parameter) = Parameter::find(id) {
                let value = parameter.value(item, &self.parameters);
                reply.line(format_args!("{item} 0x{id:X}={value}"))?;
            }
        }
        if addresses[0].is_none() {
            for parameter in PARAMETERS {
                for item in parameter.items() {
                    let (id, value) = (parameter.id, parameter.value(item, &self.parameters));
                    reply.line(format_args!("{item} 0x{id:X}={value}"))?;
                }
            }
        }
        reply.end()
    }
}

/// Why nothing drives, and the way out.
const NOT_COMMISSIONED: &str = "not commissioned, nothing drives: set zeros and directions of the encoders and the rest (SPA), then CMS 1 and WPA 100";

impl Interpreter {
    /// Answers `CMS?`.
    pub(in crate::gcs) fn reply_commissioned(
        &self,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        match self.not_commissioned() {
            None => one_line(out, format_args!("1 commissioned")),
            Some(reason) => one_line(out, format_args!("0 {reason}")),
        }
    }

    /// Why nothing drives, if the machine is not commissioned.
    pub(in crate::gcs) fn not_commissioned(&self) -> Option<&'static str> {
        (!self.parameters.commissioned).then_some(NOT_COMMISSIONED)
    }
}

/// Answers `HPA?`.
pub(in crate::gcs) fn parameter_help(out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    reply.line(format_args!("The following parameters are there:"))?;
    for parameter in PARAMETERS {
        reply.line(format_args!("{parameter}"))?;
    }
    reply.line(format_args!("end of help"))?;
    reply.end()
}
