/* One run: the objects between a scene file and its results, and the order in which they are made.

   RunScene() makes them one after the other and solves the scene. Whatever it returns, the objects that exist are in
   the Run, and RunDestroy() frees them. burnish.c is the only user. */
#pragma once
#include "burnish.h"
#include "report/checkpoint.h"

typedef enum {
  RUN_SOLVE, /* to the end, with results */
  RUN_CHECK, /* everything up to the first solve; reports on stdout */
  RUN_MESH   /* the mesh file only */
} RunTask;

/* What the user asks for */
typedef struct {
  RunTask     task;
  const char *scene;     /* scene file; NULL with restart */
  const char *directory; /* of the results; NULL: out/NAME */
  const char *restart;   /* directory of a run that is continued, or NULL */
  int         mesh;      /* with an accuracy that is asked for: number of the mesh; 0 counts as 1 */
  int         n_set;
  char      **set; /* KEY=VALUE edits of the scene */
  PetscBool   overwrite, quiet;
  PetscBool   trust; /* the scene may load libraries, run programs and write files of its own */
} RunInput;

typedef struct {
  MPI_Comm        comm;
  const RunInput *input;  /* during RunScene() */
  PetscLogDouble  start;  /* time when it began (s) */
  PetscReal       mesh_s; /* seconds that the mesh generator took */
  char            directory[PETSC_MAX_PATH_LEN], mesh_file[PETSC_MAX_PATH_LEN];
  Scene           scene;
  Checkpoint      checkpoint;
  Mesh            mesh;
  Model           model;
  Probes          probes;
  Results         results;
  LoadStepper     stepper;
  PetscBool       refines; /* the scene asks for an accuracy: this run is on one of several meshes */
  PetscInt        n_ends, ends_room;
  PetscReal      *ends;          /* load parameters at which steps ended, for runs besides (again.h) */
  PetscInt        kept;          /* step of the last checkpoint, -1: none */
  int             n_options;     /* PETSc options of the scene that are in PETSc's database */
  char          **options;       /* their names, with dash */
  char            message[1024]; /* why it did not end with BURNISH_DONE */
} Run;

PetscErrorCode RunScene(Run *, const RunInput *, BurnishStatus *);
PetscErrorCode RunDestroy(Run *);
