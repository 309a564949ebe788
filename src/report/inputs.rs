//! Which verdicts only read back what the study states: they say that it was typed in right, and nothing of a result.
//!
//! Must not know: what any field means. A cell is an input where the configuration of its stage has a field of the name of
//! its column, `teeth` or, inside `rack`, `rack_addendum`.

use std::cell::OnceCell;
use std::collections::HashMap;

use serde_json::Value;
use studygraph::store::manifest::{Config, Manifest, StageRecord};

/// Names of fields with a value, by stage; found where somebody asks for a stage.
pub struct Inputs<'a>(HashMap<&'a str, (&'a Config, OnceCell<Vec<String>>)>);

impl<'a> Inputs<'a> {
    #[must_use]
    pub fn of(manifest: &'a Manifest) -> Self {
        let stage = |stage: &'a StageRecord| (stage.name.as_str(), (&stage.config, OnceCell::new()));
        Self(manifest.stages.iter().map(stage).collect())
    }

    /// Whether a cell, `stage.table[…].column`, is one of them.
    #[must_use]
    pub fn has(&self, cell: &str) -> bool {
        let (stage, column) = (cell.split('.').next().unwrap_or_default(), cell.rsplit('.').next().unwrap_or_default());
        let is_cell = cell.split('.').count() > 2 && !cell.contains(' ') || cell.contains('[');
        let names = |(config, known): &'_ (&Config, OnceCell<Vec<String>>)| {
            known.get_or_init(|| fields(config)).iter().any(|field| field == column)
        };
        is_cell && self.0.get(stage).is_some_and(names)
    }
}

fn fields(config: &Config) -> Vec<String> {
    let mut found = Vec::new();
    collect("", &config.value(), &mut found);
    found
}

fn collect(group: &str, config: &Value, found: &mut Vec<String>) {
    let Some(fields) = config.as_object() else { return };
    for (name, value) in fields {
        if value.is_object() {
            collect(name, value, found);
        } else {
            found.push(name.clone());
            if !group.is_empty() {
                found.push(format!("{group}_{name}"));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::collections::BTreeMap;

    #[test]
    fn a_cell_is_an_input_where_its_stage_has_the_field() {
        let config = json!({ "module": "3 mm", "rack": { "addendum": 1.0 }, "pinion": { "teeth": 19 } });
        let stage = StageRecord {
            name: "pair".to_owned(),
            kind: "geometry".to_owned(),
            version: 1,
            keys: Vec::new(),
            config: config.into(),
            status: "ran".to_owned(),
            why: String::new(),
            seconds: 0.0,
            work: BTreeMap::new(),
            warnings: Vec::new(),
            left_out: Vec::new(),
            tables: Vec::new(),
        };
        let manifest = Manifest { stages: vec![stage], ..Manifest::default() };
        let inputs = Inputs::of(&manifest);
        for cell in
            ["pair.gears[gear=pinion].teeth", "pair.gears[gear=gear].module", "pair.gears[gear=gear].rack_addendum"]
        {
            assert!(inputs.has(cell), "{cell}");
        }
        for cell in [
            "pair.gears[gear=pinion].tip_radius",
            "ste.gears[gear=pinion].teeth",
            "pair.pair.contact_ratio",
            "1 - teeth",
        ] {
            assert!(!inputs.has(cell), "{cell}");
        }
    }
}
