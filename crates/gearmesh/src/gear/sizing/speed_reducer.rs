//! Golinski's speed reducer: a spur gear pair and its two shafts, small in volume or little stressed, under eleven constraints.
//!
//! Sources: Golinski, Journal of Mechanisms 5 (1970) 287; with one objective as Cagnina, Esquivel and Coello Coello,
//! Informatica 32 (2008) 319 have it; with two, volume and stress of the first shaft, Kurpati, Azarm and Wu, Structural and
//! Multidisciplinary Optimization 23 (2002) 204; with the sum of what is broken as a third RE3-7-5 of Tanabe and Ishibuchi,
//! Applied Soft Computing 89 (2020) 106078. The formulas have dimensions as printed: lengths in cm, volume in cm³ (most texts
//! call it weight). Here points are in SI and are turned into cm; stresses are moments over 0.1 d³ in the sources' unit,
//! which none of them names, so they stay plain numbers. Must not know: how anything is searched.

use super::{Objective, Sizing};
use crate::gear::problem::{Problem, Variable, Worth};
use declare::declared::Words as _;
use declare::units::{LENGTH, RATIO, VOLUME};
use declare::{Declared, Words};

/// What is to be small.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Minimized {
    /// volume of gears and shafts
    Volume,
    /// equivalent stress of the first shaft, in the sources' unit
    Stress,
    /// the sum of what is broken of the constraints, each as RE3-7-5 counts it; then none is to be kept
    Violation,
}

impl Minimized {
    fn objective(self) -> Objective {
        Objective { name: self.word(), dimension: if self == Self::Volume { VOLUME } else { RATIO } }
    }
}

/// Whose constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Constants {
    /// with two objectives: stresses up to 1300 and 1100; jMetal and RE3-7-5 have the same
    #[default]
    Kurpati2002,
    /// 7.4777 for the hubs, 16.9e6, stresses up to 1100 and 850
    Cagnina2008,
    /// Computational Intelligence and Neuroscience (2021): 7.477 for the hubs, 16.91e6, stresses up to 1100 and 850
    Talatahari2021,
}

/// The numbers in which the sources differ.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Numbers {
    /// Of the square of the pinion's teeth, and of their number, in the volume of the gears.
    teeth: [f64; 2],
    /// Of the cubes of the shafts' diameters in the volume.
    hubs: f64,
    /// The square of the first shaft's torsional moment.
    torsion: f64,
    /// The most that each shaft's stress may be.
    stresses: [f64; 2],
}

impl Constants {
    fn numbers(self) -> Numbers {
        let [shortened, single] = [[3.3333, 14.9334], [1100.0, 850.0]];
        match self {
            Self::Kurpati2002 => {
                Numbers { teeth: [10.0 / 3.0, 14.933], hubs: 7.477, torsion: 1.69e7, stresses: [1300.0, 1100.0] }
            }
            Self::Cagnina2008 => Numbers { teeth: shortened, hubs: 7.4777, torsion: 16.9e6, stresses: single },
            Self::Talatahari2021 => Numbers { teeth: shortened, hubs: 7.477, torsion: 16.91e6, stresses: single },
        }
    }
}

/// How the pinion's number of teeth is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Teeth {
    /// rounded to the nearest whole number
    #[default]
    Whole,
    /// as it is, which no gear can have
    Real,
}

/// Golinski's speed reducer: face width, module, teeth and shafts of a spur gear pair.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "speed_reducer")]
pub struct SpeedReducer {
    /// what is to be small, one or several
    #[declared(default = "volume")]
    pub minimize: Vec<Minimized>,
    /// whose constants
    #[declared(default = "kurpati2002")]
    pub constants: Constants,
    /// how the pinion's number of teeth is taken
    #[declared(default = "whole")]
    pub teeth: Teeth,
    /// least length of the second shaft between its bearings: 7.3 cm in most sources, 7.8 cm in some
    #[declared(minimum = 0.073, maximum = 0.083, dimension = LENGTH, default = "7.3 cm")]
    pub second_length: f64,
}

impl Sizing for SpeedReducer {
    fn objectives(&self) -> Vec<Objective> {
        self.minimize.iter().map(|minimized| minimized.objective()).collect()
    }

    fn problem(&self) -> Box<dyn Problem> {
        Box::new(self.clone())
    }
}

/// The constraints in the order of the sources.
const CONSTRAINTS: [&str; 11] = [
    "bending stress of the teeth",
    "surface stress of the teeth",
    "deflection of the first shaft",
    "deflection of the second shaft",
    "stress of the first shaft",
    "stress of the second shaft",
    "diameter of the pinion",
    "face width of five modules at least",
    "face width of twelve modules at most",
    "length of the first shaft for its diameter",
    "length of the second shaft for its diameter",
];

/// Which of the variables is the pinion's number of teeth.
const TEETH: usize = 2;
/// Metres in the unit of the formulas.
const CENTIMETRE: f64 = 1e-2;
const CUBIC_CENTIMETRE: f64 = 1e-6;

/// A point in the unit of the formulas.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reducer {
    width: f64,
    module: f64,
    teeth: f64,
    lengths: [f64; 2],
    diameters: [f64; 2],
    numbers: Numbers,
}

impl Reducer {
    /// \[cm³\].
    #[allow(clippy::approx_constant, reason = "π/4 as it is printed")]
    fn volume(&self) -> f64 {
        let [square, linear] = self.numbers.teeth;
        let gears = (square * self.teeth + linear) * self.teeth - 43.0934;
        let [first, second] = self.diameters;
        let shafts = self.lengths[0] * first * first + self.lengths[1] * second * second;
        0.7854 * self.width * self.module * self.module * gears - 1.508 * self.width * (first * first + second * second)
            + self.numbers.hubs * (first * first * first + second * second * second)
            + 0.7854 * shafts
    }

    /// Equivalent stresses of both shafts.
    fn stresses(&self) -> [f64; 2] {
        let stress = |shaft: usize, torsion: f64| {
            let bending = 745.0 * self.lengths[shaft] / (self.module * self.teeth);
            let diameter = self.diameters[shaft];
            (bending * bending + torsion).sqrt() / (0.1 * diameter * diameter * diameter)
        };
        [stress(0, self.numbers.torsion), stress(1, 157.5e6)]
    }

    /// A measure of each shaft's deflection.
    fn deflections(&self) -> [f64; 2] {
        let deflection = |shaft: usize| {
            let (length, square) = (self.lengths[shaft], self.diameters[shaft] * self.diameters[shaft]);
            length * length * length / (self.module * self.teeth * square * square)
        };
        [deflection(0), deflection(1)]
    }

    /// What the stresses of the teeth go with: b m² z, b m² z².
    fn tooth_sizes(&self) -> [f64; 2] {
        let bending = self.width * self.module * self.module * self.teeth;
        [bending, bending * self.teeth]
    }

    /// The least lengths of the shafts.
    fn least_lengths(&self) -> [f64; 2] {
        [1.5 * self.diameters[0] + 1.9, 1.1 * self.diameters[1] + 1.9]
    }

    /// What is left of each constraint, in shares of its limit: −g of the source.
    fn reserves(&self) -> Vec<f64> {
        let ([bending, surface], [first, second]) = (self.tooth_sizes(), self.deflections());
        let (stresses, limits) = (self.stresses(), self.numbers.stresses);
        let (lengths, width) = (self.least_lengths(), self.width / self.module);
        let used = [
            27.0 / bending,
            397.5 / surface,
            1.93 * first,
            1.93 * second,
            stresses[0] / limits[0],
            stresses[1] / limits[1],
            self.module * self.teeth / 40.0,
            5.0 / width,
            width / 12.0,
            lengths[0] / self.lengths[0],
            lengths[1] / self.lengths[1],
        ];
        used.iter().map(|used| 1.0 - used).collect()
    }

    /// The third objective of RE3-7-5.
    fn violation(&self) -> f64 {
        let ([bending, surface], [first, second]) = (self.tooth_sizes(), self.deflections());
        let (stresses, limits) = (self.stresses(), self.numbers.stresses);
        let (lengths, width) = (self.least_lengths(), self.width / self.module);
        let broken = [
            1.0 / bending - 1.0 / 27.0,
            1.0 / surface - 1.0 / 397.5,
            first - 1.0 / 1.93,
            second - 1.0 / 1.93,
            self.module * self.teeth - 40.0,
            width - 12.0,
            5.0 - width,
            lengths[0] - self.lengths[0],
            lengths[1] - self.lengths[1],
            stresses[0] - limits[0],
            stresses[1] - limits[1],
        ];
        broken.iter().map(|broken| broken.max(0.0)).sum()
    }
}

impl SpeedReducer {
    fn at(&self, point: &[f64]) -> Reducer {
        let length = |axis: usize| point[axis] / CENTIMETRE;
        Reducer {
            width: length(0),
            module: length(1),
            teeth: point[TEETH],
            lengths: [length(3), length(4)],
            diameters: [length(5), length(6)],
            numbers: self.constants.numbers(),
        }
    }

    fn keeps_constraints(&self) -> bool {
        !self.minimize.contains(&Minimized::Violation)
    }
}

impl Problem for SpeedReducer {
    fn variables(&self) -> Vec<Variable> {
        let length = |name, [minimum, maximum]: [f64; 2]| Variable {
            name,
            dimension: LENGTH,
            minimum: minimum * CENTIMETRE,
            maximum: maximum * CENTIMETRE,
        };
        vec![
            length("face_width", [2.6, 3.6]),
            length("module", [0.7, 0.8]),
            Variable { name: "teeth", dimension: RATIO, minimum: 17.0, maximum: 28.0 },
            length("first_length", [7.3, 8.3]),
            Variable { minimum: self.second_length, ..length("second_length", [7.3, 8.3]) },
            length("first_diameter", [2.9, 3.9]),
            length("second_diameter", [5.0, 5.5]),
        ]
    }

    fn constraints(&self) -> &'static [&'static str] {
        if self.keeps_constraints() { &CONSTRAINTS } else { &[] }
    }

    fn worth(&self, point: &[f64]) -> Worth {
        let reducer = self.at(&self.resolved(point));
        let value = |minimized: &Minimized| match minimized {
            Minimized::Volume => reducer.volume() * CUBIC_CENTIMETRE,
            Minimized::Stress => reducer.stresses()[0],
            Minimized::Violation => reducer.violation(),
        };
        let mut objectives = self.minimize.iter().map(value);
        let objective = objectives.next().unwrap_or(f64::NAN);
        let constraints = if self.keeps_constraints() { reducer.reserves() } else { Vec::new() };
        Worth { objective, further: objectives.collect(), constraints }
    }

    fn resolved(&self, point: &[f64]) -> Vec<f64> {
        let mut resolved = point.to_vec();
        if self.teeth == Teeth::Whole {
            resolved[TEETH] = point[TEETH].round_ties_even();
        }
        resolved
    }
}

#[cfg(test)]
mod tests;
