/* Rigid motions that a scene leaves its bodies, see freemodes.h. */
#include "bodies/freemodes.h"
#include "bodies/tools.h"
#include "kernels/elementkernel.h"
#include "mesh/meshpieces.h"
#include "mesh/pressurenodes.h"
#include "base/refusal.h"

/* Supports hold a rotation if their lever arm is more than a millionth of the body's size; this is the square of it.
   Round-off is some 1e-16 times the number of supports. */
#define FREE_SUPPORT 1e-12
/* A contact pair holds a motion if the normal part of the motion, root mean square over the surface, is above this
   part of the motion. Less is the slope that the facets of a coarse round surface leave to a rotation about its own
   axis. */
#define FREE_CONTACT 3e-3
/* Directions nearer than this to a coordinate axis get the axis's name, and screw motions of less pitch are called
   rotations: FREE_CONTACT leaves such differences uncertain. */
#define FREE_ALIGNED 1e-2

/* With more connected pieces than this their joint motions are not looked for: the elimination has 6 times as many
   unknowns, and no screen could show the result. */
enum { FREE_PIECES = 100 };

/* Characters of a message with several motions. */
enum { FREE_MESSAGE = 1400 };

struct _n_FreeModes {
  Mesh       mesh;
  Scene      scene;
  PetscInt  *piece; /* of every local node */
  PetscInt   n_pieces;
  FreePiece *pieces;
  double *gram; /* n_contacts matrices of (6 n_pieces)^2: mean square of the normal motion over each pair's surface */
  int     n_loose; /* motions of all pieces (rows of 6 n_pieces) that neither supports nor contact hold */
  double *loose;
};

/* Measures the bounding box of each piece: the same numbers on any number of ranks. */
static PetscErrorCode MeasurePieces(FreeModes modes)
{
  Mesh       mesh = modes->mesh;
  PetscReal *box;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(6 * modes->n_pieces, &box)); /* -lowest, highest */
  for (PetscInt i = 0; i < 6 * modes->n_pieces; i++) box[i] = PETSC_MIN_REAL;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    for (int d = 0; d < mesh->dim; d++) {
      const PetscReal X     = mesh->coords[n * mesh->dim + d];
      PetscReal      *range = &box[6 * modes->piece[n] + 2 * d];

      range[0] = PetscMax(range[0], -X);
      range[1] = PetscMax(range[1], X);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, box, (PetscMPIInt)(6 * modes->n_pieces), MPIU_REAL, MPIU_MAX, mesh->comm));
  for (PetscInt p = 0; p < modes->n_pieces; p++) {
    FreePiece *piece  = &modes->pieces[p];
    PetscReal  square = 0;

    for (int d = 0; d < mesh->dim; d++) {
      piece->centre[d] = (box[6 * p + 2 * d + 1] - box[6 * p + 2 * d]) / 2;
      square += PetscSqr(box[6 * p + 2 * d + 1] + box[6 * p + 2 * d]);
    }
    piece->size = PetscSqrtReal(square) / 2;
  }
  for (int k = 0; k < mesh->n_tools; k++) {
    FreePiece *piece = &modes->pieces[modes->piece[mesh->tools[k].node]];

    piece->tool = &mesh->tools[k];
    piece->size = mesh->tools[k].arm;
  }
  PetscCall(PetscFree(box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Names the pieces: "pipe"; "pipe + plate" where they share nodes; "pipe (its part with node 17)" where a body is
   several pieces. */
static PetscErrorCode NamePieces(FreeModes modes)
{
  Mesh      mesh  = modes->mesh;
  Scene     scene = modes->scene;
  PetscInt *has, *tag;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(modes->n_pieces * scene->n_bodies, &has));
  PetscCall(PetscMalloc1(modes->n_pieces, &tag));
  for (PetscInt p = 0; p < modes->n_pieces; p++) tag[p] = PETSC_MAX_INT;
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    has[modes->piece[mesh->cell_nodes[mesh->cell_ptr[c]]] * scene->n_bodies + mesh->cell_body[c]] = 1;
  for (PetscInt n = 0; n < mesh->n_nodes; n++) tag[modes->piece[n]] = PetscMin(tag[modes->piece[n]], mesh->node_tag[n]);
  PetscCallMPI(
    MPI_Allreduce(MPI_IN_PLACE, has, (PetscMPIInt)(modes->n_pieces * scene->n_bodies), MPIU_INT, MPI_MAX, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, tag, (PetscMPIInt)modes->n_pieces, MPIU_INT, MPI_MIN, mesh->comm));
  for (PetscInt p = 0; p < modes->n_pieces; p++) {
    FreePiece *piece = &modes->pieces[p];
    size_t     used  = 0;
    PetscBool  split = PETSC_FALSE;

    for (int b = 0; b < scene->n_bodies; b++) {
      if (!has[p * scene->n_bodies + b]) continue;
      piece->body = b;
      for (PetscInt q = 0; q < modes->n_pieces; q++)
        if (q != p && has[q * scene->n_bodies + b]) split = PETSC_TRUE;
      if (used < FREE_TEXT)
        used +=
          (size_t)snprintf(piece->name + used, FREE_TEXT - used, "%s%s", used ? " + " : "", scene->bodies[b].name);
    }
    if (piece->tool) {
      PetscCall(PetscStrncpy(piece->name, piece->tool->name, FREE_TEXT));
      piece->body = PetscMax(piece->tool->body, 0);
    }
    if (split && used < FREE_TEXT)
      snprintf(piece->name + used, FREE_TEXT - used, " (its part with node %" PetscInt_FMT ")", tag[p]);
  }
  PetscCall(PetscFree(has));
  PetscCall(PetscFree(tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks motions that the geometry does not have as held. */
static void HoldImpossible(Geometry geometry, double gram[])
{
  static const int possible[][RIGID_MODES] = {[GEOMETRY_SOLID]        = {1, 1, 1, 1, 1, 1},
                                              [GEOMETRY_PLANE_STRAIN] = {0, 0, 1, 1, 1, 0},
                                              [GEOMETRY_AXISYMMETRIC] = {0, 0, 0, 0, 1, 0}};

  for (int i = 0; i < RIGID_MODES; i++)
    if (!possible[geometry][i]) gram[i * RIGID_MODES + i] += 1;
}

/* Gives the order of the columns of all pieces. Rotations come first, so that a motion that needs no rotation is
   described by translations. */
static PetscErrorCode ColumnOrder(PetscInt n_pieces, int columns[])
{
  int c = 0;

  PetscFunctionBeginUser;
  for (int part = 0; part < 2; part++)
    for (PetscInt p = 0; p < n_pieces; p++)
      for (int d = 0; d < 3; d++) columns[c++] = (int)(RIGID_MODES * p) + 3 * part + d;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the coordinates of a point from the centre of a piece, in units of the piece's size. */
static void PlaceInPiece(const FreePiece *piece, int dim, const PetscReal *X, double x[3])
{
  for (int d = 0; d < 3; d++) x[d] = d < dim ? (X[d] - piece->centre[d]) / piece->size : 0;
}

/* Finds the motions that supports, their springs and imposed displacements leave to each piece. */
static PetscErrorCode FindSupported(FreeModes modes, Loads loads)
{
  Mesh        mesh = modes->mesh;
  const int   dim = mesh->dim, square = RIGID_MODES * RIGID_MODES;
  int         columns[RIGID_MODES];
  double     *gram;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc1(modes->n_pieces * square, &gram));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    const PetscInt p = modes->piece[n];
    double         x[3], row[RIGID_MODES];

    if (mesh->node_owner[n] != rank || modes->pieces[p].tool || IsPressureNode(mesh, n)) continue;
    PlaceInPiece(&modes->pieces[p], dim, &mesh->coords[n * dim], x);
    for (int d = 0; d < dim; d++) {
      if (!LoadsHeld(loads, n * dim + d)) continue;
      RigidRow(x, (const double[3]){d == 0, d == 1, d == 2}, row);
      RigidAddRow(RIGID_MODES, row, 1, &gram[p * square]);
    }
  }
  PetscCallMPI(
    MPI_Allreduce(MPI_IN_PLACE, gram, (PetscMPIInt)(modes->n_pieces * square), MPI_DOUBLE, MPI_SUM, mesh->comm));
  for (PetscInt p = 0; p < modes->n_pieces; p++)
    for (int c = 0; c < MOTION_COMPONENTS && modes->pieces[p].tool; c++)
      if (modes->pieces[p].tool->bolt || !modes->pieces[p].tool->motion->free[c])
        gram[p * square + (c + 3) % 6 * (RIGID_MODES + 1)] = 1;
  PetscCall(ColumnOrder(1, columns));
  for (PetscInt p = 0; p < modes->n_pieces; p++) {
    HoldImpossible(modes->scene->geometry, &gram[p * square]);
    modes->pieces[p].n_free = RigidFree(RIGID_MODES, &gram[p * square], FREE_SUPPORT, modes->pieces[p].free);
    RigidReduce(modes->pieces[p].n_free, RIGID_MODES, columns, modes->pieces[p].free);
  }
  PetscCall(PetscFree(gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesOnSide - marks the pieces that a side of a contact pair is part of.

  Collective

  Input Parameters:
+ modes   - the motions
. contact - number of the pair in the scene
- master  - its master's side

  Output Parameter:
. on - on[pieces]: 1 or 0; a tool without free motions is part of none
@*/
PetscErrorCode FreeModesOnSide(FreeModes modes, int contact, PetscBool master, int on[])
{
  const SceneContact *pair = &modes->scene->contacts[contact];
  const char         *name = master ? pair->master : pair->slave;
  const int           g    = name ? MeshFindGroup(modes->mesh, modes->mesh->dim - 1, name) : -1;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(on, modes->n_pieces));
  if (g >= 0 && modes->mesh->groups[g].attached)
    for (PetscInt i = 0; i < modes->mesh->groups[g].n_nodes; i++) on[modes->piece[modes->mesh->groups[g].nodes[i]]] = 1;
  for (PetscInt p = 0; p < modes->n_pieces; p++)
    if (master && modes->pieces[p].tool && modes->pieces[p].tool == ToolOfPair(modes->mesh, modes->scene, contact))
      on[p] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, on, (PetscMPIInt)modes->n_pieces, MPI_INT, MPI_MAX, modes->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesNodeVelocity - computes how a rigid motion of a piece moves one of its nodes.

  Not collective

  Input Parameters:
+ mesh   - the mesh
. piece  - the piece
. node   - local node
. u      - local displacements u[n_nodes*dim] (length)
- motion - the motion

  Output Parameter:
. v - velocity of the node's dofs, in units of the piece's size; the second node of a tool carries its rotation
@*/
void FreeModesNodeVelocity(Mesh mesh, const FreePiece *piece, PetscInt node, const PetscReal *u,
                           const double motion[RIGID_MODES], double v[3])
{
  double x[3];

  for (int d = 0; d < 3; d++)
    x[d] = d < mesh->dim
             ? (mesh->coords[node * mesh->dim + d] + u[node * mesh->dim + d] - piece->centre[d]) / piece->size
             : 0;
  RigidVelocity(motion, x, v);
  if (!piece->tool || node == piece->tool->node) return;
  v[0] = mesh->dim == 3 ? motion[0] : motion[2];
  v[1] = mesh->dim == 3 ? motion[1] : 0;
  v[2] = mesh->dim == 3 ? motion[2] : 0;
}

/* Marks the pieces that some contact pair knows. */
static PetscErrorCode MarkPaired(FreeModes modes)
{
  int *on;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(modes->n_pieces, &on));
  for (int side = 0; side < 2 * modes->scene->n_contacts; side++) {
    PetscCall(FreeModesOnSide(modes, side / 2, (PetscBool)(side % 2), on));
    for (PetscInt p = 0; p < modes->n_pieces; p++)
      if (on[p]) modes->pieces[p].paired = PETSC_TRUE;
  }
  PetscCall(PetscFree(on));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives centre, unit normal and area (the return value) of a face in the reference configuration. */
static double FacePlace(Mesh mesh, const MeshGroup *group, PetscInt f, PetscReal centre[3], double normal[3],
                        PetscInt *node)
{
  PetscInt          nodes[FACE_MAX_NODES];
  const ElementType type    = MeshFaceNodes(mesh, group, f, nodes);
  const int         corners = ElementGet(type)->corners;
  double            X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0}, normals[FACE_MAX_NODES * 3] = {0}, size;

  MeshGatherNodes(mesh, ElementGet(type)->nodes, nodes, mesh->coords, X);
  FaceAreaKernel(type, mesh->dim, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, X, area, normals);
  for (int d = 0; d < 3; d++) centre[d] = normal[d] = 0;
  for (int a = 0; a < ElementGet(type)->nodes; a++)
    for (int d = 0; d < mesh->dim; d++) normal[d] += normals[a * mesh->dim + d];
  for (int a = 0; a < corners; a++)
    for (int d = 0; d < mesh->dim; d++) centre[d] += X[a * mesh->dim + d] / corners;
  size = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  for (int d = 0; d < 3; d++) normal[d] /= size;
  *node = nodes[0];
  return size;
}

/* Adds the square of the motion along a direction between slave and master at a face. m: piece of the master; -1: it
   moves by itself. row[n] is work space. */
static PetscErrorCode AddBetween(FreeModes modes, PetscInt slave, PetscInt m, const PetscReal centre[3],
                                 const double direction[3], double weight, double row[], double gram[])
{
  const int n = RIGID_MODES * (int)modes->n_pieces, dim = modes->mesh->dim;
  double    across[RIGID_MODES], x[3];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(row, n));
  PlaceInPiece(&modes->pieces[slave], dim, centre, x);
  RigidRow(x, direction, &row[RIGID_MODES * slave]);
  if (m >= 0) {
    PlaceInPiece(&modes->pieces[m], dim, centre, x);
    RigidRow(x, direction, across);
    for (int i = 0; i < RIGID_MODES; i++) row[RIGID_MODES * m + i] -= across[i];
  }
  RigidAddRow(n, row, weight, gram);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds up the mean square of the motion between slave and master over the slave's faces: that along the normal or, with
   friction, that along all axes. All pieces that the master surface lies on count as masters, because it is not known
   before where the surfaces meet. Gaps are assumed to be small against the bodies. */
static PetscErrorCode MeasurePair(FreeModes modes, int c, double gram[])
{
  Mesh                mesh    = modes->mesh;
  const SceneContact *contact = &modes->scene->contacts[c];
  const int           n       = RIGID_MODES * (int)modes->n_pieces;
  const MeshGroup    *slave   = &mesh->groups[MeshFindGroup(mesh, mesh->dim - 1, contact->slave)];
  const PetscBool     rubs    = (PetscBool)contact->friction;
  double             *row, area = 0;
  int                *on_slave, *on_master, deformable = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &row, modes->n_pieces, &on_slave, modes->n_pieces, &on_master));
  PetscCall(FreeModesOnSide(modes, c, PETSC_FALSE, on_slave));
  PetscCall(FreeModesOnSide(modes, c, PETSC_TRUE, on_master));
  for (PetscInt p = 0; p < modes->n_pieces; p++) deformable += on_master[p];
  for (PetscInt f = 0; f < slave->n_faces; f++) {
    PetscReal    centre[3];
    double       normal[3];
    PetscInt     node;
    const double size = FacePlace(mesh, slave, f, centre, normal, &node);

    area += size;
    for (PetscInt m = deformable ? 0 : -1; m < (deformable ? modes->n_pieces : 0); m++) {
      if (m >= 0 && !on_master[m]) continue;
      for (int d = 0; d < (rubs ? mesh->dim : 1); d++) {
        const double axis[3] = {d == 0, d == 1, d == 2};

        PetscCall(AddBetween(modes, modes->piece[node], m, centre, rubs ? axis : normal, size, row, gram));
      }
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &area, 1, MPI_DOUBLE, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, gram, n * n, MPI_DOUBLE, MPI_SUM, mesh->comm));
  for (int i = 0; i < n * n; i++) gram[i] /= area;
  PetscCall(PetscFree3(row, on_slave, on_master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns a^T gram b. */
static double VectorProduct(int n, const double gram[], const double a[], const double b[])
{
  double sum = 0;

  for (int i = 0; i < n; i++) {
    if (a[i] == 0) continue;
    for (int j = 0; j < n; j++) sum += a[i] * gram[i * n + j] * b[j];
  }
  return sum;
}

/* Writes a motion of one piece as a motion of all pieces. */
static void Embed(FreeModes modes, PetscInt p, int mode, double all[])
{
  for (int i = 0; i < RIGID_MODES * modes->n_pieces; i++) all[i] = 0;
  for (int i = 0; i < RIGID_MODES; i++) all[RIGID_MODES * p + i] = modes->pieces[p].free[mode * RIGID_MODES + i];
}

/* Finds which of the motions that supports leave, of all pieces together, no pair holds either. */
static PetscErrorCode FindLoose(FreeModes modes)
{
  const int n = RIGID_MODES * (int)modes->n_pieces;
  int       k = 0, *columns;
  double   *rows, *small, *free;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < modes->n_pieces; p++) k += modes->pieces[p].n_free;
  PetscCall(PetscMalloc4(k * n, &rows, k * k, &small, k * k, &free, n, &columns));
  k = 0;
  for (PetscInt p = 0; p < modes->n_pieces; p++)
    for (int i = 0; i < modes->pieces[p].n_free; i++) Embed(modes, p, i, &rows[n * k++]);
  PetscCall(PetscArrayzero(small, k * k));
  for (int c = 0; c < modes->scene->n_contacts; c++)
    for (int i = 0; i < k; i++)
      for (int j = 0; j < k; j++)
        small[i * k + j] += VectorProduct(n, &modes->gram[c * n * n], &rows[i * n], &rows[j * n]);
  modes->n_loose = RigidFree(k, small, PetscSqr(FREE_CONTACT), free);
  PetscCall(PetscCalloc1(modes->n_loose * n, &modes->loose));
  for (int l = 0; l < modes->n_loose; l++)
    for (int i = 0; i < k; i++)
      for (int j = 0; j < n; j++) modes->loose[l * n + j] += free[l * k + i] * rows[i * n + j];
  PetscCall(ColumnOrder(modes->n_pieces, columns));
  RigidReduce(modes->n_loose, n, columns, modes->loose);
  PetscCall(PetscFree4(rows, small, free, columns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesCreate - finds the rigid motions that supports leave to every connected piece of the mesh, and those that
  contact does not hold either.

  Collective

  Input Parameters:
+ mesh  - with its groups
. scene - each of its contact pairs, if it were closed all over, would hold what moves along the normals of its
          surfaces and, with friction, along them too
- loads - which displacements are prescribed (supports, imposed displacements, the axis of an axisymmetric scene)

  Output Parameter:
. out - free it with FreeModesDestroy()

  Note:
  A rigid motion is free if no prescribed component of any node sees it: it is in the null space of the constraints on
  6 motions (3 in plane strain, 1 axisymmetric). With more than FREE_PIECES pieces contact is not looked at.
@*/
PetscErrorCode FreeModesCreate(Mesh mesh, Scene scene, Loads loads, FreeModes *out)
{
  FreeModes modes;
  size_t    square;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&modes));
  modes->mesh  = mesh;
  modes->scene = scene;
  PetscCall(PetscMalloc1(mesh->n_nodes, &modes->piece));
  PetscCall(MeshFindPieces(mesh, &modes->n_pieces, modes->piece));
  PetscCall(PetscCalloc1(modes->n_pieces, &modes->pieces));
  PetscCall(MeasurePieces(modes));
  PetscCall(NamePieces(modes));
  PetscCall(FindSupported(modes, loads));
  PetscCall(MarkPaired(modes));
  *out = modes;
  if (modes->n_pieces > FREE_PIECES) PetscFunctionReturn(PETSC_SUCCESS);
  square = (size_t)PetscSqr(RIGID_MODES * modes->n_pieces);
  PetscCall(PetscCalloc1(scene->n_contacts * square, &modes->gram));
  for (int c = 0; c < scene->n_contacts; c++) PetscCall(MeasurePair(modes, c, &modes->gram[c * square]));
  PetscCall(FindLoose(modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesDestroy - frees the motions that were found.

  Not collective

  Input Parameter:
. modes - set to NULL
@*/
PetscErrorCode FreeModesDestroy(FreeModes *modes)
{
  PetscFunctionBeginUser;
  if (!*modes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*modes)->piece));
  PetscCall(PetscFree((*modes)->pieces));
  PetscCall(PetscFree((*modes)->gram));
  PetscCall(PetscFree((*modes)->loose));
  PetscCall(PetscFree(*modes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double VectorLength(const double v[3])
{
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Replaces a component by 0 where it is below its own uncertainty. */
static double RoundToZero(double value, double scale)
{
  return fabs(value) <= 1e-6 * scale ? 0 : value;
}

/* Writes dim components of a vector, times a factor, as "(0, 1, 0)". */
static void VectorText(int dim, const double v[3], double factor, double scale, char text[FREE_TEXT])
{
  snprintf(text, FREE_TEXT, dim == 3 ? "(%.4g, %.4g, %.4g)" : "(%.4g, %.4g)", RoundToZero(factor * v[0], scale),
           RoundToZero(factor * v[1], scale), RoundToZero(factor * v[2], scale));
}

/* Writes a direction as "y, (0, 1, 0)", or the vector alone where it is along no axis. It points to the positive side.
 */
static void DirectionText(int dim, const double v[3], char text[FREE_TEXT])
{
  const double length = VectorLength(v);
  double       unit[3];
  char         vector[FREE_TEXT];
  int          axis = -1, largest = 0;

  for (int d = 1; d < 3; d++)
    if (fabs(v[d]) > fabs(v[largest])) largest = d;
  for (int d = 0; d < 3; d++) unit[d] = v[d] / (v[largest] < 0 ? -length : length);
  if (1 - unit[largest] <= FREE_ALIGNED * FREE_ALIGNED / 2) axis = largest;
  for (int d = 0; d < 3 && axis >= 0; d++) unit[d] = d == axis;
  VectorText(dim, unit, 1, 1, vector);
  if (axis >= 0)
    snprintf(text, FREE_TEXT, "%c, %.*s", "xyz"[axis], FREE_TEXT - 8, vector);
  else
    snprintf(text, FREE_TEXT, "%.*s", FREE_TEXT - 8, vector);
}

/* Writes the motion of a piece as "translation along y, (0, 1, 0)" or "rotation about z, (0, 0, 1), through (10, 0,
   5)". */
static void MotionText(FreeModes modes, const FreePiece *piece, const double motion[RIGID_MODES], char text[FREE_TEXT])
{
  const double *rotation = motion, *translation = motion + 3, square = PetscSqr(VectorLength(rotation));
  const int     dim = modes->mesh->dim;
  double        point[3], pitch;
  char          direction[FREE_TEXT], place[FREE_TEXT];

  if (VectorLength(rotation) <= FREE_ALIGNED * VectorLength(translation)) {
    DirectionText(dim, translation, direction);
    snprintf(text, FREE_TEXT, "translation along %.*s", FREE_TEXT / 2, direction);
    return;
  }
  for (int d = 0; d < 3; d++) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;

    point[d] = piece->centre[d] + modes->mesh->centre[d] +
               piece->size * (rotation[e] * translation[f] - rotation[f] * translation[e]) / square;
  }
  pitch = (rotation[0] * translation[0] + rotation[1] * translation[1] + rotation[2] * translation[2]) / square;
  VectorText(dim, point, 1, modes->mesh->size, place);
  DirectionText(3, rotation, direction);
  if (dim == 2)
    snprintf(text, FREE_TEXT, "rotation in the plane about %.*s", FREE_TEXT / 2, place);
  else
    snprintf(text, FREE_TEXT, "%s about %.*s, through %.*s", fabs(pitch) > FREE_ALIGNED ? "screw motion" : "rotation",
             FREE_TEXT / 4, direction, FREE_TEXT / 4, place);
}

/* Length of the name of a pair, without what the program has added to the name of a list of surfaces. */
static int ListedNameLength(const SceneContact *contact)
{
  return (int)(contact->listed ? strcspn(contact->name, ".") : strlen(contact->name));
}

/* Lists the pairs that would hold a motion if they were closed, as "crown, sole"; empty where there is none. All pairs
   of a list of surfaces stand there once, by the name of the list. */
static void PairsText(FreeModes modes, PetscInt p, int mode, char text[FREE_TEXT])
{
  const int   n = RIGID_MODES * (int)modes->n_pieces;
  double      motion[n];
  size_t      used = 0;
  const char *last = NULL;
  int         same = 0;

  Embed(modes, p, mode, motion);
  text[0] = '\0';
  for (int c = 0; c < modes->scene->n_contacts && used < FREE_TEXT; c++) {
    const SceneContact *contact = &modes->scene->contacts[c];
    const int           length  = ListedNameLength(contact);

    if (!(VectorProduct(n, &modes->gram[c * n * n], motion, motion) > PetscSqr(FREE_CONTACT))) continue;
    if (last && length == same && !strncmp(last, contact->name, (size_t)length)) continue;
    used += (size_t)snprintf(text + used, FREE_TEXT - used, "%s%.*s", used ? ", " : "", length, contact->name);
    last = contact->name;
    same = length;
  }
}

/* Tells whether a loose motion moves a piece. */
static PetscBool Moves(FreeModes modes, int loose, PetscInt p)
{
  return VectorLength(&modes->loose[(loose * modes->n_pieces + p) * RIGID_MODES]) > FREE_ALIGNED ||
             VectorLength(&modes->loose[(loose * modes->n_pieces + p) * RIGID_MODES + 3]) > FREE_ALIGNED
           ? PETSC_TRUE
           : PETSC_FALSE;
}

/* Writes a motion that nothing holds as "upper: translation along y, (0, 1); with it lower: ..." and tells whether one
   of its pieces is in a contact pair. */
static void LooseText(FreeModes modes, int loose, char text[FREE_MESSAGE], PetscBool *paired)
{
  size_t used = 0;

  *paired = PETSC_FALSE;
  for (PetscInt p = 0; p < modes->n_pieces && used < FREE_MESSAGE; p++) {
    char motion[FREE_TEXT];

    if (!Moves(modes, loose, p)) continue;
    MotionText(modes, &modes->pieces[p], &modes->loose[(loose * modes->n_pieces + p) * RIGID_MODES], motion);
    used += (size_t)snprintf(text + used, FREE_MESSAGE - used, "%s%s: %s", used ? "; with it " : "",
                             modes->pieces[p].name, motion);
    if (modes->pieces[p].paired) *paired = PETSC_TRUE;
  }
}

static void PrintHeld(FreeModes modes, FILE *stream)
{
  int n = 0;

  for (PetscInt p = 0; p < modes->n_pieces; p++) {
    if (modes->pieces[p].n_free) continue;
    fprintf(stream, "%s%s", n ? ", " : "motion   held by supports and imposed displacements: ", modes->pieces[p].name);
    n++;
  }
  if (n) fprintf(stream, "\n");
}

/*@
  FreeModesReport - prints what holds each body, in lines of the first screen.

  Collective

  Input Parameters:
+ modes  - the motions
. held   - also print a line that names the bodies that supports hold
- stream - of rank 0, which prints

  Note:
  There is one line for each motion, by body and direction: held by contact only, or by nothing.
@*/
PetscErrorCode FreeModesReport(FreeModes modes, PetscBool held, FILE *stream)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(modes->mesh->comm, &rank));
  if (rank) PetscFunctionReturn(PETSC_SUCCESS);
  if (modes->n_pieces > FREE_PIECES) {
    fprintf(stream, "motion   %" PetscInt_FMT " connected pieces, too many to say what holds each\n", modes->n_pieces);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (held) PrintHeld(modes, stream);
  for (PetscInt p = 0; p < modes->n_pieces; p++) {
    for (int i = 0; i < modes->pieces[p].n_free; i++) {
      char motion[FREE_TEXT], pairs[FREE_TEXT];

      PairsText(modes, p, i, pairs);
      if (!pairs[0]) continue;
      MotionText(modes, &modes->pieces[p], &modes->pieces[p].free[i * RIGID_MODES], motion);
      fprintf(stream, "motion   %s: %s: held by contact only (%s)\n", modes->pieces[p].name, motion, pairs);
    }
  }
  for (int l = 0; l < modes->n_loose; l++) {
    char      text[FREE_MESSAGE];
    PetscBool paired;

    LooseText(modes, l, text, &paired);
    fprintf(stream, "motion   %s: NOTHING holds it, %s\n", text,
            paired ? "contact does not act that way" : "and no contact pair knows the body");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesRefuse - refuses a scene in which a body that is in no contact pair can move.

  Collective

  Input Parameters:
+ modes - the motions
- step  - name of the step whose supports they are, for the message; NULL: supports hold all the time

  Note:
  Nothing could make the system of such a body regular. The message names the body and all of its free motions.
@*/
PetscErrorCode FreeModesRefuse(FreeModes modes, const char *step)
{
  char   message[FREE_MESSAGE] = "", during[FREE_TEXT] = "";
  size_t used = 0;
  int    body = -1;

  PetscFunctionBeginUser;
  if (step) PetscCall(PetscSNPrintf(during, sizeof(during), "in step '%s' ", step));
  for (PetscInt p = 0; p < modes->n_pieces && body < 0; p++) {
    const FreePiece *piece = &modes->pieces[p];

    if (piece->paired || !piece->n_free || piece->tool) continue;
    body = piece->body;
    for (int i = 0; i < piece->n_free && used < FREE_MESSAGE; i++) {
      char motion[FREE_TEXT];

      MotionText(modes, piece, &piece->free[i * RIGID_MODES], motion);
      if (!i) used += (size_t)snprintf(message, FREE_MESSAGE, "body '%s' is free to move: ", piece->name);
      used += (size_t)snprintf(message + used, FREE_MESSAGE - used, "%s%s", i ? "; " : "", motion);
    }
  }
  for (PetscInt p = 0; p < modes->n_pieces; p++)
    if (modes->pieces[p].tool && modes->pieces[p].n_free && !modes->pieces[p].paired)
      PetscCall(
        RefuseInput(modes->mesh->comm,
                    "%s: the tool '%s' is free to move, but no contact pair knows it; allowed: a free tool that "
                    "is the master of a pair",
                    SceneWhere(modes->scene, modes->pieces[p].tool->path, "free"), modes->pieces[p].name));
  if (body >= 0)
    PetscCall(RefuseInput(modes->mesh->comm,
                          "%s: %s%s; no support, imposed displacement or contact pair holds it; allowed: bodies that "
                          "something holds in every direction",
                          SceneWhere(modes->scene, modes->scene->bodies[body].path, "volume"), during, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesGetPieces - shows the connected pieces of the mesh with the motions that supports leave to each.

  Not collective

  Input Parameter:
. modes - the motions

  Output Parameters:
+ n      - number of pieces
. pieces - the pieces, the same on all ranks; they belong to the object
- piece  - number of the piece of each local node; belongs to the object
@*/
PetscErrorCode FreeModesGetPieces(FreeModes modes, PetscInt *n, const FreePiece **pieces, const PetscInt **piece)
{
  PetscFunctionBeginUser;
  *n      = modes->n_pieces;
  *pieces = modes->pieces;
  *piece  = modes->piece;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeModesAny - tells whether supports leave some piece a motion.

  Not collective, the same on all ranks

  Input Parameter:
. modes - the motions
@*/
PetscBool FreeModesAny(FreeModes modes)
{
  for (PetscInt p = 0; p < modes->n_pieces; p++)
    if (modes->pieces[p].n_free) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  FreeModesMotionText - writes a motion of a piece in words.

  Not collective

  Input Parameters:
+ modes  - the motions
. piece  - number of the piece
- motion - the motion

  Output Parameter:
. text - "translation along y, (0, 1, 0)" or "rotation about z, (0, 0, 1), through (10, 0, 5)"
@*/
void FreeModesMotionText(FreeModes modes, PetscInt piece, const double motion[RIGID_MODES], char text[FREE_TEXT])
{
  MotionText(modes, &modes->pieces[piece], motion, text);
}

/*@
  FreeModesUnheld - names the deformable bodies none of whose displacements is prescribed or on a spring.

  Collective

  Input Parameters:
+ mesh  - the mesh
. scene - the scene
. loads - the loads and supports
- size  - room of the text in characters

  Output Parameter:
. text - "'ring', 'shaft'", or empty

  Note:
  A body that is held in one direction only is not among the names: this is a hint for a message about a singular
  system, not a proof.
@*/
PetscErrorCode FreeModesUnheld(Mesh mesh, Scene scene, Loads loads, size_t size, char *text)
{
  PetscInt *held;
  size_t    used;

  PetscFunctionBeginUser;
  text[0] = '\0';
  PetscCall(PetscCalloc1(scene->n_bodies, &held));
  for (PetscInt c = 0; c < mesh->n_cells; c++)
    for (PetscInt k = mesh->cell_ptr[c]; k < mesh->cell_ptr[c + 1]; k++)
      for (int d = 0; d < mesh->dim; d++)
        held[mesh->cell_body[c]] += LoadsHeld(loads, mesh->cell_nodes[k] * mesh->dim + d) ? 1 : 0;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, held, scene->n_bodies, MPIU_INT, MPI_SUM, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) {
    if (held[b] || scene->bodies[b].rigid) continue;
    PetscCall(PetscStrlen(text, &used));
    PetscCall(PetscSNPrintf(text + used, size - used, "%s'%s'", used ? ", " : "", scene->bodies[b].name));
  }
  PetscCall(PetscFree(held));
  PetscFunctionReturn(PETSC_SUCCESS);
}
