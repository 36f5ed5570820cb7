//! Why the program ends without having finished: one sentence and an exit code.

use hairspring_io::{Error as FileError, FrameError, ManifestError};
use hairspring_scene::stage::StageError;
use hairspring_view::{OutputError, gpu::GpuError};
use std::{fmt, path::Path};

/// Exit code of an internal error of the program (EX_SOFTWARE of sysexits.h).
pub const PANICKED: u8 = 70;

/// An error, described in one sentence.
#[derive(Debug)]
pub enum Fault {
    /// The command line has an invalid argument.
    Usage(String),
    /// A file does not exist or cannot be read.
    Unreadable(String),
    /// A file's content is wrong.
    Content(String),
    /// A file, or standard output, could not be written.
    Unwritable(String),
    /// The scene cannot be simulated.
    Scene(String),
    /// The machine lacks something that the command needs: a desktop, a GPU.
    Lacking(String),
    /// The simulation does not agree with a closed-form solution.
    Invalid(String),
    /// The user stopped the run.
    Interrupted(String),
}

impl Fault {
    /// The exit code, as `--help` documents it.
    pub fn code(&self) -> u8 {
        match self {
            Self::Invalid(_) => 1,
            Self::Usage(_) => 2,
            Self::Unreadable(_) => 3,
            Self::Content(_) => 4,
            Self::Unwritable(_) => 5,
            Self::Scene(_) => 6,
            Self::Lacking(_) => 7,
            Self::Interrupted(_) => crate::interrupt::CODE,
        }
    }

    /// Converts an error of reading `input`, a file named on the command line. An unknown kind of file is an
    /// error of the command line if it is `input` itself, and an error of the content if a scene names it.
    pub fn reading(error: FileError, input: &Path) -> Self {
        let sentence = error.to_string();
        match &error {
            FileError::NotFound { .. } | FileError::Unreadable { .. } => Self::Unreadable(sentence),
            FileError::Unsupported { path, .. } if path == input => Self::Usage(sentence),
            _ => Self::Content(sentence),
        }
    }

    /// Converts an error of writing a file.
    pub fn writing(error: FileError) -> Self {
        match error {
            FileError::Unsupported { .. } => Self::Usage(error.to_string()),
            _ => Self::Unwritable(error.to_string()),
        }
    }

    /// Converts an error of writing a groom. Strands that its format cannot hold are content of the input.
    pub fn writing_groom(error: FileError) -> Self {
        match error {
            FileError::Unwritable { .. } => Self::Content(error.to_string()),
            _ => Self::writing(error),
        }
    }
}

impl From<OutputError> for Fault {
    fn from(error: OutputError) -> Self {
        Self::Unwritable(error.to_string())
    }
}

impl From<GpuError> for Fault {
    fn from(error: GpuError) -> Self {
        Self::Lacking(error.to_string())
    }
}

impl From<FrameError> for Fault {
    fn from(error: FrameError) -> Self {
        match error {
            FrameError::NotFinite { .. } => Self::Scene(error.to_string()),
            FrameError::File(error) => Self::writing_groom(error),
        }
    }
}

impl From<ManifestError> for Fault {
    fn from(error: ManifestError) -> Self {
        let sentence = error.to_string();
        match error {
            ManifestError::Differs(_) => Self::Usage(sentence),
            ManifestError::Unreadable(_) => Self::Unreadable(sentence),
            ManifestError::Invalid(_) => Self::Content(sentence),
            ManifestError::Unwritable(_) => Self::Unwritable(sentence),
        }
    }
}

impl From<StageError> for Fault {
    fn from(error: StageError) -> Self {
        Self::Scene(error.to_string())
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Usage(s)
        | Self::Unreadable(s)
        | Self::Content(s)
        | Self::Unwritable(s)
        | Self::Scene(s)
        | Self::Lacking(s)
        | Self::Invalid(s)
        | Self::Interrupted(s)) = self;
        f.write_str(s)
    }
}

/// Reports a panic as an internal error, in one line that says how to report it.
pub fn report_panics() {
    std::panic::set_hook(Box::new(|panic| {
        let what = panic.payload_as_str().unwrap_or("no reason given").replace('\n', " ");
        let place = panic.location().map_or(String::new(), |l| format!(" at {}:{}", l.file(), l.line()));
        let sentence = format!(
            "internal error in hairspring {}{place} ({what}); please report this line with the command and the file \
             that caused it",
            env!("CARGO_PKG_VERSION")
        );
        crate::console::print_error(&sentence);
    }));
}
