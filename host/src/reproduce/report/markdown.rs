//! The report as Markdown.

use super::{CampaignRecord, Report, Section};
use crate::reproduce::campaign::Size;
use crate::reproduce::finding::{Finding, Verdict};
use crate::statistics::{confidence, student_errors};

/// Below which folder figures are.
pub(super) const FIGURES: &str = "figures";

/// The whole text.
pub(super) fn markdown(report: &Report) -> String {
    let mut text = head(report);
    text.push_str(&summary(report));
    for section in &report.sections {
        text.push_str(&of_section(section));
    }
    text.push_str("## The runs\n\n");
    text.push_str(
        "Every run is decided by its configuration and seed to the last bit. Any of them can be repeated, on any \
         machine, and has to end with the digest below:\n\n\
         ```text\nmeniscus run CAMPAIGN/runs/HASH/config.toml --out again\nmeniscus digest again\n```\n\n\
         Without the runs' directory, the command of each campaign does the same from the program alone.\n\n",
    );
    for campaign in &report.campaigns {
        text.push_str(&of_campaign(campaign));
    }
    text
}

fn head(report: &Report) -> String {
    let size = match report.size {
        Size::Full => {
            "The numbers of discs, boxes and times are those of the paper, and so are those of runs for Figs. 2 and 14; for \
             Figs. 3 to 11, where it does not say, ten are meant to be; each section says how many have finished."
        }
        Size::Quick => {
            "This is the quick version: for Figs. 3 to 11 a quarter of the discs (625) at the paper's density, so at the \
             same Jeans' time and wavenumber; fewer runs, those of Figs. 12 to 14 shorter; and a ceiling of the time step twice the default (four \
             times for cold rings). Short capillary lengths keep λK, long ones λ/L."
        }
        Size::Tiny => "This is a test of the machinery: nothing in it says anything of physics.",
    };
    format!(
        "# The paper, reproduced\n\n\
         Bleibel, Dietrich, Domínguez and Oettel (2011), collective dynamics of colloids at a fluid interface, figure by \
         figure: what the paper says, what meniscus {version} finds, and whether the two are the same. {size}\n\n\
         Lengths are in disc radii R0, energies in kBT, times in Jeans' times T unless said otherwise. A number after ± is \
         one standard error (s.e.), over runs by the jackknife unless said otherwise, and ν, if it is given, the number of its \
         degrees of freedom: the runs less one. A verdict is computed from the numbers beside it, by the criterion \
         beside it, and undecided where the error is too large for that or unknown; of what is ours, reproduced means as \
         expected. Where the paper has words, or a number without an error, the bounds of a criterion are ours and say \
         so; how large an error may be is always ours.\n\n\
         In a criterion, 2 s.e. stand for the confidence that two standard errors have of a normal distribution, \
         {confidence:.2} %. Of few runs the error is itself uncertain, and that confidence takes as many of it as Student's t \
         says: {one:.2} of two runs (ν = 1), {two:.2} of three, {nine:.2} of ten. So few runs decide little, and with other \
         seeds a verdict near its bound may be another.\n\n",
        confidence = 100.0 * confidence(2.0),
        one = student_errors(2.0, 1.0),
        two = student_errors(2.0, 2.0),
        nine = student_errors(2.0, 9.0),
        version = env!("CARGO_PKG_VERSION"),
    )
}

/// Verdicts by sections.
fn summary(report: &Report) -> String {
    let mut text = "| | runs | reproduced | not reproduced | paper's text inconsistent | undecided |\n\
                    |---|---|---|---|---|---|\n"
        .to_owned();
    let cell = |count: usize| if count == 0 { "·".to_owned() } else { count.to_string() };
    for section in &report.sections {
        let counts = Verdict::ALL.map(|verdict| cell(section.count(verdict)));
        let runs =
            if section.planned == 0 { "·".to_owned() } else { progress(section.finished, section.planned) };
        let title = escaped(&section.title);
        text.push_str(&format!("| [{title}](#{}) | {runs} | {} |\n", section.name, counts.join(" | ")));
    }
    let counts = Verdict::ALL.map(|verdict| cell(report.count(verdict)));
    text.push_str(&format!("| all | | {} |\n\n", counts.join(" | ")));
    text
}

fn of_section(section: &Section) -> String {
    // An anchor of its own: those that headings get differ between readers.
    let mut text = format!("<a id=\"{}\"></a>\n\n## {}\n\n", section.name, escaped(&section.title));
    if section.planned > 0 {
        text.push_str(&format!("From {}.\n\n", progress(section.finished, section.planned)));
    }
    text.push_str(&format!("**The paper:** {}\n\n", section.paper));
    for picture in &section.pictures {
        let caption = &picture.caption;
        text.push_str(&format!("![{0}]({FIGURES}/{0}.svg)\n\n*{caption}*\n\n", picture.stem));
    }
    if !section.findings.is_empty() {
        text.push_str(
            "| quantity | paper | ours | counts as the paper's | verdict |\n|---|---|---|---|---|\n",
        );
        text.extend(section.findings.iter().map(row));
        text.push('\n');
    }
    for note in &section.notes {
        text.push_str(&format!("- {note}\n"));
    }
    if !section.notes.is_empty() {
        text.push('\n');
    }
    text
}

fn row(finding: &Finding) -> String {
    let verdict = finding.verdict();
    let word = match verdict {
        Verdict::Reproduced | Verdict::Undecided => verdict.word().to_owned(),
        Verdict::NotReproduced | Verdict::PaperInconsistent => format!("**{}**", verdict.word()),
    };
    let cells = [&finding.quantity, &finding.paper, &finding.ours(), &finding.criterion.words()]
        .map(|cell| escaped(cell));
    format!("| {} | {word} |\n", cells.join(" | "))
}

fn of_campaign(campaign: &CampaignRecord) -> String {
    let mut text = format!(
        "### {} ({})\n\n```toml\n{}```\n\n```text\n{}\n```\n\n",
        campaign.name,
        progress(campaign.runs.len(), campaign.planned),
        campaign.sweep,
        campaign.command,
    );
    if !campaign.runs.is_empty() {
        text.push_str("| hash | seed | λ / R0 | steps | digest |\n|---|---|---|---|---|\n");
    }
    for run in &campaign.runs {
        // Infinity is `inf`, as the command takes it.
        text.push_str(&format!(
            "| {} | {} | {} | {} | {} |\n",
            run.hash, run.seed, run.capillary_length, run.steps, run.digest
        ));
    }
    text.push('\n');
    text
}

fn progress(finished: usize, planned: usize) -> String {
    let runs = if planned == 1 { "run" } else { "runs" };
    if finished == planned { format!("{planned} {runs}") } else { format!("{finished} of {planned} {runs}") }
}

/// Text in which no sign of a table stands.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|").replace('<', "&lt;")
}
