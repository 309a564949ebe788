//! Modifications of flanks (from 1.2 on): those that a study has a family for. Must not know: the text of a study.

use super::around::Remarks;
use super::model::{Component, Model, Said};
use super::ways::LENGTHS;

/// A family of a study, and its fields, each with its value and unit.
pub(super) struct Modification {
    pub family: &'static str,
    pub fields: Vec<(&'static str, Said)>,
    /// The curve of a relief.
    pub curve: Option<&'static str>,
}

/// Kinds of components that a flank refers to and that are modifications.
const KINDS: [&str; 13] = [
    "tip_relief",
    "root_relief",
    "profile_crowning",
    "helix_crowning",
    "end_relief_datum_face",
    "end_relief_non_datum_face",
    "helix_deviation",
    "helix_slope",
    "profile_deviation",
    "profile_slope",
    "profile_twist",
    "triangular_tip_relief",
    "triangular_root_relief",
];

/// How near two circles are one \[mm\].
const SAME: f64 = 1e-3;

/// The modifications that all flanks of a gear have alike; every other one is named.
pub(super) fn modifications<'a>(
    model: &'a Model,
    flanks: &[&'a Component],
    tip_diameter: Option<Said>,
    remarks: &mut Remarks<'a>,
) -> Vec<Modification> {
    let of = |flank: &Component| -> Vec<&'a Component> {
        let found = model.related(&["reference"], &flank.id, "origin", &["referenced"]);
        let found = found.into_iter().map(|(component, _)| component);
        found
            .filter(|component| KINDS.contains(&component.kind.as_str()) || component.kind.contains("modification"))
            .collect()
    };
    let of_flanks: Vec<Vec<&Component>> = flanks.iter().map(|flank| of(flank)).collect();
    let all: Vec<&Component> = of_flanks.iter().flatten().copied().collect();
    remarks.concern(all.iter().copied());
    let mut read = Vec::new();
    let mut kinds: Vec<&str> = all.iter().map(|component| component.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds {
        let alike: Vec<&Component> = all.iter().copied().filter(|component| component.kind == kind).collect();
        let is_one_each =
            of_flanks.iter().all(|list| list.iter().filter(|component| component.kind == kind).count() == 1);
        let found: Option<Vec<Modification>> = alike.iter().map(|one| modification(one, tip_diameter)).collect();
        match found {
            Some(mut found) if is_one_each && found.windows(2).all(|two| two[0].is_same(&two[1])) => {
                read.extend(found.pop());
            }
            _ => {
                for component in &alike {
                    component.is_not_supported();
                }
                let ids: Vec<&str> = alike.iter().map(|component| component.id.as_str()).collect();
                remarks.notes.push(
                    format!("Not supported as it is: the {kind} {}.", ids.join(" and ")).escape_debug().to_string(),
                );
            }
        }
    }
    read
}

fn modification(component: &Component, tip_diameter: Option<Said>) -> Option<Modification> {
    let number = |name: &str| component.number(name, LENGTHS).ok().flatten();
    match component.kind.as_str() {
        "tip_relief" => relief(component, "tip_relief", tip_diameter),
        "root_relief" => relief(component, "root_relief", None),
        "profile_crowning" => {
            let amount = same(number("profile_crowning_at_root")?, number("profile_crowning_at_tip")?)?;
            crowning(component, "profile_crowning", "shape_of_profile_crowning", amount)
        }
        "helix_crowning" => {
            let [datum, other] =
                ["helix_crowning_amount_datum_face", "helix_crowning_amount_non_datum_face"].map(number);
            crowning(component, "lead_crowning", "shape_of_helix_crowning", same(datum?, other?)?)
        }
        _ => None,
    }
}

fn crowning(component: &Component, family: &'static str, shape: &str, amount: Said) -> Option<Modification> {
    // A circle and a parabola of some micrometres are one.
    let is_parabola = component.word(shape).is_none_or(|shape| ["parabolic", "circular"].contains(&shape));
    is_parabola.then(|| Modification { family, fields: vec![("amount", amount)], curve: None })
}

fn relief(component: &Component, family: &'static str, end: Option<Said>) -> Option<Modification> {
    let number = |name: &str| component.number(&format!("{family}_{name}"), LENGTHS).ok().flatten();
    let depth = number("depth")?;
    let start = match number("datum_diameter") {
        Some(diameter) => {
            component.follows(&format!("{family}_datum_length"));
            ("start_diameter", diameter)
        }
        None => ("length", number("datum_length")?),
    };
    // The amount of a study is that at the end of the flank.
    if let Some(reference) = number("evaluation_reference") {
        end.filter(|end| (end.value - reference.value).abs() < SAME)?;
    }
    let is_tangential = component.word("specify_tangential_transition").is_some_and(|word| word == "true");
    let curve = match component.word("shape_of_relief") {
        None | Some("linear") => None,
        Some("parabolic") => Some("power, exponent: 2"),
        Some(_) => return None,
    };
    (!is_tangential).then(|| Modification { family, fields: vec![("amount", depth), start], curve })
}

fn same(one: Said, other: Said) -> Option<Said> {
    ((one.value - other.value).abs() <= 1e-9 * one.value.abs()).then_some(one)
}

impl Modification {
    fn is_same(&self, other: &Self) -> bool {
        let fields = self.fields.iter().zip(&other.fields);
        self.curve == other.curve
            && fields.into_iter().all(|(one, other)| one.0 == other.0 && same(one.1, other.1).is_some())
    }
}
