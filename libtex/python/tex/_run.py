# SPDX-License-Identifier: Apache-2.0
"""The commands, in this process."""

import glob as _glob
import json as _json
import os as _os
from typing import Any, NamedTuple

from tex import _tex


class Ran(NamedTuple):
    """What a command did.

    code     the exit status: 0 done, 1 findings, 2 to 5 errors (see normal-maps(7))
    results  the dictionaries of --json, one for each file
    out      everything that the command printed on standard output
    err      its warnings and errors
    """

    code: int
    results: list[Any]
    out: str
    err: str


def commands() -> list[str]:
    """The names of the commands."""
    return list(_tex._commands)


def _expanded(argument):
    """The files that a pattern matches, as in a shell; the argument itself if there are none or it is an option."""
    if argument.startswith("-") or not _glob.has_magic(argument):
        return [argument]
    return sorted(_glob.glob(argument, recursive=True)) or [argument]


def _documents(text):
    """The JSON documents in a text, or nothing if the text is not JSON."""
    decoder, documents, at = _json.JSONDecoder(), [], 0
    while text[at:].strip():
        at += len(text[at:]) - len(text[at:].lstrip())
        try:
            document, at = decoder.raw_decode(text, at)
        except ValueError:
            return []
        documents.append(document)
    return documents


def run(command: str, arguments: Any = (), *, json: bool = True, glob: bool = True) -> Ran:
    """Runs a command, for example run("bake-normals", ["*.png", "--out-dir", "out"]).

    It does what the program of this name does, except that it prints into the result. `arguments` are texts and paths.
    With `json`, commands that have the option --json get it, unless they write a file to standard output ("-o -").
    With `glob`, arguments with wildcards become the files that match, as in a shell. A command that fails raises
    nothing: see Ran.code and Ran.err. Ctrl-C stops it and raises KeyboardInterrupt.
    """
    words = []
    for argument in arguments:
        word = _os.fspath(argument) if isinstance(argument, _os.PathLike) else str(argument)
        words += _expanded(word) if glob else [word]
    pipes = any(pair == ("-o", "-") for pair in zip(words, words[1:]))
    if json and not pipes and "--json" not in words and _tex._has_option(command, "--json"):
        words.insert(0, "--json")
    code, out, err = _tex._run(command, words)
    out, err = (text.decode(errors="surrogateescape") for text in (out, err))
    return Ran(code, _documents(out), out, err)
