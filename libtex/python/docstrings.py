# SPDX-License-Identifier: Apache-2.0
"""docstrings.py OUTPUT.cpp HEADER...: the comments of the headers' functions as a table for docs.h."""

import re
import sys
from pathlib import Path

DECLARATION = re.compile(r"^(?:\[\[nodiscard\]\] )?(?:constexpr |inline )*[A-Za-z_][\w:<>&*, ]*? [*&]?([a-z_0-9]+)\(")


# Where the words of Python differ from those of C++.
PYTHON = (
    (r"\b\w+Options::(\w+)", r"\1"),
    (r"\b(Texture|Image|HeightField|RoughnessFile|ReadOptions)::(\w+)", r"\1.\2"),
    (r"\b[A-Z]\w+::automatic\b", "'auto'"),
    (r"\b[A-Z]\w+::([a-z]\w*?)_?\b", lambda found: "'%s'" % found[1].replace("_", "-")),
    (r"\boptions\.(\w+)", r"\1"),
    (r"\b(\w+)\.size\(\)", r"len(\1)"),
    (r"\bnullopt\b", "None"),
    (r"\bnull\b", "None"),
    (r"\b(Preconditions?) \(asserted\)", r"\1"),
    (r"\b(bad|out)_(data|option|of_memory)\b", lambda found: found[0].replace("_", "-")),
)


def in_python(text):
    for pattern, word in PYTHON:
        text = re.sub(pattern, word, text)
    return text


def comments(header):
    """(function, comment) for each function that the header declares; overloads without a comment share the last."""
    comment, last = [], ""
    for line in Path(header).read_text(encoding="utf-8").splitlines():
        if line.startswith("//"):
            comment.append(line[3:])
            continue
        found = DECLARATION.match(line)
        if found:
            last = "\n".join(comment) if comment else last
            yield found.group(1), in_python(last)
        elif not line.strip():
            last = ""
        comment = []


def main(output, headers):
    table = {}
    for header in sorted(headers):
        for function, text in comments(header):
            if not text or text.startswith(" SPDX"):
                continue
            name, texts = table.setdefault(function, (Path(header).name, []))
            if text not in texts and name == Path(header).name:
                texts.append(text)
    rows = "".join(
        f'    {{"{function}", "{name}", R"doc({chr(10).join(texts)})doc"}},\n'
        for function, (name, texts) in sorted(table.items())
    )
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    Path(output).write_text(
        '#include "docs.h"\n\nnamespace tex::python {\n\nstatic constexpr HeaderComment kComments[] = {\n'
        + rows
        + "};\n\nconst HeaderComment* header_comment(std::string_view function) {\n"
        "    for (const HeaderComment& row : kComments) {\n"
        "        if (function == row.function) return &row;\n    }\n    return nullptr;\n}\n\n}  // namespace tex::python\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
