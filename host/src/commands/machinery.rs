//! `--engine` and `--threads`.

use super::CommandError;
use crate::engine::{Kind, Machinery};

/// How to work; the results are the same.
#[derive(Debug, clap::Args)]
pub(super) struct MachineryArguments {
    /// Threads, at most; as many as there are processors by default. The results do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=MOST_THREADS))]
    threads: Option<u16>,
    /// The wide engine of this program, or the scalar core, which takes one thread. The results are the same.
    #[arg(long, value_parser = [Kind::Host.word(), Kind::Core.word()], default_value = Kind::Host.word())]
    engine: String,
}

/// More are a slip of the keyboard.
pub(super) const MOST_THREADS: i64 = 1024;

impl MachineryArguments {
    /// What was asked for.
    ///
    /// # Errors
    /// [`CommandError::CoreThreads`].
    pub(super) fn read(&self) -> Result<Machinery, CommandError> {
        if self.engine == Kind::Host.word() {
            let threads = self.threads.map_or_else(processors, usize::from);
            return Ok(Machinery { kind: Kind::Host, threads });
        }
        match self.threads {
            None | Some(1) => Ok(Machinery { kind: Kind::Core, threads: 1 }),
            Some(threads) => Err(CommandError::CoreThreads { threads }),
        }
    }
}

/// Processors that this program may use.
pub(super) fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, |count| count.get().min(MOST_THREADS as usize))
}
