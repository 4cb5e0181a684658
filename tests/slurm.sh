#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# slurm.sh COMMANDS: builds textures on a real Slurm, with the commands of the folder COMMANDS and
# samples/farm/slurm.sh, while a worker is killed, a node is taken down, a slurmd is killed together with its jobs, and
# a batch shell is killed. Shards are sent again as --merge says. In the end, all outputs must have the bytes that one
# plain run makes.
#
# Starts a cluster of three nodes on this machine, which needs no service and no configuration, and ends it. Takes half
# a minute. Needs Debian's packages slurmctld, slurmd, slurm-client and munge. Exit status 77: no cluster can be
# started.
set -euo pipefail
samples=$(cd "$(dirname "${BASH_SOURCE[0]}")/../samples" && pwd)
commands=$(cd "$1" && pwd)
export PATH=$commands:$PATH:/usr/sbin:/sbin
scratch=$(mktemp -d /tmp/slurm_test.XXXXXX)
chmod 711 "$scratch" # munged wants a path that everyone can traverse
lab=$scratch/lab
tree=$scratch/tree
export SLURM_CONF=$lab/slurm.conf
nodes=3 shards=9
port=$((21000 + $$ % 1000 * 10))
say() { printf 'slurm: %3d s: %s\n' "$SECONDS" "$*"; }
fail() { say "FAILED: $*" >&2; tail -n 5 "$lab"/*.log "$tree"/slurm-*.out >&2 || true; exit 1; }

# -- the cluster --------------------------------------------------------------------------------------------------
# end PIDFILE: ends the daemon that wrote this file.
end() {
    local pid
    [ -s "$1" ] && pid=$(cat "$1") || return 0
    kill -TERM "$pid" 2>/dev/null || return 0
    # A zombie has ended, too.
    for _ in $(seq 40); do grep -qs '^State:[[:space:]]*[^Z]' "/proc/$pid/status" || return 0; sleep 0.1; done
    kill -KILL "$pid" 2>/dev/null || true
}
finish() {
    scancel -u "$(id -un)" 2>/dev/null || true
    for _ in $(seq 50); do [ -n "$(squeue -h -t R,CG 2>/dev/null)" ] || break; sleep 0.1; done
    for pid in "$lab"/slurmd.*.pid "$lab/slurmctld.pid" "$lab/munged.pid"; do end "$pid"; done
    rm -rf "$scratch"
}
start_node() { mkdir -p "$lab/spool.n$1" && slurmd -N "n$1" -f "$SLURM_CONF"; }
start() {
    local host k
    host=$(hostname -s)
    mkdir -m 711 "$lab" && mkdir "$lab/state"
    mungekey --create --bits 1024 --keyfile "$lab/munge.key"
    munged --key-file="$lab/munge.key" --socket="$lab/munge.sock" --pid-file="$lab/munged.pid" \
        --log-file="$lab/munged.log" --seed-file="$lab/munge.seed"
    # Several slurmd on one host, without cgroups. A dead node is noticed after 10 s; its jobs start again elsewhere.
    cat >"$SLURM_CONF" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$lab/munge.sock,cred_expire=5
StateSaveLocation=$lab/state
SlurmdSpoolDir=$lab/spool.%n
SlurmctldPidFile=$lab/slurmctld.pid
SlurmdPidFile=$lab/slurmd.%n.pid
SlurmctldLogFile=$lab/slurmctld.log
SlurmdLogFile=$lab/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
SchedulerType=sched/backfill
SchedulerParameters=bf_interval=2,sched_interval=2,batch_sched_delay=0
JobRequeue=1
ReturnToService=1
SlurmdTimeout=10
SlurmctldTimeout=10
MessageTimeout=10
KillWait=2
CompleteWait=0
MinJobAge=86400
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
NodeName=n[1-$nodes] NodeHostname=$host NodeAddr=127.0.0.1 Port=[$((port + 1))-$((port + nodes))] CPUs=1 State=UNKNOWN
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    slurmctld -f "$SLURM_CONF" || true
    for k in $(seq "$nodes"); do start_node "$k" || true; done
    for _ in $(seq 300); do
        [ "$(sinfo -h -N -o %T 2>/dev/null | grep -c '^idle$')" != "$nodes" ] || return 0
        sleep 0.1
    done
    say "no cluster can be started here"
    tail -n 5 "$lab"/*.log >&2 || true
    exit 77
}

# -- its jobs -----------------------------------------------------------------------------------------------------
# environ_of PID NAME: a variable of its environment.
environ_of() { { tr '\0' '\n' <"/proc/$1/environ"; } 2>/dev/null | sed -n "s/^$2=//p" || true; }
# processes PATTERN [NODE]: the processes of this cluster whose command line matches, on one node or on all.
processes() {
    local pid
    for pid in $(pgrep -f "$1"); do
        [ "$(environ_of "$pid" SLURM_CONF)" = "$SLURM_CONF" ] || continue
        [ $# -lt 2 ] || [ "$(environ_of "$pid" SLURMD_NODENAME)" = "$2" ] || continue
        echo "$pid"
    done
}
# Waits until a shard runs on a node that is not among the named ones, and stops its worker, so that the shard cannot
# end before something happens to it. Prints "PID SHARD NODE" of the worker.
stop_shard() {
    local pid node shard
    for _ in $(seq 600); do
        for pid in $(processes '^build-normals --plan'); do
            node=$(environ_of "$pid" SLURMD_NODENAME)
            if [ -z "$node" ] || [[ " $* " == *" $node "* ]]; then continue; fi
            shard=$(environ_of "$pid" SLURM_ARRAY_TASK_ID)
            kill -STOP "$pid" 2>/dev/null || continue
            if [ -e "$tree/reports/$shard.jsonl" ]; then
                kill -CONT "$pid"
                continue
            fi
            echo "$pid $shard $node"
            return
        done
        sleep 0.1
    done
    fail "no shard is running"
}
submit() {
    (cd "$tree" && sbatch --parsable --array="$1" --cpus-per-task=1 "$samples/farm/slurm.sh" "$shards" >/dev/null)
}
wait_for_jobs() {
    for _ in $(seq 1800); do
        [ -n "$(squeue -h 2>/dev/null)" ] || return 0
        sleep 0.1
    done
    squeue >&2
    fail "the jobs do not end"
}
merge() { (cd "$tree" && build-normals --plan plan.jsonl --merge reports/*.jsonl 2>>merge.log); }

trap finish EXIT
start
say "$nodes nodes are up"

# -- one plain run, and a tree without outputs ----------------------------------------------------------------------
mkdir -p "$tree/art"
for k in $(seq 90); do cp "$samples/bricks.png" "$tree/art/b$k.png"; done
cp "$samples/waves.png" "$tree/waves.png"
cat >"$tree/normals.toml" <<'MANIFEST'
version = 1
[defaults]
out-dir = "out"
[[rule]]
match = "waves.png"
steps = [ { bake = { bumpiness = 2 } } ]
[[rule]]
match = "art/*.png"
steps = [
  { bake = { bumpiness = 4 } },
  { blend = { detail = "out/waves.dds", tiling = 4 } },
  { mip = { effort = "best" } },
]
MANIFEST
cp -r "$tree" "$scratch/plain"
(cd "$scratch/plain" && build-normals --quiet)
say "one plain run has made $(find "$scratch/plain/out" -type f | wc -l) outputs"

# -- the array, and what goes wrong -----------------------------------------------------------------------------------
(cd "$tree" && build-normals --plan plan.jsonl --quiet)
submit "1-$shards"
read -r worker shard node < <(stop_shard)
kill -KILL "$worker"
say "the worker of shard $shard is killed, on $node: its shell asks for another try"
read -r worker shard down < <(stop_shard "$node")
scontrol update nodename="$down" state=down reason=test
kill -CONT "$worker" 2>/dev/null || true
say "node $down is taken down under shard $shard: Slurm starts it elsewhere"
read -r worker shard dead < <(stop_shard "$down")
kill -KILL "$(cat "$lab/slurmd.$dead.pid")"
# shellcheck disable=SC2046  # numbers
kill -KILL $(processes . "$dead") "$worker" 2>/dev/null || true
say "the slurmd of $dead is killed, with shard $shard: Slurm notices after 10 s"
scontrol update nodename="$down" state=resume
rm -f "$lab/slurmd.$dead.pid"
read -r worker lost node < <(stop_shard "$dead")
shell=$(sed 's/.*) . \([0-9]*\) .*/\1/' "/proc/$worker/stat")
kill -KILL "$shell" "$worker"
say "the batch shell of shard $lost is killed: Slurm does not start it again"
sleep 1
start_node "${dead#n}"
wait_for_jobs
say "the array has ended; $(find "$tree/reports" -name '*.jsonl' | wc -l) of $shards shards have reported"

# -- shards are sent again ------------------------------------------------------------------------------------------
sent=0
until again=$(merge); do
    [ -n "$again" ] || fail "--merge names no shard: $(cat "$tree/merge.log")"
    [ "$sent" -lt 5 ] || fail "shards are missing after five tries"
    sent=$((sent + 1))
    say "send again: $again"
    submit "$again"
    wait_for_jobs
done
[ "$sent" -gt 0 ] || fail "the shard whose shell was killed is not missing"
diff -r "$scratch/plain/out" "$tree/out" || fail "the outputs are not those of one plain run"
[ -z "$(find "$tree/reports" "$tree/out" ! -type d ! -name '*.jsonl' ! -name '*.dds')" ] || fail "something is left"
summary=$(cd "$tree" && build-normals)
[ "$summary" = '0 made, 91 up to date' ] || fail "after the merge, a plain run says: $summary"
say "complete: the outputs have the bytes of one plain run"
