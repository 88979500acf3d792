/* Walks from facet to facet around a foot and gathers the fit points within the support. */
#include "neighbourhood.h"
#include "base/lanes.h"
#include "smooth/diffusefit.h"

typedef struct {
  PetscInt a, b, facet; /* points of the edge, a < b (2D: the end twice) */
} SharedEdge;

struct _n_Neighbourhoods {
  const SurfaceView *view;
  PetscInt          *link_ptr, *link; /* facets across the edges that are not sharp, as compressed rows */
  PetscBool         *sharp, *folded;  /* of each facet: it has a sharp edge; the surface is folded at an edge of it */
  PetscReal         *place[3];        /* of each point, one component each; in 2D the third one is along the hoop */
  PetscReal         *corners;         /* the same of the nodes of each facet, with room for `room` of them */
  int                room;            /* whole vectors */
  PetscInt          *seen_facet, *seen_point, stamp;
  PetscInt          *queue;
  PetscReal         *rho2; /* of the points found */
  PetscInt          *reach;
};

/* Room for the nodes of any facet, in whole vectors */
enum { NODES_ROOM = (FACE_MAX_NODES + LANES - 1) / LANES * LANES };

static int SharedEdgeCompare(const void *p, const void *q)
{
  const SharedEdge *e = p, *f = q;

  if (e->a != f->a) return e->a < f->a ? -1 : 1;
  if (e->b != f->b) return e->b < f->b ? -1 : 1;
  return e->facet < f->facet ? -1 : e->facet > f->facet;
}

static PetscReal Dot(const PetscReal *a, const PetscReal *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Lists the edges of all facets; edges NULL: only counts them. */
static PetscInt ListEdges(const SurfaceView *view, SharedEdge *edges)
{
  PetscInt n = 0;

  for (PetscInt f = 0; f < view->n_facets; f++) {
    const Facet   *facet = &view->facets[f];
    const Element *e     = ElementGet(facet->type);

    for (int k = 0; k < (e->dim == 1 ? 2 : e->edges); k++) {
      const PetscInt a = facet->nodes[e->dim == 1 ? k : e->edge_corners[k][0]],
                     b = facet->nodes[e->dim == 1 ? k : e->edge_corners[k][1]];

      if (edges) edges[n] = (SharedEdge){PetscMin(a, b), PetscMax(a, b), f};
      n++;
    }
  }
  return n;
}

/* Has the surface been folded at an edge between two facets? They belonged to one flank and now belong to two. On which
   side they face each other says nothing: the sides of a fold that has closed cross a little. */
static PetscBool IsFold(const SurfaceView *view, PetscInt f, PetscInt g)
{
  return (PetscBool)(Dot(&view->normals[3 * f], &view->normals[3 * g]) < NEIGHBOURHOOD_COSINE &&
                     Dot(&view->reference[3 * f], &view->reference[3 * g]) >= NEIGHBOURHOOD_COSINE);
}

/* Links every pair of facets that share an edge which is not sharp in the reference configuration. With link NULL it
   only counts the links. Returns the number of pairs. */
static PetscInt LinkFacets(const SurfaceView *view, PetscInt n, const SharedEdge *edges, PetscInt *ptr, PetscInt *link,
                           PetscBool *sharp, PetscBool *folded)
{
  PetscInt count = 0;

  for (PetscInt i = 0; i < n; i++) {
    for (PetscInt j = i + 1; j < n && edges[j].a == edges[i].a && edges[j].b == edges[i].b; j++) {
      const PetscInt f = edges[i].facet, g = edges[j].facet;

      if (!SurfaceViewContinues(view, f, g)) {
        sharp[f] = sharp[g] = PETSC_TRUE;
        continue;
      }
      if (IsFold(view, f, g)) folded[f] = folded[g] = PETSC_TRUE;
      if (link) {
        link[ptr[f]++] = g;
        link[ptr[g]++] = f;
      } else {
        ptr[f + 1]++;
        ptr[g + 1]++;
      }
      count++;
    }
  }
  return count;
}

/* Component d of the place of point p; the third one in 2D is along the hoop. */
static PetscReal Component(const SurfaceView *view, PetscInt p, int d)
{
  return d < view->dim ? view->x[p * view->dim + d] : view->hoop ? view->hoop[p] : 0;
}

/* Writes the components of the facets' nodes, and of quadrature points where there are any, one by one, so that
   distances of several points are found at a time. */
static PetscErrorCode TakePlaces(Neighbourhoods nb)
{
  const SurfaceView *view = nb->view;
  const PetscInt     n    = (view->first ? view->n_points : 0) + LANES;
  int                most = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n, &nb->place[0], n, &nb->place[1], n, &nb->place[2]));
  for (PetscInt p = 0; view->first && p < view->n_points; p++)
    for (int d = 0; d < 3; d++) nb->place[d][p] = Component(view, p, d);
  for (PetscInt f = 0; f < view->n_facets; f++) most = PetscMax(most, ElementGet(view->facets[f].type)->nodes);
  nb->room = LanesGroups(most) * LANES;
  PetscCall(PetscCalloc1(3 * nb->room * view->n_facets, &nb->corners));
  for (PetscInt f = 0; f < view->n_facets; f++)
    for (int d = 0; d < 3; d++)
      for (int a = 0; a < ElementGet(view->facets[f].type)->nodes; a++)
        nb->corners[(3 * f + d) * nb->room + a] = Component(view, view->facets[f].nodes[a], d);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourhoodsCreate - links the facets of a view across their edges.

  Not collective

  Input Parameter:
. view - the facets, borrowed; they must outlive the object

  Output Parameter:
. out - the object
@*/
PetscErrorCode NeighbourhoodsCreate(const SurfaceView *view, Neighbourhoods *out)
{
  Neighbourhoods nb;
  PetscInt       n = ListEdges(view, NULL);
  SharedEdge    *edges;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&nb));
  nb->view = view;
  PetscCall(PetscMalloc1(n, &edges));
  PetscCall(PetscCalloc1(view->n_facets + 1, &nb->link_ptr));
  PetscCall(PetscCalloc2(view->n_facets, &nb->sharp, view->n_facets, &nb->folded));
  ListEdges(view, edges);
  if (n) qsort(edges, n, sizeof(*edges), SharedEdgeCompare);
  PetscCall(PetscMalloc1(2 * LinkFacets(view, n, edges, nb->link_ptr, NULL, nb->sharp, nb->folded), &nb->link));
  for (PetscInt f = 0; f < view->n_facets; f++) nb->link_ptr[f + 1] += nb->link_ptr[f];
  LinkFacets(view, n, edges, nb->link_ptr, nb->link, nb->sharp, nb->folded);
  /* Filling has moved every start to the next one's. */
  for (PetscInt f = view->n_facets; f > 0; f--) nb->link_ptr[f] = nb->link_ptr[f - 1];
  nb->link_ptr[0] = 0;
  PetscCall(PetscFree(edges));
  PetscCall(PetscCalloc2(view->n_facets, &nb->seen_facet, view->n_points, &nb->seen_point));
  PetscCall(PetscMalloc3(view->n_facets, &nb->queue, view->n_points, &nb->reach, view->n_points, &nb->rho2));
  PetscCall(TakePlaces(nb));
  *out = nb;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourhoodsDestroy - frees the links.

  Not collective

  Input/Output Parameter:
. nb - the object, NULL on return
@*/
PetscErrorCode NeighbourhoodsDestroy(Neighbourhoods *nb)
{
  PetscFunctionBeginUser;
  if (!*nb) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree3((*nb)->place[0], (*nb)->place[1], (*nb)->place[2]));
  PetscCall(PetscFree2((*nb)->seen_facet, (*nb)->seen_point));
  PetscCall(PetscFree3((*nb)->queue, (*nb)->reach, (*nb)->rho2));
  PetscCall(PetscFree((*nb)->corners));
  PetscCall(PetscFree((*nb)->link_ptr));
  PetscCall(PetscFree((*nb)->link));
  PetscCall(PetscFree2((*nb)->sharp, (*nb)->folded));
  PetscCall(PetscFree(*nb));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  NeighbourhoodsIsSharp - says whether a facet has an edge at which it meets another one sharply.

  Not collective

  Input Parameters:
+ nb - the object
- f  - the facet
@*/
PetscBool NeighbourhoodsIsSharp(Neighbourhoods nb, PetscInt f)
{
  return nb->sharp[f];
}

/*@
  NeighbourhoodsIsFolded - says whether the surface has been folded at an edge of a facet that is not sharp in the
  reference configuration, so that the facets there look different ways now.

  Not collective

  Input Parameters:
+ nb - the object
- f  - the facet

  Note:
  Such an edge is the tip of a fold or a crease. A fit knows one side of it only.
@*/
PetscBool NeighbourhoodsIsFolded(Neighbourhoods nb, PetscInt f)
{
  return nb->folded[f];
}

/*@
  NeighbourhoodsMeetSharply - says whether two facets that share an edge do not continue each other.

  Not collective

  Input Parameters:
+ nb - the object
. f  - a facet
- g  - another one
@*/
PetscBool NeighbourhoodsMeetSharply(Neighbourhoods nb, PetscInt f, PetscInt g)
{
  for (PetscInt k = nb->link_ptr[f]; k < nb->link_ptr[f + 1]; k++)
    if (nb->link[k] == g) return PETSC_FALSE;
  return PETSC_TRUE;
}

/*@
  NeighbourhoodsLinks - gives the facets across those edges of a facet that are not sharp.

  Not collective

  Input Parameters:
+ nb - the object
- f  - the facet

  Output Parameters:
+ first - number of the first link among all links, whose numbers follow each other
- links - the facets

  Note:
  Returns how many there are.
@*/
PetscInt NeighbourhoodsLinks(Neighbourhoods nb, PetscInt f, PetscInt *first, const PetscInt **links)
{
  *first = nb->link_ptr[f];
  *links = &nb->link[*first];
  return nb->link_ptr[f + 1] - nb->link_ptr[f];
}

/*@
  NeighbourhoodsLinkCount - returns the number of links of all facets, each way counted.

  Not collective

  Input Parameter:
. nb - the object
@*/
PetscInt NeighbourhoodsLinkCount(Neighbourhoods nb)
{
  return nb->link_ptr[nb->view->n_facets];
}

/* Squared distances from x0 in a support of LANES places, of which each component is given. */
LANES_INLINE Lanes Rho2(const PetscReal *x, const PetscReal *y, const PetscReal *z, const PetscReal x0[3],
                        const NeighbourhoodSupport *support)
{
  const PetscReal *metric = support->metric;
  Lanes            a = *(const LanesInArray *)x - x0[0], b = *(const LanesInArray *)y - x0[1],
        c = *(const LanesInArray *)z - x0[2];

  if (support->bent) {
    const PetscReal *along = support->along;
    const Lanes      t = along[0] * a + along[1] * b + along[2] * c, t2 = t * t,
                bend = t2 * (support->h[0] + t2 * support->h[1]);

    a -= bend * support->across[0];
    b -= bend * support->across[1];
    c -= bend * support->across[2];
  }
  return metric[0] * a * a + metric[4] * b * b + metric[8] * c * c +
         2 * (metric[1] * a * b + metric[2] * a * c + metric[5] * b * c);
}

/* Sorts the points by distance, and points at equal distance by number. */
static PetscErrorCode SortReach(Neighbourhoods nb, PetscInt n)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSortRealWithArrayInt(n, nb->rho2, nb->reach));
  for (PetscInt i = 0, j; i < n; i = j) {
    for (j = i + 1; j < n && nb->rho2[j] == nb->rho2[i]; j++) {}
    if (j > i + 1) PetscCall(PetscSortInt(j - i, &nb->reach[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a point to those that were found, if it is within the limit. There is room for all points. */
static inline void ReachAdd(Neighbourhoods nb, PetscInt *count, PetscReal rho2, PetscReal limit, PetscInt point)
{
  nb->rho2[*count]  = rho2;
  nb->reach[*count] = point;
  *count += rho2 <= limit;
}

/* Adds the fit points of a facet within the limit; returns whether there are any. */
static inline PetscBool ReachAddFacet(Neighbourhoods nb, PetscInt *count, PetscInt f, const PetscReal x0[3],
                                      const NeighbourhoodSupport *support, PetscReal limit)
{
  const PetscInt first = nb->view->first[f], points = nb->view->count[f], before = *count;

  for (PetscInt q = 0; q < points; q += LANES) { /* behind the last point there are places without a meaning */
    const PetscInt p    = first + q;
    const Lanes    rho2 = Rho2(&nb->place[0][p], &nb->place[1][p], &nb->place[2][p], x0, support);

    for (PetscInt i = 0; i < PetscMin(LANES, points - q); i++) ReachAdd(nb, count, rho2[i], limit, p + i);
  }
  return (PetscBool)(*count > before);
}

/* Says whether a node of a facet is within the limit. Adds such nodes where they are the fit points. */
static inline PetscBool ReachAddNodes(Neighbourhoods nb, PetscInt *count, PetscInt f, const PetscReal x0[3],
                                      const PetscReal e3[3], const NeighbourhoodSupport *support, PetscReal limit)
{
  const SurfaceView *view   = nb->view;
  const Facet       *facet  = &view->facets[f];
  const int          nodes  = ElementGet(facet->type)->nodes;
  const PetscReal   *x      = &nb->corners[3 * f * nb->room];
  PetscBool          inside = PETSC_FALSE;
  PetscReal          rho2[NODES_ROOM];

  for (int a = 0; a < nodes; a += LANES)
    *(LanesInArray *)&rho2[a] = Rho2(x + a, x + nb->room + a, x + 2 * nb->room + a, x0, support);
  for (int a = 0; a < nodes; a++) {
    const PetscInt p = facet->nodes[a];

    if (!(rho2[a] <= limit)) continue;
    inside = PETSC_TRUE;
    if (view->first || nb->seen_point[p] == nb->stamp) continue;
    nb->seen_point[p] = nb->stamp;
    if (view->geometry[p].weight > 0 && Dot(view->geometry[p].normal, e3) >= NEIGHBOURHOOD_COSINE)
      ReachAdd(nb, count, rho2[a], limit, p);
  }
  return inside;
}

/*@
  NeighbourhoodGather - gathers the points around a foot that a fit may use.

  Not collective

  Input Parameters:
+ nb      - the object
. start   - facet of the foot
. x0      - the foot (length)
. e3      - normal there
. support - the support
. limit   - largest rho^2 in its metric
- max     - most points that are returned

  Output Parameters:
+ points - the points; if not all are returned, the nearest ones by distance, else those of a facet together
. rho2   - rho^2 of these points, valid until the next call
. n      - number of points returned
- found  - number of points within the limit
@*/
PetscErrorCode NeighbourhoodGather(Neighbourhoods nb, PetscInt start, const PetscReal x0[3], const PetscReal e3[3],
                                   const NeighbourhoodSupport *support, PetscReal limit, PetscInt max, PetscInt *points,
                                   const PetscReal **rho2, PetscInt *n, PetscInt *found)
{
  const SurfaceView *view  = nb->view;
  const PetscReal    at[3] = {x0[0], x0[1], view->dim == 3 ? x0[2] : 0};
  PetscInt           head = 0, tail = 0, count = 0;

  PetscFunctionBeginUser;
  nb->stamp++;
  nb->queue[tail++]     = start;
  nb->seen_facet[start] = nb->stamp;
  while (head < tail) {
    const PetscInt f      = nb->queue[head++];
    PetscBool      inside = view->first ? ReachAddFacet(nb, &count, f, at, support, limit) : PETSC_FALSE;

    /* A quadrature point inside shows that the facet reaches into the support, so that its nodes need not be
       examined. */
    if (!inside) inside = ReachAddNodes(nb, &count, f, at, e3, support, limit);
    if (!inside && f != start) continue;
    for (PetscInt k = nb->link_ptr[f]; k < nb->link_ptr[f + 1]; k++) {
      const PetscInt g = nb->link[k];

      if (nb->seen_facet[g] == nb->stamp || Dot(&view->normals[3 * g], e3) < NEIGHBOURHOOD_COSINE) continue;
      nb->seen_facet[g] = nb->stamp;
      nb->queue[tail++] = g;
    }
  }
  if (count > max) PetscCall(SortReach(nb, count));
  *found = count;
  *n     = PetscMin(count, max);
  *rho2  = nb->rho2;
  for (PetscInt i = 0; i < *n; i++) points[i] = nb->reach[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}
