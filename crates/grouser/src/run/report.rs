//! The report: one self-contained page.

use super::Outcome;
use crate::output::summary::{Status, Summary};
use crate::scene::{Scenario, resolved};
use base64::Engine;
use std::fmt::Write;

const STYLE: &str = include_str!("report.css");

/// The page of a run.
pub fn page(scenario: &Scenario, summary: &Summary, outcome: &Outcome) -> String {
    let mut body = String::new();
    let status = match summary.status {
        Status::Done => "done",
        Status::Failed => "failed",
        Status::Interrupted => "interrupted",
    };
    let _ = write!(
        body,
        "<header><p class=kicker>grouser {} · {status}{}</p><h1>{}</h1>{}</header>",
        summary.version,
        if summary.is_quick { " · with --quick: smaller and coarser than the scene" } else { "" },
        escaped(&scenario.title),
        paragraphs(&scenario.description)
    );
    if let Some(error) = &summary.error {
        let _ =
            write!(body, "<section class=error><h2>What went wrong</h2><p>{}</p></section>", escaped(error));
    }
    if let Some(verdict) = &outcome.verdict {
        let _ = write!(
            body,
            "<section class=verdict><h2>{}</h2><p>{}</p>",
            escaped(&verdict.heading),
            escaped(&verdict.text)
        );
        if !verdict.source.is_empty() {
            let _ = write!(body, "<p class=source>{}</p>", escaped(&verdict.source));
        }
        body += "</section>";
    }
    for (_, chart) in &outcome.charts {
        if let Ok(svg) = chart.to_inline_svg() {
            let _ = write!(body, "<figure>{svg}</figure>");
        }
    }
    for picture in &outcome.pictures {
        let data = base64::engine::general_purpose::STANDARD.encode(&picture.png);
        let caption = escaped(&picture.caption);
        let _ = write!(
            body,
            "<figure><img alt=\"{caption}\" src=\"data:image/png;base64,{data}\"><figcaption>{caption}</figcaption></figure>"
        );
    }
    for section in &outcome.sections {
        let heads: Vec<&str> = section.heads.iter().map(String::as_str).collect();
        body += &table(&section.title, &heads, section.rows.iter().cloned());
    }
    let rows = summary.metrics.iter().map(|m| {
        let reference = m.reference.map_or(String::new(), number);
        let ratio = m.reference.filter(|r| *r != 0.0).map_or(String::new(), |r| number(m.value / r));
        let uncertainty = m.uncertainty.map_or(String::new(), |u| format!("± {}", number(u)));
        vec![m.name.clone(), number(m.value), uncertainty, m.unit.clone(), reference, ratio]
    });
    body += &table("Metrics", &["", "value", "95 %", "unit", "reference", "value / reference"], rows);
    let t = &summary.time;
    let pace = if t.wall_s > 0.0 { t.steps as f64 / t.wall_s } else { 0.0 };
    let rows = [
        ("simulated", format!("{} s in {} steps", number(t.simulated_s), t.steps)),
        ("by the clock", format!("{:.1} s, of which {:.1} s of preparation", t.wall_s, t.setup_s)),
        (
            "processor",
            t.cpu_s.map_or("unknown".into(), |s| format!("{s:.1} s on {} threads", summary.threads)),
        ),
        ("pace", format!("{pace:.0} steps a second, {}", summary.host)),
    ];
    body += &table("Time", &["", ""], rows.map(|(name, text)| vec![name.to_owned(), text]).into_iter());
    if let Some(step) = &summary.time_step {
        let rows = step.criteria.iter().map(|c| {
            let mark = if c.name == step.binding { "◆ " } else { "" };
            vec![format!("{mark}{}", c.name), format!("{} s", number(c.critical_s)), c.place.clone()]
        });
        let title = format!("Time step {} s, bound by: {}", number(step.dt_s), step.binding);
        body += &table(&title, &["criterion", "critical time", "where"], rows);
    }
    if let Some(energy) = &summary.energy {
        let rows = energy.entries.iter().map(|e| vec![e.name.clone(), format!("{} J", number(e.value_J))]);
        let title = format!("Energy, residual {:.3} % of the work", 100.0 * energy.residual_fraction);
        body += &table(&title, &["", ""], rows);
    }
    let rows = summary.conventions.iter().map(|(name, text)| vec![(*name).to_owned(), text.clone()]);
    body += &table("Conventions", &["", ""], rows);
    let _ = write!(
        body,
        "<details><summary>Resolved scenario</summary><pre>{}</pre></details>",
        escaped(&resolved(scenario))
    );
    format!(
        "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport content=\"width=device-width\">\
         <title>{}</title><style>{STYLE}</style><main>{body}</main></html>\n",
        escaped(&scenario.title)
    )
}

/// A section with a table; nothing without rows.
fn table(title: &str, heads: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut rows = rows.peekable();
    if rows.peek().is_none() {
        return String::new();
    }
    let mut text = format!("<section><h2>{}</h2><div class=scroll><table>", escaped(title));
    if heads.iter().any(|head| !head.is_empty()) {
        let cells: String = heads.iter().map(|head| format!("<th>{}</th>", escaped(head))).collect();
        let _ = write!(text, "<thead><tr>{cells}</tr></thead>");
    }
    for row in rows {
        let cells: String = row.iter().map(|cell| format!("<td>{}</td>", escaped(cell))).collect();
        let _ = write!(text, "<tr>{cells}</tr>");
    }
    text + "</table></div></section>"
}

/// Four significant digits.
pub fn number(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        format!("{value:.*}", (3 - exponent).max(0) as usize)
    } else {
        format!("{value:.3e}")
    }
}

/// A line that ends a sentence ends a paragraph, too; other ends of lines are where the author's editor broke them.
fn paragraphs(text: &str) -> String {
    let mut paragraphs = vec![String::new()];
    for line in text.lines().map(str::trim) {
        let last = paragraphs.last_mut().expect("there is one");
        *last += if last.is_empty() { "" } else { " " };
        *last += line;
        if line.is_empty() || line.ends_with(['.', '!', '?', ':']) {
            paragraphs.push(String::new());
        }
    }
    let paragraphs = paragraphs.iter().filter(|text| !text.trim().is_empty());
    paragraphs.map(|text| format!("<p class=lead>{}</p>", escaped(text.trim()))).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_and_text_is_harmless() {
        assert_eq!([12345.6, 0.012344, 1.5e-7, 0.0].map(number), ["12346", "0.01234", "1.500e-7", "0"]);
        let description = "Ruts of a machine at settings\nof others. And more.\nAssumed: <all>\n\nThe end";
        let first = "<p class=lead>Ruts of a machine at settings of others. And more.</p>";
        let rest = "<p class=lead>Assumed: &lt;all&gt;</p><p class=lead>The end</p>";
        assert_eq!(paragraphs(description), format!("{first}{rest}"));
        assert_eq!(escaped("<b a=\"&\">"), "&lt;b a=&quot;&amp;&quot;&gt;");
    }
}
