//! The way from runs to a report, with a few discs.

use super::*;
use crate::ensemble::Nobody;
use catalogue::CATALOGUE;

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
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let stop = AtomicBool::new(false);
    let machinery = Machinery { workers: 2, deadline: None, stop: &stop };
    // Nothing has finished.
    write(&report_on(&all, directory, Size::Tiny, None).unwrap(), directory).unwrap();
    let nothing = fs::read_to_string(directory.join(MARKDOWN)).unwrap();
    assert!(nothing.contains("0 of 4 runs") && nothing.contains("| undecided |"), "{nothing}");

    for round in rounds(&all, Size::Tiny, None) {
        let report = advance(round, directory, Size::Tiny, machinery, &Nobody).unwrap();
        assert!(report.is_complete(), "{:?}", report.fates);
    }
    let report = report_on(&all, directory, Size::Tiny, None).unwrap();
    for section in &report.sections {
        assert_eq!(section.finished, section.planned, "{}", section.name);
        // Snapshots are of 1 T and later.
        let has_none = ["text", "fig-3", "fig-4"].contains(&section.name.as_str());
        assert!(has_none || !section.pictures.is_empty(), "{}", section.name);
    }
    write(&report, directory).unwrap();
    for name in ["fig-2", "fig-11", "fig-12", "meshes"] {
        for ending in ["svg", "png"] {
            assert!(directory.join(FIGURES).join(format!("{name}.{ending}")).exists(), "{name}.{ending}");
        }
    }
    // The same runs give the same report.
    let again = report_on(&all, directory, Size::Tiny, None).unwrap();
    assert_eq!(fs::read_to_string(directory.join(HTML)).unwrap(), again.html());
}
