/* Terms of the sides of sharp edges, which stand beside those of nodes in surface to surface contact.

   A node on a sharp edge of the slave has faces that look different ways, and so may see different sides of the master,
   or none. One mean gap over all of them says nothing of either: where a corner stands on a floor, the points above it
   turn from the floor to a wall far away as the body tilts a little, and the mean jumps from closed to wide open. So
   each smooth part of the faces around such a node has a term of its own, with the mean gap over this part. */
#include "contactimpl.h"

/* Unit normal of a face at one of its nodes, in the reference configuration. */
static void NormalAt(const SlavePoints slaves, PetscInt f, int at, PetscReal normal[3])
{
  const Facet   *facet = &slaves->faces[f];
  const Element *e     = ElementGet(facet->type);
  const int      dim   = slaves->mesh->dim;
  double         N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], t[2][3] = {{0}};
  PetscReal      length = 0;

  ElementShape(facet->type, e->node[at], N, dN, NULL);
  for (int a = 0; a < e->nodes; a++)
    for (int k = 0; k < dim - 1; k++)
      for (int d = 0; d < dim; d++) t[k][d] += dN[a * e->dim + k] * slaves->nodes[facet->nodes[a]].X[d];
  if (dim == 2) t[1][2] = 1;
  for (int d = 0; d < 3; d++) normal[d] = t[0][(d + 1) % 3] * t[1][(d + 2) % 3] - t[0][(d + 2) % 3] * t[1][(d + 1) % 3];
  for (int d = 0; d < 3; d++) length += PetscSqr(normal[d]);
  for (int d = 0; d < 3 && length > 0; d++) normal[d] /= PetscSqrtReal(length);
}

/* Do two faces have an edge in common at a node of both? In the plane the node is the edge. */
static PetscBool ShareEdge(const SlavePoints slaves, PetscInt f, PetscInt g)
{
  const Facet *a = &slaves->faces[f], *b = &slaves->faces[g];
  int          common = 0;

  for (int i = 0; i < ElementGet(a->type)->corners; i++)
    for (int j = 0; j < ElementGet(b->type)->corners; j++) common += a->nodes[i] == b->nodes[j];
  return (PetscBool)(common >= slaves->mesh->dim - 1);
}

/* Gives the n faces around a node the numbers of their sides: that of the first face of the side, by ascending tag. */
static void FindSides(const ContactPair *pair, PetscInt n, const ContactCornerFace face[], PetscInt side[])
{
  const PetscReal cosine  = PetscCosReal(ContactSidesAngle(pair));
  PetscBool       changed = PETSC_TRUE;

  for (PetscInt i = 0; i < n; i++) side[i] = i;
  while (changed) {
    changed = PETSC_FALSE;
    for (PetscInt i = 0; i < n; i++) {
      for (PetscInt j = 0; j < i; j++) {
        const PetscReal *a = face[i].normal, *b = face[j].normal;

        if (side[i] == side[j] || a[0] * b[0] + a[1] * b[1] + a[2] * b[2] < cosine ||
            !ShareEdge(pair->slaves, face[i].face, face[j].face))
          continue;
        side[i] = side[j] = PetscMin(side[i], side[j]);
        changed           = PETSC_TRUE;
      }
    }
  }
}

/* Gives a face's node to a term, with its part of the area, which the node's own term loses. */
static void TakeFace(ContactPair *pair, PetscInt c, PetscInt term, const ContactCornerFace *face)
{
  const SlavePoints slaves = pair->slaves;
  PetscReal         area   = 0;

  for (PetscInt q = slaves->first[face->face]; q < slaves->first[face->face + 1]; q++)
    area += pair->scene->share * slaves->weight[q] * slaves->hat[slaves->ptr[q] + face->at];
  pair->area[term] += area;
  pair->area[c] -= area;
  pair->corner[face->face * FACE_MAX_NODES + face->at] = term;
}

/* Adds the terms of a node's sides beside the first one, which has the node's own term. term[n] is room. */
static void AddSides(ContactPair *pair, PetscInt c, PetscInt n, const ContactCornerFace face[], PetscInt side[],
                     PetscInt term[])
{
  FindSides(pair, n, face, side);
  for (PetscInt i = 0; i < n; i++) {
    if (side[i] == 0) continue;
    if (side[i] == i) term[i] = ContactSideAdd(pair, c);
    TakeFace(pair, c, term[side[i]], &face[i]);
  }
}

/* Lists the faces around the nodes of the slave points by ascending tag: those of node i are ptr[i] to ptr[i+1]-1. */
static PetscErrorCode FacesAround(const SlavePoints slaves, PetscInt **out_ptr, ContactCornerFace **out)
{
  PetscInt          *ptr, n = 0;
  ContactCornerFace *face;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(slaves->n_nodes + 2, &ptr));
  for (PetscInt f = 0; f < slaves->n_faces; f++) {
    for (int a = 0; a < ElementGet(slaves->faces[f].type)->nodes; a++, n++) ptr[slaves->faces[f].nodes[a] + 2]++;
  }
  for (PetscInt i = 0; i <= slaves->n_nodes; i++) ptr[i + 1] += ptr[i];
  PetscCall(PetscMalloc1(n, &face));
  for (PetscInt f = 0; f < slaves->n_faces; f++) {
    for (int a = 0; a < ElementGet(slaves->faces[f].type)->nodes; a++) {
      ContactCornerFace *next =
        &face[ptr[slaves->faces[f].nodes[a] + 1]++]; /* after the loop the start of the next node */

      *next = (ContactCornerFace){.face = f, .at = a};
      NormalAt(slaves, f, a, next->normal);
    }
  }
  *out_ptr = ptr;
  *out     = face;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCornersAdd - adds the terms of the sides of sharp edges, and of ends, to those of nodes.

  Not collective

  Input Parameter:
. pair - the pair, with the terms of its nodes, and room for three terms for each node of each face behind them

  Note:
  The faces of the slave points are by ascending tag, so sides do not depend on the ranks. Normals are compared at the
  node, by the angle at which fits end.
@*/
PetscErrorCode ContactCornersAdd(ContactPair *pair)
{
  const SlavePoints  slaves = pair->slaves;
  ContactCornerFace *face   = NULL;
  PetscInt          *ptr    = NULL, *side, *term;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(pair->n_nodes + 1, &pair->first_side, pair->n_nodes, &pair->whole));
  PetscCall(PetscArraycpy(pair->whole, pair->area, pair->n_nodes));
  for (PetscInt c = 0; c <= pair->n_nodes; c++) pair->first_side[c] = pair->n;
  if (ContactSidesAngle(pair) >= PETSC_PI) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(slaves->n_faces * FACE_MAX_NODES, &pair->corner));
  for (PetscInt i = 0; i < slaves->n_faces * FACE_MAX_NODES; i++) pair->corner[i] = -1;
  PetscCall(FacesAround(slaves, &ptr, &face));
  PetscCall(PetscMalloc2(slaves->n_faces, &side, slaves->n_faces, &term));
  PetscCall(ContactEndsBegin(pair));
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt i = NodeKeysFind(slaves->n_nodes, slaves->nodes, pair->mesh->node_id[pair->node[c]]);

    AddSides(pair, c, ptr[i + 1] - ptr[i], &face[ptr[i]], side, term);
    ContactEndsAdd(pair, c, ptr[i + 1] - ptr[i], &face[ptr[i]], term);
    pair->first_side[c + 1] = pair->n;
  }
  PetscCall(PetscFree2(side, term));
  PetscCall(PetscFree(face));
  PetscCall(PetscFree(ptr));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactCornersTake - gives the nodes of slave points on further sides of sharp edges to the terms of these sides.

  Not collective

  Input Parameter:
. pair - the pair, after ContactCornersAdd(); without it nothing is done

  Input/Output Parameter:
. term - of each node of each slave point, that of the node; -1: none
@*/
void ContactCornersTake(const ContactPair *pair, PetscInt term[])
{
  const SlavePoints slaves = pair->slaves;

  for (PetscInt f = 0; pair->corner && f < slaves->n_faces; f++) {
    for (PetscInt q = slaves->first[f]; q < slaves->first[f + 1]; q++) {
      for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++) {
        const PetscInt side = pair->corner[f * FACE_MAX_NODES + k - slaves->ptr[q]];

        if (term[k] >= 0 && side >= 0) term[k] = side;
      }
    }
  }
}

/*@
  ContactCornerId - returns a number of a term of a side that no other term of its pair has, the same on any ranks.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term
@*/
PetscInt ContactCornerId(const ContactPair *pair, PetscInt c)
{
  PetscInt side = 1;

  while (c - side >= pair->n_nodes && pair->node[c - side] == pair->node[c]) side++;
  return side * pair->mesh->n_global + pair->mesh->node_id[pair->node[c]];
}

/*@
  ContactNodeTerm - returns the term of a node whose gap says how far the node is from the master: that of the side with
  the least gap.

  Not collective

  Input Parameters:
+ pair  - the pair
. state - its state, now or accepted
- c     - the node's own term

  Note:
  Returns c where no side has a gap, and in node to surface contact.
@*/
PetscInt ContactNodeTerm(const ContactPair *pair, const ContactState *state, PetscInt c)
{
  PetscInt least = c;

  for (PetscInt i = pair->first_side[c]; i < pair->first_side[c + 1]; i++)
    if (state->gap[i] + ContactEndDepth(pair, i) < state->gap[least] + ContactEndDepth(pair, least) ||
        PetscIsNanReal(state->gap[least]))
      least = i;
  return least;
}
