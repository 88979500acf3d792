#!/bin/bash
# A run as a chain of PBS jobs: each goes on from the checkpoint of the one before, until the run has ended.
#   qsub -v SCENE=runs/pipe_pinch.yaml,DIR=out/pipe_pinch runs/batch/pbs.sh
# from the root of Burnish. To be adapted here, as the next job knows no options of qsub: nodes, ranks, time, queue. Meshes first where compute nodes have no gmsh: burnish -mesh SCENE.yaml
#PBS -N burnish
#PBS -l select=1:ncpus=2:mpiprocs=2:ompthreads=1
#PBS -l walltime=12:00:00
#PBS -j oe
# PBS sends no signal ahead of the end that all sites pass on: the run watches its time itself. LIMIT: walltime in seconds, less what starting takes.
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
