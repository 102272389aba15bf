//! The command-line program as its users start it: a process with arguments, files, output and an exit code.
//!
//! Where it is, only an integration test knows: `Program::new(env!("CARGO_BIN_EXE_meniscus-under-test"))`.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a helper of a test fails the test by panicking")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// 60 discs that collapse within a few hundred steps on a small mesh.
pub const SMALL: &str = "version = 1\nseed = 7\n\
    [system]\nparticles = 60\nbox = 48\ncapillary_strength = 10\ncapillary_length = 30\n\
    [force]\nmethod = \"pm\"\n[mesh]\ngrid = 32\n\
    [time]\nuntil = 0.5\n\
    [output]\nobservables = 0.05\ntrajectory = 0.1\nsnapshots = 0\n";

/// The program in a folder of its own, in which `small.toml` is [`SMALL`].
pub struct Program {
    executable: PathBuf,
    folder: tempfile::TempDir,
}

impl Program {
    /// Makes the folder.
    pub fn new(executable: impl Into<PathBuf>) -> Self {
        let program = Self { executable: executable.into(), folder: tempfile::tempdir().unwrap() };
        program.write("small.toml", SMALL);
        program
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.folder().join(name), text).unwrap();
    }

    /// Reads a file.
    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.folder().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Reads a file of text.
    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    /// The program with arguments, not started.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.executable);
        command.current_dir(self.folder()).args(arguments).stdin(Stdio::null());
        command
    }

    /// A line of the shell in which `meniscus` is the program.
    pub fn shell(&self, line: &str) -> Output {
        let function = format!("set -o pipefail; meniscus() {{ '{}' \"$@\"; }}\n", self.executable.display());
        let mut shell = Command::new("bash");
        shell.current_dir(self.folder()).args(["-c", &(function + line)]).stdin(Stdio::null());
        shell.output().unwrap()
    }

    /// Starts it and waits for its end.
    pub fn start(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Starts it, has it succeed, and gives its standard output.
    pub fn succeed(&self, arguments: &[&str]) -> String {
        let output = self.start(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", errors(&output));
        String::from_utf8(output.stdout).unwrap()
    }

    /// Starts it, has it fail with exit code 2 and one line of an error, the last, that holds every part.
    pub fn refuse(&self, arguments: &[&str], parts: &[&str]) -> String {
        let output = self.start(arguments);
        let errors = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {errors}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert_eq!(errors.matches("error: ").count(), 1, "{arguments:?}: {errors}");
        let line = errors.lines().next_back().unwrap().to_owned();
        assert!(line.starts_with("error: "), "{arguments:?}: {errors}");
        for part in parts {
            assert!(line.contains(part), "{arguments:?}: {part} is not in {line}");
        }
        line
    }
}

/// What it wrote on standard error.
pub fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
