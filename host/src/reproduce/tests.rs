//! The way from runs to a report, with a few discs.

use super::*;
use crate::ensemble::Nobody;
use catalogue::{CATALOGUE, entry};

#[test]
fn every_campaign_has_its_turn_early() {
    let all: Vec<&Entry> = CATALOGUE.iter().collect();
    let rounds = rounds(&all, Size::Full, None);
    let first: Vec<Campaign> = rounds.iter().take(5).map(|round| round.campaign).collect();
    assert_eq!(first, Campaign::ALL);
    assert_eq!(rounds.last(), Some(&Round { campaign: Campaign::Modes, seeds: 20 }));
    assert_eq!(rounds.iter().filter(|round| round.campaign == Campaign::Rings).count(), 1);
}

#[test]
fn a_report_is_written_of_what_has_finished() {
    let all: Vec<&Entry> = CATALOGUE.iter().collect();
    let rings = [entry("fig-12").unwrap()];
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let report = |entries: &[&Entry]| report_on(entries, directory, Size::Tiny, None).unwrap();
    // Nothing has finished.
    write(&report(&rings), directory).unwrap();
    let nothing = fs::read_to_string(directory.join(MARKDOWN)).unwrap();
    assert!(nothing.contains("0 of 4 runs") && nothing.contains("| undecided |"), "{nothing}");

    let stop = AtomicBool::new(false);
    let machinery = Machinery { workers: 2, deadline: None, stop: &stop };
    for round in rounds(&all, Size::Tiny, None) {
        let report = advance(round, directory, Size::Tiny, machinery, &Nobody).unwrap();
        assert!(report.is_complete(), "{:?}", report.fates);
    }
    for section in report(&all).sections {
        assert_eq!(section.finished, section.planned, "{}", section.name);
        // Snapshots are of 1 T and later; nothing is dense enough to have a shape.
        let has_none = ["text", "fig-3", "fig-4", "fig-11"].contains(&section.name.as_str());
        assert!(has_none || !section.pictures.is_empty(), "{}", section.name);
    }
    write(&report(&rings), directory).unwrap();
    for name in ["figures/fig-12.svg", "figures/fig-12.png", MARKDOWN] {
        assert!(directory.join(name).metadata().unwrap().len() > 0, "{name}");
    }
    // The same runs give the same report.
    assert_eq!(fs::read_to_string(directory.join(HTML)).unwrap(), report(&rings).html());
}
