"""Validates every study against schemas/study.schema.json, and a few mistakes that must be refused."""

import copy
import json
import pathlib

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
print(f"{len(studies)} studies, {len(mistakes)} mistakes")
