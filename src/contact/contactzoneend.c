/* What pressures leave of error that do not end where the zone of contact does.

   In surface to surface contact a pressure is a sum of hat functions, and the means of the gaps over these are what
   contact closes. Within faces surfaces overlap and part. A quantity J with the adjoint solution y changes by that by

     -int (z - z_h) g + (p - p_h) dg,

   where g is the gap less the one at which contact begins, dg its change along y, p the pressure and z its rate along
   y; p_h and z_h are those of the terms. That is what is left of the residual of pressures and gaps that are true,
   weighted with the adjoint solution (Becker and Rannacher, Acta Numerica 10, 2001). Where the pressure is smooth,
   hats are near to it. Where the zone ends within a face, they are not: p and z there are those that end as pressures
   do where smooth surfaces part, with the forces and moments of p_h and z_h (kernels/endpressure.h). A patch is the
   faces around a corner of the slave. It counts where one of its faces bears nothing, and where a term presses that
   lies in it: of those that reach beyond it no patch has the moments. Within a face the corners share as the linear
   shape functions do. */
#include "contactimpl.h"
#include "base/vectors.h"
#include "kernels/endpressure.h"
#include "smooth/fitframe.h"

/* Each slave point stands for so many places in each direction of its face: the square root at the end of a zone is not
   smooth. */
enum { PLACES = 6, PLACES_MOST = PLACES * PLACES };
/* Of a patch: force and moments of the pressures, of their rates, the number of pressing terms that lie in it */
enum { SUM_MOMENT, SUM_RATE = SUM_MOMENT + 4, SUM_WHOLE = SUM_RATE + 4, SUMS };
/* Its pressure: the square at the corner and its slopes, those of its rate; the least one; whether there is one */
enum { END_SQUARE, END_RATE = END_SQUARE + 4, END_LEAST = END_RATE + 4, END_IS, END_WIDTH };

typedef struct {
  const ContactPair *pair;
  PetscInt          *face;   /* of each slave point */
  int               *bears;  /* each face bears a force, of any rank's terms */
  PetscReal         *motion; /* of the contact nodes along y */
  PetscReal         *along;  /* changes of the gaps of the slave points along y; NaN: not known yet */
  PetscReal         *rate;   /* of the pressure of each term along y */
  PetscReal         *end;    /* of each node of the slave points [END_WIDTH] */
  PetscReal         *at;     /* of each slave point: PointAt() */
} ZoneEnd;

static int Corners(const ZoneEnd *z, PetscInt f)
{
  return ElementGet(z->pair->slaves->faces[f].type)->corners;
}

/* Finds the change of the gap of a point along y, unless it is known. */
static PetscErrorCode FindAlong(const ZoneEnd *z, PetscInt q)
{
  const ContactPair *pair = z->pair;

  PetscFunctionBeginUser;
  if (!PetscIsNanReal(z->along[q]) || PetscIsNanReal(pair->point_gap[q])) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactVariationsAlong(pair, q, z->motion, &z->along[q]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the rates of the pressures along y. */
static PetscErrorCode FindRates(ZoneEnd *z)
{
  const ContactPair *pair = z->pair;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area, sum = 0;

    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    if (!(value.stiffness > 0)) continue;
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      const PetscInt q = pair->term_point[k];

      PetscCall(FindAlong(z, q));
      if (!PetscIsNanReal(z->along[q])) sum += pair->term_weight[k] * pair->factor[q] * z->along[q];
    }
    z->rate[c] = -value.stiffness * sum / area;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Marks the faces that bear a force. */
static PetscErrorCode FindBearing(ZoneEnd *z)
{
  const ContactPair *pair   = z->pair;
  const SlavePoints  slaves = pair->slaves;
  int               *home;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slaves->surface->n_faces, &home));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    for (PetscInt k = pair->term_ptr[c]; value.pressure > 0 && k < pair->term_ptr[c + 1]; k++)
      if (pair->term_weight[k] > 0) z->bears[z->face[pair->term_point[k]]] = 1;
  }
  PetscCall(PetscSFReduceBegin(slaves->face_sf, MPI_INT, z->bears, home, MPI_MAX));
  PetscCall(PetscSFReduceEnd(slaves->face_sf, MPI_INT, z->bears, home, MPI_MAX));
  PetscCall(PetscSFBcastBegin(slaves->face_sf, MPI_INT, home, z->bears, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(slaves->face_sf, MPI_INT, home, z->bears, MPI_REPLACE));
  PetscCall(PetscFree(home));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a point's share of a term to the sums of the corners of its face. count: points of the term in each patch. */
static void AddPoint(const ZoneEnd *z, PetscInt q, PetscReal force, PetscReal rate, PetscInt *count, PetscReal *sums)
{
  const SlavePoints slaves = z->pair->slaves;
  const Facet      *facet  = &slaves->faces[z->face[q]];
  const int         dim    = z->pair->mesh->dim;

  for (int k = 0; k < Corners(z, z->face[q]); k++) {
    const PetscInt node = facet->nodes[k];
    PetscReal     *sum  = &sums[node * SUMS];

    count[node]++;
    sum[SUM_MOMENT] += force;
    sum[SUM_RATE] += rate;
    for (int d = 0; d < dim; d++) {
      const PetscReal x = z->pair->lists->slave_X[q * dim + d] - slaves->nodes[node].X[d];

      sum[SUM_MOMENT + 1 + d] += force * x;
      sum[SUM_RATE + 1 + d] += rate * x;
    }
  }
}

/* Adds a term that presses. count: zeros, and again afterwards. */
static void AddTerm(const ZoneEnd *z, PetscInt c, PetscReal pressure, PetscInt *count, PetscReal *sums)
{
  const ContactPair *pair   = z->pair;
  const PetscInt     points = pair->term_ptr[c + 1] - pair->term_ptr[c], *point = &pair->term_point[pair->term_ptr[c]];

  for (PetscInt k = 0; k < points; k++) {
    const PetscReal weight = pair->term_weight[pair->term_ptr[c] + k] * pair->factor[point[k]];

    AddPoint(z, point[k], weight * pressure, weight * z->rate[c], count, sums);
  }
  for (PetscInt k = 0; k < points; k++) {
    const Facet *facet = &pair->slaves->faces[z->face[point[k]]];

    for (int a = 0; a < Corners(z, z->face[point[k]]); a++) {
      const PetscInt node = facet->nodes[a];

      if (count[node] == points) sums[node * SUMS + SUM_WHOLE]++;
      count[node] = 0;
    }
  }
}

/* Sums up the patches, over all ranks at the owners of their corners. at_owner: [local nodes][SUMS]. */
static PetscErrorCode SumPatches(const ZoneEnd *z, PetscReal *at_owner)
{
  const ContactPair *pair   = z->pair;
  const SlavePoints  slaves = pair->slaves;
  PetscReal         *sums;
  PetscInt          *count;
  MPI_Datatype       block;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(slaves->n_nodes * SUMS, &sums, slaves->n_nodes, &count));
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
    if (value.pressure > 0) AddTerm(z, c, value.pressure, count, sums);
  }
  PetscCallMPI(MPI_Type_contiguous(SUMS, MPIU_REAL, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCall(PetscSFReduceBegin(slaves->sf, block, sums, at_owner, MPI_SUM));
  PetscCall(PetscSFReduceEnd(slaves->sf, block, sums, at_owner, MPI_SUM));
  PetscCallMPI(MPI_Type_free(&block));
  PetscCall(PetscFree2(sums, count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The directions of a face from its first corner: along its first edge, in space another one normal to that, and the
   face's normal, of its size. */
static void FaceFrame(const ZoneEnd *z, PetscInt f, PetscReal along[2][3], PetscReal normal[3])
{
  const SlavePoints slaves = z->pair->slaves;
  const Facet      *facet  = &slaves->faces[f];
  const int         dim = z->pair->mesh->dim, corners = Corners(z, f);
  PetscReal         edge[2][3] = {{0}}, length = 0;

  for (int d = 0; d < dim; d++) {
    edge[0][d] = slaves->nodes[facet->nodes[1]].X[d] - slaves->nodes[facet->nodes[0]].X[d];
    edge[1][d] = slaves->nodes[facet->nodes[corners - 1]].X[d] - slaves->nodes[facet->nodes[0]].X[d];
    length += PetscSqr(edge[0][d]);
  }
  if (dim == 2) edge[1][0] = edge[1][1] = 0;
  if (dim == 2) edge[1][2] = 1;
  for (int d = 0; d < 3; d++) along[0][d] = edge[0][d] / PetscSqrtReal(length);
  Cross(edge[0], edge[1], normal);
  Cross(normal, along[0], along[1]);
  length = PetscSqrtReal(Dot(normal, normal));
  for (int d = 0; d < 3; d++) along[1][d] /= length;
}

/* Lists the places for which a point stands, in space in a square with its share of the face. Returns their number. */
static int PointPlaces(const ZoneEnd *z, PetscInt q, PetscReal along[2][3], PetscReal place[PLACES_MOST][3])
{
  const SlavePoints slaves = z->pair->slaves;
  const PetscInt    f      = z->face[q];
  const int         dim = z->pair->mesh->dim, rows = dim == 3 ? PLACES : 1;
  PetscReal         all = 0, size;

  for (PetscInt k = slaves->first[f]; k < slaves->first[f + 1]; k++) all += slaves->weight[k];
  size = slaves->size[q] * PetscPowReal(slaves->weight[q] / all, 1. / (dim - 1));
  for (int i = 0; i < rows; i++) {
    for (int j = 0; j < PLACES; j++) {
      const PetscReal at[2] = {((j + 0.5) / PLACES - 0.5) * size, dim == 3 ? ((i + 0.5) / PLACES - 0.5) * size : 0};

      for (int d = 0; d < dim; d++)
        place[i * PLACES + j][d] = z->pair->lists->slave_X[q * dim + d] + at[0] * along[0][d] + at[1] * along[1][d];
    }
  }
  return rows * PLACES;
}

/* The faces around a corner, with coordinates in their plane over their size, from the corner */
typedef struct {
  PetscInt         n;
  const PetscInt  *face;
  const PetscReal *corner;
  PetscReal        axis[3][3]; /* coordinates by distances (one over length), and the faces' normal */
} Patch;

/* Finds the coordinates of a patch. room: for its places. */
static void PatchFrame(const ZoneEnd *z, Patch *patch, int *room)
{
  const SlavePoints slaves    = z->pair->slaves;
  PetscReal         normal[3] = {0, 0, 0}, size = 0;

  *room = 0;
  for (PetscInt i = 0; i < patch->n; i++) {
    const PetscInt f = patch->face[i];
    PetscReal      along[2][3], of_face[3];

    FaceFrame(z, f, along, of_face);
    for (int d = 0; d < 3; d++) normal[d] += of_face[d];
    *room += (int)(slaves->first[f + 1] - slaves->first[f]) * PLACES_MOST;
    size = PetscMax(size, slaves->size[slaves->first[f]]);
  }
  FitFrameFromNormal(z->pair->mesh->dim, normal, patch->axis);
  for (int k = 0; k < z->pair->mesh->dim - 1; k++)
    for (int d = 0; d < 3; d++) patch->axis[k][d] /= size;
}

/* The terms of a place, or of moments: the first one, and the others by distances from the corner. */
static void PatchTerms(int dim, const Patch *patch, PetscReal first, const PetscReal *distance, PetscReal *term)
{
  term[0] = first;
  for (int a = 0; a < dim - 1; a++) {
    term[1 + a] = 0;
    for (int d = 0; d < dim; d++) term[1 + a] += distance[d] * patch->axis[a][d];
  }
}

/* Lists the places of a patch. Returns their number. */
static int PatchPlaces(const ZoneEnd *z, const Patch *patch, PetscReal *term, PetscReal *weight)
{
  const SlavePoints slaves = z->pair->slaves;
  const int         dim    = z->pair->mesh->dim;
  int               n      = 0;

  for (PetscInt i = 0; i < patch->n; i++) {
    PetscReal along[2][3], normal[3], place[PLACES_MOST][3];

    FaceFrame(z, patch->face[i], along, normal);
    for (PetscInt q = slaves->first[patch->face[i]]; q < slaves->first[patch->face[i] + 1]; q++) {
      const int places = PointPlaces(z, q, along, place);

      for (int k = 0; k < places; k++, n++) {
        for (int d = 0; d < dim; d++) place[k][d] -= patch->corner[d];
        PatchTerms(dim, patch, 1, place[k], &term[n * dim]);
        weight[n] = slaves->weight[q] * z->pair->scene->share * z->pair->factor[q] / places;
      }
    }
  }
  return n;
}

/* Fits the pressure of one patch. */
static PetscErrorCode FitPatch(const ZoneEnd *z, Patch *patch, const PetscReal *sum, PetscReal *end)
{
  const int   dim = z->pair->mesh->dim;
  PetscReal   moment[ENDPRESSURE_TERMS], rate[ENDPRESSURE_TERMS], *term, *weight;
  int         room, places;
  EndPressure fit;

  PetscFunctionBeginUser;
  PatchFrame(z, patch, &room);
  PetscCall(PetscMalloc2(room * dim, &term, room, &weight));
  places = PatchPlaces(z, patch, term, weight);
  PatchTerms(dim, patch, sum[SUM_MOMENT], &sum[SUM_MOMENT + 1], moment);
  PatchTerms(dim, patch, sum[SUM_RATE], &sum[SUM_RATE + 1], rate);
  end[END_IS] = EndPressureFit(dim, places, PetscPowReal((PetscReal)patch->n / places, 1. / (dim - 1)) / 2, term,
                               weight, moment, rate, &fit);
  PetscCall(PetscFree2(term, weight));
  if (!(end[END_IS] > 0)) PetscFunctionReturn(PETSC_SUCCESS);
  end[END_SQUARE] = fit.square[0];
  end[END_LEAST]  = fit.least;
  end[END_RATE]   = fit.rate[0];
  for (int d = 0; d < dim; d++)
    for (int a = 0; a < dim - 1; a++) {
      end[END_SQUARE + 1 + d] += fit.square[1 + a] * patch->axis[a][d];
      end[END_RATE + 1 + d] += fit.rate[1 + a] * patch->axis[a][d];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the faces around the corners of this rank: those of node i are list[ptr[i]] to list[ptr[i + 1] - 1]. */
static PetscErrorCode ListFaces(const ZoneEnd *z, PetscInt **ptr, PetscInt **list)
{
  const SlavePoints slaves = z->pair->slaves;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slaves->n_nodes + 2, ptr));
  for (PetscInt f = 0; f < slaves->n_faces; f++)
    for (int k = 0; k < Corners(z, f); k++) (*ptr)[slaves->faces[f].nodes[k] + 2]++;
  for (PetscInt i = 0; i <= slaves->n_nodes; i++) (*ptr)[i + 1] += (*ptr)[i];
  PetscCall(PetscMalloc1((*ptr)[slaves->n_nodes + 1], list));
  for (PetscInt f = 0; f < slaves->n_faces; f++)
    for (int k = 0; k < Corners(z, f); k++) (*list)[(*ptr)[slaves->faces[f].nodes[k] + 1]++] = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fits the patches at the end of the zone, each where its corner is owned, and tells all ranks. */
static PetscErrorCode FitPatches(ZoneEnd *z)
{
  const SlavePoints slaves = z->pair->slaves;
  const Mesh        mesh   = z->pair->mesh;
  PetscInt         *ptr, *list;
  PetscReal        *sums, *ends;
  MPI_Datatype      block;
  PetscMPIInt       rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscCalloc2(mesh->n_nodes * SUMS, &sums, mesh->n_nodes * END_WIDTH, &ends));
  PetscCall(SumPatches(z, sums));
  PetscCall(ListFaces(z, &ptr, &list));
  for (PetscInt i = 0; i < slaves->n_nodes; i++) {
    const NodeKey   *node      = &slaves->nodes[i];
    const PetscReal *sum       = &sums[node->local * SUMS];
    Patch            patch     = {.n = ptr[i + 1] - ptr[i], .face = &list[ptr[i]], .corner = node->X};
    PetscBool        ends_here = PETSC_FALSE;

    if (node->owner != rank || !(sum[SUM_WHOLE] > 0)) continue;
    for (PetscInt k = ptr[i]; k < ptr[i + 1]; k++) ends_here = (PetscBool)(ends_here || !z->bears[list[k]]);
    if (ends_here) PetscCall(FitPatch(z, &patch, sum, &ends[node->local * END_WIDTH]));
  }
  PetscCallMPI(MPI_Type_contiguous(END_WIDTH, MPIU_REAL, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCall(PetscSFBcastBegin(slaves->sf, block, ends, z->end, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(slaves->sf, block, ends, z->end, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&block));
  PetscCall(PetscFree(ptr));
  PetscCall(PetscFree(list));
  PetscCall(PetscFree2(sums, ends));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure of a patch and its rate, the means over the places of a point. */
static void PatchAt(const ZoneEnd *z, PetscInt node, int places, PetscReal place[PLACES_MOST][3], PetscReal *p,
                    PetscReal *rate)
{
  const PetscReal *end = &z->end[node * END_WIDTH], *X = z->pair->slaves->nodes[node].X;

  *p = *rate = 0;
  for (int k = 0; k < places; k++) {
    PetscReal square = end[END_SQUARE], square_rate = end[END_RATE], p_at, rate_at;

    for (int d = 0; d < z->pair->mesh->dim; d++) {
      square += end[END_SQUARE + 1 + d] * (place[k][d] - X[d]);
      square_rate += end[END_RATE + 1 + d] * (place[k][d] - X[d]);
    }
    EndPressureAt(square, square_rate, end[END_LEAST], &p_at, &rate_at);
    *p += p_at / places;
    *rate += rate_at / places;
  }
}

/* Adds up what the corners of a point's face with a pressure of their own say at the point: their shares, the pressure
   and its rate times these. */
static void PointAt(const ZoneEnd *z, PetscInt q, PetscReal *share, PetscReal *p, PetscReal *rate)
{
  const SlavePoints slaves = z->pair->slaves;
  const PetscInt    f      = z->face[q];
  const Facet      *facet  = &slaves->faces[f];
  const FaceRule   *rule   = FaceRuleOf(facet->type, slaves->finer, slaves->ends[f]);
  PetscReal         along[2][3], normal[3], place[PLACES_MOST][3], N[FACE_MAX_NODES];
  int               places = 0;

  *share = *p = *rate = 0;
  ElementShape(ElementCornerType(z->pair->mesh->dim - 1, Corners(z, f)), rule->xi[q - slaves->first[f]], N, NULL, NULL);
  for (int k = 0; k < Corners(z, f); k++) {
    PetscReal p_at, rate_at;

    if (!(z->end[facet->nodes[k] * END_WIDTH + END_IS] > 0)) continue;
    if (!places) {
      FaceFrame(z, f, along, normal);
      places = PointPlaces(z, q, along, place);
    }
    PatchAt(z, facet->nodes[k], places, place, &p_at, &rate_at);
    *share += N[k];
    *p += N[k] * p_at;
    *rate += N[k] * rate_at;
  }
}

/* Adds what a term's points leave. */
static PetscErrorCode AddTermError(const ZoneEnd *z, PetscInt c, PetscReal *error)
{
  const ContactPair *pair   = z->pair;
  const PetscReal    begins = ContactTermOnsetGap(pair, c, pair->t);
  LawValue           value;
  PetscReal          area;

  PetscFunctionBeginUser;
  ContactTermLaw(pair, c, pair->t, &value, NULL, &area);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt   q      = pair->term_point[k];
    const PetscReal  weight = pair->term_weight[k] * pair->factor[q];
    const PetscReal *at     = &z->at[3 * q];

    if (PetscIsNanReal(pair->point_gap[q]) || at[0] == 0) continue;
    PetscCall(FindAlong(z, q));
    *error -= weight * ((at[2] - at[0] * z->rate[c]) * (pair->point_gap[q] - begins) +
                        (at[1] - at[0] * value.pressure) * z->along[q]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up the error over this rank's terms. */
static PetscErrorCode SumError(const ZoneEnd *z, PetscReal *error)
{
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < z->pair->lists->n_slaves; q++)
    PointAt(z, q, &z->at[3 * q], &z->at[3 * q + 1], &z->at[3 * q + 2]);
  *error = 0;
  for (PetscInt c = 0; c < z->pair->n; c++) PetscCall(AddTermError(z, c, error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(const ContactPair *pair, ZoneEnd *z)
{
  const SlavePoints slaves = pair->slaves;

  PetscFunctionBeginUser;
  *z = (ZoneEnd){.pair = pair};
  PetscCall(PetscCalloc7(slaves->n, &z->face, slaves->n_faces, &z->bears, slaves->n, &z->along, 3 * slaves->n, &z->at,
                         pair->n, &z->rate, slaves->n_nodes * END_WIDTH, &z->end,
                         pair->lists->n_nodes * pair->mesh->dim, &z->motion));
  for (PetscInt q = 0; q < slaves->n; q++) z->along[q] = NAN;
  for (PetscInt f = 0; f < slaves->n_faces; f++)
    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++) z->face[q] = f;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums up what the end of a pair's zone leaves in one quantity, on this rank. */
static PetscErrorCode ZoneEndError(Contact contact, ContactPair *pair, const PetscReal *y, PetscReal *error)
{
  ZoneEnd z;

  PetscFunctionBeginUser;
  PetscCall(Create(pair, &z));
  PetscCall(ContactPairMove(contact, pair, y, pair->t, pair->t, z.motion));
  PetscCall(FindRates(&z));
  PetscCall(FindBearing(&z));
  PetscCall(FitPatches(&z));
  PetscCall(SumError(&z, error));
  PetscCall(PetscFree7(z.face, z.bears, z.along, z.at, z.rate, z.end, z.motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairWithinFaces - estimates what a pair leaves of error within faces in some quantities: where the zone of
  contact ends in surface to surface contact, between nodes in node to surface contact.

  Collective

  Input Parameters:
+ contact - the contact, in the state of its last ContactResidual() with forces
. p       - number of the pair
. u       - local displacements of that residual, u[n_nodes*dim] (length)
. n       - number of quantities
- y       - adjoint solution of each, with what it sees of the pair directly, y[n_nodes*dim], ghosts included

  Output Parameters:
+ error - of each: true less computed value, the same on all ranks
- known - PETSC_FALSE: not known with friction, which follows the pressures, nor between nodes of first order
@*/
PetscErrorCode ContactPairWithinFaces(Contact contact, int p, const PetscReal *u, int n, PetscReal *const y[],
                                      PetscReal error[], PetscBool *known)
{
  ContactPair *pair = &contact->pairs[p];

  PetscFunctionBeginUser;
  for (int i = 0; i < n; i++) error[i] = 0;
  *known = (PetscBool)(!pair->friction && (pair->formulation.surface || pair->slave->order > 1));
  if (!*known) PetscFunctionReturn(PETSC_SUCCESS);
  if (pair->formulation.surface)
    for (int i = 0; i < n; i++) PetscCall(ZoneEndError(contact, pair, y[i], &error[i]));
  else
    PetscCall(ContactBetweenNodes(contact, pair, u, n, y, error));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, error, n, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
