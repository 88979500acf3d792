/* Friction along a linear step: how its displacements slide a term, what forces its tractions are, and what law they
   are to obey at the end. */
#include "contactimpl.h"

/* Mean motion of the slave points of a term against their anchors in the tangent plane, where the contact nodes move by
   values; 0 where the term has no anchors. */
PetscErrorCode FrictionTermMotion(const ContactPair *pair, PetscInt c, const PetscReal *values, PetscReal motion[3])
{
  const NeighbourLists lists = pair->lists;
  const int            dim   = lists->dim;
  PetscReal            area = 0, across = 0, square = 0, normal[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  for (int d = 0; d < 3; d++) motion[d] = 0;
  for (PetscInt k = pair->term_ptr[c]; pair->friction->anchored[c] && k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q      = pair->term_point[k], *node;
    const PetscReal weight = pair->term_weight[k] * pair->factor[q], *S;
    const Facet    *face;
    const PetscInt  n = FrictionOwnNodes(pair, q, &node, &S);
    PetscReal       N[FACE_MAX_NODES];

    if (!FrictionTermTakes(pair, k)) continue;
    area += weight;
    PetscCall(ContactVariationsNeed(pair, q));
    for (int d = 0; d < dim; d++) normal[d] += weight * pair->variations->own[q * dim + d];
    if (pair->friction->face[q] < 0) continue;
    for (PetscInt a = 0; a < n; a++)
      for (int d = 0; d < dim; d++) motion[d] += weight * S[a] * values[node[a] * dim + d];
    if (!pair->master || pair->friction->at[q] < 0) continue;
    face = &lists->face[pair->friction->at[q]];
    ElementShape(face->type, &pair->friction->xi[2 * q], N, NULL, NULL);
    for (int a = 0; a < ElementGet(face->type)->nodes; a++) {
      PetscReal sign[3];
      PetscInt  at;

      FrictionNodeSign(pair, face->nodes[a], &at, sign);
      for (int d = 0; d < dim; d++) motion[d] -= weight * N[a] * sign[d] * values[at * dim + d];
    }
  }
  for (int d = 0; d < 3; d++) {
    across += normal[d] * motion[d];
    square += PetscSqr(normal[d]);
  }
  for (int d = 0; d < 3 && area > 0; d++) motion[d] = (motion[d] - across / square * normal[d]) / area;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the forces of a traction on a term to the values of the contact nodes. */
PetscErrorCode FrictionTermForces(const ContactPair *pair, PetscInt c, const PetscReal traction[3], PetscReal *values)
{
  PetscFunctionBeginUser;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt q = pair->term_point[k];
    PetscReal      F[3];

    if (!FrictionTermTakes(pair, k)) continue;
    for (int d = 0; d < 3; d++) F[d] = pair->term_weight[k] * pair->factor[q] * traction[d];
    PetscCall(FrictionPointForces(pair, q, F, values));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes what the law says of a term to its tangents. */
static void TakeToTangents(const FrictionTraction *out, PetscReal tangent[2][3], ActiveSetFriction *friction)
{
  for (int a = 0; a < 2; a++) {
    for (int i = 0; i < 3; i++) {
      friction->traction[a] += tangent[a][i] * out->traction[i];
      friction->by_gap[a] += tangent[a][i] * out->by_gap[i];
      for (int b = 0; b < 2; b++)
        for (int j = 0; j < 3; j++) friction->by_slip[a][b] += tangent[a][i] * out->by_slip[i][j] * tangent[b][j];
    }
  }
}

/*@
  FrictionStepTerm - fills the friction of a term where a linear step begins.

  Not collective

  Input Parameters:
+ pair - the pair, projected, in the state of the last residual and tangent
. c    - the term
- t    - load parameter

  Output Parameters:
+ friction - in residual and tangent, and its law in the frame of the term's tangents; zeros where it has no anchors
- tangent  - the two unit tangents

  Note:
  That the step turns the tangents is left out.
@*/
PetscErrorCode FrictionStepTerm(const ContactPair *pair, PetscInt c, PetscReal t, ActiveSetFriction *friction,
                                PetscReal tangent[2][3])
{
  static const PetscReal unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  FrictionInput          in, held;
  FrictionTraction       out;
  PetscReal              slip[2], part[2];
  PetscBool              found, acts;

  PetscFunctionBeginUser;
  *friction = (ActiveSetFriction){.law = {.stiffness = 0}};
  PetscCall(FrictionTermAsk(pair, c, t, &in, &found));
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < 3; d++) {
    FrictionComponents(in.normal, in.along, unit[d], part);
    for (int a = 0; a < 2; a++) tangent[a][d] = part[a];
  }
  FrictionComponents(in.normal, in.along, in.slip, slip);
  friction->law         = in;
  friction->law.kept[0] = friction->law.kept[1] = 0;
  friction->law.steepness                       = 0; /* the coefficient stays in the step */
  for (int d = 0; d < 3; d++) {
    friction->law.normal[d] = unit[2][d];
    friction->law.along[d]  = unit[0][d];
    friction->law.slip[d]   = d < 2 ? in.kept[d] + slip[d] : 0;
  }
  PetscCall(FrictionTerm(pair, c, t, &held, &out, &acts));
  if (acts) TakeToTangents(&out, tangent, friction);
  PetscFunctionReturn(PETSC_SUCCESS);
}
