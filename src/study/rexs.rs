//! An existing gear pair from REXS, the gear industry's exchange format, as the text of a study's geometry.
//!
//! Source: FVA GmbH, REXS 1.0 to 2.0: the schema of files (`rexs-file.xsd`) and the lists of components, attributes and
//! relations (`rexs_schema_*.xml`) in the reference implementation `fva-net/rexs-api-java`, under Apache-2.0. A stage
//! relates two gears, a flank relation their flanks, a manufacturing step the tool, a reference the material. What the file
//! does not say is left out and named, never invented; what a spur gear pair cannot have is refused. The file may come from
//! anybody: its size and its elements are limited, its depth needs no stack (the parser
//! has a counter), and a document type, which entities come from, is refused.
//! Must not know: stages that are run, files.

use std::fmt;

use roxmltree::{Document, Node, ParsingOptions};

/// Largest file that is read \[bytes\].
pub const MOST_BYTES: usize = 64 << 20;
const MOST_NODES: u32 = 4_000_000;

/// Why a file cannot be used, in one sentence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

fn refuse<T>(message: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal(message.into()))
}

/// The text of a study whose one stage is the geometry of a cylindrical stage in `xml`; `stage` is its id, needed where
/// there are several.
///
/// # Errors
/// A sentence that says what is wrong with the file, or with the pair.
pub fn geometry(xml: &str, stage: Option<&str>) -> Result<String, Refusal> {
    if xml.len() > MOST_BYTES {
        return refuse(format!("the file is larger than {} MiB", MOST_BYTES >> 20));
    }
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(xml, options).map_err(|error| match error {
        roxmltree::Error::DtdDetected => Refusal("it has a document type, which files of REXS have not".to_owned()),
        roxmltree::Error::NodesLimitReached => Refusal(format!("it has more than {MOST_NODES} elements")),
        other => Refusal(format!("it is not XML: {other}")),
    })?;
    let root = document.root_element();
    if !root.has_tag_name("model") {
        return refuse(format!(
            "it is no REXS file: its outermost element is `{}`, not `model`",
            root.tag_name().name()
        ));
    }
    let model = Model { root };
    let relation = model.stage(stage)?;
    Pair::read(&model, relation)?.text(root.attribute("version").unwrap_or("unknown"))
}

/// The outermost element of a file.
struct Model<'a> {
    root: Node<'a, 'a>,
}

/// A component with attributes.
#[derive(Clone, Copy)]
struct Component<'a>(Node<'a, 'a>);

impl<'a> Model<'a> {
    fn inside(&self, list: &'static str, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + use<'a> {
        let lists = self.root.children().filter(move |node| node.has_tag_name(list));
        lists.flat_map(move |list| list.children().filter(move |node| node.has_tag_name(name)))
    }

    fn component(&self, id: &str) -> Option<Component<'a>> {
        self.inside("components", "component").find(|node| node.attribute("id") == Some(id)).map(Component)
    }

    /// What stands in the role `wanted` of the relations of a type in which a component has the role `role`.
    fn related(&self, kind: &str, role: &str, id: &str, wanted: &str) -> Vec<Component<'a>> {
        let relations = self.inside("relations", "relation").filter(|node| node.attribute("type") == Some(kind));
        let found = relations.filter(|relation| in_role(*relation, role) == Some(id));
        found.filter_map(|relation| self.component(in_role(relation, wanted)?)).collect()
    }

    /// The relation of the cylindrical stage that is meant.
    fn stage(&self, wanted: Option<&str>) -> Result<Node<'a, 'a>, Refusal> {
        let is_cylindrical = |relation: &Node<'a, 'a>| {
            let stage = in_role(*relation, "stage").and_then(|id| self.component(id));
            relation.attribute("type") == Some("stage")
                && stage.is_some_and(|stage| stage.kind() == "cylindrical_stage")
        };
        let stages: Vec<Node<'a, 'a>> = self.inside("relations", "relation").filter(is_cylindrical).collect();
        let ids: Vec<&str> = stages.iter().filter_map(|relation| in_role(*relation, "stage")).collect();
        match (wanted, stages.as_slice()) {
            (_, []) => refuse("it has no stage of two cylindrical gears"),
            (None, [one]) => Ok(*one),
            (None, _) => refuse(format!("it has {} cylindrical stages; name one of {}", ids.len(), ids.join(", "))),
            (Some(id), _) => match stages.iter().find(|relation| in_role(**relation, "stage") == Some(id)) {
                Some(found) => Ok(*found),
                None => refuse(format!("it has no cylindrical stage `{id}`; it has {}", ids.join(", "))),
            },
        }
    }
}

/// The id that a relation has in a role.
fn in_role<'a>(relation: Node<'a, 'a>, role: &str) -> Option<&'a str> {
    relation.children().find(|node| node.has_tag_name("ref") && node.attribute("role") == Some(role))?.attribute("id")
}

impl<'a> Component<'a> {
    fn id(self) -> &'a str {
        self.0.attribute("id").unwrap_or("")
    }

    fn kind(self) -> &'a str {
        self.0.attribute("type").unwrap_or("")
    }

    /// A number in one of these units; none when it is not given.
    fn number(self, name: &str, units: &[&str]) -> Result<Option<f64>, Refusal> {
        let is_meant = |node: &Node| node.has_tag_name("attribute") && node.attribute("id") == Some(name);
        let Some(attribute) = self.0.children().find(is_meant) else { return Ok(None) };
        let (kind, id) = (self.kind(), self.id());
        let unit = attribute.attribute("unit").unwrap_or("");
        if !units.contains(&unit) {
            return refuse(format!("`{name}` of the {kind} {id} is in `{unit}`, not in {}", units[0]));
        }
        let text = attribute.text().unwrap_or("").trim();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => refuse(format!("`{name}` of the {kind} {id} is `{}`, which is no number", text.escape_debug())),
        }
    }
}

const MILLIMETRES: &[&str] = &["mm"];
const DEGREES: &[&str] = &["deg", "°"];
const PLAIN: &[&str] = &["none", "", "-"];
const MEGAPASCALS: &[&str] = &["MPa", "N / mm^2", "N/mm^2"];

/// A gear as far as a file says it; lengths in mm, as they are shown.
struct Gear {
    teeth: u32,
    module: f64,
    pressure_angle: Option<f64>,
    shift: Option<f64>,
    width: Option<f64>,
    tip_diameter: Option<f64>,
    bore_diameter: Option<f64>,
    /// In modules, from the tool or from the root circle.
    dedendum: Option<f64>,
    addendum: Option<f64>,
    rack_tip_radius: Option<f64>,
    youngs_modulus: Option<f64>,
    poisson_ratio: Option<f64>,
}

/// The one value that several components give.
fn agreed<'a>(
    components: impl Iterator<Item = Component<'a>>,
    name: &str,
    units: &[&str],
) -> Result<Option<f64>, Refusal> {
    let mut found: Option<(f64, &str)> = None;
    for component in components {
        let Some(value) = component.number(name, units)? else { continue };
        match found {
            Some((other, id)) if (other - value).abs() > 1e-12 * value.abs() => {
                return refuse(format!(
                    "`{name}` is {other} of the component {id} and {value} of {}; both flanks of a gear must be alike",
                    component.id()
                ));
            }
            _ => found = Some((value, component.id())),
        }
    }
    Ok(found.map(|(value, _)| value))
}

impl Gear {
    fn read(model: &Model, gear: Component) -> Result<Self, Refusal> {
        let id = gear.id();
        if gear.kind() != "cylindrical_gear" {
            return refuse(format!(
                "the component {id} is a {}; only external cylindrical gears can be read",
                gear.kind()
            ));
        }
        let needed = |value: Option<f64>, name: &str| match value {
            Some(value) => Ok(value),
            None => refuse(format!("the cylindrical_gear {id} has no `{name}`")),
        };
        let module = needed(gear.number("normal_module", MILLIMETRES)?, "normal_module")?;
        let teeth = needed(gear.number("number_of_teeth", PLAIN)?, "number_of_teeth")?;
        if !(teeth.fract() == 0.0 && (1.0..=1e6).contains(&teeth)) {
            return refuse(format!(
                "the cylindrical_gear {id} has {teeth} teeth; only whole external gears can be read"
            ));
        }
        if module <= 0.0 {
            return refuse(format!("the cylindrical_gear {id} has a module of {module} mm"));
        }
        let helix = gear.number("helix_angle_reference_diameter", DEGREES)?.unwrap_or(0.0);
        if helix != 0.0 {
            return refuse(format!(
                "the cylindrical_gear {id} has a helix angle of {helix}°; only spur gears can be read"
            ));
        }
        let flanks: Vec<Component> =
            ["left", "right"].iter().flat_map(|side| model.related("flank", "gear", id, side)).collect();
        let tools: Vec<Component> = flanks
            .iter()
            .flat_map(|flank| model.related("manufacturing_step", "workpiece", flank.id(), "tool"))
            .collect();
        let of_flank = |name, units| agreed(std::iter::once(gear).chain(flanks.iter().copied()), name, units);
        let of_tool =
            |name, units| agreed(tools.iter().copied().filter(|tool| tool.kind() == "rack_shaped_tool"), name, units);
        let materials = model.related("reference", "origin", id, "referenced");
        let of_material = |name, units| {
            agreed(materials.iter().copied().filter(|component| component.kind() == "material"), name, units)
        };
        let shift = of_flank("addendum_modification_coefficient", PLAIN)?;
        let root = gear.number("root_diameter", MILLIMETRES)?;
        // r_f = m(z/2 − h_fP* + x).
        let by_root = root.zip(shift).map(|(root, shift)| 0.5 * teeth + shift - 0.5 * root / module);
        let round = of_tool("tip_radius", MILLIMETRES)?.map(|radius| radius / module);
        Ok(Self {
            // Checked above.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            teeth: teeth as u32,
            module,
            pressure_angle: of_flank("normal_pressure_angle", DEGREES)?,
            shift,
            width: gear.number("face_width", MILLIMETRES)?,
            tip_diameter: gear.number("tip_diameter", MILLIMETRES)?,
            bore_diameter: gear.number("inner_diameter", MILLIMETRES)?.filter(|diameter| *diameter > 0.0),
            // The tool's addendum cuts the gear's dedendum.
            dedendum: of_tool("addendum_coefficient_reference_profile", PLAIN)?.or(by_root),
            addendum: of_flank("addendum_coefficient_basic_profile", PLAIN)?,
            rack_tip_radius: of_tool("tip_radius_factor", PLAIN)?.or(round),
            youngs_modulus: of_material("elastic_modulus", MEGAPASCALS)?,
            poisson_ratio: of_material("poisson_ratio", PLAIN)?,
        })
    }
}

struct Pair {
    stage: String,
    gears: [Gear; 2],
    centre_distance: Option<f64>,
}

impl Pair {
    fn read(model: &Model, relation: Node) -> Result<Self, Refusal> {
        let gear = |role: &str| -> Result<Gear, Refusal> {
            let component = in_role(relation, role).and_then(|id| model.component(id));
            component.map_or_else(|| refuse(format!("the stage has no `{role}`")), |gear| Gear::read(model, gear))
        };
        let id = in_role(relation, "stage").unwrap_or("");
        let centre_distance = match model.component(id) {
            Some(stage) => stage.number("center_distance", MILLIMETRES)?,
            None => None,
        };
        Ok(Self { stage: id.to_owned(), gears: [gear("gear_1")?, gear("gear_2")?], centre_distance })
    }

    /// A value that both gears must have in common; what one of them does not say, the other's stands for.
    fn common(&self, name: &str, get: impl Fn(&Gear) -> Option<f64>) -> Result<Option<f64>, Refusal> {
        match self.gears.each_ref().map(get) {
            [Some(a), Some(b)] if (a - b).abs() > 1e-9 * a.abs().max(b.abs()) => {
                refuse(format!("the gears' {name} differ, {a} and {b}; a pair here has one"))
            }
            [a, b] => Ok(a.or(b)),
        }
    }

    fn text(&self, version: &str) -> Result<String, Refusal> {
        let version: String = version.chars().filter(|c| c.is_ascii_alphanumeric() || *c == '.').take(16).collect();
        let stage: String = self.stage.chars().filter(char::is_ascii_alphanumeric).take(16).collect();
        let mut missing = Vec::new();
        let mut text =
            format!("study: imported\ntitle: Cylindrical stage {stage} of a REXS file\n\nstages:\n  pair:\n");
        text += "    kind: geometry\n";
        let module = self.common("modules", |gear| Some(gear.module))?.unwrap_or_default();
        text += &format!("    module: {module} mm\n");
        match self.common("pressure angles", |gear| gear.pressure_angle)? {
            Some(angle) => text += &format!("    pressure_angle: {angle} deg\n"),
            None => missing.push("normal_pressure_angle (20 deg stands for it)".to_owned()),
        }
        let rack = [
            ("addendum", self.common("rack addenda", |gear| gear.addendum)?, "1.0"),
            ("dedendum", self.common("rack dedenda", |gear| gear.dedendum)?, "1.25"),
            ("tip_radius", self.common("rack tip radii", |gear| gear.rack_tip_radius)?, "0.38"),
        ];
        let given: Vec<String> =
            rack.iter().filter_map(|(name, value, _)| value.map(|value| format!("{name}: {value}"))).collect();
        if !given.is_empty() {
            text += &format!("    rack: {{ {} }}\n", given.join(", "));
        }
        let unsaid = rack.iter().filter(|(_, value, _)| value.is_none());
        missing.extend(unsaid.map(|(name, _, usual)| format!("the rack's {name} ({usual} modules stand for it)")));
        for (name, gear) in ["pinion", "gear"].iter().zip(&self.gears) {
            let mut fields = vec![format!("teeth: {}", gear.teeth)];
            let mut put = |field: &str, value: Option<f64>, unit: &str, needed: bool| match value {
                Some(value) => fields.push(format!("{field}: {value}{unit}")),
                None if needed => missing.push(format!("{field} of the {name}, which must be given by hand")),
                None => {}
            };
            put("face_width", gear.width, " mm", true);
            put("bore_radius", gear.bore_diameter.map(|diameter| 0.5 * diameter), " mm", true);
            put("profile_shift", gear.shift, "", false);
            put("tip_radius", gear.tip_diameter.map(|diameter| 0.5 * diameter), " mm", false);
            if gear.shift.is_none() {
                missing.push(format!("addendum_modification_coefficient of the {name} (0 stands for it)"));
            }
            let material: Vec<String> = [
                gear.youngs_modulus.map(|modulus| format!("youngs_modulus: {modulus} MPa")),
                gear.poisson_ratio.map(|ratio| format!("poisson_ratio: {ratio}")),
            ]
            .into_iter()
            .flatten()
            .collect();
            if !material.is_empty() {
                fields.push(format!("material: {{ {} }}", material.join(", ")));
            }
            text += &format!("    {name}: {{ {} }}\n", fields.join(", "));
        }
        if let Some(distance) = self.centre_distance {
            text += &format!("    centre_distance: {distance} mm\n");
        }
        let mut head = format!("# From a file of REXS {version}.\n");
        for what in missing {
            head += &format!("# It does not say: {what}.\n");
        }
        Ok(head + &text)
    }
}
