"""Asks the rows of a sweep with DuckDB, in the file as it was published, what `gearstudy query` is asked of the same rows.

    python duckdb_rows.py PROGRAM RESULTS STUDY STAGE OUTPUT
"""

import json
import pathlib
import subprocess
import sys

try:
    import duckdb
except ImportError:
    print("SKIPPED: there is no `duckdb` in this Python; `make setup` installs it")
    sys.exit()

program, results, study, stage, output = sys.argv[1:]
file = pathlib.Path(results, study, f"{stage}.rows.parquet")
QUESTIONS = [
    "SELECT count(*) AS n FROM {rows}",
    "SELECT count(*) AS n FROM {rows} WHERE reason <> ''",
    "SELECT reason, count(*) AS n FROM {rows} GROUP BY reason ORDER BY reason",
    "SELECT * FROM {rows} WHERE reason = '' ORDER BY {output}, 1, 2, 3 LIMIT 7",
    "SELECT torque, min({output}) AS low, max({output}) AS high FROM {rows} WHERE reason = '' GROUP BY torque ORDER BY torque",
]

counts = []
for question in QUESTIONS:
    # No import, no copy: the file is the table.
    found = duckdb.sql(question.format(rows=f"'{file}'", output=output))
    by_duckdb = [dict(zip(found.columns, row)) for row in found.fetchall()]
    text = question.format(rows=f'"{study}.{stage}.rows"', output=output)
    command = [program, "query", "--results", results, "--format", "json", text]
    by_program = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    by_program = by_program["rows"] if isinstance(by_program, dict) else by_program
    assert by_duckdb == by_program, (question, by_duckdb[:3], by_program[:3])
    counts.append(len(by_duckdb))
manifest = json.loads(pathlib.Path(results, study, "manifest.json").read_text())
tables = {table["name"]: table for each in manifest["stages"] for table in each["tables"]}
described = duckdb.sql(f"SELECT count(*) FROM '{file}'").fetchall()[0][0]
assert described == tables[f"{stage}.rows"]["rows"]
print(f"{described} rows, {sum(counts)} answers alike")
