//! Why an accuracy is not to be had, and what is.

use super::{ACCURACY_RANGE, Choice, Given, SAFETY, Scheme};
use crate::configuration::assignment_word;
use core::fmt;

/// No scheme is as accurate as was asked for with what is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The accuracy asked for.
    pub accuracy: f64,
    /// What was given.
    pub given: Given,
    /// The most accurate scheme with what is given.
    pub best: Box<Choice>,
    /// The smallest accuracy that [`super::choose`] accepts with what is given.
    pub reachable: f64,
    /// What would help.
    pub remedy: Remedy,
}

/// What helps against a [`Refusal`].
#[derive(Clone, Debug, PartialEq)]
pub enum Remedy {
    /// To give nothing but the accuracy: this is what [`super::choose`] then takes.
    Free(Box<Choice>),
    /// To ask for less, as even with nothing given the accuracy is out of reach.
    Accuracy {
        /// The smallest accuracy that [`super::choose`] accepts with nothing given.
        accuracy: f64,
        /// What it then takes.
        choice: Box<Choice>,
    },
    /// To leave the attraction out or all of it to the mesh: it is so weak that the quanta of force drown it.
    NoSplit,
}

impl std::error::Error for Refusal {}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { accuracy, best, reachable, .. } = self;
        let keys = given_keys(&self.given);
        let with = if keys.is_empty() { String::new() } else { format!(" with the given {keys}") };
        write!(
            formatter,
            "force.accuracy = {accuracy:?} cannot be reached{with}: the smallest estimated error, {:.1e} of the root \
             mean square force at {}, is above {SAFETY} of that",
            best.estimate,
            written(&best.scheme),
        )?;
        match &self.remedy {
            Remedy::Free(choice) => {
                write!(formatter, "; leave {keys} out, which gives {}", written(&choice.scheme))?;
                if *reachable <= ACCURACY_RANGE.1 {
                    write!(formatter, ", or set force.accuracy = {reachable:?} or more")?;
                }
                Ok(())
            }
            Remedy::Accuracy { accuracy: limit, .. } if keys.is_empty() => {
                write!(formatter, "; set force.accuracy = {limit:?} or more")
            }
            Remedy::Accuracy { accuracy: limit, .. } => {
                write!(formatter, "; leave {keys} out and set force.accuracy = {limit:?} or more")
            }
            Remedy::NoSplit => write!(
                formatter,
                "; the attraction is not far above the quantum of force, 2^-24 kBT/R0: set \
                 system.capillary_strength = 0, or force.method = \"pm\""
            ),
        }
    }
}

/// The configuration keys of what is given.
fn given_keys(given: &Given) -> String {
    let keys = [
        (given.grid.is_some(), "mesh.grid"),
        (given.assignment.is_some(), "mesh.assignment"),
        (given.splitting.is_some(), "force.splitting"),
        (given.cutoff.is_some(), "force.cutoff"),
    ];
    let keys: Vec<&str> = keys.iter().filter(|(is_given, _)| *is_given).map(|(_, key)| *key).collect();
    match keys.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => keys.concat(),
    }
}

/// A scheme as configuration keys.
fn written(scheme: &Scheme) -> String {
    let Scheme { grid, assignment, splitting, cutoff } = *scheme;
    let assignment = assignment_word(assignment);
    format!(
        "mesh.grid = {grid}, mesh.assignment = \"{assignment}\", force.splitting = {splitting:?}, \
         force.cutoff = {cutoff:?}"
    )
}

#[cfg(test)]
mod tests {
    use super::super::{System, choose};
    use super::*;

    #[test]
    fn the_message_names_keys_and_remedy_in_one_line() {
        let system = System {
            side: 500.0,
            particles: 2500,
            capillary_strength: 0.89,
            capillary_length: 270.0,
            mean_square_strength: 1.0,
        };
        let given = Given { grid: Some(32), cutoff: Some(20.0), ..Given::default() };
        let message = choose(&system, 1e-3, &given).expect_err("too coarse").to_string();
        assert!(message.starts_with("force.accuracy = 0.001 cannot be reached with the given mesh.grid and"));
        assert!(
            message.contains("leave mesh.grid and force.cutoff out, which gives mesh.grid = "),
            "{message}"
        );
        assert!(message.is_ascii() && !message.contains('\n'));
    }

    #[test]
    fn keys_are_listed_as_in_a_sentence() {
        let mut given = Given::default();
        assert_eq!(given_keys(&given), "");
        given.cutoff = Some(1.0);
        assert_eq!(given_keys(&given), "force.cutoff");
        given.splitting = Some(1.0);
        assert_eq!(given_keys(&given), "force.splitting and force.cutoff");
        given.grid = Some(16);
        assert_eq!(given_keys(&given), "mesh.grid, force.splitting and force.cutoff");
    }
}
