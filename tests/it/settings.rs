//! Configurations of stages as they would be written in a study.

use std::path::Path;

use serde_json::json;

use gearstudy::program::load_text;
use studygraph::study::settings::Shown;

#[test]
fn fields_are_shown_as_they_would_be_written() {
    let text = include_str!("../../studies/quick.yaml");
    let study = load_text(text, Path::new("quick.yaml")).unwrap();
    let stage = |name: &str| {
        let node = study.nodes.iter().find(|node| node.name == name).unwrap();
        serde_json::to_value(Shown { fields: node.kind.fields, record: &node.record }).unwrap()
    };
    let pair = stage("pair");
    assert_eq!(pair["module"], "3 mm");
    assert_eq!(pair["material"]["youngs_modulus"], "206 GPa");
    assert_eq!(pair["pinion"]["teeth"], 24);
    let designs = stage("designs");
    assert_eq!(designs["pair"], "pair");
    assert_eq!(designs["designs"]["unmodified"], json!([]));
    assert_eq!(designs["designs"]["long"][1]["lead_crowning"]["amount"], "4 um");
    let optimum = stage("optimum");
    assert_eq!(optimum["design"][0]["tip_relief"]["amount"], json!({ "least": "0 mm", "most": "30 um" }));
    assert_eq!(optimum["method"]["differential_evolution"]["population"], 24);
    assert_eq!(stage("ste")["torque"], json!(["50 N m", "100 N m", "150 N m", "200 N m", "250 N m"]));
    let claim = stage("report");
    assert!(claim["published"][0]["claim"].as_str().is_some_and(|claim| claim.contains("best <= short")));
    assert!(claim["figures"][0]["name"] == "stiffness");
}
