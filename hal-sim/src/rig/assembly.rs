//! The one assembly of a controller on a simulated machine: command side, settings, queues, tick, and starting again.

use embedded_io::Write;
use firmware::blackbox::BlackBox;
use firmware::controller::Outputs;
use firmware::link::{Link, PanelLink, TickLink};
use firmware::panel::{Panel, Session};
use firmware::parameters::Parameters;
use firmware::recorder::Record;
use firmware::store::Keeper;

use super::run::started;
use crate::front::Host;
use crate::machine::devices::{SettingsFlash, StageParameters};

/// The queues between tick and command side, and what outlives a restart of both. A rig borrows it.
pub struct Queues {
    link: Box<Link>,
    black_box: Box<BlackBox>,
}

/// See the module.
pub struct Rig<'a> {
    /// The machine and the controller's loop.
    pub host: Host,
    /// The command side.
    pub panel: Panel,
    /// Keeps its settings.
    pub keeper: Keeper<SettingsFlash>,
    /// The tick's ends of the queues.
    pub tick_link: TickLink<'a>,
    /// The command side's ends of the queues.
    pub panel_link: PanelLink<'a>,
    parameters: Parameters,
}

impl Default for Queues {
    fn default() -> Self {
        Self::new()
    }
}

impl Queues {
    /// Empty.
    #[must_use]
    pub fn new() -> Self {
        Self {
            link: Box::new(Link::new()),
            black_box: Box::new(BlackBox::new()),
        }
    }
}

impl<'a> Rig<'a> {
    /// A stage whose controller starts with the settings of this flash, and with these parameters where it keeps none.
    #[must_use]
    pub fn new(
        queues: &'a mut Queues,
        stage: &StageParameters,
        parameters: &Parameters,
        flash: SettingsFlash,
    ) -> Self {
        let (tick_link, panel_link) = queues.link.split_keeping(&queues.black_box);
        let mut keeper = Keeper::new(flash);
        let (panel, fault) = started(parameters, &mut keeper);
        let mut host = Host::new(stage, panel.parameters());
        host.restart(panel.parameters(), fault);
        Self {
            host,
            panel,
            keeper,
            tick_link,
            panel_link,
            parameters: parameters.clone(),
        }
    }

    /// One tick of the controller, and the machine's motion up to the next.
    pub fn tick(&mut self, recorder: &mut impl Record) -> Outputs {
        self.host.tick(&mut self.tick_link, recorder)
    }

    /// Has the command side carry out what a connection has received.
    ///
    /// # Errors
    /// Those of `replies`.
    pub fn service<W: Write>(
        &mut self,
        session: &mut Session,
        replies: &mut W,
    ) -> Result<(), W::Error> {
        self.panel.service(session, &mut self.panel_link, replies)
    }

    /// Goes on keeping settings, a step at a time.
    pub fn keep(&mut self) {
        self.keeper.carry_on(&mut self.panel);
    }

    /// Starts the controller again if it was told to (`RBT`); whether it was. The connections' sessions are the caller's to
    /// start again.
    pub fn restart_if_wanted(&mut self) -> bool {
        if !self.panel.wants_restart() {
            return false;
        }
        let (panel, fault) = started(&self.parameters, &mut self.keeper);
        self.panel = panel;
        self.host.restart(self.panel.parameters(), fault);
        self.tick_link.clear();
        self.panel_link.clear();
        true
    }
}
