//! The report: one self-contained HTML page.

use super::{Job, parameters, row};
use crate::report::{
    chart::{Series, svg},
    document, escape,
};
use hairspring_validate::{Case, Outcome, Plot};
use rayon::prelude::*;

/// Builds the page for the results of `jobs`. It simulates more runs for the plots, in parallel.
pub fn page(jobs: &[Job], outcomes: &[Outcome]) -> String {
    let mut cases: Vec<&Job> = Vec::new();
    for job in jobs {
        if cases.last().is_none_or(|last| last.case.name != job.case.name) {
            cases.push(job);
        }
    }
    let plots: Vec<Plot> = cases.par_iter().map(|job| job.case.plot(job.method)).collect();
    let passed = outcomes.iter().filter(|o| o.pass()).count();
    let links = cases.iter().map(|j| format!("<a href=\"#{0}\">{0}</a> ", j.case.name)).collect::<String>();
    let sections = cases.iter().zip(&plots).map(|(job, plot)| section(job.case, plot, outcomes));
    let sections: String = sections.collect();
    let body = format!(
        "<p>{passed} of {} measured values are within their tolerance. hairspring {}.</p>
\
         <nav>{links}</nav>
{sections}",
        outcomes.len(),
        env!("CARGO_PKG_VERSION"),
    );
    document("Hairspring compared with closed-form solutions", &body)
}

fn section(case: &Case, plot: &Plot, outcomes: &[Outcome]) -> String {
    let own: Vec<&Outcome> = outcomes.iter().filter(|o| o.case == case.name).collect();
    let rows: String = own.iter().map(|o| table_row(o)).collect();
    let how = own.first().map_or(String::new(), |o| super::how(o));
    format!(
        "<section id=\"{}\"><h2>{}</h2>\n<p>{} <small>{how}.</small></p>\n{}\n<table><tr><th>parameters</th>\
         <th>quantity</th><th>measured</th><th>reference</th><th>error</th><th></th></tr>\n{rows}</table></section>\n",
        case.name,
        case.name,
        escape(case.about),
        drawn(plot),
    )
}

/// The plot as an SVG element.
fn drawn(plot: &Plot) -> String {
    let series: Vec<Series> = plot
        .curves
        .iter()
        .map(|c| Series { name: &c.name, line: &c.reference, points: &c.measured })
        .collect();
    svg([&plot.x, &plot.y], &series, "line: reference, points: measured")
}

fn table_row(outcome: &Outcome) -> String {
    let [_, _, quantity, measured, reference, error, verdict] = row(outcome).map(|cell| escape(&cell));
    let class = if outcome.pass() { "" } else { " class=\"fail\"" };
    let parameters = escape(&parameters(outcome));
    format!(
        "<tr{class}><td>{parameters}</td><td>{quantity}</td><td>{measured}</td><td>{reference}</td>\
         <td>{error}</td><td>{verdict}</td></tr>\n"
    )
}
