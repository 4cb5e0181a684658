#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# parallel.sh HOSTS SHARDS: GNU parallel runs the shards over ssh, on machines that share this folder, and again if some
# were lost. HOSTS is a list as for --sshlogin ("4/north,8/south": so many at once on each; ":" is this machine).
#
#     samples/farm/parallel.sh 4/north,8/south 24
set -euo pipefail
hosts=$1 shards=$2

rm -rf reports
mkdir reports
build-normals --plan plan.jsonl
todo=$(seq -s , "$shards")
for _ in 1 2 3; do
    # A shard that fails does not stop the others. Its failures are found below.
    tr , '\n' <<<"$todo" | parallel --sshlogin "$hosts" --workdir "$PWD" --joblog +reports/log \
        build-normals --plan plan.jsonl --shard "{}/$shards" --report "reports/{}.jsonl" --quiet || true
    if todo=$(build-normals --plan plan.jsonl --merge reports/*.jsonl); then exit 0; fi
    [ -n "$todo" ] || exit 1
done
exit 1
