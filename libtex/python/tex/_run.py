# SPDX-License-Identifier: Apache-2.0
"""The commands, in this process."""

import contextlib as _contextlib
import glob as _glob
import json as _json
import os as _os
from collections.abc import Iterable
from typing import Any, NamedTuple

from tex import _tex


class Ran(NamedTuple):
    """What a command did.

    code       the exit status: 0 done, 1 findings, 2 to 5 errors (see normal-maps(7))
    results    the dictionaries of --json, one for each file
    out        everything that the command printed on standard output, as text
    err        its warnings and errors
    out_bytes  `out` as bytes: of "-o -", the file
    """

    code: int
    results: list[Any]
    out: str
    err: str
    out_bytes: bytes


class RunError(RuntimeError):
    """A command that run() was to check failed. `ran` is what it did."""

    def __init__(self, command: str, ran: Ran) -> None:
        super().__init__(command, ran)
        self.command = command
        self.ran = ran

    def __str__(self) -> str:
        return f"{self.command}: exit status {self.ran.code}\n{self.ran.err or self.ran.out}".rstrip()


def commands() -> list[str]:
    """The names of the commands."""
    return list(_tex._commands)


def _words(arguments, glob):
    """The arguments as bytes, with the files that patterns match."""
    if isinstance(arguments, (str, bytes, _os.PathLike)) or not isinstance(arguments, Iterable):
        raise TypeError(f"arguments: expected a list of texts and paths, got {type(arguments).__name__}")
    words = []
    for argument in arguments:
        try:
            word = _os.fsencode(argument)
        except TypeError:
            raise TypeError(f"arguments: expected str, bytes or os.PathLike, got {type(argument).__name__}") from None
        if b"\0" in word:
            raise ValueError(f"arguments: {word!r} has a null byte inside")
        words += _expanded(word) if glob else [word]
    return words


def _expanded(word):
    """The files that a pattern matches, as in a shell; the argument itself if there are none or it is an option."""
    if word.startswith(b"-") or not _glob.has_magic(word):
        return [word]
    return sorted(_glob.glob(word, recursive=True)) or [word]


_OUT = (b"/dev/stdout", b"/dev/fd/1", b"/proc/self/fd/1")
_ERR = (b"/dev/stderr", b"/dev/fd/2", b"/proc/self/fd/2")


def _redirected(words, out, err):
    """The arguments with other names for the host's standard output and standard error; whether -o is the former."""
    pipes, changed = False, []
    for before, word in zip([b"", *words], words):
        option, value = before, word
        if word.startswith(b"--") and b"=" in word:
            option, value = word.split(b"=", 1)
        elif word.startswith(b"-o") and word != b"-o":
            option, value = b"-o", word[2:]
        if value in (b"-", *_OUT) and option in (b"-o", b"--output"):
            pipes = True
        elif value in _OUT:
            word = word[: len(word) - len(value)] + out
        elif value in _ERR:
            word = word[: len(word) - len(value)] + err
        changed.append(word)
    return changed, pipes


@_contextlib.contextmanager
def _memory(name):
    """A file in memory: (the name of its descriptor, a function that returns its bytes)."""
    with open(_os.memfd_create(name), "r+b") as file:

        def read():
            file.seek(0)
            return file.read()

        yield f"/dev/fd/{file.fileno()}".encode(), read


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


def run(
    command: str,
    arguments: Iterable[str | bytes | _os.PathLike[str]] = (),
    *,
    json: bool = True,
    glob: bool = True,
    check: bool = False,
) -> Ran:
    """Runs a command, for example run("bake-normals", ["*.png", "--out-dir", "out"]).

    It does what the program of this name does, except that it prints into the result: also the file of "-o -", which is
    Ran.out_bytes. `arguments` are texts and paths, as those of subprocess.run(). With `json`, commands that have the
    option --json get it, unless they write a file to standard output. With `glob`, arguments with wildcards become the
    files that match, as in a shell. A command that fails raises nothing, see Ran.code and Ran.err, or with `check` a
    RunError. Ctrl-C stops it and raises KeyboardInterrupt.
    """
    if not isinstance(command, str):
        raise TypeError(f"command: expected str, got {type(command).__name__}")
    words = _words(arguments, glob)
    with _memory("tex.run.out") as (out_name, out_file), _memory("tex.run.err") as (err_name, err_file):
        words, pipes = _redirected(words, out_name, err_name)
        if json and not pipes and b"--json" not in words and _tex._has_option(command, "--json"):
            words.insert(0, b"--json")
        code, out, err = _tex._run(command, words, out_name)
        out, err = out + out_file(), err + err_file()
    texts = [text.decode(errors="surrogateescape") for text in (out, err)]
    ran = Ran(code, _documents(texts[0]), *texts, out)
    if check and code != 0:
        raise RunError(command, ran)
    return ran
