"""Holds archives to the checks of roc-validator for RO-Crate 1.3.

    python ro_crate_validator.py FILE.zip...

No network: both JSON-LD contexts are answered from here, the one of RO-Crate by the package rocrate, and every other
request fails. Prints what does not meet a check of severity REQUIRED, or RECOMMENDED and not in ACCEPTED, and ends with 1.
"""

import importlib.resources
import json
import pathlib
import sys
from unittest import mock

import requests
from rocrate_validator import services
from rocrate_validator.models import Severity, ValidationSettings

RUN = "https://w3id.org/ro/terms/workflow-run"
TERMS = ("ParameterConnection", "connection", "resourceUsage", "sha256", "sourceParameter", "targetParameter")
CONTEXTS = {
    "https://w3id.org/ro/crate/1.3/context": (importlib.resources.files("rocrate") / "data/ro-crate.jsonld").read_bytes(),
    f"{RUN}/context": json.dumps({"@context": {term: f"{RUN}#{term}" for term in TERMS}}).encode(),
}
# By check of profile ro-crate-1.3, or of 1.2 on which it stands: the reason why an archive does not do as recommended.
ACCEPTED = {
    "ro-crate-1.3_13.1": "the Bioschemas profile asks for inputs and outputs, which the study itself states",
    "ro-crate-1.2_56.1": "who publishes the archive is not known when it is made",
    "ro-crate-1.2_80.2": "only name and ORCID iD of an author are asked for",
    "ro-crate-1.2_80.3": "as above",
    "ro-crate-1.2_85.0": "no address has the text of several licences, or of none",
    "ro-crate-1.2_86.2": "the authors of the program have no page",
    "ro-crate-1.2_89.0": "nor an identifier in ROR",
    "ro-crate-1.2_90.1": "nor a contact point",
    "ro-crate-1.2_93.0": "as above",
}


def answered(_adapter, request, **_):
    if request.url not in CONTEXTS:
        raise requests.ConnectionError(f"no network in this test: {request.url}", request=request)
    response = requests.Response()
    response.status_code, response.url, response.request = 200, request.url, request
    response.headers["Content-Type"] = "application/ld+json"
    response._content = CONTEXTS[request.url]
    return response


def issues(archive):
    settings = ValidationSettings(
        rocrate_uri=archive, profile_identifier="ro-crate-1.3", requirement_severity=Severity.RECOMMENDED, no_cache=True
    )
    return services.validate(settings).get_issues()


found = []
with mock.patch.object(requests.adapters.HTTPAdapter, "send", answered):
    for file in sys.argv[1:]:
        for issue in issues(pathlib.Path(file)):
            check = issue.check
            if check.severity == Severity.REQUIRED or check.identifier not in ACCEPTED:
                found.append(f"{file}: {check.identifier} {check.severity.name}: {issue.message} [{issue.violatingEntity}]")
print("\n".join(found))
sys.exit(len(found) > 0)
