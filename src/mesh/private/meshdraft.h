/* A mesh file in the making. A program that makes a mesh writes it in a folder of its own, beside the place where the
   file shall stand. It gets its name when it is whole, so that no run meets a part of a mesh.

   MeshDraftCheck() checks what the mesh is made of, MeshDraftCreate() makes the folder and those above it,
   MeshDraftFinish() gives the file its name and removes the folder. For one rank. */
#pragma once
#include "base/complaint.h"
#include "scene/scene.h"

/* Room in a path, in bytes, for "/mesh-", hash, process number and ending. */
enum { MESH_NAME_ROOM = 64 };

typedef struct {
  char folder[PETSC_MAX_PATH_LEN + 16]; /* the only one in which the program may write */
  char mesh[PETSC_MAX_PATH_LEN + 32];   /* the file that it writes */
} MeshDraft;

void           MeshDraftCheck(Scene, const char *directory, Complaint *);
void           MeshDraftCreate(const char *file, MeshDraft *, Complaint *);
PetscErrorCode MeshDraftFinish(MeshDraft *, const char *file, Complaint *);
