//! An existing gear pair from REXS, the gear industry's exchange format, as the text of a study's geometry.
//!
//! Source: FVA GmbH, REXS 1.0 to 2.0: the schema of files (`rexs-file.xsd`) and the lists of components, attributes and
//! relations (`rexs_schema_*.xml`) in the reference implementation `fva-net/rexs-api-java`, under Apache-2.0. A stage
//! relates two gears, a flank relation their flanks, a manufacturing step the tool, a reference the material. What the file
//! does not say is left out and named, never invented; what a spur gear pair cannot have is refused, with line and column
//! of the file: the study that comes out is read, so its own limits hold. The file may come from anybody: its size, its
//! elements and their attributes are limited, its depth needs no stack (the parser has a counter), components and relations
//! are found by id in indices, and a document type, which entities come from, is refused: time goes with the size of the
//! file.
//! Must not know: stages that are run, files.

mod tags;
mod written;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

/// Largest file that is read \[bytes\].
pub const MOST_BYTES: usize = 64 << 20;
const MOST_NODES: u32 = 4_000_000;

/// Most ids in a message.
const MOST_NAMED: usize = 20;

/// Versions of the format that are read.
const VERSIONS: (f64, f64) = (1.0, 2.0);

/// Characters of a message.
const LONGEST_MESSAGE: usize = 500;

/// Why a file cannot be used: a sentence, behind line and column where it is about a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    message: String,
    /// Byte of the file.
    at: Option<usize>,
    /// Line and column, counted from 1.
    place: Option<(u32, u32)>,
}

impl fmt::Display for Refusal {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((line, column)) = self.place {
            write!(formatter, "{line}:{column}: ")?;
        }
        // Names in a file from elsewhere may be as long as the file.
        let mut shown = self.message.chars();
        formatter.write_str(&shown.by_ref().take(LONGEST_MESSAGE).collect::<String>())?;
        if shown.next().is_some() { formatter.write_str(" …") } else { Ok(()) }
    }
}

impl Refusal {
    fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), at: None, place: None }
    }

    /// The sentence behind the file's name.
    #[must_use]
    pub fn in_file(&self, file: &Path) -> String {
        let between = if self.place.is_some() { ":" } else { ": " };
        format!("{}{between}{self}", file.display())
    }

    fn at(mut self, byte: usize) -> Self {
        self.at.get_or_insert(byte);
        self
    }
}

fn refuse<T>(at: Node, message: impl Into<String>) -> Result<T, Refusal> {
    Err(Refusal::new(message).at(at.range().start))
}

/// The text of a study whose one stage is the geometry of a cylindrical stage in `xml`; `stage` is its id, needed where
/// there are several.
///
/// # Errors
/// A sentence that says what is wrong with the file, or with the pair, and where.
pub fn geometry(xml: &str, stage: Option<&str>) -> Result<String, Refusal> {
    if xml.len() > MOST_BYTES {
        return Err(Refusal::new(format!("the file is larger than {} MiB", MOST_BYTES >> 20)));
    }
    tags::check(xml)?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(xml, options).map_err(|error| {
        let place = error.pos();
        let refusal = Refusal::new(match error {
            roxmltree::Error::DtdDetected => "it has a document type, which files of REXS have not".to_owned(),
            roxmltree::Error::NodesLimitReached => format!("it has more than {MOST_NODES} elements"),
            other => format!("it is not XML: {other}"),
        });
        Refusal { place: Some((place.row, place.col)), ..refusal }
    })?;
    read(&document, stage).map_err(|refusal| {
        let place = refusal.at.map(|at| document.text_pos_at(at)).map(|place| (place.row, place.col));
        Refusal { place, ..refusal }
    })
}

fn read(document: &Document, stage: Option<&str>) -> Result<String, Refusal> {
    let root = document.root_element();
    if !root.has_tag_name("model") {
        let name = root.tag_name().name();
        return refuse(root, format!("it is no REXS file: its outermost element is `{name}`, not `model`"));
    }
    let version = root.attribute("version").unwrap_or("");
    let known = version.parse::<f64>().is_ok_and(|version| (VERSIONS.0..=VERSIONS.1).contains(&version));
    if !known {
        let (minimum, maximum) = VERSIONS;
        let shown: String = version.escape_debug().take(16).collect();
        return refuse(
            root,
            format!("its version is `{shown}`; versions {minimum:.1} to {maximum:.1} of REXS can be read"),
        );
    }
    let model = Model::new(root)?;
    let relation = model.stage(stage)?;
    RexsPair::read(&model, relation)?.text(version)
}

/// What relations say: their type, and the role of the component by which they are looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Relation {
    Flanks,
    Tools,
    Materials,
}

const RELATIONS: [(Relation, &str, &str); 3] = [
    (Relation::Flanks, "flank", "gear"),
    (Relation::Tools, "manufacturing_step", "workpiece"),
    (Relation::Materials, "reference", "origin"),
];

/// The outermost element of a file, its components by id, and its relations by what they say of whom.
struct Model<'a> {
    root: Node<'a, 'a>,
    components: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Sorted; in the order of the file where they say the same of the same component.
    relations: Vec<(Relation, &'a str, Node<'a, 'a>)>,
}

/// A component with attributes.
#[derive(Clone, Copy)]
struct Component<'a>(Node<'a, 'a>);

impl<'a> Model<'a> {
    fn new(root: Node<'a, 'a>) -> Result<Self, Refusal> {
        let mut model = Self { root, components: BTreeMap::new(), relations: Vec::new() };
        for node in model.inside("relations", "relation") {
            let kind = node.attribute("type").unwrap_or("");
            let Some((relation, _, role)) = RELATIONS.iter().find(|(_, name, _)| *name == kind) else { continue };
            if let Some(id) = in_role(node, role) {
                model.relations.push((*relation, id, node));
            }
        }
        model.relations.sort_by(|one, other| (one.0, one.1).cmp(&(other.0, other.1)));
        for node in model.inside("components", "component") {
            let Some(id) = node.attribute("id") else { continue };
            if let Some(first) = model.components.insert(id, node) {
                let line = root.document().text_pos_at(first.range().start).row;
                return refuse(
                    node,
                    format!("the component {id} is given twice, first in line {line}; ids are unique"),
                );
            }
        }
        Ok(model)
    }

    fn inside(&self, list: &'static str, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + use<'a> {
        let lists = self.root.children().filter(move |node| node.has_tag_name(list));
        lists.flat_map(move |list| list.children().filter(move |node| node.has_tag_name(name)))
    }

    fn component(&self, id: &str) -> Option<Component<'a>> {
        self.components.get(id).copied().map(Component)
    }

    /// What stands in the role `wanted` of the relations that say something of a component; each component once.
    fn related(&self, relation: Relation, id: &str, wanted: &str) -> Vec<Component<'a>> {
        let from = self.relations.partition_point(|(other, of, _)| (*other, *of) < (relation, id));
        let found = self.relations[from..].iter().take_while(|(other, of, _)| (*other, *of) == (relation, id));
        let mut seen = BTreeSet::new();
        let ids = found.filter_map(|(_, _, node)| in_role(*node, wanted)).filter(|id| seen.insert(*id));
        ids.filter_map(|id| self.component(id)).collect()
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
        // A message is not a list of a whole factory.
        let named = ids[..ids.len().min(MOST_NAMED)].join(", ") + if ids.len() > MOST_NAMED { ", …" } else { "" };
        match (wanted, stages.as_slice()) {
            (_, []) => refuse(self.root, "it has no stage of two cylindrical gears"),
            (None, [one]) => Ok(*one),
            (None, [_, second, ..]) => {
                refuse(*second, format!("it has {} cylindrical stages; name one of {named}", ids.len()))
            }
            (Some(id), _) => match stages.iter().find(|relation| in_role(**relation, "stage") == Some(id)) {
                Some(found) => Ok(*found),
                None => refuse(self.root, format!("it has no cylindrical stage `{id}`; it has {named}")),
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
    fn number(self, name: &str, units: &[&str]) -> Result<Option<Said>, Refusal> {
        let is_meant = |node: &Node| node.has_tag_name("attribute") && node.attribute("id") == Some(name);
        let mut given = self.0.children().filter(is_meant);
        let Some(attribute) = given.next() else { return Ok(None) };
        let (kind, id) = (self.kind(), self.id());
        if let Some(second) = given.next() {
            return refuse(second, format!("`{name}` of the {kind} {id} is given twice"));
        }
        let unit = attribute.attribute("unit").unwrap_or("");
        if !units.contains(&unit) {
            return refuse(attribute, format!("`{name}` of the {kind} {id} is in `{unit}`, not in {}", units[0]));
        }
        let text = attribute.text().unwrap_or("").trim();
        match text.parse::<f64>() {
            Ok(value) if value.abs() <= LARGEST => Ok(Some(Said { value, at: attribute.range().start })),
            Ok(value) if value.is_finite() => refuse(
                attribute,
                format!("`{name}` of the {kind} {id} is {value:e}; it must be -{LARGEST:e} to {LARGEST:e}"),
            ),
            _ => {
                let shown: String = text.escape_debug().take(40).collect();
                refuse(attribute, format!("`{name}` of the {kind} {id} is `{shown}`, which is not a number"))
            }
        }
    }
}

/// No number of a gear is larger, in any unit of REXS.
const LARGEST: f64 = 1e9;

/// A number of the file, and the byte where it stands.
#[derive(Clone, Copy, Debug)]
struct Said {
    value: f64,
    at: usize,
}

impl Said {
    fn map(self, change: impl FnOnce(f64) -> f64) -> Self {
        Self { value: change(self.value), ..self }
    }
}

const MILLIMETRES: &[&str] = &["mm"];
const DEGREES: &[&str] = &["deg", "°"];
const PLAIN: &[&str] = &["none", "", "-"];
const MEGAPASCALS: &[&str] = &["MPa", "N / mm^2", "N/mm^2"];

/// A gear as far as a file says it; lengths in mm, as they are shown.
struct Gear {
    teeth: Said,
    module: Said,
    pressure_angle: Option<Said>,
    shift: Option<Said>,
    width: Option<Said>,
    tip_diameter: Option<Said>,
    bore_diameter: Option<Said>,
    /// In modules, from the tool or from the root circle.
    dedendum: Option<Said>,
    addendum: Option<Said>,
    rack_tip_radius: Option<Said>,
    youngs_modulus: Option<Said>,
    poisson_ratio: Option<Said>,
}

/// The one value that several components give.
fn agreed<'a>(
    components: impl Iterator<Item = Component<'a>>,
    name: &str,
    units: &[&str],
) -> Result<Option<Said>, Refusal> {
    let mut found: Option<(Said, &str)> = None;
    for component in components {
        let Some(said) = component.number(name, units)? else { continue };
        match found {
            Some((other, id)) if (other.value - said.value).abs() > 1e-12 * said.value.abs() => {
                let message = format!(
                    "`{name}` is {} of the component {id} and {} of {}; both flanks of a gear must be alike",
                    other.value,
                    said.value,
                    component.id()
                );
                return Err(Refusal::new(message).at(said.at));
            }
            _ => found = Some((said, component.id())),
        }
    }
    Ok(found.map(|(said, _)| said))
}

impl Gear {
    fn read(model: &Model, gear: Component) -> Result<Self, Refusal> {
        let id = gear.id();
        if gear.kind() != "cylindrical_gear" {
            return refuse(
                gear.0,
                format!("the component {id} is a {}; only external cylindrical gears can be read", gear.kind()),
            );
        }
        let needed = |said: Option<Said>, name: &str| match said {
            Some(said) => Ok(said),
            None => refuse(gear.0, format!("the cylindrical_gear {id} has no `{name}`")),
        };
        let module = needed(gear.number("normal_module", MILLIMETRES)?, "normal_module")?;
        let teeth = needed(gear.number("number_of_teeth", PLAIN)?, "number_of_teeth")?;
        let z = teeth.value;
        if !(z.fract() == 0.0 && (1.0..=1e6).contains(&z)) {
            let message = format!("the cylindrical_gear {id} has {z} teeth; only whole external gears can be read");
            return Err(Refusal::new(message).at(teeth.at));
        }
        if module.value <= 0.0 {
            let message = format!("the cylindrical_gear {id} has a module of {} mm; it must be positive", module.value);
            return Err(Refusal::new(message).at(module.at));
        }
        if let Some(helix) = gear.number("helix_angle_reference_diameter", DEGREES)?.filter(|helix| helix.value != 0.0)
        {
            let message =
                format!("the cylindrical_gear {id} has a helix angle of {}°; only spur gears can be read", helix.value);
            return Err(Refusal::new(message).at(helix.at));
        }
        let flanks: Vec<Component> =
            ["left", "right"].iter().flat_map(|side| model.related(Relation::Flanks, id, side)).collect();
        let tools: Vec<Component> =
            flanks.iter().flat_map(|flank| model.related(Relation::Tools, flank.id(), "tool")).collect();
        let of_flank = |name, units| agreed(std::iter::once(gear).chain(flanks.iter().copied()), name, units);
        let of_tool =
            |name, units| agreed(tools.iter().copied().filter(|tool| tool.kind() == "rack_shaped_tool"), name, units);
        let materials = model.related(Relation::Materials, id, "referenced");
        let of_material = |name, units| {
            agreed(materials.iter().copied().filter(|component| component.kind() == "material"), name, units)
        };
        let shift = of_flank("addendum_modification_coefficient", PLAIN)?;
        let root = gear.number("root_diameter", MILLIMETRES)?;
        // r_f = m(z/2 − h_fP* + x).
        let by_root =
            root.zip(shift).map(|(root, shift)| root.map(|root| 0.5 * z + shift.value - 0.5 * root / module.value));
        let round = of_tool("tip_radius", MILLIMETRES)?.map(|radius| radius.map(|radius| radius / module.value));
        Ok(Self {
            teeth,
            module,
            pressure_angle: of_flank("normal_pressure_angle", DEGREES)?,
            shift,
            width: gear.number("face_width", MILLIMETRES)?,
            tip_diameter: gear.number("tip_diameter", MILLIMETRES)?,
            bore_diameter: gear.number("inner_diameter", MILLIMETRES)?.filter(|diameter| diameter.value > 0.0),
            // The tool's addendum cuts the gear's dedendum.
            dedendum: of_tool("addendum_coefficient_reference_profile", PLAIN)?.or(by_root),
            addendum: of_flank("addendum_coefficient_basic_profile", PLAIN)?,
            rack_tip_radius: of_tool("tip_radius_factor", PLAIN)?.or(round),
            youngs_modulus: of_material("elastic_modulus", MEGAPASCALS)?,
            poisson_ratio: of_material("poisson_ratio", PLAIN)?,
        })
    }
}

struct RexsPair {
    stage: String,
    /// Where the relation of the stage stands.
    at: usize,
    gears: [Gear; 2],
    centre_distance: Option<Said>,
}

impl RexsPair {
    fn read(model: &Model, relation: Node) -> Result<Self, Refusal> {
        let gear = |role: &str| -> Result<Gear, Refusal> {
            let component = in_role(relation, role).and_then(|id| model.component(id));
            component
                .map_or_else(|| refuse(relation, format!("the stage has no `{role}`")), |gear| Gear::read(model, gear))
        };
        let id = in_role(relation, "stage").unwrap_or("");
        let centre_distance = match model.component(id) {
            Some(stage) => stage.number("center_distance", MILLIMETRES)?,
            None => None,
        };
        let at = relation.range().start;
        Ok(Self { stage: id.to_owned(), at, gears: [gear("gear_1")?, gear("gear_2")?], centre_distance })
    }

    /// A value that both gears must have in common; what one of them does not say, the other's stands for.
    fn common(&self, name: &str, get: impl Fn(&Gear) -> Option<Said>) -> Result<Option<Said>, Refusal> {
        match self.gears.each_ref().map(get) {
            [Some(a), Some(b)] if (a.value - b.value).abs() > 1e-9 * a.value.abs().max(b.value.abs()) => {
                let message = format!("the gears' {name} differ, {} and {}; a pair here has one", a.value, b.value);
                Err(Refusal::new(message).at(b.at))
            }
            [a, b] => Ok(a.or(b)),
        }
    }
}
