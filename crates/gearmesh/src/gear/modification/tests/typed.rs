//! Modifications made without a study: their ranges, and the room of a tooth under a surface.

use std::sync::Arc;

use crate::gear::fixtures::{pair, record};
use crate::gear::geometry::Side;
use crate::gear::modification::curve::Curve;
use crate::gear::modification::lead_crowning::LeadCrowning;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::modification::{Design, Gears, Modification, NamedModification, family};
use declare::record::Value::{Choice, Quantity};

/// So much over the whole flank, as a surface and as a lead.
#[derive(Debug)]
struct Even {
    surface: f64,
    lead: f64,
}

impl Modification for Even {
    fn lead(&self, _z: f64) -> f64 {
        self.lead
    }

    fn varies_along_face(&self) -> bool {
        true
    }

    fn surface(&self, _roll: f64, _z: f64) -> f64 {
        self.surface
    }

    fn varies_over_surface(&self) -> bool {
        true
    }

    fn resolved(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }
}

fn with(surface: f64, lead: f64) -> Design {
    let modification = Arc::new(Even { surface, lead });
    Design { pinion: vec![NamedModification { family: "test", modification }], ..Design::default() }
}

/// Tier: invariant; a value out of the range of its field is refused by that range, whoever states it.
#[test]
fn a_value_out_of_its_range_is_refused() {
    let refused = |amount: f64| Design::default().add(Gears::Pinion, &LeadCrowning { amount }, &pair()).err();
    assert_eq!(refused(20e-6), None);
    for amount in [-1e-6, 6e-3, f64::NAN] {
        let said = refused(amount).unwrap().to_string();
        assert_eq!(said, format!("`amount` is {amount}; it may be 0 to 0.005"));
    }
}

/// What is refused, by a check, by a field or for want of room, leaves the design as it was.
#[test]
fn a_refused_modification_is_not_kept() {
    let pair = pair();
    let relief = |amount: f64, start: Start| TipRelief {
        amount: Amount::Depth(amount),
        start,
        counted_from: FromTip::Tip,
        curve: Curve::Linear,
    };
    let mut design = Design::default();
    design.add(Gears::Both, &relief(9e-6, Start::Fraction(0.8)), &pair).unwrap();
    // Too much; too long for the flank; out of range.
    for (amount, start) in [(3e-3, Start::Fraction(1.0)), (9e-6, Start::Length(0.05)), (-1e-6, Start::Fraction(1.0))] {
        assert!(design.add(Gears::Both, &relief(amount, start), &pair).is_err(), "{amount}");
        assert_eq!([design.pinion.len(), design.gear.len()], [1, 1], "{amount}");
    }
    // What its fields say against each other.
    let against = TipRelief { counted_from: FromTip::SingleZone, ..relief(9e-6, Start::RollAngle(0.5)) };
    assert!(design.add(Gears::Both, &against, &pair).is_err_and(|error| error.field == Some("counted_from")));
    let record =
        record("tip_relief", &[("gear", Choice("both")), ("amount", Quantity(3e-3)), ("fraction", Quantity(1.0))]);
    assert!(design.add_record(family("tip_relief").unwrap(), &record, &pair).is_err());
    assert_eq!([design.pinion.len(), design.gear.len()], [1, 1]);
}

/// Tier: closed form; what a surface takes off and a lead leaves on comes to nothing, and the other way round; the outline
/// has the surface in the middle of the face.
#[test]
fn a_surface_takes_room_as_a_lead_does() {
    for (surface, lead, fits) in [
        (3e-3, 0.0, false),
        (8e-4, 8e-4, false),
        (8e-4, -8e-4, true),
        (3e-3, -3e-3, true),
        (0.0, 3e-3, false),
        (1e-5, 1e-5, true),
    ] {
        let design = with(surface, lead);
        assert_eq!(design.check_rooms(Gears::Both, &pair()).is_ok(), fits, "{surface} {lead}");
        let relief = design.relief(Side::Pinion).unwrap();
        assert_eq!((relief.depth(0.3), relief.breaks()), (surface, Vec::new()));
    }
}
