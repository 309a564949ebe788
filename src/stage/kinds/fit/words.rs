//! What is said of a fit.
//!
//! Must not know: how it was found.

use super::parameters::Parameter;
use super::search::Found;
use super::tables::ParameterRow;
use declare::number::{significant, with_unit};
use gearmesh::optimize::least_squares::End;
use gearmesh::optimize::least_squares::uncertainty::Uncertainty;

/// A sentence or several, and whether somebody should hear them.
pub struct Said {
    pub text: String,
    pub is_warning: bool,
}

/// `1 value`, `3 values`.
pub fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// A direction in which nothing changes: `bore + 1 mm, torque − 3 N m`; empty where there is none.
pub fn flat(parameters: &[Parameter], uncertainty: &Uncertainty) -> String {
    let Some(direction) = &uncertainty.flat else { return String::new() };
    // What counts of a change is its share of what is allowed.
    let share = |(parameter, part): &(&Parameter, &f64)| (*part / (parameter.bounds.1 - parameter.bounds.0)).abs();
    let parts: Vec<(&Parameter, &f64)> = parameters.iter().zip(direction).collect();
    let least = 1e-3 * parts.iter().map(share).fold(0.0, f64::max);
    let change = |parameter: &Parameter, part: f64| parameter.shown(part) - parameter.shown(0.0);
    let moved: Vec<(&Parameter, f64)> =
        parts.into_iter().filter(|part| share(part) > least).map(|(one, part)| (one, change(one, *part))).collect();
    // Beside a change of the first by one of its units.
    let unit = moved.first().map_or(1.0, |(_, part)| *part);
    let said = moved.iter().map(|(parameter, part)| {
        let change = part / unit;
        let sign = if change < 0.0 { '−' } else { '+' };
        format!("{} {sign} {}", parameter.name, with_unit(&significant(change.abs(), 3), &parameter.unit))
    });
    said.collect::<Vec<_>>().join(", ")
}

/// How many solutions there are, and what is wrong with the best. `refused` is why values beyond the best are refused.
pub fn said(found: &Found, parameters: &[ParameterRow], flat: &str, refused: &str) -> Said {
    let best = &found.solutions[0];
    let meeting = found.meeting();
    let mut sentences = vec![match meeting {
        // Searches from some starts do not exclude that values elsewhere meet all.
        0 => format!(
            "no search ended at values that meet all within their tolerances; the nearest leave one {} tolerances off",
            significant(best.largest(), 3)
        ),
        1 if flat.is_empty() => "one solution meets all within their tolerances".to_owned(),
        1 => {
            "solutions meet all within their tolerances, as many as there are along a direction that nothing determines"
                .to_owned()
        }
        several => format!("{several} different solutions meet all within their tolerances"),
    }];
    let mut is_warning = meeting != 1;
    if !flat.is_empty() {
        is_warning = true;
        sentences.push(format!("nothing that is met changes along {flat}"));
    }
    for row in parameters.iter().filter(|row| row.is_held) {
        is_warning = true;
        let at = with_unit(&significant(row.value, 6), &row.parameter.unit);
        sentences.push(format!("`{}` is held at its bound, {at}", row.parameter.name));
    }
    if best.is_at_edge() {
        is_warning = true;
        let why = if refused.is_empty() { String::new() } else { format!(", which is refused: {refused}") };
        sentences
            .push(format!("the best lies at the edge of the valid values; the residuals would fall beyond it{why}"));
    }
    if best.fit.end == End::Stopped {
        is_warning = true;
        sentences.push(
            "its search stopped at refused values: whether other values beside them are nearer is not known".to_owned(),
        );
    } else if !best.is_settled() {
        is_warning = true;
        sentences.push(format!("the best has not settled after {}", count(best.fit.steps, "step")));
    }
    if found.without > 0 {
        sentences.push(format!("{} had no numbers", count(found.without, "start")));
    }
    Said { text: sentences.join("; "), is_warning }
}
