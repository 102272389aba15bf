//! `meniscus verify GOLDEN [--bisect]`

use super::machinery::MachineryArguments;
use super::{CommandError, Reporter, Verdict};
use crate::configuration::Configuration;
use crate::golden::{Difference, Golden};
use crate::simulation::Simulation;
use crate::verification::{compare, compare_with_core};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A golden file, as `run` writes it.
    golden: PathBuf,
    /// If a record differs, run up to it in this engine and in the scalar core, with the discs stored in two orders, and
    /// compare every step: this tells whether the program contradicts itself, and where first.
    #[arg(long)]
    bisect: bool,
    #[command(flatten)]
    machinery: MachineryArguments,
}

pub(super) fn run(arguments: &Arguments, reporter: &mut Reporter<'_>) -> Result<Verdict, CommandError> {
    let golden = Golden::read(&arguments.golden)?;
    if golden.records.is_empty() {
        return Err(CommandError::GoldenRecords { path: arguments.golden.clone(), found: "no record" });
    }
    let machinery = arguments.machinery.read()?;
    let name = format!("{}: configuration", arguments.golden.display());
    let simulation = || -> Result<Simulation, CommandError> {
        let configuration = Configuration::from_text(&name, &golden.configuration, &[])?;
        Ok(Simulation::with_machinery(configuration, machinery)?)
    };
    let mut agreed = None;
    let difference = compare(&golden, &mut simulation()?.engine, |record| {
        agreed = Some(record.step);
        reporter.detail(&format!("step {} is equal", record.step));
    })?;
    let Some(difference) = difference else {
        let (count, step) = (golden.records.len(), agreed.unwrap_or_default());
        reporter.text(&format!("equal: {count} records to step {step}\n"))?;
        reporter.json(|| serde_json::json!({ "equal": true, "records": count, "step": step }))?;
        return Ok(Verdict::Ok);
    };
    reporter.text(&describe(&golden, agreed, &difference))?;
    let within = if arguments.bisect { bisect(simulation()?, difference.step)? } else { None };
    if arguments.bisect {
        reporter.text(&describe_within(within.as_ref(), difference.step, agreed))?;
    }
    reporter.json(|| {
        serde_json::json!({
            "equal": false,
            "step": difference.step,
            "difference": difference.to_string(),
            "equal_to_step": agreed,
            "minted_by": golden.version,
            "bisected": arguments.bisect,
            "contradiction": within.map(|difference| difference.to_string()),
        })
    })?;
    Ok(Verdict::Different)
}

fn describe(golden: &Golden, agreed: Option<u64>, difference: &Difference) -> String {
    let before = match agreed {
        Some(step) => format!("equal up to the record of step {step}"),
        None => "no record before it".to_owned(),
    };
    let (minted, this) = (&golden.version, env!("CARGO_PKG_VERSION"));
    format!("different: {difference}\n{before}\nminted by meniscus {minted}, this is {this}\n")
}

fn bisect(simulation: Simulation, last: u64) -> Result<Option<Difference>, CommandError> {
    Ok(compare_with_core(simulation, last)?)
}

fn describe_within(within: Option<&Difference>, last: u64, agreed: Option<u64>) -> String {
    match within {
        Some(difference) => {
            format!("this program contradicts itself, the core with discs stored in reverse: {difference}\n")
        }
        None => format!(
            "this program agrees with itself at every step; the first difference lies in steps {} to {last}: \
             mint these with --every 1 where the file came from to see which\n",
            agreed.map_or(0, |step| step + 1)
        ),
    }
}
