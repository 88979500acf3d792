/* A checkpoint is the file checkpoint.h5: a run as it stands after a step, from which it goes on with any number of
   ranks. This part knows which objects a run consists of, and archive.h writes and checks the file.

     scene/     file: name of the scene file; text: the document after -set
     mesh/file  the .msh file with gmsh's tags, so that a restart needs no gmsh and no other file
     model/     displacements by node, load parameter, scales;  path/  the last states;  linear/  counts of solves
     contact/   state by pair and slave node;  stepper/  step size and counts
     results/   last step, probes, what steps.csv and results.vtkhdf held;  options/  PETSc's options

   A run calls CheckpointCreate(), CheckpointSetRun(), and CheckpointWrite() whenever the state is to be kept. A restart
   calls CheckpointOpen(), CheckpointReadScene() and CheckpointMeshFile(), makes the same objects as any run, and calls
   CheckpointSetRun() and CheckpointRead() in the place of ModelSetUp(). */
#pragma once
#include "report/results.h"

typedef struct _n_Checkpoint *Checkpoint;

PetscErrorCode CheckpointCreate(MPI_Comm, const char *directory, const char *mesh_file, Checkpoint *);
PetscErrorCode CheckpointOpen(MPI_Comm, const char *directory, Checkpoint *);
PetscErrorCode CheckpointDestroy(Checkpoint *);
PetscErrorCode CheckpointReadScene(Checkpoint, int n_set, char *const *set, Scene *);
PetscErrorCode CheckpointMeshFile(Checkpoint, char *file);
PetscErrorCode CheckpointSetRun(Checkpoint, Scene, Model, LoadStepper, Results);
PetscErrorCode CheckpointRead(Checkpoint);
PetscErrorCode CheckpointWrite(Checkpoint);
