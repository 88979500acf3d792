/* Room in which slave points are evaluated, one after the other.

   All pairs share one ContactWork, because only one slave point is evaluated at a time and its arrays are large. A pair
   holds a pointer to it. A function that takes a `const ContactPair *` therefore leaves the pair as it is, but it may
   overwrite the work. What the work holds is valid until the next function that writes the same member.

   Members and who writes them:
   - `result`, `x`, `multiplier`, `hoop`, `workspace`: ContactPointEvaluate().
   - `map`, `number`, `count`, `N`: ContactPointToNodes(), ContactVariationsNodes() and ContactPointsToNodes().
   - `sum`, `M`: ContactSecondBegin() to ContactSecondEnd(), and ContactOwnToNodes().
   - `slot`: one of two users at a time, each of which leaves it at -1 everywhere:
     a list of nodes, from ContactWorkNodesBegin() over any number of ContactWorkNodesAdd() to ContactWorkNodesEnd();
     a block of the tangent, from ContactWorkBlockBegin() to ContactWorkBlockEnd() with the same nodes.
   Between ContactWorkBlockBegin() and ContactWorkBlockEnd() no list of nodes may be begun. */
#pragma once
#include "base/petsccompat.h"
#include "smooth/fitderivatives.h"
#include "smooth/smoother.h"

/* What the points of one evaluation are made of. Row 0 is the slave point, row 1 + i is the i-th point that takes part.
   The entries ptr[r] to ptr[r + 1] - 1 of row r are nodes (their slots) with weights S. Each weight is multiplied with
   sign, which holds three components for each entry and reflects what lies on a mirror image. */
typedef struct {
  int    *ptr, *node;
  int    *run; /* of each row: the first of the rows, one after the other, that have the same nodes and signs */
  double *S, *sign;
  int     rows_room, entries_room;
} ContactMap;

typedef struct {
  SmootherResult    result;
  PetscReal        *x, *multiplier, *hoop, *workspace; /* x: positions relative to the slave point (length) */
  PetscInt          x_room;
  ContactMap        map;
  PetscInt          count, *number; /* contact nodes, each of which occurs once */
  PetscReal        *N;              /* first variation of the gap over these nodes, dim entries for each */
  PetscInt          room;
  FitDerivativesSum sum;
  PetscReal        *sum_workspace, *M; /* M: second variations over the nodes of a block, summed over slave points */
  PetscInt          sum_room, M_room;
  int              *slot; /* place of each contact node in number[] or in the block at hand, -1 elsewhere */
  PetscInt          slot_room;
} ContactWork;

FitDerivatives ContactWorkMap(const ContactWork *, PetscInt n_nodes);
PetscErrorCode ContactWorkCreate(int capacity, int dense_capacity, long workspace, ContactWork *);
PetscErrorCode ContactWorkDestroy(ContactWork *);
PetscErrorCode ContactWorkReserveMap(ContactWork *, PetscInt contact_nodes, int rows, PetscInt entries);
PetscErrorCode ContactWorkReserveBlock(ContactWork *, PetscInt m);
PetscErrorCode ContactWorkNodesBegin(ContactWork *, PetscInt contact_nodes, PetscInt room);
void           ContactWorkNodesAdd(ContactWork *, PetscInt n, const PetscInt nodes[]);
void           ContactWorkNodesEnd(ContactWork *);
PetscErrorCode ContactWorkBlockBegin(ContactWork *, PetscInt contact_nodes, PetscInt n, const PetscInt nodes[]);
void           ContactWorkBlockEnd(ContactWork *, PetscInt n, const PetscInt nodes[]);
