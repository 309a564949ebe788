//! The components around a gear: flanks, tools, settings of the first manufacturing step, materials. Must not know: attributes.

use super::model::{Component, Model};

/// What is to be reported of the components that are read.
#[derive(Default)]
pub(super) struct Remarks<'a> {
    pub components: Vec<&'a Component>,
    /// Sentences about what a reader must know.
    pub notes: Vec<String>,
}

impl<'a> Remarks<'a> {
    /// Notes components whose attributes must be reported, each once.
    pub fn concern(&mut self, components: impl IntoIterator<Item = &'a Component>) {
        for component in components {
            if !self.components.iter().any(|other| std::ptr::eq(*other, component)) {
                self.components.push(component);
            }
        }
    }
}

/// The components around a gear.
pub(super) struct Around<'a> {
    pub gear: &'a Component,
    pub flanks: Vec<&'a Component>,
    /// Racks of the first manufacturing step, and its settings.
    pub racks: Vec<&'a Component>,
    /// Pinion-type cutters of that step, where no rack is.
    pub cutters: Vec<&'a Component>,
    pub settings: Vec<&'a Component>,
    pub materials: Vec<&'a Component>,
}

impl<'a> Around<'a> {
    pub(super) fn of(model: &'a Model, gear: &'a Component, name: &str, remarks: &mut Remarks<'a>) -> Self {
        let bare = |found: Vec<(&'a Component, Option<u32>)>| -> Vec<&'a Component> {
            found.into_iter().map(|(component, _)| component).collect()
        };
        let flanks = bare(model.related(&["flank"], &gear.id, "gear", &["left", "right"]));
        let mut steps: Vec<(&Component, Option<u32>)> = Vec::new();
        for workpiece in [&gear].into_iter().chain(&flanks) {
            let wanted = ["tool", "manufacturing_settings"];
            steps.extend(model.related(&["manufacturing_step"], &workpiece.id, "workpiece", &wanted));
            steps.extend(model.related(&["ordered_reference", "reference"], &workpiece.id, "origin", &["referenced"]));
        }
        let is_tool = |component: &Component| component.kind.ends_with("_tool");
        let is_settings = |component: &Component| component.kind.ends_with("_manufacturing_settings");
        steps.retain(|(component, _)| is_tool(component) || is_settings(component));
        let first = steps.iter().filter(|(component, _)| is_tool(component)).filter_map(|(_, order)| *order).min();
        let is_first = |order: Option<u32>| order.is_none() || order == first;
        let of_first = |wanted: &dyn Fn(&Component) -> bool| {
            let mut found: Vec<&Component> = Vec::new();
            for (component, order) in &steps {
                if is_first(*order) && wanted(component) && !found.iter().any(|other| std::ptr::eq(*other, *component))
                {
                    found.push(component);
                }
            }
            found
        };
        let racks = of_first(&|component| component.kind == "rack_shaped_tool");
        let settings = of_first(&is_settings);
        let cutters =
            if racks.is_empty() { of_first(&|component| component.kind == "cutter_wheel_tool") } else { Vec::new() };
        if racks.is_empty()
            && cutters.is_empty()
            && let Some(other) = of_first(&is_tool).first()
        {
            let note = format!("The {name} is cut by a {}, which is not read: a rack stands for it.", other.kind);
            remarks.notes.push(note);
        }
        if steps.iter().any(|(component, order)| is_tool(component) && !is_first(*order)) {
            remarks.notes.push(format!("The tools of later manufacturing steps of the {name} are not read."));
        }
        let of = |id: &str| -> Vec<&'a Component> {
            let found = bare(model.related(&["reference"], id, "origin", &["referenced"]));
            found.into_iter().filter(|component| component.kind == "material").collect()
        };
        let assembled = bare(model.related(&["assembly"], &gear.id, "assembly", &["part"]));
        let bodies = assembled.into_iter().filter(|part| part.kind == "gear_body");
        let mut shafts = bare(model.related(&["assembly"], &gear.id, "part", &["assembly"]));
        shafts.extend(bare(model.related(&["side"], &gear.id, "outer_part", &["inner_part"])));
        let mut materials = of(&gear.id);
        for owner in bodies.chain(shafts.into_iter().filter(|shaft| shaft.kind == "shaft")) {
            if materials.is_empty() {
                materials = of(&owner.id);
                if !materials.is_empty() {
                    let kind = &owner.kind;
                    remarks
                        .notes
                        .push(format!("The {name} has no material of its own: that of its {kind} stands for it."));
                }
            }
        }
        let data = bare(model.related(&["stage_gear_data"], &gear.id, "gear", &["stage_gear_data"]));
        let tools = steps.iter().map(|(component, _)| *component);
        remarks.concern([gear].into_iter().chain(flanks.iter().copied()).chain(tools));
        remarks.concern(materials.iter().copied().chain(data));
        Self { gear, flanks, racks, cutters, settings, materials }
    }
}
