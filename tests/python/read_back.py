"""Reads a results folder back with pyarrow and h5py and compares every value, bit for bit, with each other, with the
manifest and with `gearstudy table --format csv`.

    python read_back.py PROGRAM STUDY.yaml RESULTS
"""

import csv
import io
import json
import pathlib
import subprocess
import sys

import h5py
import numpy
import pyarrow
import pyarrow.parquet

program, study, results = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
manifest = json.loads((results / "manifest.json").read_text())
TYPES = {
    "float": (pyarrow.float64(), numpy.dtype("float64")),
    "integer": (pyarrow.int64(), numpy.dtype("int64")),
    "text": (pyarrow.string(), None),
    "flag": (pyarrow.bool_(), numpy.dtype("bool")),
}


def same(one, other, kind, place):
    """Bit for bit: a NaN is a NaN, and -0.0 is not 0.0."""
    assert len(one) == len(other), place
    if kind == "float":
        one, other = (numpy.asarray(values, dtype="float64").view("uint64") for values in (one, other))
        assert (one == other).all(), place
    else:
        assert list(one) == list(other), place


def from_csv(text, kind):
    if kind == "float":
        return float(text) if text else float("nan")  # an empty cell: not applicable
    if kind == "integer":
        return int(text)
    if kind == "flag":
        return {"true": True, "false": False}[text]
    return text


counts = {"tables": 0, "columns": 0, "values": 0, "keys": 0, "units": 0}
with h5py.File(results / f"{manifest['study']}.h5", "r") as file:
    listed = {table["name"] for stage in manifest["stages"] for table in stage["tables"]}
    held = {f"{stage}.{table}" for stage in file for table in file[stage]}
    assert held == listed, (held, listed)
    for record in (table for stage in manifest["stages"] for table in stage["tables"]):
        name = record["name"]
        stage, table_name = name.split(".", 1)
        schema = manifest["schemas"][record["schema"]]
        columns = [{"unit": "", "key": False, "volatile": False, **column} for column in schema["columns"]]
        arrow = pyarrow.parquet.read_table(results / record["file"])
        group = file[stage][table_name]
        metadata = {key.decode(): value.decode() for key, value in arrow.schema.metadata.items()}
        assert metadata["table"] == table_name and metadata["description"] == schema["description"], name
        attrs = json.loads(metadata["PANDAS_ATTRS"])
        units = {one["name"]: one["unit"] for one in columns if one["unit"]}
        beside = {"value": "unit"} if {"value", "unit"} <= {one["name"] for one in columns} and "value" not in units else {}
        assert attrs == {"table": table_name, "units": units} | ({"unit_columns": beside} if beside else {}), name
        assert group.attrs["description"] == schema["description"], name
        names = [column["name"] for column in columns]
        assert arrow.column_names == names and list(group.attrs["columns"]) == names, name
        assert set(group) == set(names), name
        assert arrow.num_rows == record["rows"], name

        command = [program, "table", study, name, "--format", "csv", "--results", str(results.parent)]
        printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        heading, *rows = csv.reader(io.StringIO(printed))
        assert len(rows) == record["rows"], name

        keys = []
        for index, column in enumerate(columns):
            place = f"{name}.{column['name']}"
            kind = column["type"]
            field, dataset = arrow.schema.field(index), group[column["name"]]
            about = {key.decode(): value.decode() for key, value in field.metadata.items()}
            assert field.type == TYPES[kind][0] and not field.nullable, place
            assert dataset.attrs["type"] == kind, place
            if TYPES[kind][1] is not None:
                assert dataset.dtype == TYPES[kind][1], (place, dataset.dtype)
            assert len(column["description"]) > 8, place
            for key in ("unit", "description"):
                assert about[key] == column[key] and dataset.attrs[key] == column[key], place
            for mark in ("key", "volatile"):
                assert (mark in about) == (mark in dataset.attrs) == column[mark], (place, mark)
            expected = f"{column['name']} [{column['unit']}]" if column["unit"] else column["name"]
            assert heading[index] == expected, place

            one = arrow.column(index).to_pylist()
            other = dataset.asstr()[:] if kind == "text" else dataset[:]
            same(one, other.tolist(), kind, place)
            same(one, [from_csv(row[index], kind) for row in rows], kind, place)
            if column["key"]:
                keys.append(one)
            counts["columns"] += 1
            counts["values"] += len(one)
            counts["units"] += bool(column["unit"])
        if keys:
            rows = list(zip(*keys))
            assert rows == sorted(set(rows)), f"{name}: keys are unique and sorted"
            counts["keys"] += 1
        else:
            assert record["rows"] <= 1, name
        counts["tables"] += 1
print(" ".join(f"{value} {key}" for key, value in counts.items()))
