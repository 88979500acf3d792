/* Follows rows of long faces around a foot: a walk from face to face, and a polynomial for how far the rows bend. */
#include "facerows.h"
#include "base/smoothstep.h"

/* Length over width of the faces at which supports begin to follow their rows, and from which on they do so wholly.
   Right-angled triangles of equal legs have 1.7, and a support along straight axes does not miss rows of faces of 2. */
#define ROWS_FROM   2
#define ROWS_WHOLLY 4
/* Faces count for a row up to this rho^2, as for lists of points. */
#define ROWS_MARGIN 1.7
/* Cosine of the largest angle between the longest directions of neighbours that are of one row: 45 degrees. Beyond it
   the mesh changes its direction, and the row goes on straight. */
#define ROWS_TURN 0.7
/* Cosine of the largest angle between normals, as for lists of points. */
#define ROWS_FLANK 0.5
/* What is added to the normal equations of the bend, over their sum of weights. It decides only where a row has too few
   faces for all powers, as at the end of a surface; else it changes the bend by less than a thousandth. */
#define ROWS_RIDGE 1e-6
/* How far a row bends aside at the end of the support, over the support's half width, from which on coordinates begin
   to bend with it, and from which on they do so wholly. A straight support still holds a row that bends by a part of
   its width, and the wiggles of uneven faces are far below that. */
#define ROWS_BENDS        0.25
#define ROWS_BENDS_WHOLLY 1.
/* The circle of a row is found in this many passes. Each takes what the higher powers are wrong by to a tenth, and they
   are small. */
#define ROWS_PASSES 4

enum { UNKNOWNS = 3 /* of a row: place and slope at the foot, curvature */ };

/* A face with its moments, in the present position. */
typedef struct {
  PetscReal area, centre[3], covariance[3][3];
  PetscReal along[3], across[3], length, width; /* longest direction in its plane, the other one; extents along them */
  PetscBool known;
} FaceShape;

/* A face that the walk has reached: sums over the ways to it until it is visited, then their mean. */
typedef struct {
  PetscInt  stamp;
  int       ways, own; /* own: of those along its own longest direction, less those against it */
  int       sign;      /* 1 or -1: it lies along its own longest direction or against it; 0: it does not */
  PetscReal s, t;      /* steps across and along the rows from the foot to its centre (length) */
  PetscReal along[3], across[3], length, width; /* directions of the rows there, unit vectors; its extents along them */
} FacePlace;

/* The step from the centre of a face that lies along its own longest direction to a neighbour. */
typedef struct {
  PetscBool known;
  int sign; /* 1 or -1: the neighbour is of its row and lies along its own longest direction or against it; else 0 */
  PetscReal s, t; /* across and along the row (length) */
} FaceStep;

struct _n_FaceRows {
  const SurfaceView *view;
  Neighbourhoods     neighbourhoods;
  FaceShape         *shape;
  FacePlace         *place;
  FaceStep          *step; /* of each link */
  PetscInt          *queue, stamp;
};

/* Sums over the faces around a foot. */
typedef struct {
  PetscReal weight, normal[3], length2, width2, area;
  PetscReal moment[9], place[5]; /* sums of t^k, and of t^k times the places across the row; t over the reach */
  PetscReal turn;                /* of t times the slope of the normals along the row */
} RowSums;

static PetscReal Dot(const PetscReal *a, const PetscReal *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void Cross(const PetscReal *a, const PetscReal *b, PetscReal *c)
{
  for (int d = 0; d < 3; d++) c[d] = a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
}

/* Makes a unit vector of the part of v that is square to the unit vector n. */
static void Flatten(const PetscReal *n, PetscReal *v)
{
  const PetscReal out = Dot(n, v);
  PetscReal       length;

  for (int d = 0; d < 3; d++) v[d] -= out * n[d];
  length = PetscSqrtReal(Dot(v, v));
  for (int d = 0; d < 3 && length > 0; d++) v[d] /= length;
}

/* Root of a face's second moment along a direction. */
static PetscReal Extent(const FaceShape *shape, const PetscReal *direction)
{
  PetscReal sum = 0;

  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) sum += direction[i] * shape->covariance[i][j] * direction[j];
  return PetscSqrtReal(PetscMax(sum, 0));
}

/* Finds the longest direction of a face in its plane. */
static void FindLongest(const PetscReal *normal, FaceShape *shape)
{
  PetscReal e[2][3] = {{0}}, C[2][2] = {{0}}, angle;
  int       least = 0;

  for (int d = 1; d < 3; d++)
    if (PetscAbsReal(normal[d]) < PetscAbsReal(normal[least])) least = d;
  e[0][least] = 1;
  Flatten(normal, e[0]);
  Cross(normal, e[0], e[1]);
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++)
      for (int i = 0; i < 9; i++) C[a][b] += e[a][i / 3] * shape->covariance[i / 3][i % 3] * e[b][i % 3];
  angle = 0.5 * PetscAtan2Real(2 * C[0][1], C[0][0] - C[1][1]);
  for (int d = 0; d < 3; d++) shape->along[d] = PetscCosReal(angle) * e[0][d] + PetscSinReal(angle) * e[1][d];
  Cross(normal, shape->along, shape->across);
  shape->length = Extent(shape, shape->along);
  shape->width  = Extent(shape, shape->across);
}

/* Computes the moments of a face. */
static void MakeShape(FaceRows rows, PetscInt f)
{
  const SurfaceView *view  = rows->view;
  const Facet       *facet = &view->facets[f];
  FaceShape         *shape = &rows->shape[f];
  const FaceRule    *rule  = FaceRuleGet(facet->type, FACE_RULE_PLAIN);
  PetscReal          x[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS], r[FACE_RULE_POINTS][3] = {{0}};

  *shape = (FaceShape){.known = PETSC_TRUE};
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    for (int d = 0; d < 3; d++) x[a * 3 + d] = view->x[facet->nodes[a] * 3 + d];
  FaceRuleAreas(rule, facet->type, 3, GEOMETRY_SOLID, x, area, NULL);
  for (int q = 0; q < rule->n; q++) {
    shape->area += area[q];
    for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
      for (int d = 0; d < 3; d++) r[q][d] += rule->N[q][a] * x[a * 3 + d];
    for (int d = 0; d < 3; d++) shape->centre[d] += area[q] * r[q][d];
  }
  for (int d = 0; d < 3; d++) shape->centre[d] /= shape->area;
  for (int q = 0; q < rule->n; q++)
    for (int i = 0; i < 9; i++)
      shape->covariance[i / 3][i % 3] +=
        area[q] / shape->area * (r[q][i / 3] - shape->centre[i / 3]) * (r[q][i % 3] - shape->centre[i % 3]);
  FindLongest(&view->normals[3 * f], shape);
}

/* The moments of a face, computed when they are asked for first. */
static inline const FaceShape *Shape(FaceRows rows, PetscInt f)
{
  if (!rows->shape[f].known) MakeShape(rows, f);
  return &rows->shape[f];
}

/*@
  FaceRowsCreate - prepares walks over the faces of a view.

  Not collective

  Input Parameters:
+ view           - the faces, in 3D; borrowed, they must outlive the object
- neighbourhoods - their links, likewise

  Output Parameter:
. out - the object
@*/
PetscErrorCode FaceRowsCreate(const SurfaceView *view, Neighbourhoods neighbourhoods, FaceRows *out)
{
  FaceRows rows;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&rows));
  rows->view           = view;
  rows->neighbourhoods = neighbourhoods;
  PetscCall(PetscCalloc3(view->n_facets, &rows->shape, view->n_facets, &rows->place,
                         NeighbourhoodsLinkCount(neighbourhoods), &rows->step));
  PetscCall(PetscMalloc1(view->n_facets, &rows->queue));
  *out = rows;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FaceRowsDestroy - frees the object.

  Not collective

  Input/Output Parameter:
. rows - the object, NULL on return
@*/
PetscErrorCode FaceRowsDestroy(FaceRows *rows)
{
  PetscFunctionBeginUser;
  if (!*rows) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*rows)->shape, (*rows)->place, (*rows)->step));
  PetscCall(PetscFree((*rows)->queue));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a face that lies along its own longest direction, or against it, its directions and extents. */
static void PlaceOwn(const FaceShape *shape, int sign, FacePlace *place)
{
  place->sign = sign;
  for (int d = 0; d < 3; d++) {
    place->along[d]  = sign * shape->along[d];
    place->across[d] = sign * shape->across[d];
  }
  place->length = shape->length;
  place->width  = shape->width;
}

/* Is a neighbour of the row that has the direction `along` at a face: is it long, and does its own direction turn from
   that one, laid into its plane, by little? */
static PetscBool OfRow(const FaceShape *shape, const PetscReal *normal, const PetscReal *along)
{
  return (PetscBool)(shape->length > ROWS_FROM * shape->width &&
                     PetscSqr(Dot(along, shape->along)) > ROWS_TURN * ROWS_TURN * (1 - PetscSqr(Dot(along, normal))));
}

/* Finds the step from a face with the directions of `at` to a neighbour, along the mean of their directions. `there`
   returns the direction of the rows at the neighbour. */
static FaceStep FindStep(FaceRows rows, PetscInt from, PetscInt to, const FacePlace *at, PetscReal there[3])
{
  const FaceShape *shape  = Shape(rows, to);
  const PetscReal *normal = &rows->view->normals[3 * to];
  FaceStep         found  = {.known = PETSC_TRUE};
  PetscReal        way[3], mean[2][3], across[3];

  if (OfRow(shape, normal, at->along)) {
    found.sign = Dot(at->along, shape->along) > 0 ? 1 : -1;
    for (int d = 0; d < 3; d++) {
      there[d]  = found.sign * shape->along[d];
      across[d] = found.sign * shape->across[d];
    }
  } else {
    for (int d = 0; d < 3; d++) there[d] = at->along[d];
    Flatten(normal, there);
    Cross(normal, there, across);
  }
  for (int d = 0; d < 3; d++) {
    way[d]     = shape->centre[d] - rows->shape[from].centre[d];
    mean[0][d] = at->across[d] + across[d];
    mean[1][d] = at->along[d] + there[d];
  }
  found.s = Dot(way, mean[0]) / PetscSqrtReal(Dot(mean[0], mean[0]));
  found.t = Dot(way, mean[1]) / PetscSqrtReal(Dot(mean[1], mean[1]));
  return found;
}

/* Adds the way from a face to the neighbour across link number `link`. Between faces that lie along their own
   directions all walks go the same step, or its opposite, so that it is found once. */
static void AddWay(FaceRows rows, PetscInt from, PetscInt to, PetscInt link)
{
  const FacePlace *at   = &rows->place[from];
  FacePlace       *next = &rows->place[to];
  FaceStep         step = rows->step[link];
  PetscReal        there[3];

  if (step.known && at->sign) {
    step.sign *= at->sign;
    step.s *= at->sign;
    step.t *= at->sign;
    for (int d = 0; d < 3; d++) there[d] = step.sign * rows->shape[to].along[d];
  } else {
    step = FindStep(rows, from, to, at, there);
    if (at->sign && step.sign)
      rows->step[link] = (FaceStep){PETSC_TRUE, at->sign * step.sign, at->sign * step.s, at->sign * step.t};
  }
  next->own += step.sign;
  for (int d = 0; d < 3; d++) next->along[d] += there[d];
  next->s += at->s + step.s;
  next->t += at->t + step.t;
  next->ways++;
}

/* Takes the mean over the ways to a face. */
static void TakePlace(FaceRows rows, PetscInt f)
{
  const PetscReal *normal = &rows->view->normals[3 * f];
  const FaceShape *shape  = &rows->shape[f];
  FacePlace       *place  = &rows->place[f];

  place->s /= place->ways;
  place->t /= place->ways;
  if (PetscAbsInt(place->own) == place->ways) {
    PlaceOwn(shape, place->own > 0 ? 1 : -1, place);
    return;
  }
  Flatten(normal, place->along);
  Cross(normal, place->along, place->across);
  place->length = Extent(shape, place->along);
  place->width  = Extent(shape, place->across);
}

/* Adds a face to the sums, with its place seen from the foot along and across the row. */
static void AddFace(FaceRows rows, PetscInt f, PetscReal rho2, const PetscReal foot[3], const PetscReal *along,
                    const PetscReal *across, PetscReal reach, RowSums *sums)
{
  const FaceShape *shape  = &rows->shape[f];
  const FacePlace *place  = &rows->place[f];
  const PetscReal *normal = &rows->view->normals[3 * f], weight = PetscSqr(1 - rho2 / ROWS_MARGIN);
  PetscReal        x[3], t, power = weight;

  for (int d = 0; d < 3; d++) x[d] = shape->centre[d] - foot[d];
  t = Dot(x, along) / reach;
  sums->weight += weight;
  sums->length2 += weight * PetscSqr(place->length);
  sums->width2 += weight * PetscSqr(place->width);
  sums->area += weight * shape->area / SurfaceNodesPerFace(rows->view->facets[f].type);
  for (int d = 0; d < 3; d++) sums->normal[d] += weight * shape->area * normal[d];
  sums->turn -= weight * t * Dot(normal, along);
  for (int k = 0; k < 9; k++, power *= t) {
    sums->moment[k] += power;
    if (k < 5) sums->place[k] += power * (Dot(x, across) - place->s);
  }
}

/* Solves the normal equations of the row's place c[0] + c[1] t + c[2] (t^2 + cubic t^3 + quartic t^4) by Gauss'
   elimination; they are positive definite by the ridge. */
static void SolveRow(const RowSums *sums, PetscReal cubic, PetscReal quartic, PetscReal c[UNKNOWNS])
{
  const PetscReal *m = sums->moment;
  PetscReal        A[UNKNOWNS][UNKNOWNS];

  for (int k = 0; k < UNKNOWNS - 1; k++) {
    A[k][0] = m[k];
    A[k][1] = m[k + 1];
    A[k][2] = A[2][k] = m[k + 2] + cubic * m[k + 3] + quartic * m[k + 4];
    c[k]              = sums->place[k];
  }
  A[2][2] = m[4] + cubic * (2 * m[5] + cubic * m[6]) + quartic * (2 * m[6] + 2 * cubic * m[7] + quartic * m[8]);
  c[2]    = sums->place[2] + cubic * sums->place[3] + quartic * sums->place[4];
  for (int k = 1; k < UNKNOWNS; k++) A[k][k] += ROWS_RIDGE * sums->weight;
  for (int k = 0; k < UNKNOWNS; k++) {
    for (int i = k + 1; i < UNKNOWNS; i++) {
      const PetscReal share = A[i][k] / A[k][k];

      for (int l = k; l < UNKNOWNS; l++) A[i][l] -= share * A[k][l];
      c[i] -= share * c[k];
    }
  }
  for (int k = UNKNOWNS - 1; k >= 0; k--) {
    for (int l = k + 1; l < UNKNOWNS; l++) c[k] -= A[k][l] * c[l];
    c[k] /= A[k][k];
  }
}

/* Finds slope and bend of the row at the foot. The row is taken for a circle of curvature K in space. In the tangent
   plane, where the part of K is k, it bends aside by k (t^2/2 + K^2 t^4/8 + ...). Seen along a direction that is off by
   a slope there is also a cubic term, slope k^2 t^3/2. */
static void FindBend(const RowSums *sums, const PetscReal radius[2], FaceRow *row, PetscReal *slope)
{
  const PetscReal out = sums->turn / sums->moment[2]; /* the part of K square to the plane, times the reach */
  PetscReal       c[UNKNOWNS], cubic = 0, quartic = PetscSqr(out) / 4, aside;

  for (int pass = 0; pass < ROWS_PASSES; pass++) {
    SolveRow(sums, cubic, quartic, c);
    cubic   = 2 * c[2] * c[1] / PetscSqr(radius[1]);
    quartic = PetscSqr(out) / 4 + PetscSqr(c[2] / radius[1]);
  }
  aside      = PetscAbsReal(c[2]) / radius[0];
  *slope     = c[1] / radius[1];
  row->bends = row->share * SmoothStep((aside - ROWS_BENDS) / (ROWS_BENDS_WHOLLY - ROWS_BENDS));
  row->h[0]  = row->bends * c[2] / PetscSqr(radius[1]);
  row->h[1]  = row->h[0] * quartic / PetscSqr(radius[1]);
}

/* Adds the ways from a face to its neighbours that were not reached in an earlier ring, and queues new ones. */
static void Spread(FaceRows rows, PetscInt start, PetscInt f, PetscInt *tail)
{
  const PetscReal *normals = rows->view->normals;
  const PetscInt  *links;
  PetscInt         first, n = NeighbourhoodsLinks(rows->neighbourhoods, f, &first, &links);

  for (PetscInt k = 0; k < n; k++) {
    FacePlace *place = &rows->place[links[k]];

    if (place->stamp == rows->stamp || Dot(&normals[3 * links[k]], &normals[3 * start]) < ROWS_FLANK) continue;
    if (place->stamp != -rows->stamp) {
      *place                 = (FacePlace){.stamp = -rows->stamp};
      rows->queue[(*tail)++] = links[k];
    }
    AddWay(rows, f, links[k], first + k);
  }
}

/* Walks over the faces around a foot, one ring of links after the other, so that the ways to a face do not depend on
   the order of the faces. The stamp of a face is negative until its ring is complete. radius: of the support across and
   along the row (length). */
static void Walk(FaceRows rows, PetscInt start, const PetscReal foot[3], const PetscReal *along,
                 const PetscReal *across, const PetscReal radius[2], RowSums *sums)
{
  PetscInt head = 0, end = 1, tail = 1;

  rows->queue[0] = start;
  while (head < end) {
    for (; head < end; head++) {
      const PetscInt   f  = rows->queue[head];
      const FacePlace *at = &rows->place[f];
      PetscReal        rho2;

      if (f != start) TakePlace(rows, f);
      rho2 = PetscSqr(at->s / radius[0]) + PetscSqr(at->t / radius[1]);
      if (rho2 >= ROWS_MARGIN && f != start) continue;
      if (rho2 < ROWS_MARGIN) AddFace(rows, f, rho2, foot, along, across, radius[1], sums);
      Spread(rows, start, f, &tail);
    }
    for (; end < tail; end++) rows->place[rows->queue[end]].stamp = rows->stamp;
  }
}

/*@
  FaceRowsFollow - finds how the rows of long faces around a foot run.

  Not collective

  Input Parameters:
+ rows    - the object
. start   - face of the foot
. foot    - the foot (length)
. upright - unit normal of the tangent plane in which the bend is measured
- support - radius of the support in spacings

  Output Parameter:
. row - the rows; their share is 0 where faces are about as long as wide, at no more than the cost of a face's moments
@*/
PetscErrorCode FaceRowsFollow(FaceRows rows, PetscInt start, const PetscReal foot[3], const PetscReal upright[3],
                              PetscReal support, FaceRow *row)
{
  const FaceShape *shape = Shape(rows, start);
  const PetscReal  size  = support * PetscSqrtReal(shape->area / SurfaceNodesPerFace(rows->view->facets[start].type)),
                  aspect = shape->length / shape->width,
                  radius[2] = {size / PetscSqrtReal(aspect), size * PetscSqrtReal(aspect)};
  FacePlace *place          = &rows->place[start];
  RowSums    sums           = {0};
  PetscReal  v[3], across[3], slope, length;

  PetscFunctionBeginUser;
  row->share = 0;
  if (!(aspect > ROWS_FROM) || PetscIsInfReal(aspect)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < 3; d++) {
    v[d]          = shape->centre[d] - foot[d];
    row->along[d] = shape->along[d];
  }
  *place = (FacePlace){.stamp = ++rows->stamp, .ways = 1, .s = Dot(v, shape->across), .t = Dot(v, shape->along)};
  PlaceOwn(shape, 1, place);
  Flatten(upright, row->along);
  Cross(upright, row->along, across);
  Walk(rows, start, foot, row->along, across, radius, &sums);
  if (!(sums.weight > 0)) PetscFunctionReturn(PETSC_SUCCESS); /* the foot is far from the face */
  row->length2 = sums.length2 / sums.weight;
  row->width2  = sums.width2 / sums.weight;
  row->area    = sums.area / sums.weight;
  row->share =
    SmoothStep((PetscSqrtReal(row->length2 / row->width2) - ROWS_FROM) / (PetscReal)(ROWS_WHOLLY - ROWS_FROM));
  length = PetscSqrtReal(Dot(sums.normal, sums.normal));
  for (int d = 0; d < 3; d++) row->normal[d] = sums.normal[d] / length;
  FindBend(&sums, radius, row, &slope);
  for (int d = 0; d < 3; d++) row->along[d] += slope * across[d];
  Flatten(upright, row->along);
  PetscFunctionReturn(PETSC_SUCCESS);
}
