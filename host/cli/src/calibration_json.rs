//! What was calibrated, as one JSON document: numbers in their units, and what is unlike the other hinges.

use crate::board_calibrations::Taught;
use crate::calibration_table::{COLUMNS, key, outliers};
use serde_json::{Map, Value, json};
use std::path::Path;
use zygote_calibration::Quantity;
use zygote_deployment::{Calibrated, CalibratedAt, CalibratedHinge, CalibrationError};

/// The document, with what the board was told to keep, if that could be told. The files are those of calibration, records and page.
pub(crate) fn document(
    rig: &str,
    board: &CalibratedAt,
    hinges: &[CalibratedHinge],
    taught: Option<&Taught>,
    [calibration, records, report]: [&Path; 3],
) -> Result<Value, CalibrationError> {
    let unlike = COLUMNS.map(|(quantity, _)| (quantity, outliers(hinges, quantity)));
    let told = hinges.iter().map(|hinge| {
        let unlike: Vec<String> = unlike
            .iter()
            .filter(|(_, hinges)| hinges.contains(&hinge.hinge))
            .map(|(quantity, _)| key(*quantity))
            .collect();
        of_hinge(hinge, &unlike)
    });
    Ok(json!({
        "rig": rig,
        "board": board.board,
        "unique_id": board.unique_id,
        "hinges": told.collect::<Result<Vec<_>, _>>()?,
        "board_keeps": taught,
        "files": { "calibration": calibration, "records": records, "report": report },
    }))
}

fn of_hinge(hinge: &CalibratedHinge, unlike: &[String]) -> Result<Value, CalibrationError> {
    let mut values = Map::new();
    for quantity in Quantity::ALL {
        let unit = quantity.ascii_unit();
        let value = match (hinge.interval(&quantity.key(), &unit)?, hinge.values.get(&quantity.key())) {
            (Some([value, low, high]), _) => {
                json!({ "value": value, "low": low, "high": high, "unit": unit })
            }
            (None, Some(Calibrated::Unknown { unknown })) => json!({ "unknown": unknown }),
            (None, _) => continue,
        };
        values.insert(quantity.key(), value);
    }
    Ok(json!({
        "hinge": hinge.hinge,
        "channel": hinge.channel,
        "date": hinge.date,
        "firmware": hinge.firmware,
        "verdict": hinge.verdict,
        "why": hinge.why,
        "ambient": hinge.ambient,
        "residuals": hinge.residuals,
        "values": values,
        "servo": hinge.servo,
        "unlike_the_others": unlike,
    }))
}
