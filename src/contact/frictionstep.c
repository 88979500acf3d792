/* Friction along a linear step: how its displacements slide a term, what forces its tractions are, and what law they
   are to obey at the end. */
#include "contactimpl.h"

/* Adds the nodes that slide slave point q against its anchor to the list of nodes. */
static void AddSlideNodes(const ContactPair *pair, PetscInt q)
{
  const PetscInt  *node, at = pair->friction->at[q];
  const PetscReal *S;
  const PetscInt   n    = FrictionOwnNodes(pair, q, &node, &S);
  const Facet     *face = pair->master && at >= 0 ? &pair->lists->face[at] : NULL;

  ContactWorkNodesAdd(pair->work, n, node);
  for (int a = 0; face && a < ElementGet(face->type)->nodes; a++) {
    PetscReal sign[3];
    PetscInt  anchor;

    FrictionNodeSign(pair, face->nodes[a], &anchor, sign);
    ContactWorkNodesAdd(pair->work, 1, &anchor);
  }
}

/* Adds the shares of these nodes, times weight. */
static void AddSlideShares(const ContactPair *pair, PetscInt q, PetscReal weight, PetscReal *share)
{
  const PetscInt  *node, at = pair->friction->at[q];
  const PetscReal *S;
  const PetscInt   n    = FrictionOwnNodes(pair, q, &node, &S);
  const Facet     *face = pair->master && at >= 0 ? &pair->lists->face[at] : NULL;
  PetscReal        N[FACE_MAX_NODES];

  for (PetscInt a = 0; a < n; a++)
    for (int d = 0; d < 3; d++) share[3 * pair->work->slot[node[a]] + d] += weight * S[a];
  if (face) ElementShape(face->type, &pair->friction->xi[2 * q], N, NULL, NULL);
  for (int a = 0; face && a < ElementGet(face->type)->nodes; a++) {
    PetscReal sign[3];
    PetscInt  anchor;

    FrictionNodeSign(pair, face->nodes[a], &anchor, sign);
    for (int d = 0; d < 3; d++) share[3 * pair->work->slot[anchor] + d] -= weight * N[a] * sign[d];
  }
}

/*@
  FrictionTermSlide - finds how contact nodes slide a term: the mean motion of its slave points against their anchors.

  Not collective

  Input Parameters:
+ pair - the pair, projected
- c    - the term

  Output Parameter:
. slide - to be freed with FrictionSlideFree(); of no nodes where the term has no anchors
@*/
PetscErrorCode FrictionTermSlide(const ContactPair *pair, PetscInt c, FrictionSlide *slide)
{
  const PetscInt first = pair->term_ptr[c], end = pair->friction->anchored[c] ? pair->term_ptr[c + 1] : first;
  PetscReal      area = 0, square = 0;

  PetscFunctionBeginUser;
  *slide = (FrictionSlide){.n = 0};
  for (PetscInt k = first; k < end; k++) {
    const PetscInt q = pair->term_point[k];

    if (!FrictionTermTakes(pair, k)) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    area += pair->term_weight[k] * pair->factor[q];
    for (int d = 0; d < pair->mesh->dim; d++)
      slide->normal[d] += pair->term_weight[k] * pair->factor[q] * pair->variations->own[q * pair->mesh->dim + d];
  }
  if (area == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (int d = 0; d < 3; d++) square += PetscSqr(slide->normal[d]);
  for (int d = 0; d < 3; d++) slide->normal[d] /= PetscSqrtReal(square);
  PetscCall(ContactWorkNodesBegin(pair->work, pair->lists->n_nodes, 2 * FACE_MAX_NODES * (end - first)));
  for (PetscInt k = first; k < end; k++)
    if (FrictionTermTakes(pair, k) && pair->friction->face[pair->term_point[k]] >= 0)
      AddSlideNodes(pair, pair->term_point[k]);
  slide->n = pair->work->count;
  PetscCall(PetscMalloc1(slide->n, &slide->node));
  PetscCall(PetscCalloc1(3 * slide->n, &slide->share));
  PetscCall(PetscArraycpy(slide->node, pair->work->number, slide->n));
  for (PetscInt k = first; k < end; k++) {
    const PetscInt q = pair->term_point[k];

    if (FrictionTermTakes(pair, k) && pair->friction->face[q] >= 0)
      AddSlideShares(pair, q, pair->term_weight[k] * pair->factor[q] / area, slide->share);
  }
  ContactWorkNodesEnd(pair->work);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionSlideFree - frees what FrictionTermSlide() has found.

  Not collective

  Input Parameter:
. slide - its arrays are freed
@*/
PetscErrorCode FrictionSlideFree(FrictionSlide *slide)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(slide->node));
  PetscCall(PetscFree(slide->share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionSlideMotion - computes how a term slides in its tangent plane where contact nodes move.

  Not collective

  Input Parameters:
+ slide  - of FrictionTermSlide()
. dim    - dimension
- values - values[contact nodes*dim] (length)

  Output Parameter:
. motion - mean motion (length)
@*/
void FrictionSlideMotion(const FrictionSlide *slide, int dim, const PetscReal *values, PetscReal motion[3])
{
  PetscReal across = 0;

  for (int d = 0; d < 3; d++) motion[d] = 0;
  for (PetscInt i = 0; i < slide->n; i++)
    for (int d = 0; d < dim; d++) motion[d] += slide->share[3 * i + d] * values[slide->node[i] * dim + d];
  for (int d = 0; d < 3; d++) across += slide->normal[d] * motion[d];
  for (int d = 0; d < 3; d++) motion[d] -= across * slide->normal[d];
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
  friction->law.kept[0] = friction->law.kept[1] = friction->law.grip[0] = friction->law.grip[1] = 0;
  friction->law.steepness = 0; /* the coefficient stays in the step */
  for (int d = 0; d < 3; d++) {
    friction->law.normal[d] = unit[2][d];
    friction->law.along[d]  = unit[0][d];
    friction->law.slip[d]   = d < 2 ? in.kept[d] + in.grip[d] / in.stiffness + slip[d] : 0;
  }
  PetscCall(FrictionTerm(pair, c, t, &held, &out, &acts));
  if (acts) TakeToTangents(&out, tangent, friction);
  PetscFunctionReturn(PETSC_SUCCESS);
}
