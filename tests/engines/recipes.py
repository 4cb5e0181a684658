#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""recipes.py MANUAL --commands SECTION: prints the commands of a section of the manual's template.
recipes.py MANUAL --fill SECTION PAGE: prints a page, with the Nth block of code in place of the line "// RECIPE N".
recipes.py --cases ENGINE [PLACE MAP MODEL]...: prints cases for page.js and judge.py.
"""

import json
import pathlib
import re
import sys

import cases


def section(manual, name):
    text = pathlib.Path(manual).read_text(encoding="utf-8")
    return re.search(rf"^\.Sh {re.escape(name)}\n(.*?)(?=^\.Sh )", text, re.M | re.S)[1]


def main():
    if sys.argv[1] == "--cases":
        words = sys.argv[3:]
        asked = [{"id": f"{k:03}", "table": "recipe", "name": sys.argv[2], "place": place, "map": file, "model": model,
                  "corner": "upper left", "dent": False, "halves": False, "wanted": "bump"}
                 for k, (place, file, model) in enumerate(zip(*[iter(words)] * 3))]
        print(json.dumps({"engine": sys.argv[2], "side": cases.SIDE, "lights": cases.LIGHTS, "cases": asked}))
        return
    text = section(sys.argv[1], sys.argv[3])
    if sys.argv[2] == "--commands":
        print("\n".join(re.findall(r"^\.Dl ([a-z]+-normals .*)", text, re.M)).replace("\\-", "-"))
        return
    blocks = re.findall(r"^\.Bd -literal -offset indent\n(.*?)^\.Ed", text, re.M | re.S)
    page = pathlib.Path(sys.argv[4]).read_text(encoding="utf-8")
    print(re.sub(r"^ *// RECIPE (\d+)$", lambda m: blocks[int(m[1]) - 1], page, flags=re.M))


if __name__ == "__main__":
    main()
