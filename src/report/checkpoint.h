/* checkpoint.h5: a run as it stands after a step, from which it goes on with any number of ranks. Knows which objects a
   run consists of, not what is in them (archive.h).

     scene/     file: its name; text: the document after -set
     mesh/file  the .msh file, gmsh's tags included: a restart needs no gmsh and no other file
     model/     displacements by node, load parameter, scales;  path/  the last states;  contact/  state by pair and
   slave node stepper/   step size and counts;  results/  last step, probes, what steps.csv and results.h5 held

   A run: CheckpointCreate(), CheckpointSetRun(), CheckpointWrite() whenever the state is to be kept. A restart:
   CheckpointOpen(), CheckpointReadScene(), CheckpointMeshFile(), then the same objects as ever, CheckpointSetRun(),
   CheckpointRead() in the place of ModelSetUp(). */
#pragma once
#include "report/results.h"

typedef struct _n_Checkpoint *Checkpoint;

PetscErrorCode CheckpointCreate(MPI_Comm, const char *directory, const char *mesh_file, Checkpoint *);
/* Refuses what is no whole checkpoint of ours. Collective. */
PetscErrorCode CheckpointOpen(MPI_Comm, const char *directory, Checkpoint *);
PetscErrorCode CheckpointDestroy(Checkpoint *);
/* The scene as the run had it, with edits of solver, output and stepping. Collective. */
PetscErrorCode CheckpointReadScene(Checkpoint, int n_set, char *const *set, Scene *);
/* A file that holds the mesh, on rank 0; it goes with CheckpointDestroy(). file has room for PETSC_MAX_PATH_LEN.
 * Collective. */
PetscErrorCode CheckpointMeshFile(Checkpoint, char *file);
/* What is saved and restored; borrowed. Not collective. */
PetscErrorCode CheckpointSetRun(Checkpoint, Scene, Model, LoadStepper, Results);
PetscErrorCode CheckpointRead(Checkpoint);  /* the state into them; no file is touched. Collective */
PetscErrorCode CheckpointWrite(Checkpoint); /* their state, whole or not at all. Collective */
