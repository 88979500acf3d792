#!/bin/bash
# A run as a chain of Slurm jobs: each goes on from the checkpoint of the one before, until the run has ended.
#   sbatch runs/batch/slurm.sh runs/pipe_pinch.yaml out/pipe_pinch [burnish's and PETSc's options]
# from the root of Burnish. To be adapted: nodes, ranks, time, partition. Meshes first where compute nodes have no gmsh: burnish -mesh SCENE.yaml
#SBATCH --job-name=burnish
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=2
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --open-mode=append
#SBATCH --output=%x-%j.out
# --signal: to this script (B), 300 s before the end: more than a step and a checkpoint take. --ntasks-per-node: one rank a core; few ranks are
# faster where memory bandwidth ends first.
set -u
SCENE=$1 DIR=$2 OPTIONS=("${@:3}")
cd "${SLURM_SUBMIT_DIR:-.}" || exit 4
. runs/batch/chain.sh
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# shellcheck disable=SC2034 # read by chain.sh
BURNISH=(build/burnish "${OPTIONS[@]}")
# srun where Open MPI or MPICH is built for Slurm: LAUNCH=(srun --cpu-bind=cores)
# shellcheck disable=SC2034,SC2206 # a command of several words
LAUNCH=(${LAUNCH:-mpirun -n ${SLURM_NTASKS:-2} --bind-to core})
# shellcheck disable=SC2329 # called by run_chain
resubmit() { sbatch --dependency=afterany:"${SLURM_JOB_ID:-}" runs/batch/slurm.sh "$SCENE" "$DIR" "${OPTIONS[@]}"; }
run_chain
