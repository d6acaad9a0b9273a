//! Whose variable a name means.

use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;
use crate::gcs::text::{Name, Text};

impl Interpreter {
    /// The value of a variable: the running macro's, the connection's, or one of all macros.
    pub(in crate::gcs) fn variable<'a>(
        &'a self,
        name: &Name,
        session: &'a Session,
    ) -> Option<&'a Text> {
        match name.digit() {
            Some(digit) => self.macros.locals(session)?.get(digit)?.as_ref(),
            None => (session.variables.get(name)).or_else(|| self.variables.get(name)),
        }
    }

    /// Its value as a number.
    pub(in crate::gcs) fn variable_number(
        &self,
        name: &Name,
        session: &Session,
    ) -> Result<f64, ErrorCode> {
        let text = self.variable(name, session);
        let text = text.ok_or(ErrorCode::UnknownVariable)?;
        let number = text.as_str().parse::<f64>().ok();
        number
            .filter(|number| number.is_finite())
            .ok_or(ErrorCode::InvalidNumber)
    }

    /// Sets one, or forgets it: where it is, and a new one where the line comes from.
    pub(super) fn set_variable(
        &mut self,
        name: &Name,
        value: Option<Text>,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if let Some(digit) = name.digit() {
            let locals = self.macros.locals_mut(session);
            let local = locals.and_then(|locals| locals.get_mut(digit));
            *local.ok_or(ErrorCode::UnknownVariable)? = value;
            return Ok(());
        }
        let is_own = session.variables.get(name).is_some();
        let is_of_macros = !is_own && self.variables.get(name).is_some();
        if !session.is_macro && !is_of_macros {
            return session.variables.set(name, value);
        }
        // A macro that moves the stage may depend on it.
        if self.ownership.excludes(session.number) {
            return Err(ErrorCode::OwnedByAnother);
        }
        self.variables.set(name, value)
    }
}
