#!/bin/bash
# A run as a Slurm job that goes back into the queue until the run has ended. Each time it goes on from the last
# checkpoint. Submit it from the root of Burnish:
#   sbatch runs/batch/slurm.sh runs/pipe_pinch.yaml out/pipe_pinch [burnish's and PETSc's options]
# Adapt nodes, ranks, time and partition. Where compute nodes have no gmsh, make the mesh before: burnish -mesh
# SCENE.yaml
#SBATCH --job-name=burnish
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=2
#SBATCH --cpus-per-task=1
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@300
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x-%j.out
# --signal: this script (B) gets the signal 300 s before the end, which is more than a step and a checkpoint take.
# --ntasks-per-node: one rank for each core. Fewer ranks are faster where the memory bandwidth is the limit.
set -u
SCENE=$1 DIR=$2
cd "${SLURM_SUBMIT_DIR:-.}" || exit 4
. runs/batch/chain.sh
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# export OPENBLAS_CORETYPE=SkylakeX # where a run's first lines say that this is faster, and all nodes are alike
# shellcheck disable=SC2034 # read by chain.sh
BURNISH=(build/burnish "${@:3}")
# srun where Open MPI or MPICH is built for Slurm: LAUNCH=(srun --cpu-bind=cores)
# shellcheck disable=SC2034,SC2206 # a command of several words
LAUNCH=(${LAUNCH:-mpirun -n ${SLURM_NTASKS:-2} --bind-to core})
# shellcheck disable=SC2317,SC2329 # called by run_chain; with all options that sbatch was given
resubmit() { scontrol requeue "${SLURM_JOB_ID:?}"; }
run_chain
