#!/bin/bash
# A study as a PBS job array with several runs in each job. Afterwards scripts/study.py with the same arguments makes
# the table. Submit it from the root of Burnish:
#   qsub -J 0-3 -v "COUNT=4,STUDY=runs/pipe_pinch.yaml --vary contact.0.degree=2;4" runs/batch/pbs_study.sh
# A semicolon stands for a comma, because a comma ends a value of qsub's -v.
#PBS -N burnish-study
#PBS -l select=1:ncpus=1:mpiprocs=1:ompthreads=1
#PBS -l walltime=12:00:00
#PBS -j oe
set -u
cd "${PBS_O_WORKDIR:-.}" || exit 4
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
read -ra words <<<"${STUDY//;/,}"
exec build/venv/bin/python scripts/study.py "${words[@]}" --job-array "${PBS_ARRAY_INDEX:?},${COUNT:?}"
