"""The YAML language server, which most editors have, with schemas/study.schema.json: over studies and over broken ones.

    yaml_language_server.py

Of every study it finds nothing. Of broken ones that a schema can tell from a study it finds something, in words that a reader
understands. It completes quantities with their units, and its hover has title, description and example. Prints one line.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

SCHEMA = pathlib.Path("schemas/study.schema.json").resolve()
LINE = f"# yaml-language-server: $schema={SCHEMA.as_uri()}\n"


class Server:
    def __init__(self, program):
        self.process = subprocess.Popen([program, "--stdio"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.number = 0
        snippets = {"textDocument": {"completion": {"completionItem": {"snippetSupport": True}}}}
        root = pathlib.Path.cwd().as_uri()
        self.ask("initialize", {"processId": None, "rootUri": root, "capabilities": snippets})
        self.tell("initialized", {})
        # No list of schemas from a network: the first line of a study names its own.
        settings = {"yaml": {"schemaStore": {"enable": False}, "validate": True, "hover": True, "completion": True}}
        self.tell("workspace/didChangeConfiguration", {"settings": settings})

    def send(self, message):
        text = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(text), text))
        self.process.stdin.flush()

    def receive(self):
        length = 0
        while line := self.process.stdout.readline().strip():
            name, value = line.split(b": ")
            length = int(value) if name == b"Content-Length" else length
        assert length, "the server has ended"
        return json.loads(self.process.stdout.read(length))

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def wait(self, wanted):
        while not wanted(message := self.receive()):
            # What the server asks of an editor has an empty answer.
            if "id" in message and "method" in message:
                items = message.get("params", {}).get("items")
                self.send({"id": message["id"], "result": [None] * len(items) if items else None})
        return message

    def ask(self, method, params):
        self.number += 1
        self.send({"id": self.number, "method": method, "params": params})
        return self.wait(lambda message: message.get("id") == self.number and "method" not in message)["result"]

    def open(self, name, text):
        """What is wrong with a text."""
        uri = f"file:///desk/{name}.yaml"
        document = {"uri": uri, "languageId": "yaml", "version": 1, "text": LINE + text}
        self.tell("textDocument/didOpen", {"textDocument": document})
        told = self.wait(
            lambda message: message.get("method") == "textDocument/publishDiagnostics" and message["params"]["uri"] == uri
        )
        return told["params"]["diagnostics"]

    def at(self, method, name, marked):
        before, after = marked.split("|")
        self.open(name, before + after)
        lines = (LINE + before).split("\n")
        place = {"line": len(lines) - 1, "character": len(lines[-1])}
        return self.ask(method, {"textDocument": {"uri": f"file:///desk/{name}.yaml"}, "position": place})


# Beside the interpreter or on the search path.
folders = [os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)]
program = shutil.which("yaml-language-server", path=os.pathsep.join(folders))
if not program:
    sys.exit(print("SKIPPED: yaml_language_server.py: there is no yaml-language-server"))
server = Server(program)
studies = sorted(pathlib.Path("studies").glob("*.yaml"))
assert studies
for path in studies:
    found = server.open(f"study-{path.stem}", path.read_text())
    assert not found, f"{path}: {found[0]['range']['start']} {found[0]['message']}"

# What no schema can see: gears that do not fit, stages that are not there, rows that no table has. And what no text is.
beyond = {
    "bore_above_root", "condition_on_unknown_column", "contact_law_of_a_whole_pair", "contact_ratio_below_one", "cycle",
    "interference", "thickness_upside_down", "profile_shift_said_twice", "profile_shifts_both_follow",
    "pitch_deviations_twice", "tooth_measured_twice", "teeth_without_deviations", "thickness_leaves_no_tooth",
    "balls_too_near", "load_dependent_without_torque",
    "printed_columns", "printed_column_unknown", "missing_column", "missing_stage", "missing_table", "no_row_with_this_design", "no_row_with_this_torque",
    "pointed_tip", "rack_above_full_round", "relief_given_twice", "resolved_contact_of_a_beam",
    "resolved_contact_without_torque", "root_stress_without_a_mesh", "sharp_root_of_finite_elements",
    "torque_backwards", "wrong_kind_of_stage", "bad_tolerance", "device_as_stage", "device_as_study", "nul_in_a_name",
    "nul_in_title", "bore_of_nothing", "octal_teeth", "hexadecimal_teeth", "empty_file", "no_designs",
    "condition_of_a_figure", "constraint_sign", "constraint_unit", "constraint_unknown_column",
    "constraints_contradict", "objective_unknown", "objectives_for_one", "sizing_objectives", "units_of_a_claim",
    "rating_design_alone", "trace_the_other_way", "trace_in_millimetres", "trace_without_a_deviation",
    "fit_unknown_path", "fit_unknown_cell", "fit_meets_nothing", "fit_of_too_little", "fit_bounds_upside_down",
    "fit_of_itself", "fit_meets_itself", "friction_at_corners", "friction_at_rest", "trace_in_no_file",
    "protuberance_leaves_no_flank", "protuberance_as_steep_as_the_flank", "allowance_leaves_no_tool",
    "notch_without_radius", "cutter_pointed", "cutter_too_small", "cutter_too_round",
    "interval_of_no_width", "interval_beyond_the_range", "interval_of_one_unit", "published_interval",
    "fit_within_percent", "span_of_no_tooth", "units_without_a_power_sign",
    "limit_unknown_path", "limit_without_bounds", "limit_beside_nothing",
}
seen = []
for path in sorted(pathlib.Path("tests/bad").glob("*.yaml")):
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        continue
    found = server.open(f"bad-{path.stem}", text)
    for one in found:
        assert "^[" not in one["message"], f"{path}: a raw pattern: {one['message']}"
    if found:
        seen.append(path.stem)
    assert bool(found) != (path.stem in beyond), f"{path}: {found}"

quick = pathlib.Path("studies/quick.yaml").read_text()


def changed(old, new):
    assert old in quick, old
    return quick.replace(old, new, 1)


# In words, beside the place: the unit, and a value of the size of this field.
message = server.open("no-unit", changed("face_width: 20 mm", "face_width: 20"))[0]["message"]
assert message == "a length is a number and a unit, more than 0, such as `20 mm`", message
message = server.open("wrong-unit", changed("amount: 12 um", "amount: 12 N"))[0]["message"]
assert message == "a length is a number and a unit, such as `12 um`", message
offered = server.at("textDocument/completion", "unit", changed("module: 3 mm", "module: |"))
offered = {item["label"]: item["insertText"] for item in offered["items"]}
assert offered["3 mm"].strip('"') == "3 mm" and offered["… um"] == "${1:3000} um", offered
hover = server.at("textDocument/hover", "hover", changed("bore_radius: 18", "bore_|radius: 18"))["contents"]["value"]
assert "Bore radius" in hover and "where the body is clamped" in hover and "18 mm" in hover, hover
server.process.kill()
server.process.wait()
print(f"{len(studies)} studies, {len(seen)} of the broken ones found")
