//! Run times, and the time of the run, in the report's files: the only things in them that differ from run to run and from
//! machine to machine.

use maud::{Markup, html};

/// What stands before a run time on a page, and what ends it.
const MARK: [&str; 2] = ["<span class=\"run-time\">", "</span>"];
/// The keys of run times, and of the time of the run, in a JSON document.
const KEYS: [&str; 2] = ["\"solve_seconds\":", "\"compared\":"];

/// A run time on a page.
pub(crate) fn marked(time: &str) -> Markup {
    html! { span class="run-time" { (time) } }
}

/// Whether two versions of a file say the same, run times aside.
pub(crate) fn same_but_for_run_times(one: &[u8], other: &[u8]) -> bool {
    one == other
        || match (std::str::from_utf8(one), std::str::from_utf8(other)) {
            (Ok(one), Ok(other)) => without(one) == without(other),
            _ => false,
        }
}

/// The text with its run times left out.
fn without(text: &str) -> String {
    let mut rest = text;
    let mut rest_of_text = String::with_capacity(text.len());
    loop {
        let keys = KEYS.iter().filter_map(|key| Some(rest.find(key)? + key.len()));
        let mark = rest.find(MARK[0]).map(|at| at + MARK[0].len());
        let Some(start) = keys.chain(mark).min() else { break };
        let (before, after) = rest.split_at(start);
        rest_of_text += before;
        let length = match Some(start) == mark {
            true => after.find(MARK[1]),
            // a number ends where the next member or the object's end begins
            false => after.find([',', '}', '\n']),
        };
        rest = &after[length.unwrap_or(0)..];
    }
    rest_of_text + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_run_times_may_differ() {
        let same = |one: &str, other: &str| same_but_for_run_times(one.as_bytes(), other.as_bytes());
        let page = |time: &str, efficiency: &str| {
            let seconds = time.trim_end_matches(" s");
            format!(
                "<p>in {} and {}</p>{{\"solve_seconds\": {seconds},\n\"efficiency\": {efficiency},\"solve_seconds\":{seconds}}}",
                marked(time).into_string(),
                marked(time).into_string()
            )
        };
        assert!(same(&page("0.1 s", "0.7"), &page("1.25e-4 s", "0.7")));
        assert!(!same(&page("0.1 s", "0.7"), &page("0.1 s", "0.71")));
        assert!(!same("{\"steps\": 1}", "{\"steps\": 2}"));
        assert!(!same("\"solve_seconds\": 1,\"a\": 1", "\"solve_seconds\": 1"), "nothing else is left out");
        assert!(!same_but_for_run_times(&[0xff, 1], &[0xff, 2]), "pictures");
    }
}
