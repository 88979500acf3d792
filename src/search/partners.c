/* Slave points where any side of the bodies may meet any other one: which of them can have a partner at all. */
#include "ownbody.h"

/* A test is good as long as slave points, with their offsets, and master together have moved by less than this part of
   the thinnest element or of the largest face, whichever is less. A wall of one element is thicker than that and what
   can have been entered of it. */
#define PARTNERS_SKIN 0.25
/* And as long as no unit normal has changed by more than this. Normals count as opposed from SEARCH_OPPOSED_NOT on, so
   that two of these changes leave faces of a right angle out. */
#define PARTNERS_TURN 0.02
/* Points of a face are tested one by one where more facets than this are in sight of them together: a tree finds the
   nearest ones of many sooner than a row. */
enum { PARTNERS_TOGETHER = 128 };
/* Normals of a facet are compared at few places. Elsewhere on it they have turned by at most this many times as much:
   the largest sum of the absolute shape functions between three points of a rule, for both directions. */
#define PARTNERS_TURN_BETWEEN 4
/* Where the middle nodes of a quadratic facet deviate from the one through its corners, the facet exceeds its nodes by
   at most this much of the largest deviation: sum of the absolute shape functions of these nodes. */
#define PARTNERS_BULGE 1.6

/* How far a test sees beyond the positions at hand. */
typedef struct {
  PetscReal radius, shift, turn; /* two lengths, and the change of a unit normal */
} PartnersSight;

/* The length of which the constants above are parts, over all ranks. */
static PetscErrorCode ThinnestPart(ContactSearch s, PetscReal *length)
{
  PetscFunctionBeginUser;
  *length = PetscMax(s->slaves->surface->max_size, s->master->max_size);
  for (PetscInt q = 0; q < s->slaves->n; q++) *length = PetscMin(*length, s->slaves->height[q]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, length, 1, MPIU_REAL, MPIU_MIN, s->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchHasPartners - says whether slave points without a partner are known from former searches or from a test before
  a search.

  Not collective

  Input Parameter:
. s - the search
@*/
PetscBool SearchHasPartners(ContactSearch s)
{
  return (PetscBool)(s->listed && s->master && !s->master->rigid && !s->slaves->maps.ptr);
}

/*@
  SearchTestsPartners - says whether slave points are tested for partners before they are searched.

  Not collective

  Input Parameter:
. s - the search

  Note:
  They are on one body, where most faces lie near others that do not oppose them. Where slave and master are two bodies,
  a search learns from its own lists which points have no partner.
@*/
PetscBool SearchTestsPartners(ContactSearch s)
{
  return (PetscBool)(s->one_body && SearchHasPartners(s));
}

/* The test of one slave point. */
typedef struct {
  const SearchField *field;
  NeighbourLists     lists;
  const BoxTreeSide *side;
  const PetscReal   *x;
  PetscBool          found;
} PointTest;

/* How far a facet reaches along a direction beyond its nodes (length), from their heights along it. */
static PetscReal Bulge(const Element *e, const PetscReal *height)
{
  PetscReal mean = 0, most = 0;

  for (int a = 0; a < e->corners; a++) mean += height[a] / e->corners;
  for (int a = e->corners; a < e->nodes; a++) {
    const PetscBool middle = (PetscBool)(e->dim == 1 || a - e->corners >= e->edges); /* of the whole facet */
    const int      *ends   = e->edge_corners[middle ? 0 : a - e->corners];

    most = PetscMax(most, PetscAbsReal(height[a] - (middle ? mean : (height[ends[0]] + height[ends[1]]) / 2)));
  }
  return PARTNERS_BULGE * most;
}

/* Does a candidate lie wholly behind the plane of the point, farther than what can have been entered? Its nodes say
   more than its box, which is thick where the candidate lies askew. */
static PetscBool LiesBehind(const PointTest *test, const Candidate *c)
{
  const BoxTreeSide *side = test->side;
  const Element     *e    = ElementGet(c->facet.type);
  const int          dim  = test->lists->dim;
  PetscReal          height[FACE_MAX_NODES], most = PETSC_MIN_REAL, farthest = 0;

  for (int a = 0; a < e->nodes; a++) {
    const PetscInt p      = c->facet.nodes[a] * dim;
    PetscReal      square = 0;

    height[a] = 0;
    for (int d = 0; d < dim; d++) {
      const PetscReal way = test->lists->point_X[p + d] + test->lists->point_u[p + d] - test->x[d];

      height[a] += side->own[d] * way;
      square += PetscSqr(way);
    }
    most     = PetscMax(most, height[a]);
    farthest = PetscMax(farthest, square);
  }
  most += Bulge(e, height);
  farthest = PetscSqrtReal(farthest) + CandidateBulge(c, test->field->records[c->record].size);
  return (PetscBool)(most < -side->shift - side->lean * farthest &&
                     PetscMax(-most, CandidateBoxDistance(dim, c, test->x)) > side->behind);
}

/* Does the point lie wholly behind a candidate, farther than what can have been entered? */
static PetscBool PointIsBehind(const PointTest *test, const Candidate *c)
{
  const BoxTreeSide *side = test->side;
  const int          dim  = test->lists->dim;
  PetscReal          x[3] = {0, 0, 0}, square = 0;

  for (int d = 0; d < dim; d++) {
    x[d] = test->x[d];
    square += PetscSqr(x[d] - c->hull.centre[d]);
  }
  return (PetscBool)(FacetHullSide(&c->hull, x,
                                   side->shift + PARTNERS_TURN_BETWEEN * side->lean *
                                                   (PetscSqrtReal(square) + c->hull.radius)) < 0 &&
                     CandidateBoxDistance(dim, c, x) > side->behind);
}

/* May a candidate be a partner? */
static int TestFacet(void *context, int index)
{
  const PointTest *test = context;
  const Candidate *c    = &test->field->candidates[index];

  return !LiesBehind(test, c) && !PointIsBehind(test, c);
}

/* Visitor of BoxTreeClosest(), which ends with the first facet that may be a partner. */
static void VisitFacet(void *context, int index, double *bound)
{
  PointTest *test = context;

  if (!TestFacet(context, index)) return;
  test->found = PETSC_TRUE;
  *bound      = -1;
}

/* Makes normals unit ones; some: of these; NULL: of all. */
static PetscErrorCode Normalise(PetscInt n, const PetscBool *some, PetscReal *normal)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *v = &normal[3 * i], length;

    if (some && !some[i]) continue;
    length = PetscSqrtReal(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int d = 0; d < 3 && length > 0; d++) v[d] /= length;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unit normals of the slave points after their last move. any: the same of any length. */
static PetscErrorCode PointNormals(ContactSearch s, const PetscReal *u, PetscReal *any, PetscReal *normal)
{
  PetscFunctionBeginUser;
  PetscCall(SlavePointsNormals(s->slaves, s->n_images, s->images, u, NULL, any));
  PetscCall(PetscArraycpy(normal, any, 3 * s->slaves->n));
  PetscCall(Normalise(s->slaves->n, NULL, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unit normals at the centres of the master's faces on this rank. */
static void FaceNormals(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal *normal)
{
  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    Candidate face = {.facet = s->master->faces[f]};
    PetscReal x[FACE_MAX_NODES * 3];

    SearchFacePositions(s, s->master, f, u, t, x);
    CandidatePlace(s->mesh->dim, x, 0, &face);
    for (int d = 0; d < 3; d++) normal[3 * f + d] = face.normal[d];
  }
}

/* Tests of slave points: what they look for, and from where. */
typedef struct {
  ContactSearch        s;
  const SearchField   *field;
  NeighbourLists       lists;
  BoxTree              tree;
  const PartnersSight *sight;
  const PetscReal     *x, *normal; /* of all slave points; unit normals */
  const PetscBool     *among;      /* those to be tested; NULL: all */
} PointTests;

/* What a slave point leaves out. Where slave and master have faces of one body, the facet must oppose the point. */
static BoxTreeSide PointSide(const PointTests *tests, PetscInt q)
{
  const ContactSearch s      = tests->s;
  const PetscReal     behind = OwnBodyFarthest(s->one_body, s->slaves->height[q], s->slaves->size[q]);

  return (BoxTreeSide){.own     = &tests->normal[3 * q],
                       .opposed = s->one_body ? SEARCH_OPPOSED_NOT - 2 * tests->sight->turn : -INFINITY,
                       .behind  = behind + tests->sight->shift,
                       .shift   = tests->sight->shift,
                       .lean    = tests->sight->turn};
}

/* Has a slave point a facet in sight that is not behind its own body? gathered: BoxTreeGather() has seen to it. */
static PetscBool TestPoint(const PointTests *tests, PetscBool gathered, PetscInt q)
{
  const BoxTreeSide side  = PointSide(tests, q);
  const PetscReal  *x     = &tests->x[q * tests->lists->dim];
  PointTest         test  = {tests->field, tests->lists, &side, x, PETSC_FALSE};
  double            bound = tests->sight->radius;

  if (gathered) return (PetscBool)BoxTreeAny(tests->tree, x, &side, bound, TestFacet, &test);
  BoxTreeClosest(tests->tree, x, &side, &bound, VisitFacet, &test);
  return test.found;
}

/* Takes in the slave points from `first` to `last` that are to be tested, and says how many. */
static PetscInt GroupPoints(const PointTests *tests, PetscInt first, PetscInt last, BoxTreeGroup *group)
{
  const int dim = tests->lists->dim;
  PetscInt  n   = 0;

  group->behind = 0;
  for (PetscInt q = first; q < last; q++) {
    const PetscReal *x = &tests->x[q * dim], *normal = &tests->normal[3 * q];

    if (tests->among && !tests->among[q]) continue;
    for (int d = 0; d < dim; d++) {
      group->lower[d]     = n ? PetscMin(group->lower[d], x[d]) : x[d];
      group->upper[d]     = n ? PetscMax(group->upper[d], x[d]) : x[d];
      group->own_lower[d] = n ? PetscMin(group->own_lower[d], normal[d]) : normal[d];
      group->own_upper[d] = n ? PetscMax(group->own_upper[d], normal[d]) : normal[d];
    }
    group->behind = PetscMax(group->behind, PointSide(tests, q).behind);
    n++;
  }
  return n;
}

/* Tests slave points from `first` to `last`, which lie on one face and look alike: what none of them can see is left
   out for all at once. */
static void TestGroup(const PointTests *tests, PetscInt first, PetscInt last, PetscBool *possible)
{
  BoxTreeGroup    group;
  const PetscInt  n        = GroupPoints(tests, first, last, &group);
  const PetscBool together = (PetscBool)(n > 1);
  BoxTreeSide     side;
  int             seen = 0;

  if (n == 0) return;
  side = PointSide(tests, first);
  if (together) seen = BoxTreeGather(tests->tree, &group, &side, tests->sight->radius);
  for (PetscInt q = first; q < last; q++)
    if (!tests->among || tests->among[q])
      possible[q] = TestPoint(tests, (PetscBool)(together && seen <= PARTNERS_TOGETHER), q);
}

/* Tests the slave points, those of a face together where they have faces. The tree compares boxes, so that points
   without a partner may pass, but no point with one is missed. */
static void TestGroups(const PointTests *tests, PetscBool *possible)
{
  const SlavePoints points = tests->s->slaves;

  for (PetscInt f = 0; f < points->n_faces; f++) TestGroup(tests, points->first[f], points->first[f + 1], possible);
  for (PetscInt q = 0; q < points->n && !points->n_faces; q++) TestGroup(tests, q, q + 1, possible);
}

/* Tests which of some slave points have a facet that opposes them in sight, and not behind their own body. */
static PetscErrorCode TestPoints(ContactSearch s, const PetscReal *u, PetscReal t, const PartnersSight *sight,
                                 const PetscReal *normal, const PetscBool *among, PetscBool *possible)
{
  const int      dim = s->mesh->dim;
  NeighbourLists lists;
  SearchField    field;
  PointTests     tests = {s, &field, NULL, NULL, sight, NULL, normal, among};
  PetscReal      box[6], *x;

  PetscFunctionBeginUser;
  SearchBoxEmpty(dim, box);
  PetscCall(PetscMalloc1(s->slaves->n * dim, &x));
  for (PetscInt q = 0; q < s->slaves->n; q++) {
    if (among && !among[q]) continue;
    SlavePointsPosition(s->slaves, q, &x[q * dim]);
    SearchBoxAdd(box, dim, &x[q * dim]);
  }
  PetscCall(PetscNew(&lists));
  PetscCall(SearchFieldCreate(s, u, t, box, sight->radius, PETSC_FALSE, lists, &field));
  PetscCall(CandidatesTree(dim, field.n_candidates, field.candidates, PETSC_TRUE, s->before.known, &tests.tree));
  PetscCall(PetscArrayzero(possible, s->slaves->n));
  tests.lists = lists;
  tests.x     = x;
  TestGroups(&tests, possible);
  BoxTreeDestroy(&tests.tree);
  PetscCall(SearchFieldDestroy(&field));
  PetscCall(NeighbourListsDestroy(&lists));
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal LargestChange(PetscInt n, int dim, const PetscReal *a, const PetscReal *b)
{
  PetscReal most = 0;

  for (PetscInt i = 0; i < n; i++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(a[i * dim + d] - b[i * dim + d]);
    most = PetscMax(most, square);
  }
  return PetscSqrtReal(most);
}

/* Adds a point of a face to its lever. N and dN are the shape functions there, with dN[a * stride + k], x the nodes'
   positions. Tangents change by no more than the sum of their derivatives' amounts times the length, and the unit
   vector of a product by no more than twice its change over its amount. */
static void LeverAdd(int dim, const Element *e, const double *N, const double *dN, int stride, const PetscReal *x,
                     PetscReal *lever)
{
  PetscReal tangent[2][3] = {{0}}, length[2] = {0, 0}, sum[2] = {0, 0}, amount = 0, area = 0;

  for (int a = 0; a < e->nodes; a++) {
    amount += PetscAbsReal(N[a]);
    for (int k = 0; k < e->dim; k++) {
      sum[k] += PetscAbsReal(dN[a * stride + k]);
      for (int d = 0; d < dim; d++) tangent[k][d] += dN[a * stride + k] * x[a * dim + d];
    }
  }
  for (int k = 0; k < e->dim; k++) {
    for (int d = 0; d < dim; d++) length[k] += PetscSqr(tangent[k][d]);
    length[k] = PetscSqrtReal(length[k]);
  }
  for (int d = 0; d < 3 && e->dim == 2; d++)
    area +=
      PetscSqr(tangent[0][(d + 1) % 3] * tangent[1][(d + 2) % 3] - tangent[0][(d + 2) % 3] * tangent[1][(d + 1) % 3]);
  area = e->dim == 2 ? PetscSqrtReal(area) : length[0];
  if (e->order > 1) lever[LEVER_POINT] = PetscMax(lever[LEVER_POINT], amount);
  if (!(area > 0)) {
    lever[LEVER_NORMAL] = PETSC_INFINITY;
    return;
  }
  lever[LEVER_NORMAL] =
    PetscMax(lever[LEVER_NORMAL], 2 * (e->dim == 2 ? sum[0] * length[1] + sum[1] * length[0] : sum[0]) / area);
  if (e->dim == 2) lever[LEVER_SQUARE] = PetscMax(lever[LEVER_SQUARE], 2 * sum[0] * sum[1] / area);
}

/* Takes a face's lever into the largest of all faces. */
static void LeverMost(const PetscReal *lever, PetscReal *most)
{
  for (int k = 0; k < LEVERS; k++) most[k] = PetscMax(most[k], lever[k]);
}

/* Finds the levers of all faces at the state of the last test, and the largest ones. */
static void FindLevers(ContactSearch s, const PetscReal *u, PetscReal t)
{
  const SlavePoints points = s->slaves;
  const int         dim    = s->mesh->dim;
  PetscReal        *lever = s->partners.lever, *most = s->partners.most_lever, x[FACE_MAX_NODES * 3];

  for (int k = 0; k < LEVERS; k++) most[k] = 0;

  for (PetscInt f = 0; f < points->n_faces; f++, lever += LEVERS) {
    const ElementType type = points->faces[f].type;
    const FaceRule   *rule = FaceRuleOf(type, points->finer, points->ends[f]);

    SlavePointsFacePositions(points, f, x);
    for (int k = 0; k < LEVERS; k++) lever[k] = 0;
    for (int q = 0; q < rule->n; q++) LeverAdd(dim, ElementGet(type), rule->N[q], &rule->dN[q][0][0], 2, x, lever);
    LeverMost(lever, most);
  }
  for (PetscInt f = 0; f < s->master->n_faces; f++, lever += LEVERS) {
    const Element *e     = ElementGet(s->master->faces[f].type);
    double         xi[2] = {0, 0}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2];

    if (e->corners == 3) xi[0] = xi[1] = 1.0 / 3;
    ElementShape(e->type, xi, N, dN, NULL);
    SearchFacePositions(s, s->master, f, u, t, x);
    for (int k = 0; k < LEVERS; k++) lever[k] = 0;
    LeverAdd(dim, e, N, dN, e->dim, x, lever);
    LeverMost(lever, most);
  }
}

/* Takes in by how much a face whose nodes have numbers node[] has moved at most, and turned. */
static void FaceChange(int dim, int nodes, const int *node, const PetscReal *now, const PetscReal *before,
                       const PetscReal *lever, PetscReal *moved, PetscReal *turned)
{
  PetscReal lower[3] = {0, 0, 0}, upper[3] = {0, 0, 0}, part = 0, square = 0;

  for (int a = 0; a < nodes; a++) {
    PetscReal way = 0;

    for (int d = 0; d < dim; d++) {
      const PetscReal change = now[node[a] * dim + d] - before[node[a] * dim + d];

      lower[d] = a ? PetscMin(lower[d], change) : change;
      upper[d] = a ? PetscMax(upper[d], change) : change;
      way += PetscSqr(change);
    }
    square = PetscMax(square, way);
  }
  for (int d = 0; d < dim; d++) part += PetscSqr(upper[d] - lower[d]);
  part    = PetscSqrtReal(part);
  *moved  = PetscMax(*moved, PetscSqrtReal(square) + lever[LEVER_POINT] * part);
  *turned = PetscMax(*turned, part > 0 ? (lever[LEVER_NORMAL] + lever[LEVER_SQUARE] * part) * part : 0);
}

/* Bounds of what BoundChanges() finds, from the largest motions of nodes and the largest levers of faces: two nodes of
   a face part by twice the largest motion at most. Nodes of other surfaces count as well, and rough bounds are enough
   where hardly anything moves. */
static PetscErrorCode BoundRoughly(ContactSearch s, const PetscReal *u, PetscReal *moved, PetscReal *turned)
{
  enum { POINT, NODE, OFFSET, NORMAL, CHANGES };
  const int        dim   = s->mesh->dim;
  const Partners  *at    = &s->partners;
  const PetscReal *lever = at->most_lever, parting = 2 * PetscSqrtReal(dim), more = 1 + parting * lever[LEVER_POINT],
                  point = LargestChange(s->slaves->n_nodes, dim, s->slaves->u, at->slave_u),
                  node = LargestChange(s->mesh->n_nodes, dim, u, at->u), part = parting * PetscMax(point, node);
  PetscReal all[CHANGES] = {more * point, more * node, s->slaves->most_offset,
                            part > 0 ? (lever[LEVER_NORMAL] + lever[LEVER_SQUARE] * part) * part : 0};

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, CHANGES, MPIU_REAL, MPIU_MAX, s->mesh->comm));
  *moved  = all[POINT] + all[NODE] + all[OFFSET];
  *turned = all[NORMAL];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much positions of points and of the master's nodes have changed at most since the last test, with the offsets,
   and unit normals, over all ranks: bounds from the motion of nodes alone. */
static PetscErrorCode BoundChanges(ContactSearch s, const PetscReal *u, PetscReal *moved, PetscReal *turned)
{
  enum { POINT, NODE, OFFSET, NORMAL, CHANGES };
  const SlavePoints points       = s->slaves;
  const Partners   *at           = &s->partners;
  const PetscReal  *lever        = at->lever;
  PetscReal         all[CHANGES] = {0, 0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < points->n_faces; f++, lever += LEVERS)
    FaceChange(s->mesh->dim, ElementGet(points->faces[f].type)->nodes, points->faces[f].nodes, points->u, at->slave_u,
               lever, &all[POINT], &all[NORMAL]);
  for (PetscInt f = 0; f < s->master->n_faces; f++, lever += LEVERS)
    FaceChange(s->mesh->dim, ElementGet(s->master->faces[f].type)->nodes, s->master->faces[f].nodes, u, at->u, lever,
               &all[NODE], &all[NORMAL]);
  all[OFFSET] = s->slaves->most_offset;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, CHANGES, MPIU_REAL, MPIU_MAX, s->mesh->comm));
  *moved  = all[POINT] + all[NODE] + all[OFFSET];
  *turned = all[NORMAL];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* By how much nodes of the master's faces on this rank have moved at most since the last test (length). */
static PetscReal MasterMotion(ContactSearch s, const PetscReal *u)
{
  const int dim  = s->mesh->dim;
  PetscReal most = 0;

  for (PetscInt f = 0; f < s->master->n_faces; f++) {
    for (int a = 0; a < ElementGet(s->master->faces[f].type)->nodes; a++) {
      const PetscInt i      = s->master->faces[f].nodes[a] * dim;
      PetscReal      square = 0;

      for (int d = 0; d < dim; d++) square += PetscSqr(u[i + d] - s->partners.u[i + d]);
      most = PetscMax(most, square);
    }
  }
  return PetscSqrtReal(most);
}

/* What has changed since the last test, over all ranks: positions of the points and of the master's nodes, offsets
   (lengths), unit normals. */
static PetscErrorCode Changes(ContactSearch s, const PetscReal *u, const PetscReal *x, const PetscReal *normal,
                              const PetscReal *face_normal, PetscReal *moved, PetscReal *turned)
{
  enum { POINT, NODE, OFFSET, NORMAL, FACE, CHANGES };
  const int       dim = s->mesh->dim;
  const Partners *at  = &s->partners;
  PetscReal       all[CHANGES];

  PetscFunctionBeginUser;
  all[POINT]  = LargestChange(s->slaves->n, dim, x, at->x);
  all[NODE]   = MasterMotion(s, u);
  all[OFFSET] = s->slaves->most_offset;
  all[NORMAL] = LargestChange(s->slaves->n, 3, normal, at->normal);
  all[FACE]   = LargestChange(s->master->n_faces, 3, face_normal, at->face_normal);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, all, CHANGES, MPIU_REAL, MPIU_MAX, s->mesh->comm));
  *moved  = all[POINT] + all[NODE] + all[OFFSET];
  *turned = PetscMax(all[NORMAL], all[FACE]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the tests see on whose answer later searches rely. */
static PartnersSight SightAhead(ContactSearch s)
{
  const PetscReal skin = PARTNERS_SKIN * s->partners.thin;

  return (PartnersSight){s->reach + s->partners.motion + skin, skin, PARTNERS_TURN};
}

/* Says whether any slave point on any rank may have a partner. */
static PetscErrorCode NoteAny(ContactSearch s)
{
  Partners *at  = &s->partners;
  int       any = 0;

  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < s->slaves->n; q++) any = any || at->possible[q];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_LOR, s->mesh->comm));
  at->any = (PetscBool)any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tests all points at a state, which becomes that of the last test, or leaves the test to SearchPartnersLearn(). */
static PetscErrorCode TestAll(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion)
{
  Partners     *at = &s->partners;
  PartnersSight sight;

  PetscFunctionBeginUser;
  at->motion = motion;
  sight      = SightAhead(s);
  PetscCall(PetscArraycpy(at->u, u, s->mesh->n_nodes * s->mesh->dim));
  if (at->lever) PetscCall(PetscArraycpy(at->slave_u, s->slaves->u, s->slaves->n_nodes * s->mesh->dim));
  if (at->lever) FindLevers(s, u, t);
  at->learns = (PetscBool)!SearchTestsPartners(s);
  if (at->learns)
    for (PetscInt q = 0; q < s->slaves->n; q++) at->possible[q] = PETSC_TRUE;
  else
    PetscCall(TestPoints(s, u, t, &sight, at->normal, NULL, at->possible));
  PetscCall(NoteAny(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchPartnersLearn - finds which slave points have no partner from lists that have just been made, if no test has
  said so.

  Collective

  Input Parameters:
+ s     - the search, after SearchPartners() at the state of the lists
. lists - the lists
. field - the candidates of the lists
- tree  - the tree of the candidates

  Note:
  A point for which the lists have a facet, or one that does not face it, may have a partner. The others are tested.
@*/
PetscErrorCode SearchPartnersLearn(ContactSearch s, NeighbourLists lists, const SearchField *field, BoxTree tree)
{
  const PartnersSight sight = SightAhead(s);
  Partners           *at    = &s->partners;
  PetscBool          *among;

  PetscFunctionBeginUser;
  if (!SearchHasPartners(s) || !at->learns) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(s->slaves->n, &among));
  for (PetscInt q = 0; q < s->slaves->n; q++) among[q] = (PetscBool)(lists->nearest[q] < 0 && !lists->averse[q]);
  TestGroups(&(const PointTests){s, field, lists, tree, &sight, at->x, at->normal, among}, at->possible);
  PetscCall(PetscFree(among));
  at->learns = PETSC_FALSE;
  PetscCall(NoteAny(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is what has changed since the last test too little for another answer? */
static PetscBool IsLittle(const Partners *at, PetscReal motion, PetscReal moved, PetscReal turned)
{
  return (PetscBool)(PetscMax(0, motion - at->motion) + moved <= PARTNERS_SKIN * at->thin && turned <= PARTNERS_TURN);
}

/* Does the last test still hold, as far as the motion of nodes alone tells? */
static PetscErrorCode StillHolds(ContactSearch s, const PetscReal *u, PetscReal motion, PetscBool *holds)
{
  const Partners *at = &s->partners;
  PetscReal       moved, turned;

  PetscFunctionBeginUser;
  *holds = PETSC_FALSE;
  if (!s->slaves->face_sf || at->thin == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoundRoughly(s, u, &moved, &turned));
  *holds = IsLittle(at, motion, moved, turned);
  if (*holds) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoundChanges(s, u, &moved, &turned));
  *holds = IsLittle(at, motion, moved, turned);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Allocates what a test leaves. */
static PetscErrorCode MakeRoom(ContactSearch s)
{
  Partners      *at = &s->partners;
  const PetscInt n = s->slaves->n, faces = s->master->n_faces;
  const int      dim = s->mesh->dim;

  PetscFunctionBeginUser;
  /* Not NULL on a rank without slave points, which goes the same way as the others. */
  PetscCall(PetscMalloc5(n + 1, &at->possible, n * dim, &at->x, 3 * n, &at->normal, 3 * faces, &at->face_normal,
                         s->mesh->n_nodes * dim, &at->u));
  if (s->slaves->face_sf)
    PetscCall(PetscMalloc2(s->slaves->n_nodes * dim, &at->slave_u, LEVERS * (s->slaves->n_faces + faces), &at->lever));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Compares positions and normals with those of the last test, and tests anew where they have changed too much. normals
   are those of SlavePointsNormals(). */
static PetscErrorCode TestAnew(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal *normals)
{
  Partners       *at = &s->partners;
  const PetscInt  n = s->slaves->n, faces = s->master->n_faces;
  const int       dim   = s->mesh->dim;
  const PetscBool first = (PetscBool)(at->thin == 0);
  PetscReal      *x, *normal, *face_normal, moved = 0, turned = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n * dim, &x, 3 * n, &normal, 3 * faces, &face_normal));
  for (PetscInt q = 0; q < n; q++) SlavePointsPosition(s->slaves, q, &x[q * dim]);
  PetscCall(PointNormals(s, u, normals, normal));
  FaceNormals(s, u, t, face_normal);
  if (first) PetscCall(ThinnestPart(s, &at->thin));
  if (first) PetscCall(MakeRoom(s));
  if (!first) PetscCall(Changes(s, u, x, normal, face_normal, &moved, &turned));
  if (first || !IsLittle(at, motion, moved, turned)) {
    PetscCall(PetscArraycpy(at->x, x, n * dim));
    PetscCall(PetscArraycpy(at->normal, normal, 3 * n));
    PetscCall(PetscArraycpy(at->face_normal, face_normal, 3 * faces));
    PetscCall(TestAll(s, u, t, motion));
  }
  PetscCall(PetscFree3(x, normal, face_normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces of the slave on this rank that have a possible point on some rank. */
static PetscErrorCode MarkFaces(SlavePoints points, const PetscBool *possible, PetscBool *faces)
{
  int *at_points, *at_faces;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(points->n_faces, &at_points, points->surface->n_faces, &at_faces));
  for (PetscInt f = 0; f < points->n_faces; f++)
    for (int q = 0; q < FaceRuleOf(points->faces[f].type, points->finer, points->ends[f])->n; q++)
      at_points[f] = at_points[f] || possible[points->first[f] + q];
  PetscCall(PetscSFReduceBegin(points->face_sf, MPI_INT, at_points, at_faces, MPI_MAX));
  PetscCall(PetscSFReduceEnd(points->face_sf, MPI_INT, at_points, at_faces, MPI_MAX));
  for (PetscInt f = 0; f < points->surface->n_faces; f++) faces[f] = (PetscBool)at_faces[f];
  PetscCall(PetscFree2(at_points, at_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchPartners - finds which slave points may have a partner; all others have none.

  Collective

  Input Parameters:
+ s      - the search, after SlavePointsMove() of its slave points
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t      - load parameter
- motion - relative motion (length) for which lists are to be good

  Output Parameter:
. normals - normals[3*n] of the slave points, as SlavePointsNormals() gives them: of those that may have a partner, or
            of all where lists keep all faces

  Note:
  The answer is in the search's partners. Boxes are seen farther than a search would by a skin, and normals count as
  opposed earlier. As long as nothing has moved or turned by more, the last answer is kept: a point that it leaves out
  has no facet that opposes it, within the reach of a search and not hidden by its own body.

  Source: Verlet, Computer experiments on classical fluids, Phys. Rev. 159 (1967) 98-103, for the skin.
@*/
PetscErrorCode SearchPartners(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, PetscReal *normals)
{
  PetscBool holds;

  PetscFunctionBeginUser;
  PetscCall(StillHolds(s, u, motion, &holds));
  if (!holds)
    PetscCall(TestAnew(s, u, t, motion, normals));
  else if (s->partners.any)
    PetscCall(
      SlavePointsNormals(s->slaves, s->n_images, s->images, u, s->keeps_faces ? NULL : s->partners.possible, normals));
  else if (s->keeps_faces)
    PetscCall(PetscArrayzero(normals, 3 * s->slaves->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchFindsNothing - says whether no slave point on any rank can have a partner, so that lists would be empty.

  Collective

  Input Parameters:
+ s      - the search
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t      - load parameter
- motion - relative motion (length) for which lists are to be good

  Output Parameter:
. nothing - the same on all ranks
@*/
PetscErrorCode SearchFindsNothing(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion,
                                  PetscBool *nothing)
{
  PetscReal *normals;

  PetscFunctionBeginUser;
  *nothing = PETSC_FALSE;
  if (!SearchHasPartners(s)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(3 * s->slaves->n, &normals));
  PetscCall(SlavePointsMove(s->slaves, u, t));
  PetscCall(SearchPartners(s, u, t, motion, normals));
  PetscCall(PetscFree(normals));
  *nothing = (PetscBool)!s->partners.any;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchPartnersFaces - finds the faces of the slave on this rank on which a point may have a partner.

  Collective

  Input Parameters:
+ s      - the search
. u      - local displacements u[mesh n_nodes*dim] (length), ghosts included
. t      - load parameter
- motion - relative motion (length) for which lists are to be good

  Output Parameter:
. faces - faces[faces of the slave on this rank]

  Note:
  The answer depends on the state at hand alone, not on former tests. It is the same on any number of ranks. Points
count where they are without offsets, and those of other faces have none.
@*/
PetscErrorCode SearchPartnersFaces(ContactSearch s, const PetscReal *u, PetscReal t, PetscReal motion, PetscBool *faces)
{
  const SlavePoints   points = s->slaves;
  const PartnersSight sight  = {s->reach + motion, 0, 0};
  PetscBool          *possible;
  PetscReal          *normal;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(faces, points->surface->n_faces));
  PetscCall(SlavePointsMove(points, u, t));
  PetscCall(PetscMalloc2(points->n, &possible, 3 * points->n, &normal));
  PetscCall(SearchPartners(s, u, t, motion, normal));
  PetscCall(Normalise(points->n, s->partners.possible, normal));
  if (s->partners.any) {
    PetscCall(TestPoints(s, u, t, &sight, normal, s->partners.possible, possible));
    PetscCall(MarkFaces(points, possible, faces));
  }
  PetscCall(PetscFree2(possible, normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  SearchPartnersFree - frees what the tests for partners hold.

  Not collective

  Input Parameter:
. s - the search
@*/
PetscErrorCode SearchPartnersFree(ContactSearch s)
{
  Partners *at = &s->partners;

  PetscFunctionBeginUser;
  if (at->thin > 0) PetscCall(PetscFree5(at->possible, at->x, at->normal, at->face_normal, at->u));
  if (at->thin > 0 && at->lever) PetscCall(PetscFree2(at->slave_u, at->lever));
  PetscFunctionReturn(PETSC_SUCCESS);
}
