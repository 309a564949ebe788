//! Numbers in other notations and names that no file can have: refused with what to write instead.

use super::each_is_refused;

const CHANGES: &[(&str, &str, &str)] = &[
    (
        "teeth: 19",
        "teeth: 0x18",
        "10:22: `teeth` must be a whole number in digits, not `0x18`\n  help: `0x18` in decimal digits is `24`",
    ),
    (
        "teeth: 19",
        "teeth: 0o30",
        "10:22: `teeth` must be a whole number in digits, not `0o30`\n  help: `0o30` in decimal digits is `24`",
    ),
    (
        "teeth: 19",
        "teeth: 030",
        "10:22: `teeth` must be a whole number in digits, not `030`\n  help: write `30`, without zeros in front",
    ),
    (
        "teeth: 19",
        "teeth: 1:30",
        "10:22: `teeth` must be a whole number in digits, not `1:30`\n  help: nothing is counted in sixties: write one number in decimal digits, `1.5` for `1:30`",
    ),
    (
        "teeth: 19",
        "teeth: 1_000",
        "10:22: `teeth` must be a whole number in digits, not `1_000`\n  help: nothing parts thousands: write `1000`",
    ),
    ("teeth: 19", "teeth: 3e1", "10:22: `teeth` must be a whole number in digits, not `3e1`\n  help: write `30`"),
    ("teeth: 19", "teeth: 19x", "10:22: `teeth` must be a whole number in digits, not `19x`"),
    (
        "addendum: 1.25",
        "addendum: 01.25",
        "9:23: `01.25` is not a number as a study has it; a plain number is expected\n  help: write `1.25`, without zeros in front",
    ),
    (
        "module: 3 mm",
        "module: 0x3 mm",
        "8:13: `0x3 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: `0x3` in decimal digits is `3`",
    ),
    (
        "module: 3 mm",
        "module: 3,5 mm",
        "8:13: `3,5 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: a decimal point, not a comma, and nothing parts thousands: write `3.5 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3,000 um",
        "8:13: `3,000 um` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: a decimal point, not a comma, and nothing parts thousands: write `3000 um`, or `3.000 um` if the comma is a decimal one",
    ),
    (
        "value: 2.316 um",
        "value: 2,316 um",
        "34:12: `2,316 um` is not a number as a study has it; value needs one\n  help: a decimal point, not a comma, and nothing parts thousands: write `2.316 um`, or `2316 um` if the comma parts thousands",
    ),
    (
        "value: 2.316 um",
        "value: 1_000 um",
        "34:12: `1_000 um` is not a number as a study has it; value needs one\n  help: nothing parts thousands: write `1000 um`",
    ),
    (
        "module: 3 mm",
        "module: 3,014 ± 0,001 mm",
        "8:13: `3,014 ± 0,001 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: a decimal point, not a comma, and nothing parts thousands: write `3.014 ± 0.001 mm`",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: 1,25 ± 0,005, shift: 0.1 }",
        "9:23: `1,25 ± 0,005` is several values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `1.25 ± 0.005`",
    ),
    (
        "face_width: 20 mm",
        "face_width: 20,5 mm ± 0,01 mm",
        "10:38: `20,5 mm ± 0,01 mm` is several values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `20.5 mm ± 0.01 mm`",
    ),
    (
        "face_width: 20 mm",
        "face_width: 20.5 ± 0,01 mm",
        "10:38: `20.5 ± 0,01 mm` is two values to YAML: a decimal point, not a comma, and nothing parts thousands\n  help: write `20.5 ± 0.01 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.000(5) mm",
        "8:13: `3.000(5) mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: digits in brackets are not read: write `3.000 mm`, or as an interval `3.000 ± 0.005 mm`",
    ),
    (
        "module: 3 mm",
        "module: (3.000 ± 0.005) mm",
        "8:13: `(3.000 ± 0.005) mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: an interval is written `3.000 ± 0.005 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.000 \\u00b1 0.005 mm",
        "8:13: `3.000 \\u00b1 0.005 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: an interval is written `3.000 ± 0.005 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.000 $\\pm$ 0.005 mm",
        "8:13: `3.000 $\\pm$ 0.005 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: an interval is written `3.000 ± 0.005 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.000 +0.002/-0.001 mm",
        "8:13: `3.000 +0.002/-0.001 mm` is not a number as a study has it; a length (for example `3 mm`) is expected\n  help: an interval is as wide to both sides: `0.504 ± 0.0005` is its middle and half of its width",
    ),
    (
        "module: 3 mm",
        "module: 3.000 ± 1 um",
        "8:13: the unit of `3.000 ± 1 um` is that of both numbers, so `module` would be `3.000 um`\n  help: write `3.000 mm ± 1 um`, or `3.000 um ± 1 um` if it is",
    ),
    (
        "module: 3 mm",
        "module: 3.000 ±± 1 um",
        "8:13: `3.000 ±± 1 um` has more than one sign; a length (for example `3 mm`) is expected\n  help: an interval is written `0.504 ± 0.0005`, or `5.05 ± 0.005 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.000 ± some um",
        "8:13: `some um` is not a number; a length (for example `3 mm`) is expected",
    ),
    (
        "module: 3 mm",
        "module: 3.000 ± 1",
        "8:13: `3.000 ± 1` has no unit; a length is expected, for example `3.000 ± 1 mm`",
    ),
    ("module: 3 mm", "module: 3.000 ± 1 deg", "8:13: `1 deg` is an angle; a length (for example `3 mm`) is expected"),
    (
        "module: 3 mm",
        "module: 3.0 mm ± 0.5 %",
        "8:13: `0.5 %` behind the sign of `3.0 mm ± 0.5 %` is a ratio; a length (for example `3 mm`) is expected\n  help: write `3 mm ± 0.015 mm`",
    ),
    (
        "module: 3 mm",
        "module: 3.0 ± 0.5 %",
        "8:13: `0.5 %` behind the sign of `3.0 ± 0.5 %` is a ratio; a length (for example `3 mm`) is expected\n  help: write `3 mm ± 0.015 mm`",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: 1.25 ± 0.4 % }",
        "9:23: `1.25 ± 0.4 %` can be read in two ways; a plain number is expected\n  help: write `1.25 ± 0.005` for 0.4 % of 1.25, `1.25 ± 0.004` for 0.4 % of 1",
    ),
    (
        "{ addendum: 1.25 }",
        "{ addendum: 125 % ± 0.4 % }",
        "9:23: `125 % ± 0.4 %` has a unit; `addendum` is a plain number\n  help: write `1.25 ± 0.004`",
    ),
    (
        "overlap: 12.5 %",
        "overlap: 0.1 ± 0.5 %",
        "11:14: `0.1 ± 0.5 %` can be read in two ways; a ratio (a plain number or one with `%`) is expected\n  help: write `0.1 ± 0.0005` for 0.5 % of 0.1, `0.1 ± 0.005` for 0.5 % of 1, or `0.1 % ± 0.5 %` in percent",
    ),
    (
        "overlap: 12.5 %",
        "overlap: 10 % ± 0.5",
        "11:14: `10 % ± 0.5` can be read in two ways; a ratio (a plain number or one with `%`) is expected\n  help: write `%` behind both numbers, or behind none",
    ),
    (
        "count: 16",
        "count: 016",
        "30:49: `count` is a whole number in digits\n  help: write `16`, without zeros in front",
    ),
    (
        "study: small",
        "study: con",
        "1:8: `con` cannot be the name of a study\n  help: Windows keeps it for a device, so no file there can have it: for example `con-study`",
    ),
    (
        "study: small",
        "study: NUL",
        "1:8: `NUL` cannot be the name of a study\n  help: Windows keeps it for a device, so no file there can have it: for example `nul-study`",
    ),
    (
        "  report:\n",
        "  lpt9:\n",
        "31:3: `lpt9` cannot be the name of a stage\n  help: Windows keeps it for a device, so no file there can have it: for example `lpt9-stage`",
    ),
];

#[test]
fn other_notations_and_names_of_devices_are_refused_with_what_to_write() {
    each_is_refused(CHANGES);
}
