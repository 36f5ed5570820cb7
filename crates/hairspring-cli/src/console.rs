//! What the user is told: results on standard output, everything else on standard error.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    fmt::Display,
    io::{IsTerminal, Write, stderr, stdout},
};

/// How much is said.
#[derive(Clone, Copy)]
pub struct Console {
    quiet: bool,
    verbose: bool,
}

/// A line of the result. A reader that has gone away (`| head`) is no error.
pub fn say(line: impl Display) {
    let _ = writeln!(stdout(), "{line}");
}

/// A line about what went wrong.
pub fn complain(line: &impl Display) {
    let _ = writeln!(stderr(), "error: {line}");
}

impl Console {
    /// `quiet`: only results and errors; `verbose`: also what each frame took.
    pub fn new(quiet: bool, verbose: bool) -> Self {
        Self { quiet, verbose }
    }

    /// Something that the user should know.
    pub fn note(self, line: impl Display) {
        if !self.quiet {
            let _ = writeln!(stderr(), "note: {line}");
        }
    }

    /// A note for each thing, if there is any.
    pub fn note_all(self, things: impl IntoIterator<Item = impl Display>) {
        things.into_iter().for_each(|thing| self.note(thing));
    }

    /// What is being done, where it takes a moment.
    pub fn doing(self, line: impl Display) {
        if !self.quiet {
            let _ = writeln!(stderr(), "{line}");
        }
    }

    /// Shows the progress of `total` frames of `what`: a bar on a terminal, a line every tenth elsewhere.
    pub fn progress(self, what: &'static str, total: u32) -> Progress {
        self.progress_in(what, total, "frames")
    }

    /// The same in units other than frames.
    pub fn progress_in(self, what: &'static str, total: u32, unit: &'static str) -> Progress {
        let bar = (!self.quiet && stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(total.into()), ProgressDrawTarget::stderr());
            // The template has no part of the user's: it parses, or the plain bar is shown.
            let template =
                format!("{{msg}} [{{bar:32}}] {{pos}}/{{len}} {unit}, {{elapsed}} gone, {{eta}} to go");
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(what);
            bar
        });
        Progress { bar, console: self, what, unit, total, done: 0 }
    }
}

/// Progress of a long run.
pub struct Progress {
    bar: Option<ProgressBar>,
    console: Console,
    what: &'static str,
    unit: &'static str,
    total: u32,
    done: u32,
}

impl Progress {
    /// One step is done; `detail` is said where the user asked for it.
    pub fn step(&mut self, detail: impl FnOnce() -> String) {
        self.done += 1;
        match &self.bar {
            Some(bar) => bar.inc(1),
            None => {
                let tenth = |n: u32| u64::from(n) * 10 / u64::from(self.total.max(1));
                if !self.console.verbose && tenth(self.done) > tenth(self.done - 1) {
                    self.console
                        .doing(format_args!("{} {}/{} {}", self.what, self.done, self.total, self.unit));
                }
            }
        }
        if self.console.verbose {
            let line = detail();
            match &self.bar {
                Some(bar) => bar.suspend(|| self.console.doing(line)),
                None => self.console.doing(line),
            }
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
