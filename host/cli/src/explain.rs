//! `zygote explain`: what a refusal or fault code means, is the position still trusted, and what to do.

use crate::failure::Failure;
use crate::output::say;
use anyhow::anyhow;
use clap::Args;
use serde_json::{Value, json};
use zygote_protocol::{Explanation, FaultCode, RefusalCode};

/// Arguments of `zygote explain`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The code, as F12 or R17; without it, a line for each
    #[arg(value_name = "CODE")]
    code: Option<String>,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

/// A code of either kind, with its text.
struct Entry {
    code: String,
    name: String,
    text: Explanation,
}

impl Entry {
    fn json(&self) -> Value {
        json!({
            "code": self.code,
            "name": self.name,
            "meaning": self.text.meaning,
            "numbers": self.text.numbers,
            "position_trusted": self.text.position,
            "what_to_do": self.text.remedy,
        })
    }

    fn page(&self) -> String {
        let Explanation { meaning, numbers, position, remedy } = self.text;
        let title = format!("{} {}: {meaning}", self.code, self.name);
        let numbers =
            if numbers.is_empty() { String::new() } else { format!("\nits numbers:       {numbers}") };
        format!("{title}{numbers}\nposition trusted:  {position}\nwhat to do:        {remedy}")
    }
}

/// Every code: refusals, then faults.
fn entries() -> impl Iterator<Item = Entry> {
    let refusals = RefusalCode::ALL.iter().map(|code| Entry {
        code: format!("{}{:02}", RefusalCode::LETTER, code.number()),
        name: format!("{code:?}"),
        text: code.explanation(),
    });
    let faults = FaultCode::ALL.iter().map(|code| Entry {
        code: format!("{}{:02}", FaultCode::LETTER, code.number()),
        name: format!("{code:?}"),
        text: code.explanation(),
    });
    refusals.chain(faults)
}

/// The entry of a code as people write it: `F06`, `f6`.
fn find(code: &str) -> Option<Entry> {
    let mut letters = code.chars();
    let letter = letters.next()?.to_ascii_uppercase();
    let number: u16 = letters.as_str().parse().ok()?;
    entries().find(|entry| entry.code == format!("{letter}{number:02}"))
}

/// Prints one code, or all.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(code) = &arguments.code else {
        if arguments.json {
            say(format_args!("{:#}", entries().map(|entry| entry.json()).collect::<Value>()));
        } else {
            entries()
                .for_each(|entry| say(format_args!("{} {}: {}", entry.code, entry.name, entry.text.meaning)));
        }
        return Ok(());
    };
    let entry = find(code).ok_or_else(|| {
        let (refusals, faults) = (RefusalCode::ALL.len(), FaultCode::ALL.len());
        Failure::BadInput(anyhow!(
            "{code}: no such code; there are R01 to R{refusals:02} and F01 to F{faults:02}"
        ))
    })?;
    if arguments.json {
        say(format_args!("{:#}", entry.json()));
    } else {
        say(entry.page());
    }
    Ok(())
}

#[cfg(test)]
mod checks {
    use super::*;

    #[test]
    fn a_code_is_found_however_it_is_written() {
        for written in ["F12", "f12", "F012"] {
            assert_eq!(find(written).map(|entry| entry.name).as_deref(), Some("UnexpectedHeat"), "{written}");
        }
        assert_eq!(find("R1").map(|entry| entry.name).as_deref(), Some("WrongState"));
    }

    #[test]
    fn what_is_no_code_is_not_found() {
        for written in ["", "F", "F0", "F99", "12", "X1", "F-1", "\u{e9}1"] {
            assert!(find(written).is_none(), "{written}");
        }
    }

    #[test]
    fn the_page_of_a_fault_tells_meaning_position_and_remedy() {
        let page = find("F12").map(|entry| entry.page()).unwrap_or_default();
        let text = FaultCode::UnexpectedHeat.explanation();
        for part in [text.meaning, text.numbers, text.position, text.remedy] {
            assert!(page.contains(part), "{page}");
        }
    }
}
