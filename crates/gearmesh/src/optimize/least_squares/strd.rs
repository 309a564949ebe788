//! Certified values: Statistical Reference Datasets of the National Institute of Standards and Technology, nonlinear regression.
//!
//! Misra1a (lower difficulty), Thurber and MGH09 (higher), each from the first and the second of its starts. Parameters, their
//! standard deviations and the sum of squares are certified to eleven digits.

use std::convert::Infallible;

use super::derivative::noise;
use super::uncertainty::Uncertainty;
use super::{Answers, End, Search};

struct Dataset {
    name: &'static str,
    model: fn(&[f64], f64) -> f64,
    /// y and x.
    data: &'static [(f64, f64)],
    starts: [&'static [f64]; 2],
    /// The box is from 0 to this.
    most: &'static [f64],
    certified: &'static [(f64, f64)],
    sum_of_squares: f64,
}

const MISRA1A: Dataset = Dataset {
    name: "Misra1a",
    model: |b, x| b[0] * -libm::expm1(-b[1] * x),
    data: &[
        (10.07, 77.6),
        (14.73, 114.9),
        (17.94, 141.1),
        (23.93, 190.8),
        (29.61, 239.9),
        (35.18, 289.0),
        (40.02, 332.8),
        (44.82, 378.4),
        (50.76, 434.8),
        (55.05, 477.3),
        (61.01, 536.8),
        (66.40, 593.1),
        (75.47, 689.1),
        (81.78, 760.0),
    ],
    starts: [&[500.0, 0.0001], &[250.0, 0.0005]],
    most: &[1000.0, 0.01],
    certified: &[(2.389_421_291_8e2, 2.707_007_524_1), (5.501_564_318_1e-4, 7.266_868_843_6e-6)],
    sum_of_squares: 1.245_513_889_4e-1,
};

const THURBER: Dataset = Dataset {
    name: "Thurber",
    model: |b, x| (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / (1.0 + x * (b[4] + x * (b[5] + x * b[6]))),
    data: &[
        (80.574, -3.067),
        (84.248, -2.981),
        (87.264, -2.921),
        (87.195, -2.912),
        (89.076, -2.840),
        (89.608, -2.797),
        (89.868, -2.702),
        (90.101, -2.699),
        (92.405, -2.633),
        (95.854, -2.481),
        (100.696, -2.363),
        (101.060, -2.322),
        (401.672, -1.501),
        (390.724, -1.460),
        (567.534, -1.274),
        (635.316, -1.212),
        (733.054, -1.100),
        (759.087, -1.046),
        (894.206, -0.915),
        (990.785, -0.714),
        (1090.109, -0.566),
        (1080.914, -0.545),
        (1122.643, -0.400),
        (1178.351, -0.309),
        (1260.531, -0.109),
        (1273.514, -0.103),
        (1288.339, 0.010),
        (1327.543, 0.119),
        (1353.863, 0.377),
        (1414.509, 0.790),
        (1425.208, 0.963),
        (1421.384, 1.006),
        (1442.962, 1.115),
        (1464.350, 1.572),
        (1468.705, 1.841),
        (1447.894, 2.047),
        (1457.628, 2.200),
    ],
    starts: [&[1000.0, 1000.0, 400.0, 40.0, 0.7, 0.3, 0.03], &[1300.0, 1500.0, 500.0, 75.0, 1.0, 0.4, 0.05]],
    most: &[5000.0, 5000.0, 5000.0, 1000.0, 10.0, 10.0, 1.0],
    certified: &[
        (1.288_139_680_0e3, 4.664_796_334_4),
        (1.491_079_253_5e3, 3.957_115_608_6e1),
        (5.832_383_687_7e2, 2.869_869_610_2e1),
        (7.541_664_429_1e1, 5.567_537_027_0),
        (9.662_950_286_4e-1, 3.133_334_068_7e-2),
        (3.979_728_579_7e-1, 1.498_492_819_8e-2),
        (4.972_729_734_9e-2, 6.584_234_462_3e-3),
    ],
    sum_of_squares: 5.642_708_239_7e3,
};

const MGH09: Dataset = Dataset {
    name: "MGH09",
    model: |b, x| b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]),
    data: &[
        (0.1957, 4.0),
        (0.1947, 2.0),
        (0.1735, 1.0),
        (0.1600, 0.5),
        (0.0844, 0.25),
        (0.0627, 0.167),
        (0.0456, 0.125),
        (0.0342, 0.1),
        (0.0323, 0.0833),
        (0.0235, 0.0714),
        (0.0246, 0.0625),
    ],
    starts: [&[25.0, 39.0, 41.5, 39.0], &[0.25, 0.39, 0.415, 0.39]],
    most: &[50.0, 50.0, 50.0, 50.0],
    certified: &[
        (1.928_069_345_8e-1, 1.143_531_222_7e-2),
        (1.912_823_287_3e-1, 1.963_322_091_1e-1),
        (1.230_565_069_3e-1, 8.084_203_123_2e-2),
        (1.360_623_306_8e-1, 9.002_554_230_8e-2),
    ],
    sum_of_squares: 3.075_056_038_5e-4,
};

/// Tier: published value; six digits of what is certified, of which derivatives by differences leave no more than eight.
#[test]
fn certified_values_are_met() {
    for set in [&MISRA1A, &THURBER, &MGH09] {
        let mut model = |points: &[Vec<f64>]| -> Result<Answers, Infallible> {
            let one = |point: &Vec<f64>| set.data.iter().map(|(y, x)| (set.model)(point, *x) - y).collect();
            Ok(points.iter().map(|point| Some(one(point))).collect())
        };
        for start in set.starts {
            let bounds: Vec<(f64, f64)> = set.most.iter().map(|most| (0.0, *most)).collect();
            let Ok(Some(noise)) = noise(&bounds, start, &mut model) else { panic!("{} has no residuals", set.name) };
            let search = Search { bounds, steps: 500, gain: 1e-18, noise };
            let Ok(Some(fit)) = search.from(start, &mut model) else { panic!("{} has no residuals", set.name) };
            assert_eq!((fit.end, fit.freedom()), (End::Settled, set.data.len() - start.len()), "{}", set.name);
            let off = (fit.sum_of_squares / set.sum_of_squares - 1.0).abs();
            assert!(off < 1e-9, "{}: sum of squares off by {off:e} after {} steps", set.name, fit.steps);
            let spread = (fit.sum_of_squares / fit.freedom() as f64).sqrt();
            let uncertainty = Uncertainty::of(&fit);
            let found = fit.point.iter().zip(uncertainty.deviations(spread)).zip(set.certified);
            for (number, ((value, deviation), (certified, its_deviation))) in found.enumerate() {
                let (off, deviation_off) = (value / certified - 1.0, deviation / its_deviation - 1.0);
                let said = format!("{} b{}: off by {off:e}, deviation by {deviation_off:e}", set.name, number + 1);
                assert!(off.abs() < 1e-6 && deviation_off.abs() < 1e-5, "{said}");
            }
        }
    }
}
