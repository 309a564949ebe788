//! Every message: where, what was found, what was expected, what to write instead.

use super::{changed, each_is_refused, load};

const CHANGES: &[(&str, &str, &str)] = &[
    ("module: 3 mm", "module: 3", "8:13: `3` has no unit; a length is expected, for example `3 mm`"),
    ("module: 3 mm", "module: 3 N", "8:13: `3 N` is a force; a length (for example `3 mm`) is expected"),
    (
        "module: 3 mm",
        "module: 3 mm^4",
        "8:13: `3 mm^4` is a quantity in m^4; a length (for example `3 mm`) is expected",
    ),
    ("module: 3 mm", "module: 3 mm^3", "8:13: `3 mm^3` is a volume; a length (for example `3 mm`) is expected"),
    (
        "module: 3 mm",
        "module: 3 furlong",
        "8:13: unknown unit `furlong` in `3 furlong`; a length (for example `3 mm`) is expected\n  help: known here: `mm`, `um`, `m`",
    ),
    (
        "module: 3 mm",
        "module: 3 nn",
        "8:13: unknown unit `nn` in `3 nn`; a length (for example `3 mm`) is expected\n  help: known here: `mm`, `um`, `m`",
    ),
    (
        "module: 3 mm",
        "module: 3 m(",
        "8:13: `m(` in `3 m(` cannot be read as a unit: a bracket is not closed; a length (for example `3 mm`) is expected\n  help: units are written like `mm`, `N m`, `N/(mm um)` or `1/um^2`",
    ),
    ("module: 3 mm", "module: .nan", "8:13: `.nan` is not finite; a length (for example `3 mm`) is expected"),
    ("module: 3 mm", "module: -.inf", "8:13: `-.inf` is not finite; a length (for example `3 mm`) is expected"),
    (
        "module: 3 mm",
        "module: 1e999 mm",
        "8:13: `1e999 mm` is too large a number; a length (for example `3 mm`) is expected",
    ),
    ("module: 3 mm", "module: 3e9 mm", "8:13: `module` must be between 10 um and 100 mm, not `3e9 mm`"),
    ("module: 3 mm", "module: three", "8:13: `three` is not a number; a length (for example `3 mm`) is expected"),
    (
        "module: 3 mm",
        "module:",
        "8:5: `module` has no value; a length (for example `3 mm`) is expected\n  help: Module m.",
    ),
    (
        "module: 3 mm",
        "module: ~",
        "8:13: `module` has no value; a length (for example `3 mm`) is expected\n  help: Module m.",
    ),
    (
        "module: 3 mm",
        "module: [1 mm, 2 mm]",
        "8:13: `module` takes one value, not a list\n  help: a length (for example `3 mm`) is expected",
    ),
    (
        "module: 3 mm",
        "module: { a: b }",
        "8:13: `module` takes one value, not a mapping\n  help: a length (for example `3 mm`) is expected",
    ),
    ("module: 3 mm", "modul: 3 mm", "8:5: unknown field `modul` of `pair`\n  help: did you mean `module`?"),
    (
        "module: 3 mm\n    ",
        "",
        "6:3: `pair` has no `module`; a length (for example `3 mm`) is expected\n  help: Module m.",
    ),
    (
        "module: 3 mm",
        "module: 3 mm\n    module: 3 mm",
        "9:5: `module` stands here a second time\n  help: the first is in line 8; keep one of them",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: 1.25 mm }",
        "9:23: `1.25 mm` has a unit; `addendum` is a plain number\n  help: a quantity in `mm` is another quantity, not this number with a unit",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: 12.5 % }",
        "9:23: `12.5 %` has a unit; `addendum` is a plain number\n  help: write `0.125`",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: '1.25' }",
        "9:23: `1.25` is text in quotes; a plain number is expected\n  help: write the number without quotes",
    ),
    ("{ addendum: 1.25 }", "{ addendum: 5 }", "9:23: `addendum` must be between 0.1 and 2, not `5`"),
    ("{ addendum: 1.25 }", "{ shift: -2 }", "9:20: `shift` must be at least -1, not `-2`"),
    (
        "{ addendum: 1.25 }",
        "1.25",
        "9:11: `rack` is `1.25`; a mapping from its fields to their values is expected\n  help: its fields are `addendum`, `shift`",
    ),
    (
        "{ addendum: 1.25 }",
        "[1.25]",
        "9:11: `rack` is a list; a mapping from its fields to their values is expected\n  help: its fields are `addendum`, `shift`",
    ),
    (
        "{ addendum: 1.25 }",
        "",
        "9:5: `rack` has no value; a mapping with the fields `addendum`, `shift` is expected\n  help: The basic rack.",
    ),
    ("teeth: 19", "teeth: 19.0", "10:22: `teeth` must be a whole number in digits, not `19.0`\n  help: write `19`"),
    (
        "teeth: 19",
        "teeth: 19 mm",
        "10:22: `teeth` must be a whole number without a unit, not `19 mm`\n  help: a quantity in `mm` is another quantity, no count",
    ),
    ("teeth: 19", "teeth: 19.5", "10:22: `teeth` must be a whole number in digits, not `19.5`"),
    (
        "teeth: 19",
        "teeth: 99999999999999999999",
        "10:22: `teeth` must be between 5 and 1000, not `99999999999999999999`",
    ),
    ("teeth: 19", "teeth: 3", "10:22: `teeth` must be between 5 and 1000, not `3`"),
    ("teeth: 19", "teeth: '19'", "10:22: `teeth` must be a whole number without quotes, not `19`\n  help: write `19`"),
    ("teeth: 19", "teeth: nineteen", "10:22: `teeth` must be a whole number in digits, not `nineteen`"),
    ("teeth: 19", "teeth: [19]", "10:22: `teeth` is a list; a whole number is expected"),
    ("teeth: 19, ", "", "10:5: `pinion` has no `teeth`; a whole number is expected\n  help: Number of teeth z."),
    ("face_width: 20 mm", "face_width: -20 mm", "10:38: `face_width` must be between 10 um and 1 m, not `-20 mm`"),
    ("overlap: 12.5 %", "overlap: 120 %", "11:14: `overlap` must be between 0 and 1, not `120 %`"),
    (
        "overlap: 12.5 %",
        "overlap: 3 mm",
        "11:14: `3 mm` is a length; a ratio (a plain number or one with `%`) is expected",
    ),
    ("overlap: 12.5 %", "ground: yes", "11:13: `ground` is `yes`; `true` or `false` is expected"),
    ("overlap: 12.5 %", "side: rigth", "11:11: `side` cannot be `rigth`\n  help: did you mean `right`?"),
    ("overlap: 12.5 %", "side: up", "11:11: `side` cannot be `up`\n  help: known here: `left`, `right`"),
    ("overlap: 12.5 %", "side: [left]", "11:11: `side` is a list; `left` or `right` is expected"),
    ("overlap: 12.5 %", "note: impossible", "6:3: this pair is impossible"),
    ("overlap: 12.5 %", "note: [a]", "11:11: `note` is a list; text is expected"),
    ("kind: geometry", "kind: geometri", "7:11: unknown kind of stage: `geometri`\n  help: did you mean `geometry`?"),
    (
        "kind: geometry",
        "kind: zzz",
        "7:11: unknown kind of stage: `zzz`\n  help: known here: `geometry`, `modification`, `optimizer`, `ste`, `report`",
    ),
    (
        "kind: geometry",
        "kind:",
        "6:3: stage `pair` has no `kind`\n  help: kinds are `geometry`, `modification`, `optimizer`, `ste` or `report`",
    ),
    (
        "kind: geometry",
        "kind: [geometry]",
        "7:11: unknown kind of stage: a list\n  help: known here: `geometry`, `modification`, `optimizer`, `ste`, `report`",
    ),
    (
        "    kind: geometry\n",
        "",
        "6:3: stage `pair` has no `kind`\n  help: kinds are `geometry`, `modification`, `optimizer`, `ste` or `report`",
    ),
    (
        "  pair:\n",
        "  Pair:\n",
        "6:3: `Pair` cannot be the name of a stage\n  help: lower-case letters, digits, `-` and `_` make a name, at most 64 of them: for example `pair`",
    ),
    (
        "  pair:\n",
        "  ä:\n",
        "6:3: `ä` cannot be the name of a stage\n  help: lower-case letters, digits, `-` and `_` make a name, at most 64 of them",
    ),
    ("    pair: pair\n", "    pair: par\n", "14:11: there is no stage `par`\n  help: did you mean `pair`?"),
    ("    pair: pair\n", "    pair: zzz\n", "14:11: there is no stage `zzz`\n  help: stages that fit here: `pair`"),
    (
        "    pair: pair\n",
        "    pair: ste\n",
        "14:11: `ste` is a `ste` stage; the name of a `geometry` stage is expected\n  help: stages that fit here: `pair`",
    ),
    (
        "designs: [designs, optimum]",
        "designs: [designs, pair]",
        "29:24: `pair` is a `geometry` stage; the name of a `modification` or `optimizer` stage is expected\n  help: stages that fit here: `designs` or `optimum`",
    ),
    (
        "designs: [designs, optimum]",
        "designs: [designs, ~]",
        "29:24: `designs` has no value; the name of a `modification` or `optimizer` stage is expected\n  help: What is run.",
    ),
    (
        "designs: [designs, optimum]",
        "designs: { a: b }",
        "29:14: `designs` is a mapping; the name of a `modification` or `optimizer` stage is expected",
    ),
    (
        "    designs: [designs, optimum]\n",
        "    designs: [designs, optimum]\n    before: ste\n",
        "30:13: stage `ste` refers to itself",
    ),
    ("plain: []", "plain:", "16:7: `plain` has no value; a list is expected\n  help: write `[]` for an empty list"),
    (
        "plain: []",
        "a,b: []",
        "16:7: `a,b` cannot be a name in `designs`\n  help: letters, digits, `-`, `_` and `.` make a name, at most 64 of them",
    ),
    (
        "plain: []",
        "plain: [tip_releif]",
        "16:15: unknown name `tip_releif` in `plain`\n  help: did you mean `tip_relief`?",
    ),
    (
        "plain: []",
        "plain: [tip_relief]",
        "16:15: `tip_relief` has no `amount`; a length (for example `12 um`) is expected\n  help: Relief C_a.",
    ),
    (
        "plain: []",
        "plain: [[nothing]]",
        "16:15: `plain` takes one of `tip_relief`, `lead_crowning` or `nothing`, not a list",
    ),
    ("plain: []", "plain: [{}]", "16:15: `plain` is empty; `tip_relief`, `lead_crowning` or `nothing` is expected"),
    (
        "plain: []",
        "plain: [nothing: 3]",
        "16:24: `nothing` is `3`; a mapping from its fields to their values is expected\n  help: it has no fields: write only its name",
    ),
    (
        "plain: []",
        "plain: [tip_relief: 3]",
        "16:27: `tip_relief` is `3`; a mapping from its fields to their values is expected\n  help: its fields are `amount`, `length`",
    ),
    (
        "plain: []",
        "plain: { tip_relief: , amount: 3 mm }",
        "16:30: `tip_relief` and `amount` stand side by side; `plain` takes one\n  help: indent `amount` and what follows further than `tip_relief`",
    ),
    (
        "plain: []",
        "plain: { tip_relief: {}, nothing: }",
        "16:32: `tip_relief` and `nothing` stand side by side; `plain` takes one\n  help: in a list, each starts with `- ` on a line of its own",
    ),
    (
        "plain: []",
        "plain: { tip_relief: { amount: [0 um, 8 um] } }",
        "16:38: `amount` takes one value here, not a range\n  help: a range `[least, most]` belongs in `design` of a stage of kind `optimizer`",
    ),
    (
        "amount: [0 um, 8 um]",
        "amount: [8 um, 0 um]",
        "25:31: a range is `[least, most]`; `8 um` is not below `0 um`\n  help: a value that is fixed is written without brackets",
    ),
    ("amount: [0 um, 8 um]", "amount: [8 um]", "25:31: `amount` takes a range `[least, most]`, not a list of 1"),
    ("amount: [0 um, 8 um]", "amount: [0 um, 8]", "25:38: `8` has no unit; a length is expected, for example `8 um`"),
    (
        "amount: [0 um, 8 um]",
        "amount: { from: 0 um, to: 8 um }",
        "25:31: `amount` takes one value, not a mapping\n  help: a length (for example `12 um`) is expected",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25,5 N m, to: 100 N m, count: 16 }",
        "30:21: `25,5 N m` is two values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `25.5 N m`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25 N m, to: 10 N m, count: 16 }",
        "30:33: `to` (`10 N m`) must be above `from` (`25 N m`)",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25 N m, to: 100 N m, count: 1 }",
        "30:49: `torque` must have between 2 and 100000 values, not `1`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25 N m, to: 100 N m, count: 1000000 }",
        "30:49: `torque` must have between 2 and 100000 values, not `1000000`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25 N m, to: 100 N m, steps: 16 }",
        "30:42: unknown field `steps` of `torque`\n  help: known here: `from`, `to`, `count`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 25 N m, to: 100 N m }",
        "30:13: `torque` has no `count`\n  help: evenly spaced values are `{ from: …, to: …, count: … }`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "{ from: 1 N m, to: 1.0000000000000002 N m, count: 3 }",
        "30:63: 3 different values do not fit between `1 N m` and `1.0000000000000002 N m`",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "[50 N m, 50000 N mm]",
        "30:22: `torque` already has this value: `50000 N mm`\n  help: keep one of them",
    ),
    (
        "{ from: 25 N m, to: 100 N m, count: 16 }",
        "[]",
        "30:13: `torque` is an empty list; at least one value is expected",
    ),
    (
        "cells: ste.summary.peak_to_peak",
        "cells: stee.summary.peak_to_peak",
        "33:12: there is no stage `stee`\n  help: did you mean `ste`?",
    ),
    (
        "cells: ste.summary.peak_to_peak",
        "cells: [ste.sumary.peak_to_peak]",
        "33:13: stage `ste` has no table `sumary`\n  help: did you mean `summary`?",
    ),
    (
        "cells: ste.summary.peak_to_peak",
        "cells: [ste.summary.peak_to_peak, ste.summary.peak]",
        "33:39: table `ste.summary` has no column `peak`\n  help: did you mean `peak_to_peak`?",
    ),
    ("cells: ste.summary.peak_to_peak", "cells: report.summary.peak_to_peak", "33:12: stage `report` refers to itself"),
    (
        "value: 2.316 um",
        "value: around 2",
        "34:12: `around 2` is not a number with a unit that is known; value needs one\n  help: units are written like `um`, `N m`, `N/(mm um)` or `1/um^2`",
    ),
    (
        "study: small",
        "study: Small Study",
        "1:8: `Small Study` cannot be the name of a study\n  help: lower-case letters, digits, `-` and `_` make a name, at most 64 of them: for example `small-study`",
    ),
    (
        "study: small",
        "study:",
        "1:1: `study` has no value; text is expected\n  help: The study's name: the folder of its results.",
    ),
    (
        "study: small\n",
        "",
        "1:1: the study has no `study`; text is expected\n  help: The study's name: the folder of its results.",
    ),
    ("study: small", "stduy: small", "1:1: unknown field `stduy` of the study\n  help: did you mean `study`?"),
    ("seed: 7", "seed: -1", "4:7: `seed` must be at least 0, not `-1`"),
    (
        "seed: 7",
        "seed: 9223372036854775808",
        "4:7: `seed` must be between 0 and 9223372036854775807, not `9223372036854775808`",
    ),
    ("tables: [1, 2]", "tables: [1, A]", "3:38: `tables` must be a whole number in digits, not `A`"),
    (
        "source: { paper: nobody, tables: [1, 2], figures: 3 }",
        "source: nobody",
        "3:9: `source` is `nobody`; a mapping from its fields to their values is expected\n  help: its fields are `paper`, `tables`, `figures`",
    ),
    (
        "  report:\n",
        "  second:\n    kind: ste\n    pair: pair\n    designs: []\n    torque: 1 N m\n    before: third\n  third: { kind: ste, pair: pair, designs: [], torque: 1 N m, before: second }\n  report:\n",
        "37:71: these stages read each other in a circle: `second` → `third` → `second`\n  help: a stage can only read what is finished before it",
    ),
    (
        "    around: designs",
        "    around: optimum",
        "35:13: `optimum` is an `optimizer` stage; the name of a `modification` or `report` stage is expected\n  help: stages that fit here: `designs`",
    ),
    (
        "    around: designs",
        "    around: second\n  second: { kind: report }",
        "35:13: stage `second` reads nothing as `pair`",
    ),
    (
        "title: A small study of 5 µm",
        "title: 'µµ'\nsed: 7",
        "3:1: unknown field `sed` of the study\n  help: did you mean `seed`?",
    ),
    ("paper: nobody", "paper: µµ, table: 3", "3:22: unknown field `table` of `source`\n  help: did you mean `tables`?"),
    (
        "design:\n      - tip_relief: { amount: [0 um, 8 um], length: 2 mm }",
        "design: nothing\n    method: { tip_relief: { amount: [0 um, 8 um] } }",
        "25:37: `amount` takes one value here, not a range\n  help: a range `[least, most]` belongs in `design` of a stage of kind `optimizer`",
    ),
    (
        "study: small",
        "study: a-name-that-is-longer-than-a-folder-of-results-should-have-it-here",
        "1:8: `a-name-that-is-longer-than-a-folder-of-results-should-have-i…` cannot be the name of a study\n  help: lower-case letters, digits, `-` and `_` make a name, at most 64 of them: for example `a-name-that-is-longer-than-a-folder-of-results-should-have-it-he`",
    ),
    (
        "overlap: 12.5 %",
        "bolts: 7",
        "11:12: `bolts` must be an even number between 4 and 12, not `7`\n  help: write `6` or `8`",
    ),
    (
        "overlap: 12.5 %",
        "bolts: 3",
        "11:12: `bolts` must be an even number between 4 and 12, not `3`\n  help: write `4`",
    ),
    (
        "overlap: 12.5 %",
        "bolts: 900",
        "11:12: `bolts` must be an even number between 4 and 12, not `900`\n  help: write `12`",
    ),
];

#[test]
fn a_study_with_one_mistake_gets_its_message() {
    each_is_refused(CHANGES);
}

#[test]
fn the_place_covers_what_is_wrong() {
    for (old, new, covered) in [
        ("module: 3 mm", "module: 3 N # not a length", "3 N"),
        ("title: A small study of 5 µm\n", "title: 5 µm\r\nµµ: 5 µm\r\n", "µµ"),
        ("module: 3 mm", "module: '3 N'", "'3 N'"),
        ("amount: [0 um, 8 um]", "amount: [8 um, 0 um]", "[8 um, 0 um]"),
        ("designs: [designs, optimum]", "designs: [designs, optimun]", "optimun"),
        ("module: 3 mm", "", "pair"),
    ] {
        let error = load(&changed(old, new)).err().unwrap();
        let place = error.diagnostic.place.unwrap();
        assert_eq!(&error.text[place.offset..place.offset + place.length], covered, "{error}");
    }
}
