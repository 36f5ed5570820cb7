//! The report: one page of HTML that needs nothing beside itself.

use super::{
    Job,
    chart::{escape, svg},
    parameters, row,
};
use hairspring::validate::{Case, Outcome, Plot};
use rayon::prelude::*;

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 46rem; margin: 2rem auto; padding: 0 1rem }
h1 { font-size: 1.6rem } h2 { font-size: 1.2rem; margin-top: 2.5rem; border-top: 1px solid #ddd; padding-top: 1rem }
table { border-collapse: collapse; width: 100%; font-size: 0.85rem; font-variant-numeric: tabular-nums }
th { text-align: left; border-bottom: 1px solid #999 } th, td { padding: 0.15rem 0.5rem 0.15rem 0; vertical-align: top }
tr.fail td { color: #b00020; font-weight: 600 }
svg { width: 100%; height: auto } svg text { font: 12px system-ui, sans-serif; fill: #444 }
.grid { stroke: #eee } .axis { stroke: #999; fill: none } .curve { fill: none; stroke-width: 1.6 }
svg circle { stroke: #fff; stroke-width: 1 }
.legend { font-size: 0.85rem; margin: 0 } .legend span { margin-right: 1.2rem } .key { width: 28px; height: 10px; margin-right: 0.4rem }
small { color: #666 } nav a { margin-right: 0.8rem; white-space: nowrap }
";

/// The page of what `jobs` came to; simulates more for the plots, in parallel.
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
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\">\
         <title>Hairspring against closed forms</title><style>{STYLE}</style></head><body>\n\
         <h1>Hairspring against closed forms</h1>\n\
         <p>{passed} of {} measured values are within their tolerance. hairspring {}.</p>\n\
         <nav>{links}</nav>\n{sections}</body></html>\n",
        outcomes.len(),
        env!("CARGO_PKG_VERSION"),
    )
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
        svg(plot),
    )
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
