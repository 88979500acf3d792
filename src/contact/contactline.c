/* Contact energy along a line of displacements, and slave points whose normal turns at once. */
#include "contact/contactline.h"
#include "contactimpl.h"

/* Places on the line at which gaps are known: a parabola needs three. */
#define PLACES 3

/* A normal that turns by more than this (a sine) over a very small part of a step goes over an edge between two
   facets. */
#define TURN_AT_ONCE 1e-4

struct _n_ContactLine {
  Contact    contact;
  PetscReal  lambda[PLACES], t;
  PetscReal *gap[PLACES]; /* of all pairs' terms, one pair after the other; NaN: no master near */
  PetscReal *area;        /* at the first place */
};

/*@
  ContactLineCreate - makes room for the gaps along a line.

  Not collective

  Input Parameter:
. contact - the contact, borrowed

  Output Parameter:
. out - the line
@*/
PetscErrorCode ContactLineCreate(Contact contact, ContactLine *out)
{
  ContactLine line;
  PetscInt    n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&line));
  line->contact = contact;
  for (int p = 0; p < contact->n_pairs; p++) n += contact->pairs[p].n;
  PetscCall(PetscMalloc4(n, &line->gap[0], n, &line->gap[1], n, &line->gap[2], n, &line->area));
  *out = line;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLineDestroy - frees a line.

  Not collective

  Input Parameter:
. line - the line; set to NULL
@*/
PetscErrorCode ContactLineDestroy(ContactLine *line)
{
  PetscFunctionBeginUser;
  if (!*line) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*line)->gap[0], (*line)->gap[1], (*line)->gap[2], (*line)->area));
  PetscCall(PetscFree(*line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLineSet - finds the gaps at one of the three places of a line.

  Collective

  Input Parameters:
+ line   - the line
. place  - 0, 1 or 2
. lambda - position of the place on the line
. u      - local displacements there, u[n_nodes*dim] (length), ghosts included
- t      - load parameter
@*/
PetscErrorCode ContactLineSet(ContactLine line, int place, PetscReal lambda, const PetscReal *u, PetscReal t)
{
  Contact  contact = line->contact;
  PetscInt n       = 0;

  PetscFunctionBeginUser;
  line->lambda[place] = lambda;
  line->t             = t;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    PetscCall(ContactPairProject(contact, pair, u, t));
    for (PetscInt c = 0; c < pair->n; c++, n++) {
      PetscReal area;

      line->gap[place][n] = ContactTermGap(pair, pair->factor, pair->point_gap, c, &area);
      if (!place) line->area[n] = area;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gap of the n-th term at lambda, by the parabola through the three places (Newton's form), and its derivative. */
static PetscReal LineGap(ContactLine line, PetscInt n, PetscReal lambda, PetscReal *rate)
{
  const PetscReal *l = line->lambda, a = line->gap[0][n], b = line->gap[1][n], c = line->gap[2][n];
  const PetscReal  first = (b - a) / (l[1] - l[0]), second = ((c - b) / (l[2] - l[1]) - first) / (l[2] - l[0]);

  *rate = first + second * (2 * lambda - l[0] - l[1]);
  return a + (lambda - l[0]) * (first + second * (lambda - l[1]));
}

/*@
  ContactLineSlope - computes the derivative of this rank's contact energy with respect to lambda, and the second one.

  Not collective

  Input Parameters:
+ line   - the line, with ContactLineSet() of all places, which must differ
- lambda - position on the line

  Output Parameters:
+ slope     - first derivative (energy)
- stiffness - second derivative; may be NULL
@*/
void ContactLineSlope(ContactLine line, PetscReal lambda, PetscReal *slope, PetscReal *stiffness)
{
  PetscInt n = 0;

  *slope = 0;
  if (stiffness) *stiffness = 0;
  for (int p = 0; p < line->contact->n_pairs; p++) {
    const ContactPair *pair = &line->contact->pairs[p];

    for (PetscInt c = 0; c < pair->n; c++, n++) {
      const LawState  state = ContactTermState(pair, c, line->t, pair->most);
      PetscReal       rate;
      const PetscReal gap = LineGap(line, n, lambda, &rate);
      LawValue        value;

      if (PetscIsNanReal(gap)) continue;
      pair->law->evaluate(gap, &state, &value);
      *slope -= line->area[n] * value.pressure * rate;
      if (stiffness) *stiffness += line->area[n] * value.stiffness * PetscSqr(rate);
    }
  }
}

/* Finds the point of a pair whose normal turns most from u to u_ahead, among those that its term's pressure acts on. */
static PetscErrorCode PairTurn(Contact contact, ContactPair *pair, const PetscReal *u, const PetscReal *u_ahead,
                               PetscReal t, PetscReal *most, PetscInt *node)
{
  const NeighbourLists lists = pair->lists;
  PetscReal           *before;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * lists->n_slaves, &before));
  PetscCall(ContactPairProject(contact, pair, u, t));
  PetscCall(PetscArraycpy(before, pair->point_normal, 3 * lists->n_slaves));
  PetscCall(ContactPairProject(contact, pair, u_ahead, t));
  for (PetscInt c = 0; c < pair->n; c++) {
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      const PetscInt q    = pair->term_point[k];
      PetscReal      turn = 0;

      for (int d = 0; d < 3; d++) turn += PetscSqr(pair->point_normal[3 * q + d] - before[3 * q + d]);
      if (pair->point_force[q] == 0 || !(PetscSqrtReal(turn) > *most)) continue;
      *most = PetscSqrtReal(turn);
      *node = pair->node[c];
    }
  }
  PetscCall(PetscFree(before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactLocateTurn - looks for a slave node in contact with a point that goes over an edge between facets from u to
  u_ahead.

  Collective

  Input Parameters:
+ contact - the contact, after ContactResidual() with forces
. u       - local displacements, u[n_nodes*dim] (length), ghosts included
. u_ahead - displacements that differ from u by very little
- t       - load parameter

  Output Parameters:
+ found - the same on all ranks
- place - the node, where found is PETSC_TRUE
@*/
PetscErrorCode ContactLocateTurn(Contact contact, const PetscReal *u, const PetscReal *u_ahead, PetscReal t,
                                 PetscBool *found, ContactPlace *place)
{
  Mesh      mesh      = contact->mesh;
  PetscReal values[4] = {0};
  PetscInt  node      = -1;
  struct {
    double value;
    int    rank;
  } mine = {TURN_AT_ONCE, 0}, most;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair = &contact->pairs[p];

    if (pair->master && !pair->fit.fitted) PetscCall(PairTurn(contact, pair, u, u_ahead, t, &mine.value, &node));
  }
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
  PetscCallMPI(MPI_Allreduce(&mine, &most, 1, MPI_DOUBLE_INT, MPI_MAXLOC, mesh->comm));
  *found = most.value > TURN_AT_ONCE ? PETSC_TRUE : PETSC_FALSE;
  if (*found && most.rank == mine.rank) {
    values[0] = (PetscReal)mesh->node_tag[node];
    MeshNodePlace(mesh, node, &values[1]);
  }
  PetscCallMPI(MPI_Bcast(values, 4, MPIU_REAL, most.rank, mesh->comm));
  *place = (ContactPlace){
    .tag = (PetscInt)values[0],
    .X   = {values[1], values[2], values[3]}
  };
  PetscFunctionReturn(PETSC_SUCCESS);
}
