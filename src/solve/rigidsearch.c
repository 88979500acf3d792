/* The rigid search: bodies that only contact holds move along their loads, without force, until they rest on what is in
   their way. */
#include "freebodiesimpl.h"
#include "base/halfspaces.h"
#include "contact/contactstep.h"

/* First and longest move of one pass, in face sizes of the slaves. The contact lists of a pass are made for its move;
   longer ones hold many faces for each point. */
#define SEARCH_FIRST   2
#define SEARCH_LONGEST 16
/* A body that has moved this many sizes of the model meets nothing. */
#define SEARCH_FARTHEST 4
/* A body that has moved by this part of a pass's move in it was not in touch with anything. */
#define SEARCH_FREE 0.9
/* A body that a pass moves this many times as far as it may is pushed out by gaps that contradict each other. */
#define SEARCH_BEYOND 2
/* Bodies rest where a pass moves them by less than this part of a face size, or by SEARCH_SLOW of what it allows, for
   SEARCH_RESTS passes. The loads then press them onto their contacts within this angle. */
#define SEARCH_REST  1e-7
#define SEARCH_SLOW  1e-3
#define SEARCH_RESTS 3
/* Passes with a body in touch. Where it slides and rolls on curved surfaces, each pass is a step of Newton's method. */
#define SEARCH_PASSES 40
/* A pass gets on if the loads do this part of the work that they would do over its length without anything in the way.
   One that does not is followed by one of half the length: bodies rock to and fro where facets meet. */
#define SEARCH_WORK 0.1
/* Surfaces that overlap at the start by more than this part of a face size do so on purpose, and are left so. */
#define SEARCH_OVERLAP 0.1
/* What overlaps a master by more than SEARCH_STRAY of a face, with no more than this part of its area, is mostly past
   an end of that master, where gaps are wrong by what the last faces leave of its shape. It is in nothing's way, unless
   a body that goes on without it meets nothing. */
#define SEARCH_PAST  0.25
#define SEARCH_STRAY 1e-3
/* Bodies turn this many times less readily than they move along, until they rest. Where they touch at one point that is
   not quite below their loads, which depends on the mesh, they would fall over it. */
#define SEARCH_HEAVY 100
/* They go on and turn freely where the loads would then do more than this part of the work that they could do. */
#define SEARCH_FALL 0.1
/* Bodies that touch with friction slide this many times less readily than they move otherwise: friction may hold them.
 */
#define SEARCH_RUBS 1e9
/* A body without a load gives way to those with one: its weight in theirs. */
#define SEARCH_LIGHT 1e-3

/* One pass: the wish of the loads, and the contact terms that bound it. */
typedef struct {
  int        n;
  double    *gram, *factor;        /* products of the motions; Cholesky's factor of them with the pieces' weights */
  double    *force, *scale, *wish; /* n each */
  PetscReal *weight;               /* of each piece */
  PetscBool *driven;               /* by loads, of each piece */
  PetscBool  strict;               /* all terms are in the way of bodies */
  PetscBool  spared;               /* some were not */
  PetscInt   n_terms;
  double    *normal, *bound; /* n_terms*n; n_terms */
} Pass;

static PetscErrorCode PassCreate(FreeBodies b, Pass *pass)
{
  const int n = b->n;

  PetscFunctionBeginUser;
  *pass = (Pass){.n = n};
  PetscCall(PetscMalloc5(n * n, &pass->gram, n * n, &pass->factor, n, &pass->force, n, &pass->scale, n, &pass->wish));
  PetscCall(PetscMalloc2(b->n_pieces, &pass->weight, b->n_pieces, &pass->driven));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode PassDestroy(Pass *pass)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(pass->gram, pass->factor, pass->force, pass->scale, pass->wish));
  PetscCall(PetscFree2(pass->weight, pass->driven));
  PetscCall(PetscFree2(pass->normal, pass->bound));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the loads would take each body if nothing was in its way: as they would accelerate it, over a distance of
   `move`. The weights of the pieces are such that the wish balances the loads. heavy: bodies hardly turn. *any: a load
   drives some body. */
static PetscErrorCode Wish(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscReal move,
                           PetscBool heavy, Pass *pass, PetscBool *any)
{
  const int  n = b->n;
  PetscReal *longest, lightest = PETSC_MAX_REAL;

  PetscFunctionBeginUser;
  PetscCall(FreeBodiesGram(b, u, pass->gram));
  for (int k = 0; k < n && heavy; k++)
    if (FreeBodiesTurns(b, k)) pass->gram[k * n + k] *= SEARCH_HEAVY;
  PetscCall(FreeBodiesRub(b, u, t, SEARCH_RUBS, pass->gram));
  PetscCall(FreeBodiesForce(b, u, t_loads, pass->force, pass->scale));
  PetscCall(PetscMalloc1(b->n_pieces, &longest));
  PetscCall(PetscArraycpy(pass->wish, pass->force, n));
  RigidCholesky(n, pass->gram, pass->factor);
  RigidSolve(n, pass->factor, pass->wish);
  PetscCall(FreeBodiesLongest(b, u, pass->wish, longest));
  *any = PETSC_FALSE;
  for (PetscInt p = 0; p < b->n_pieces; p++) pass->driven[p] = PETSC_FALSE;
  for (int k = 0; k < n; k++) /* by a load of its own: friction couples the motions of bodies that touch */
    if (pass->force[k] != 0 && longest[b->owner[k]] > 0) pass->driven[b->owner[k]] = PETSC_TRUE;
  for (PetscInt p = 0; p < b->n_pieces; p++) {
    pass->weight[p] = pass->driven[p] ? longest[p] / move : 0;
    if (!pass->driven[p]) continue;
    *any     = PETSC_TRUE;
    lightest = PetscMin(lightest, pass->weight[p]);
  }
  for (PetscInt p = 0; p < b->n_pieces; p++)
    if (!pass->driven[p]) pass->weight[p] = SEARCH_LIGHT * lightest;
  for (int k = 0; k < n; k++) {
    pass->wish[k] = pass->force[k];
    for (int l = 0; l < n; l++)
      pass->factor[k * n + l] =
        PetscSqrtReal(pass->weight[b->owner[k]] * pass->weight[b->owner[l]]) * pass->gram[k * n + l];
  }
  if (*any) RigidCholesky(n, pass->factor, pass->factor);
  if (*any) RigidSolve(n, pass->factor, pass->wish);
  PetscCall(PetscFree(longest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is a term in the way of a body? */
static PetscBool InTheWay(FreeBodies b, const ActiveSetTerm *term)
{
  return (PetscBool) !(term->share <= SEARCH_PAST && term->opening < -SEARCH_STRAY * b->face);
}

/* The contact terms that the bodies at (u, t) may reach by a move, as bounds to it. In: *overlap is the deepest overlap
   that is left as it is; first: it is measured here. NULL: terms that press stay as deep as they are. */
static PetscErrorCode Bounds(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal move, PetscBool first, Pass *pass,
                             PetscReal *overlap)
{
  const int            n = b->n;
  PetscReal           *du, *travel;
  double              *a;
  ContactStep          step;
  const ActiveSetTerm *terms;

  PetscFunctionBeginUser;
  PetscCall(PetscFree2(pass->normal, pass->bound));
  PetscCall(PetscMalloc1(b->mesh->n_nodes * b->mesh->dim, &du));
  PetscCall(PetscCalloc1(n, &a));
  for (PetscInt i = 0; i < b->mesh->n_nodes * b->mesh->dim; i++) du[i] = move; /* one body may push the others */
  PetscCall(ContactStepCreate(b->contact, u, du, t, t, &step));
  PetscCall(ContactStepGetTerms(step, &pass->n_terms, &terms));
  PetscCall(PetscMalloc2(n * pass->n_terms, &pass->normal, pass->n_terms, &pass->bound));
  PetscCall(PetscMalloc1(pass->n_terms, &travel));
  for (int k = 0; k < n; k++) {
    a[k] = 1;
    FreeBodiesVelocity(b, u, a, du);
    a[k] = 0;
    PetscCall(ContactStepTravel(step, du, t, t, travel, NULL));
    for (PetscInt i = 0; i < pass->n_terms; i++) pass->normal[i * n + k] = travel[i];
  }
  if (first && overlap) *overlap = 0;
  for (PetscInt i = 0; i < pass->n_terms; i++) {
    PetscReal moves = 0;

    for (int k = 0; k < n; k++) moves = PetscMax(moves, PetscAbsReal(pass->normal[i * n + k]));
    if (moves > 0 && !pass->strict && !InTheWay(b, &terms[i])) {
      moves        = 0;
      pass->spared = PETSC_TRUE;
    }
    if (first && overlap && moves > 0 && terms[i].opening < -SEARCH_OVERLAP * b->face)
      *overlap = PetscMax(*overlap, -terms[i].opening);
    pass->bound[i] = moves > 0 ? -terms[i].opening : -PETSC_MAX_REAL;
  }
  for (PetscInt i = 0; i < pass->n_terms; i++)
    pass->bound[i] = overlap ? pass->bound[i] - *overlap : PetscMin(pass->bound[i], 0);
  PetscCall(ContactStepDestroy(&step));
  PetscCall(PetscFree(travel));
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion nearest to `wanted` within the bounds, into wish: both in the coordinates in which a product is the sum of
   the products of the numbers. The first rank's result serves all. */
static PetscErrorCode Project(FreeBodies b, const double wanted[], Pass *pass)
{
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(pass->wish, wanted, pass->n));
  HalfspacesProject(pass->n, (int)pass->n_terms, pass->normal, pass->bound, SEARCH_REST * b->face, pass->wish);
  RigidBackward(pass->n, pass->factor, pass->wish);
  PetscCallMPI(MPI_Bcast(pass->wish, pass->n, MPI_DOUBLE, 0, b->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The motion nearest to the wish within the bounds, into wish, and its longest velocity on each piece. Where bodies fit
   so closely that gaps around them contradict each other by what faces leave of their shape, a motion that opens all
   overlaps is longer than the way for which the terms were chosen, or it is none at all. What presses stays as deep as
   it is then, so that no motion at all is within the bounds. */
static PetscErrorCode Bound(FreeBodies b, const PetscReal *u, PetscReal move, Pass *pass, PetscReal *longest)
{
  const int n   = pass->n;
  PetscBool far = PETSC_FALSE;
  double   *wanted;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &wanted));
  for (PetscInt i = 0; i < pass->n_terms; i++) RigidForward(n, pass->factor, &pass->normal[i * n]);
  for (int i = 0; i < n; i++)
    for (int k = i; k < n; k++) wanted[i] += pass->factor[k * n + i] * pass->wish[k];
  PetscCall(Project(b, wanted, pass));
  PetscCall(FreeBodiesLongest(b, u, pass->wish, longest));
  for (PetscInt p = 0; p < b->n_pieces; p++) far = (PetscBool)(far || longest[p] > SEARCH_BEYOND * move);
  if (far) {
    for (PetscInt i = 0; i < pass->n_terms; i++) pass->bound[i] = PetscMin(pass->bound[i], 0);
    PetscCall(Project(b, wanted, pass));
    PetscCall(FreeBodiesLongest(b, u, pass->wish, longest));
  }
  PetscCall(PetscFree(wanted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a stabilised body has no contact at all in the present state. */
static PetscErrorCode Untouched(FreeBodies b, PetscBool *any)
{
  PetscInt *closed, *touched;
  int      *on;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n_pieces, &closed));
  PetscCall(PetscCalloc1(b->n_pieces, &touched));
  PetscCall(PetscMalloc1(b->n_pieces, &on));
  for (int c = 0; c < b->scene->n_contacts; c++) {
    PetscInt sum = 0;

    PetscCall(ContactPairClosed(b->contact, c, b->piece, b->n_pieces, closed));
    PetscCall(FreeModesOnSide(b->modes, c, PETSC_TRUE, on));
    for (PetscInt p = 0; p < b->n_pieces; p++) sum += closed[p];
    for (PetscInt p = 0; p < b->n_pieces; p++) touched[p] += closed[p] + (on[p] ? sum : 0);
  }
  *any = PETSC_FALSE;
  for (PetscInt p = 0; p < b->n_pieces; p++)
    *any = (PetscBool)(*any || (b->stabilised[p] && b->pieces[p].n_free && !touched[p]));
  PetscCall(PetscFree(on));
  PetscCall(PetscFree(touched));
  PetscCall(PetscFree(closed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the loads at t_loads drive a body that was tied in the accepted state (u, t), as nothing moved it then,
   where no contact holds it. */
static PetscErrorCode ComesToFall(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool *falls)
{
  PetscFunctionBeginUser;
  *falls = PETSC_FALSE;
  for (int k = 0; k < b->n; k++) *falls = (PetscBool)(*falls || b->state[k] >= MOTION_TIED);
  if (!*falls) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ContactGather(b->contact, u, t, t, b->face));
  PetscCall(FreeBodiesFall(b, u, t, t_loads, SEARCH_FALL, falls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to the text how far each body came. */
static void NoteMoved(FreeBodies b, PetscReal t, const PetscReal *travel)
{
  size_t used = strlen(b->moved);

  for (PetscInt p = 0; p < b->n_pieces && used < sizeof(b->moved); p++) {
    if (!(travel[p] > SEARCH_REST * b->face)) continue;
    used += (size_t)snprintf(b->moved + used, sizeof(b->moved) - used, "%s'%s' by up to %.4g at t = %.4g",
                             used ? ", " : "", b->pieces[p].name, (double)travel[p], (double)t);
  }
}

/* The passes of FreeBodiesSettle(). presses: what presses stays as deep as it is. strict: all terms are in the way.
   travel[]: how far each piece came. *spared: some terms were not in the way. */
static PetscErrorCode Search(FreeBodies b, PetscReal t, PetscReal t_loads, PetscBool presses, PetscBool strict,
                             PetscReal *u, PetscReal travel[], SettleResult *result, PetscBool *spared)
{
  PetscReal move = SEARCH_FIRST * b->face, overlap = 0, way = 0, *longest;
  PetscBool any = PETSC_FALSE, heavy = PETSC_TRUE, rubs = ContactHasFriction(b->contact);
  PetscInt  rests = 0, touched = 0;
  Pass      pass;

  PetscFunctionBeginUser;
  *result = SETTLE_NONE;
  PetscCall(PassCreate(b, &pass));
  pass.strict = strict;
  PetscCall(PetscMalloc1(b->n_pieces, &longest));
  PetscCall(PetscArrayzero(travel, b->n_pieces));
  for (PetscInt it = 0; rests < SEARCH_RESTS && touched < SEARCH_PASSES; it++) {
    PetscReal most = 0, work = 0, wished = 0;

    PetscCall(FreeBodiesCentre(b, u));
    if (rubs) PetscCall(ContactGather(b->contact, u, t, t, move));
    PetscCall(Wish(b, u, t, t_loads, move, heavy, &pass, &any));
    if (!any) break;
    if (!rubs) PetscCall(ContactGather(b->contact, u, t, t, move));
    PetscCall(Bounds(b, u, t, move, (PetscBool)!it, &pass, presses ? NULL : &overlap));
    for (int k = 0; k < b->n; k++) wished += pass.force[k] * pass.wish[k];
    PetscCall(Bound(b, u, move, &pass, longest));
    for (int k = 0; k < b->n; k++) work += pass.force[k] * pass.wish[k];
    for (PetscInt p = 0; p < b->n_pieces; p++) {
      most = PetscMax(most, longest[p]);
      travel[p] += longest[p];
    }
    PetscCall(PetscInfo(NULL,
                        "rigid search: pass %" PetscInt_FMT ", %" PetscInt_FMT " terms, of %g moved %g, work %g\n", it,
                        pass.n_terms, (double)move, (double)most, (double)(work / wished)));
    FreeBodiesMove(b, pass.wish, u);
    way += most;
    if (most > SEARCH_REST * b->face) *result = SETTLE_MOVED;
    if (most > SEARCH_FREE * move) {
      *result = SETTLE_ADRIFT;
      if (way > SEARCH_FARTHEST * b->mesh->size) break;
      move = PetscMin(2 * move, SEARCH_LONGEST * b->face);
      continue;
    }
    *result = SETTLE_MOVED;
    touched++;
    rests = most <= SEARCH_REST * b->face ? SEARCH_RESTS : most <= SEARCH_SLOW * b->face ? rests + 1 : 0;
    if (work > SEARCH_WORK * wished * most / move)
      move = PetscMin(move, PetscMax(b->face, 2 * most));
    else
      move = PetscMax(SEARCH_REST * b->face, move / 2);
    if (!heavy || rests < SEARCH_RESTS) continue;
    PetscCall(ContactGather(b->contact, u, t, t, move));
    PetscCall(FreeBodiesFall(b, u, t, t_loads, SEARCH_FALL, &any));
    if (!any) break;
    heavy = PETSC_FALSE;
    rests = 0;
    move  = SEARCH_FIRST * b->face;
  }
  if (*result == SETTLE_MOVED && way <= SEARCH_REST * b->face) *result = SETTLE_NONE;
  *spared = pass.spared;
  PetscCall(PetscFree(longest));
  PetscCall(PassDestroy(&pass));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FreeBodiesSettle - moves the bodies along their loads, as rigid ones and without force, until they rest on what is in
  their way.

  Collective

  Input Parameters:
+ b       - the bodies
. t       - load parameter of the state
. t_loads - load parameter at which the loads are taken
- first   - bodies that touch already may move too; otherwise only where some body has no contact at all, or loads come
            to drive one along a motion that was tied

  Input/Output Parameter:
. u - local displacements u[n_nodes*dim] of the state (length)

  Output Parameter:
. result - whether they were moved, or one of them meets nothing and is driven on and on

  Notes:
  Each pass asks where the loads would take the bodies, and moves them to the nearest point that the gaps allow, to
  first order. Bodies without a load stay where they are until another one pushes them. The contact's lists and gaps
  are left as they were for the last pass; its state is not touched.

  Source: Gauss's principle of least constraint, with the contact conditions as inequalities.
@*/
PetscErrorCode FreeBodiesSettle(FreeBodies b, PetscReal t, PetscReal t_loads, PetscBool first, PetscReal *u,
                                SettleResult *result)
{
  const PetscInt size = b->mesh->n_nodes * b->mesh->dim;
  PetscBool      any = PETSC_FALSE, presses = PETSC_FALSE, spared;
  PetscReal     *start, *travel;

  PetscFunctionBeginUser;
  *result = SETTLE_NONE;
  if (!b->n) PetscFunctionReturn(PETSC_SUCCESS);
  if (!first) {
    PetscCall(Untouched(b, &any));
    if (!any) PetscCall(ComesToFall(b, u, t, t_loads, &presses));
    if (!any && !presses) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(size, &start, b->n_pieces, &travel));
  PetscCall(PetscArraycpy(start, u, size));
  PetscCall(Search(b, t, t_loads, presses, PETSC_FALSE, u, travel, result, &spared));
  if (*result == SETTLE_ADRIFT && spared) {
    PetscCall(PetscArraycpy(u, start, size));
    PetscCall(Search(b, t, t_loads, presses, PETSC_TRUE, u, travel, result, &spared));
  }
  if (*result == SETTLE_MOVED) NoteMoved(b, t, travel); /* the run takes no state in which a body is adrift */
  PetscCall(PetscFree2(start, travel));
  PetscFunctionReturn(PETSC_SUCCESS);
}
