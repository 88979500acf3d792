/* What a mesh consists of: the arrays, groups and rigid tools that every part of it works on. Its users include mesh.h.

   A node is a local degree-of-freedom carrier on a Plex point (vertex; for order 2 also edge, face or cell centre).
   Local nodes are numbered 0..n_nodes-1 in the order of the local section, so that node n has local dofs n*dim ..
   n*dim+dim-1 (supports included: the local section holds every dof, the global section only the free ones). Cells are
   not overlapped: each belongs to one rank; local cell c is Plex point c. No node order of Plex is used anywhere: cells
   keep gmsh's. */
#pragma once
#include "base/petsccompat.h"
#include "kernels/element.h"
#include "mesh/partition.h"
#include "scene/scene.h"

enum { MESH_TEXT = 512 }; /* room for a list of names in a message; longer lists are cut off */

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
  MPI_Comm  comm;
  DM        dm; /* DMPlex; its local section is the displacement's */
  int       dim, order;
  PetscInt  n_nodes, n_owned, n_global;
  PetscInt *node_id;          /* 0..n_global-1 in the order of gmsh's tags: the same on any number of ranks */
  PetscInt *node_tag;         /* gmsh's */
  PetscInt *node_owner;       /* rank */
  PetscInt *node_owner_local; /* the node's local number there */
  PetscReal
    *coords; /* n_nodes*dim, relative to centre; axisymmetric: the first is the radius itself, since centre[0] = 0 */
  PetscReal centre[3],
    size; /* of the bodies' bounding box, without rigid tools; size: its diagonal; axisymmetric: centre[0] = 0 */
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
  /* for meshdofs.c only */
  PetscInt  *node_point;  /* Plex point of a local node */
  PetscSF    node_sf;     /* ghost nodes to their owners' nodes */
  PetscInt  *global_dofs; /* NULL until MeshSetConstraints() */
  PetscReal *work;        /* n_nodes*dim */
} *Mesh;
