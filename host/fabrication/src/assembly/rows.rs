//! Piles in a table, and for large stacks the coded sequence, a word a panel.

use std::fmt::Write as _;
use zygote_stacking::{Column, Layer, Plan, Sequence};

/// How a reader understands the words.
pub(super) const HOW: &str = "<p>One word a panel, pile by pile from the bottom up: its number, then side and opening angle of the hinge to the panel \
    above. <b>[W180]</b> before it is a bridge to the next pile on that side, told at both its panels. <b>/</b> means no hinge, <b>.</b> \
    the top, <b>*</b> the panel that stays fixed. You look from above, N is the side away from you. Outer sides are up at even heights, from 0.</p>\
    <p>Lay a layer of all piles, then the next: so both panels of a bridge are in reach.</p>";

const COLUMNS: usize = 6;
/// Rows of words on a page, headings among them.
const ROWS: usize = 60;

/// What stands in a row.
enum Row<'a> {
    Pile(usize, &'a Column, usize),
    Words(usize, usize, &'a [Layer]),
}

/// A line of the table for every pile.
pub(super) fn piles(plan: &Plan) -> Vec<String> {
    let line = |(number, column): (usize, &Column)| {
        let folds = |angle: u16| {
            let above = column.layers.iter().filter_map(|layer| layer.above);
            above.filter(|mounted| mounted.opening_deg == angle).count()
        };
        let (hinged, bridges) = (
            column.layers.iter().filter(|layer| layer.above.is_some()).count(),
            column.layers.iter().map(|layer| layer.bridges.len()).sum::<usize>(),
        );
        let [i, j] = column.cell;
        let mut line = format!("<tr><td class=\"n\">{number}</td><td>({i},{j})</td>");
        let breaks = column.layers.len().saturating_sub(1 + hinged);
        for count in [column.layers.len(), folds(90), folds(180), folds(270), breaks, bridges] {
            let _infallible = write!(line, "<td class=\"n\">{count}</td>");
        }
        line + "</tr>\n"
    };
    Sequence::of(plan).columns.iter().enumerate().map(line).collect()
}

/// The table with some of its lines.
pub(super) fn pile_table(lines: &[String]) -> String {
    let heads = ["panels", "open to 90°", "to 180°", "to 270°", "breaks", "bridge ends"];
    let heads: Vec<_> = heads.iter().map(|head| format!("<th class=\"n\">{head}</th>")).collect();
    format!(
        "<table><tr><th class=\"n\">pile</th><th>cell</th>{}</tr>\n{}</table>",
        heads.concat(),
        lines.concat()
    )
}

/// The coded sequence, page by page.
pub(super) fn pages(plan: &Plan) -> Vec<String> {
    let sequence = Sequence::of(plan);
    let mut rows = Vec::new();
    for (pile, column) in sequence.columns.iter().enumerate() {
        let words = column.layers.chunks(COLUMNS).enumerate();
        let words = words.map(|(row, layers)| Row::Words(pile, row * COLUMNS, layers));
        rows.push(Row::Pile(pile, column, 0));
        for row in words {
            // A page that begins within a pile says which.
            if rows.len() % ROWS == 0
                && let Row::Words(_, height, _) = row
            {
                rows.push(Row::Pile(pile, column, height));
            }
            rows.push(row);
        }
    }
    rows.chunks(ROWS).map(|rows| page(plan, rows)).collect()
}

fn page(plan: &Plan, rows: &[Row<'_>]) -> String {
    let mut html = "<div class=\"rows\">".to_owned();
    for row in rows {
        let _infallible = match row {
            Row::Pile(pile, column, height) => {
                let [i, j] = column.cell;
                writeln!(html, "<h3>Pile {pile}, cell ({i},{j}), from height {height}</h3>")
            }
            Row::Words(pile, first, layers) => {
                let top = plan.height();
                for (step, layer) in layers.iter().enumerate() {
                    let height = first + step;
                    let number = plan.piles[*pile].panels[height];
                    let _infallible =
                        write!(html, "<span><b>{number}</b>{}</span>", word(layer, height + 1 == top));
                }
                // The grid wants whole rows.
                let _infallible = write!(html, "{}", "<span></span>".repeat(COLUMNS - layers.len()));
                writeln!(html)
            }
        };
    }
    html + "</div>"
}

/// The word of a panel, as the coded sequence has it.
fn word(layer: &Layer, is_top: bool) -> String {
    let mut word = if layer.root { "*".to_owned() } else { String::new() };
    for bridge in &layer.bridges {
        let _infallible = write!(word, "[{bridge}]");
    }
    match layer.above {
        Some(mounted) => word + &mounted.to_string(),
        None => word + if is_top { "." } else { "/" },
    }
}
