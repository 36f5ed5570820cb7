//! Messages to the user: results on standard output, everything else on standard error.

use crate::{args::ProgressForm, fault::Fault};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::{
    fmt::Display,
    io::{self, IsTerminal, Write, stderr, stdout},
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

/// How much is printed.
#[derive(Clone, Copy)]
pub struct Console {
    quiet: bool,
    verbose: bool,
    form: ProgressForm,
}

/// The first error of standard output.
static UNPRINTED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Whether standard output was closed when the program began.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Remembers whether standard output is closed. When the program begins, the standard library replaces a closed output by
/// `/dev/null`. What is printed would then be lost without an error.
pub extern "C" fn remember_closed_output() {
    #[cfg(unix)]
    // SAFETY: reads the flags of a file descriptor, which may be closed.
    if unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) } == -1 {
        CLOSED.store(true, Ordering::Relaxed);
    }
}

/// Returns an error if standard output was closed.
pub fn check_open() -> io::Result<()> {
    match CLOSED.load(Ordering::Relaxed) {
        true => Err(io::Error::other("it is closed")),
        false => Ok(()),
    }
}

/// The text on one line: a name or a path in it must neither control the terminal nor begin a line that a program
/// takes for one of ours.
fn one_line(text: &impl Display) -> String {
    hairspring_io::printable(&text.to_string()).into_owned()
}

/// The text of JSON on one line. Hidden characters are in strings only, where JSON has escapes for them.
fn json_line(value: &Value) -> String {
    let text = value.to_string();
    if !text.contains(hairspring_io::is_hidden) {
        return text;
    }
    text.chars().fold(String::new(), |mut shown, c| {
        match hairspring_io::is_hidden(c) {
            true => shown += &format!("\\u{:04x}", u32::from(c)),
            false => shown.push(c),
        }
        shown
    })
}

/// Prints a line of the result. After an error (a closed pipe, a full disk) nothing more is printed;
/// [`finish`] returns the error, so that a command still completes its files.
pub fn print_line(line: impl Display) {
    print(&one_line(&line));
}

/// Prints the result as JSON, as [`print_line`] does.
pub fn print_json(value: &Value) {
    print(&json_line(value));
}

fn print(line: &str) {
    let mut unprinted = UNPRINTED.lock().unwrap_or_else(PoisonError::into_inner);
    if unprinted.is_none() {
        *unprinted = check_open().and_then(|()| writeln!(stdout(), "{line}")).err();
    }
}

/// Completes standard output.
///
/// # Errors
/// Returns the first error of standard output.
pub fn finish() -> Result<(), Fault> {
    let first = UNPRINTED.lock().unwrap_or_else(PoisonError::into_inner).take();
    let why = first.or_else(|| stdout().flush().err());
    why.map_or(Ok(()), |why| Err(unprinted(why)))
}

/// Describes an error of standard output.
pub fn unprinted(why: io::Error) -> Fault {
    Fault::Unwritable(format!("the result could not be printed to standard output: {why}"))
}

/// Prints a note that does not depend on the settings of the console.
pub fn note(line: impl Display) {
    let _ = writeln!(stderr(), "note: {}", one_line(&line));
}

/// Prints an event of `--progress json`.
fn event(event: &Value) {
    let _ = writeln!(stderr(), "{}", json_line(event));
}

/// Prints a line about an error.
pub fn print_error(line: &impl Display) {
    let _ = writeln!(stderr(), "error: {}", one_line(line));
}

impl Console {
    /// `quiet`: only results and errors; `verbose`: also the time of each frame.
    pub fn new(quiet: bool, verbose: bool, form: ProgressForm) -> Self {
        Self { quiet, verbose, form }
    }

    /// Prints a note that the user should know about.
    pub fn note(self, line: impl Display) {
        match self.form {
            _ if self.quiet => {}
            ProgressForm::Json => event(&json!({ "event": "note", "text": line.to_string() })),
            _ => note(line),
        }
    }

    /// Prints one note for each item.
    pub fn note_all(self, things: impl IntoIterator<Item = impl Display>) {
        things.into_iter().for_each(|thing| self.note(thing));
    }

    /// Prints what the program is doing, if it takes a moment.
    pub fn doing(self, line: impl Display) {
        match self.form {
            ProgressForm::Json => self.note(line),
            _ if self.quiet => {}
            _ => _ = writeln!(stderr(), "{}", one_line(&line)),
        }
    }

    /// Shows the progress of `total` frames of `what`: a bar on a terminal, otherwise a line every tenth.
    pub fn progress(self, what: &'static str, total: u32) -> Progress {
        self.progress_in(what, total, "frames")
    }

    /// Shows the progress of `total` frames before the run. For Open Job Description it is a status without a number, because
    /// the number is that of the run.
    pub fn preroll(self, total: u32) -> Progress {
        if self.form == ProgressForm::Text {
            self.doing(format_args!("pre-roll of {total} frames"));
        }
        let mut progress = self.progress("pre-roll", total);
        progress.is_of_run = false;
        progress
    }

    /// Like [`Console::progress`], in units other than frames.
    pub fn progress_in(self, what: &'static str, total: u32, unit: &'static str) -> Progress {
        let bar = (!self.quiet && self.form == ProgressForm::Text && stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(total.into()), ProgressDrawTarget::stderr());
            // The template has no user input, so it always parses. If it did not, the plain bar would be
            // shown.
            let template =
                format!("{{msg}} [{{bar:32}}] {{pos}}/{{len}} {unit}, {{elapsed}} elapsed, {{eta}} left");
            if let Ok(style) = ProgressStyle::with_template(&template) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.set_message(what);
            bar
        });
        Progress { bar, console: self, what, unit, total, done: 0, is_of_run: true }
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
    /// Whether it is the progress of the run, and not of what comes before it.
    is_of_run: bool,
}

impl Progress {
    /// Counts one finished step; `detail` is printed in verbose mode.
    pub fn step(&mut self, detail: impl Fn() -> String) {
        self.done += 1;
        let Self { what, done, total, unit, .. } = *self;
        match (&self.bar, self.console.form) {
            (_, ProgressForm::Json) => event(&json!({
                "event": "progress", "what": what, "done": done, "total": total, "unit": unit, "detail": detail(),
            })),
            (_, ProgressForm::Openjd) => {
                // The result is on standard output too; a closed pipe is reported at the end.
                if self.is_of_run {
                    print_line(format_args!(
                        "openjd_progress: {:.2}",
                        100.0 * f64::from(done) / f64::from(total.max(1))
                    ));
                }
                print_line(format_args!("openjd_status: {what}, {done} of {total} {unit}"));
            }
            (Some(bar), _) => bar.inc(1),
            (None, _) => {
                let tenth = |n: u32| u64::from(n) * 10 / u64::from(self.total.max(1));
                if !self.console.verbose && tenth(self.done) > tenth(self.done - 1) {
                    self.console
                        .doing(format_args!("{} {}/{} {}", self.what, self.done, self.total, self.unit));
                }
            }
        }
        if self.console.verbose && self.console.form == ProgressForm::Text {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_control_the_terminal() {
        let name = "a\u{1b}[31mb\nopenjd_fail: c\u{202e}d\u{9b}";
        let line = one_line(&name);
        assert_eq!(line, "a\\u{1b}[31mb\\nopenjd_fail: c\\u{202e}d\\u{9b}");
        let json = json_line(&json!({ name: name }));
        assert!(!json.contains(hairspring_io::is_hidden), "{json}");
        assert_eq!(serde_json::from_str::<Value>(&json).unwrap(), json!({ name: name }));
    }
}
