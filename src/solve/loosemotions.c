/* Motions that neither contact nor ties hold: which they are, which of them loads drive, and their names. */
#include "freebodiesimpl.h"
#include "contact/contactstep.h"

/* The same for messages. Bodies that roll are seen by a contact patch with a slope of its width over their radius. */
#define FREE_BODIES_NAMED 3e-2
/* Tied motions are named with others in this unit. Its square is far below FREE_BODIES_HELD. */
#define FREE_BODIES_HIDDEN 1e-3
/* Bodies that were moved into contact touch with the terms that are open by less than this part of a face size. */
#define FREE_BODIES_TOUCH 1e-4
/* A traction this part below what friction can bear has reached it: states are known to their residuals. */
#define FREE_BODIES_LIMIT 1e-4

/* Product of two motions as term i of n sees them: of their travels and, where there are four values, slides. */
static PetscReal Together(int across, PetscBool along, PetscInt n, PetscInt i, const PetscReal *a, const PetscReal *b)
{
  PetscReal sum = along ? 0 : a[i] * b[i];

  for (int d = 0; d < across - 1; d++) sum += a[n + 3 * i + d] * b[n + 3 * i + d];
  return sum;
}

/* How the friction of terms counts: what slips too, alone, or not. */
typedef enum { GRAM_STICKS, GRAM_ALONG, GRAM_SLIPS } GramKind;

/* Does a term slip, or has it the largest traction that sticks? */
static PetscBool Slips(const ActiveSetTerm *term)
{
  const PetscReal bound = FrictionBound(&term->friction.law, term->pressure);

  return (PetscBool)(hypot(term->friction.traction[0], term->friction.traction[1]) >= (1 - FREE_BODIES_LIMIT) * bound);
}

/* Adds the force of term i to what the pieces carry that it sees: those whose motions change its gap, by travel[n]. */
static void Carry(FreeBodies b, PetscInt i, const ActiveSetTerm *term, PetscReal *const travel[])
{
  for (int k = 0, last = -1; k < b->n; k++) {
    if (b->owner[k] == last || travel[k][i] == 0) continue;
    last = b->owner[k];
    b->carried[last] += PetscAbsReal(term->pressure) * term->area;
  }
}

/* Stiffness gram[n][n] of the terms in contact, or touching, along the motions at (u, t), over the largest diagonal
   entry that it would have if nothing slipped. Friction counts as if nothing slipped, unless its kind says otherwise.
   The pieces remember what they carry. */
static PetscErrorCode ContactGram(FreeBodies b, const PetscReal *u, PetscReal t, PetscBool touching, GramKind kind,
                                  double gram[])
{
  const PetscInt       size   = b->mesh->n_nodes * b->mesh->dim;
  const int            n      = b->n;
  const int            across = ContactHasFriction(b->contact) ? 4 : 1; /* values of a term: travel, slide */
  PetscReal           *du, **travel, *sticks, largest = 0;
  double              *a;
  PetscInt             n_terms;
  const ActiveSetTerm *terms;
  ContactStep          step;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(gram, n * n));
  PetscCall(PetscCalloc1(n, &sticks));
  PetscCall(PetscArrayzero(b->carried, b->n_pieces));
  PetscCall(PetscMalloc1(size, &du));
  PetscCall(PetscMalloc1(n, &travel));
  PetscCall(PetscCalloc1(n, &a));
  for (PetscInt i = 0; i < size; i++) du[i] = b->face; /* terms whose gaps are farther from zero have no part in it */
  PetscCall(ContactStepCreate(b->contact, u, du, t, t, &step));
  PetscCall(ContactStepGetTerms(step, &n_terms, &terms));
  for (int k = 0; k < n; k++) {
    a[k] = 1;
    FreeBodiesVelocity(b, u, a, du);
    a[k] = 0;
    PetscCall(PetscMalloc1(across * n_terms, &travel[k]));
    PetscCall(ContactStepTravel(step, du, t, t, travel[k], across > 1 ? &travel[k][n_terms] : NULL));
  }
  for (PetscInt i = 0; i < n_terms; i++) {
    if (terms[i].pressure == 0 && !(touching && terms[i].opening <= FREE_BODIES_TOUCH * b->face)) continue;
    Carry(b, i, &terms[i], travel);
    for (int k = 0; k < n; k++)
      for (int l = 0; l < n; l++)
        gram[k * n + l] += Together(kind == GRAM_SLIPS && Slips(&terms[i]) ? 1 : across,
                                    (PetscBool)(kind == GRAM_ALONG), n_terms, i, travel[k], travel[l]) /
                           (b->pieces[b->owner[k]].size * b->pieces[b->owner[l]].size);
    for (int k = 0; k < n; k++)
      sticks[k] += Together(across, (PetscBool)(kind == GRAM_ALONG), n_terms, i, travel[k], travel[k]) /
                   PetscSqr(b->pieces[b->owner[k]].size);
  }
  for (int k = 0; k < n; k++) largest = PetscMax(largest, sticks[k]);
  for (int k = 0; k < n * n && largest > 0; k++) gram[k] /= largest;
  PetscCall(ContactStepDestroy(&step));
  for (int k = 0; k < n; k++) PetscCall(PetscFree(travel[k]));
  PetscCall(PetscFree(travel));
  PetscCall(PetscFree(sticks));
  PetscCall(PetscFree(a));
  PetscCall(PetscFree(du));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stiffness gram[n][n] of the terms in contact, or touching, along the motions at (u, t), over the largest diagonal
   entry. Friction counts as if nothing slipped. */
PetscErrorCode FreeBodiesContactGram(FreeBodies b, const PetscReal *u, PetscReal t, PetscBool touching, double gram[])
{
  PetscFunctionBeginUser;
  PetscCall(ContactGram(b, u, t, touching, GRAM_STICKS, gram));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes bodies that touch with friction at (u, t) hardly slide: gram[n][n], the products of their motions, grows by
   `factor` of its largest diagonal entry along them. */
PetscErrorCode FreeBodiesRub(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal factor, double gram[])
{
  const int n = b->n;
  double   *along, largest = 0;

  PetscFunctionBeginUser;
  if (!ContactHasFriction(b->contact)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n * n, &along));
  PetscCall(ContactGram(b, u, t, PETSC_TRUE, GRAM_ALONG, along));
  for (int k = 0; k < n; k++) largest = PetscMax(largest, gram[k * n + k]);
  for (int k = 0; k < n * n; k++) gram[k] += factor * largest * along[k];
  PetscCall(PetscFree(along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a motion a[n] moves a piece, and how it does (q). */
static PetscBool PieceMoves(FreeBodies b, PetscInt piece, const double a[], double q[RIGID_MODES])
{
  PetscBool moves = PETSC_FALSE;

  FreeBodiesPieceMotion(b, piece, a, q);
  for (int i = 0; i < RIGID_MODES; i++) moves = (PetscBool)(moves || PetscAbsReal(q[i]) > 1e-2);
  return moves;
}

/* Adds "BODY: motion; with it BODY: motion" to the text. */
static void AddMotion(FreeBodies b, const double a[], size_t size, char *text)
{
  size_t    used = strlen(text);
  PetscBool more = PETSC_FALSE;

  if (used && used < size) used += (size_t)snprintf(text + used, size - used, "; ");
  for (PetscInt p = 0; p < b->n_pieces && used < size; p++) {
    double q[RIGID_MODES];
    char   motion[FREE_TEXT];

    if (!PieceMoves(b, p, a, q)) continue;
    FreeModesMotionText(b->modes, p, q, motion);
    used +=
      (size_t)snprintf(text + used, size - used, "%s'%s': %s", more ? ", with it " : "", b->pieces[p].name, motion);
    more = PETSC_TRUE;
  }
}

/* The column that row f of free[m][n] alone has. */
static int OwnColumn(int m, int n, const double free[], int f)
{
  for (int k = 0; k < n; k++) {
    int others = 0;

    for (int g = 0; g < m; g++) others += g != f && free[g * n + k] != 0;
    if (!others && free[f * n + k] == 1) return k;
  }
  return 0;
}

/* The motions of all bodies along which a contact of stiffness gram[n][n] has less than a part of it: free[m][n],
   m <= n, in a basis in which each is the only one that has its coordinate pivot[m]. That coordinate is the one that
   contact holds the least. */
PetscErrorCode FreeBodiesBasis(FreeBodies b, const double gram[], PetscReal part, int *m, double free[], int pivot[])
{
  const int n = b->n;
  double   *work;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &work));
  PetscCall(PetscArraycpy(work, gram, n * n));
  *m = RigidFree(n, work, part, free);
  for (int f = 0; f < *m; f++) pivot[f] = OwnColumn(*m, n, free, f);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norms of the nodal loads at t, summed over each piece, and those of the moments on tools. A piece that others press
   has the force that it carries, if that is more. */
static PetscErrorCode PieceLoads(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal *load, PetscReal *moment)
{
  const int  dim = b->mesh->dim;
  PetscReal *f, square = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(b->mesh->n_nodes * dim, &f));
  PetscCall(PetscArrayzero(load, b->n_pieces));
  PetscCall(PetscArrayzero(moment, b->n_pieces));
  PetscCall(LoadsResidual(b->loads, t, u, f, NULL, &square));
  for (PetscInt i = 0; i < b->mesh->n_nodes; i++) {
    const MeshTool *tool = b->pieces[b->piece[i]].tool;

    square = 0;
    for (int d = 0; d < dim; d++) square += PetscSqr(f[i * dim + d]);
    load[b->piece[i]] += PetscSqrtReal(square);
    if (tool && i != tool->node) moment[b->piece[i]] += PetscSqrtReal(square);
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPI_SUM, b->mesh->comm));
  for (PetscInt p = 0; p < b->n_pieces; p++) load[p] = PetscMax(load[p], b->carried[p]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moment, (PetscMPIInt)b->n_pieces, MPIU_REAL, MPI_SUM, b->mesh->comm));
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the motion a[n] at displacements u turns a tool about its own point, so that its moment alone works. The
   longest way of the tool's dofs is given. */
static PetscBool TurnsInPlace(FreeBodies b, PetscInt piece, const PetscReal *u, const double a[], PetscReal longest)
{
  const FreePiece *p = &b->pieces[piece];
  double           q[RIGID_MODES], v[3], square = 0;

  if (!p->tool) return PETSC_FALSE;
  FreeBodiesPieceMotion(b, piece, a, q);
  FreeModesNodeVelocity(b->mesh, p, p->tool->node, u, q, v);
  for (int d = 0; d < b->mesh->dim; d++) square += p->tool->motion->free[d] ? PetscSqr(p->size * v[d]) : 0;
  return (PetscBool)(PetscSqrtReal(square) <= FREE_BODIES_HELD * longest);
}

/* Which of the motions free[m][n] at displacements u the loads at t drive: those along which they do more than a part
   of the work that they could do over the longest way of a node. The way of a piece counts with the forces that it
   carries, too: where it slides far below a loaded one that sinks by its unevenness, nothing drives it. */
PetscErrorCode FreeBodiesDriven(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal part, int m,
                                const double free[], PetscBool driven[])
{
  const int  n = b->n;
  PetscReal *load, *moment, *longest;
  double    *force, *scale;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(b->n_pieces, &load, b->n_pieces, &moment, b->n_pieces, &longest, n, &force, n, &scale));
  PetscCall(PieceLoads(b, u, t, load, moment));
  PetscCall(FreeBodiesForce(b, u, t, force, scale));
  for (int f = 0; f < m; f++) {
    double work = 0, most = 0;

    PetscCall(FreeBodiesLongest(b, u, &free[f * n], longest));
    for (int k = 0; k < n; k++) work += free[f * n + k] * force[k];
    for (PetscInt p = 0; p < b->n_pieces; p++)
      most += (TurnsInPlace(b, p, u, &free[f * n], longest[p]) ? moment[p] : load[p]) * longest[p];
    driven[f] = (PetscBool)(PetscAbsReal(work) > part * most);
  }
  PetscCall(PetscFree5(load, moment, longest, force, scale));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether the loads at t_loads do more than a part of the work that they could do along a motion that what
   touches at (u, t) does not hold. */
PetscErrorCode FreeBodiesFall(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscReal part,
                              PetscBool *falls)
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, m;
  PetscBool *drives;

  PetscFunctionBeginUser;
  *falls = PETSC_FALSE;
  PetscCall(FreeBodiesCentre(b, u));
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(FreeBodiesContactGram(b, u, t, PETSC_TRUE, gram));
  PetscCall(FreeBodiesBasis(b, gram, FREE_BODIES_HELD, &m, free, pivot));
  PetscCall(FreeBodiesDriven(b, u, t_loads, part, m, free, drives));
  for (int f = 0; f < m; f++) *falls = (PetscBool)(*falls || drives[f]);
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Counts the coordinates of tied motions in units of `part`, so that a contact of stiffness gram[n][n] does not see
   them. */
static void ScaleTied(FreeBodies b, PetscReal part, double gram[])
{
  for (int k = 0; k < b->n; k++)
    for (int l = 0; l < b->n; l++)
      gram[k * b->n + l] *= (b->state[k] >= MOTION_TIED ? part : 1) * (b->state[l] >= MOTION_TIED ? part : 1);
}

/* Brings a motion a[n] that ScaleTied() has made loose back to the units of the others, with 1 for coordinate k. */
static void UnscaleMotion(FreeBodies b, PetscReal part, int k, double a[])
{
  const double one = b->state[k] >= MOTION_TIED ? part : 1;

  for (int l = 0; l < b->n; l++) a[l] *= (b->state[l] >= MOTION_TIED ? part : 1) / one;
}

/*@
  FreeBodiesLoose - names the motions of the bodies that contact does not hold in the present state.

  Collective

  Input Parameters:
+ b      - the bodies
. u      - local displacements u[n_nodes*dim] (length), within the reach of the contact's lists
. t      - load parameter
. driven - name only the motions along which the loads at t act
- size   - of the text

  Output Parameter:
. text - "'ball': translation along y, (0, 1, 0); ..."; empty: contact holds all bodies

  Note:
  A contact holds a motion if a term in contact sees it; friction that slips does not hold what is driven. The system is
  singular along the others without springs. Unless
  only those that are driven are asked for, motions that are tied are named too.
@*/
PetscErrorCode FreeBodiesLoose(FreeBodies b, const PetscReal *u, PetscReal t, PetscBool driven, size_t size, char *text)
{
  const int  n = b->n;
  double    *gram, *free;
  int       *pivot, m;
  PetscBool *drives;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeBodiesCentre(b, u));
  PetscCall(PetscMalloc4(n * n, &gram, n * n, &free, n, &pivot, n, &drives));
  PetscCall(ContactGram(b, u, t, PETSC_FALSE, driven ? GRAM_SLIPS : GRAM_STICKS, gram));
  if (!driven) ScaleTied(b, FREE_BODIES_HIDDEN, gram);
  PetscCall(FreeBodiesBasis(b, gram, driven ? FREE_BODIES_HELD : FREE_BODIES_NAMED, &m, free, pivot));
  for (int f = 0; f < m && !driven; f++) UnscaleMotion(b, FREE_BODIES_HIDDEN, pivot[f], &free[f * n]);
  PetscCall(FreeBodiesDriven(b, u, t, FREE_BODIES_UNEVEN, m, free, drives));
  for (int f = 0; f < m; f++)
    if (driven ? drives[f] : b->state[pivot[f]] != MOTION_CONTACT) AddMotion(b, &free[f * n], size, text);
  PetscCall(PetscFree4(gram, free, pivot, drives));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the names of the bodies without a load of their own that a motion a[n] moves to the text, each once. loaded[]:
   which bodies have one. */
static void AddDrivenOut(FreeBodies b, const double a[], const PetscBool loaded[], size_t size, char *text)
{
  for (PetscInt p = 0; p < b->n_pieces; p++) {
    const size_t used = strlen(text);
    double       q[RIGID_MODES];
    char         name[FREE_TEXT + 2];

    snprintf(name, sizeof(name), "'%s'", b->pieces[p].name);
    if (loaded[p] || !PieceMoves(b, p, a, q) || strstr(text, name)) continue;
    snprintf(text + used, size - used, "%s%s", used ? ", " : "", name);
  }
}

/*@
  FreeBodiesDrivenOut - names the bodies without a load of their own that the loads on others drive out from between
  them, as nothing holds them along the contact.

  Collective

  Input Parameters:
+ b        - the bodies
. u        - local displacements u[n_nodes*dim] (length), within the reach of the contact's lists
. t        - load parameter there
. t_loads  - load parameter at which the loads are taken
. touching - what touches holds, and friction there sticks; otherwise what presses, and friction that does not slip
- size     - of the text

  Output Parameter:
. text - "'left', 'right'"; empty: there are none

  Note:
  A body between two others that a force presses together, as a roller between plates, may have a motion along which no
  gap changes, or only together with them. If the loads do work along it, no equilibrium is near.
@*/
PetscErrorCode FreeBodiesDrivenOut(FreeBodies b, const PetscReal *u, PetscReal t, PetscReal t_loads, PetscBool touching,
                                   size_t size, char *text)
{
  const int  n = b->n;
  double    *gram, *free, *force, *scale;
  int       *pivot, m;
  PetscBool *drives, *loaded;

  PetscFunctionBeginUser;
  text[0] = '\0';
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeBodiesCentre(b, u));
  PetscCall(PetscMalloc6(n * n, &gram, n * n, &free, n, &force, n, &scale, n, &pivot, n, &drives));
  PetscCall(PetscCalloc1(b->n_pieces, &loaded));
  PetscCall(ContactGram(b, u, t, touching, touching ? GRAM_STICKS : GRAM_SLIPS, gram));
  PetscCall(FreeBodiesBasis(b, gram, FREE_BODIES_HELD, &m, free, pivot));
  PetscCall(FreeBodiesDriven(b, u, t_loads, FREE_BODIES_UNEVEN, m, free, drives));
  PetscCall(FreeBodiesForce(b, u, t_loads, force, scale));
  for (int k = 0; k < n; k++) loaded[b->owner[k]] = (PetscBool)(loaded[b->owner[k]] || scale[k] > 0);
  for (int f = 0; f < m; f++)
    if (drives[f]) AddDrivenOut(b, &free[f * n], loaded, size, text);
  PetscCall(PetscFree6(gram, free, force, scale, pivot, drives));
  PetscCall(PetscFree(loaded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a contact of stiffness gram[n][n] acts on a piece at all. */
PetscBool FreeBodiesInContact(FreeBodies b, PetscInt piece, const double gram[])
{
  PetscBool acts = PETSC_FALSE;

  for (int k = 0; k < b->n; k++) acts = (PetscBool)(acts || (b->owner[k] == piece && gram[k * b->n + k] > 0));
  return acts;
}
