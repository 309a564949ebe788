"""Reads an archive with rocrate and runcrate, and holds it to what the profiles of Workflow Run RO-Crate 0.6 ask for.

    python crate.py FILE.zip FOLDER LICENCE

FOLDER is made; rocrate unpacks into it.
"""

import io
import json
import pathlib
import sys
import zipfile

from rocrate.rocrate import ROCrate
from runcrate.report import dump_crate_actions

file, folder, licence = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
crate = ROCrate(file)
root, workflow = crate.root_dataset, crate.mainEntity


def listed(value):
    return [] if value is None else value if isinstance(value, list) else [value]


def types(entity):
    return set(listed(entity.type))


# RO-Crate 1.3 and Workflow RO-Crate 1.1.
assert crate.metadata["conformsTo"] == "https://w3id.org/ro/crate/1.3", crate.metadata["conformsTo"]
profiles = {f"https://w3id.org/ro/wfrun/{name}/0.6" for name in ("process", "workflow", "provenance")}
profiles.add("https://w3id.org/workflowhub/workflow-ro-crate/1.1")
assert {entity.id for entity in root["conformsTo"]} == profiles
for key in ("name", "description", "datePublished", "license"):
    assert root[key], key
assert root["license"].id == licence and root["license"]["name"]
assert {"File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"} <= types(workflow)
assert workflow["programmingLanguage"].type == "ComputerLanguage"

# Every file is described once, with its size; nothing is described that is not there; every reference leads somewhere.
with zipfile.ZipFile(file) as packed:
    assert packed.testzip() is None
    inside = {info.filename: info.file_size for info in packed.infolist()}
    graph = json.loads(packed.read("ro-crate-metadata.json"))["@graph"]
    manifest = json.loads(packed.read(f"results/{workflow['alternateName']}/manifest.json"))
parts = {part.id for part in root["hasPart"]}
assert parts == set(inside) - {"ro-crate-metadata.json"}, parts ^ set(inside)
for part in root["hasPart"]:
    assert int(part["contentSize"]) == inside[part.id] and part["encodingFormat"], part.id
ids = [entity["@id"] for entity in graph]
assert len(ids) == len(set(ids)), "an identifier is used twice"


def references(value):
    if isinstance(value, dict):
        if set(value) == {"@id"}:
            yield value["@id"]
        else:
            for inner in value.values():
                yield from references(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from references(inner)


EXTERNAL = {"https://w3id.org/ro/crate/1.3", "http://schema.org/CompletedActionStatus"}
for entity in graph:
    for target in references(entity):
        assert target in ids or target in EXTERNAL, (entity["@id"], target)

# Process and Workflow Run Crate: the run of the workflow.
actions = {e.id: e for e in crate.contextual_entities if "CreateAction" in types(e)}
mentioned = {entity.id for entity in root["mentions"]}
assert set(actions) <= mentioned
runs = [action for action in actions.values() if action["instrument"] is workflow]
assert len(runs) == 1 and runs[0]["endTime"] == manifest["written"]
if licence != "#license":
    assert runs[0]["agent"]["name"] == "Ada Lovelace" and runs[0]["agent"].type == "Person"
tables = {f"results/{manifest['study']}/{t['file']}": t for s in manifest["stages"] for t in s["tables"]}
assert set(tables) <= {result.id for result in runs[0]["result"]}

# Provenance Run Crate: tools, steps, one action per stage, and the engine.
stages = {stage["name"]: stage for stage in manifest["stages"]}
tools = {tool.id for tool in listed(workflow["hasPart"])}
steps = {step["name"]: step for step in listed(workflow["step"])}
assert set(steps) == set(stages)
controls = [e for e in crate.contextual_entities if "ControlAction" in types(e)]
assert len(controls) == len(stages) and len(actions) == len(stages) + 1
made, order = {}, {}
for control in controls:
    step, action = control["instrument"], control["object"]
    assert step.type == "HowToStep" and step["workExample"].id in tools
    assert action["instrument"] is step["workExample"] and "SoftwareApplication" in types(action["instrument"])
    assert action["instrument"]["softwareVersion"].startswith(manifest["program"]["version"])
    stage = stages[step["name"]]
    results = {result.id for result in listed(action["result"])}
    assert results == {f"results/{manifest['study']}/{t['file']}" for t in stage["tables"]}
    order[step["name"]] = int(step["position"])
    for result in results:
        made[result] = step["name"]
    for usage in listed(action["resourceUsage"]):
        assert usage["propertyID"] and float(usage["value"]) == stage["seconds"]
for control in controls:
    name = control["instrument"]["name"]
    for read in listed(control["object"]["object"]):
        # A table that is read was made by a step before; the rest is the study.
        assert read is workflow or order[made[read.id]] < order[name], (name, read.id)
assert any(len(listed(control["object"]["object"])) > 1 for control in controls)
engines = [e for e in crate.contextual_entities if "OrganizeAction" in types(e)]
assert len(engines) == 1 and engines[0]["result"] is runs[0]
assert {e.id for e in engines[0]["object"]} == {c.id for c in controls}
engine = engines[0]["instrument"]
assert engine["softwareVersion"] == manifest["program"]["version"] and engine["license"] and engine["citation"]
assert {r["name"] for r in engine["softwareRequirements"]} == {"rustc", "Cargo.lock"}

# runcrate tells the same.
said = io.StringIO()
dump_crate_actions(crate, f=said)
assert said.getvalue().count("\n  instrument: ") == len(actions), said.getvalue()
assert said.getvalue().count("  step: ") == len(stages), said.getvalue()

# rocrate writes it out again, whole.
crate.write(folder)
for name, size in inside.items():
    assert (folder / name).exists(), name
    assert name == "ro-crate-metadata.json" or (folder / name).stat().st_size == size, name
print(f"{len(stages)} stages {len(tables)} tables {len(inside)} files")
