# SPDX-License-Identifier: Apache-2.0
"""docstrings.py OUTPUT.cpp HEADER...: the comments of the headers' functions as a table for docs.h."""

import re
import sys
import textwrap
from functools import lru_cache
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
    # The module checks options and parts before it calls a verb: no MeshPart fails check_part().
    (r"\bas validate\(\w*\)", "an option is out of its range"),
    (r"\(see validate\(\)\)", "(an option is out of its range)"),
    (r"\bPreconditions?: every part passes check_part\(\)\.\n", ""),
    (r"\bbad-data +(?:check_part\([\w.]*\) fails|a part does not pass check_part\(\))\n +", ""),
    (r"\bbad-data \(check_part\([\w.]*\) fails\), ", ""),
    (r"\(check_part\([\w.]*\) fails; ", "("),
)

# Sentences that are true in C++ alone: (function, what the comment says, what the docstring says instead). Line breaks
# count as blanks.
SENTENCES = (
    ("build_roughness_chain", "values are clamped to [0, 1], and NaN becomes 0.",
     "values must be finite, and are clamped to [0, 1]."),
    ("check", "; if there is a mesh, check_part() succeeds.", "."),
    ("check", "Errors: bad-option (an option is out of its range)", "Errors: bad-option (no such rule or requirement)"),
    ("check_file", "the report has a finding, N101, and the Error. If the file cannot be opened, memory runs out "
     "or the check is cancelled, the report has only 'error'. Errors: bad-option (an option is out of its range).",
     "that is raised, and so is everything else that reading raises.\n"
     "Errors: io, bad-data, unsupported, bad-option (no such rule or requirement), out-of-memory, cancelled."),
    ("check_model", "as check_map() does", "as check() does with `mesh`"),
    ("compare", "The other texels have an angle of 0 in 'degrees' and do not count in 'error'.",
     "The other texels have an angle of 0 in 'degrees' and do not count in the other fields."),
    ("deband", "Texels that are NaN have no bounds and stay NaN; the field bends through them.",
     "Heights must be finite; height_field() with `fill_invalid` and `deband` takes pictures that lack some."),
    ("deband", "deband of height_field() does this", "The option `deband` of height_field() does this"),
    ("height_field", "Channel: see HeightChannel.", "Channel: `channel` or `channel_name` chooses it."),
    ("layout_name", "The name in kSwizzleNames of the layout", "The name of the layout"),
    ("layout_name", "the letters of to_string().", "its letters."),
    ("pack_file", "Memory holds a few rows, the additional data that bake_file() lists for interlaced PNGs and for outputs, "
     "and what RoughnessFile.map and RoughnessFile.kept return.",
     "Memory holds a few rows, and the additional data that bake_file() lists for interlaced PNGs and for outputs."),
    ("pack_file", " The roughness files appear after the normal map files.", ""),
    ("read_mesh", "Every part of the result passes check_part(); there is at least one part.",
     "There is at least one part."),
    ("refit", "Errors and memory: as above,", "Errors and memory: as those of to_object_space(),"),
)


@lru_cache
def constants(folder):
    """The numbers that the headers name, as prose writes them: kMaxExtent is 2^20."""
    found = {}
    for header in Path(folder).glob("*.h"):
        rows = re.findall(r"^inline constexpr [\w:]+ (k[A-Z]\w*) = ([^;]+);", header.read_text(encoding="utf-8"), re.M)
        for name, value in rows:
            power = re.fullmatch(r"(?:1|[\w:]+\{1\}) << (\d+)", value)
            if power:
                found[name] = f"2^{power[1]}"
            elif re.fullmatch(r"[\d.]+(?:e\d+)?f?", value):
                found[name] = value.rstrip("f")
    return found


def in_python(text, folder):
    for pattern, word in PYTHON:
        text = re.sub(pattern, word, text)
    return re.sub(r"\bk[A-Z]\w*", lambda found: constants(folder).get(found[0], found[0]), text)


def sentence_pattern(words):
    return (r"\s+" if words[0] == " " else "") + r"\s+".join(map(re.escape, words.split()))


def refilled(text, start):
    """`text` with the lines from `start` on, up to one that ends a sentence, filled again, unless they are a table."""
    first = text.rfind("\n", 0, start) + 1
    found = re.compile(r"[^\n]*?(?:\n(?=[^\n])[^\n]*?)*?(?:[.:](?=\n|$)|(?=\n\n)|$)").match(text, first)
    if not found or "\n " in found[0]:
        return text
    return text[:first] + textwrap.fill(found[0], 117, break_on_hyphens=False) + text[found.end():]


def with_sentences(function, text):
    for name, words, instead in SENTENCES:
        found = re.search(sentence_pattern(words), text) if name == function else None
        if found:
            text = refilled(text[:found.start()] + instead + text[found.end():], found.start())
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
            yield found.group(1), with_sentences(found.group(1), in_python(last, Path(header).parent))
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
