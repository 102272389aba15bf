//! What a command tells, and where: results on standard output, everything else on standard error.
//!
//! | | default | `--verbose` | `--quiet` |
//! |---|---|---|---|
//! | results and errors | yes | yes | yes |
//! | warnings: files that were damaged or gone, and what took their place | yes | yes | yes |
//! | notes: progress, remarks on what was asked for, where results are | yes | yes | no |
//! | details: what was chosen, timings | no | yes | no |
//!
//! With `--json` standard output holds one JSON object and nothing else; a command that fails leaves it empty. Nobody has
//! to listen: where a pipe is closed, what would go into it is dropped, the command goes on, and its exit code stays what
//! it is. Only results can fail to be written, on a full disc for example.

use std::io::{ErrorKind, Write};

/// How much to tell, and in which form.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(super) struct Reporting {
    /// Tell more: what was chosen, timings.
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    verbose: bool,
    /// Tell results, warnings and errors only.
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Print the result as one JSON object, and nothing else, on standard output.
    #[arg(long, global = true)]
    json: bool,
}

/// Tells what there is to tell.
pub(super) struct Reporter<'a> {
    reporting: Reporting,
    output: &'a mut dyn Write,
}

impl<'a> Reporter<'a> {
    /// Results go to `output`.
    pub(super) fn new(reporting: Reporting, output: &'a mut dyn Write) -> Self {
        Self { reporting, output }
    }

    /// Whether notes are told at all.
    pub(super) fn tells_notes(&self) -> bool {
        !self.reporting.quiet
    }

    /// A line on something that nobody asked for and everybody has to know.
    pub(super) fn warn(&self, line: &str) {
        say(line);
    }

    /// A line for whoever wants to know how it goes.
    pub(super) fn note(&self, line: &str) {
        if self.tells_notes() {
            say(line);
        }
    }

    /// A line for whoever wants to know more.
    pub(super) fn detail(&self, line: &str) {
        if self.reporting.verbose {
            say(line);
        }
    }

    /// A part of the result as a person reads it, with its ends of lines.
    ///
    /// # Errors
    /// Those of writing, but for a closed pipe.
    pub(super) fn text(&mut self, text: &str) -> std::io::Result<()> {
        if self.reporting.json { Ok(()) } else { self.write(text) }
    }

    /// The whole result as a program reads it. Called once in a command that does not fail.
    ///
    /// # Errors
    /// Those of writing, but for a closed pipe.
    pub(super) fn json(&mut self, object: impl FnOnce() -> serde_json::Value) -> std::io::Result<()> {
        if self.reporting.json { self.write(&format!("{}\n", object())) } else { Ok(()) }
    }

    fn write(&mut self, text: &str) -> std::io::Result<()> {
        match self.output.write_all(text.as_bytes()).and_then(|()| self.output.flush()) {
            // Whoever read has seen enough.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            result => result,
        }
    }
}

/// Writes a line to standard error; nobody can be told if that fails.
pub(super) fn say(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
