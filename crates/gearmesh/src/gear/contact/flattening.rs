//! How two flanks flatten against each other: contact laws and Hertzian pressure.
//!
//! Sources: the article `energy_ga` (linear law, here for two materials); Weber and Banaschek, Formänderung und
//! Profilrücknahme bei gerad- und schrägverzahnten Rädern, 1953 (load-dependent law); Johnson, Contact Mechanics, 4.2
//! (line contact). Loads per face width in N/m. Must not know: how teeth bend.

use std::f64::consts::PI;

use super::tip::{Ended, FarLaw, NearTips, Tips};
use crate::gear::geometry::GearPair;
use crate::gear::material::{Material, Plane};
use crate::numeric::lambert::larger_root;

/// What both flanks are made of, and the plane state that they are in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// Of pinion and gear.
    pub materials: [Material; 2],
    /// Of both.
    pub plane: Plane,
}

impl Bodies {
    /// Those of a pair.
    #[must_use]
    pub fn of(pair: &GearPair, plane: Plane) -> Self {
        Self { materials: [pair.pinion.specification.material, pair.gear.specification.material], plane }
    }

    /// 1/E′ of each \[1/Pa\].
    fn compliances(&self) -> [f64; 2] {
        self.materials.map(|material| material.plane_compliance(self.plane))
    }

    /// Σ 1/E′ \[1/Pa\].
    fn compliance(&self) -> f64 {
        let [one, other] = self.compliances();
        one + other
    }

    /// The linear law: 2/π Σ 1/E′, penetration per load per width \[1/Pa\]; for equal materials 4/(πE′).
    #[must_use]
    pub fn linear(&self) -> f64 {
        2.0 / PI * self.compliance()
    }

    /// Half the width of the contact, b_H² = 4 p ρ Σ(1/E′) / π, over the square root of the load per width p.
    #[must_use]
    pub fn half_width(&self, combined_radius: f64) -> f64 {
        (4.0 * combined_radius * self.compliance() / PI).sqrt()
    }

    /// The largest pressure of a line contact \[Pa\]: √(p / (π ρ Σ 1/E′)).
    #[must_use]
    pub fn pressure(&self, combined_radius: f64, line_load: f64) -> f64 {
        (line_load / (PI * combined_radius * self.compliance())).sqrt()
    }
}

/// 1/ρ = 1/ρ1 + 1/ρ2.
#[must_use]
pub fn combined_radius(radii: [f64; 2]) -> f64 {
    radii[0] * radii[1] / (radii[0] + radii[1])
}

/// The load-dependent law of two flanks at one place: approach p(α − β ln p) at the load per width p.
///
/// By Weber and Banaschek Σ 2/(πE′)·[ln(2t/b_H) − ν′/2] with b_H ∝ √p. The law presumes b_H ≪ t; it would yield under more load
/// beyond ln p = α/β − 1, where b_H has grown to the size of the tooth, and is held constant from there on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Logarithmic {
    /// α \[1/Pa\].
    pub constant: f64,
    /// β = 1/π Σ 1/E′ \[1/Pa\].
    pub rate: f64,
    /// ln β.
    pub log_rate: f64,
}

impl Logarithmic {
    /// `depths`: t of both teeth \[m\].
    #[must_use]
    pub fn weber(bodies: &Bodies, combined_radius: f64, depths: [f64; 2]) -> Self {
        Self::new(bodies, combined_radius, depths, |material| -0.5 * material.plane_poisson_ratio(bodies.plane))
    }

    /// Σ 2/(πE′)·[ln(2l/b_H) + `beside`].
    fn new(bodies: &Bodies, combined_radius: f64, lengths: [f64; 2], beside: impl Fn(&Material) -> f64) -> Self {
        let unit = bodies.half_width(combined_radius);
        let mut law = Self { constant: 0.0, rate: 0.0, log_rate: 0.0 };
        let of_bodies = bodies.compliances().into_iter().zip(&bodies.materials).zip(lengths);
        for ((compliance, material), length) in of_bodies {
            let factor = 2.0 / PI * compliance;
            law.constant += factor * (libm::log(2.0 * length / unit) + beside(material));
            law.rate += 0.5 * factor;
        }
        Self { log_rate: libm::log(law.rate), ..law }
    }

    /// Half planes, beside the displacement of their surfaces at the distances `lengths` \[m\] from the contact, which are
    /// large against its width: Σ 2/(πE′)·[ln(2l/b_H) + ½] (Johnson, Contact Mechanics, 4.2).
    #[must_use]
    pub fn half_planes(bodies: &Bodies, combined_radius: f64, lengths: [f64; 2]) -> Self {
        Self::new(bodies, combined_radius, lengths, |_| 0.5)
    }

    /// The law with `compliance` (penetration per load per width, > 0) in series.
    #[must_use]
    pub fn in_series<'a>(self, compliance: f64) -> InSeries<'a> {
        let start = (compliance + self.constant) / self.rate + self.log_rate - 1.0;
        InSeries { law: self, compliance, start, tips: None }
    }

    /// The load per width above which the approach is constant.
    #[must_use]
    pub fn last(&self) -> f64 {
        libm::exp(self.constant / self.rate - 1.0)
    }

    /// The approach of the flanks at the load per width p.
    #[must_use]
    pub fn approach(&self, load: f64) -> f64 {
        let load = load.min(self.last());
        if load > 0.0 { load * (self.constant - self.rate * libm::log(load)) } else { 0.0 }
    }
}

/// Flanks and teeth in series, prepared for many inversions.
#[derive(Clone, Debug)]
pub struct InSeries<'a> {
    /// The flanks.
    pub law: Logarithmic,
    /// c: penetration of both teeth without the contact, per load per width \[1/Pa\]; with what tips add that are far.
    pub compliance: f64,
    /// (c + α) / β + ln β − 1.
    start: f64,
    /// Tips that may be near, where contact is resolved.
    tips: Option<NearTips<'a>>,
}

impl<'a> InSeries<'a> {
    /// Fills the places of an array that no pair takes: flanks and teeth without compliance.
    pub const NONE: Self =
        Self { law: Logarithmic { constant: 0.0, rate: 0.0, log_rate: 0.0 }, compliance: 0.0, start: 0.0, tips: None };

    /// The same between teeth whose tips may be near.
    #[must_use]
    pub fn at_tips(self, tips: Tips<'a>) -> Self {
        let near = NearTips::new(tips, self.law.rate, self.compliance);
        self.with(near)
    }

    /// The same of the tips at a place, which are asked for where one is near.
    #[must_use]
    #[inline]
    pub fn at_ends<E: Ended>(self, ends: &'a E, s: f64) -> Self {
        let near = NearTips::at(ends, ends.far(s, self.law.rate), s, self.compliance);
        self.with(near)
    }

    #[inline]
    fn with(self, near: NearTips<'a>) -> Self {
        let mut series = self.law.in_series(self.compliance + near.far());
        series.tips = Some(near);
        series
    }

    fn far_law(&self) -> FarLaw {
        FarLaw { compliance: self.compliance, constant: self.law.constant, rate: self.law.rate }
    }

    /// The penetration at a load per width.
    #[must_use]
    pub fn penetration(&self, load: f64) -> f64 {
        if load > 0.0 { self.at_load(load).0 } else { 0.0 }
    }

    /// The penetration at a load per width p > 0, and dw/dp.
    #[must_use]
    pub fn at_load(&self, load: f64) -> (f64, f64) {
        self.at_known_load(load, libm::log(load))
    }

    /// The same where ln p is known.
    #[must_use]
    #[inline]
    pub fn at_known_load(&self, load: f64, log: f64) -> (f64, f64) {
        let ([penetration, slope, _], _) = self.rates_at(load, log);
        (penetration, slope)
    }

    /// The penetration at a load per width p > 0 with the logarithm `log`, dw/dp and d²w/dp²; and whether the last is that of
    /// flanks alone, next to a tip.
    #[must_use]
    #[inline]
    pub fn rates_at(&self, load: f64, log: f64) -> ([f64; 3], bool) {
        if let Some(tips) = &self.tips {
            return tips.at_load(self.far_law(), load, log);
        }
        let Self { law: Logarithmic { constant, rate, .. }, compliance, .. } = *self;
        if rate * (log + 1.0) > constant {
            return ([compliance * load + rate * self.law.last(), compliance, 0.0], false);
        }
        let total = compliance + constant - rate * log;
        ([load * total, total - rate, -rate / load], false)
    }

    /// Load per width p and dp/dw at the penetration w > 0.
    #[must_use]
    #[inline]
    pub fn load(&self, penetration: f64) -> (f64, f64) {
        let (load, slope) = self.load_without_tips(penetration);
        match &self.tips {
            None => (load, slope),
            Some(tips) => tips.load(self.far_law(), penetration, load),
        }
    }

    #[inline]
    fn load_without_tips(&self, penetration: f64) -> (f64, f64) {
        let Self { law: Logarithmic { rate, .. }, compliance, start, .. } = *self;
        // w = p (c + α − β ln p) in u = w / (β p): u − ln u = (c + α) / β + ln β − ln w.
        let total = rate * larger_root(start - libm::log(penetration));
        if total <= compliance + rate {
            let last = self.law.last();
            return ((penetration - rate * last) / compliance, 1.0 / compliance);
        }
        (penetration / total, 1.0 / (total - rate))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::quadrature::GaussLegendre;

    const STEEL: Material = Material::STEEL;
    const SOFT: Material = Material { youngs_modulus: 100e9, poisson_ratio: 0.25, ..Material::STEEL };

    const fn bodies(materials: [Material; 2]) -> Bodies {
        Bodies { materials, plane: Plane::Strain }
    }

    #[test]
    fn the_linear_law_is_the_articles_for_equal_materials_and_the_mean_of_two() {
        let article = |nu: f64, modulus: f64| 4.0 * (1.0 - nu * nu) / (PI * modulus);
        assert!((bodies([STEEL; 2]).linear() / article(0.3, 206e9) - 1.0).abs() < 1e-15);
        let mean = 0.5 * (article(0.3, 206e9) + article(0.25, 100e9));
        for materials in [[STEEL, SOFT], [SOFT, STEEL]] {
            assert!((bodies(materials).linear() / mean - 1.0).abs() < 1e-15);
        }
    }

    /// 19/48, module 3 mm, 18 mm wide, 50 N·m: the least pressure of the single-contact zone is known to be 709 MPa.
    #[test]
    fn pressure_at_the_end_of_single_contact_is_the_published_one() {
        let s = 2.009_266_843_717_533_4e-3 + 8.856_394_302_280_648e-3;
        let radius = combined_radius([s, 34.373_024_404_229_71e-3 - s]);
        let load = 50.0 / 26.781_240e-3 / 18e-3;
        assert!((bodies([STEEL; 2]).pressure(radius, load) - 709e6).abs() < 0.5e6);
    }

    /// Mean pressure times width is the load, and the largest pressure of an ellipse is 4/π of the mean.
    #[test]
    fn pressure_and_half_width_balance_the_load() {
        let (radius, load) = (6e-3, 2e5_f64);
        let half = bodies([STEEL, SOFT]).half_width(radius) * load.sqrt();
        let total = 0.5 * PI * half * bodies([STEEL, SOFT]).pressure(radius, load);
        assert!((total / load - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_load_dependent_law_inverts_at_every_load() {
        let law = Logarithmic::weber(&bodies([STEEL, SOFT]), 7e-3, [2.5e-3, 3e-3]);
        let series = law.in_series(4e-11);
        let mut before = 0.0;
        for exponent in -300..=40 {
            let load = libm::pow(10.0, f64::from(exponent) * 0.5);
            let penetration = series.penetration(load);
            assert!(penetration > before, "monotonic at {load}");
            before = penetration;
            let (found, slope) = series.load(penetration);
            assert!((found / load - 1.0).abs() < 5e-14, "{load} {found}");
            let step = 1e-5 * penetration;
            let difference = series.load(penetration + step).0 - series.load(penetration - step).0;
            assert!((difference / (2.0 * step) / slope - 1.0).abs() < 1e-5, "slope at {load}");
        }
    }

    /// The law as written, term by term, at one load.
    #[test]
    fn the_load_dependent_law_is_webers() {
        let (radius, load, depths) = (7e-3, 1e5, [2.5e-3, 3e-3]);
        let half = bodies([STEEL, SOFT]).half_width(radius) * f64::sqrt(load);
        let body = |material: &Material, depth: f64| {
            let nu = material.poisson_ratio;
            2.0 * (1.0 - nu * nu) / (PI * material.youngs_modulus)
                * (f64::ln(2.0 * depth / half) - nu / (2.0 * (1.0 - nu)))
        };
        let exact = load * (body(&STEEL, depths[0]) + body(&SOFT, depths[1]));
        let law = Logarithmic::weber(&bodies([STEEL, SOFT]), radius, depths);
        assert!((law.approach(load) / exact - 1.0).abs() < 1e-13);
    }

    /// Tier: second method; the strain under a Hertz pressure (Johnson, Contact Mechanics, eq. 4.49), integrated, in
    /// either plane state with Hooke's law of three dimensions.
    #[test]
    fn the_load_dependent_law_is_the_integral_of_the_strain() {
        let (load, radius, depth) = (2e5_f64, 8e-3, 3e-3);
        for plane in [Plane::Strain, Plane::Stress] {
            let bodies = Bodies { materials: [STEEL; 2], plane };
            let half = bodies.half_width(radius) * load.sqrt();
            let peak = bodies.pressure(radius, load);
            let strain = |z: f64| {
                let root = libm::hypot(half, z);
                let along = -peak * half / root;
                let across = -peak * ((half * half + 2.0 * z * z) / (half * root) - 2.0 * z / half);
                let third = if plane == Plane::Strain { 0.3 * (along + across) } else { 0.0 };
                (along - 0.3 * (across + third)) / 206e9
            };
            // z = b_H sinh w spreads the peak.
            let rule = GaussLegendre::new(60);
            let [integral] = rule
                .integrate(0.0, libm::asinh(depth / half), |w| [-strain(half * libm::sinh(w)) * half * libm::cosh(w)]);
            let approach = Logarithmic::weber(&bodies, radius, [depth; 2]).approach(load);
            // The closed form drops terms of the order of (b_H/t)².
            let ratio = approach / (2.0 * integral);
            assert!((ratio - 1.0).abs() < (half / depth).powi(2), "{plane:?}: {approach} for {integral}");
        }
    }
}
