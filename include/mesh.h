/* The distributed mesh: a DMPlex from gmsh, partitioned by METIS, with every node's reference coordinates, physical groups by name, and
   gmsh's tags as rank-independent keys. Knows no physics.

   A node is a local degree-of-freedom carrier on a Plex point (vertex; for order 2 also edge, face or cell centre). Local nodes are
   numbered 0..n_nodes-1 in the order of the local section, so that node n has local dofs n*dim .. n*dim+dim-1 (supports included: the
   local section holds every dof, the global section only the free ones). Cells are not overlapped: each belongs to one rank; local cell c
   is Plex point c. No node order of Plex is used anywhere: cells keep gmsh's. */
#pragma once
#include "petsccompat.h"
#include "element.h"
#include "partition.h"
#include "scene.h"

typedef struct {
  char    *name;
  PetscInt tag; /* gmsh's physical tag */
  int      dim; /* of the group: mesh->dim for volumes, less for surfaces, curves, points */
  /* nodes on the group: all local ones, also where no face of the group is on this rank; ascending */
  PetscInt n_nodes, *nodes;
  /* faces (dim - 1 groups of the deformable mesh): those of this rank's cells */
  PetscInt  n_faces, *face_cell; /* local cell */
  int      *face_number;         /* which face of that cell (element table) */
  PetscInt *face_tag;            /* gmsh's element tag */
  PetscBool attached;            /* false: its elements are no faces of cells (a rigid tool), see rigid */
  PetscInt  n_elements, n_loose; /* on all ranks, in the file: elements, and those that do not lie on any body */
} MeshGroup;

/* A surface mesh that carries no unknowns, whole on every rank: a meshed rigid tool. Node order as gmsh wrote it. */
typedef struct {
  char        *name;
  PetscInt     n_nodes, n_faces;
  PetscReal   *coords; /* n_nodes*dim, relative to mesh->centre */
  PetscInt    *node_tag;
  ElementType *face_type;
  PetscInt    *face_ptr, *face_nodes, *face_tag; /* CSR */
} MeshRigid;

typedef struct {
  MPI_Comm     comm;
  DM           dm; /* DMPlex; its local section is the displacement's */
  int          dim, order;
  PetscInt     n_nodes, n_owned, n_global;
  PetscInt    *node_id;          /* 0..n_global-1 in the order of gmsh's tags: the same on any number of ranks */
  PetscInt    *node_tag;         /* gmsh's */
  PetscInt    *node_owner;       /* rank */
  PetscInt    *node_owner_local; /* the node's local number there */
  PetscReal   *coords;           /* n_nodes*dim, relative to centre */
  PetscReal    centre[3], size;  /* of the bodies' bounding box, without rigid tools; size: its diagonal; axisymmetric: centre[0] = 0 */
  PetscInt     n_cells, n_cells_global;
  PetscInt    *cell_id; /* 0..n_cells_global-1 in the order of gmsh's tags */
  ElementType *cell_type;
  PetscInt    *cell_ptr, *cell_nodes; /* CSR, local nodes in gmsh's order */
  int         *cell_body;             /* index into scene->bodies */
  PetscInt    *cell_tag;
  int          n_groups;
  MeshGroup   *groups;
  int          n_rigid;
  MeshRigid   *rigid;
  Partition    partition;
  /* for mesh.c only */
  PetscInt  *node_point;  /* Plex point of a local node */
  PetscSF    node_sf;     /* ghost nodes to their owners' nodes */
  PetscInt  *global_dofs; /* NULL until MeshSetConstraints() */
  PetscReal *work;        /* n_nodes*dim */
} * Mesh;

/* gmsh: .geo -> .msh (once, into DIR/mesh-HASH.msh); a .msh is returned as it is. file has room for PETSC_MAX_PATH_LEN. Collective. */
PetscErrorCode MeshGenerate(MPI_Comm, Scene, const char *directory, char *file, PetscReal *seconds);
PetscErrorCode MeshCreate(MPI_Comm, Scene, const char *file, Mesh *);
PetscErrorCode MeshDestroy(Mesh *);
/* the group of that name and at most that dimension, or refuses: names the key, says which groups there are. Collective. */
PetscErrorCode MeshGetGroup(Mesh, Scene, const char *path, const char *key, const char *name, int dim, MeshGroup **);
MeshRigid     *MeshFindRigid(Mesh, const char *name); /* or NULL */
/* nodes and type of face f of a group, in the face's own node order (outward) */
ElementType MeshFaceNodes(Mesh, const MeshGroup *, PetscInt f, PetscInt nodes[FACE_MAX_NODES]);
/* Bodies, cells, element types, quality (smallest scaled Jacobian per body and its cell), for -check and the first lines of a run. Collective. */
PetscErrorCode MeshReport(Mesh, Scene, FILE *);
/* Refuses inverted elements (cell tag, body, smallest determinant). Collective. */
PetscErrorCode MeshCheckQuality(Mesh, Scene);
/* Marks constrained local dofs (n_nodes*dim; OR-ed over the ranks that share a node), makes the sections. Before any vector. Collective. */
PetscErrorCode MeshSetConstraints(Mesh, const PetscBool *constrained);
/* Global number of every local dof (n_nodes*dim), -1 where constrained; belongs to the mesh. */
PetscErrorCode MeshGetGlobalDofs(Mesh, const PetscInt **dofs);
/* x (global, free dofs) into u (n_nodes*dim local, ghosts too); constrained entries of u are left alone. Collective. */
PetscErrorCode MeshGlobalToLocal(Mesh, Vec x, PetscReal *u);
/* F = sum over ranks of the free dofs of f (n_nodes*dim local contributions). Collective. */
PetscErrorCode MeshLocalToGlobal(Mesh, const PetscReal *f, Vec F);
/* Sums values (n_nodes*block) over all ranks' copies of a node; the sum stands on every copy. Collective. */
PetscErrorCode MeshSumNodes(Mesh, PetscInt block, PetscReal *values);
