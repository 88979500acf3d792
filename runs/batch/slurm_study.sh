#!/bin/bash
# A study as a Slurm job array with several runs in each job. Afterwards scripts/study.py with the same arguments
# makes the table. Submit it from the root of Burnish:
#   sbatch --array=0-3 runs/batch/slurm_study.sh runs/pipe_pinch.yaml --vary contact.0.degree=2,4 \
#     --vary mesh.parameters.n_arc=12,24 --measure plate_force --reference finest
#SBATCH --job-name=burnish-study
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --output=%x-%A_%a.out
set -u
cd "${SLURM_SUBMIT_DIR:-.}" || exit 4
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
exec build/venv/bin/python scripts/study.py "$@" --job-array "${SLURM_ARRAY_TASK_ID:?},${SLURM_ARRAY_TASK_COUNT:?}"
