"""Validates every study against schemas/study.schema.json, and a few mistakes that must be refused."""

import copy
import json
import math
import pathlib
import re

import jsonschema
import yaml

schema = json.loads(pathlib.Path("schemas/study.schema.json").read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)

studies = sorted(pathlib.Path("studies").glob("*.yaml"))
assert studies
for path in studies:
    study = yaml.safe_load(path.read_text())
    errors = [f"{path}: {'.'.join(map(str, error.absolute_path))}: {error.message[:200]}" for error in validator.iter_errors(study)]
    assert not errors, "\n".join(errors)

quick = yaml.safe_load(pathlib.Path("studies/quick.yaml").read_text())


def spoilt(change):
    study = copy.deepcopy(quick)
    change(study["stages"])
    return study


mistakes = {
    "no unit": lambda stages: stages["pair"].update(module=3),
    "wrong unit": lambda stages: stages["pair"].update(module="3 N"),
    "unknown field": lambda stages: stages["pair"].update(modul="3 mm"),
    "unknown kind": lambda stages: stages["pair"].update(kind="geometri"),
    "missing field": lambda stages: stages["pair"].pop("module"),
    "unknown family": lambda stages: stages["designs"]["designs"].update(short=[{"tip_releif": {}}]),
    "range outside an optimiser": lambda stages: stages["designs"]["designs"]["short"][0]["tip_relief"].update(
        amount=["0 um", "8 um"]
    ),
    "a word that is no choice": lambda stages: stages["stiffness"].update(root="trochoida"),
    "teeth with a unit": lambda stages: stages["pair"]["pinion"].update(teeth="24 mm"),
    "too few teeth": lambda stages: stages["pair"]["pinion"].update(teeth=3),
}
for name, change in mistakes.items():
    assert not validator.is_valid(spoilt(change)), f"accepted: {name}"
# What the program accepts: names that are numbers to YAML, spaces that do not break a line, block scalars.
same = {
    "name": lambda study: study.update(study=2024),
    "name of digits and an e": lambda study: study.update(study=1e3),
    "name that is true": lambda study: study.update(study=True),
    "no-break space": lambda study: study["stages"]["pair"].update(module="3\u00a0mm"),
    "narrow no-break space": lambda study: study["stages"]["pair"].update(module="3\u202fmm"),
    "block scalar": lambda study: study["stages"]["pair"].update(module="3 mm\n"),
    "number of a stage": lambda study: study["stages"]["stiffness"].update(pair=1),
}
for name, change in same.items():
    study = copy.deepcopy(quick)
    change(study)
    errors = [error.message[:200] for error in validator.iter_errors(study)]
    assert not errors, f"refused: {name}: {errors}"
for name in [2024.5, -3]:
    assert not validator.is_valid({**quick, "study": name}), f"accepted: {name}"
# The program takes the same names, as `tests/it/schema.rs` compares.
for line in pathlib.Path("tests/python/names_of_studies.tsv").read_text().splitlines():
    if not line.startswith("#"):
        written, value, name = line.split("\t")
        is_valid = validator.is_valid({**quick, "study": json.loads(value)})
        assert is_valid == (name != "-"), f"{written}: {'accepted' if is_valid else 'refused'}"
# Editors see the key of a merge, which other readers resolve.
for keys in [schema["properties"]["stages"]["propertyNames"], schema["properties"]["set"]["propertyNames"]]:
    assert re.search(keys["pattern"], "<<") and not re.search(keys["pattern"], "<")
print(f"{len(studies)} studies, {len(mistakes)} mistakes")

# Examples and defaults of every field, by the field's own schema; and of the size that studies have.
UNITS = {
    "m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "deg": math.pi / 180, "rad": 1, "mrad": 1e-3, "N": 1, "kN": 1e3,
    "N m": 1, "N mm": 1e-3, "Pa": 1, "MPa": 1e6, "GPa": 1e9, "N/(mm um)": 1e9, "s": 1, "%": 1e-2, "": 1,
}
TREE = "https://json-schema.org/draft/2020-12/schema"


def size(text):
    """A number with a unit, by itself; None for what is no number."""
    found = re.fullmatch(r"([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?) *(.*)", str(text))
    return float(found[1]) * UNITS[found[2]] if found and found[2] in UNITS else None


def has_unit(text):
    return " " in str(text) and "%" not in str(text)


def restored(one):
    """A schema with the definitions that several places share in these places."""
    if isinstance(one, dict):
        name = str(one.get("$ref", "")).removeprefix("#/$defs/")
        if name and not name.startswith(("stage", "kind_", "family_")):
            return restored({**schema["$defs"][name], **{key: inner for key, inner in one.items() if key != "$ref"}})
        return {key: restored(inner) for key, inner in one.items()}
    return [restored(inner) for inner in one] if isinstance(one, list) else one


schema = restored(schema)


def schemas(one):
    """All schemas inside one, without following references."""
    if isinstance(one, dict):
        yield one
    for inner in one.values() if isinstance(one, dict) else one if isinstance(one, list) else []:
        yield from schemas(inner)


def fields(one):
    for inner in schemas(one):
        if isinstance(inner.get("properties"), dict):
            yield from inner["properties"].items()


def on_its_own(inner):
    return jsonschema.Draft202012Validator({"$schema": TREE, "$defs": schema["$defs"], **inner})


offered = 0
sizes = {}
for name, field in [*fields({"properties": schema["properties"]}), *fields(schema["$defs"])]:
    for inner in [inner for inner in schemas(field) if inner is field or "properties" not in inner]:
        for example in [*inner.get("examples", []), *([inner["default"]] if "default" in inner else [])]:
            assert on_its_own(inner).is_valid(example), f"{name}: {example!r} is refused by its own field"
            offered += 1
        if "default" not in field:
            for example in inner.get("examples", []):
                if value := size(example):
                    sizes.setdefault((name, has_unit(example)), set()).add(abs(value))

said = {}


def written(node, name=None):
    if isinstance(node, dict):
        for key, inner in node.items():
            written(inner, name if key in ("from", "to") else key)
    elif isinstance(node, list):
        for inner in node:
            written(inner, name)
    elif not isinstance(node, bool) and (value := size(node)):
        said.setdefault((name, has_unit(node)), []).append(abs(value))


for path in studies:
    written(yaml.safe_load(path.read_text())["stages"])
sized = 0
# Without fields whose numbers mean another thing in each place.
ELSEWHERE = {"x", "y", "value", "values", "with", "any"}
for name in sorted(name for name in sizes.keys() & said.keys() if name[0] not in ELSEWHERE):
    examples = sizes[name]
    far = min(abs(math.log10(example / value)) for example in examples for value in said[name])
    assert far < math.log10(5), f"{name}: {examples} is not of the size that studies say, {min(said[name])} to {max(said[name])}"
    sized += 1
assert offered > 300 and sized > 25, (offered, sized)
print(f"{offered} examples and defaults, {sized} of them beside those of studies")
