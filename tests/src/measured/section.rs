//! What a section of the page is.

/// A section: a command, and what its figures are.
#[derive(Debug)]
pub struct Section {
    /// What it is called on the command line.
    pub name: &'static str,
    /// Its heading, which is unique.
    pub title: &'static str,
    /// The chapter it stands in.
    pub group: Group,
    /// What is measured and under which conditions. One paragraph of Markdown.
    pub about: &'static str,
    /// A line for bash in the project's folder.
    pub command: &'static str,
    /// A shorter run of the same, where the whole one takes minutes.
    pub short: Option<&'static str>,
    /// What the figures depend on.
    pub kind: Kind,
    /// How long it takes on two cores, s, without what has to be built.
    pub seconds: u32,
    /// Lines of the output that hold one of these are left out: host times among deterministic figures, folders, progress.
    pub without: &'static [&'static str],
}

impl Section {
    /// The command of this run.
    #[must_use]
    pub fn command(&self, short: bool) -> &'static str {
        match self.short {
            Some(shorter) if short => shorter,
            _ => self.command,
        }
    }

    /// Whether figures that this command gave belong here.
    #[must_use]
    pub fn is_measured_by(&self, command: &str) -> bool {
        command == self.command || self.short == Some(command)
    }
}

/// What the figures depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing: every run gives them again.
    Deterministic,
    /// The compiler: they are counted in an image, or on the emulator.
    Compiled,
    /// The host, and what else it does.
    HostTime,
}

impl Kind {
    /// For the page.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::Deterministic => "deterministic",
            Self::Compiled => "deterministic for one compiler",
            Self::HostTime => "host time",
        }
    }
}

/// A chapter of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// The simulated stage on a tour of the disk.
    Demonstration,
    /// Moves, planned and carried out.
    Motion,
    /// Faults, lost encoders, power cuts.
    Faults,
    /// Machines that nobody knows, brought up.
    Commissioning,
    /// Numbers against better ones.
    Exactness,
    /// The image on the emulated chip. Needs it built.
    Chip,
    /// What the host takes.
    Host,
}

impl Group {
    /// In the page's order.
    pub const ALL: [Self; 7] = [
        Self::Demonstration,
        Self::Motion,
        Self::Faults,
        Self::Commissioning,
        Self::Exactness,
        Self::Chip,
        Self::Host,
    ];

    /// The chapter's heading.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Demonstration => "Demonstration",
            Self::Motion => "Motion",
            Self::Faults => "What happens when something breaks",
            Self::Commissioning => "Commissioning",
            Self::Exactness => "Exactness",
            Self::Chip => "On the emulated chip",
            Self::Host => "On a desktop",
        }
    }

    /// What is the same for all its sections. One paragraph of Markdown.
    #[must_use]
    pub fn about(self) -> Option<&'static str> {
        match self {
            Self::Demonstration => Some(
                "The script [demonstration.gcs](scripts/demonstration.gcs) at the reference stage's limits \
                 ([PARAMETERS.md](../firmware/PARAMETERS.md)), all imperfections of [PLANT.md](PLANT.md) on but encoder \
                 eccentricity. A move has settled when every pivot stays within +-2 encoder LSB of its setpoint. Pictures: \
                 [the run](pictures/demonstration.png), [its setpoints beside their limits](pictures/motion.png).",
            ),
            Self::Chip => Some(
                "All of these need the image: `source .ci/target-toolchain; cargo stage; cargo cost-image`. Costs are instructions \
                 counted on the emulator, not cycles: it models no wait states of the flash and no exception entry.",
            ),
            Self::Host => Some("These count on a machine that does nothing else."),
            Self::Motion | Self::Faults | Self::Commissioning | Self::Exactness => None,
        }
    }
}

/// What a section's command gave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measured {
    /// The command that ran.
    pub command: String,
    /// When, at which commit, on what, how long.
    pub conditions: String,
    /// The lines of figures.
    pub figures: String,
}
