//! Start and interval of the samples in the header of a table without times, as Rigol's oscilloscopes write it:
//!
//! ```text
//! X,CH1,Start,Increment          CH1V,t0 =-5.0e-03,tInc = 1.0e-06
//! Sequence,Volt,-1.2e-03,2e-06   0.04
//! 0,0.04                         0.08
//! ```

use super::rows::number;

/// Lines in which it is looked for.
const HEAD: usize = 50;

/// Start and interval in s that the head of `text` states.
pub(super) fn stated(text: &str) -> Option<[f64; 2]> {
    let mut lines = text.lines().take(HEAD).filter(|line| !line.trim().is_empty()).peekable();
    while let Some(line) = lines.next() {
        let names = cells(line);
        let below = lines.peek().map(|line| cells(line)).unwrap_or_default();
        let below_heading = |name: &str| {
            let place = names.iter().position(|cell| cell.eq_ignore_ascii_case(name))?;
            number(below.get(place)?)
        };
        let after_equals = |name: &str| {
            let mut parts = names.iter().filter_map(|cell| cell.split_once('='));
            let (_, value) = parts.find(|(of, _)| of.trim().eq_ignore_ascii_case(name))?;
            number(value.trim().trim_end_matches(['s', 'S']).trim_end())
        };
        let found = below_heading("start")
            .zip(below_heading("increment"))
            .or_else(|| after_equals("t0").zip(after_equals("tinc")));
        if let Some((start, interval)) = found.filter(|(t, dt)| t.is_finite() && dt.is_finite() && *dt > 0.0)
        {
            return Some([start, interval]);
        }
    }
    None
}

/// The cells of a line, separated by commas, semicolons or tabs.
fn cells(line: &str) -> Vec<&str> {
    line.split([',', ';', '\t']).map(|cell| cell.trim().trim_matches('"').trim()).collect()
}

#[cfg(test)]
mod tests {
    use super::stated;
    use crate::columns::{Map, read};
    use crate::kinds::KINDS;

    #[test]
    fn start_and_interval_are_found() {
        for text in [
            "X,CH1,Start,Increment\nSequence,Volt,-1.2e-03,2e-06\n0,0.04\n1,0.08\n",
            "X,CH1,CH2,Start,Increment,\r\nSequence,Volt,Volt,-1.200000e-03,2.000000e-06\r\n0,1,2,\r\n",
            "CH1V,CH2V,t0 = -1.2e-03, tInc = 2e-06,\n0.1,0.2,\n",
            "\"Start\";\"Increment\"\n-0.0012;0.000002\n",
        ] {
            assert_eq!(stated(text), Some([-1.2e-3, 2e-6]), "{text}");
        }
        for text in [
            "X,CH1,Start,Increment\nSequence,Volt,-1.2e-03,0\n0,0.04\n",
            "X,CH1,Start,Increment\nSequence,Volt\n0,0.04\n",
            "start,increment\nof,all\n0,1\n1,2\n",
            "time,t0=3\n0,1\n",
        ] {
            assert_eq!(stated(text), None, "{text}");
        }
    }

    /// Both forms give times, and the numbers of the rows none; a map may name the curves, or other times.
    #[test]
    fn tables_without_times_are_read_by_their_header() {
        let known: Vec<_> = KINDS.iter().flat_map(|kind| kind.curves()).cloned().collect();
        let rows = |of: fn(u32) -> String| (0..40).map(of).collect::<String>();
        let numbered = rows(|k| format!("{k},{}.0,{}.0,\n", 2 * k, 3 * k));
        let plain = rows(|k| format!("{}.0,\n", 2 * k));
        let map = "[columns]\nouter_velocity = { column = \"CH1\", sensitivity = \"1 m/s/V\" }\n";
        for (text, map) in [
            (format!("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1e-4,5e-7\n{numbered}"), map),
            (
                format!(
                    "X,outer_velocity,inner_velocity,Start,Increment,\nSequence,m/s,m/s,-1e-4,5e-7\n{numbered}"
                ),
                "",
            ),
            (format!("outer_velocity [m/s],t0 = -1e-4,tInc = 5e-7,\n{plain}"), ""),
        ] {
            let found = read(&text, &Map::parse(map).expect("a map"), &known, 32).expect("a record");
            assert!((found.columns.time[10] + 95e-6).abs() < 1e-15, "{:?}", found.columns.time);
            assert_eq!(found.columns.values[0].1[10], 20.0);
            let how = found.how.expect("inferred");
            assert!(how.contains("start −100.0 µs and interval 0.5000 µs from the header"), "{how}");
            // the header is read again by the map that comes with it
            let again = read(&text, &Map::parse(&found.map).expect("a map"), &known, 32).expect("a record");
            assert_eq!(again.columns, found.columns, "{}", found.map);
        }
        let text = format!("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1e-4,5e-7\n{numbered}");
        for (map, time) in [
            ("[time]\ninterval = \"1 us\"\n", 10e-6),
            ("[columns]\ntime = { column = 1, unit = \"ms\" }\n", 10e-3),
        ] {
            let columns = if map.contains("[columns]") { "" } else { "[columns]\n" };
            let map = format!(
                "{map}{columns}outer_velocity = {{ column = 2 , unit = \"V\", sensitivity = \"1 m/s/V\" }}\n"
            );
            let found = read(&text, &Map::parse(&map).expect("a map"), &known, 32).expect("a record");
            assert!((found.columns.time[10] - time).abs() < 1e-15, "{map}: {:?}", found.columns.time[10]);
        }
    }
}
