/* gmsh: running it on a .geo file, and reading .msh files (format 4.1, text and binary) into plain arrays. One rank does both; the mesh
   turns the arrays into a distributed DMPlex.

   An own reader instead of DMPlex's: it keeps gmsh's tags (the rank-independent keys), second-order nodes in gmsh's order, groups of every
   dimension, and says in words what is wrong with a file. */
#pragma once
#include "petsccompat.h"
#include "element.h"
#include "scene.h"

/* The first mistake found, in words; empty: none. One rank fills it, then all ranks refuse together. */
typedef struct {
  char text[2048];
} GmshMessage;

typedef struct {
  int      dim;
  PetscInt tag;
  char    *name; /* a group without a name goes by its number */
} GmshPhysical;

/* The elements of one type on one geometric entity */
typedef struct {
  int            dim;
  const Element *element; /* NULL: points */
  int            nodes;   /* per element */
  PetscInt       n, *tag;
  PetscInt      *connectivity;           /* n*nodes indices into the node arrays, gmsh's node order */
  int            n_physicals, *physical; /* indices into GmshMesh.physicals */
  int           *sign;                   /* -1: the group names the entity with a minus sign, which turns its normals over (the elements are not turned) */
} GmshBlock;

typedef struct {
  PetscInt      n_nodes, *node_tag; /* ascending */
  PetscReal    *coords;             /* n_nodes*3 */
  int           n_physicals;
  GmshPhysical *physicals; /* ordered by descending dimension, then tag */
  int           n_blocks;
  GmshBlock    *blocks; /* those that belong to a physical group */
} GmshMesh;

PetscErrorCode GmshSay(GmshMessage *, const char *, ...) __attribute__((format(printf, 2, 3)));
/* Makes the scene's .msh from its .geo, or finds the one made before. file has room for PETSC_MAX_PATH_LEN. Not collective. */
PetscErrorCode GmshGenerate(Scene, const char *directory, char *file, PetscReal *seconds, GmshMessage *);
/* Reads a .msh file. Not collective. */
PetscErrorCode GmshRead(const char *file, GmshMesh *, GmshMessage *);
PetscErrorCode GmshReset(GmshMesh *);
