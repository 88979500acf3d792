/* Rigid tools as meshes, see toolshapes.h. */
#include "toolshapes.h"
#include <math.h>
#include <string.h>

/* A full circle has so many edges: its chords then lie within 0.06 % of the radius. */
#define CIRCLE_EDGES 90
/* A sphere has so many bands from pole to pole. */
#define SPHERE_BANDS 45

/* Makes the name of the last shape fit for a path in a file, and different from those of all others. */
static PetscErrorCode SettleName(ToolShapes *shapes)
{
  ToolShape *last = &shapes->shape[shapes->n - 1];

  PetscFunctionBeginUser;
  for (char *at = last->name; *at; at++)
    if (*at == '/') *at = '_';
  for (int s = 0; s < shapes->n - 1; s++) {
    if (strcmp(shapes->shape[s].name, last->name)) continue;
    PetscCall(PetscStrlcat(last->name, "_", sizeof(last->name)));
    s = -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddShape(ToolShapes *shapes, ElementType type, PetscInt n_nodes, PetscInt n_cells,
                               ToolShape **added)
{
  ToolShape *shape;

  PetscFunctionBeginUser;
  PetscCall(PetscRealloc((size_t)(shapes->n + 1) * sizeof(ToolShape), &shapes->shape));
  shape  = &shapes->shape[shapes->n++];
  *shape = (ToolShape){.type = type, .n_nodes = n_nodes, .n_cells = n_cells};
  PetscCall(PetscCalloc1(n_nodes * 3, &shape->nodes));
  PetscCall(PetscCalloc1(n_cells * ElementGet(type)->nodes, &shape->cells));
  *added = shape;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Meshed tools: a shape for each type of face. */
static PetscErrorCode AddMeshed(Mesh mesh, Scene scene, const MeshRigid *rigid, ToolShapes *shapes)
{
  PetscFunctionBeginUser;
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    const int  nodes = ElementGet((ElementType)type)->nodes, body = MeshFindBody(scene, rigid->name, PETSC_TRUE);
    PetscInt   n = 0;
    ToolShape *shape;

    for (PetscInt f = 0; f < rigid->n_faces; f++) n += rigid->face_type[f] == (ElementType)type;
    if (!n || body < 0) continue;
    PetscCall(AddShape(shapes, (ElementType)type, rigid->n_nodes, n, &shape));
    PetscCall(PetscSNPrintf(shape->name, sizeof(shape->name), "%s%s%s", rigid->name, n < rigid->n_faces ? " " : "",
                            n < rigid->n_faces ? ElementGet((ElementType)type)->name : ""));
    PetscCall(SettleName(shapes));
    shape->number = body;
    shape->motion = &scene->bodies[body].motion;
    for (PetscInt k = 0; k < rigid->n_nodes; k++)
      for (int d = 0; d < mesh->dim; d++) shape->nodes[k * 3 + d] = rigid->coords[k * mesh->dim + d] + mesh->centre[d];
    n = 0;
    for (PetscInt f = 0; f < rigid->n_faces; f++) {
      if (rigid->face_type[f] != (ElementType)type) continue;
      for (int i = 0; i < nodes; i++) shape->cells[n * nodes + i] = rigid->face_nodes[rigid->face_ptr[f] + i];
      n++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two unit vectors across a unit vector. */
static void Across(const double axis[3], double a[3], double b[3])
{
  const int least =
    fabs(axis[0]) < fabs(axis[1]) ? (fabs(axis[0]) < fabs(axis[2]) ? 0 : 2) : (fabs(axis[1]) < fabs(axis[2]) ? 1 : 2);
  double other[3] = {least == 0, least == 1, least == 2}, length;

  a[0]   = axis[1] * other[2] - axis[2] * other[1];
  a[1]   = axis[2] * other[0] - axis[0] * other[2];
  a[2]   = axis[0] * other[1] - axis[1] * other[0];
  length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  for (int d = 0; d < 3; d++) a[d] /= length;
  b[0] = axis[1] * a[2] - axis[2] * a[1];
  b[1] = axis[2] * a[0] - axis[0] * a[2];
  b[2] = axis[0] * a[1] - axis[1] * a[0];
}

/* Where an analytic tool is drawn: its unit axis or normal, two directions across it, and the point of it that is
   nearest to the middle of the bodies. */
typedef struct {
  double axis[3], a[3], b[3], foot[3];
  double radius, size;
} Frame;

static void FrameOf(Mesh mesh, const SceneContact *contact, Frame *frame)
{
  const AnalyticSurface *master = &contact->analytic;
  double                 length = 0, along = 0;

  for (int d = 0; d < 3; d++) length += master->axis[d] * master->axis[d];
  for (int d = 0; d < 3; d++) frame->axis[d] = length > 0 ? master->axis[d] / sqrt(length) : d == 2;
  Across(frame->axis, frame->a, frame->b);
  if (mesh->dim == 2 && master->shape == ANALYTIC_PLANE) {
    frame->a[0] = -frame->axis[1];
    frame->a[1] = frame->axis[0];
    frame->a[2] = 0;
  }
  for (int d = 0; d < 3; d++) along += (mesh->centre[d] - contact->motion.point[d]) * frame->axis[d];
  for (int d = 0; d < 3; d++)
    frame->foot[d] = master->shape == ANALYTIC_PLANE      ? mesh->centre[d] - along * frame->axis[d]
                     : master->shape == ANALYTIC_CYLINDER ? contact->motion.point[d] + along * frame->axis[d]
                                                          : contact->motion.point[d];
  frame->radius = master->radius;
  frame->size   = (double)mesh->size;
}

static void SetNode(ToolShape *shape, PetscInt k, const Frame *frame, double a, double b, double axis)
{
  for (int d = 0; d < 3; d++)
    shape->nodes[k * 3 + d] = frame->foot[d] + a * frame->a[d] + b * frame->b[d] + axis * frame->axis[d];
}

/* A chain of edges from node to node. */
static void SetEdges(ToolShape *shape, PetscBool closed)
{
  for (PetscInt c = 0; c < shape->n_cells; c++) {
    shape->cells[2 * c]     = c;
    shape->cells[2 * c + 1] = closed && c == shape->n_cells - 1 ? 0 : c + 1;
  }
}

/* A line in the plane: a plane seen from its edge, or the wall of a cylinder about the axis of revolution. */
static PetscErrorCode AddLine(const double from[3], const double to[3], ToolShapes *shapes, ToolShape **shape)
{
  PetscFunctionBeginUser;
  PetscCall(AddShape(shapes, ELEMENT_EDGE2, 2, 1, shape));
  for (int d = 0; d < 3; d++) {
    (*shape)->nodes[d]     = from[d];
    (*shape)->nodes[3 + d] = to[d];
  }
  SetEdges(*shape, PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A circle about z, or in an axisymmetric scene its half at x > 0. */
static PetscErrorCode AddCircle(const Frame *frame, PetscBool half, ToolShapes *shapes, ToolShape **shape)
{
  const PetscInt edges = half ? CIRCLE_EDGES / 2 : CIRCLE_EDGES;

  PetscFunctionBeginUser;
  PetscCall(AddShape(shapes, ELEMENT_EDGE2, half ? edges + 1 : edges, edges, shape));
  for (PetscInt k = 0; k < (*shape)->n_nodes; k++) {
    const double angle = 2 * PETSC_PI * (double)k / CIRCLE_EDGES - (half ? PETSC_PI / 2 : 0);

    (*shape)->nodes[k * 3]     = frame->foot[0] + frame->radius * cos(angle);
    (*shape)->nodes[k * 3 + 1] = frame->foot[1] + frame->radius * sin(angle);
  }
  SetEdges(*shape, half ? PETSC_FALSE : PETSC_TRUE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Quadrilaterals between rings of nodes: a tube, or a sphere, whose rings at the poles shrink to points. */
static PetscErrorCode AddRings(const Frame *frame, AnalyticShape kind, ToolShapes *shapes, ToolShape **shape)
{
  const PetscInt bands = kind == ANALYTIC_SPHERE ? SPHERE_BANDS : 1;

  PetscFunctionBeginUser;
  PetscCall(AddShape(shapes, ELEMENT_QUAD4, (bands + 1) * CIRCLE_EDGES, bands * CIRCLE_EDGES, shape));
  for (PetscInt r = 0; r <= bands; r++) {
    const double polar  = PETSC_PI * (double)r / (double)bands;
    const double radius = frame->radius * (kind == ANALYTIC_SPHERE ? sin(polar) : 1);
    const double height = kind == ANALYTIC_SPHERE ? -frame->radius * cos(polar) : frame->size * ((double)r - 0.5);

    for (PetscInt k = 0; k < CIRCLE_EDGES; k++) {
      const double  angle = 2 * PETSC_PI * (double)k / CIRCLE_EDGES;
      int64_t      *cell  = &(*shape)->cells[(r * CIRCLE_EDGES + k) * 4];
      const int64_t next  = (k + 1) % CIRCLE_EDGES;

      SetNode(*shape, r * CIRCLE_EDGES + k, frame, radius * cos(angle), radius * sin(angle), height);
      if (r == bands) continue;
      cell[0] = r * CIRCLE_EDGES + k;
      cell[1] = r * CIRCLE_EDGES + next;
      cell[2] = (r + 1) * CIRCLE_EDGES + next;
      cell[3] = (r + 1) * CIRCLE_EDGES + k;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A square, as large as the bodies. */
static PetscErrorCode AddSquare(const Frame *frame, ToolShapes *shapes, ToolShape **shape)
{
  static const double corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

  PetscFunctionBeginUser;
  PetscCall(AddShape(shapes, ELEMENT_QUAD4, 4, 1, shape));
  for (int k = 0; k < 4; k++) {
    SetNode(*shape, k, frame, frame->size / 2 * corner[k][0], frame->size / 2 * corner[k][1], 0);
    (*shape)->cells[k] = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Draws an analytic tool in the plane. */
static PetscErrorCode AddFlat(const Frame *frame, AnalyticShape kind, PetscBool axisymmetric, ToolShapes *shapes,
                              ToolShape **shape)
{
  double from[3], to[3];

  PetscFunctionBeginUser;
  if (kind == ANALYTIC_SPHERE || (kind == ANALYTIC_CYLINDER && !axisymmetric)) {
    PetscCall(AddCircle(frame, axisymmetric, shapes, shape));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (int d = 0; d < 3; d++) {
    const double along = kind == ANALYTIC_PLANE ? frame->a[d] : frame->axis[d];

    from[d] = frame->foot[d] - frame->size / 2 * along + (kind == ANALYTIC_CYLINDER && d == 0 ? frame->radius : 0);
    to[d]   = from[d] + frame->size * along;
  }
  if (axisymmetric && kind == ANALYTIC_PLANE) {
    from[0] = 0;
    to[0]   = frame->size;
  }
  PetscCall(AddLine(from, to, shapes, shape));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddAnalytic(Mesh mesh, Scene scene, int pair, ToolShapes *shapes)
{
  static const char *const names[] =
    {[ANALYTIC_PLANE] = "plane", [ANALYTIC_CYLINDER] = "cylinder", [ANALYTIC_SPHERE] = "sphere"};
  const SceneContact *contact = &scene->contacts[pair];
  const AnalyticShape kind    = contact->analytic.shape;
  Frame               frame;
  ToolShape          *shape;

  PetscFunctionBeginUser;
  FrameOf(mesh, contact, &frame);
  if (mesh->dim == 2)
    PetscCall(
      AddFlat(&frame, kind, scene->geometry == GEOMETRY_AXISYMMETRIC ? PETSC_TRUE : PETSC_FALSE, shapes, &shape));
  else if (kind == ANALYTIC_PLANE)
    PetscCall(AddSquare(&frame, shapes, &shape));
  else
    PetscCall(AddRings(&frame, kind, shapes, &shape));
  PetscCall(PetscSNPrintf(shape->name, sizeof(shape->name), "%s_%s", contact->name, names[kind]));
  PetscCall(SettleName(shapes));
  shape->number = scene->n_bodies + pair;
  shape->motion = &contact->motion;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolShapesCreate - makes the meshes of all rigid tools of a scene.

  Not collective

  Input Parameters:
+ mesh  - its meshed tools and the size of its bodies are read
- scene - bodies and contact pairs, which must live as long as the shapes

  Output Parameter:
. shapes - to be freed with ToolShapesDestroy()
@*/
PetscErrorCode ToolShapesCreate(Mesh mesh, Scene scene, ToolShapes *shapes)
{
  PetscFunctionBeginUser;
  *shapes = (ToolShapes){0};
  for (int r = 0; r < mesh->n_rigid; r++) PetscCall(AddMeshed(mesh, scene, &mesh->rigid[r], shapes));
  for (int p = 0; p < scene->n_contacts; p++)
    if (!scene->contacts[p].master) PetscCall(AddAnalytic(mesh, scene, p, shapes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ToolShapePlace - gives the displacements of a tool's nodes.

  Not collective

  Input Parameters:
+ shape - the tool
- t     - load parameter

  Output Parameter:
. displacement - [n_nodes * 3]
@*/
void ToolShapePlace(const ToolShape *shape, PetscReal t, PetscReal *displacement)
{
  for (PetscInt k = 0; k < shape->n_nodes; k++) {
    double X[3], x[3];

    for (int d = 0; d < 3; d++) X[d] = (double)shape->nodes[k * 3 + d];
    MotionPlace(shape->motion, (double)t, X, x);
    for (int d = 0; d < 3; d++) displacement[k * 3 + d] = x[d] - X[d];
  }
}

/*@
  ToolShapesDestroy - frees the shapes.

  Not collective

  Input Parameter:
. shapes - empty afterwards
@*/
PetscErrorCode ToolShapesDestroy(ToolShapes *shapes)
{
  PetscFunctionBeginUser;
  for (int s = 0; s < shapes->n; s++) {
    PetscCall(PetscFree(shapes->shape[s].nodes));
    PetscCall(PetscFree(shapes->shape[s].cells));
  }
  PetscCall(PetscFree(shapes->shape));
  *shapes = (ToolShapes){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
