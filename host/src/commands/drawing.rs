//! A report being drawn: how much it is of, and what Ctrl-C does meanwhile.
//!
//! It is drawn in a thread that writes no part of it; the table of force errors, which is kept beside it for the next report,
//! goes to the disk in one piece. So it can be left at any moment: what is on the disk is the report that was there before,
//! or the whole new one.

use super::stop::StopSignal;
use super::{CommandError, Reporter};
use crate::ensemble::EnsembleError;
use crate::reproduce::campaign::Size;
use crate::reproduce::catalogue::Entry;
use crate::reproduce::report::Report;
use crate::reproduce::{ReportFile, ReproduceError, evidence, files, report_of, write};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// Time between looks at the signal.
const LOOK: Duration = Duration::from_millis(50);

/// What a report is to be made of, and where.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub entries: Vec<&'static Entry>,
    pub directory: PathBuf,
    pub size: Size,
    pub seeds: Option<u32>,
}

/// Why a report is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reason {
    /// Some time has passed, and runs go on when it is there. Nothing is told; Ctrl-C stops the runs, and the report is
    /// the last.
    Time,
    /// There is nothing left to run.
    End,
    /// Somebody has stopped the runs.
    Stopped,
    /// The wall time is over.
    WallTime,
}

/// How far a report is.
enum Progress {
    /// It is known which runs there are.
    Counted(Counts),
    Done(Box<(Report, Vec<ReportFile>)>),
    Failed(ReproduceError),
}

#[derive(Clone, Copy)]
struct Counts {
    finished: usize,
    planned: usize,
}

impl Drawing {
    /// Draws the report and writes it; tells that, and what Ctrl-C does. Also gives whether Ctrl-C has stopped the runs
    /// meanwhile, or before.
    ///
    /// # Errors
    /// [`CommandError::NoReport`] if somebody does not wait for it, and those of drawing and writing.
    pub(super) fn draw(
        &self,
        mut reason: Reason,
        stop: &StopSignal,
        reporter: &Reporter<'_>,
    ) -> Result<(Report, Reason), CommandError> {
        let (sender, receiver) = channel();
        let drawing = self.clone();
        std::thread::spawn(move || {
            // Nobody listens any more when somebody does not wait.
            let _ = match drawing.made(&sender) {
                Ok(made) => sender.send(Progress::Done(Box::new(made))),
                Err(error) => sender.send(Progress::Failed(error)),
            };
        });
        let mut counts = None;
        let (report, files) = loop {
            if stop.take() {
                if reason != Reason::Time {
                    return Err(CommandError::NoReport(self.directory.clone()));
                }
                reason = Reason::Stopped;
                tell(reason, counts, reporter);
            }
            match receiver.recv_timeout(LOOK) {
                Ok(Progress::Counted(found)) => {
                    counts = Some(found);
                    tell(reason, counts, reporter);
                }
                Ok(Progress::Done(made)) => break *made,
                Ok(Progress::Failed(error)) => return Err(error.into()),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(EnsembleError::Thread.into()),
            }
        };
        write(&files, &self.directory)?;
        Ok((report, reason))
    }

    fn made(&self, sender: &Sender<Progress>) -> Result<(Report, Vec<ReportFile>), ReproduceError> {
        let evidence = evidence(&self.entries, &self.directory, self.size, self.seeds)?;
        let campaigns = || crate::reproduce::campaigns(&self.entries).into_iter();
        let _ = sender.send(Progress::Counted(Counts {
            finished: campaigns().map(|campaign| evidence.of(campaign).len()).sum(),
            planned: campaigns().map(|campaign| evidence.planned(campaign)).sum(),
        }));
        let report = report_of(&self.entries, &evidence, self.seeds)?;
        let files = files(&report)?;
        Ok((report, files))
    }
}

/// Tells what is drawn, if it is known and anything is to be told.
fn tell(reason: Reason, counts: Option<Counts>, reporter: &Reporter<'_>) {
    let Some(Counts { finished, planned }) = counts else { return };
    let runs = format!("{finished} of {planned} runs finished");
    match reason {
        Reason::Time => {}
        Reason::End => reporter.note(&format!("{runs}; drawing the report; Ctrl-C leaves it out")),
        Reason::Stopped => reporter.note(&format!(
            "stopped: {runs}; drawing the report of what there is; Ctrl-C again leaves it out"
        )),
        Reason::WallTime => reporter.note(&format!(
            "the wall time is over: {runs}; drawing the report of what there is; Ctrl-C leaves it out"
        )),
    }
}
