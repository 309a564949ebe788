//! Axes that are not parallel: the gap that opens between flanks across the face.
//!
//! Where one axis leans away from the other, each transverse section of a gear is displaced by as much as its axis is there.
//! The flanks of a spur pair touch along the line of action, so they part by the displacement's component along it: that in
//! the plane of the axes counts with sin α_wt, that across it with cos α_wt. To first order it is the same at every position of
//! the mesh and grows with z: a tilt. Terms and symbols: ISO/TR 10064-3. Must not know: compliance, load.

use super::geometry::GearPair;

/// Deviations of shaft parallelism as they are measured: over the distance of the bearings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftParallelism {
    /// f_Σδ, in the common plane of the axes \[m\]: positive where they part towards positive z.
    pub in_plane: f64,
    /// f_Σβ, across that plane \[m\]: positive where the loaded flanks part towards positive z.
    pub out_of_plane: f64,
    /// L, over which both are stated \[m\], above 0.
    pub bearing_span: f64,
}

impl ShaftParallelism {
    /// How fast the gap between the flanks grows with z \[m/m\].
    #[must_use]
    pub fn tilt(&self, pair: &GearPair) -> f64 {
        let (sine, cosine) = libm::sincos(pair.working_pressure_angle);
        (self.out_of_plane * cosine + self.in_plane * sine) / self.bearing_span
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::compliance::ContactLaw;
    use crate::gear::contact::SliceCoupling;
    use crate::gear::fixtures::{NamedModification, coupled, design, pair, varying};
    use crate::gear::mesh::answers::curve::{Summary, Wanted};
    use crate::gear::mesh::{Mesh, Settings};
    use crate::gear::modification::Design;
    use declare::record::Value::{Choice, Quantity};

    const TORQUE: f64 = 50.0;

    fn cycles() -> Vec<Mesh> {
        let pair = pair();
        let plate = Settings { slice_coupling: SliceCoupling::Plate, ..Settings::default() };
        let load_dependent =
            crate::gear::compliance::PairCompliance { contact: Some(ContactLaw::LoadDependent), ..varying() };
        [(varying(), Settings::default()), (coupled(), Settings::default()), (load_dependent, Settings::default())]
            .into_iter()
            .chain([(varying(), plate)])
            .map(|(compliance, settings)| Mesh::new(&pair, &compliance, settings).unwrap())
            .collect()
    }

    fn summary(cycle: &Mesh, design: &Design) -> Summary {
        cycle.loaded(design, TORQUE).summary(Wanted { harmonics: 3, ..Wanted::default() })
    }

    fn tilted(parts: &[NamedModification], tilt: f64) -> Design {
        Design { tilt, ..design(&pair(), parts).unwrap() }
    }

    /// Tier: second method. The displacement of one axis by itself moves the gear's flank; the gap along the line of action is
    /// found as the distance of two parallel straight lines, which involutes of one line of action are to first order.
    #[test]
    fn the_tilt_is_the_displacement_along_the_line_of_action() {
        let pair = pair();
        let (in_plane, out_of_plane, bearing_span) = (30e-6, -12e-6, 90e-3);
        let tilt = ShaftParallelism { in_plane, out_of_plane, bearing_span }.tilt(&pair);
        // The line of action between the base circles' points of tangency, axes on the y axis.
        let (r1, r2, a) = (pair.pinion.base_radius, pair.gear.base_radius, pair.centre_distance);
        let lean = libm::acos((r1 + r2) / a);
        let tangent = |radius: f64, sign: f64| [sign * radius * libm::sin(lean), sign * radius * libm::cos(lean)];
        let (from, to) = (tangent(r1, 1.0), tangent(r2, -1.0));
        let along = [to[0] - from[0], to[1] + a - from[1]];
        let length = libm::hypot(along[0], along[1]);
        assert!((length / pair.tangent_length - 1.0).abs() < 1e-12);
        let z = 7e-3;
        let moved = [out_of_plane * z / bearing_span, in_plane * z / bearing_span];
        let parted = (moved[0] * along[0].abs() + moved[1] * along[1].abs()) / length;
        assert!((tilt * z / parted - 1.0).abs() < 1e-12, "{} {parted}", tilt * z);
    }

    /// Tier: second method; a helix slope deviation that opens the same gap. The slope takes material off, on average half of
    /// it, which only moves the mean; the tilt turns about the middle of the face. With every law of contact, coupled or not.
    #[test]
    fn a_tilt_is_a_helix_slope_with_the_same_gap() {
        let width = 18e-3;
        for amount in [3e-6, 15e-6, -40e-6] {
            let relief = ("tip_relief", "both", &[("amount", Quantity(6e-6)), ("fraction", Quantity(1.0))][..]);
            let slope = ("helix_slope", "gear", &[("amount", Quantity(amount))][..]);
            let crown = ("lead_crowning", "pinion", &[("amount", Quantity(4e-6))][..]);
            let flat = (tilted(&[relief, slope], 0.0), tilted(&[relief], amount / width));
            let crowned = (tilted(&[relief, crown, slope], 0.0), tilted(&[relief, crown], amount / width));
            for (cycle, (by_slope, by_tilt)) in cycles().iter().flat_map(|cycle| [(cycle, &flat), (cycle, &crowned)]) {
                let [one, two] = [by_slope, by_tilt].map(|design| summary(cycle, design));
                let close =
                    |one: f64, two: f64| assert!((one - two).abs() < 1e-9 * two.abs() + 1e-17, "{one:e} {two:e}");
                close(one.peak_to_peak, two.peak_to_peak);
                close(one.mean - 0.5 * amount.abs(), two.mean);
                close(one.loaded_contact_ratio, two.loaded_contact_ratio);
                let off = one.harmonics.iter().zip(&two.harmonics).map(|(one, two)| (one - two).abs());
                assert!(off.fold(0.0, f64::max) < 1e-9 * two.peak_to_peak);
            }
        }
    }

    /// Tier: invariant. Sides of the face swap with the sign. A face that is even gives the same for both; one with relief at one
    /// end does not.
    #[test]
    fn the_sign_says_which_end_of_the_face_carries() {
        let relief = |end| [("amount", Quantity(9e-6)), ("length", Quantity(5e-3)), ("curve", Choice("linear")), end];
        let [first, second] = ["I", "II"].map(|end| relief(("end", Choice(end))));
        let crown = [("amount", Quantity(6e-6))];
        let even = |tilt| tilted(&[("lead_crowning", "pinion", &crown)], tilt);
        let [at_first, at_second] =
            [&first, &second].map(|end| move |tilt| tilted(&[("end_relief", "gear", end)], tilt));
        let tilt = 12e-6 / 18e-3;
        for cycle in cycles() {
            let mean = |design: Design| summary(&cycle, &design).mean;
            let same = |one: f64, two: f64| (one / two - 1.0).abs() < 1e-9;
            assert!(same(mean(even(tilt)), mean(even(-tilt))));
            assert!(even(0.0).lead_is_even() && !even(tilt).lead_is_even());
            let [towards, away] = [mean(at_first(tilt)), mean(at_first(-tilt))];
            assert!((towards / away - 1.0).abs() > 1e-3, "{towards:e} {away:e}");
            // The mirrored face with the mirrored tilt.
            assert!(same(mean(at_second(-tilt)), towards) && same(mean(at_second(tilt)), away));
        }
    }

    /// Tier: closed form. Under linear contact a tilt that leaves the whole face in contact moves nothing: its mean is 0.
    #[test]
    fn a_tilt_that_leaves_the_whole_face_in_contact_changes_nothing() {
        let cycle = &cycles()[0];
        let [plain, turned] = [0.0, 1e-6 / 18e-3].map(|tilt| summary(cycle, &tilted(&[], tilt)));
        assert!((turned.mean / plain.mean - 1.0).abs() < 1e-12, "{:e} {:e}", turned.mean, plain.mean);
        assert!((turned.peak_to_peak / plain.peak_to_peak - 1.0).abs() < 1e-10);
    }
}
