//! `meniscus resume DIR …`

use super::machinery::MachineryArguments;
use super::run::{WallTime, announce, conclude, go};
use super::stop::StopSignal;
use super::{CommandError, Reporter, Verdict};
use crate::run::{Resumed, Run};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The directory of a run that was stopped, or is to go further.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Another end, in Jeans' times (in R0^2/D without attraction).
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    until: Option<f64>,
    #[command(flatten)]
    wall_time: WallTime,
    #[command(flatten)]
    machinery: MachineryArguments,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let deadline = arguments.wall_time.deadline();
    match Run::resume(&arguments.directory, arguments.machinery.read()?, arguments.until)? {
        Resumed::Ready { run, warnings } => {
            warnings.iter().for_each(|warning| reporter.warn(warning));
            let simulation = run.simulation();
            announce(simulation, &arguments.directory, reporter);
            reporter.note(&format!("goes on after step {}", simulation.engine.clock().step));
            go(run.until(deadline), &StopSignal::catch()?, reporter)
        }
        Resumed::Finished(outcome) => {
            reporter.note("this run has finished; to go further: --until T");
            conclude(&outcome, reporter)?;
            Ok(Verdict::Ok)
        }
    }
}
