#include "offset.h"
#include "searchimpl.h"

struct _n_Offsets {
  ContactSurface surface;
  ContactSearch  search; /* the surface looking at itself */
  FitSettings    fit;
  int            finer;
  PetscBool      smooth, once, taken;
  PetscInt       n;
  PetscReal     *used, *now, *before; /* now, before: of the last two accepted states */
  PetscReal      t_now, t_before;
};

/* OffsetsCreate - offsets of a surface, 0 until they are taken. Collective. feature_angle: radians. */
PetscErrorCode OffsetsCreate(Mesh mesh, Scene scene, Loads loads, ContactSurface surface, int n_images, const SurfaceImage *images, PetscReal feature_angle,
                             int finer, PetscBool smooth, Offsets *out)
{
  Offsets o;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&o));
  o->surface = surface;
  o->finer   = finer;
  o->smooth  = smooth;
  o->once    = (PetscBool)(surface->rigid || scene->kinematics == KINEMATICS_SMALL);
  o->t_now = o->t_before = -1;
  /* the nodal fit's own defaults: the smoothest whose guards hold on jittered meshes */
  o->fit = (FitSettings){.degree = 4, .support = mesh->dim == 2 ? 4.5 : 3.5, .exponent = mesh->dim == 2 ? 6 : 3, .feature_angle = feature_angle};
  o->n   = surface->n_faces * FACE_RULE_POINTS * mesh->dim;
  PetscCall(PetscCalloc3(o->n, &o->used, o->n, &o->now, o->n, &o->before));
  PetscCall(SearchCreate(mesh, scene, loads, surface, surface->max_size, n_images, images, &o->fit, NULL, NULL, &o->search));
  *out = o;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* OffsetsDestroy - Collective. */
PetscErrorCode OffsetsDestroy(Offsets *offsets)
{
  PetscFunctionBeginUser;
  if (!*offsets) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SearchDestroy(&(*offsets)->search));
  PetscCall(PetscFree3((*offsets)->used, (*offsets)->now, (*offsets)->before));
  PetscCall(PetscFree(*offsets));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = (f(0) - sum_a N_a f(s_a)) n at one quadrature point: f the fit about it in the face's frame, s_a the face's nodes there. */
static PetscErrorCode OffsetAt(Fitting *fit, PetscInt candidate, const Facet *facet, const double *xi, const double *N, const PetscReal *x,
                               const PetscReal *normal, PetscReal *b)
{
  const int dim = fit->lists->dim;
  FitFoot   at  = {
       .facet   = candidate,
       .xi      = {xi[0], xi[1]},
       .upright = PETSC_TRUE
  };
  FitProblem problem;
  FitResult  result;
  double     zero[2] = {0, 0}, sagitta;
  int        rung;

  PetscFunctionBeginUser;
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
    for (int d = 0; d < dim; d++) at.x[d] += N[a] * x[a * dim + d];
  for (int d = 0; d < 3; d++) {
    at.foot[d]    = at.x[d];
    at.outward[d] = normal[d];
  }
  for (int d = 0; d < dim; d++) b[d] = 0;
  PetscCall(FittingClimb(fit, &at, &problem, &result, &rung));
  if (rung == RUNG_FACET) PetscFunctionReturn(PETSC_SUCCESS);
  sagitta = FitSurfaceHeight(&result.surface, zero, NULL);
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    double y[2] = {0, 0};

    for (int k = 0; k < dim - 1; k++)
      for (int d = 0; d < dim; d++) y[k] += problem.frame[k][d] * (x[a * dim + d] - at.x[d]);
    sagitta -= N[a] * FitSurfaceHeight(&result.surface, y, NULL);
  }
  for (int d = 0; d < dim; d++) b[d] = sagitta * normal[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int CandidateCompare(const void *a, const void *b)
{
  const Candidate *p = a, *q = b;
  return p->facet.tag < q->facet.tag ? -1 : p->facet.tag > q->facet.tag;
}

/* The offsets of all own faces at (u, t). */
static PetscErrorCode OffsetsCompute(Offsets o, const PetscReal *u, PetscReal t, PetscReal *offset)
{
  ContactSearch s   = o->search;
  const int     dim = s->mesh->dim;
  ContactLists  lists;
  SearchField   field;
  Fitting       fit;
  PetscReal     box[6];

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&lists));
  SearchMasterBox(s, u, t, box);
  PetscCall(SearchFieldCreate(s, u, t, box, SearchFitReach(s), lists, &field));
  PetscCall(FittingCreate(s, lists, &field, &fit));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) {
    const Facet    *facet  = &o->surface->faces[f];
    const FaceRule *rule   = FaceRuleGet(facet->type, o->finer);
    const Candidate wanted = {.facet = {.tag = facet->tag * SURFACE_MAX_IMAGES}},
                    *own   = bsearch(&wanted, field.candidates, field.n_candidates, sizeof(Candidate), CandidateCompare);
    double x[FACE_MAX_NODES * 3], area[FACE_RULE_POINTS], normal[FACE_RULE_POINTS * 3];

    for (int a = 0; a < ElementGet(facet->type)->nodes; a++)
      for (int d = 0; d < dim; d++) x[a * dim + d] = fit.view.x[own->facet.nodes[a] * dim + d];
    FaceRuleAreas(rule, facet->type, dim, GEOMETRY_SOLID, x, area, normal);
    for (int q = 0; q < rule->n; q++)
      PetscCall(OffsetAt(&fit, own - field.candidates, facet, rule->xi[q], rule->N[q], x, &normal[3 * q], &offset[(f * FACE_RULE_POINTS + q) * dim]));
  }
  PetscCall(FittingDestroy(&fit));
  PetscCall(SearchFieldDestroy(&field));
  PetscCall(ListsDestroy(&lists));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offsets that are taken once. *done: they are there. */
static PetscErrorCode TakeOnce(Offsets o, PetscBool *done)
{
  PetscFunctionBeginUser;
  *done = (PetscBool)(o->once || !o->smooth);
  if (o->smooth && o->once && !o->taken) {
    PetscReal *zero;

    PetscCall(PetscCalloc1(o->search->mesh->n_nodes * o->search->mesh->dim, &zero));
    PetscCall(OffsetsCompute(o, zero, 0, o->used));
    PetscCall(PetscFree(zero));
    o->taken = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* OffsetsExtrapolate - Collective. u[n_nodes*dim]: local displacements, ghosts included, of the accepted state at t; t_next: where the step goes. A step that
   is tried again starts from the same t and finds the same offsets. */
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
  PetscCall(OffsetsCompute(o, u, t, o->now));
  if (o->t_before >= 0 && !SceneBreaks(o->search->scene, t)) ahead = (t_next - t) / (t - o->t_before); /* past a breakpoint things go another way */
  for (PetscInt i = 0; i < o->n; i++) o->used[i] = o->now[i] + ahead * (o->now[i] - o->before[i]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* OffsetsTake - Collective. */
PetscErrorCode OffsetsTake(Offsets o, const PetscReal *u, PetscReal t)
{
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(TakeOnce(o, &done));
  if (!done) PetscCall(OffsetsCompute(o, u, t, o->used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* OffsetsGet - the offsets in force, lengths along the normals of the time they were taken. Not collective. */
const PetscReal *OffsetsGet(Offsets o)
{
  return o->used;
}

/* OffsetsArchive - Collective. name: where they stand in the archive. */
PetscErrorCode OffsetsArchive(Offsets o, Archive archive, const char *name)
{
  PetscReal   time[] = {o->t_now, o->t_before}, *values[] = {o->now, o->before};
  const char *names[] = {"now", "before"};
  PetscInt   *tag;
  char        path[PETSC_MAX_PATH_LEN];
  Rows        faces;

  PetscFunctionBeginUser;
  if (o->once || !o->smooth) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(o->surface->n_faces, &tag));
  for (PetscInt f = 0; f < o->surface->n_faces; f++) tag[f] = o->surface->faces[f].tag;
  PetscCall(RowsCreateByKey(o->search->mesh->comm, o->surface->n_faces, tag, &faces));
  PetscCall(PetscFree(tag));
  for (int k = 0; k < 2; k++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "%s/%s", name, names[k]));
    PetscCall(ArchiveRows(archive, path, &faces, FACE_RULE_POINTS * o->search->mesh->dim, values[k]));
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "%s/t", name));
  PetscCall(ArchiveReals(archive, path, 2, time));
  o->t_now    = time[0];
  o->t_before = time[1];
  PetscCall(RowsDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
