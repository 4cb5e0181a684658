#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# slurm.sh SHARDS: one shard of a plan, as a task of a Slurm array job. Submit it in the folder of normals.toml:
#
#     build-normals --plan plan.jsonl
#     sbatch --array=1-64 slurm.sh 64
#     build-normals --plan plan.jsonl --merge reports/*.jsonl    # after the array has ended; may print 3,7
#     sbatch --array=3,7 slurm.sh 64                             # ... and merge again
#
# The number of shards is an argument, because it must stay the same when some of them are sent again;
# SLURM_ARRAY_TASK_COUNT would not.
#SBATCH --job-name=normals
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --cpus-per-task=2
#SBATCH --time=4:00:00
shards=$1 shard=$SLURM_ARRAY_TASK_ID

# Not "exec": if build-normals is killed, for want of memory or by hand, this shell asks for another try. The job is
# named by array and task, because the last task has the number of the whole array as its own.
build-normals --plan plan.jsonl --shard "$shard/$shards" --report "reports/$shard.jsonl" \
    --threads "${SLURM_CPUS_PER_TASK:-2}"
status=$?
if [ "$status" -gt 128 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" && sleep 60 # the requeue ends this shell
fi
exit "$status"
