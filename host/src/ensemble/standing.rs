//! How far a member has come, as its run directory tells.

use super::error::MemberError;
use super::member::{Member, hexadecimal};
use crate::configuration::{Configuration, Start};
use serde_json::Value;
use sha2::{Digest as _, Sha256};
use std::fs;
use std::path::Path;

/// How far a member has come.
#[derive(Clone, Debug, PartialEq)]
pub enum Standing {
    /// Nobody has begun it.
    Missing,
    /// It is under way, here or elsewhere, or was stopped.
    Unfinished,
    /// A step was refused, or its files could not be written.
    Failed,
    /// It has finished.
    Finished(Finished),
}

impl Standing {
    /// How `members.csv` calls it.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Unfinished => "unfinished",
            Self::Failed => "failed",
            Self::Finished(_) => "finished",
        }
    }

    /// Looks at the run directory of `member` in the directory of its ensemble.
    ///
    /// # Errors
    /// [`MemberError::Foreign`] if the run there has another configuration, and [`MemberError::Damaged`] if it has finished
    /// and its last state is not the one that its `run.json` names.
    pub fn of(member: &Member, ensemble: &Path) -> Result<Self, MemberError> {
        let directory = member.directory(ensemble);
        if !directory.exists() {
            return Ok(Self::Missing);
        }
        let summary = fs::read(directory.join("run.json")).ok();
        let Some(summary) = summary.and_then(|bytes| serde_json::from_slice::<Value>(&bytes).ok()) else {
            return Ok(Self::Unfinished);
        };
        refuse_foreign(member, &directory.join("config.toml"))?;
        if summary["ended"] == "error" {
            return Ok(Self::Failed);
        }
        if summary["ended"] != "finished" {
            return Ok(Self::Unfinished);
        }
        let told = (summary["step"].as_u64(), summary["time"].as_f64(), summary["digest"].as_str());
        let (Some(step), Some(time), Some(digest)) = told else { return Ok(Self::Unfinished) };
        let path = directory.join("final.state");
        let damaged = |reason| MemberError::Damaged { path: path.clone(), reason };
        let state = fs::read(&path).map_err(|error| damaged(format!("cannot be read: {error}")))?;
        let found = hexadecimal(&Sha256::digest(&state));
        if found != digest {
            return Err(damaged(format!("found digest {found}, run.json says that it was {digest}")));
        }
        let time_unit = summary["jeans_time"].as_f64().unwrap_or(1.0);
        Ok(Self::Finished(Finished { step, time, time_unit, digest: found }))
    }
}

/// Where a run has ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// Steps done.
    pub step: u64,
    /// Time, R0²/D.
    pub time: f64,
    /// What one unit of `time.until` and of intervals was, R0²/D: Jeans' time, in which strengths in a file that the run
    /// started from count, or 1 without attraction.
    pub time_unit: f64,
    /// SHA-256 of its last state.
    pub digest: String,
}

/// Refuses a run of another configuration than that of `member`; one that is not there is for the run to miss.
fn refuse_foreign(member: &Member, path: &Path) -> Result<(), MemberError> {
    let Ok(text) = fs::read_to_string(path) else { return Ok(()) };
    if text == member.configuration.to_toml() {
        return Ok(());
    }
    let unreadable = |error| MemberError::Run(crate::run::RunError::Configuration(error));
    let there = Configuration::from_text(&path.display().to_string(), &text, &[]).map_err(unreadable)?;
    refuse_other(member, &there, path)
}

/// Refuses a configuration, read from `path`, that is not that of `member`.
pub(super) fn refuse_other(member: &Member, there: &Configuration, path: &Path) -> Result<(), MemberError> {
    let own = &member.configuration;
    // A run takes the strengths that a file of positions gives into its configuration.
    let from_file = matches!(own.start, Start::File { .. });
    let free: &[&str] = if from_file { &["system.strengths", "physical.strengths"] } else { &[] };
    let Some((key, [found, expected])) = there.difference(own, free) else { return Ok(()) };
    let said = |value: Option<String>| value.unwrap_or_else(|| "nothing".to_owned());
    Err(MemberError::Foreign { path: path.to_owned(), key, found: said(found), expected: said(expected) })
}
