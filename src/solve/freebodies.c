/* Bodies that only contact holds: which they are, their springs, and what of them is kept from step to step. */
#include "freebodiesimpl.h"
#include "kernels/elementkernel.h"
#include "mesh/pressurenodes.h"

/* All springs of a body together are this part of the stiffness of the elements below one slave node. What a spring
   takes from a force that a whole contact carries is less than this part, and ten times more would still be below 1e-6.
   It is far above the round-off of a factor, some 1e-14 of the stiffness of an element. */
#define FREE_BODIES_SPRINGS 1e-8
/* Squares of distances that differ by less than this part of the square of a body's size are equal. */
#define FREE_BODIES_EQUAL 1e-9

/* Finds the pieces that are stabilised: one of their pairs says auto and they have free motions, or one says true. */
static PetscErrorCode FindStabilised(FreeBodies b)
{
  int *on;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->n_pieces, &b->stabilised));
  PetscCall(PetscMalloc1(b->n_pieces, &on));
  for (int side = 0; side < 2 * b->scene->n_contacts; side++) {
    const SceneContact *contact = &b->scene->contacts[side / 2];

    if (contact->stabilise == STABILISE_FALSE) continue;
    PetscCall(FreeModesOnSide(b->modes, side / 2, (PetscBool)(side % 2), on));
    for (PetscInt p = 0; p < b->n_pieces; p++)
      if (on[p] && (b->pieces[p].n_free || contact->stabilise == STABILISE_TRUE)) b->stabilised[p] = PETSC_TRUE;
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the free motions of the stabilised pieces and says whose they are. FreeBodiesCentre() writes them. */
static PetscErrorCode ListMotions(FreeBodies b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(RIGID_MODES * b->n_pieces, &b->owner, RIGID_MODES * b->n_pieces, &b->motion));
  for (PetscInt p = 0; p < b->n_pieces; p++)
    for (int i = 0; i < b->pieces[p].n_free && b->stabilised[p]; i++) b->owner[b->n++] = (int)p;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures the volumes at the nodes and the faces of the slaves. The nodes of a tool have equal parts of it. */
static PetscErrorCode Measure(FreeBodies b)
{
  const Mesh  mesh = b->mesh;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc1(mesh->n_nodes, &b->weight));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c], n = mesh->cell_ptr[c + 1] - first;
    PetscReal      X[ELEMENT_MAX_NODES * 3], volume;

    MeshCellCoordinates(mesh, c, X);
    volume = CellVolume(mesh->cell_type[c], mesh->dim, b->scene->geometry, X);
    for (PetscInt k = 0; k < n; k++) b->weight[mesh->cell_nodes[first + k]] += volume / (PetscReal)n;
  }
  for (int k = 0; k < mesh->n_tools; k++)
    for (int i = 0; i < TOOL_NODES; i++)
      b->weight[mesh->tools[k].node + i] = mesh->node_owner[mesh->tools[k].node] == rank;
  for (int p = 0; p < ContactPairs(b->contact); p++) {
    const MeshGroup *slave;
    PetscReal        size;

    PetscCall(ContactPairSurface(b->contact, p, &slave, &size));
    b->face = PetscMax(b->face, size);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the stiffness of the elements below one slave node for each piece: that of its stiffest pair. */
static PetscErrorCode FindStiffness(FreeBodies b)
{
  int *on;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->n_pieces, &b->stiffness));
  PetscCall(PetscMalloc1(b->n_pieces, &on));
  for (int side = 0; side < 2 * b->scene->n_contacts; side++) {
    PetscReal term;

    PetscCall(ContactPairTermStiffness(b->contact, side / 2, &term));
    PetscCall(FreeModesOnSide(b->modes, side / 2, (PetscBool)(side % 2), on));
    for (PetscInt p = 0; p < b->n_pieces; p++)
      if (on[p]) b->stiffness[p] = PetscMax(b->stiffness[p], term);
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the cell at the middle of each piece, which its ties hold. The rank that has it stores its number. */
static PetscErrorCode FindCells(FreeBodies b)
{
  const Mesh mesh = b->mesh;
  PetscReal *least, *mine;
  PetscInt  *id;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n_pieces, &b->cell));
  PetscCall(PetscMalloc3(b->n_pieces, &least, mesh->n_cells, &mine, b->n_pieces, &id));
  for (PetscInt p = 0; p < b->n_pieces; p++) {
    least[p] = PETSC_MAX_REAL;
    id[p]    = PETSC_MAX_INT;
  }
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c], n = mesh->cell_ptr[c + 1] - first, p = b->piece[mesh->cell_nodes[first]];

    mine[c] = 0;
    for (int d = 0; d < mesh->dim; d++) {
      PetscReal centre = 0;

      for (PetscInt k = 0; k < n; k++) centre += mesh->coords[mesh->cell_nodes[first + k] * mesh->dim + d];
      mine[c] += PetscSqr(centre / (PetscReal)n - b->pieces[p].centre[d]);
    }
    least[p] = PetscMin(least[p], mine[c]);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, least, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPIU_MIN, mesh->comm));
  for (int give = 0; give < 2; give++) { /* of those that are equally near, the one that comes first in gmsh's file */
    for (PetscInt c = 0; c < mesh->n_cells; c++) {
      const PetscInt p = b->piece[mesh->cell_nodes[mesh->cell_ptr[c]]];

      if (mine[c] > least[p] + FREE_BODIES_EQUAL * PetscSqr(b->pieces[p].size)) continue;
      if (!give) id[p] = PetscMin(id[p], mesh->cell_id[c]);
      if (give && id[p] == mesh->cell_id[c]) b->cell[p] = c;
    }
    if (give) break;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, id, (PetscMPIInt)b->n_pieces, MPIU_INT, MPI_MIN, mesh->comm));
    for (PetscInt p = 0; p < b->n_pieces; p++) b->cell[p] = -1;
  }
  PetscCall(PetscFree3(least, mine, id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesCreate - finds the bodies that are stabilised.

  Collective

  Input Parameters:
+ mesh    - borrowed
. scene   - borrowed
. loads   - borrowed
. contact - borrowed
- modes   - borrowed

  Output Parameter:
. out - the bodies; NULL where there are none
@*/
PetscErrorCode FreeBodiesCreate(Mesh mesh, Scene scene, Loads loads, Contact contact, FreeModes modes, FreeBodies *out)
{
  FreeBodies b;
  PetscBool  asked = PETSC_FALSE, any = PETSC_FALSE;

  PetscFunctionBeginUser;
  *out = NULL;
  for (int c = 0; c < scene->n_contacts; c++)
    asked = (PetscBool)(asked || scene->contacts[c].stabilise != STABILISE_FALSE);
  if (!asked) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&b));
  b->mesh    = mesh;
  b->scene   = scene;
  b->loads   = loads;
  b->contact = contact;
  b->modes   = modes;
  *out       = b;
  PetscCall(FreeModesGetPieces(b->modes, &b->n_pieces, &b->pieces, &b->piece));
  PetscCall(FindStabilised(b));
  for (PetscInt p = 0; p < b->n_pieces; p++) any = (PetscBool)(any || b->stabilised[p]);
  if (!any) {
    PetscCall(FreeBodiesDestroy(out));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(ListMotions(b));
  PetscCall(Measure(b));
  PetscCall(FindStiffness(b));
  PetscCall(FindCells(b));
  PetscCall(PetscCalloc2(b->n, &b->state, b->n_pieces, &b->carried));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesDestroy - frees the bodies.

  Collective

  Input Parameter:
. b - the bodies; set to NULL
@*/
PetscErrorCode FreeBodiesDestroy(FreeBodies *b)
{
  PetscFunctionBeginUser;
  if (!*b) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*b)->stabilised));
  PetscCall(PetscFree2((*b)->owner, (*b)->motion));
  PetscCall(PetscFree((*b)->weight));
  PetscCall(PetscFree((*b)->stiffness));
  PetscCall(PetscFree((*b)->cell));
  PetscCall(PetscFree2((*b)->state, (*b)->carried));
  PetscCall(PetscFree(*b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesSprings - makes the springs of the bodies.

  Collective

  Input Parameters:
+ b    - the bodies
- like - a vector of the free dofs

  Output Parameter:
. springs - spread evenly over the nodes of each body

  Note:
  They make the system regular where contact does not hold a body, and are too weak to be seen where it does.
@*/
PetscErrorCode FreeBodiesSprings(FreeBodies b, Vec like, ContactSprings *springs)
{
  const Mesh  mesh = b->mesh;
  PetscReal  *values;
  PetscInt   *nodes;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc2(b->n_pieces, &nodes, mesh->n_nodes * mesh->dim, &values));
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    nodes[b->piece[i]] += mesh->node_owner[i] == rank && !IsPressureNode(mesh, i);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, nodes, (PetscMPIInt)b->n_pieces, MPIU_INT, MPI_SUM, mesh->comm));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    const PetscInt p = b->piece[i];

    if (mesh->node_owner[i] != rank || !b->stabilised[p] || IsPressureNode(mesh, i)) continue;
    for (int d = 0; d < mesh->dim; d++)
      values[i * mesh->dim + d] = FREE_BODIES_SPRINGS * b->stiffness[p] / (PetscReal)nodes[p];
  }
  PetscCall(ContactSpringsCreate(mesh, values, like, springs));
  PetscCall(PetscFree2(nodes, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesAccept - remembers what is tied in a state that becomes the accepted one.

  Not collective, the same on all ranks

  Input Parameters:
+ b       - the bodies
- springs - their ties
@*/
PetscErrorCode FreeBodiesAccept(FreeBodies b, ContactSprings springs)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < b->n; k++) {
    const SpringTie *tie;

    ContactSpringsGetTie(springs, k, &tie, NULL);
    if (tie)
      b->state[k] = tie->released ? MOTION_CONTACT : tie->unstable ? MOTION_FIRM : MOTION_TIED;
    else if (b->state[k] >= MOTION_TIED)
      b->state[k] = MOTION_PLAIN;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Saves or loads what holds each free motion. Other bodies may be free where the supports have changed: what a motion
   that is not the same one was tied by is not known then. */
static PetscErrorCode ArchiveStates(FreeBodies b, Archive archive)
{
  const int motions = b->n;
  PetscInt  n       = 2 * motions, *list;
  PetscBool there   = PETSC_TRUE, same;

  PetscFunctionBeginUser;
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "bodies/tied", &there));
  if (!there) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ArchiveLoads(archive)) PetscCall(PetscMalloc1(n, &list));
  for (int k = 0; k < motions && !ArchiveLoads(archive); k++) {
    list[2 * k]     = b->owner[k];
    list[2 * k + 1] = b->state[k];
  }
  PetscCall(ArchiveIntegerList(archive, "bodies/tied", &n, &list));
  same = (PetscBool)(n == 2 * motions);
  for (int k = 0; k < motions && same; k++) same = (PetscBool)(list[2 * k] == b->owner[k]);
  for (int k = 0; k < motions && same; k++) b->state[k] = list[2 * k + 1];
  PetscCall(PetscFree(list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesArchive - saves or loads what is tied in the accepted state, and what FreeBodiesMoved() says.

  Collective

  Input Parameters:
+ b       - the bodies
- archive - decides whether it is saved or loaded
@*/
PetscErrorCode FreeBodiesArchive(FreeBodies b, Archive archive)
{
  PetscBool there = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (b->n) PetscCall(ArchiveStates(b, archive));
  if (ArchiveRenumbers(archive) && ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, "bodies/moved", &there));
  if (there) PetscCall(ArchiveString(archive, "bodies/moved", sizeof(b->moved), b->moved));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesMoved - says which bodies the rigid search has moved, and by how much; empty: none.

  Not collective

  Input Parameter:
. b - the bodies; NULL: none
@*/
const char *FreeBodiesMoved(FreeBodies b)
{
  return b ? b->moved : "";
}
