//! Letters of single strokes: cutters follow lines, and what reads their files often has no fonts.

/// A letter stands on a grid so high and so wide; the next one begins one height further.
const HIGH: f64 = 6.0;
const WIDE: f64 = 4.0;

/// Strokes of a letter, parted by blanks; of every point x and y, one digit each. Capitals, digits, blank.
pub(crate) fn glyph(letter: char) -> Option<&'static str> {
    Some(match letter {
        ' ' => "",
        '0' => "0040460600 0046",
        '1' => "152620 1030",
        '2' => "064643030040",
        '3' => "06464000 0343",
        '4' => "060343 4640",
        '5' => "460603434000",
        '6' => "460600404303",
        '7' => "064610",
        '8' => "0040460600 0343",
        '9' => "004046060343",
        'A' => "0004264440 0343",
        'B' => "00063645443303 3342413000",
        'C' => "4536160501103041",
        'D' => "00062644422000",
        'E' => "46060040 0333",
        'F' => "460600 0333",
        'G' => "45361605011030414323",
        'H' => "0006 4046 0343",
        'I' => "1030 2026 1636",
        'L' => "060040",
        'M' => "0006234640",
        'N' => "00064046",
        'O' => "1030414536160501 0110",
        'P' => "0006464303",
        'R' => "0006464303 2340",
        'S' => "45361605044241301001",
        'T' => "0646 2620",
        'U' => "06004046",
        'V' => "062046",
        'W' => "0610233046",
        'Y' => "062346 2320",
        _ => return None,
    })
}

/// The strokes of a text so high, its foot at `foot` and centred there, turned by quarters of a turn counter-clockwise.
pub(crate) fn strokes(text: &str, height: f64, foot: [f64; 2], quarters: usize) -> Vec<Vec<[f64; 2]>> {
    let unit = height / HIGH;
    let width = text.chars().count().saturating_sub(1) as f64 * height + WIDE * unit;
    let place = |letter: usize, point: &[u8]| {
        let digit = |at: usize| f64::from(point[at].saturating_sub(b'0')) * unit;
        let [x, y] = [letter as f64 * height + digit(0) - width / 2.0, digit(1)];
        let [dx, dy] = match quarters % 4 {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        };
        [foot[0] + dx, foot[1] + dy]
    };
    let mut strokes = Vec::new();
    for (number, letter) in text.chars().enumerate() {
        for stroke in glyph(letter).unwrap_or_default().split_ascii_whitespace() {
            strokes.push(stroke.as_bytes().chunks_exact(2).map(|point| place(number, point)).collect());
        }
    }
    strokes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stay_on_their_grid_and_no_two_look_alike() {
        let letters: Vec<char> =
            ('0'..='9').chain('A'..='Z').filter(|letter| glyph(*letter).is_some()).collect();
        for (number, letter) in letters.iter().enumerate() {
            let strokes = glyph(*letter).unwrap();
            assert!(!strokes.is_empty());
            for stroke in strokes.split(' ') {
                assert!(stroke.len() >= 4 && stroke.len() % 2 == 0, "{letter}: {stroke}");
                let digits: Vec<u32> = stroke.chars().map(|digit| digit.to_digit(10).unwrap()).collect();
                assert!(digits.chunks(2).all(|point| point[0] <= 4 && point[1] <= 6), "{letter}: {stroke}");
            }
            assert!(letters[..number].iter().all(|other| glyph(*other) != Some(strokes)), "{letter}");
        }
    }

    #[test]
    fn a_text_is_centred_on_its_foot_whichever_way_it_is_turned() {
        for quarters in 0..4 {
            let points = strokes("NMN", 6.0, [10.0, 20.0], quarters).concat();
            let bounds = [0, 1].map(|axis| {
                let values = || points.iter().map(|point| point[axis]);
                [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)]
            });
            let expected = [
                [[2.0, 18.0], [20.0, 26.0]],
                [[4.0, 10.0], [12.0, 28.0]],
                [[2.0, 18.0], [14.0, 20.0]],
                [[10.0, 16.0], [12.0, 28.0]],
            ][quarters];
            assert_eq!(bounds, expected, "{quarters}");
        }
    }
}
