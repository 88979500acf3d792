/* Contact along a linear step: the terms that may open or close on it, and their first variations. */
#include "contact/contactstep.h"
#include "contactimpl.h"

/* Multiple of the longest motion of a step up to which gaps may be reached by it. Gaps change by the motions of two
   bodies, and by more than the first solution of the step says, because what opens or closes changes the step. */
#define STEP_REACH 3

struct _n_ContactStep {
  Contact        contact;
  PetscReal     *reach; /* of each pair */
  PetscBool     *near;  /* has a pair terms here, on any rank? */
  PetscInt       n, mine, parts;
  PetscMPIInt    rank, *count, *first; /* terms of each rank */
  PetscInt      *order, *place; /* rank after rank: number of the term of all that comes there; of each of mine */
  ActiveSetTerm *terms;         /* n */
  PetscInt      *pair, *term;   /* of mine */
  PetscReal     *area;
  PetscInt      *ptr, *node;  /* gap's first variation, over contact nodes of the pair */
  PetscReal     *N;           /* dim for each of these */
  PetscReal (*tangent)[2][3]; /* of mine, where there is friction */
  FrictionSlide *slide;       /* of mine; NULL: nobody has asked yet */
};

/* How the contact nodes of a pair move with du, tools and an analytic master included: values[contact nodes*dim], to
   be freed by the caller. */
static PetscErrorCode PairMove(Contact contact, ContactPair *pair, const PetscReal *du, PetscReal t, PetscReal t_next,
                               PetscReal **values)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->lists->n_nodes * contact->mesh->dim, values));
  PetscCall(ContactPairMove(contact, pair, du, t, t_next, *values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Longest motion of this rank's slave nodes, of which not all are contact nodes where most points have no partner. */
static PetscReal SlaveMotion(Contact contact, const ContactPair *pair, const PetscReal *du)
{
  const int   dim  = contact->mesh->dim;
  PetscReal   most = 0;
  PetscMPIInt rank;

  if (!pair->master || MPI_Comm_rank(contact->mesh->comm, &rank)) return 0;
  for (PetscInt i = 0; i < pair->slaves->n_nodes && !ContactOnTool(pair); i++) {
    const NodeKey *node   = &pair->slaves->nodes[i];
    PetscReal      square = 0;

    for (int d = 0; d < dim && node->owner == rank; d++) square += PetscSqr(du[node->local * dim + d]);
    most = PetscMax(most, square);
  }
  return PetscSqrtReal(most);
}

/* Longest motion of a pair's contact nodes and slave nodes, over all ranks. */
static PetscErrorCode PairStepMotion(Contact contact, ContactPair *pair, const PetscReal *du, PetscReal t,
                                     PetscReal t_next, PetscReal *motion)
{
  const int  dim = contact->mesh->dim;
  PetscReal *values;

  PetscFunctionBeginUser;
  *motion = 0;
  PetscCall(PairMove(contact, pair, du, t, t_next, &values));
  for (PetscInt i = 0; i < pair->lists->n_nodes; i++) {
    PetscReal square = 0;

    for (int d = 0; d < dim; d++) square += PetscSqr(values[i * dim + d]);
    *motion = PetscMax(*motion, PetscSqrtReal(square));
  }
  *motion = PetscMax(*motion, SlaveMotion(contact, pair, du));
  PetscCall(PetscFree(values));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, motion, 1, MPIU_REAL, MPI_MAX, contact->mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Part of the area around a term that is not past an end of the master. */
static PetscReal TermShare(const ContactPair *pair, PetscInt c, PetscReal area)
{
  PetscReal whole = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) whole += pair->term_weight[k];
  return whole > 0 ? area / whole : 0;
}

/* Adds a term of a pair, in its state at the last projection and without its variation, if the step may reach its
   gap. With friction all at which it acts are added, because each may begin or cease to slip. */
static PetscErrorCode AddTerm(ContactStep step, int p, PetscInt c, PetscReal t)
{
  const ContactPair *pair  = &step->contact->pairs[p];
  const LawState     state = ContactTermState(pair, c, t, ContactTermMost(pair, c));
  LawValue           value;
  PetscReal          opening;

  PetscFunctionBeginUser;
  ContactTermLaw(pair, c, t, &value, &opening, &step->area[step->mine]);
  opening -= LawOnsetGap(&state);
  if (PetscIsNanReal(opening)) PetscFunctionReturn(PETSC_SUCCESS); /* no master is near */
  if (!(PetscAbsReal(opening) <= step->reach[p] || (pair->friction && FrictionTermActs(pair, c, value.stiffness))))
    PetscFunctionReturn(PETSC_SUCCESS);
  step->terms[step->mine] = (ActiveSetTerm){.opening   = opening,
                                            .pressure  = value.pressure,
                                            .stiffness = pair->stiffness[c],
                                            .penalty   = state.penalty,
                                            .area      = step->area[step->mine],
                                            .share     = TermShare(pair, c, step->area[step->mine])};
  if (pair->friction)
    PetscCall(FrictionStepTerm(pair, c, t, &step->terms[step->mine].friction, step->tangent[step->mine]));
  step->pair[step->mine]   = p;
  step->term[step->mine++] = c;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the variations of those terms of a pair that were added from number `from` on. */
static PetscErrorCode AddVariations(ContactStep step, int p, PetscInt from)
{
  const ContactPair *pair = &step->contact->pairs[p];
  const int          dim  = step->contact->mesh->dim;

  PetscFunctionBeginUser;
  for (PetscInt i = from; i < step->mine; i++) {
    const PetscInt  c = step->term[i], first = step->ptr[i];
    const PetscInt *nodes;
    PetscInt        n;

    PetscCall(
      ContactVariationsNodes(pair, pair->term_ptr[c + 1] - pair->term_ptr[c], &pair->term_point[pair->term_ptr[c]]));
    n                = pair->work->count;
    nodes            = pair->work->number;
    step->ptr[i + 1] = first + n;
    PetscCall(PetscRealloc((first + n) * sizeof(PetscInt), &step->node));
    PetscCall(PetscRealloc((first + n) * dim * sizeof(PetscReal), &step->N));
    PetscCall(PetscArraycpy(&step->node[first], nodes, n));
    PetscCall(PetscArrayzero(&step->N[first * dim], n * dim));
    PetscCall(ContactWorkBlockBegin(pair->work, pair->lists->n_nodes, n, nodes));
    ContactTermVary(pair, c, 1 / step->area[i], &step->N[first * dim]);
    ContactWorkBlockEnd(pair->work, n, nodes);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the terms of a pair whose gaps the step may reach. */
static PetscErrorCode AddPair(ContactStep step, int p, const PetscReal *u, PetscReal t)
{
  ContactPair   *pair = &step->contact->pairs[p];
  const PetscInt from = step->mine;

  PetscFunctionBeginUser;
  PetscCall(ContactPairProject(step->contact, pair, u, t));
  for (PetscInt c = 0; c < pair->n; c++) PetscCall(AddTerm(step, p, c, t));
  PetscCall(AddVariations(step, p, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers `size` bytes of each of my terms, rank after rank. */
static PetscErrorCode GatherRanks(ContactStep step, size_t size, const void *mine, void *all)
{
  MPI_Comm     comm = step->contact->mesh->comm;
  MPI_Datatype block;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)size, MPI_BYTE, &block));
  PetscCallMPI(MPI_Type_commit(&block));
  PetscCallMPI(MPI_Allgatherv(mine, step->count[step->rank], block, all, step->count, step->first, block, comm));
  PetscCallMPI(MPI_Type_free(&block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gathers `size` bytes of each of my terms into their places among those of all ranks. */
static PetscErrorCode Gather(ContactStep step, size_t size, const void *mine, void *all)
{
  char *ranks;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(step->n * size, &ranks));
  PetscCall(GatherRanks(step, size, mine, ranks));
  for (PetscInt i = 0; i < step->n; i++)
    PetscCall(PetscMemcpy((char *)all + step->order[i] * size, &ranks[i * size], size));
  PetscCall(PetscFree(ranks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What orders terms alike on any ranks. */
typedef struct {
  PetscInt pair, id, at; /* number of the term in its pair; place where terms stand rank after rank */
} TermKey;

static int CompareKeys(const void *a, const void *b)
{
  const TermKey *left = a, *right = b;

  if (left->pair != right->pair) return left->pair < right->pair ? -1 : 1;
  return left->id < right->id ? -1 : left->id > right->id;
}

/* Orders the terms of all ranks by their pairs and their numbers in them. The active set goes through them one after
   the other, and where it may end at more than one set the order decides: it must not be that of the ranks. */
static PetscErrorCode OrderTerms(ContactStep step)
{
  TermKey *mine, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(step->mine, &mine, step->n, &all));
  PetscCall(PetscMalloc2(step->n, &step->order, step->mine, &step->place));
  for (PetscInt i = 0; i < step->mine; i++)
    mine[i] = (TermKey){step->pair[i], ContactTermId(&step->contact->pairs[step->pair[i]], step->term[i]), 0};
  PetscCall(GatherRanks(step, sizeof(TermKey), mine, all));
  for (PetscInt i = 0; i < step->n; i++) {
    all[i].at               = i;
    step->near[all[i].pair] = PETSC_TRUE;
  }
  if (step->n) qsort(all, (size_t)step->n, sizeof(TermKey), CompareKeys);
  for (PetscInt i = 0; i < step->n; i++) step->order[all[i].at] = i;
  for (PetscInt i = 0; i < step->mine; i++) step->place[i] = step->order[step->first[step->rank] + i];
  PetscCall(PetscFree2(mine, all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The list of my terms becomes that of all ranks. */
static PetscErrorCode GatherTerms(ContactStep step)
{
  MPI_Comm       comm = step->contact->mesh->comm;
  PetscMPIInt    size, mine = (PetscMPIInt)step->mine;
  ActiveSetTerm *own = step->terms;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCallMPI(MPI_Comm_rank(comm, &step->rank));
  PetscCall(PetscMalloc2(size, &step->count, size + 1, &step->first));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPI_INT, step->count, 1, MPI_INT, comm));
  step->first[0] = 0;
  for (PetscMPIInt r = 0; r < size; r++) step->first[r + 1] = step->first[r] + step->count[r];
  step->n = step->first[size];
  PetscCall(OrderTerms(step));
  PetscCall(PetscMalloc1(step->n, &step->terms));
  PetscCall(Gather(step, sizeof(*own), own, step->terms));
  PetscCall(PetscFree(own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepCreate - chooses the terms whose gaps a linear step may reach.

  Collective

  Input Parameters:
+ contact - the contact, with the last residual and tangent at (u, t); what ContactHoldActiveSet() holds must stay
            until the step is taken
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
. du      - their change in the step, du[n_nodes*dim] (length), ghosts included
. t       - load parameter where the step begins
- t_next  - load parameter to which tools move

  Output Parameter:
. out - the step
@*/
PetscErrorCode ContactStepCreate(Contact contact, const PetscReal *u, const PetscReal *du, PetscReal t,
                                 PetscReal t_next, ContactStep *out)
{
  ContactStep step;
  PetscInt    most = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&step));
  step->contact = contact;
  for (int p = 0; p < contact->n_pairs; p++) most += contact->pairs[p].n;
  PetscCall(PetscMalloc1(most, &step->terms));
  PetscCall(PetscMalloc4(most, &step->pair, most, &step->term, most, &step->area, most + 1, &step->ptr));
  step->parts = ContactHasFriction(contact) ? contact->mesh->dim : 1;
  if (step->parts > 1) PetscCall(PetscCalloc1(most, &step->tangent));
  step->ptr[0] = 0;
  PetscCall(PetscMalloc1(contact->n_pairs, &step->reach));
  PetscCall(PetscCalloc1(contact->n_pairs, &step->near));
  for (int p = 0; p < contact->n_pairs; p++) {
    PetscCall(PairStepMotion(contact, &contact->pairs[p], du, t, t_next, &step->reach[p]));
    step->reach[p] *= STEP_REACH;
    PetscCall(AddPair(step, p, u, t));
  }
  PetscCall(GatherTerms(step));
  *out = step;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepDestroy - frees a step.

  Not collective

  Input Parameter:
. step - the step; set to NULL
@*/
PetscErrorCode ContactStepDestroy(ContactStep *step)
{
  ContactStep s = *step;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(s->reach));
  PetscCall(PetscFree(s->near));
  PetscCall(PetscFree(s->terms));
  PetscCall(PetscFree4(s->pair, s->term, s->area, s->ptr));
  PetscCall(PetscFree(s->tangent));
  for (PetscInt i = 0; s->slide && i < s->mine; i++) PetscCall(FrictionSlideFree(&s->slide[i]));
  PetscCall(PetscFree(s->slide));
  PetscCall(PetscFree2(s->count, s->first));
  PetscCall(PetscFree2(s->order, s->place));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->N));
  PetscCall(PetscFree(*step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepGetTerms - gets the terms of all ranks.

  Not collective

  Input Parameter:
. step - the step

  Output Parameters:
+ n     - number of terms, the same on all ranks
- terms - they belong to the step
@*/
PetscErrorCode ContactStepGetTerms(ContactStep step, PetscInt *n, const ActiveSetTerm **terms)
{
  PetscFunctionBeginUser;
  *n     = step->n;
  *terms = step->terms;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Parts of a term: 1, with friction as many as there are dimensions. */
PetscInt ContactStepParts(ContactStep step)
{
  return step->parts;
}

/* Change of a term's gap. It is summed by components, so that no product waits for the one before it. */
static inline PetscReal TermTravel(const int dim, const PetscReal *N, PetscInt n, const PetscInt *node,
                                   const PetscReal *values)
{
  PetscReal sum[3] = {0, 0, 0};

  for (PetscInt i = 0; i < n; i++)
    for (int d = 0; d < dim; d++) sum[d] += N[i * dim + d] * values[node[i] * dim + d];
  return sum[0] + sum[1] + sum[2];
}

/* Finds how contact nodes slide my terms, once for all displacements that are asked for. */
static PetscErrorCode FindSlides(ContactStep step)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(step->mine, &step->slide));
  for (PetscInt i = 0; i < step->mine; i++) {
    const ContactPair *pair = &step->contact->pairs[step->pair[i]];

    if (pair->friction) PetscCall(FrictionTermSlide(pair, step->term[i], &step->slide[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What local displacements do to my terms: travel of their gaps, and motion of their sides along each other, slide[3]
   of each, 0 without friction; slide may be NULL. Each pair that has terms is moved once: of a list of surfaces most
   have none. */
static PetscErrorCode OwnMotion(ContactStep step, const PetscReal *du, PetscReal t, PetscReal t_next, PetscReal *travel,
                                PetscReal *slide)
{
  const int  dim = step->contact->mesh->dim;
  PetscReal *values;
  PetscInt   i = 0, k = 0;

  PetscFunctionBeginUser;
  if (slide) PetscCall(PetscArrayzero(slide, 3 * step->mine));
  if (slide && !step->slide) PetscCall(FindSlides(step));
  for (int p = 0; p < step->contact->n_pairs; p++) {
    ContactPair *pair = &step->contact->pairs[p];

    if (!step->near[p]) continue;
    PetscCall(PairMove(step->contact, pair, du, t, t_next, &values));
    for (; i < step->mine && step->pair[i] == p; i++) {
      const PetscInt first = step->ptr[i], n = step->ptr[i + 1] - first;

      travel[i] = dim == 3 ? TermTravel(3, &step->N[first * 3], n, &step->node[first], values)
                           : TermTravel(2, &step->N[first * 2], n, &step->node[first], values);
    }
    if (slide && pair->friction && pair->tool) PetscCall(ContactToolRelative(pair, values));
    for (; k < i; k++)
      if (slide && pair->friction) FrictionSlideMotion(&step->slide[k], dim, values, &slide[3 * k]);
    PetscCall(PetscFree(values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepForesee - notes the pressures at the end of a step, for the tangents to come.

  Collective

  Input Parameters:
+ step   - the step
. du     - local displacements of the whole step, du[n_nodes*dim] (length), prescribed ones included
. t      - load parameter where the step begins
- t_next - load parameter where it ends

  Note:
  They are those of the linear problem: gaps change to first order. Terms that the step does not reach keep what is
  foreseen of them: nothing after ContactForgetForeseen().
@*/
PetscErrorCode ContactStepForesee(ContactStep step, const PetscReal *du, PetscReal t, PetscReal t_next)
{
  PetscReal *travel;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(step->mine, &travel));
  PetscCall(OwnMotion(step, du, t, t_next, travel, NULL));
  for (PetscInt i = 0; i < step->mine; i++) {
    const ActiveSetTerm *term = &step->terms[step->place[i]];

    step->contact->pairs[step->pair[i]].foreseen[step->term[i]] =
      PetscMax(0, -term->penalty * (term->opening + travel[i]));
  }
  PetscCall(PetscFree(travel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepTravel - computes how local displacements change the gaps, to first order, and how they move the slave
  against its anchors on the master, where there is friction.

  Collective

  Input Parameters:
+ step   - the step
. du     - local displacements, du[n_nodes*dim] (length), prescribed ones included
. t      - load parameter where the motion of tools begins
- t_next - load parameter where it ends

  Output Parameters:
+ travel - travel[n] of the terms of all ranks (length)
- slide  - slide[3*n] of the terms of all ranks (length), 0 without friction; may be NULL, on all ranks
@*/
PetscErrorCode ContactStepTravel(ContactStep step, const PetscReal *du, PetscReal t, PetscReal t_next,
                                 PetscReal *travel, PetscReal *slide)
{
  PetscReal *mine, *along;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(step->mine, &mine, 3 * step->mine, &along));
  PetscCall(OwnMotion(step, du, t, t_next, mine, slide ? along : NULL));
  PetscCall(Gather(step, sizeof(PetscReal), mine, travel));
  if (slide) PetscCall(Gather(step, 3 * sizeof(PetscReal), along, slide));
  PetscCall(PetscFree2(mine, along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepChange - computes how local displacements change all parts of the terms, to first order: their gaps and,
  with friction, their slips along their tangents.

  Collective

  Input Parameters:
+ step   - the step
. du     - local displacements, du[n_nodes*dim] (length), prescribed ones included
. t      - load parameter where the motion of tools begins
- t_next - load parameter where it ends

  Output Parameter:
. change - change[ContactStepParts()*n] of the terms of all ranks, part by part (length)
@*/
PetscErrorCode ContactStepChange(ContactStep step, const PetscReal *du, PetscReal t, PetscReal t_next,
                                 PetscReal *change)
{
  PetscReal *slide, *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * step->mine, &slide, step->mine, &mine));
  PetscCall(OwnMotion(step, du, t, t_next, mine, step->parts > 1 ? slide : NULL));
  PetscCall(Gather(step, sizeof(PetscReal), mine, change));
  for (PetscInt a = 0; a < step->parts - 1; a++) {
    for (PetscInt i = 0; i < step->mine; i++) {
      mine[i] = 0;
      for (int d = 0; d < 3; d++) mine[i] += step->tangent[i][a][d] * slide[3 * i + d];
    }
    PetscCall(Gather(step, sizeof(PetscReal), mine, &change[(1 + a) * step->n]));
  }
  PetscCall(PetscFree2(slide, mine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepWithin - says whether local displacements go no farther than the terms were chosen for.

  Collective

  Input Parameters:
+ step   - the step
. du     - local displacements, du[n_nodes*dim] (length)
. t      - load parameter where the motion of tools begins
- t_next - load parameter where it ends

  Output Parameter:
. within - the same on all ranks
@*/
PetscErrorCode ContactStepWithin(ContactStep step, const PetscReal *du, PetscReal t, PetscReal t_next,
                                 PetscBool *within)
{
  PetscReal motion;

  PetscFunctionBeginUser;
  *within = PETSC_TRUE;
  for (int p = 0; p < step->contact->n_pairs; p++) {
    PetscCall(PairStepMotion(step->contact, &step->contact->pairs[p], du, t, t_next, &motion));
    *within = (PetscBool)(*within && motion <= step->reach[p]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to column j the forces of a pressure of 1 on my term i. */
static PetscErrorCode AddPressure(ContactStep step, PetscInt i, PetscInt j, Mat B)
{
  const int       dim = step->contact->mesh->dim;
  const PetscInt *dof = step->contact->pairs[step->pair[i]].lists->dof;

  PetscFunctionBeginUser;
  for (PetscInt k = step->ptr[i] * dim; k < step->ptr[i + 1] * dim; k++)
    PetscCall(MatSetValue(B, dof[step->node[k / dim] * dim + k % dim], j, step->area[i] * step->N[k], ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds to column j the forces of a traction of 1 on my term i along a tangent. */
static PetscErrorCode AddTraction(ContactStep step, PetscInt i, PetscInt a, PetscInt j, Mat B)
{
  ContactPair   *pair = &step->contact->pairs[step->pair[i]];
  const PetscInt n    = pair->lists->n_nodes * step->contact->mesh->dim;
  PetscReal     *values;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &values));
  PetscCall(FrictionTermForces(pair, step->term[i], step->tangent[i][a], values));
  if (pair->tool) PetscCall(ContactToolForces(pair, values));
  for (PetscInt k = 0; k < n; k++)
    if (values[k] != 0) PetscCall(MatSetValue(B, pair->lists->dof[k], j, -values[k], ADD_VALUES));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepForces - computes the forces over the free dofs of a pressure of 1 on some terms, against the opening of
  their gaps, or of a traction of 1 on them along a tangent, against their slip.

  Collective

  Input Parameters:
+ step  - the step
. rows  - rows of the matrix on this rank
. m     - number of components
- which - their numbers as in activeset.h, the same on all ranks

  Output Parameter:
. B - dense matrix with m columns; the caller destroys it
@*/
PetscErrorCode ContactStepForces(ContactStep step, PetscInt rows, PetscInt m, const PetscInt *which, Mat *B)
{
  PetscInt *own;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(step->n, &own));
  for (PetscInt i = 0; i < step->n; i++) own[i] = -1;
  for (PetscInt i = 0; i < step->mine; i++) own[step->place[i]] = i;
  PetscCall(MatCreateDense(step->contact->mesh->comm, rows, PETSC_DECIDE, PETSC_DETERMINE, m, NULL, B));
  for (PetscInt j = 0; j < m; j++) {
    const PetscInt i = own[which[j] % step->n], part = which[j] / step->n;

    if (i < 0) continue;
    if (part)
      PetscCall(AddTraction(step, i, part - 1, j, *B));
    else
      PetscCall(AddPressure(step, i, j, *B));
  }
  PetscCall(PetscFree(own));
  PetscCall(MatAssemblyBegin(*B, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(*B, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepMeets - says whether each pair that presses at the end of the linear step presses somewhere in the present
  state.

  Collective

  Input Parameters:
+ step    - the step; the present state is that where it ends
- pressed - pressed[n] of the terms of all ranks: they press at the end of the linear step

  Output Parameter:
. meets - the same on all ranks
@*/
PetscErrorCode ContactStepMeets(ContactStep step, const PetscBool *pressed, PetscBool *meets)
{
  const int n = step->contact->n_pairs;
  PetscInt *terms; /* of each pair: those that should press, then those that do */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &terms));
  for (PetscInt i = 0; i < step->mine; i++) {
    const int p = (int)step->pair[i];

    if (!pressed[step->place[i]]) continue;
    terms[p]++;
    terms[n + p] += step->contact->pairs[p].now.status[step->term[i]] == CONTACT_CLOSED;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, terms, 2 * n, MPIU_INT, MPI_SUM, step->contact->mesh->comm));
  *meets = PETSC_TRUE;
  for (int p = 0; p < n; p++)
    if (terms[p] && !terms[n + p]) *meets = PETSC_FALSE;
  PetscCall(PetscFree(terms));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactStepMarkPredicted - notes what presses at the end of a step, for ContactHoldExpected(), and of one that
  predicts for ContactUnpredictedEnergy().

  Not collective

  Input Parameters:
+ step    - the step
- pressed - pressed[n] of the terms of all ranks

  Note:
  While only what the prediction did not count on is softened, no step predicts.
@*/
PetscErrorCode ContactStepMarkPredicted(ContactStep step, const PetscBool *pressed)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < step->contact->n_pairs; p++) {
    ContactPair *pair = &step->contact->pairs[p];

    PetscCall(PetscArraycpy(pair->arrived, pair->expected, pair->n));
    PetscCall(PetscArrayzero(pair->expected, pair->n));
  }
  for (PetscInt i = 0; i < step->mine; i++) {
    const ContactPair *pair = &step->contact->pairs[step->pair[i]];

    pair->expected[step->term[i]] = pressed[step->place[i]];
    if (pair->holding && pair->most == pair->predicted_most) pair->predicted[step->term[i]] = pressed[step->place[i]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
