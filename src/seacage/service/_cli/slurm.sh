#!/bin/bash
# {cases} sea states in {tasks} tasks, by `seacage campaign slurm`. Hand it to sbatch where the
# paths below are right and `seacage` is on the PATH; add time and partition as your cluster
# wants them. Handed in again it goes on where it stopped. The last task to end sums up; should
# it be lost there: seacage campaign finish {store}
#SBATCH --job-name=seacage
#SBATCH --array=0-{last}
#SBATCH --ntasks=1
#SBATCH --cpus-per-task={workers}
#SBATCH --mem-per-cpu=1G
set -euo pipefail
export OMP_NUM_THREADS=1
exec {command} --share "$SLURM_ARRAY_TASK_ID/{tasks}"
