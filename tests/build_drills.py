#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""build_drills.py: build-normals in trees that were made to hurt it.

    tests/build_drills.py [ROUNDS [BUILD [SEED]]]    default: 500 build/release 1

Each round makes a random tree: links, odd names, files of equal bytes, outputs that lead to inputs, documents with
the names of other files, a cache in a folder that is not one, a state that somebody else has written. It runs build-
normals a few times: alone, two at once, killed, with inputs that are replaced meanwhile, with a damaged cache and a
damaged state. After each run:

* every file that the user had is byte for byte what it was, and so are the files outside the tree that links lead to;
* every output is right: what a run in a fresh folder makes of some content that its input has had;
* nothing else is there but the state, the cache and the documents that the command line names.

Prints the seed of a round that fails. tests/build_drills.sh runs some rounds.
"""

import hashlib
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROUNDS = int(sys.argv[1]) if len(sys.argv) > 1 else 500
ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else ROOT / "build/release").resolve()
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
PICTURES = [(ROOT / "samples" / name).read_bytes() for name in ("ramp.png", "waves.png", "hemisphere.png")]
NAMES = ["a", "b c", "d'e", 'f"g', "h\ni", "ünï", "-o", "k\tl", "{m}", "n*", "o%41", "p;q", "$r"]
EXTENSIONS = ["dds", "ktx2", "png"]


class Failed(Exception):
    pass


def run(folder, arguments, **more):
    program = str(BUILD / "build-normals")
    return subprocess.Popen([program, "--no-sync", *arguments], cwd=folder, stdin=subprocess.DEVNULL,
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, **more)


def files_below(folder):
    """Every name below the folder that is not a folder, without following links."""
    found = {}
    for at, folders, names in os.walk(folder):
        for name in names + [one for one in folders if os.path.islink(os.path.join(at, one))]:
            path = os.path.join(at, name)
            known = "-> " + os.readlink(path) if os.path.islink(path) else pathlib.Path(path).read_bytes()
            found[os.path.relpath(path, folder)] = known
    return found


right_bytes = {}


def right(content, extension, bumpiness):
    """The bytes of a bake, by bake-normals itself."""
    key = (content, extension, bumpiness)
    if key not in right_bytes:
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "in.png").write_bytes(content)
            subprocess.run([str(BUILD / "bake-normals"), "in.png", "-o", "out." + extension, "--bumpiness",
                            str(bumpiness), "--quiet"], cwd=folder, check=True)
            right_bytes[key] = pathlib.Path(folder, "out." + extension).read_bytes()
    return right_bytes[key]


class Round:
    def __init__(self, number, scratch):
        self.random = random.Random(SEED * 1000003 + number)
        self.tree = os.path.join(scratch, "tree")
        self.outside = os.path.join(scratch, "outside")
        os.makedirs(os.path.join(self.tree, "art"))
        os.makedirs(self.outside)
        self.contents = {}  # of each input, all that it has had
        for k in range(3):
            pathlib.Path(self.outside, f"victim{k}.png").write_bytes(PICTURES[k])
        pathlib.Path(self.outside, "notes.txt").write_text("notes of somebody else\n")

    def make_tree(self):
        chance = self.random.random
        for stem in self.random.sample(NAMES, self.random.randint(1, 5)):
            folder = self.random.choice(["art", "art/deep", "art/.hid", "art/x y"])
            os.makedirs(os.path.join(self.tree, folder), exist_ok=True)
            name = f"{folder}/{stem}.png"
            path = os.path.join(self.tree, name)
            if os.path.lexists(path):
                continue
            if chance() < 0.15:
                os.symlink(os.path.join(self.outside, f"victim{self.random.randrange(3)}.png"), path)
            elif chance() < 0.15 and self.contents:
                os.link(os.path.join(self.tree, next(iter(self.contents))), path)
            else:
                pathlib.Path(path).write_bytes(self.random.choice(PICTURES))
            self.contents[name] = [pathlib.Path(path).read_bytes()]
        pathlib.Path(self.tree, "notes.txt").write_text("my notes\n")
        if chance() < 0.3:
            os.symlink("art", os.path.join(self.tree, "lnk"))
        if chance() < 0.3:
            os.symlink(self.outside, os.path.join(self.tree, "away"))
        self.extension = self.random.choice(EXTENSIONS)
        self.bumpiness = self.random.randint(1, 3)
        out = self.random.choice(["out", "out", "out", "lnk", "away/out", os.path.join(self.tree, "art"), "art", "."])
        name = self.random.choice(["{dir}/{stem}", "{stem}", "{dir}/../{stem}", "{stem}_n"])
        quoted = f"{name}.{self.extension}"
        with open(os.path.join(self.tree, "normals.toml"), "w", encoding="utf-8") as manifest:
            manifest.write(f"version = 1\n[[rule]]\nmatch = \"art/**/*.png\"\nout-dir = '{out}'\n"
                           f"name = \"{quoted}\"\nsteps = [ {{ bake = {{ bumpiness = {self.bumpiness} }} }} ]\n")
        if chance() < 0.3:  # links where outputs will be
            os.makedirs(os.path.join(self.tree, "out/art"), exist_ok=True)
            for stem in self.random.sample(NAMES, 3):
                target = self.random.choice([os.path.join(self.outside, "victim0.png"), "../art/a.png", "nowhere"])
                path = os.path.join(self.tree, self.random.choice(["out", "out/art"]), f"{stem}.{self.extension}")
                if not os.path.lexists(path):
                    os.symlink(target, path)

    def arguments(self):
        chosen = []
        if self.random.random() < 0.6:
            self.cache = self.random.choice(["cache", "cache", "cache", ".", "art", "lnk", "away"])
            chosen += ["--cache", self.cache]
            if self.random.random() < 0.5:
                chosen += ["--cache-size", self.random.choice(["1", "4K", "1M"])]
        if self.random.random() < 0.4:
            chosen += ["--prune"]
        if self.random.random() < 0.3:
            chosen += ["--depfile", self.random.choice(["deps.d", "normals.toml", "notes.txt/x", "art/a.png",
                                                        ".normals.toml.state", f"out/a.{self.extension}"])]
        if self.random.random() < 0.15:
            chosen += ["--plan", self.random.choice(["plan.jsonl", "normals.toml", "art/a.png", "lnk/a.png"])]
            chosen = [one for one in chosen if one != "--prune"]
        for option, name in zip(chosen, chosen[1:]):
            if option in ("--depfile", "--plan"):
                self.documents.add(name)
                if name.startswith("lnk/"):
                    self.documents.add("art" + name[3:])
        return chosen

    def damage(self):
        """Cuts, flips, swaps or links files of the cache, and damages the state."""
        cache = os.path.join(self.tree, "cache")
        entries = [os.path.join(at, name) for at, _, names in os.walk(cache) for name in names if len(name) == 64]
        for path in entries:
            how = self.random.choice(["keep", "cut", "flip", "swap", "link", "folder", "empty"])
            if os.path.islink(path) or not os.path.isfile(path):
                continue
            data = bytearray(pathlib.Path(path).read_bytes())
            if how == "cut":
                pathlib.Path(path).write_bytes(data[: self.random.randrange(len(data) + 1)])
            elif how == "flip" and data:
                data[self.random.randrange(len(data))] ^= 1 << self.random.randrange(8)
                pathlib.Path(path).write_bytes(data)
            elif how == "swap":
                shutil.copyfile(path, self.random.choice(entries) + "~")
                other = self.random.choice(entries)
                if os.path.isfile(other) and not os.path.islink(other):
                    pathlib.Path(other).write_bytes(data)
            elif how == "link":
                os.remove(path)
                os.symlink(os.path.join(self.outside, "victim1.png"), path)
            elif how == "folder":
                os.remove(path)
                os.mkdir(path)
            elif how == "empty":
                pathlib.Path(path).write_bytes(b"")
        for copy in [os.path.join(at, name) for at, _, names in os.walk(cache) for name in names if name[-1] == "~"]:
            os.remove(copy)
        state = pathlib.Path(self.tree, ".normals.toml.state")
        if state.is_file() and self.random.random() < 0.5:
            data = bytearray(state.read_bytes())
            if self.random.random() < 0.5:
                state.write_bytes(data[: self.random.randrange(len(data) + 1)])
            elif len(data) > 100:
                data[self.random.randrange(30, len(data))] ^= 4
                state.write_bytes(data)

    def forge(self):
        """Adds outputs to the state that nobody has made, as whoever ships a folder can."""
        state = pathlib.Path(self.tree, ".normals.toml.state")
        head = b"build-normals state 1\n"
        lines = state.read_bytes()[len(head):-69] if state.is_file() and not state.is_symlink() else b""
        victims = ["notes.txt", "normals.toml", "../outside/notes.txt", "../outside/victim0.png", "out/../notes.txt",
                   "lnk/a.png", "away/victim1.png", "out/../../outside/victim2.png",
                   os.path.join(self.outside, "notes.txt"), *self.contents]
        for victim in victims:
            path = os.path.join(self.tree, victim)
            if not os.path.isfile(path) or any(c in victim for c in "%\t\n"):
                continue
            sums = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()
            made_from = self.random.choice(["art/gone.png", victim, "../art/gone.png", "art/../notes.txt"])
            lines += f"made\t{'0' * 64}\t{'0' * 64}\t{made_from}\t{victim}\t1\t{sums}\t{victim}\n".encode()
        text = head + lines
        if not state.is_symlink() and not state.is_dir():
            state.write_bytes(text + b"end\t" + hashlib.sha256(text).hexdigest().encode() + b"\n")

    def editor(self, stop):
        """Replaces inputs, as a program that saves does."""
        names = [name for name in self.contents if not os.path.islink(os.path.join(self.tree, name))]
        while names and not stop.is_set():
            name = self.random.choice(names)
            content = self.random.choice(PICTURES)
            temporary = os.path.join(self.outside, "new.tmp")
            pathlib.Path(temporary).write_bytes(content)
            self.contents[name].append(content)
            os.replace(temporary, os.path.join(self.tree, name))
            time.sleep(0.003)

    def check(self, before, what):
        after = files_below(self.tree)
        edited = {name: self.contents[name] for name in self.contents}
        outputs = {right(content, self.extension, self.bumpiness)
                   for contents in self.contents.values() for content in contents}
        for name, was in before.items():
            if name in edited and isinstance(was, bytes):
                if after.get(name) not in edited[name]:
                    raise Failed(f"{what}: the input {name!r} was lost")
            elif name in self.ours:
                continue
            elif isinstance(was, str) and (after.get(name) in outputs or name in self.documents):
                self.ours.add(name)  # a link with the name of an output or a document became that
            elif after.get(name) != was:
                raise Failed(f"{what}: {name!r} is not what it was")
        for name, now in after.items():
            if name in before and name not in self.ours:
                continue
            is_in_cache = (name.split("/")[0] + "/libtex-cache") in after
            if is_in_cache or name == ".normals.toml.state" or name in self.documents:
                self.ours.add(name)
            elif now in outputs:
                self.ours.add(name)
            elif not (self.killed and ".tex-tmp" in name):
                raise Failed(f"{what}: {name!r} was left, or is wrong")
        for name, was in self.victims.items():
            if files_below(self.outside).get(name) != was:
                raise Failed(f"{what}: {name!r} outside of the tree is not what it was")
        for name, now in files_below(self.outside).items():
            if name not in self.victims and now not in outputs and name != "new.tmp" and not (
                    self.killed and ".tex-tmp" in name):
                raise Failed(f"{what}: {name!r} was written outside of the tree")

    def play(self):
        self.make_tree()
        self.ours = set()
        self.documents = set()  # that a command line has named
        self.victims = files_below(self.outside)
        self.killed = False
        codes = []
        for _ in range(self.random.randint(2, 5)):
            what = self.random.choice(["alone", "two", "killed", "edited", "damaged", "forged", "alone"])
            arguments = self.arguments()
            before = {name: now for name, now in files_below(self.tree).items() if name not in self.ours}
            stop = threading.Event()
            editor = threading.Thread(target=self.editor, args=(stop,))
            if what == "damaged":
                self.damage()
            if what == "forged":
                self.forge()
                if "--plan" not in arguments and "--prune" not in arguments:
                    arguments.append("--prune")
            if what == "edited":
                editor.start()
            programs = [run(self.tree, arguments) for _ in range(2 if what == "two" else 1)]
            if what == "killed":
                time.sleep(self.random.random() * 0.08)
                programs[0].send_signal(signal.SIGKILL)
                self.killed = True
            for program in programs:
                message = program.communicate(timeout=120)[1].decode("utf-8", "replace")
                codes.append(program.returncode)
                if program.returncode not in (0, 2, 3, 4, -signal.SIGKILL):
                    raise Failed(f"{what} {arguments}: ended with {program.returncode}: {message}")
            if what == "edited":
                stop.set()
                editor.join()
            self.check(before, f"{what} {arguments} {codes}")
        return codes


def main():
    ended = {}
    for number in range(ROUNDS):
        with tempfile.TemporaryDirectory() as scratch:
            try:
                for code in Round(number, scratch).play():
                    ended[code] = ended.get(code, 0) + 1
            except Failed as failed:
                sys.exit(f"build_drills: round {number} of seed {SEED}: {failed}")
    text = ", ".join(f"{count} with {code}" for code, count in sorted(ended.items()))
    print(f"{ROUNDS} random trees: nothing was lost, no output is wrong, nothing else is left; runs ended: {text}")


if __name__ == "__main__":
    main()
