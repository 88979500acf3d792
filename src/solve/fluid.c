/* Fluids that enter between surfaces in contact, see fluid.h. */
#include "solve/fluid.h"
#include "base/refusal.h"
#include "fluidimpl.h"
#include "kernels/elementkernel.h"
#include "search/facequadrature.h"

/* A step in which the fluid reaches the other end is repeated with shorter ones, until its length is this part of t,
   and the pressure changes by this part in it. The leak pressure is interpolated, and better than this. */
#define FLUID_LEAK_STEP 0.01
/* It is not repeated where its length is below so many times the shortest one, as the next would be too short. */
#define FLUID_CUT 4
/* Surfaces touch, with or without pressure, where they are not farther apart than this part of the model's size. */
#define FLUID_OPEN 1e-9

/* Adds the areas around the nodes of a face. */
static void FaceAreas(Fluids fluids, int form, int finer, ElementType type, const PetscReal *x, PetscReal *area)
{
  const FaceRule *rule = FaceRuleGet(type, finer);
  double          part[FACE_RULE_POINTS];

  if (form == FLUID_NODES) {
    FaceAreaKernel(type, fluids->mesh->dim, fluids->scene->geometry, x, area, NULL);
    return;
  }
  FaceRuleAreas(rule, type, fluids->mesh->dim, fluids->scene->geometry, x, part, NULL);
  for (int q = 0; q < rule->n; q++)
    for (int a = 0; a < ElementGet(type)->nodes; a++) area[a] += rule->hat[q][a] * part[q];
}

/* Sets the present areas of one form; u NULL: those of the reference. */
static PetscErrorCode SetFormAreas(Fluids fluids, Fluid *fluid, int form, const PetscReal *u)
{
  const Mesh mesh = fluids->mesh;
  PetscInt   nodes[FACE_MAX_NODES];
  PetscReal  x[3 * FACE_MAX_NODES], area[FACE_MAX_NODES], *sum = fluid->area[form];

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sum, mesh->n_nodes));
  for (PetscInt f = 0; f < fluid->group->n_faces; f++) {
    const ElementType type = FluidFacePlaces(fluids, fluid, f, u, nodes, x);
    const int         n    = ElementGet(type)->nodes;

    PetscCall(PetscArrayzero(area, n));
    FaceAreas(fluids, form, fluid->finer, type, x, area);
    for (int a = 0; a < n; a++) sum[nodes[a]] += area[a];
  }
  PetscCall(MeshSumNodes(mesh, 1, sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the areas of all forms; with small kinematics those of the reference. */
static PetscErrorCode SetAreas(Fluids fluids, Fluid *fluid, const PetscReal *u)
{
  PetscFunctionBeginUser;
  for (int form = 0; form < FLUID_FORMS; form++)
    if (fluid->form[form])
      PetscCall(SetFormAreas(fluids, fluid, form, fluids->scene->kinematics == KINEMATICS_SMALL ? NULL : u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How a pair measures contact. */
static int PairForm(Fluids fluids, int pair)
{
  return ContactPairIsSurface(fluids->contact, pair) ? FLUID_FACES : FLUID_NODES;
}

/* The form in which a face shares the fluid: that of the pair that presses most on it. Where all of its nodes are wet,
   or none is, all forms are the same. */
static int FaceForm(const Fluid *fluid, int n, const PetscInt *nodes)
{
  int       form = fluid->form[FLUID_FACES] ? FLUID_FACES : FLUID_NODES;
  PetscReal most = 0;

  for (int a = 0; a < n; a++) {
    if (fluid->pressing[nodes[a]] <= most) continue;
    most = fluid->pressing[nodes[a]];
    form = (int)fluid->pressing_form[nodes[a]];
  }
  return form;
}

/* Gives the load its share of every face: at the quadrature points the hat functions of the wet nodes, or the forces of
   the wet nodes alone. */
static void SetShares(Fluids fluids, Fluid *fluid)
{
  PetscInt nodes[FACE_MAX_NODES];
  double   hat[FACE_MAX_NODES];

  for (PetscInt f = 0; f < fluid->group->n_faces; f++) {
    const Element *face = ElementGetFace(MeshFaceNodes(fluids->mesh, fluid->group, f, nodes));
    const int      form = FaceForm(fluid, face->nodes, nodes);

    for (int a = 0; a < face->nodes; a++)
      fluid->nodes[f * FACE_MAX_NODES + a] = form == FLUID_NODES ? fluid->wet[nodes[a]] : 1;
    for (int p = 0; p < face->points; p++) {
      PetscReal share = 0;

      FaceHatAround(face->type, p, fluid->finer, hat);
      for (int a = 0; a < face->nodes; a++) share += hat[a] * fluid->wet[nodes[a]];
      fluid->points[f * FACE_MAX_POINTS + p] = form == FLUID_FACES ? share : 1;
    }
  }
}

/* Tells load and contact where the fluid is in the present state, and how much it presses at t. */
static PetscErrorCode Apply(Fluids fluids, Fluid *fluid, const PetscReal *u, PetscReal t)
{
  const Mesh mesh = fluids->mesh;
  PetscReal *carried;

  PetscFunctionBeginUser;
  PetscCall(LoadsPressure(fluids->loads, fluid->number, t, &fluid->pressure));
  PetscCall(SetAreas(fluids, fluid, u));
  for (int i = 0; i < fluid->surface->graph.n; i++) {
    fluid->share[i] = fluid->laid[i] ? FluidShare(fluid, i) : 0;
    if (fluid->surface->local[i] >= 0) fluid->wet[fluid->surface->local[i]] = fluid->share[i];
  }
  SurfaceGraphScatter(fluid->surface, fluid->lubricated, fluid->dry);
  for (PetscInt i = 0; i < mesh->n_nodes; i++) fluid->dry[i] = fluid->wet[i] * (1 - fluid->dry[i]);
  SurfaceGraphScatter(fluid->surface, fluid->now.form, fluid->pressing_form);
  for (int i = 0; i < fluid->surface->graph.n; i++)
    if (fluid->surface->local[i] >= 0) fluid->pressing[fluid->surface->local[i]] = fluid->now.p[i];
  SetShares(fluids, fluid);
  PetscCall(LoadsSetShares(fluids->loads, fluid->number, fluid->nodes, fluid->points));
  PetscCall(PetscMalloc1(mesh->n_nodes, &carried));
  for (int p = 0; p < ContactPairs(fluids->contact); p++) {
    const PetscReal *area = fluid->area[PairForm(fluids, p)];

    if (!fluid->pair[p]) continue;
    for (PetscInt i = 0; i < mesh->n_nodes; i++) carried[i] = fluid->wet[i] * fluid->pressure * area[i];
    PetscCall(ContactSetCarried(fluids->contact, p, carried, fluid->dry));
  }
  PetscCall(PetscFree(carried));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds what contact alone presses at the nodes, from the forces of the last residual. Where the fluid's load lies
   these are the forces beyond the fluid. */
static PetscErrorCode Measure(Fluids fluids, Fluid *fluid, const PetscReal *u, PetscReal t)
{
  const SurfaceGraph s = fluid->surface;
  PetscReal          same;

  PetscFunctionBeginUser;
  PetscCall(LoadsPressure(fluids->loads, fluid->number, t, &fluid->pressure));
  same = FLUID_SAME * fluid->pressure;
  PetscCall(SetAreas(fluids, fluid, u));
  for (int form = 0; form < FLUID_FORMS; form++) PetscCall(PetscArrayzero(fluid->force[form], fluids->mesh->n_nodes));
  for (int p = 0; p < ContactPairs(fluids->contact); p++)
    if (fluid->pair[p])
      PetscCall(
        ContactTermForces(fluids->contact, p, FLUID_OPEN * fluids->mesh->size, fluid->force[PairForm(fluids, p)]));
  for (int i = 0; i < s->graph.n; i++) {
    const PetscInt node = s->local[i];
    PetscReal      p[FLUID_FORMS];

    for (int form = 0; form < FLUID_FORMS && s->own[i]; form++)
      p[form] = fluid->force[form][node] > 0 ? fluid->force[form][node] / fluid->area[form][node] : 0;
    if (!s->own[i]) continue;
    fluid->force[0][node] = PetscMax(p[FLUID_NODES], p[FLUID_FACES]);
    fluid->force[1][node] = p[FLUID_FACES] > p[FLUID_NODES] ? FLUID_FACES : FLUID_NODES;
  }
  PetscCall(SurfaceGraphGather(s, fluid->force[1], fluid->now.p));
  for (int i = 0; i < s->graph.n; i++) fluid->now.form[i] = (char)fluid->now.p[i];
  PetscCall(SurfaceGraphGather(s, fluid->force[0], fluid->now.p));
  for (int i = 0; i < s->graph.n; i++)
    if (fluid->laid[i]) fluid->now.p[i] = fluid->now.p[i] > same ? fluid->now.p[i] + fluid->pressure : 0;
  PetscCall(FluidMeasureReactions(fluids, fluid, u));
  PetscCall(FluidFaceSlaves(fluids, fluid, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds where the load belongs: on wet places. On a master it lies beside them and at the end from which the fluid
   comes too, as the front crosses faces there, of which reactions bear a part. */
static void FindBearing(Fluid *fluid)
{
  const SurfaceGraph s = fluid->surface;

  for (int i = 0; i < s->graph.n; i++) {
    fluid->bears[i] = fluid->now.wet[i] || (fluid->master && fluid->from[i]);
    for (int k = s->ptr[i]; k < s->ptr[i + 1] && fluid->master; k++) fluid->bears[i] |= fluid->now.wet[s->adj[k]];
  }
}

/* The lowest pressure with which the fluid would reach its other end in the contact as it is. */
static PetscErrorCode FindBarrier(Fluid *fluid)
{
  const int  n = fluid->surface->graph.n;
  PetscReal *height;
  int       *order, *root, highest;
  PetscInt  *index;

  PetscFunctionBeginUser;
  fluid->height = NAN;
  if (!fluid->has_to) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc4(n, &height, n, &order, n, &index, n + 2, &root));
  for (int i = 0; i < n; i++) {
    index[i]  = i;
    height[i] = fluid->now.p[i];
  }
  PetscCall(PetscSortRealWithPermutation(n, height, index));
  for (int i = 0; i < n; i++) order[i] = (int)index[i];
  highest = PassageBarrier(&fluid->surface->graph, order, fluid->from, fluid->to, root);
  if (highest >= 0) fluid->height = height[highest];
  PetscCall(PetscFree4(height, order, index, root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the fluid, with some pressure, is at the end where it leaks. */
static PetscBool ReachesEnd(const Fluid *fluid)
{
  for (int i = 0; i < fluid->surface->graph.n && fluid->has_to && fluid->pressure > 0; i++)
    if (fluid->to[i] && fluid->now.wet[i]) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Lays the fluid's load on wet places and on those to which the contact pressure rises from them. Contact presses more
   than the fluid there, so that this changes no force, and Newton's method itself finds how far the front moves up to
   the crest of the pressure. There it stays until the solution is found. Where masters deform, the load lies on wet
   places alone, as it would have to be taken back from what lies ahead on both sides. */
static PetscErrorCode LayAhead(Fluid *fluid)
{
  const PassageGraph *graph = &fluid->surface->graph;
  const FluidState   *now   = &fluid->now;
  int                *stack, top = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(graph->n, &stack));
  for (int i = 0; i < graph->n; i++) {
    if (now->wet[i]) stack[top++] = i;
    fluid->laid[i] |= fluid->bears[i];
    fluid->lubricated[i] |= now->wet[i];
  }
  while (top && !fluid->deforms) {
    const int i = stack[--top];

    for (int k = graph->ptr[i]; k < graph->ptr[i + 1]; k++) {
      const int j = graph->adj[k];

      if (fluid->laid[j] || (!now->wet[i] && now->p[j] < now->p[i])) continue;
      fluid->laid[j] = 1;
      stack[top++]   = j;
    }
  }
  PetscCall(PetscFree(stack));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the load from places that are dry again, once in a step, where it matters that it lies there: friction has not
   counted its pressure, or it lies on a master that deforms. */
static void Drain(Fluid *fluid, PetscBool *moved)
{
  if (fluid->drained) return;
  for (int i = 0; i < fluid->surface->graph.n; i++) {
    if (fluid->bears[i]) continue;
    if ((fluid->friction && fluid->lubricated[i]) || (fluid->deforms && fluid->laid[i] && fluid->share[i] > 0))
      *moved = PETSC_TRUE;
    fluid->lubricated[i] = 0;
    if (fluid->deforms) fluid->laid[i] = 0;
  }
  fluid->drained = *moved;
}

/* Moves one fluid to where it can be at the present solution. *moved: it is where its load did not lie, or where
   friction counted its pressure as one of contact. A load of which no place is wet any more is taken away, once in a
   step. */
static PetscErrorCode MoveOne(Fluids fluids, Fluid *fluid, const PetscReal *u, PetscReal t, PetscBool *moved)
{
  const int n   = fluid->surface->graph.n;
  PetscInt  wet = 0, laid = 0;
  char     *open;
  int      *stack;

  PetscFunctionBeginUser;
  PetscCall(Measure(fluids, fluid, u, t));
  PetscCall(PetscMalloc2(n, &open, n, &stack));
  for (int i = 0; i < n; i++) open[i] = FluidOpen(fluid, fluid->now.p[i]);
  PassageFlood(&fluid->surface->graph, open, fluid->from, stack, fluid->now.wet);
  FindBearing(fluid);
  PetscCall(PetscFree2(open, stack));
  *moved = PETSC_FALSE;
  for (int i = 0; i < n; i++) {
    *moved = (PetscBool)(*moved || (fluid->bears[i] && !fluid->laid[i]) || FluidShareChanges(fluid, i) ||
                         (fluid->now.wet[i] && fluid->friction && !fluid->lubricated[i]));
    wet += fluid->now.wet[i];
    laid += fluid->laid[i];
  }
  if (!wet && laid && !fluid->shut) {
    fluid->shut = *moved = PETSC_TRUE;
    PetscCall(PetscArrayzero(fluid->laid, n));
    PetscCall(PetscArrayzero(fluid->lubricated, n));
  }
  if (!*moved) Drain(fluid, moved);
  if (!*moved) PetscCall(FindBarrier(fluid));
  if (!*moved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayAhead(fluid));
  PetscCall(Apply(fluids, fluid, u, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StateCreate(int n, FluidState *state)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(n, &state->wet, n, &state->p, n, &state->form, n, &state->react));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode StateCopy(int n, const FluidState *from, FluidState *to)
{
  char      *wet = to->wet, *form = to->form;
  PetscReal *p = to->p, *react = to->react;

  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(wet, from->wet, n));
  PetscCall(PetscArraycpy(p, from->p, n));
  PetscCall(PetscArraycpy(react, from->react, n));
  PetscCall(PetscArraycpy(form, from->form, n));
  *to       = *from;
  to->wet   = wet;
  to->p     = p;
  to->react = react;
  to->form  = form;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the nodes of an end that the scene names: those that a surface has in common with the loaded one, or the node
   next to a point. */
static PetscErrorCode ReadEnd(Fluids fluids, Fluid *fluid, const char *key, const SceneEnd *end, char *flag,
                              PetscBool *given)
{
  const Mesh  mesh  = fluids->mesh;
  const char *where = SceneWhere(fluids->scene, fluid->load->path, key);
  MeshGroup  *group;
  PetscReal   distance, reach;
  PetscInt    n;

  PetscFunctionBeginUser;
  *given = (PetscBool)(end->has_point || end->surface);
  if (end->surface) {
    PetscCall(MeshGetGroup(mesh, fluids->scene, fluid->load->path, key, end->surface, mesh->dim - 1, &group));
    PetscCall(SurfaceGraphGroup(fluid->surface, group, flag, &n));
    if (!n)
      PetscCall(RefuseInput(mesh->comm,
                            "%s: '%s' has no node in common with the loaded '%s'; allowed: a surface that meets it, or "
                            "one of its points",
                            SceneWhere(fluids->scene, fluid->load->path, key), end->surface, fluid->load->region));
    if (n == fluid->surface->graph.n)
      PetscCall(RefuseInput(mesh->comm, "%s: '%s' has all nodes of the loaded '%s'; allowed: a part of them",
                            SceneWhere(fluids->scene, fluid->load->path, key), end->surface, fluid->load->region));
  }
  if (!end->has_point) PetscFunctionReturn(PETSC_SUCCESS);
  n = SurfaceGraphNearest(fluid->surface, end->point, &distance, &reach);
  if (distance > reach) {
    const PetscReal *X = &fluid->surface->X[3 * n];

    PetscCall(
      RefuseInput(mesh->comm,
                  "%s: the point is not on the loaded '%s'; allowed: a point of it in the reference state; its nearest "
                  "node is at (%.6g, %.6g, %.6g), %.3g away",
                  where, fluid->load->region, (double)X[0], (double)X[1], (double)X[2], (double)distance));
  }
  flag[n] = 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the pairs whose slaves or masters are on the surface. A master that is no slave measures at its nodes. */
static PetscErrorCode FindPairs(Fluids fluids, Fluid *fluid)
{
  const Contact contact = fluids->contact;
  char         *flag;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fluid->surface->graph.n, &flag));
  PetscCall(PetscCalloc2(ContactPairs(contact), &fluid->pair, ContactPairs(contact), &fluid->reacts));
  for (int p = 0; p < ContactPairs(contact); p++) {
    const SceneContact *scene = ContactPairScene(contact, p);
    const MeshGroup    *slave;
    PetscReal           size;
    PetscInt            n;

    PetscCall(ContactPairSurface(contact, p, &slave, &size));
    PetscCall(SurfaceGraphGroup(fluid->surface, slave, flag, &n));
    fluid->pair[p] = (PetscBool)(n > 0);
    if (!n) continue;
    fluid->form[PairForm(fluids, p)] = PETSC_TRUE;
    fluid->finer                     = PetscMax(fluid->finer, ContactPairFiner(contact, p));
    if (scene->listed)
      PetscCall(RefuseInput(fluids->mesh->comm,
                            "%s: '%s' is in contact '%s', which lists surfaces; allowed with where: open: contact by "
                            "slave and master",
                            SceneWhere(fluids->scene, fluid->load->path, "where"), fluid->load->region, scene->name));
    if (scene->adjust || scene->augment)
      PetscCall(
        RefuseInput(fluids->mesh->comm,
                    "%s: the penalty of contact '%s' on '%s' is adjusted or augmented; allowed with where: open: "
                    "a penalty without adjust and augment",
                    SceneWhere(fluids->scene, fluid->load->path, "where"), scene->name, fluid->load->region));
    fluid->friction = (PetscBool)(fluid->friction || scene->friction);
  }
  PetscCall(PetscFree(flag));
  PetscCall(FluidFindMasters(fluids, fluid));
  if (!fluid->form[FLUID_NODES] && !fluid->form[FLUID_FACES] && !fluid->master)
    PetscCall(RefuseInput(fluids->mesh->comm,
                          "%s: '%s' is in no contact pair; allowed with where: open: the slave of one or more pairs, "
                          "or a master that deforms",
                          SceneWhere(fluids->scene, fluid->load->path, "surface"), fluid->load->region));
  if (!fluid->form[FLUID_FACES]) fluid->form[FLUID_NODES] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a formula that is negative at some t. */
static PetscErrorCode CheckPressure(Fluids fluids, const Fluid *fluid)
{
  PetscFunctionBeginUser;
  for (int k = 0; k <= FLUID_SAMPLES; k++) {
    const PetscReal t = (PetscReal)k / FLUID_SAMPLES;
    PetscReal       pressure;

    PetscCall(LoadsPressure(fluids->loads, fluid->number, t, &pressure));
    if (pressure < 0)
      PetscCall(RefuseInput(fluids->mesh->comm,
                            "%s: is %g at t = %g; allowed with where: open: 0 or more (a fluid presses)",
                            SceneWhere(fluids->scene, fluid->load->path, "pressure"), (double)pressure, (double)t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateOne(Fluids fluids, int load, Fluid *fluid)
{
  const Mesh mesh = fluids->mesh;
  MeshGroup *group;
  int        n, form;

  PetscFunctionBeginUser;
  fluid->number = load;
  fluid->load   = &fluids->scene->loads[load];
  PetscCall(
    MeshGetGroup(mesh, fluids->scene, fluid->load->path, "surface", fluid->load->region, mesh->dim - 1, &group));
  fluid->group = group;
  PetscCall(SurfaceGraphCreate(mesh, group, &fluid->surface));
  n = fluid->surface->graph.n;
  PetscCall(FindPairs(fluids, fluid));
  PetscCall(PetscCalloc5(n, &fluid->from, n, &fluid->to, n, &fluid->laid, n, &fluid->lubricated, n, &fluid->weight));
  PetscCall(PetscCalloc2(n, &fluid->share, n, &fluid->bears));
  for (int form = 0; form < FLUID_FORMS; form++)
    PetscCall(PetscCalloc2(mesh->n_nodes, &fluid->area[form], mesh->n_nodes, &fluid->force[form]));
  PetscCall(PetscCalloc4(mesh->n_nodes, &fluid->wet, mesh->n_nodes, &fluid->dry, mesh->n_nodes, &fluid->pressing,
                         mesh->n_nodes, &fluid->pressing_form));
  PetscCall(
    PetscCalloc2(group->n_faces * FACE_MAX_NODES, &fluid->nodes, group->n_faces * FACE_MAX_POINTS, &fluid->points));
  PetscCall(StateCreate(n, &fluid->now));
  PetscCall(StateCreate(n, &fluid->accepted));
  fluid->height = fluid->leak_t = fluid->leak_pressure = NAN;
  PetscCall(CheckPressure(fluids, fluid));
  PetscCall(ReadEnd(fluids, fluid, "from", &fluid->load->from, fluid->from, &fluid->has_from));
  PetscCall(ReadEnd(fluids, fluid, "to", &fluid->load->to, fluid->to, &fluid->has_to));
  form = fluid->form[FLUID_FACES] ? FLUID_FACES : FLUID_NODES;
  PetscCall(SetFormAreas(fluids, fluid, form, NULL));
  PetscCall(SurfaceGraphGather(fluid->surface, fluid->area[form], fluid->weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidCreate - creates the fluids of a scene, dry.

  Collective

  Input Parameters:
+ mesh    - borrowed
. scene   - borrowed
. loads   - which hold their pressures; borrowed
- contact - borrowed

  Output Parameter:
. out - NULL where the scene has none; free it with FluidDestroy()

  Note:
  It refuses a surface that is no slave, ends that are not on it, and penalties that follow penetrations.
@*/
PetscErrorCode FluidCreate(Mesh mesh, Scene scene, Loads loads, Contact contact, Fluids *out)
{
  Fluids fluids;
  int    n = 0;

  PetscFunctionBeginUser;
  *out = NULL;
  for (int l = 0; l < scene->n_loads; l++) n += scene->loads[l].open;
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&fluids));
  *out            = fluids; /* FluidDestroy() frees what a refusal leaves */
  fluids->mesh    = mesh;
  fluids->scene   = scene;
  fluids->loads   = loads;
  fluids->contact = contact;
  PetscCall(PetscCalloc2(n, &fluids->fluid, n, &fluids->order));
  for (int l = 0; l < scene->n_loads; l++)
    if (scene->loads[l].open) PetscCall(CreateOne(fluids, l, &fluids->fluid[fluids->n++]));
  for (int i = 0; i < fluids->n; i++) PetscCall(FluidCheckMasters(fluids, &fluids->fluid[i]));
  n = 0;
  for (int masters = 0; masters < 2; masters++)
    for (int i = 0; i < fluids->n; i++)
      if (fluids->fluid[i].master == (PetscBool)masters) fluids->order[n++] = i;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidDestroy - frees the fluids.

  Not collective

  Input Parameter:
. fluids - set to NULL; may be NULL already
@*/
PetscErrorCode FluidDestroy(Fluids *fluids)
{
  PetscFunctionBeginUser;
  if (!*fluids) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < (*fluids)->n; i++) {
    Fluid *fluid = &(*fluids)->fluid[i];

    PetscCall(SurfaceGraphDestroy(&fluid->surface));
    PetscCall(PetscFree2(fluid->share, fluid->bears));
    PetscCall(PetscFree5(fluid->from, fluid->to, fluid->laid, fluid->lubricated, fluid->weight));
    for (int form = 0; form < FLUID_FORMS; form++) PetscCall(PetscFree2(fluid->area[form], fluid->force[form]));
    PetscCall(PetscFree4(fluid->wet, fluid->dry, fluid->pressing, fluid->pressing_form));
    PetscCall(PetscFree2(fluid->nodes, fluid->points));
    PetscCall(PetscFree2(fluid->pair, fluid->reacts));
    PetscCall(PetscFree4(fluid->now.wet, fluid->now.p, fluid->now.form, fluid->now.react));
    PetscCall(PetscFree4(fluid->accepted.wet, fluid->accepted.p, fluid->accepted.form, fluid->accepted.react));
  }
  PetscCall(PetscFree2((*fluids)->fluid, (*fluids)->order));
  PetscCall(PetscFree(*fluids));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the ends of a loaded line that the scene does not name: the fluid comes from the end that is open at the
   start, and leaks at the other one. */
static PetscErrorCode ChooseEnds(Fluids fluids, Fluid *fluid)
{
  const SurfaceGraph s    = fluid->surface;
  const char        *key  = SceneWhere(fluids->scene, fluid->load->path, "from");
  int                ends = 0, open = 0, end[2] = {-1, -1}, wet = -1;
  PetscReal         *gap;

  PetscFunctionBeginUser;
  if (fluid->has_from && fluid->has_to) PetscFunctionReturn(PETSC_SUCCESS);
  if (fluids->mesh->dim == 3 && !fluid->has_from)
    PetscCall(RefuseInput(fluids->mesh->comm,
                          "%s: is missing; allowed: a surface, a curve or one of its points from which the fluid "
                          "enters (in three dimensions it has no default)",
                          key));
  if (fluids->mesh->dim == 3) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(fluids->mesh->n_nodes, &gap));
  for (int i = 0; i < s->graph.n; i++)
    if (s->own[i] && s->rim[i]) {
      const PetscReal g = ContactNodeGap(fluids->contact, s->local[i]);

      gap[s->local[i]] = PetscIsNanReal(g) || g > FLUID_OPEN * fluids->mesh->size ? 1 : 0;
    }
  PetscCall(SurfaceGraphGather(s, gap, fluid->now.p));
  PetscCall(PetscFree(gap));
  for (int i = 0; i < s->graph.n; i++) {
    if (!s->rim[i]) continue;
    if (ends < 2) end[ends] = i;
    ends++;
    open += fluid->now.p[i] > 0;
    if (fluid->now.p[i] > 0) wet = i;
  }
  if (!fluid->has_from && (ends != 2 || open != 1))
    PetscCall(RefuseInput(fluids->mesh->comm,
                          "%s: is missing, and of the %d ends of '%s' %d are open at the start; allowed: a surface or "
                          "one of its points from which the fluid enters",
                          key, ends, fluid->load->region, open));
  if (!fluid->has_from) fluid->from[wet] = 1;
  if (!fluid->has_to && ends == 2 && fluid->from[end[0]] != fluid->from[end[1]]) {
    wet                                        = fluid->from[end[0]] ? end[0] : end[1];
    fluid->to[wet == end[0] ? end[1] : end[0]] = 1;
    fluid->has_to                              = PETSC_TRUE;
  }
  fluid->has_from = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidStart - finds the ends of the surfaces that the scene does not name, and wets what is open before any load.

  Collective

  Input Parameters:
+ fluids - may be NULL
- u      - local displacements at t = 0, u[n_nodes*dim] (length), for which the contact was evaluated

  Note:
  It refuses ends that the state does not show.
@*/
PetscErrorCode FluidStart(Fluids fluids, const PetscReal *u)
{
  PetscBool moved;

  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid *fluid = &fluids->fluid[fluids->order[i]];

    PetscCall(ChooseEnds(fluids, fluid));
    for (int k = 0; k < fluid->surface->graph.n; k++)
      if (fluid->from[k] && fluid->to[k])
        PetscCall(RefuseInput(fluids->mesh->comm, "%s: the two ends of '%s' have a node in common; allowed: ends apart",
                              SceneWhere(fluids->scene, fluid->load->path, "to"), fluid->load->region));
    PetscCall(MoveOne(fluids, fluid, u, 0, &moved));
    PetscCall(StateCopy(fluid->surface->graph.n, &fluid->now, &fluid->accepted));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidBegins - says whether a fluid has no pressure at a breakpoint of the loads, so that it may begin to press there.

  Not collective, the same on all ranks

  Input Parameters:
+ fluids - may be NULL
- t      - load parameter at which loads change their rate

  Output Parameter:
. begins - there is such a fluid
@*/
PetscErrorCode FluidBegins(Fluids fluids, PetscReal t, PetscBool *begins)
{
  PetscFunctionBeginUser;
  *begins = PETSC_FALSE;
  for (int i = 0; fluids && i < fluids->n; i++) {
    PetscReal pressure;

    PetscCall(LoadsPressure(fluids->loads, fluids->fluid[i].number, t, &pressure));
    *begins = (PetscBool)(*begins || pressure == 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidBegin - begins a load step: the fluids are where they were accepted, with their pressures at t.

  Collective

  Input Parameters:
+ fluids - may be NULL
. u      - local displacements, u[n_nodes*dim] (length), for the areas
- t      - load parameter
@*/
PetscErrorCode FluidBegin(Fluids fluids, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid *fluid = &fluids->fluid[i];

    PetscCall(StateCopy(fluid->surface->graph.n, &fluid->accepted, &fluid->now));
    FindBearing(fluid);
    fluid->shut = fluid->drained = PETSC_FALSE;
    PetscCall(PetscArrayzero(fluid->laid, fluid->surface->graph.n));
    PetscCall(PetscArrayzero(fluid->lubricated, fluid->surface->graph.n));
    PetscCall(LayAhead(fluid));
    PetscCall(Apply(fluids, fluid, u, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidMove - wets and dries the surfaces as the contact of a solution says.

  Collective

  Input Parameters:
+ fluids - may be NULL
. u      - local displacements of the solution, u[n_nodes*dim] (length), for which the contact was evaluated
- t      - load parameter

  Output Parameter:
. moved - some place became wet or dry: the step must be solved on
@*/
PetscErrorCode FluidMove(Fluids fluids, const PetscReal *u, PetscReal t, PetscBool *moved)
{
  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  for (int i = 0; fluids && i < fluids->n; i++) {
    PetscBool one;

    PetscCall(MoveOne(fluids, &fluids->fluid[fluids->order[i]], u, t, &one));
    *moved = (PetscBool)(*moved || one);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The pressure at which a fluid has leaked: where its pressure and the barrier met, on straight lines through the last
   two states without a leak, but not outside the step of the leak. */
static PetscReal LeakPressure(const Fluid *fluid)
{
  const FluidState *s = &fluid->accepted;
  const PetscReal   p = s->sealed_p[0], q = fluid->pressure;
  PetscReal         fall, found           = s->barrier[0]; /* a contact that does not change */

  fall = ((s->sealed_p[0] - s->barrier[0]) - (s->sealed_p[1] - s->barrier[1])); /* of the margin, over the two */
  if (s->n_sealed == FLUID_STATES && fall > 0) found = p + (s->barrier[0] - p) * (p - s->sealed_p[1]) / fall;
  return PetscMax(PetscMin(p, q), PetscMin(PetscMax(p, q), found));
}

/*@
  FluidReaches - says whether a fluid reaches its other end.

  Not collective, the same on all ranks

  Input Parameters:
+ fluids - may be NULL
. t_0    - load parameter of the accepted state
. t      - load parameter of the present state
- dt_min - the shortest step that may be made

  Output Parameters:
+ reaches - a fluid does
- closely - the step is short enough to say at which pressure, or cannot be made shorter
@*/
PetscErrorCode FluidReaches(Fluids fluids, PetscReal t_0, PetscReal t, PetscReal dt_min, PetscBool *reaches,
                            PetscBool *closely)
{
  const PetscReal dt = t - t_0;

  PetscFunctionBeginUser;
  *reaches = PETSC_FALSE;
  *closely = PETSC_TRUE;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid    *fluid = &fluids->fluid[i];
    PetscReal before;

    if (!ReachesEnd(fluid)) continue;
    *reaches = PETSC_TRUE;
    PetscCall(LoadsPressure(fluids->loads, fluid->number, t_0, &before));
    if (dt > FLUID_LEAK_STEP * t || PetscAbsReal(fluid->pressure - before) > FLUID_LEAK_STEP * fluid->pressure)
      *closely = PETSC_FALSE;
    fluid->leak_t        = t;
    fluid->leak_pressure = LeakPressure(fluid);
  }
  if (dt < FLUID_CUT * dt_min) *closely = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lays the load on wet places alone, as far as they bear it. */
static PetscErrorCode ApplyWet(Fluids fluids, Fluid *fluid, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(fluid->laid, fluid->bears, fluid->surface->graph.n));
  PetscCall(PetscArraycpy(fluid->lubricated, fluid->now.wet, fluid->surface->graph.n));
  PetscCall(Apply(fluids, fluid, u, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidSettle - lays the loads of a converged step on wet places alone, so that contact shows all that it presses.

  Collective

  Input Parameters:
+ fluids - may be NULL
. u      - local displacements of the solution, u[n_nodes*dim] (length), at which FluidMove() has moved nothing
- t      - its load parameter
@*/
PetscErrorCode FluidSettle(Fluids fluids, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid *fluid = &fluids->fluid[fluids->order[i]];

    PetscCall(FluidMeasureReactions(fluids, fluid, u));
    PetscCall(ApplyWet(fluids, fluid, u, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidAccept - makes the present wet places those of the accepted state.

  Collective

  Input Parameters:
+ fluids - may be NULL
. u      - local displacements of the state, u[n_nodes*dim] (length)
- t      - its load parameter
@*/
PetscErrorCode FluidAccept(Fluids fluids, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid      *fluid = &fluids->fluid[fluids->order[i]];
    FluidState *now   = &fluid->now;

    PetscCall(Measure(fluids, fluid, u, t));
    PetscCall(FindBarrier(fluid));
    if (fluid->has_to) {
      now->n_sealed    = PetscMin(FLUID_STATES, now->n_sealed + 1);
      now->sealed_p[1] = now->sealed_p[0];
      now->barrier[1]  = now->barrier[0];
      now->sealed_p[0] = fluid->pressure;
      now->barrier[0]  = fluid->height;
    }
    fluid->leak_t = fluid->leak_pressure = NAN;
    PetscCall(StateCopy(fluid->surface->graph.n, now, &fluid->accepted));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidRestore - returns to the accepted state.

  Collective

  Input Parameters:
+ fluids - may be NULL
. u      - local displacements of the accepted state, u[n_nodes*dim] (length)
- t      - its load parameter
@*/
PetscErrorCode FluidRestore(Fluids fluids, const PetscReal *u, PetscReal t)
{
  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid *fluid = &fluids->fluid[i];

    PetscCall(StateCopy(fluid->surface->graph.n, &fluid->accepted, &fluid->now));
    FindBearing(fluid);
    PetscCall(ApplyWet(fluids, fluid, u, t));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidArchive - saves or loads the accepted state.

  Collective

  Input Parameters:
+ fluids  - may be NULL; FluidRestore() comes after loading
- archive - decides whether the state is saved or loaded
@*/
PetscErrorCode FluidArchive(Fluids fluids, Archive archive)
{
  PetscFunctionBeginUser;
  for (int i = 0; fluids && i < fluids->n; i++) {
    Fluid      *fluid = &fluids->fluid[i];
    FluidState *state = &fluid->accepted;
    const int   n     = fluid->surface->graph.n;
    PetscReal   values[2 * FLUID_STATES];
    PetscInt   *wet;
    char        name[64];

    PetscCall(PetscMalloc1(n + 1, &wet));
    for (int k = 0; k < n; k++) wet[k] = state->wet[k] + 2 * fluid->from[k] + 4 * fluid->to[k] + 8 * state->form[k];
    wet[n] = state->n_sealed;
    for (int k = 0; k < FLUID_STATES; k++) {
      values[k]                = state->sealed_p[k];
      values[FLUID_STATES + k] = state->barrier[k];
    }
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/%d/wet", i));
    PetscCall(ArchiveIntegers(archive, name, n + 1, wet));
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/%d/values", i));
    PetscCall(ArchiveReals(archive, name, 2 * FLUID_STATES, values));
    for (int k = 0; k < n; k++) {
      state->wet[k]  = (char)(wet[k] & 1);
      state->form[k] = (char)(wet[k] >> 3 & 1);
      fluid->from[k] = (char)(wet[k] >> 1 & 1);
      fluid->to[k]   = (char)(wet[k] >> 2 & 1);
      fluid->has_to  = (PetscBool)(fluid->has_to || fluid->to[k]);
    }
    state->n_sealed = wet[n];
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/%d/pressure", i));
    PetscCall(ArchiveReals(archive, name, n, state->p));
    PetscCall(PetscSNPrintf(name, sizeof(name), "fluid/%d/reaction", i));
    PetscCall(ArchiveReals(archive, name, n, state->react));
    for (int k = 0; k < FLUID_STATES; k++) {
      state->sealed_p[k] = values[k];
      state->barrier[k]  = values[FLUID_STATES + k];
    }
    PetscCall(PetscFree(wet));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FluidCount - returns the number of fluids, 0 for NULL.

  Not collective

  Input Parameter:
. fluids - the fluids, or NULL
@*/
int FluidCount(Fluids fluids)
{
  return fluids ? fluids->n : 0;
}

/*@
  FluidFind - returns the number of the fluid on a surface, or -1.

  Not collective

  Input Parameters:
+ fluids  - the fluids, or NULL
- surface - its name in the scene
@*/
int FluidFind(Fluids fluids, const char *surface)
{
  for (int i = 0; i < FluidCount(fluids); i++)
    if (!strcmp(fluids->fluid[i].load->region, surface)) return i;
  return -1;
}

/*@
  FluidGetReport - says where a fluid is in the last accepted state, and when it leaked.

  Not collective, the same on all ranks

  Input Parameters:
+ fluids - the fluids
- i      - number of the fluid

  Output Parameter:
. report - its state
@*/
void FluidGetReport(Fluids fluids, int i, FluidReport *report)
{
  const Fluid      *fluid = &fluids->fluid[i];
  const FluidState *state = &fluid->accepted;
  PetscReal         wet = 0, all = 0;

  for (int k = 0; k < fluid->surface->graph.n; k++) {
    all += fluid->weight[k];
    wet += state->wet[k] ? fluid->weight[k] : 0;
  }
  *report = (FluidReport){.load          = fluid->load,
                          .pressure      = fluid->pressure,
                          .wetted        = wet / all,
                          .barrier       = state->barrier[0],
                          .leak_t        = fluid->leak_t,
                          .leak_pressure = fluid->leak_pressure};
}

/*@
  FluidLeakText - names the fluids that were found to leak last and the pressures at which they did.

  Not collective

  Input Parameters:
+ fluids - the fluids
- size   - of the text

  Output Parameter:
. text - for example "the fluid on 'lip' leaks at a pressure of 1.7"; empty without a leak
@*/
void FluidLeakText(Fluids fluids, char *text, size_t size)
{
  text[0] = '\0';
  for (int i = 0; i < FluidCount(fluids); i++) {
    const size_t used = strlen(text);
    FluidReport  report;

    FluidGetReport(fluids, i, &report);
    if (PetscIsNanReal(report.leak_t)) continue;
    snprintf(text + used, size - used, "%sthe fluid on '%s' leaks at a pressure of %.4g", used ? "; " : "",
             report.load->region, (double)report.leak_pressure);
  }
}

/* Part of the way from the wet node a to its dry neighbour b where contact presses as much as the fluid: on the
   straight line through b and the dry node behind it. On the side of the fluid contact alone has no pressure to go by.
 */
static PetscReal FrontBetween(const Fluid *fluid, int a, int b)
{
  const SurfaceGraph s     = fluid->surface;
  const PetscReal   *X     = s->X;
  PetscReal          ahead = 0, slope = 0, length = 0;

  for (int d = 0; d < 3; d++) length += PetscSqr(X[3 * b + d] - X[3 * a + d]);
  length = PetscSqrtReal(length);
  for (int k = s->ptr[b]; k < s->ptr[b + 1]; k++) {
    const int c      = s->adj[k];
    PetscReal cosine = 0, far = 0;

    if (c == a || fluid->accepted.wet[c]) continue;
    for (int d = 0; d < 3; d++) {
      cosine += (X[3 * c + d] - X[3 * b + d]) * (X[3 * b + d] - X[3 * a + d]) / length;
      far += PetscSqr(X[3 * c + d] - X[3 * b + d]);
    }
    far = PetscSqrtReal(far);
    if (cosine <= ahead * far) continue;
    ahead = cosine / far;
    slope = (fluid->accepted.p[c] - fluid->accepted.p[b]) / far;
  }
  if (slope * length <= 0)
    slope = fluid->accepted.p[b] / length; /* a crest: as if the pressure fell to 0 within one face */
  return slope > 0 ? PetscMax(0, 1 - (fluid->accepted.p[b] - fluid->pressure) / (slope * length)) : 1;
}

/*@
  FluidFront - finds how far a fluid has come along an axis in the last accepted state.

  Collective

  Input Parameters:
+ fluids   - the fluids
. i        - number of the fluid
. u        - local displacements of that state, u[n_nodes*dim] (length)
. axis     - 0 to 2
- max_side - PETSC_TRUE: the largest coordinate of a wet place, PETSC_FALSE: the smallest

  Output Parameter:
. front - present coordinate, in the coordinates of the mesh file, the same on all ranks; NaN where nothing is wet

  Note:
  Between a wet and a dry node the front is where the contact pressure is that of the fluid.
@*/
PetscErrorCode FluidFront(Fluids fluids, int i, const PetscReal *u, int axis, PetscBool max_side, PetscReal *front)
{
  const Fluid       *fluid = &fluids->fluid[i];
  const SurfaceGraph s     = fluid->surface;
  const int          sign = max_side ? 1 : -1, dim = fluids->mesh->dim;
  PetscReal          best = PETSC_MIN_REAL, *local, *x;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(fluids->mesh->n_nodes, &local, s->graph.n, &x));
  for (PetscInt k = 0; k < fluids->mesh->n_nodes; k++) local[k] = u[k * dim + axis];
  PetscCall(SurfaceGraphGather(s, local, x));
  for (int a = 0; a < s->graph.n; a++) x[a] += s->X[3 * a + axis];
  for (int a = 0; a < s->graph.n; a++) {
    if (!fluid->accepted.wet[a]) continue;
    best = PetscMax(best, sign * x[a]);
    for (int k = s->ptr[a]; k < s->ptr[a + 1]; k++) {
      const int b = s->adj[k];

      if (!fluid->accepted.wet[b]) best = PetscMax(best, sign * (x[a] + FrontBetween(fluid, a, b) * (x[b] - x[a])));
    }
  }
  *front = best > PETSC_MIN_REAL ? sign * best : NAN;
  PetscCall(PetscFree2(local, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
