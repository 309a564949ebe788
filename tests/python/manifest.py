"""The jobs of a manifest: fields that an indexed job must have, and which shards they run."""

import re
import sys

import yaml

jobs = list(yaml.safe_load_all(open(sys.argv[1])))
for job in jobs:
    assert (job["apiVersion"], job["kind"]) == ("batch/v1", "Job"), job
    assert re.fullmatch(r"[a-z0-9]([-a-z0-9]*[a-z0-9])?", job["metadata"]["name"])
    spec = job["spec"]
    assert spec["completionMode"] == "Indexed" and spec["parallelism"] <= spec["completions"]
    pod = spec["template"]["spec"]
    # `backoffLimitPerIndex` is for pods that are never restarted.
    assert pod["restartPolicy"] == "Never"
    [container] = pod["containers"]
    assert {mount["name"] for mount in container["volumeMounts"]} == {volume["name"] for volume in pod["volumes"]}
    command = container["command"][2]
    first = int(re.search(r"\$\(\((\d+) \+ JOB_COMPLETION_INDEX\)\)", command).group(1))
    print(f"{len(jobs)} job, {spec['completions']} completions, first {first}, image {container['image']}")
