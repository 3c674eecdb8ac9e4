//! The assembly sheet: the coded sequence as pages to print, with a picture a panel.
//!
//! Panels are laid layer by layer, so that whoever mounts a hinge has both its panels in reach, between piles too. Where that
//! would be more pages than anyone turns, each pile is its line of the coded sequence instead.

mod card;
mod rows;

use crate::bill::{Bill, Drives};
use crate::mounts::mounts;
use crate::panel::Panel;
use crate::svg::escaped;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fmt::{Display, Write as _};
use zygote_deployment::{TreeError, picture};
use zygote_stacking::Plan;

const STYLE: &str = include_str!("style.css");
/// Up to so many panels each has a picture.
const MOST_CARDS: usize = 200;
const CARDS_ON_A_PAGE: usize = 15;
/// Lines of a table on a page of its own.
const LINES_ON_A_PAGE: usize = 52;
/// More piles than these have a page of their own.
const PILES_ON_THE_COVER: usize = 8;

/// What an assembly sheet tells.
#[derive(Debug, Clone, Copy)]
pub struct Assembly<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// Its panels as things.
    pub panel: &'a Panel,
    /// What moves the hinges, where a rig says it.
    pub drives: Option<&'a Drives>,
}

/// The sheet as one HTML file that needs nothing else.
///
/// # Errors
/// [`TreeError`] if the plan is no tree.
pub fn assembly(about: &Assembly<'_>) -> Result<String, TreeError> {
    let mut pages = Pages::default();
    cover(&mut pages, about, &picture::both(about.plan)?);
    let piles = rows::piles(about.plan);
    if piles.len() > PILES_ON_THE_COVER {
        for lines in piles.chunks(LINES_ON_A_PAGE) {
            pages.page(format_args!("<h2>Piles</h2>{}", rows::pile_table(lines)));
        }
    }
    if about.plan.panels() > MOST_CARDS {
        for page in rows::pages(about.plan) {
            pages.page(page);
        }
    } else {
        let mounts = mounts(about.plan);
        let cards = card::in_order(about.plan);
        for on_page in cards.chunks(CARDS_ON_A_PAGE) {
            let cards: Vec<_> = on_page.iter().map(|step| card::card(about, &mounts, step)).collect();
            pages.page(format_args!("<div class=\"cards\">{}</div>", cards.concat()));
        }
    }
    Ok(pages.finish(&format!("{}: assembly", about.plan.source.model)))
}

fn cover(pages: &mut Pages, about: &Assembly<'_>, both: &str) {
    let Assembly { plan, panel, drives } = about;
    let image = STANDARD.encode(both);
    let mut html = format!(
        "<h1>{}</h1>\n<p class=\"note\">{} panels of {} x {} x {} mm in {} piles of {}, {} hinges. Panel {} stays fixed when it \
         unfolds.</p>\n<img class=\"whole\" alt=\"Stack and shape\" src=\"data:image/svg+xml;base64,{image}\">\n",
        escaped(&plan.source.model),
        plan.panels(),
        panel.side_mm,
        panel.side_mm,
        panel.thickness_mm,
        plan.piles.len(),
        plan.height(),
        plan.hinges.len(),
        plan.root,
    );
    let bill = Bill::new(plan, panel, *drives);
    let mut have = String::new();
    for item in &bill.items {
        let _infallible = writeln!(
            have,
            "<tr><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>",
            item.count,
            item.part,
            escaped(&item.detail)
        );
    }
    let how = if plan.panels() > MOST_CARDS { rows::HOW } else { card::HOW };
    let _infallible = writeln!(
        html,
        "<div class=\"two\"><div><h2>To have</h2><table>{have}</table></div><div><h2>How to read it</h2>{how}</div></div>"
    );
    let piles = rows::piles(plan);
    if piles.len() <= PILES_ON_THE_COVER {
        let _infallible = write!(html, "<h2>Piles</h2>{}", rows::pile_table(&piles));
    }
    pages.page(html);
}

/// Pages so far.
#[derive(Default)]
struct Pages {
    pages: Vec<String>,
}

impl Pages {
    fn page(&mut self, content: impl Display) {
        self.pages.push(content.to_string());
    }

    fn finish(self, title: &str) -> String {
        let title = escaped(title);
        let mut html = format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n<style>\n{STYLE}</style></head>\n<body>\n"
        );
        let count = self.pages.len();
        for (number, page) in self.pages.iter().enumerate() {
            let _infallible = writeln!(
                html,
                "<section class=\"page\">{page}<footer><span>{title}</span><span>{} of {count}</span></footer></section>",
                number + 1
            );
        }
        html.push_str("</body></html>\n");
        html
    }
}
