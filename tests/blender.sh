#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# blender.sh [BUILD]: Blender without a window runs samples/python/blender_bake.py with the module of BUILD
# (build/release), and check-normals passes what it makes. By hand, because Blender takes 600 MB:
# apt-get install --no-install-recommends blender
#
# Last result: 2026-11-23, Blender 3.4.1 of Debian 12: passed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source=$PWD
build=$(realpath "${1:-build/release}")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
export PYTHONPATH=$build/python

# blender_runs SCRIPT ARGUMENT...: with the file of `file`, if any. A failure of the script is one of this test.
blender_runs() { blender -b "${file[@]}" --python-exit-code 1 -P "$@" >log 2>&1 || { cat log; exit 1; }; }

cat >prepare.py <<END
import bpy
bpy.ops.wm.read_factory_settings(use_empty=True)
image = bpy.data.images.load("$source/samples/bricks.png")
image.name = "Height"
image.colorspace_settings.name = "Non-Color"
image.use_fake_user = True
image.pack()
bpy.ops.wm.save_as_mainfile(filepath="$scratch/rock.blend")
END
cat >inspect_saved.py <<END
import bpy
import numpy as np
image = bpy.data.images["Height normals"]
assert tuple(image.size) == (512, 512) and image.colorspace_settings.is_data, image
texels = np.array(image.pixels[:], np.float32).reshape(-1, 4)[:, :3] * 2 - 1
assert abs(np.linalg.norm(texels, axis=1) - 1).max() < 0.01, "the saved map does not have unit length"
END
file=()
blender_runs prepare.py
file=(rock.blend)
blender_runs "$source/samples/python/blender_bake.py" -- Height rock.dds
blender_runs inspect_saved.py
"$build/check-normals" rock.dds --require format=dxt5nm --require mips=full --require y=up
"$build/bake-normals" "$source/samples/bricks.png" -o expected.dds --bumpiness 8
cmp rock.dds expected.dds
echo "blender.sh: passed with $(blender --version | head -n 1)"
