/* What a mesh consists of: the arrays, groups and rigid tools that all parts of it work on. Other folders include
   mesh.h.

   A node carries degrees of freedom. Local nodes are numbered 0..n_nodes-1 in the order of their ids, so that node n
   has the local dofs n*dim .. n*dim+dim-1. This includes supports: there is a local dof for every component, a global
   one only for the free ones. Nodes of pressures follow those of cells, and those of tools with free motions come last.
   Cells do not overlap: each belongs to one rank. Local cells are in the order of their ids, too. */
#pragma once
#include "base/petsccompat.h"
#include "kernels/element.h"
#include "mesh/partition.h"
#include "scene/scene.h"

/* Characters of a list of names in a message. Longer lists are cut off. */
enum { MESH_TEXT = 512 };

typedef struct {
  char    *name;
  PetscInt tag; /* gmsh's physical tag */
  int      dim; /* of the group: mesh->dim for volumes, less for surfaces, curves and points */
  /* All local nodes on the group, ascending, also where no face of the group is on this rank. */
  PetscInt n_nodes, *nodes;
  /* Faces of this rank's cells, for groups of dimension dim - 1 on deformable bodies. */
  PetscInt  n_faces, *face_cell; /* local cell */
  int      *face_number;         /* number of the face in that cell, from the element table */
  PetscInt *face_tag;            /* gmsh's element tag */
  PetscBool attached;            /* PETSC_FALSE: its elements are not faces of cells, as of a rigid tool, see rigid */
  PetscInt  n_elements, n_loose; /* in the whole file: elements, and those that do not lie on any body */
} MeshGroup;

/* A meshed rigid tool: a surface mesh without unknowns, whole on every rank. Its node order is gmsh's, reversed where
   the group has a minus sign. */
typedef struct {
  char        *name;
  PetscInt     n_nodes, n_faces, n_given; /* n_given: faces in the file, some of which may be divided */
  PetscReal   *coords;                    /* n_nodes*dim, relative to mesh->centre */
  PetscInt    *node_tag;
  ElementType *face_type;
  PetscInt    *face_ptr, *face_nodes, *face_tag; /* CSR */
} MeshRigid;

/* Nodes of a tool with free motions: one for its displacement, one for its rotation. */
enum { TOOL_NODES = 2 };

/* A rigid tool, meshed or analytic, with free components of its motion. It has two nodes, which no cell has. They are
   the last local nodes of every rank, and rank 0 owns them. The displacement of the first is that of the tool's point;
   that of the second is the rotation vector times arm, in the plane its first component alone. */
typedef struct {
  const char *name;     /* of the tool's surface, or of the pair whose master it is */
  char        path[64]; /* in the scene, such as "bodies.1.rigid" */
  Motion     *motion;
  int         body, contact; /* in the scene; the other one is -1 */
  PetscInt    node;          /* the first of its nodes */
  /* A body that is tightened as a bolt has such nodes too; the first dof is the shortening of its unloaded length. */
  const SceneBody *bolt;      /* NULL: a rigid tool */
  PetscReal        length;    /* of the bolt: extent along its axis */
  PetscReal        stiffness; /* of what keeps its length (force per length) */
  PetscReal        arm;       /* length by which rotations count as displacements */
} MeshTool;

typedef struct {
  MPI_Comm comm;
  DM       dm; /* DMPlex, see meshplex.h */
  int      dim, order;
  PetscInt n_nodes, n_owned, n_global;
  PetscInt n_free; /* free dofs that this rank owns, after MeshSetConstraints() */
  PetscInt n_body_nodes, n_body_owned,
    n_body_global;            /* nodes of cells, which come first; the others are those of pressures and tools */
  PetscBool has_pressures;    /* there are nodes for pressures, see pressurenodes.h; the same on all ranks */
  PetscInt  n_pressure_nodes; /* as many as of cells, or 0; they follow these */
  PetscBool saddle;           /* a node for pressures has an unknown, on any rank; PressureNodesConstrain() sets it */
  PetscInt *node_id;          /* 0..n_global-1 in the order of gmsh's tags, the same on any number of ranks */
  PetscInt *node_tag;         /* gmsh's tag */
  PetscInt *node_owner;       /* rank */
  PetscInt *node_owner_local; /* local number of the node on that rank */
  /* n_nodes*dim, relative to centre. In an axisymmetric mesh the first coordinate is the radius itself, because
     centre[0] is 0. */
  PetscReal *coords;
  /* Centre and diagonal of the bodies' bounding box, without rigid tools. In an axisymmetric mesh centre[0] is 0. */
  PetscReal    centre[3], size;
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
  int          n_tools;
  MeshTool    *tools;
  Partition    partition;
  char        *notes; /* on rank 0: what a converter changed and which surfaces of contact, in lines; NULL: nothing */
  /* The fields below are for the files of this folder only. */
  PetscSF    node_sf;     /* from ghost nodes to their owners' nodes, as the DM's between points */
  PetscInt  *global_dofs; /* NULL until MeshSetConstraints() */
  PetscReal *work;        /* n_nodes*dim */
} *Mesh;
