# SPDX-License-Identifier: Apache-2.0
"""sbom.py VERSION COMMIT EPOCH FOLDER FILE...: writes FOLDER/libtex-VERSION.spdx.json, a list in SPDX 2.3 of the files
of a release and of the Debian packages that they are built with (.ci/packages.sh), as installed here."""

import datetime
import hashlib
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def build_packages():
    """The packages of build_packages in .ci/packages.sh, without the tools that leave nothing in a program."""
    text = (ROOT / ".ci/packages.sh").read_text(encoding="utf-8")
    words = re.search(r"^build_packages=\((.*?)\)", text, re.S | re.M).group(1).split()
    return [word for word in words if word.endswith("-dev")]


def installed_version(package):
    done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 and done.stdout else "NOASSERTION"


def sum_of(path):
    return [{"algorithm": "SHA256", "checksumValue": hashlib.sha256(path.read_bytes()).hexdigest()}]


def main():
    version, commit, epoch, folder, *names = sys.argv[1:]
    folder = Path(folder)
    created = datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    packages = [{
        "SPDXID": "SPDXRef-libtex", "name": "libtex", "versionInfo": version, "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False, "licenseConcluded": "Apache-2.0", "licenseDeclared": "Apache-2.0",
        "copyrightText": "NOASSERTION", "sourceInfo": f"git commit {commit}",
    }]
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-libtex")]
    for name in build_packages():
        found = installed_version(name)
        packages.append({
            "SPDXID": f"SPDXRef-{name}", "name": name, "versionInfo": found, "downloadLocation": "NOASSERTION",
            "filesAnalyzed": False, "licenseConcluded": "NOASSERTION", "licenseDeclared": "NOASSERTION",
            "copyrightText": "NOASSERTION", "supplier": "Organization: Debian",
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                              "referenceLocator": f"pkg:deb/debian/{name}@{found}"}],
        })
        relations.append(("SPDXRef-libtex", "DEPENDS_ON", f"SPDXRef-{name}"))
    files = []
    for number, name in enumerate(sorted(names)):
        files.append({"SPDXID": f"SPDXRef-file-{number}", "fileName": f"./{name}", "checksums": sum_of(folder / name),
                      "licenseConcluded": "Apache-2.0", "copyrightText": "NOASSERTION"})
        relations.append(("SPDXRef-libtex", "CONTAINS", f"SPDXRef-file-{number}"))
    document = {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"libtex-{version}",
        "documentNamespace": f"urn:libtex:{version}:{commit}",
        "creationInfo": {"created": created, "creators": ["Tool: libtex-sbom.py"]},
        "packages": packages, "files": files,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b}
                          for a, kind, b in relations],
    }
    text = json.dumps(document, indent=1, sort_keys=True) + "\n"
    (folder / f"libtex-{version}.spdx.json").write_text(text, encoding="utf-8")


main()
