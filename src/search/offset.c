/* Offsets of quadrature points: a nodal fit of the surface about each point, and its sagitta as a vector or as a
   combination of nodes. */
#include "search/offset.h"
#include "search/surfaceends.h"
#include "searchimpl.h"
#include "base/timing.h"

/* Offsets that a solve turns back are damped where what is left of their change is more than this part of the change
   before. Less than that settles by itself. */
#define OFFSET_SETTLES 0.1
/* They are damped after so many such turns in a row. One alone may come from nodes that open or close: two cubes that
   overhang each other do not settle if they are damped from the first one on. */
#define OFFSET_TURNS 2
/* Those of a single face stay between both after so many: damping, which knows all faces together, has not ended them.
 */
#define OFFSET_FACE_TURNS 3

/* Rung with which fits about points of a face at an end of the surface begin: degree 2. They see the surface on one
   side only, and degree 4 runs through the five nodes there. It then answers to a kink at the last node by 0.23 of its
   height, where an arc has 0.125. A body that yields is crushed at its edge, so that the kink, the offset and the force
   there follow each other to and fro: a bar pushed into a funnel took 7193 iterations, with degree 2 it takes 455. */
#define OFFSET_END_RUNG RUNG_QUADRATIC

struct _n_Offsets {
  ContactSurface surface;
  ContactSearch  search; /* searches the surface itself */
  FitSettings    fit;
  int            finer;
  OffsetsKind    kind;
  PetscBool      once, taken; /* once: in the reference position; taken: nothing that is wanted is missing there */
  PetscBool     *had;         /* of each face, where they are taken once: they have been */
  FaceMaps       maps;        /* of live offsets */
  PetscInt       n;
  PetscReal *used, *now, *before; /* used: those of the present solve; now, before: of the last two accepted states */
  PetscReal  t_now, t_before;
  PetscBool *wanted; /* of each face: its offsets are taken; others are NAN in now, before and last, and 0 in use */
  /* Faces that have ever been wanted, once the first wish is known. The others have no values but 0 in use. */
  PetscBool *touched, tracked, blank; /* blank: no face on any rank is touched */
  /* The offsets that were taken last, with the displacements and the load parameter there. t_last is NAN before the
     first. */
  PetscReal *last, *u_last, t_last;
  Offsets    lender; /* earlier offsets of the same surface by the same settings, or NULL */
  /* Of the step at hand: the offsets with which its lists were made, and of the time when these were replaced last what
     the solution asked for and by how much that differed. */
  PetscReal *held, *asked, *change;
  PetscBool  replaced, turning; /* turning: solutions turn them to and fro */
  int        turns;             /* times in a row that they have */
  /* And of each face: the last change that was not small beside the one before, how many there were that turned
     the one before back, with the first one, and whether the offsets in use stay to the end of the step. */
  PetscReal *swing;
  int       *swings;
  PetscBool *stays;
};

/* The arrays that offsets have which are taken again and again. */
enum { FOLLOWING = 7 };
static PetscReal **Following(Offsets o, int k)
{
  PetscReal **arrays[FOLLOWING] = {&o->now, &o->before, &o->last, &o->held, &o->asked, &o->change, &o->swing};

  return arrays[k];
}

/* Values of all faces, which are 0. Memory is taken from the system where values are written, as most faces of large
   surfaces never have any: PetscCalloc1() would write all of them. */
static PetscErrorCode MakeValues(PetscInt n, PetscReal **values)
{
  PetscFunctionBeginUser;
  *values = calloc(PetscMax(n, 1), sizeof(PetscReal));
  PetscCheck(*values, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for offsets");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsCreate - makes the offsets of a surface, which are 0 until they are taken.

  Collective

  Input Parameters:
+ mesh          - the mesh
. scene         - the scene
. loads         - gives the position of rigid tools
. surface       - the surface, borrowed
. n_images      - number of mirror images
. images        - the images, borrowed
. feature_angle - fits end at edges that are sharper (radians)
. finer         - how fine the quadrature is, see FaceRuleGet()
- kind          - none, held or live; a rigid tool has held offsets instead of live ones

  Output Parameter:
. out - the offsets
@*/
PetscErrorCode OffsetsCreate(Mesh mesh, Scene scene, Loads loads, ContactSurface surface, int n_images,
                             const SurfaceImage *images, PetscReal feature_angle, int finer, OffsetsKind kind,
                             Offsets *out)
{
  Offsets o;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  o->surface = surface;
  o->finer   = finer;
  o->kind    = kind == OFFSETS_LIVE && surface->rigid ? OFFSETS_HELD : kind;
  o->once    = (PetscBool)(surface->rigid || scene->kinematics == KINEMATICS_SMALL);
  o->t_now = o->t_before = -1;
  /* These are the defaults of nodal fits: the smoothest ones whose guards hold on jittered meshes. The path of friction
     keeps what offsets jump by, and lists would be made anew again and again. Without friction a jump costs little, and
     fits keep the points that they have: a coarse ring in space that a fluid rolls needs them. */
  o->fit    = (FitSettings){.fitted        = PETSC_TRUE,
                            .degree        = 4,
                            .support       = mesh->dim == 2 ? 4.5 : 3.5,
                            .exponent      = mesh->dim == 2 ? 6 : 3,
                            .feature_angle = feature_angle,
                            .fades         = SceneHasFriction(scene)};
  o->n      = surface->n_faces * FACE_RULE_POINTS * mesh->dim;
  o->t_last = NAN;
  PetscCall(MakeValues(o->n, &o->used));
  for (int k = 0; k < FOLLOWING && !o->once; k++) PetscCall(MakeValues(o->n, Following(o, k)));
  if (o->once) PetscCall(PetscCalloc1(surface->n_faces, &o->had));
  if (!o->once) PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &o->u_last));
  if (!o->once) PetscCall(PetscCalloc2(surface->n_faces, &o->swings, surface->n_faces, &o->stays));
  PetscCall(PetscMalloc2(surface->n_faces, &o->wanted, surface->n_faces, &o->touched));
  for (PetscInt f = 0; f < surface->n_faces; f++) o->wanted[f] = o->touched[f] = PETSC_TRUE;
  PetscCall(SearchCreate(mesh, scene, loads, surface, surface->max_size, n_images, images, &o->fit, NULL, NULL, NULL,
                         &o->search));
  *out = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsDestroy - frees the offsets.

  Collective

  Input/Output Parameter:
. offsets - the offsets, NULL on return
@*/
PetscErrorCode OffsetsDestroy(Offsets *offsets)
{
  PetscFunctionBeginUser;
  if (!*offsets) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SearchDestroy(&(*offsets)->search));
  PetscCall(FaceMapsDestroy(&(*offsets)->maps));
  free((*offsets)->used);
  for (int k = 0; k < FOLLOWING; k++) free(*Following(*offsets, k));
  PetscCall(PetscFree((*offsets)->had));
  PetscCall(PetscFree((*offsets)->u_last));
  PetscCall(PetscFree2((*offsets)->swings, (*offsets)->stays));
  PetscCall(PetscFree2((*offsets)->wanted, (*offsets)->touched));
  PetscCall(PetscFree(*offsets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The ends of the surface at a face. */
static int FaceEnds(ContactSurface surface, PetscInt f)
{
  return surface->face_ends ? surface->face_ends[f] : 0;
}

/*@
  OffsetsLend - has offsets of a surface take those that others have at the same state, if both are made alike.

  Not collective

  Input Parameters:
+ lender - offsets, which live as long
- o      - the offsets

  Output Parameter:
. alike - they are

  Note:
  Where bodies meet without pairs of names, each surface is a slave in some pairs and a master in others.
@*/
PetscErrorCode OffsetsLend(Offsets lender, Offsets o, PetscBool *alike)
{
  const ContactSurface a = lender->surface, b = o->surface;

  PetscFunctionBeginUser;
  *alike =
    (PetscBool)(a->group == b->group && a->rigid == b->rigid && a->n_faces == b->n_faces && a->turned == b->turned &&
                lender->kind == o->kind && lender->finer == o->finer &&
                lender->fit.feature_angle == o->fit.feature_angle && lender->search->n_images == o->search->n_images);
  if (*alike) PetscCall(PetscArraycmp(a->faces, b->faces, a->n_faces, alike));
  for (PetscInt f = 0; f < a->n_faces && *alike; f++) *alike = (PetscBool)(FaceEnds(a, f) == FaceEnds(b, f));
  if (*alike) PetscCall(PetscArraycmp(lender->search->images, o->search->images, o->search->n_images, alike));
  if (*alike) o->lender = lender;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A face of the surface with its number among the candidates, its rule and its nodes' positions. */
typedef struct {
  PetscInt        candidate;
  const Facet    *facet;
  const FaceRule *rule;
  int             rung; /* with which fits about its points begin */
  double          x[FACE_MAX_NODES * 3], normal[FACE_RULE_POINTS * 3];
} OffsetFace;

/* Makes the surface's own nodal fit about point q of a face, in the face's frame. nodes[a] are the tangent
   coordinates of the face's nodes there. *rung is RUNG_FACET if there is no fit. */
static PetscErrorCode FitAt(FitSupport *fit, const OffsetFace *face, int q, FitProblem *problem, FitResult *result,
                            int *rung, double (*nodes)[2])
{
  const int dim = fit->lists->dim, n = ElementGet(face->facet->type)->nodes;
  FitFoot   at = {.facet = face->candidate, .xi = {face->rule->xi[q][0], face->rule->xi[q][1]}, .upright = PETSC_TRUE};

  PetscFunctionBeginUser;
  for (int a = 0; a < n; a++)
    for (int d = 0; d < dim; d++) at.X[d] += face->rule->N[q][a] * face->x[a * dim + d];
  for (int d = 0; d < 3; d++) {
    at.foot[d]    = at.X[d];
    at.outward[d] = face->normal[3 * q + d];
  }
  TimingBegin(TIMING_FIT);
  PetscCall(FitSupportClimb(fit, &at, face->rung, problem, result, rung));
  TimingEnd(TIMING_FIT);
  for (int a = 0; a < n && *rung != RUNG_FACET; a++) {
    for (int k = 0; k < dim - 1; k++) {
      nodes[a][k] = 0;
      for (int d = 0; d < dim; d++) nodes[a][k] += problem->frame[k][d] * (face->x[a * dim + d] - at.X[d]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = (f(0) - sum_a N_a f(s_a)) n at one quadrature point. f is the fit about it in the face's frame, and s_a are
   the face's nodes there. */
static PetscErrorCode OffsetAt(FitSupport *fit, const OffsetFace *face, int q, PetscReal *b)
{
  const int  dim = fit->lists->dim;
  FitProblem problem;
  FitResult  result;
  double     zero[2] = {0, 0}, nodes[FACE_MAX_NODES][2], sagitta;
  int        rung;

  PetscFunctionBeginUser;
  for (int d = 0; d < dim; d++) b[d] = 0;
  PetscCall(FitAt(fit, face, q, &problem, &result, &rung, nodes));
  if (rung == RUNG_FACET) PetscFunctionReturn(PETSC_SUCCESS);
  sagitta = FitSurfaceHeight(&result.surface, zero, NULL);
  for (int a = 0; a < ElementGet(face->facet->type)->nodes; a++)
    sagitta -= face->rule->N[q][a] * FitSurfaceHeight(&result.surface, nodes[a], NULL);
  for (int d = 0; d < dim; d++) b[d] = sagitta * face->normal[3 * q + d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The same sagitta as a combination of the fit's *n points in fit->points, with the coefficients shape[*n]. It
   vanishes where these points lie on a plane. Applied to their whole positions it is therefore along the normal and
   turns with the surface. */
static PetscErrorCode SagittaShape(FitSupport *fit, const OffsetFace *face, int q, double *shape, PetscInt *n)
{
  const int  dim = fit->lists->dim, corners = ElementGet(face->facet->type)->nodes;
  FitProblem problem;
  FitResult  result;
  double     nodes[FACE_MAX_NODES][2], y[(1 + FACE_MAX_NODES) * 2] = {0}, factor[1 + FACE_MAX_NODES] = {1};
  int        rung;

  PetscFunctionBeginUser;
  *n = 0;
  PetscCall(FitAt(fit, face, q, &problem, &result, &rung, nodes));
  if (rung == RUNG_FACET) PetscFunctionReturn(PETSC_SUCCESS);
  for (int a = 0; a < corners; a++) {
    factor[1 + a] = -face->rule->N[q][a];
    for (int k = 0; k < dim - 1; k++) y[(1 + a) * (dim - 1) + k] = nodes[a][k];
  }
  FitShape(&problem, 1 + corners, y, factor, fit->workspace, shape);
  *n = problem.n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Handles a face while fits about it can be made. */
typedef PetscErrorCode (*OffsetFaceFn)(Offsets, FitSupport *, const OffsetFace *, PetscInt f, void *context);

/* Visits own faces, some[] of them or all, with the surface at (u, t). */
static PetscErrorCode OffsetsVisit(Offsets o, const PetscReal *u, PetscReal t, const PetscBool *some,
                                   OffsetFaceFn visit, void *context)
{
  const int  dim = o->search->mesh->dim;
  MasterFits fits;

  PetscFunctionBeginUser;
  PetscCall(MasterFitsCreate(o->search, u, t, some, &fits));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    const Facet     *facet = &o->surface->faces[f];
    const Candidate *own   = SearchFieldOwn(&fits.field, facet);
    OffsetFace       face  = {.candidate = own - fits.field.candidates,
                              .facet     = facet,
                              .rule      = SurfaceRule(o->surface, f, o->finer),
                              .rung      = FaceEnds(o->surface, f) ? OFFSET_END_RUNG : RUNG_PLAIN};
    double           area[FACE_RULE_POINTS];

    if (some && !some[f]) continue;
    for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
      for (int d = 0; d < dim; d++) face.x[a * dim + d] = fits.fit.view.x[own->facet.nodes[a] * dim + d];
    FaceRuleAreas(face.rule, facet->type, dim, GEOMETRY_SOLID, face.x, area, face.normal);
    PetscCall(visit(o, &fits.fit, &face, f, context));
  }
  PetscCall(MasterFitsDestroy(&fits));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the held offsets of a face. */
static PetscErrorCode TakeFace(Offsets o, FitSupport *fit, const OffsetFace *face, PetscInt f, void *context)
{
  PetscReal *offset = context;

  PetscFunctionBeginUser;
  for (int q = 0; q < face->rule->n; q++)
    PetscCall(OffsetAt(fit, face, q, &offset[(f * FACE_RULE_POINTS + q) * o->search->mesh->dim]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Maps that grow face by face. */
typedef struct {
  PetscInt room;
  /* Number of each point of the lists among the entries. Numbers of other faces are below the first entry of the
     present face. */
  PetscInt *place;
} MapsInMaking;

/* Adds the share S of point q of the present face at a point of the lists, which is an image of a node. */
static PetscErrorCode AddEntry(FaceMaps *maps, MapsInMaking *making, NeighbourLists lists, PetscInt point, int q,
                               double S)
{
  PetscInt          *end  = &maps->ptr[maps->n + 1];
  const PetscInt     node = lists->point_node[lists->point_ptr[point]];
  const PetscSFNode *owner;

  PetscFunctionBeginUser;
  if (making->place[point] < maps->ptr[maps->n]) {
    if (*end == making->room)
      PetscCall(PetscRealloc((making->room = 2 * making->room + 1024) * sizeof(FaceMapEntry), &maps->entry));
    PetscCall(PetscSFGetGraph(lists->sf, NULL, NULL, NULL, &owner));
    maps->entry[*end] =
      (FaceMapEntry){.node  = {.id = lists->node_id[node], .owner = owner[node].rank, .local = owner[node].index},
                     .image = lists->point_image[point]};
    for (int d = 0; d < lists->dim; d++) maps->entry[*end].node.X[d] = lists->X[node * lists->dim + d];
    making->place[point] = (*end)++;
  }
  maps->entry[making->place[point]].S[q] += S;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the map of a face from its shape functions and the coefficients of the sagittas. The face's own nodes come
   first. */
static PetscErrorCode MapFace(Offsets o, FitSupport *fit, const OffsetFace *face, PetscInt f, void *context)
{
  FaceMaps      *maps   = &o->maps;
  MapsInMaking  *making = context;
  NeighbourLists lists  = fit->lists;
  double         shape[FIT_MAX_POINTS];
  PetscInt       n;

  PetscFunctionBeginUser;
  if (!making->place) {
    PetscCall(PetscMalloc1(lists->n_points, &making->place));
    for (PetscInt p = 0; p < lists->n_points; p++) making->place[p] = -1;
  }
  maps->n          = f;
  maps->ptr[f + 1] = maps->ptr[f];
  for (int a = 0; a < ElementGet(face->facet->type)->nodes; a++)
    for (int q = 0; q < face->rule->n; q++)
      PetscCall(AddEntry(maps, making, lists, fit->view.facets[face->candidate].nodes[a], q, face->rule->N[q][a]));
  for (int q = 0; q < face->rule->n; q++) {
    PetscCall(SagittaShape(fit, face, q, shape, &n));
    for (PetscInt i = 0; i < n; i++)
      if (shape[i] != 0) PetscCall(AddEntry(maps, making, lists, fit->points[i], q, shape[i]));
  }
  maps->n = f + 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the maps of all own faces in the reference position. */
static PetscErrorCode OffsetsMap(Offsets o)
{
  MapsInMaking making = {0};
  PetscReal   *zero;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(o->surface->n_faces + 1, &o->maps.ptr));
  PetscCall(PetscCalloc1(o->search->mesh->n_nodes * o->search->mesh->dim, &zero));
  PetscCall(OffsetsVisit(o, zero, 0, NULL, MapFace, &making));
  PetscCall(PetscFree(zero));
  PetscCall(PetscFree(making.place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Number of values of a face. */
static PetscInt FaceBlock(Offsets o)
{
  return FACE_RULE_POINTS * o->search->mesh->dim;
}

/* Takes the offsets of the missing faces of all ranks, with the surface at (u, t); u NULL: in the reference position.
 */
static PetscErrorCode TakeMissing(Offsets o, const PetscReal *u, PetscReal t, const PetscBool *missing,
                                  PetscReal *values)
{
  PetscReal *zero = NULL;
  int        any  = 0;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < o->surface->n_faces && !any; f++) any = missing[f];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_LOR, o->search->mesh->comm));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  if (!u) PetscCall(PetscCalloc1(o->search->mesh->n_nodes * o->search->mesh->dim, &zero));
  PetscCall(OffsetsVisit(o, u ? u : zero, t, missing, TakeFace, values));
  PetscCall(PetscFree(zero));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes what is missing from lenders that have it at (u, t). */
static PetscErrorCode Borrow(Offsets o, const PetscReal *u, PetscReal t, PetscReal *values, PetscBool *missing)
{
  const PetscInt block = FaceBlock(o), n = o->search->mesh->n_nodes * o->search->mesh->dim;

  PetscFunctionBeginUser;
  for (Offsets from = o->lender; from; from = from->lender) {
    const PetscReal *lent = from->once ? from->used : from->last;
    PetscBool        same = (PetscBool)(from->once || from->t_last == t);

    if (same && !from->once) PetscCall(PetscArraycmp(u, from->u_last, n, &same));
    for (PetscInt f = 0; f < o->surface->n_faces && same; f++) {
      if (!missing[f] || !from->touched[f] || (from->once ? !from->had[f] : PetscIsNanReal(lent[f * block]))) continue;
      PetscCall(PetscArraycpy(&values[f * block], &lent[f * block], block));
      missing[f] = PETSC_FALSE;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the offsets of the wanted faces in the reference position, once each. */
static PetscErrorCode TakeReference(Offsets o)
{
  PetscBool *missing;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->surface->n_faces, &missing));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    missing[f] = (PetscBool)(o->wanted[f] && !o->had[f]);
    if (missing[f]) o->had[f] = PETSC_TRUE;
  }
  PetscCall(Borrow(o, NULL, 0, o->used, missing));
  PetscCall(TakeMissing(o, NULL, 0, missing, o->used));
  PetscCall(PetscFree(missing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Are offsets taken again and again? */
static PetscBool Follow(Offsets o)
{
  return (PetscBool)(o->kind == OFFSETS_HELD && !o->once);
}

/* Takes offsets that are taken only once. *done is set if nothing remains to be done. */
static PetscErrorCode TakeOnce(Offsets o, PetscBool *done)
{
  PetscFunctionBeginUser;
  *done = (PetscBool)!Follow(o);
  if (!*done || o->kind == OFFSETS_NONE || o->taken) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->kind == OFFSETS_LIVE)
    PetscCall(OffsetsMap(o));
  else
    PetscCall(TakeReference(o));
  o->taken = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the offsets of the wanted faces at (u, t) that are not among the last ones. */
static PetscErrorCode TakeWanted(Offsets o, const PetscReal *u, PetscReal t)
{
  const PetscInt block = FaceBlock(o);
  PetscBool     *missing;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->surface->n_faces, &missing));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    missing[f] = (PetscBool)(o->wanted[f] && PetscIsNanReal(o->last[f * block]));
    if (missing[f]) PetscCall(PetscArrayzero(&o->last[f * block], block));
  }
  PetscCall(Borrow(o, u, t, o->last, missing));
  PetscCall(TakeMissing(o, u, t, missing, o->last));
  PetscCall(PetscFree(missing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives an untouched face values, which are those of a face that is not wanted. */
static void Touch(Offsets o, PetscInt f)
{
  const PetscInt block = FaceBlock(o);

  for (PetscInt i = f * block; Follow(o) && i < (f + 1) * block; i++) o->last[i] = o->now[i] = o->before[i] = NAN;
  o->touched[f] = PETSC_TRUE;
}

/* The values from *first to the returned end belong to the next touched face from face *f on, which becomes the one
   after it. Returns *first where there is none. */
static PetscInt NextTouched(Offsets o, PetscInt *f, PetscInt *first)
{
  const PetscInt block = FaceBlock(o);

  while (*f < o->surface->n_faces && !o->touched[*f]) (*f)++;
  *first = *f * block;
  if (*f == o->surface->n_faces) return *first;
  (*f)++;
  return *first + block;
}

/* The offsets at (u, t), NAN on faces that are not wanted. They are asked for twice for each solution: when its lists
   are checked, and where the next step begins. The second time the stored ones are used. */
static PetscErrorCode OffsetsAt(Offsets o, const PetscReal *u, PetscReal t, PetscReal *values)
{
  const PetscInt n = o->search->mesh->n_nodes * o->search->mesh->dim;
  PetscBool      same;
  int            all;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycmp(u, o->u_last, n, &same));
  all = same && t == o->t_last;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_LAND, o->search->mesh->comm));
  if (!all) {
    for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;)
      for (; i < end; i++) o->last[i] = NAN;
    PetscCall(PetscArraycpy(o->u_last, u, n));
    o->t_last = t;
  }
  PetscCall(TakeWanted(o, u, t));
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;)
    for (const PetscBool wanted = o->wanted[f - 1]; i < end; i++) values[i] = wanted ? o->last[i] : NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets in use are 0 on faces that are not wanted. */
static PetscReal InUse(PetscReal offset)
{
  return PetscIsNanReal(offset) ? 0 : offset;
}

/*@
  OffsetsChoose - says whether offsets are taken face by face, so that it matters on which faces they are needed.

  Not collective

  Input Parameter:
. o - the offsets
@*/
PetscBool OffsetsChoose(Offsets o)
{
  return (PetscBool)(o->kind == OFFSETS_HELD);
}

/*@
  OffsetsWant - says on which faces offsets are needed.

  Collective

  Input Parameters:
+ o      - the offsets
. wanted - wanted[faces of the surface on this rank]
- anew   - a step begins; otherwise faces that were wanted before stay so

  Note:
  Only held offsets are left out elsewhere: they are 0 there. What is first wanted in a step is not extrapolated over
  it. What is taken once stays.
@*/
PetscErrorCode OffsetsWant(Offsets o, const PetscBool *wanted, PetscBool anew)
{
  const PetscBool first = (PetscBool)(!o->tracked && PetscIsNanReal(o->t_last) && o->t_now < 0);
  int             any   = 0;

  PetscFunctionBeginUser;
  if (first) PetscCall(PetscArrayzero(o->touched, o->surface->n_faces));
  if (first) o->tracked = PETSC_TRUE;
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    o->wanted[f] = (PetscBool)(wanted[f] || (!anew && o->wanted[f]));
    if (o->wanted[f] && !o->touched[f]) Touch(o, f);
    any = any || o->touched[f];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_LOR, o->search->mesh->comm));
  o->blank = any ? PETSC_FALSE : PETSC_TRUE;
  if (o->kind == OFFSETS_HELD) o->taken = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsBlank - says whether no face on any rank has ever been wanted, so that all offsets in use are 0.

  Not collective

  Input Parameter:
. o - the offsets
@*/
PetscBool OffsetsBlank(Offsets o)
{
  return o->blank;
}

/*@
  OffsetsExtrapolate - takes the offsets at the accepted state (u, t) and extrapolates their change since the previous
  accepted state to t_next.

  Collective

  Input Parameters:
+ o      - the offsets
. u      - local displacements u[n_nodes*dim] of the accepted state (length), ghosts included
. t      - its load parameter
- t_next - load parameter at the end of the step

  Note:
  A step that is tried again starts from the same t and finds the same offsets. There is no extrapolation past a
  breakpoint of a load history.
@*/
PetscErrorCode OffsetsExtrapolate(Offsets o, const PetscReal *u, PetscReal t, PetscReal t_next)
{
  PetscReal ahead = 0;
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(TakeOnce(o, &done));
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  if (t != o->t_now) {
    PetscReal *swap = o->before;

    o->before   = o->now;
    o->now      = swap;
    o->t_before = o->t_now;
    o->t_now    = t;
  }
  if (!o->blank) PetscCall(OffsetsAt(o, u, t, o->now));
  /* Past a breakpoint the loads take another direction. */
  if (o->t_before >= 0 && !SceneBreaks(o->search->scene, t)) ahead = (t_next - t) / (t - o->t_before);
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;)
    for (; i < end; i++) o->held[i] = o->used[i] = InUse(o->now[i]) + ahead * InUse(o->now[i] - o->before[i]);
  o->replaced = o->turning = PETSC_FALSE;
  o->turns                 = 0;
  PetscCall(PetscArrayzero(o->swings, o->surface->n_faces));
  PetscCall(PetscArrayzero(o->stays, o->surface->n_faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsTake - takes the offsets at (u, t) without extrapolation.

  Collective

  Input Parameters:
+ o - the offsets
. u - local displacements u[n_nodes*dim] (length), ghosts included
- t - load parameter
@*/
PetscErrorCode OffsetsTake(Offsets o, const PetscReal *u, PetscReal t)
{
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(TakeOnce(o, &done));
  if (done) PetscFunctionReturn(PETSC_SUCCESS);
  if (o->blank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OffsetsAt(o, u, t, o->used));
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;)
    for (; i < end; i++) o->used[i] = o->stays[f - 1] ? o->held[i] : InUse(o->used[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets of a face that solutions turn to and fro stay where they are between the two, to the end of the step. The fit
   of a coarse face changes by a jump where a point comes into its support or it falls to another rung, and may be the
   one of the two that its own solution does not ask for. *some: there are such faces. */
static PetscErrorCode StayBetween(Offsets o, PetscBool *some)
{
  const PetscInt block = FaceBlock(o);

  PetscFunctionBeginUser;
  *some = PETSC_FALSE;
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    PetscReal *used = &o->used[f * block], *held = &o->held[f * block], *swing = &o->swing[f * block];
    PetscReal  along = 0, now = 0, last = 0;

    if (!o->touched[f] || o->stays[f]) continue;
    for (PetscInt i = 0; i < block; i++) {
      along += (used[i] - held[i]) * swing[i];
      now += PetscSqr(used[i] - held[i]);
      last += o->swings[f] ? PetscSqr(swing[i]) : 0;
    }
    if (now <= PetscSqr(OFFSET_SETTLES) * last || now == 0) continue;
    o->swings[f] += !o->swings[f] || along < 0;
    o->stays[f] = (PetscBool)(o->swings[f] > OFFSET_FACE_TURNS);
    for (PetscInt i = 0; i < block; i++) {
      swing[i] = used[i] - held[i];
      if (o->stays[f]) used[i] -= swing[i] / 2;
    }
    *some = (PetscBool)(*some || o->stays[f]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsDamp - damps the offsets that were taken at a solution, if the solutions of this step turn them to and fro.

  Collective

  Input Parameter:
. o - the offsets, after OffsetsTake(); they replace those with which the solution was found

  Output Parameter:
. changed - the offsets are not those that were taken; the same on all ranks

  Note:
  A soft body may answer to a change of its offsets by more than that change the other way, as a ring that rolls in its
  groove. Solutions then never settle. From OFFSET_TURNS such answers in a row on, the offsets are set on the line
  through the last two that solutions asked for, where their secant sees no change any more. Those of single faces
  that are turned to and fro by jumps of their fits stay between both.

  Source: Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547-560.
@*/
PetscErrorCode OffsetsDamp(Offsets o, PetscBool *changed)
{
  /* squared change before, change times change before, squared change; faces that stay */
  PetscReal sum[4] = {0, 0, 0, 0}, part;
  PetscBool turns, stays, damps;

  PetscFunctionBeginUser;
  *changed = PETSC_FALSE;
  if (!Follow(o)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StayBetween(o, &stays));
  sum[3] = stays;
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;) {
    for (; i < end; i++) {
      const PetscReal change = o->used[i] - o->held[i];

      sum[0] += PetscSqr(o->change[i]);
      sum[1] += change * o->change[i];
      sum[2] += PetscSqr(change);
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 4, MPIU_REAL, MPI_SUM, o->search->mesh->comm));
  turns      = (PetscBool)(o->replaced && sum[1] < 0 && sum[2] > PetscSqr(OFFSET_SETTLES) * sum[0]);
  o->turns   = turns ? o->turns + 1 : 0;
  o->turning = (PetscBool)(o->turning || o->turns == OFFSET_TURNS);
  damps      = (PetscBool)(o->turning && sum[2] > 0);
  *changed   = (PetscBool)(damps || sum[3] > 0);
  part       = damps ? PetscMax(-1, (sum[2] - sum[1]) / (sum[2] - 2 * sum[1] + sum[0])) : 0;
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;) {
    for (; i < end; i++) {
      const PetscReal asked = o->used[i];

      o->change[i] = asked - o->held[i];
      o->used[i] -= part * (asked - o->asked[i]);
      o->asked[i] = asked;
      o->held[i]  = o->used[i];
    }
  }
  o->replaced = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsTakePart - goes back to a part of the last change of the offsets, after OffsetsDamp().

  Not collective

  Input Parameters:
+ o    - the offsets
- part - of what is left of the change, from 0 to 1
@*/
void OffsetsTakePart(Offsets o, PetscReal part)
{
  if (!Follow(o) || !o->replaced) return;
  for (PetscInt f = 0, i, end; (end = NextTouched(o, &f, &i)) > i;) {
    for (; i < end; i++) {
      const PetscReal before = o->asked[i] - o->change[i];

      o->used[i] = o->held[i] = before + part * (o->held[i] - before);
    }
  }
}

/*@
  OffsetsGet - returns the present offsets: vectors along the normals of the time when they were taken (length).

  Not collective

  Input Parameter:
. o - the offsets

  Note:
  The array is [faces of the surface on this rank][FACE_RULE_POINTS*dim]. It stays the same array.
@*/
const PetscReal *OffsetsGet(Offsets o)
{
  return o->used;
}

/*@
  OffsetsTouched - says which faces have ever had offsets.

  Not collective

  Input Parameter:
. o - the offsets

  Note:
  Returns an array of the faces of the surface on this rank. The offsets of the others are 0.
@*/
const PetscBool *OffsetsTouched(Offsets o)
{
  return o->touched;
}

/*@
  OffsetsMaps - returns the maps of live offsets, which make the points combinations of nodes.

  Not collective

  Input Parameter:
. o - the offsets

  Note:
  Returns NULL if the offsets are not live. The maps, one for each face of the surface on this rank, are there once
  offsets have been taken.
@*/
const FaceMaps *OffsetsMaps(Offsets o)
{
  return o->kind == OFFSETS_LIVE ? &o->maps : NULL;
}

/* Writes or reads one array of values. Rows of faces without values are NAN. */
static PetscErrorCode ArchiveValues(Offsets o, Archive archive, const char *path, const Hdf5Table *faces,
                                    PetscReal *values)
{
  const PetscInt block = FaceBlock(o);
  PetscReal     *rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->n, &rows));
  for (PetscInt i = 0; i < o->n; i++) rows[i] = o->touched[i / block] ? values[i] : NAN;
  PetscCall(ArchiveRows(archive, path, faces, (int)block, rows));
  for (PetscInt f = 0; f < o->surface->n_faces && ArchiveLoads(archive); f++) {
    if (PetscIsNanReal(rows[f * block])) continue;
    if (!o->touched[f]) Touch(o, f);
    PetscCall(PetscArraycpy(&values[f * block], &rows[f * block], block));
  }
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of the faces of the surface. */
static PetscErrorCode FaceTable(Offsets o, Hdf5Table *faces)
{
  PetscInt *tag;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(o->surface->n_faces, &tag));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) tag[f] = o->surface->faces[f].tag;
  PetscCall(Hdf5TableCreateByKey(o->search->mesh->comm, o->surface->n_faces, tag, faces));
  PetscCall(PetscFree(tag));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Before values are loaded no face has any. */
static PetscErrorCode Forget(Offsets o)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(o->touched, o->surface->n_faces));
  o->tracked = PETSC_TRUE;
  o->blank   = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsArchive - writes to or reads from an archive the values from which the next extrapolation starts.

  Collective

  Input Parameters:
+ archive - the archive
- name    - where the values stand in the archive

  Input/Output Parameter:
. o - the offsets

  Note:
  Nothing is archived where offsets are taken once.
@*/
PetscErrorCode OffsetsArchive(Offsets o, Archive archive, const char *name)
{
  PetscReal   time[] = {o->t_now, o->t_before}, *values[] = {o->now, o->before};
  const char *names[] = {"now", "before"};
  char        path[PETSC_MAX_PATH_LEN];
  Hdf5Table   faces;

  PetscFunctionBeginUser;
  if (!Follow(o)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FaceTable(o, &faces));
  if (ArchiveLoads(archive)) PetscCall(Forget(o));
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", name, names[k]));
    PetscCall(ArchiveValues(o, archive, path, &faces, values[k]));
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/t", name));
  PetscCall(ArchiveReals(archive, path, 2, time));
  o->t_now    = time[0];
  o->t_before = time[1];
  PetscCall(Hdf5TableDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OffsetsArchiveStaying - writes to or reads from an archive the offsets that stay where they are to the end of a step.

  Collective

  Input Parameters:
+ archive - the archive
- name    - where the values stand in the archive

  Input/Output Parameter:
. o - the offsets, between two steps

  Note:
  The lists that are ready for the next step were made with them. OffsetsExtrapolate() forgets them, OffsetsTake() takes
  them.
@*/
PetscErrorCode OffsetsArchiveStaying(Offsets o, Archive archive, const char *name)
{
  const PetscInt block = FaceBlock(o);
  PetscReal     *rows;
  PetscBool      any = PETSC_FALSE;
  Hdf5Table      faces;

  PetscFunctionBeginUser;
  if (!Follow(o)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt f = 0; f < o->surface->n_faces; f++) any = (PetscBool)(any || o->stays[f]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, o->search->mesh->comm));
  if (ArchiveLoads(archive)) PetscCall(ArchiveHas(archive, name, &any));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FaceTable(o, &faces));
  PetscCall(PetscMalloc1(o->n, &rows));
  for (PetscInt i = 0; i < o->n; i++) rows[i] = o->stays[i / block] ? o->held[i] : NAN;
  PetscCall(ArchiveRows(archive, name, &faces, (int)block, rows));
  for (PetscInt f = 0; f < o->surface->n_faces && ArchiveLoads(archive); f++) {
    o->stays[f] = (PetscBool)!PetscIsNanReal(rows[f * block]);
    if (o->stays[f]) PetscCall(PetscArraycpy(&o->held[f * block], &rows[f * block], block));
  }
  PetscCall(PetscFree(rows));
  PetscCall(Hdf5TableDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
