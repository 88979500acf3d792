/* Bodies that only contact holds: which they are, their motions, their springs and their names. */
#include "freebodiesimpl.h"
#include "contact/contactstep.h"
#include "kernels/elementkernel.h"

/* All springs of a body together are this part of the stiffness of the elements below one slave node. What a spring
   takes from a force that a whole contact carries is less than this part, and ten times more would still be below 1e-6.
   It is far above the round-off of a factor, some 1e-14 of the stiffness of an element. */
#define FREE_BODIES_SPRINGS 1e-8
/* A contact holds a motion if its stiffness along it is above this part of its stiffness along any. Its root is the
   slope that the faces of a coarse round surface leave to a rotation about its own axis. */
#define FREE_BODIES_HELD 1e-3
/* The same for messages. Bodies that roll are seen by a contact patch with a slope of its width over their radius. */
#define FREE_BODIES_NAMED 3e-2
/* A tied motion is held by contact if its stiffness is above this part of the largest one of its body, each the force
   over the mean motion of the whole body, with all that is elastic. Even a motion that is held weakly, by a contact a
   tenth as wide as its body, is above, and what the unevenness of meshes does to a neutral one is far below. */
#define FREE_BODIES_STIFF 1e-2
/* A tie is this part of the stiffness of the elements below one slave node. It holds motions that no load drives
   against the unevenness of meshes, and bodies that roll on it at their place. */
#define FREE_BODIES_TIE 1e-2
/* Squares of distances that differ by less than this part of the square of a body's size are equal. */
#define FREE_BODIES_EQUAL 1e-9
/* Tied motions are named with others in this unit. Its square is far below FREE_BODIES_HELD. */
#define FREE_BODIES_HIDDEN 1e-3
/* Bodies that were moved into contact touch with the terms that are open by less than this part of a face size. */
#define FREE_BODIES_TOUCH 1e-4
/* A load that acts along a motion with less than this part of its amount does so because of the unevenness of meshes.
   It is a slope, the root of FREE_BODIES_HELD. */
#define FREE_BODIES_UNEVEN 3e-2
/* A load drives a motion if its force along it is above this part of the sum of the amounts. */
#define FREE_BODIES_DRIVEN 1e-6

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
    PetscCall(FreeModesOnSurface(b->modes, side % 2 ? contact->master : contact->slave, on));
    for (PetscInt p = 0; p < b->n_pieces; p++)
      if (on[p] && (b->pieces[p].n_free || contact->stabilise == STABILISE_TRUE)) b->stabilised[p] = PETSC_TRUE;
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the free motions of the stabilised pieces. */
static PetscErrorCode ListMotions(FreeBodies b)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(RIGID_MODES * b->n_pieces, &b->owner, RIGID_MODES * b->n_pieces, &b->motion));
  for (PetscInt p = 0; p < b->n_pieces; p++) {
    for (int i = 0; i < b->pieces[p].n_free && b->stabilised[p]; i++) {
      b->owner[b->n]    = (int)p;
      b->motion[b->n++] = &b->pieces[p].free[i * RIGID_MODES];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Measures the volumes at the nodes and the faces of the slaves. */
static PetscErrorCode Measure(FreeBodies b)
{
  const Mesh mesh = b->mesh;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &b->weight));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const PetscInt first = mesh->cell_ptr[c], n = mesh->cell_ptr[c + 1] - first;
    PetscReal      X[ELEMENT_MAX_NODES * 3], volume;

    MeshCellCoordinates(mesh, c, X);
    volume = CellVolume(mesh->cell_type[c], mesh->dim, b->scene->geometry, X);
    for (PetscInt k = 0; k < n; k++) b->weight[mesh->cell_nodes[first + k]] += volume / (PetscReal)n;
  }
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
    const SceneContact *contact = &b->scene->contacts[side / 2];
    PetscReal           term;

    PetscCall(ContactPairTermStiffness(b->contact, side / 2, &term));
    PetscCall(FreeModesOnSurface(b->modes, side % 2 ? contact->master : contact->slave, on));
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
- contact - borrowed

  Output Parameter:
. out - the bodies; NULL where there are none
@*/
PetscErrorCode FreeBodiesCreate(Mesh mesh, Scene scene, Loads loads, Contact contact, FreeBodies *out)
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
  *out       = b;
  PetscCall(FreeModesCreate(mesh, scene, loads, &b->modes));
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
  PetscCall(PetscCalloc1(b->n, &b->state));
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
  PetscCall(FreeModesDestroy(&(*b)->modes));
  PetscCall(PetscFree((*b)->stabilised));
  PetscCall(PetscFree2((*b)->owner, (*b)->motion));
  PetscCall(PetscFree((*b)->weight));
  PetscCall(PetscFree((*b)->stiffness));
  PetscCall(PetscFree((*b)->cell));
  PetscCall(PetscFree((*b)->state));
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
  for (PetscInt i = 0; i < mesh->n_nodes; i++) nodes[b->piece[i]] += mesh->node_owner[i] == rank;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, nodes, (PetscMPIInt)b->n_pieces, MPIU_INT, MPI_SUM, mesh->comm));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    const PetscInt p = b->piece[i];

    if (mesh->node_owner[i] != rank || !b->stabilised[p]) continue;
    for (int d = 0; d < mesh->dim; d++)
      values[i * mesh->dim + d] = FREE_BODIES_SPRINGS * b->stiffness[p] / (PetscReal)nodes[p];
  }
  PetscCall(ContactSpringsCreate(mesh, values, like, springs));
  PetscCall(PetscFree2(nodes, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Position of a node from the centre of its piece, in units of the piece's size. */
static void PlaceInPiece(FreeBodies b, PetscInt node, const PetscReal *u, double x[3])
{
  const int        dim   = b->mesh->dim;
  const FreePiece *piece = &b->pieces[b->piece[node]];

  for (int d = 0; d < 3; d++)
    x[d] = d < dim ? (b->mesh->coords[node * dim + d] + u[node * dim + d] - piece->centre[d]) / piece->size : 0;
}

/* The displacement row[m] (length) of component d of a node under the motions first to first + m - 1 of its piece. */
static void FreeBodiesRow(FreeBodies b, PetscInt node, const PetscReal *u, int d, int first, int m, double row[])
{
  double x[3], v[3];

  PlaceInPiece(b, node, u, x);
  for (int k = 0; k < m; k++) {
    RigidVelocity(b->motion[first + k], x, v);
    row[k] = b->pieces[b->piece[node]].size * v[d];
  }
}

/* The motion of a piece by the coordinates a[n] of all. */
void FreeBodiesPieceMotion(FreeBodies b, PetscInt piece, const double a[], double q[RIGID_MODES])
{
  for (int i = 0; i < RIGID_MODES; i++) q[i] = 0;
  for (int k = 0; k < b->n; k++)
    for (int i = 0; i < RIGID_MODES && b->owner[k] == piece; i++) q[i] += a[k] * b->motion[k][i];
}

/* Says whether a motion turns its piece. */
PetscBool FreeBodiesTurns(FreeBodies b, int k)
{
  const double *q = b->motion[k];

  return (PetscBool)(q[0] != 0 || q[1] != 0 || q[2] != 0);
}

/* The velocities du[n_nodes*dim] (length) of a motion a[n] of the bodies at displacements u. */
void FreeBodiesVelocity(FreeBodies b, const PetscReal *u, const double a[], PetscReal *du)
{
  const int dim  = b->mesh->dim;
  PetscInt  last = -1;
  double    q[RIGID_MODES], x[3], v[3];

  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    if (b->piece[i] != last) FreeBodiesPieceMotion(b, b->piece[i], a, q);
    last = b->piece[i];
    PlaceInPiece(b, i, u, x);
    RigidVelocity(q, x, v);
    for (int d = 0; d < dim; d++) du[i * dim + d] = b->pieces[last].size * v[d];
  }
}

/* Moves the bodies by a[n]: adds it to the displacements u. */
void FreeBodiesMove(FreeBodies b, const double a[], PetscReal *u)
{
  const int dim  = b->mesh->dim;
  PetscInt  last = -1;
  double    q[RIGID_MODES], x[3], from[3];

  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    if (b->piece[i] != last) FreeBodiesPieceMotion(b, b->piece[i], a, q);
    last = b->piece[i];
    PlaceInPiece(b, i, u, from);
    for (int d = 0; d < 3; d++) x[d] = from[d];
    if (b->scene->kinematics == KINEMATICS_FINITE)
      RigidMove(q, x);
    else {
      RigidVelocity(q, from, x);
      for (int d = 0; d < 3; d++) x[d] += from[d];
    }
    for (int d = 0; d < dim; d++) u[i * dim + d] += b->pieces[last].size * (x[d] - from[d]);
  }
}

/* Products gram[n][n] of the motions at displacements u: mean over the volume of each piece (length^2). */
PetscErrorCode FreeBodiesGram(FreeBodies b, const PetscReal *u, double gram[])
{
  const int n = b->n;
  double   *volume;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->n_pieces, &volume));
  PetscCall(PetscArrayzero(gram, n * n));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    double x[3];

    PlaceInPiece(b, i, u, x);
    volume[b->piece[i]] += b->weight[i];
    for (int k = 0; k < n; k++) {
      double v[3], w[3];

      if (b->owner[k] != b->piece[i]) continue;
      RigidVelocity(b->motion[k], x, v);
      for (int l = 0; l < n; l++) {
        if (b->owner[l] != b->piece[i]) continue;
        RigidVelocity(b->motion[l], x, w);
        for (int d = 0; d < b->mesh->dim; d++) gram[k * n + l] += b->weight[i] * v[d] * w[d];
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, n * n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, volume, (PetscMPIInt)b->n_pieces, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  for (int k = 0; k < n; k++)
    for (int l = 0; l < n; l++) gram[k * n + l] *= PetscSqr(b->pieces[b->owner[k]].size) / volume[b->owner[k]];
  PetscCall(PetscFree(volume));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Longest velocity (length) of the nodes of each piece under the motion a[n], of all ranks. */
PetscErrorCode FreeBodiesLongest(FreeBodies b, const PetscReal *u, const double a[], PetscReal *longest)
{
  const int  dim = b->mesh->dim;
  PetscReal *v;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->mesh->n_nodes * dim, &v));
  PetscCall(PetscArrayzero(longest, b->n_pieces));
  FreeBodiesVelocity(b, u, a, v);
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(v[i * dim + d]);
    longest[b->piece[i]] = PetscMax(longest[b->piece[i]], PetscSqrtReal(square));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, longest, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPIU_MAX, b->mesh->comm));
  PetscCall(PetscFree(v));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The work force[n] of the loads at t along each motion at displacements u, and the sum of its amounts over the nodes.
   Where they nearly cancel the force is 0. */
PetscErrorCode FreeBodiesForce(FreeBodies b, const PetscReal *u, PetscReal t, double force[], double scale[])
{
  const PetscInt size = b->mesh->n_nodes * b->mesh->dim;
  PetscReal     *f, *v, square = 0;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(size, &f));
  PetscCall(PetscMalloc1(size, &v));
  PetscCall(PetscCalloc1(b->n, &a));
  PetscCall(LoadsResidual(b->loads, t, u, f, NULL, &square));
  for (int k = 0; k < b->n; k++) {
    force[k] = scale[k] = 0;
    a[k]                = 1;
    FreeBodiesVelocity(b, u, a, v);
    a[k] = 0;
    for (PetscInt i = 0; i < size; i++) {
      force[k] -= f[i] * v[i];
      scale[k] += PetscAbsReal(f[i] * v[i]);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, force, b->n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, scale, b->n, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  for (int k = 0; k < b->n; k++)
    if (PetscAbsReal(force[k]) <= FREE_BODIES_DRIVEN * scale[k]) force[k] = 0;
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(v));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Product of two motions as term i of n sees them: of their travels and, where there are four values, slides. */
static PetscReal Together(int across, PetscBool along, PetscInt n, PetscInt i, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = along ? 0 : a[i] * b[i];

  for (int d = 0; d < across - 1; d++) sum += a[n + 3 * i + d] * b[n + 3 * i + d];
  return sum;
}

/* Stiffness gram[n][n] of the terms in contact, or touching, along the motions at (u, t), over the largest diagonal
   entry. Friction counts as if nothing slipped. along: it alone counts. */
static PetscErrorCode ContactGram(FreeBodies b, const PetscReal *u, PetscReal t, PetscBool touching, PetscBool along,
                                  double gram[])
{
  const PetscInt       size   = b->mesh->n_nodes * b->mesh->dim;
  const int            n      = b->n;
  const int            across = ContactHasFriction(b->contact) ? 4 : 1; /* values of a term: travel, slide */
  PetscReal           *du, **travel, largest = 0;
  double              *a;
  PetscInt             n_terms;
  const ActiveSetTerm *terms;
  ContactStep          step;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(gram, n * n));
  PetscCall(PetscMalloc1(size, &du));
  PetscCall(PetscMalloc1(n, &travel));
  PetscCall(PetscCalloc1(n, &a));
  for (PetscInt i = 0; i < size; i++) du[i] = b->face; /* terms whose gaps are farther from zero have no part in it */
  PetscCall(ContactStepCreate(b->contact, u, du, t, t, &step));
  PetscCall(ContactStepGetTerms(step, &n_terms, &terms));
  for (int k = 0; k < n; k++) {
    a[k] = 1;
    FreeBodiesVelocity(b, u, a, du);
    a[k] = 0;
    PetscCall(PetscMalloc1(across * n_terms, &travel[k]));
    PetscCall(ContactStepTravel(step, du, t, t, travel[k]));
    if (across > 1) PetscCall(ContactStepSlide(step, du, t, t, &travel[k][n_terms]));
  }
  for (PetscInt i = 0; i < n_terms; i++) {
    if (terms[i].pressure == 0 && !(touching && terms[i].opening <= FREE_BODIES_TOUCH * b->face)) continue;
    for (int k = 0; k < n; k++)
      for (int l = 0; l < n; l++)
        gram[k * n + l] += Together(across, along, n_terms, i, travel[k], travel[l]) /
                           (b->pieces[b->owner[k]].size * b->pieces[b->owner[l]].size);
  }
  for (int k = 0; k < n; k++) largest = PetscMax(largest, gram[k * n + k]);
  for (int k = 0; k < n * n && largest > 0; k++) gram[k] /= largest;
  PetscCall(ContactStepDestroy(&step));
  for (int k = 0; k < n; k++) PetscCall(PetscFree(travel[k]));
  PetscCall(PetscFree(travel));
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds "BODY: motion; with it BODY: motion" to the text. */
static void AddMotion(FreeBodies b, const double a[], size_t size, char *text)
{
  size_t    used = strlen(text);
  PetscBool more = PETSC_FALSE;

  if (used && used < size) used += (size_t)snprintf(text + used, size - used, "; ");
  for (PetscInt p = 0; p < b->n_pieces && used < size; p++) {
    double    q[RIGID_MODES];
    char      motion[FREE_TEXT];
    PetscBool moves = PETSC_FALSE;

    FreeBodiesPieceMotion(b, p, a, q);
    for (int i = 0; i < RIGID_MODES; i++) moves = (PetscBool)(moves || PetscAbsReal(q[i]) > 1e-2);
    if (!moves) continue;
    FreeModesMotionText(b->modes, p, q, motion);
    used +=
      (size_t)snprintf(text + used, size - used, "%s'%s': %s", more ? ", with it " : "", b->pieces[p].name, motion);
    more = PETSC_TRUE;
  }
}

/* The column that row f of free[m][n] alone has. */
static int OwnColumn(int m, int n, const double free[], int f)
{
  for (int k = 0; k < n; k++) {
    int others = 0;

    for (int g = 0; g < m; g++) others += g != f && free[g * n + k] != 0;
    if (!others && free[f * n + k] == 1) return k;
  }
  return 0;
}

/* The motions of all bodies along which a contact of stiffness gram[n][n] has less than a part of it: free[m][n],
   m <= n, in a basis in which each is the only one that has its coordinate pivot[m]. That coordinate is the one that
   contact holds the least. */
static PetscErrorCode LooseMotions(FreeBodies b, const double gram[], PetscReal part, int *m, double free[],
                                   int pivot[])
{
  const int n = b->n;
  double   *work;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &work));
  PetscCall(PetscArraycpy(work, gram, n * n));
  *m = RigidFree(n, work, part, free);
  for (int f = 0; f < *m; f++) pivot[f] = OwnColumn(*m, n, free, f);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norms of the nodal loads at t, summed over each piece. */
static PetscErrorCode PieceLoads(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal *load)
{
  const int  dim = b->mesh->dim;
  PetscReal *f, square = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->mesh->n_nodes * dim, &f));
  PetscCall(PetscArrayzero(load, b->n_pieces));
  PetscCall(LoadsResidual(b->loads, t, u, f, NULL, &square));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    square = 0;
    for (int d = 0; d < dim; d++) square += PetscSqr(f[i * dim + d]);
    load[b->piece[i]] += PetscSqrtReal(square);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPI_SUM, b->mesh->comm));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Which of the motions free[m][n] at displacements u the loads at t drive: those along which they do more than a part
   of the work that they could do over the longest way of a node. */
static PetscErrorCode FindDriven(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal part, int m,
                                 const double free[], PetscBool driven[])
{
  const int  n = b->n;
  PetscReal *load, *longest;
  double    *force, *scale;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(b->n_pieces, &load, b->n_pieces, &longest, n, &force, n, &scale));
  PetscCall(PieceLoads(b, u, t, load));
  PetscCall(FreeBodiesForce(b, u, t, force, scale));
  for (int f = 0; f < m; f++) {
    double work = 0, most = 0;

    PetscCall(FreeBodiesLongest(b, u, &free[f * n], longest));
    for (int k = 0; k < n; k++) work += free[f * n + k] * force[k];
    for (PetscInt p = 0; p < b->n_pieces; p++) most += load[p] * longest[p];
    driven[f] = (PetscBool)(PetscAbsReal(work) > part * most);
  }
  PetscCall(PetscFree4(load, longest, force, scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the loads at t_loads do more than a part of the work that they could do along a motion that what
   touches at (u, t) does not hold. */
PetscErrorCode FreeBodiesFall(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscReal part,
                              PetscBool *falls)
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, m;
  PetscBool *drives;

  PetscFunctionBeginUser;
  *falls = PETSC_FALSE;
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(ContactGram(b, u, t, PETSC_TRUE, PETSC_FALSE, gram));
  PetscCall(LooseMotions(b, gram, FREE_BODIES_HELD, &m, free, pivot));
  PetscCall(FindDriven(b, u, t_loads, part, m, free, drives));
  for (int f = 0; f < m; f++) *falls = (PetscBool)(*falls || drives[f]);
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the coordinates of tied motions in units of `part`, so that a contact of stiffness gram[n][n] does not see
   them. */
static void ScaleTied(FreeBodies b, PetscReal part, double gram[])
{
  for (int k = 0; k < b->n; k++)
    for (int l = 0; l < b->n; l++)
      gram[k * b->n + l] *= (b->state[k] == MOTION_TIED ? part : 1) * (b->state[l] == MOTION_TIED ? part : 1);
}

/* Brings a motion a[n] that ScaleTied() has made loose back to the units of the others, with 1 for coordinate k. */
static void UnscaleMotion(FreeBodies b, PetscReal part, int k, double a[])
{
  const double one = b->state[k] == MOTION_TIED ? part : 1;

  for (int l = 0; l < b->n; l++) a[l] *= (b->state[l] == MOTION_TIED ? part : 1) / one;
}

/*@
  FreeBodiesLoose - names the motions of the bodies that contact does not hold in the present state.

  Collective

  Input Parameters:
+ b      - the bodies
. u      - local displacements u[n_nodes*dim] (length), within the reach of the contact's lists
. t      - load parameter
. driven - name only the motions along which the loads at t act
- size   - of the text

  Output Parameter:
. text - "'ball': translation along y, (0, 1, 0); ..."; empty: contact holds all bodies

  Note:
  A contact holds a motion if a term in contact sees it. The system is singular along the others without springs. Unless
  only those that are driven are asked for, motions that are tied are named too.
@*/
PetscErrorCode FreeBodiesLoose(FreeBodies b, const PetscReal *u, PetscReal t, PetscBool driven, size_t size, char *text)
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, m;
  PetscBool *drives;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(ContactGram(b, u, t, PETSC_FALSE, PETSC_FALSE, gram));
  if (!driven) ScaleTied(b, FREE_BODIES_HIDDEN, gram);
  PetscCall(LooseMotions(b, gram, driven ? FREE_BODIES_HELD : FREE_BODIES_NAMED, &m, free, pivot));
  for (int f = 0; f < m && !driven; f++) UnscaleMotion(b, FREE_BODIES_HIDDEN, pivot[f], &free[f * n]);
  PetscCall(FindDriven(b, u, t, FREE_BODIES_UNEVEN, m, free, drives));
  for (int f = 0; f < m; f++)
    if (driven ? drives[f] : b->state[pivot[f]] != MOTION_CONTACT) AddMotion(b, &free[f * n], size, text);
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes bodies that touch with friction at (u, t) hardly slide: gram[n][n], the products of their motions, grows by
   `factor` of its largest diagonal entry along them. */
PetscErrorCode FreeBodiesRub(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal factor, double gram[])
{
  const int n = b->n;
  double   *along, largest = 0;

  PetscFunctionBeginUser;
  if (!ContactHasFriction(b->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n * n, &along));
  PetscCall(ContactGram(b, u, t, PETSC_TRUE, PETSC_TRUE, along));
  for (int k = 0; k < n; k++) largest = PetscMax(largest, gram[k * n + k]);
  for (int k = 0; k < n * n; k++) gram[k] += factor * largest * along[k];
  PetscCall(PetscFree(along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a contact of stiffness gram[n][n] acts on a piece at all. */
static PetscBool InContact(FreeBodies b, PetscInt piece, const double gram[])
{
  PetscBool acts = PETSC_FALSE;

  for (int k = 0; k < b->n; k++) acts = (PetscBool)(acts || (b->owner[k] == piece && gram[k * b->n + k] > 0));
  return acts;
}

/* A tie that measures coordinate k of the motions at displacements u, in lengths, by the cell at the middle of its
   piece: the motion nearest to that of the cell's nodes. */
static PetscErrorCode MakeTie(FreeBodies b, const PetscReal *u, int k, SpringTie *tie)
{
  const Mesh       mesh = b->mesh;
  const PetscInt   p = b->owner[k], cell = b->cell[p];
  const FreePiece *piece = &b->pieces[p];
  const PetscInt  *dofs;
  double           gram[RIGID_MODES * RIGID_MODES] = {0}, factor[RIGID_MODES * RIGID_MODES], row[RIGID_MODES];
  int              first = k, m = piece->n_free;
  PetscMPIInt      owner = -1;

  PetscFunctionBeginUser;
  *tie = (SpringTie){.motion = k, .stiffness = FREE_BODIES_TIE * b->stiffness[p]};
  PetscCall(MeshGetGlobalDofs(mesh, &dofs));
  while (first > 0 && b->owner[first - 1] == p) first--;
  if (cell >= 0) {
    PetscCallMPI(MPI_Comm_rank(mesh->comm, &owner));
    for (PetscInt c = mesh->cell_ptr[cell]; c < mesh->cell_ptr[cell + 1]; c++)
      for (int d = 0; d < mesh->dim; d++) {
        FreeBodiesRow(b, mesh->cell_nodes[c], u, d, first, m, row);
        RigidAddRow(m, row, 1, gram);
      }
    RigidCholesky(m, gram, factor);
    for (PetscInt c = mesh->cell_ptr[cell]; c < mesh->cell_ptr[cell + 1]; c++)
      for (int d = 0; d < mesh->dim; d++) {
        const PetscInt dof = dofs[mesh->cell_nodes[c] * mesh->dim + d];

        if (dof < 0) continue;
        FreeBodiesRow(b, mesh->cell_nodes[c], u, d, first, m, row);
        RigidSolve(m, factor, row);
        tie->dof[tie->n]     = dof;
        tie->value[tie->n++] = piece->size * row[k - first];
      }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MAX, mesh->comm));
  PetscCallMPI(MPI_Bcast(&tie->n, 1, MPIU_INT, owner, mesh->comm));
  PetscCallMPI(MPI_Bcast(tie->dof, (PetscMPIInt)tie->n, MPIU_INT, owner, mesh->comm));
  PetscCallMPI(MPI_Bcast(tie->value, (PetscMPIInt)tie->n, MPIU_REAL, owner, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Drops those of the motions tied[n] that the loads at t drive though a contact of stiffness gram[n][n] does not hold
   them, and translations of pieces without any contact. */
static PetscErrorCode DropDriven(FreeBodies b, const PetscReal *u, PetscReal t, const double gram[], PetscBool tied[])
{
  const int  n = b->n;
  double    *free;
  int       *pivot, loose;
  PetscBool *drives;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * n, &free, n, &pivot, n, &drives));
  PetscCall(LooseMotions(b, gram, FREE_BODIES_HELD, &loose, free, pivot));
  PetscCall(FindDriven(b, u, t, FREE_BODIES_UNEVEN, loose, free, drives));
  for (int k = 0; k < n; k++) {
    tied[k] = (PetscBool)(tied[k] && (InContact(b, b->owner[k], gram) || FreeBodiesTurns(b, k)));
    for (int f = 0; f < loose; f++)
      if (drives[f] && free[f * n + k] != 0) tied[k] = PETSC_FALSE;
  }
  PetscCall(PetscFree3(free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the motions tied[n] those that neither they nor contact hold and no load drives at (u, t). Drops those that a
   load drives. touching: what touches holds, too. */
static PetscErrorCode FindTied(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool touching,
                               PetscBool tied[])
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, loose;
  PetscBool *drives;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(ContactHoldActiveSet(b->contact, PETSC_TRUE, touching)); /* fresh lists may have opened it a little */
  PetscCall(ContactGram(b, u, t, touching, PETSC_FALSE, gram));
  PetscCall(ContactHoldActiveSet(b->contact, PETSC_FALSE, PETSC_FALSE));
  PetscCall(DropDriven(b, u, t_loads, gram, tied));
  for (int k = 0; k < n; k++) gram[k * n + k] += tied[k] ? 1 : 0; /* the stiffness of the stiffest contact */
  PetscCall(LooseMotions(b, gram, FREE_BODIES_HELD, &loose, free, pivot));
  PetscCall(FindDriven(b, u, t_loads, FREE_BODIES_UNEVEN, loose, free, drives));
  for (int f = 0; f < loose; f++)
    if (!drives[f] && (InContact(b, b->owner[pivot[f]], gram) || FreeBodiesTurns(b, pivot[f])))
      tied[pivot[f]] = PETSC_TRUE;
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesTie - ties the motions that neither contact holds nor loads drive.

  Collective

  Input Parameters:
+ b        - the bodies
. u        - local displacements u[n_nodes*dim] (length), within the reach of the contact's lists
. t        - load parameter there
. t_loads  - load parameter at which the loads are taken
. begins   - a load step begins: what was tied in the accepted state stays tied, otherwise what is tied now
- touching - the bodies were moved into contact: what touches holds, too

  Output Parameters:
+ springs - their ties
- changed - other motions than before are tied

  Note:
  Such a motion stays as it is, without changing anything else. Without a tie the unevenness of the meshes would drive
  it, far beyond what a linear step can follow. Of a body without any contact only rotations are tied, so that a tool
  can push it before it. FreeBodiesRelease() judges whether contact has come to hold it.
@*/
PetscErrorCode FreeBodiesTie(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool begins,
                             PetscBool touching, ContactSprings springs, PetscBool *changed)
{
  int        m = 0;
  PetscBool *tied;
  SpringTie *ties;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (!b->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(b->n, &ties, b->n, &tied));
  for (int k = 0; k < b->n; k++)
    tied[k] = begins ? (PetscBool)(b->state[k] == MOTION_TIED) : ContactSpringsHaveTie(springs, k);
  PetscCall(FindTied(b, u, t, t_loads, touching, tied));
  for (int k = 0; k < b->n; k++) {
    *changed = (PetscBool)(*changed || tied[k] != ContactSpringsHaveTie(springs, k));
    if (tied[k]) PetscCall(MakeTie(b, u, k, &ties[m++]));
  }
  PetscCall(ContactSpringsSetTies(springs, m, ties));
  PetscCall(PetscFree2(ties, tied));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean motion of a piece along its coordinate k (length) under the free displacements x, at displacements u. */
static PetscErrorCode MeanMotion(FreeBodies b, const PetscReal *u, Vec x, int k, PetscReal *mean)
{
  const int  n = b->n, dim = b->mesh->dim;
  double    *gram, *a, volume = 0;
  PetscReal *z;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &gram));
  PetscCall(PetscCalloc2(n + 1, &a, b->mesh->n_nodes * dim, &z));
  PetscCall(MeshGlobalToLocal(b->mesh, x, z));
  PetscCall(FreeBodiesGram(b, u, gram));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    double place[3], v[3];

    if (b->piece[i] != b->owner[k]) continue;
    PlaceInPiece(b, i, u, place);
    volume += b->weight[i];
    for (int l = 0; l < n; l++) {
      if (b->owner[l] != b->owner[k]) continue;
      RigidVelocity(b->motion[l], place, v);
      for (int d = 0; d < dim; d++) a[l] += b->weight[i] * b->pieces[b->owner[k]].size * v[d] * z[i * dim + d];
    }
  }
  a[n] = volume;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, a, n + 1, MPI_DOUBLE, MPI_SUM, b->mesh->comm));
  volume = a[n];
  RigidCholesky(n, gram, gram);
  RigidSolve(n, gram, a);
  *mean = b->pieces[b->owner[k]].size * a[k] / volume;
  PetscCall(PetscFree2(a, z));
  PetscCall(PetscFree(gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stiffness of what holds motion k at displacements u, but for its own tie: a force along the motion over the mean
   motion of the whole body that it causes. */
static PetscErrorCode MotionStiffness(FreeBodies b, const PetscReal *u, int k, KSP ksp, ContactSprings springs,
                                      PetscReal *stiffness)
{
  SpringTie   tie;
  Vec         force, x;
  PetscScalar stretch;
  PetscReal   mean = 0;
  PetscInt    first, end;

  PetscFunctionBeginUser;
  PetscCall(MakeTie(b, u, k, &tie));
  PetscCall(ContactSpringsVector(springs, &force));
  PetscCall(VecDuplicate(force, &x));
  PetscCall(VecGetOwnershipRange(force, &first, &end));
  for (PetscInt i = 0; i < tie.n; i++)
    if (tie.dof[i] >= first && tie.dof[i] < end) PetscCall(VecSetValue(force, tie.dof[i], tie.value[i], ADD_VALUES));
  PetscCall(VecAssemblyBegin(force));
  PetscCall(VecAssemblyEnd(force));
  PetscCall(KSPSolve(ksp, force, x));
  PetscCall(VecDot(force, x, &stretch));
  PetscCall(MeanMotion(b, u, x, k, &mean));
  *stiffness = (1 - (ContactSpringsHaveTie(springs, k) ? tie.stiffness * PetscRealPart(stretch) : 0)) / mean;
  PetscCall(VecDestroy(&force));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stiffness of all motions of pieces with ties, and the largest one of each of these pieces. Where all motions of a
   piece are tied, the elements below a slave node tell how stiff a contact may be. */
static PetscErrorCode FindMotionStiffness(FreeBodies b, const PetscReal *u, KSP ksp, ContactSprings springs,
                                          PetscReal *stiffness, PetscReal *largest)
{
  PetscBool *tied, *others; /* of each piece */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(b->n_pieces, &tied, b->n_pieces, &others));
  for (int k = 0; k < b->n; k++) (ContactSpringsHaveTie(springs, k) ? tied : others)[b->owner[k]] = PETSC_TRUE;
  for (PetscInt p = 0; p < b->n_pieces; p++) largest[p] = others[p] ? 0 : b->stiffness[p];
  for (int k = 0; k < b->n; k++) {
    stiffness[k] = 0;
    if (tied[b->owner[k]]) PetscCall(MotionStiffness(b, u, k, ksp, springs, &stiffness[k]));
    largest[b->owner[k]] = PetscMax(largest[b->owner[k]], stiffness[k]);
  }
  PetscCall(PetscFree2(tied, others));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesRelease - releases the ties of motions that contact has come to hold, or along which a load acts.

  Collective

  Input Parameters:
+ b     - the bodies
. u     - local displacements u[n_nodes*dim] (length) of the solution
. scale - of the forces
- ksp   - it solves with the tangent at the solution, springs and ties included

  Input/Output Parameter:
. springs - their ties

  Output Parameter:
. any - one was released

  Note:
  Contact holds a motion if the body resists a force along it. The shape of the contact does not tell: under a round
  body the faces have a slope, but the body rolls over them, as its shape gives way everywhere alike. What is left is
  the unevenness of meshes, of either sign.
@*/
PetscErrorCode FreeBodiesRelease(FreeBodies b, const PetscReal *u, PetscReal scale, KSP ksp, ContactSprings springs,
                                 PetscBool *any)
{
  int        kept = 0, *motion;
  PetscReal *stiffness, *largest;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(b->n, &motion, b->n, &stiffness, b->n_pieces, &largest));
  PetscCall(FindMotionStiffness(b, u, ksp, springs, stiffness, largest));
  for (int k = 0; k < b->n; k++) {
    const SpringTie *tie;
    PetscReal        force = 0;

    if (!ContactSpringsHaveTie(springs, k)) continue;
    ContactSpringsGetTie(springs, k, &tie, &force);
    PetscCall(PetscInfo(NULL, "tie of motion %d: stiffness %g, of the body %g, force %g of %g\n", k,
                        (double)stiffness[k], (double)largest[b->owner[k]], (double)force, (double)scale));
    if (!(stiffness[k] > FREE_BODIES_STIFF * largest[b->owner[k]]) &&
        !(PetscAbsReal(force) > FREE_BODIES_UNEVEN * scale))
      motion[kept++] = k;
  }
  PetscCall(ContactSpringsRelease(springs, kept, motion, any));
  PetscCall(PetscFree3(motion, stiffness, largest));
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
      b->state[k] = tie->released ? MOTION_CONTACT : MOTION_TIED;
    else if (b->state[k] == MOTION_TIED)
      b->state[k] = MOTION_PLAIN;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesArchive - saves or loads what is tied in the accepted state.

  Collective

  Input Parameters:
+ b       - the bodies
- archive - decides whether it is saved or loaded
@*/
PetscErrorCode FreeBodiesArchive(FreeBodies b, Archive archive)
{
  PetscFunctionBeginUser;
  if (b->n) PetscCall(ArchiveIntegers(archive, "bodies/tied", b->n, b->state));
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
