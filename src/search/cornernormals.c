/* Normals of a faceted surface that do not jump from facet to facet. */
#include "cornernormals.h"

/* Corners of a facet at most */
enum { CORNERS = 4 };

struct _n_CornerNormals {
  const SurfaceView *view;
  PetscReal         *normal; /* normal[n_facets][CORNERS][3], of any length */
};

/* Angle of a facet at its corner a (radians); 1 in 2D. */
static PetscReal AngleAt(const SurfaceView *view, PetscInt f, int a)
{
  const Facet *facet   = &view->facets[f];
  const int    corners = ElementGet(facet->type)->corners;
  PetscReal    cosine = 0, length[2] = {0, 0};

  if (view->dim == 2) return 1;
  for (int d = 0; d < 3; d++) {
    const PetscReal here   = view->x[3 * facet->nodes[a] + d],
                    next   = view->x[3 * facet->nodes[(a + 1) % corners] + d] - here,
                    before = view->x[3 * facet->nodes[(a + corners - 1) % corners] + d] - here;

    cosine += next * before;
    length[0] += PetscSqr(next);
    length[1] += PetscSqr(before);
  }
  if (length[0] == 0 || length[1] == 0) return 0;
  return PetscAcosReal(PetscMax(-1, PetscMin(1, cosine / PetscSqrtReal(length[0] * length[1]))));
}

/* Lists of the facets around each point: fan[ptr[p]] to fan[ptr[p + 1] - 1], each with the number of its corner there,
   facet * CORNERS + corner. The caller frees both by PetscFree2(). */
static PetscErrorCode Fans(const SurfaceView *view, PetscInt **ptr, PetscInt **fan)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(view->n_points + 2, ptr, CORNERS * view->n_facets, fan));
  PetscCall(PetscArrayzero(*ptr, view->n_points + 2));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt f = 0; f < view->n_facets; f++)
      for (int a = 0; a < ElementGet(view->facets[f].type)->corners; a++) {
        PetscInt *place = &(*ptr)[view->facets[f].nodes[a] + 2 - pass];

        if (pass) (*fan)[*place] = CORNERS * f + a;
        ++*place;
      }
    for (PetscInt p = 1; !pass && p < view->n_points + 2; p++) (*ptr)[p] += (*ptr)[p - 1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CornerNormalsCreate - finds the mean normals at the corners of all facets. A facet that meets another one sharply does
  not take part in the other one's.

  Not collective

  Input Parameter:
. view - the facets, borrowed; they must outlive the object

  Output Parameter:
. out - the object
@*/
PetscErrorCode CornerNormalsCreate(const SurfaceView *view, CornerNormals *out)
{
  CornerNormals cn;
  PetscInt     *ptr, *fan;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&cn));
  cn->view = view;
  PetscCall(PetscCalloc1(3 * CORNERS * view->n_facets, &cn->normal));
  PetscCall(Fans(view, &ptr, &fan));
  for (PetscInt p = 0; p < view->n_points; p++) {
    for (PetscInt i = ptr[p]; i < ptr[p + 1]; i++) {
      const PetscInt  f     = fan[i] / CORNERS;
      const PetscReal angle = AngleAt(view, f, (int)(fan[i] % CORNERS));

      for (PetscInt k = ptr[p]; k < ptr[p + 1]; k++) {
        if (!SurfaceViewContinues(view, f, fan[k] / CORNERS)) continue;
        for (int d = 0; d < 3; d++) cn->normal[3 * fan[k] + d] += angle * view->normals[3 * f + d];
      }
    }
  }
  PetscCall(PetscFree2(ptr, fan));
  *out = cn;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  CornerNormalsDestroy - frees the normals.

  Not collective

  Input/Output Parameter:
. cn - the object, NULL on return
@*/
PetscErrorCode CornerNormalsDestroy(CornerNormals *cn)
{
  PetscFunctionBeginUser;
  if (!*cn) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree((*cn)->normal));
  PetscCall(PetscFree(*cn));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Shares of the corners of a facet at a place, which is taken to the facet where it lies beside. */
static void CornerShares(const Element *e, const double *xi, double N[CORNERS])
{
  double at[2] = {0, 0}, sum;

  if (e->corners == 3) {
    for (int k = 0; k < 2; k++) at[k] = PetscMax(0, xi[k]);
    sum = PetscMax(1, at[0] + at[1]);
    for (int k = 0; k < 2; k++) at[k] /= sum;
  } else
    for (int k = 0; k < e->dim; k++) at[k] = PetscMax(-1, PetscMin(1, xi[k]));
  ElementShape(e->corners == 2 ? ELEMENT_EDGE2 : e->corners == 3 ? ELEMENT_TRI3 : ELEMENT_QUAD4, at, N, NULL, NULL);
}

/* Unit vector of a corner's normal; 0 where the normals of its facets cancel. */
static void UnitCorner(CornerNormals cn, PetscInt facet, int a, PetscReal normal[3])
{
  const PetscReal *corner = &cn->normal[3 * (CORNERS * facet + a)];
  PetscReal        length = 0;

  for (int d = 0; d < 3; d++) length += PetscSqr(corner[d]);
  length = PetscSqrtReal(length);
  for (int d = 0; d < 3; d++) normal[d] = length > 0 ? corner[d] / length : 0;
}

/*@
  CornerNormalsAt - finds the normal at a place of a facet.

  Not collective

  Input Parameters:
+ cn    - the normals
. facet - the facet
- xi    - the place in reference coordinates

  Output Parameter:
. normal - of length 1; that of the facet where those of the corners cancel
@*/
void CornerNormalsAt(CornerNormals cn, PetscInt facet, const double *xi, PetscReal normal[3])
{
  const Element *e      = ElementGet(cn->view->facets[facet].type);
  PetscReal      length = 0;
  double         N[CORNERS];

  CornerShares(e, xi, N);
  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (int a = 0; a < e->corners; a++) {
    PetscReal corner[3];

    UnitCorner(cn, facet, a, corner);
    for (int d = 0; d < 3; d++) normal[d] += N[a] * corner[d];
  }
  for (int d = 0; d < 3; d++) length += PetscSqr(normal[d]);
  length = PetscSqrtReal(length);
  for (int d = 0; d < 3; d++) normal[d] = length > 0 ? normal[d] / length : cn->view->normals[3 * facet + d];
}

/*@
  CornerNormalsBulge - estimates how far a smooth surface with these normals is off a facet of first order.

  Not collective

  Input Parameters:
+ cn    - the normals
- facet - the facet

  Note:
  Returns a length: along each edge the height of a parabola whose ends have these normals, and across a face the
  heights along two edges. Facets of second order are curved themselves: 0.
@*/
PetscReal CornerNormalsBulge(CornerNormals cn, PetscInt facet)
{
  const SurfaceView *view = cn->view;
  const Facet       *f    = &view->facets[facet];
  const int          dim = view->dim, n = ElementGet(f->type)->corners;
  PetscReal          largest = 0;

  if (ElementGet(f->type)->order > 1) return 0;
  for (int a = 0; a < (dim == 2 ? 1 : n); a++) {
    const int b    = (a + 1) % n;
    PetscReal turn = 0, from[3], to[3];

    UnitCorner(cn, facet, a, from);
    UnitCorner(cn, facet, b, to);
    for (int d = 0; d < dim; d++)
      turn += (to[d] - from[d]) * (view->x[f->nodes[b] * dim + d] - view->x[f->nodes[a] * dim + d]);
    largest = PetscMax(largest, PetscAbsReal(turn) / 8);
  }
  return (dim - 1) * largest;
}
