//! `meniscus verify GOLDEN [--bisect]`

use super::machinery::MachineryArguments;
use super::progress::CountProgress;
use super::{CommandError, Reporter, Verdict};
use crate::configuration::Configuration;
use crate::engine::{Engine, EngineError, Trace};
use crate::golden::{Difference, Golden, Record};
use crate::simulation::Simulation;
use crate::verification::{Contradiction, Repeated, Steps, compare, first_contradiction, reversed};
use meniscus_core::dynamics::Clock;
use std::fmt::Write as _;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A golden file, as `run` writes it.
    golden: PathBuf,
    /// If a record differs, run from the one before it to it in two engines, with the discs stored in two orders, and
    /// compare every stage of every step: this tells whether the program contradicts itself, and in which stage first.
    #[arg(long)]
    bisect: bool,
    /// Compare nothing; print the digest of what each stage of this step (counted from 1) hands on, to be compared with
    /// what another machine prints.
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u64).range(1..), conflicts_with = "bisect")]
    stages: Option<u64>,
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
        let mut configuration = Configuration::from_text(&name, &golden.configuration, &[])?;
        // Nothing is written, and the memory that rows and snapshots would take is not asked for.
        configuration.output = configuration.output.without_series_and_snapshots();
        Ok(Simulation::with_machinery(configuration, machinery)?)
    };
    if let Some(step) = arguments.stages {
        return print_stages(&mut simulation()?.engine, step, reporter);
    }
    let mut agreed = None;
    let engine = &mut simulation()?.engine;
    let last = golden.records.last().map(|record| record.step);
    let mut progress = CountProgress::new("step", engine.clock().step, last, reporter);
    let difference = compare(&golden, engine, |repeated| match repeated {
        Repeated::Step(step) => progress.show(step, reporter),
        Repeated::Record(record) => {
            agreed = Some(record.step);
            reporter.detail(&format!("step {} is equal", record.step));
        }
    });
    progress.finish();
    let difference = difference?;
    let Some(difference) = difference else {
        let (count, step) = (golden.records.len(), agreed.unwrap_or_default());
        reporter.text(&format!("equal: {count} records to step {step}\n"))?;
        reporter.json(|| serde_json::json!({ "equal": true, "records": count, "step": step }))?;
        return Ok(Verdict::Ok);
    };
    reporter.text(&describe(&golden, agreed, &difference))?;
    let search = if arguments.bisect {
        let search = bisect(simulation()?, &golden, difference.step, agreed, reporter)?;
        reporter.text(&search.describe(difference.step, agreed))?;
        Some(search)
    } else {
        None
    };
    reporter.json(|| {
        let contradiction = search.as_ref().and_then(|search| search.contradiction.as_ref());
        serde_json::json!({
            "equal": false,
            "step": difference.step,
            "difference": difference.to_string(),
            "equal_to_step": agreed,
            "minted_by": golden.version,
            "bisected": arguments.bisect,
            "first_differing_step": contradiction.map(|contradiction| contradiction.step),
            "contradiction": contradiction.map(ToString::to_string),
            "other_engine_gives_the_record": search.as_ref().map(|search| search.other_is_right),
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

/// What running two engines side by side has shown.
struct Search {
    /// The engine that was asked for, and the other, in words.
    engines: [&'static str; 2],
    contradiction: Option<Contradiction>,
    /// Step at which they began.
    begun: u64,
    /// Whether the other engine gives the record that this one does not.
    other_is_right: bool,
}

impl Search {
    fn describe(&self, last: u64, agreed: Option<u64>) -> String {
        let first = agreed.unwrap_or(self.begun) + 1;
        let [this, other] = self.engines;
        let right = |record: &str| match self.other_is_right {
            true => format!("gives {record}"),
            false => format!("does not give {record} either"),
        };
        match &self.contradiction {
            Some(contradiction) => format!(
                "this program contradicts itself, --engine {this} and --engine {other}: {contradiction}\n\
                 --engine {other} {}\n",
                right(&format!("the record of step {last}"))
            ),
            None if last <= self.begun => "the state that the run starts from differs already\n".to_owned(),
            None if first >= last => format!(
                "this program agrees with itself in every stage up to step {last}, which is the first that differs from \
                 where the file came from: to see in which stage, compare what meniscus verify FILE --stages {last} \
                 prints here and there\n"
            ),
            None => format!(
                "this program agrees with itself in every stage of every step; the first difference lies in steps {first} \
                 to {last}: mint these with --every 1 where the file came from to see which\n"
            ),
        }
    }
}

/// Runs from the last record that is equal to the one that differs, in the engine asked for and in the other.
fn bisect(
    simulation: Simulation,
    golden: &Golden,
    last: u64,
    agreed: Option<u64>,
    reporter: &Reporter<'_>,
) -> Result<Search, CommandError> {
    let Simulation { mut engine, configuration, .. } = simulation;
    if let Some(agreed) = agreed {
        advance(&mut engine, agreed, reporter)?;
    }
    let mut other = reversed(&engine, &configuration)?;
    let engines = [engine.kind().word(), other.kind().word()];
    let step = engine.clock().step;
    reporter
        .detail(&format!("comparing --engine {} with --engine {} from step {step}", engines[0], engines[1]));
    let mut progress = CountProgress::new("step", step, Some(last), reporter);
    let watched = &mut Watched { engine, progress: &mut progress, reporter };
    let contradiction = first_contradiction(watched, &mut other, last);
    progress.finish();
    let contradiction = contradiction?;
    // An engine that refuses a step does not give the record, and what was found before is to be told.
    let arrives = advance(&mut other, last, reporter).is_ok();
    let found = Record::from(other.state().digest_by_field());
    let expected = golden.records.iter().find(|record| record.step == last);
    let other_is_right = arrives && expected.is_some_and(|expected| expected.difference(&found).is_none());
    Ok(Search { engines, contradiction, begun: step, other_is_right })
}

/// Runs up to step `last`.
fn advance(engine: &mut Engine, last: u64, reporter: &Reporter<'_>) -> Result<(), EngineError> {
    let mut progress = CountProgress::new("step", engine.clock().step, Some(last), reporter);
    let mut result = Ok(());
    while result.is_ok() && engine.clock().step < last {
        result = engine.step().map(|_| ());
        progress.show(engine.clock().step, reporter);
    }
    progress.finish();
    result
}

/// An engine whose steps are shown.
struct Watched<'a, 'b> {
    engine: Engine,
    progress: &'a mut CountProgress,
    reporter: &'a Reporter<'b>,
}

impl Steps for Watched<'_, '_> {
    fn traced_step(&mut self, trace: &mut Trace) -> Result<Clock, EngineError> {
        let clock = Steps::traced_step(&mut self.engine, trace)?;
        self.progress.show(clock.step, self.reporter);
        Ok(clock)
    }

    fn clock(&self) -> Clock {
        self.engine.clock()
    }

    fn record(&self) -> Record {
        self.engine.record()
    }
}

/// Prints length and digest of what each stage of a step hands on.
fn print_stages(
    engine: &mut Engine,
    step: u64,
    reporter: &mut Reporter<'_>,
) -> Result<Verdict, CommandError> {
    let start = engine.clock().step;
    if step <= start {
        return Err(CommandError::StageBeforeStart { step, start });
    }
    advance(engine, step - 1, reporter)?;
    let mut trace = Trace::default();
    engine.traced_step(&mut trace)?;
    let mut table = String::new();
    for (stage, digest) in trace.digests() {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "{:<15}{} {digest}", stage.to_string(), digest.length);
    }
    reporter.text(&table)?;
    reporter.json(|| {
        let stages = trace.digests().map(|(stage, digest)| {
            serde_json::json!({ "stage": stage.to_string(), "length": digest.length, "digest": digest.to_string() })
        });
        serde_json::json!({ "step": step, "stages": stages.collect::<Vec<_>>() })
    })?;
    Ok(Verdict::Ok)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{Stage, StageDifference};
    use crate::verification::Parting;

    fn search(contradiction: Option<Contradiction>, begun: u64) -> Search {
        Search { engines: ["host", "core"], contradiction, begun, other_is_right: true }
    }

    /// The example of the page on golden runs.
    #[test]
    fn a_contradiction_is_told_as_the_documentation_shows() {
        let values = [Some(-1503), Some(-1504)];
        let parting = Parting::Stage(StageDifference { stage: Stage::PairForce, index: 15, values });
        let found = search(Some(Contradiction { step: 53, parting }), 40);
        let said = found.describe(60, Some(40));
        let page = include_str!("../../docs/golden-runs.md");
        let page: String = page.lines().map(|line| format!("{}\n", line.trim_start())).collect();
        assert!(page.contains(&said), "{said}");
        assert_eq!(said.lines().count(), 2);
        let wrong = Search { other_is_right: false, ..found };
        assert!(
            wrong
                .describe(60, Some(40))
                .ends_with("--engine core does not give the record of step 60 either\n")
        );
    }

    #[test]
    fn where_the_difference_can_lie_is_told() {
        let said = |begun, last, agreed| search(None, begun).describe(last, agreed);
        assert!(said(0, 0, None).starts_with("the state that the run starts from differs"));
        assert!(said(0, 60, Some(40)).contains("lies in steps 41 to 60: "));
        assert!(said(0, 60, None).contains("lies in steps 1 to 60: "));
        assert!(said(0, 41, Some(40)).contains("up to step 41, which is the first that differs"));
    }
}
