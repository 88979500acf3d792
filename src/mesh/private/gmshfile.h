/* Reads gmsh's .msh files (format 4.1, text and binary) into plain arrays. The first rank reads the file piece by
   piece, and each rank keeps a part of it. It knows nothing of scenes and bodies. GmshRead() reads a file,
   GmshFileLoad() loads any file as text.

   DMPlex's reader is not used, because this one keeps gmsh's tags, which are the keys that do not depend on the number
   of ranks, keeps second-order nodes in gmsh's order, reads groups of every dimension, and describes what is wrong with
   a file. */
#pragma once
#include "gmshmesh.h"

PetscErrorCode GmshRead(MPI_Comm, const char *file, GmshMesh *, Complaint *);
PetscErrorCode GmshFileLoad(const char *file, char **data, size_t *size);
