//! The report as one page of HTML.

use super::Report;
use super::markdown::FIGURES;
use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

/// How the page looks.
const STYLE: &str = "body{max-width:62rem;margin:2rem auto;padding:0 1rem;font-family:sans-serif;line-height:1.45;color:#111;background:#fff}\
table{border-collapse:collapse;margin:1rem 0;display:block;overflow-x:auto}\
th,td{border:1px solid #bbb;padding:.25rem .5rem;text-align:left;vertical-align:top}\
th{background:#eee}pre{background:#f4f4f4;padding:.6rem;overflow-x:auto}code{font-size:.9em}\
svg{max-width:100%;height:auto}h2{margin-top:2.5rem;border-top:1px solid #bbb;padding-top:1rem}";

/// The whole page, well-formed as XML too.
pub(super) fn html(report: &Report) -> String {
    let text = report.markdown();
    let options = Options::ENABLE_TABLES;
    let mut events = Vec::new();
    // What stands between the begin and the end of an image is its description, which is said below it.
    let mut inside_drawing = false;
    for event in Parser::new_ext(&text, options) {
        match event {
            Event::Start(Tag::Image { ref dest_url, .. }) => {
                if let Some(svg) = drawing(report, dest_url) {
                    inside_drawing = true;
                    events.push(Event::InlineHtml(CowStr::from(svg)));
                } else {
                    events.push(event);
                }
            }
            Event::End(TagEnd::Image) if inside_drawing => inside_drawing = false,
            _ if inside_drawing => {}
            event => events.push(event),
        }
    }
    let mut body = String::new();
    html::push_html(&mut body, events.into_iter());
    format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n\
         <title>The paper, reproduced</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )
}

/// The drawing of this address, without what only a file begins with.
fn drawing<'a>(report: &'a Report, address: &str) -> Option<&'a str> {
    let stem = address.strip_prefix(FIGURES)?.strip_prefix('/')?.strip_suffix(".svg")?;
    let mut pictures = report.sections.iter().flat_map(|section| &section.pictures);
    let svg = &pictures.find(|picture| picture.stem == stem)?.svg;
    svg.find("<svg").and_then(|begin| svg.get(begin..))
}
