#!/bin/bash
# A run as a chain of PBS jobs. Each job goes on from the checkpoint of the one before, until the run has ended.
# Submit it from the root of Burnish:
#   qsub -v SCENE=runs/pipe_pinch.yaml,DIR=out/pipe_pinch runs/batch/pbs.sh
# Adapt nodes, ranks, time and queue in this file, because the next job does not know the options of qsub. Where compute
# nodes have no gmsh, make the mesh before: burnish -mesh SCENE.yaml
#PBS -N burnish
#PBS -l select=1:ncpus=2:mpiprocs=2:ompthreads=1
#PBS -l walltime=12:00:00
#PBS -j oe
# Not all sites pass on a signal of PBS before the end of a job, so the run watches its time itself. LIMIT is the
# walltime in seconds minus the time that the start takes.
set -u
LIMIT=${LIMIT:-43000}
cd "${PBS_O_WORKDIR:-.}" || exit 4
. runs/batch/chain.sh
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# export OPENBLAS_CORETYPE=SkylakeX # where a run's first lines say that this is faster, and all nodes are alike
# shellcheck disable=SC2034 # read by chain.sh
BURNISH=(build/burnish -time_limit "$LIMIT")
# shellcheck disable=SC2034,SC2206 # a command of several words
LAUNCH=(${LAUNCH:-mpirun -n ${PBS_NP:-2} --bind-to core})
# shellcheck disable=SC2317,SC2329 # called by run_chain
resubmit() { qsub -W depend=afterany:"${PBS_JOBID:-}" -v "SCENE=$SCENE,DIR=$DIR,LIMIT=$LIMIT" runs/batch/pbs.sh; }
run_chain
