"""Every Vega-Lite file of a folder is one by its schema, and holds the values that are drawn.

    vega.py FOLDER
"""

import json
import sys
from pathlib import Path

import altair


def main(folder):
    files = sorted(Path(folder).glob("*.vl.json"))
    for file in files:
        chart = altair.Chart.from_dict(json.loads(file.read_text(encoding="utf-8")))
        computed = chart.to_dict()["layer"][0]
        values = next(iter(chart.to_dict().get("datasets", {}).values()), None) or computed["data"]["values"]
        assert len(values) > 4 and all("x" in row and "y" in row for row in values), file
        assert file.with_name(file.name.replace(".vl.json", ".svg")).exists(), file
    print(f"{len(files)} figures")


if __name__ == "__main__":
    main(sys.argv[1])
