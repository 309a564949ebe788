//! Load cases: torques, and what else a pair may be under or be off by, as studies state them and stages look at them.
//!
//! A case is a torque and deviations of mounting and manufacture, which come on top of whatever design there is. Several
//! values of several fields are all combinations of them, torques slowest, then the fields in their order. Must not know:
//! what is computed of a case, who chooses designs.

use declare::declared::goes_with;
use declare::error::{Diagnostic, Failure};
use declare::number::significant;
use declare::record::Record;
use declare::units::{LENGTH, RATIO, TORQUE, in_unit};
use declare::{Declared, Words};
use gearmesh::gear::geometry::GearPair;
use gearmesh::gear::misalignment::ShaftParallelism;
use gearmesh::gear::modification::profile_slope::ProfileSlope;
use gearmesh::gear::modification::{Design, Gears};

/// The largest deviation that is looked at \[m\]; beyond it nothing is small against a tooth.
const MOST: f64 = 1e-3;

/// By how much a pair is off as it is made and mounted, one value of each or several.
#[derive(Clone, Debug, PartialEq, Declared)]
pub struct Deviations {
    /// f_Hβ of both gears together over the common face width: positive opens the flanks towards z = +b/2.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "15 um")]
    pub helix_slope: Option<Vec<f64>>,
    /// f_Hβ of the pinion over its face width: positive opens the flanks towards z = +b/2.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "8 um")]
    pub pinion_helix_slope: Option<Vec<f64>>,
    /// f_Hβ of the gear over its face width: positive opens the flanks towards z = +b/2.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "8 um")]
    pub gear_helix_slope: Option<Vec<f64>>,
    /// f_Hα of the pinion over its active flank: positive takes material off at the tip.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "5 um")]
    pub pinion_profile_slope: Option<Vec<f64>>,
    /// f_Hα of the gear over its active flank: positive takes material off at the tip.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "5 um")]
    pub gear_profile_slope: Option<Vec<f64>>,
    /// f_Σδ, deviation of shaft parallelism in the plane of the axes: positive where they part towards positive z.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "20 um")]
    pub parallelism_in_plane: Option<Vec<f64>>,
    /// f_Σβ, deviation of shaft parallelism across that plane: positive opens the loaded flanks towards positive z.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, axis = usize::MAX, example = "10 um")]
    pub parallelism_out_of_plane: Option<Vec<f64>>,
    /// L, over which both deviations of parallelism are stated; the common face width unless it is said.
    #[declared(minimum = 1e-4, maximum = 100.0, dimension = LENGTH, example = "80 mm")]
    pub bearing_span: Option<f64>,
}

/// What of a pair may be off.
pub const FIELDS: usize = 7;

/// The fields of [`Deviation`], in their order: name, and what a column says of it.
pub const DEVIATIONS: [(&str, &str); FIELDS] = [
    (Deviations::NAMES.helix_slope, "Helix slope deviation f_Hβ of both gears over the common face width."),
    (Deviations::NAMES.pinion_helix_slope, "Helix slope deviation f_Hβ of the pinion over its face width."),
    (Deviations::NAMES.gear_helix_slope, "Helix slope deviation f_Hβ of the gear over its face width."),
    (Deviations::NAMES.pinion_profile_slope, "Profile slope deviation f_Hα of the pinion."),
    (Deviations::NAMES.gear_profile_slope, "Profile slope deviation f_Hα of the gear."),
    (Deviations::NAMES.parallelism_in_plane, "Deviation f_Σδ of shaft parallelism in the plane of the axes."),
    (Deviations::NAMES.parallelism_out_of_plane, "Deviation f_Σβ of shaft parallelism across the plane of the axes."),
];

impl Deviations {
    fn fields(&self) -> [Option<&Vec<f64>>; FIELDS] {
        [
            self.helix_slope.as_ref(),
            self.pinion_helix_slope.as_ref(),
            self.gear_helix_slope.as_ref(),
            self.pinion_profile_slope.as_ref(),
            self.gear_profile_slope.as_ref(),
            self.parallelism_in_plane.as_ref(),
            self.parallelism_out_of_plane.as_ref(),
        ]
    }

    /// Refuses a bearing span without anything that is stated over it.
    ///
    /// # Errors
    /// With the place in `record`.
    pub fn check(&self, record: &Record) -> Result<(), Diagnostic> {
        let [.., in_plane, out_of_plane] = self.fields();
        if self.bearing_span.is_none() || in_plane.is_some() || out_of_plane.is_some() {
            return Ok(());
        }
        Err(Diagnostic::new("`bearing_span` goes with `parallelism_in_plane` or `parallelism_out_of_plane` only")
            .at(record.place_of(Self::NAMES.bearing_span)))
    }

    /// Which fields are stated, as indices of [`DEVIATIONS`].
    pub fn stated(&self) -> Vec<usize> {
        (0..FIELDS).filter(|field| self.fields()[*field].is_some()).collect()
    }

    /// The values of a field; none where it is not stated.
    pub fn values(&self, field: usize) -> &[f64] {
        self.fields()[field].map_or(&[], Vec::as_slice)
    }

    /// All combinations of their values, the last field fastest; where nothing is stated the one that nothing is off.
    pub fn combinations(&self) -> Vec<Deviation> {
        let none = Deviation { of_fields: [0.0; FIELDS], bearing_span: self.bearing_span };
        let mut all = vec![none];
        for (field, values) in self.fields().into_iter().enumerate() {
            let Some(values) = values else { continue };
            let with = |deviation: &Deviation, value: f64| {
                let mut with = *deviation;
                with.of_fields[field] = value;
                with
            };
            all = all.iter().flat_map(|deviation| values.iter().map(move |value| with(deviation, *value))).collect();
        }
        all
    }
}

/// By how much a pair is off in one case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// In the order of [`DEVIATIONS`] \[m\].
    pub of_fields: [f64; FIELDS],
    /// None is the common face width.
    bearing_span: Option<f64>,
}

impl Deviation {
    /// The deviations that are not 0, as they stand behind a torque: `, helix_slope 20 um`.
    pub fn words(&self) -> String {
        let stated = DEVIATIONS.iter().zip(&self.of_fields).filter(|(_, amount)| **amount != 0.0);
        let word = |((name, _), amount): (&(&str, &str), &f64)| {
            format!(", {name} {} um", significant(in_unit(*amount, "um"), 6))
        };
        stated.map(word).collect::<Vec<_>>().concat()
    }

    /// A design as it is made and mounted.
    ///
    /// # Errors
    /// When what is left of a tooth is no tooth any more.
    pub fn on(&self, design: &Design, pair: &GearPair) -> Result<Design, Diagnostic> {
        let mut off = design.clone();
        let [helix_slope, pinion_helix, gear_helix, pinion_profile, gear_profile, in_plane, out_of_plane] =
            self.of_fields;
        for (gears, amount) in [(Gears::Pinion, pinion_profile), (Gears::Gear, gear_profile)] {
            if amount != 0.0 {
                off.add(gears, &ProfileSlope { amount }, pair)?;
            }
        }
        let [pinion, gear] = [&pair.pinion, &pair.gear].map(|gear| gear.specification.face_width);
        let common = pinion.min(gear);
        let parallelism =
            ShaftParallelism { in_plane, out_of_plane, bearing_span: self.bearing_span.unwrap_or(common) };
        off.tilt += helix_slope / common + pinion_helix / pinion + gear_helix / gear + parallelism.tilt(pair);
        Ok(off)
    }
}

/// The loads a design is judged by, and what counts when there are several.
#[derive(Clone, Debug, Declared)]
pub struct Loads {
    /// Torque on the pinion, one or several.
    #[declared(minimum = 1e-12, maximum = 1e9, dimension = TORQUE, axis = usize::MAX, example = "100 N m")]
    pub torque: Vec<f64>,
    #[declared(flatten)]
    pub deviations: Deviations,
    /// How much each torque counts; all alike unless it is said.
    pub weights: Option<Vec<Weight>>,
    /// What counts when there are several cases.
    #[declared(default = "worst")]
    pub combine: Combine,
    /// Which share of the cases is to be as good or better.
    #[declared(minimum = 0.0, maximum = 1.0, dimension = RATIO, example = "95 %")]
    pub quantile: Option<f64>,
    /// How many standard deviations are added to the mean.
    #[declared(minimum = 0.0, maximum = 100.0, example = "3")]
    pub spread: Option<f64>,
}

/// How much a torque counts.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct Weight {
    /// One of the torques.
    #[declared(minimum = 1e-12, maximum = 1e9, dimension = TORQUE, example = "100 N m")]
    pub torque: f64,
    /// How much it counts beside the others.
    #[declared(minimum = 0.0, maximum = 1e9, example = "2")]
    pub weight: f64,
}

/// What counts of several values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Combine {
    /// the largest
    Worst,
    /// the mean, by weight
    Mean,
    /// the smallest value that a share `quantile` of the cases, by weight, does not exceed
    Quantile,
    /// the mean and `spread` standard deviations
    MeanAndSpread,
}

/// A torque and what is off under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// On the pinion \[N m\].
    pub torque: f64,
    pub deviation: Deviation,
    /// How much it counts beside the others.
    pub weight: f64,
}

/// All cases, and how their values become one.
#[derive(Clone, Debug, PartialEq)]
pub struct Cases {
    pub all: Vec<Case>,
    measure: Measure,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Measure {
    Worst,
    Mean,
    Quantile(f64),
    MeanAndSpread(f64),
}

impl Loads {
    /// # Errors
    /// What contradicts itself, with its place in `record`, which is that of the loads.
    pub fn cases(&self, record: &Record) -> Result<Cases, Diagnostic> {
        self.deviations.check(record)?;
        let names = Self::NAMES;
        goes_with(record, names.quantile, [names.combine, "quantile"])?;
        goes_with(record, names.spread, [names.combine, "mean_and_spread"])?;
        let measure = match (self.combine, self.quantile, self.spread) {
            (Combine::Quantile, Some(share), _) => Measure::Quantile(share),
            (Combine::MeanAndSpread, _, Some(times)) => Measure::MeanAndSpread(times),
            (Combine::Mean, ..) => Measure::Mean,
            _ => Measure::Worst,
        };
        let weights = self.weights_of_torques(record)?;
        let combinations = self.deviations.combinations();
        let of_torque = |(torque, weight): (&f64, &f64)| {
            let (torque, weight) = (*torque, *weight);
            combinations.iter().map(move |deviation| Case { torque, deviation: *deviation, weight })
        };
        let all = self.torque.iter().zip(&weights).flat_map(of_torque).collect();
        Ok(Cases { all, measure })
    }

    fn weights_of_torques(&self, record: &Record) -> Result<Vec<f64>, Diagnostic> {
        let Some(stated) = &self.weights else { return Ok(vec![1.0; self.torque.len()]) };
        let place = record.place_of(Self::NAMES.weights);
        let mut weights = vec![None; self.torque.len()];
        for (Weight { torque, weight }, own) in stated.iter().zip(record.each_inside(Self::NAMES.weights)) {
            let at = self.torque.iter().position(|other| other.to_bits() == torque.to_bits());
            let refused = |message: String| Diagnostic::new(message).at(own.place_of(Weight::NAMES.torque));
            let Some(at) = at else {
                let known = self.torque.iter().map(|torque| format!("{torque} N m")).collect::<Vec<_>>().join(", ");
                return Err(refused(format!("{torque} N m is none of the torques")).help(format!("they are {known}")));
            };
            if weights[at].replace(*weight).is_some() {
                return Err(refused(format!("the torque {torque} N m has two weights")));
            }
        }
        if let Some(missing) = weights.iter().position(Option::is_none) {
            let message = format!("the torque {} N m has no weight", self.torque[missing]);
            return Err(Diagnostic::new(message).at(place).help("give each torque its weight, or none of them"));
        }
        let weights: Vec<f64> = weights.into_iter().flatten().collect();
        if weights.iter().sum::<f64>() <= 0.0 {
            return Err(Diagnostic::new("all weights are 0").at(place));
        }
        Ok(weights)
    }
}

impl Cases {
    /// One value for those of all cases, which are in their order; NaN or an infinite one among them stays one.
    ///
    /// # Panics
    /// When there are not as many values as cases.
    pub fn combined(&self, values: &[f64]) -> f64 {
        assert_eq!(values.len(), self.all.len(), "a value for each case");
        let weighted = || values.iter().zip(self.all.iter().map(|case| case.weight));
        if values.iter().any(|value| !value.is_finite()) {
            return values.iter().copied().find(|value| !value.is_finite()).unwrap_or(f64::NAN);
        }
        let total: f64 = self.all.iter().map(|case| case.weight).sum();
        let mean = || weighted().map(|(value, weight)| value * weight).sum::<f64>() / total;
        match self.measure {
            Measure::Worst => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            Measure::Mean => mean(),
            Measure::Quantile(share) => {
                let mut order: Vec<(f64, f64)> = weighted().map(|(value, weight)| (*value, weight)).collect();
                order.sort_by(|one, two| one.0.total_cmp(&two.0));
                let mut below = 0.0;
                // As many roundings as there are cases.
                let wanted = total * (share - f64::EPSILON * order.len() as f64);
                let found = order.iter().find(|(_, weight)| {
                    below += weight;
                    below >= wanted && *weight > 0.0
                });
                found.or(order.last()).map_or(f64::NAN, |(value, _)| *value)
            }
            Measure::MeanAndSpread(times) => {
                let mean = mean();
                let variance: f64 = weighted().map(|(value, weight)| weight * (value - mean) * (value - mean)).sum();
                mean + times * (variance / total).sqrt()
            }
        }
    }

    /// Of what must be small in every case: the largest value, or where a share of the cases is to be as good, the largest of
    /// those.
    ///
    /// # Panics
    /// As [`Cases::combined`].
    pub fn decisive(&self, values: &[f64]) -> f64 {
        match self.measure {
            Measure::Quantile(_) => self.combined(values),
            _ => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The cases as stretches with the same deviation: the design of each as it is made and mounted, with the torques and
    /// the places of its cases.
    ///
    /// # Errors
    /// As [`Deviation::on`].
    pub fn designs(&self, design: &Design, pair: &GearPair) -> Result<Vec<OffDesign>, Failure> {
        let mut found: Vec<(Deviation, OffDesign)> = Vec::new();
        for (place, case) in self.all.iter().enumerate() {
            if let Some((_, known)) = found.iter_mut().find(|(deviation, _)| *deviation == case.deviation) {
                known.cases.push((place, case.torque));
                continue;
            }
            let design = case.deviation.on(design, pair).map_err(|wrong| Failure::new(wrong.message))?;
            found.push((case.deviation, OffDesign { design, cases: vec![(place, case.torque)] }));
        }
        Ok(found.into_iter().map(|(_, design)| design).collect())
    }
}

/// A design as it is made and mounted.
pub struct OffDesign {
    pub design: Design,
    /// Place among all cases, and torque \[N m\].
    pub cases: Vec<(usize, f64)>,
}

#[cfg(test)]
#[allow(clippy::float_cmp)] // what must be met exactly
mod tests {
    use super::*;
    use declare::declared::{Declared, record_of};
    use declare::record::Value;

    fn loads(given: &[(&str, Value)]) -> (Loads, Record) {
        let torque = ("torque", Value::Axis(vec![50.0, 80.0, 200.0]));
        let all: Vec<(&str, Value)> = std::iter::once(torque).chain(given.iter().cloned()).collect();
        let record = record_of(Loads::MEMBER.fields, &all);
        (Loads::read(&record), record)
    }

    fn cases(given: &[(&str, Value)]) -> Result<Cases, Diagnostic> {
        let (loads, record) = loads(given);
        loads.cases(&record)
    }

    fn weights(given: &[(f64, f64)]) -> Value {
        let of = |(torque, weight): &(f64, f64)| {
            declare::declared::entry(declare::declared::Parameter::to_value(&Weight {
                torque: *torque,
                weight: *weight,
            }))
        };
        Value::List(given.iter().map(of).collect())
    }

    #[test]
    fn cases_are_all_combinations() {
        let slopes = Value::Axis(vec![-15e-6, 0.0, 15e-6]);
        let plane = Value::Axis(vec![0.0, 10e-6]);
        let cases = cases(&[("helix_slope", slopes), ("parallelism_in_plane", plane)]).unwrap();
        assert_eq!(cases.all.len(), 18);
        let second = cases.all[1];
        assert!(second.torque < 51.0 && second.deviation.of_fields == [-15e-6, 0.0, 0.0, 0.0, 0.0, 10e-6, 0.0]);
        assert!(cases.all[6].torque > 79.0);
        assert!(cases.all[2].deviation.of_fields == [0.0; FIELDS]);
    }

    /// Tier: worked by hand.
    #[test]
    fn values_are_combined_as_is_said() {
        let word = |word| ("combine", Value::Choice(word));
        let values = [3.0, 1.0, 8.0];
        let of = |given: &[(&str, Value)]| cases(given).unwrap().combined(&values);
        let close = |found: f64, exact: f64| assert!((found - exact).abs() < 1e-14, "{found} {exact}");
        close(of(&[]), 8.0);
        close(of(&[word("mean")]), 4.0);
        let uneven = ("weights", weights(&[(200.0, 1.0), (50.0, 2.0), (80.0, 1.0)]));
        close(of(&[word("mean"), uneven.clone()]), 3.75);
        let at = |share| ("quantile", Value::Quantity(share));
        close(of(&[word("quantile"), at(0.5), uneven.clone()]), 3.0);
        close(of(&[word("quantile"), at(0.75), uneven.clone()]), 3.0);
        close(of(&[word("quantile"), at(0.76), uneven]), 8.0);
        close(of(&[word("quantile"), at(1.0)]), 8.0);
        close(of(&[word("quantile"), at(0.0)]), 1.0);
        // Variance (1 + 9 + 16)/3.
        close(of(&[word("mean_and_spread"), ("spread", Value::Number(2.0))]), 4.0 + 2.0 * (26.0_f64 / 3.0).sqrt());
        assert!(cases(&[]).unwrap().combined(&[1.0, f64::INFINITY, 2.0]).is_infinite());
    }

    #[test]
    fn what_contradicts_itself_is_refused() {
        let refused = |given: &[(&str, Value)]| cases(given).unwrap_err().message;
        let quantile = ("quantile", Value::Quantity(0.9));
        assert!(refused(&[quantile]).contains("`quantile` goes with `combine: quantile` only"));
        assert!(refused(&[("combine", Value::Choice("quantile"))]).contains("needs its `quantile`"));
        assert!(refused(&[("weights", weights(&[(51.0, 1.0)]))]).contains("51 N m is none of the torques"));
        assert!(refused(&[("weights", weights(&[(50.0, 1.0)]))]).contains("80 N m has no weight"));
        let none = weights(&[(50.0, 0.0), (80.0, 0.0), (200.0, 0.0)]);
        assert!(refused(&[("weights", none)]).contains("all weights are 0"));
        assert!(refused(&[("bearing_span", Value::Quantity(0.1))]).contains("`bearing_span` goes with"));
    }
}
