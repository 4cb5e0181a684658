# SPDX-License-Identifier: Apache-2.0
"""Tangent-space normal maps: the verbs of libtex, with numpy arrays.

    import tex

    field = tex.read_heights("rock.png")                    # the channel that holds heights
    n = tex.bake(field, bumpiness=12)                       # (height, width, 3): x, y up, z
    chain = tex.build_mip_chain(n)                          # a list of such arrays
    tex.write_texture("rock.dds", tex.pack(chain, "dxt5nm", effort="best"))

    data = tex.encode_blocks(n, "bc5")                      # bytes for an engine's own container
    for finding in tex.check("rock.dds", require={"y": "up"}):
        print(finding.id, finding.level, finding.message)
    tex.run("bake-normals", ["*.png", "--out-dir", "out"])  # any command, in this process

Arrays. Heights are (height, width), maps (height, width, 3): x to the right, y up, z out of the surface, each from -1
to 1, rows from the top. Results are views of libtex's own memory, which is not copied; a map is stored as three planes
(numpy.ascontiguousarray(n) has x, y, z side by side). Arguments are 32-bit floats. Maps that come from libtex are not
copied, nor are heights whose rows are contiguous and a multiple of 16 texels long; other layouts are copied. Floats of
16 and 64 bits are converted. Heights may be integers of 8 or 16 bits, too: the largest is 1.0, and the lowest of a
signed type -1.0. Extents are (width, height). Where a verb takes heights or a map, it takes a path, an Image or (of a
map) a Texture, too: tex.pack("rock_n.png"). numpy.asarray(image) joins the channels of an Image, and Image(array,
names) makes one. All objects and functions can be pickled.

A texture may hold more than normals: heights in alpha, occlusion in blue. Then a map is a NormalMap, which is an array
with these data beside it (n.alpha), and the data go along through verbs. tex.NormalMap(n, alpha=heights) puts them there.

Options are given by name and are the fields of the headers' structures. Options with separate values for x and y take
one value for both, or a pair (x, y): wrap="repeat", wrap=("repeat", "clamp"). Choices are the words of the commands.

Every verb on whole images takes threads=0, the largest number of threads (0: one for each processor), and
progress=callable. The callable gets the fraction done, from 0 to 1, on the caller's thread, and cancels if it returns
False or raises. Ctrl-C cancels, too. Verbs run without the GIL. The bytes are the same for every number of threads.

Errors are exceptions of the class Error, with code, file and reason. A wrong argument is a TypeError or ValueError.
IoError is an OSError, too; its errno is ENOSPC if the disk is full, and otherwise None.

After fork() (multiprocessing's "fork"), a child must not call libtex if its parent has: use "spawn" or "forkserver".
"""

from tex._errors import (
    BadDataError,
    BadOptionError,
    CancelledError,
    Error,
    IoError,
    OutOfMemoryError,
    UnsupportedError,
)
from tex import _tex
from tex._heights import read_heights
from tex._normal_map import NormalMap
from tex._run import Ran, RunError, commands, run

_verbs = {name: value for name, value in vars(_tex).items() if not name.startswith("_")}
globals().update(_verbs)

__version__ = _tex.version()
__all__ = sorted(
    [*_verbs, "BadDataError", "BadOptionError", "CancelledError", "Error", "IoError", "NormalMap", "OutOfMemoryError"]
    + ["Ran", "RunError", "UnsupportedError", "commands", "read_heights", "run"]
)
del _verbs
