#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# graph.sh: prints, for each folder of sources, the other folders whose headers it includes. Folders that include each
# other, directly or in a circle, are an error. `verbs` are the sources in libtex/src itself, `commands` those in tools;
# the folders in formats count as one. Public headers (tex/) are left out: everything may include them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

arrows=$(grep -rnoH --include='*.cpp' --include='*.h' '#include "[a-z_0-9/-]*/[a-z_0-9-]*\.h"' libtex/src tools |
    sed -E 's/:[0-9]+:#include "/ /; s/"$//' |
    awk '
        function folder(path) {
            sub(/^libtex\/src\//, "", path)
            if (path ~ /^tools\/[^\/]*$/) return "commands"
            sub(/^tools\//, "", path)
            if (path !~ /\//) return "verbs"
            sub(/\/.*/, "", path)
            return path
        }
        { from = folder($1); to = folder($2); if (from != to) print from, to }' | sort -u)
tsort <<<"$arrows" >/dev/null
awk '{ to[$1] = to[$1] " " $2 } END { for (from in to) print from ":" to[from] }' <<<"$arrows" | sort
