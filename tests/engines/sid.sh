#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# sid.sh ROOT ENGINE: godot or blender, in a root of Debian sid, draws the cases.json of the current folder.
#
# ROOT is made if it is not there (mmdebstrap, root, 2 GB, some minutes); exits with 77 if that cannot be. "sid.sh ROOT
# --version ENGINE" prints its package. DRAW=COMMAND runs another command in this folder.
set -euo pipefail
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$1 engine=${*: -1}
shift
packages=blender,godot,python3-numpy,xvfb,xauth,libgl1-mesa-dri,libegl1
if [ ! -e "$root/usr/bin/godot" ]; then
    if [ "$(id -u)" -ne 0 ] || ! command -v mmdebstrap >/dev/null; then
        echo "$0: no root of Debian sid: needs root and mmdebstrap"
        exit 77
    fi
    rm -rf "$root.new"
    # A mirror that stands still has an index that is past its date. It must be signed all the same.
    mmdebstrap --quiet --variant=apt --include="$packages" --aptopt='Acquire::Check-Valid-Until "false"' \
        --aptopt='APT::Install-Recommends "false"' sid "$root.new" "${MIRROR:-http://deb.debian.org/debian}" ||
        { rm -rf "$root.new"; echo "$0: the mirror does not have sid"; exit 77; }
    mv "$root.new" "$root"
fi
if [ "$1" = --version ]; then
    # shellcheck disable=SC2016  # dpkg-query's
    chroot "$root" dpkg-query -W -f '${Package} ${Version}' "$engine"
    exit
fi

# inside COMMAND: in this folder, which the root has at the same place. The mounts end with it.
inside() {
    # shellcheck disable=SC2016  # expanded in the shell that has the mounts
    unshare --mount --pid --fork --kill-child bash -euc '
        root=$1 here=$2
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        mount --rbind /sys "$root/sys"
        mount -t tmpfs tmpfs "$root/tmp"
        mkdir -p "$root/$here"
        mount --bind "$here" "$root/$here"
        exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
            chroot "$root" bash -euc "cd \"$here\"; $3; exit" # Xvfb does not tell process 1 that it is ready
    ' inside "$root" "$PWD" "$1" >log 2>&1 || { tail -n 5 log; return 1; }
}

for link in *; do # links point out of the folder
    if [ -L "$link" ]; then cp -rL "$link" copy && rm "$link" && mv copy "$link"; fi
done
godot='xvfb-run -a godot --audio-driver Dummy --rendering-method gl_compatibility --rendering-driver opengl3'
case $engine in
    godot)
        cp "$tests"/*.gd .
        printf 'config_version=5\n[rendering]\nrenderer/rendering_method="gl_compatibility"\n' >project.godot
        # What the recipe sets in the Import dock is in the file that a first import makes.
        inside 'godot --headless --import'
        find . -name '*.png.import' -not -path './models/*' -exec sed -i -e 's|^compress/mode=0|compress/mode=2|' \
            -e 's|^compress/normal_map=0|compress/normal_map=1|' \
            -e 's|^mipmaps/generate=false|mipmaps/generate=true|' {} +
        inside 'godot --headless --import'
        inside 'godot --headless --script godot_bake.gd'
        inside "timeout 600 ${DRAW:-$godot --resolution 64x64 --script godot.gd}"
        ;;
    blender)
        cp "$tests"/*.py .
        inside "${DRAW:-blender -b --python-exit-code 1 -P blender.py}"
        ;;
    *) echo "$0: no engine $engine"; exit 2 ;;
esac
