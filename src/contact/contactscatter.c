/* Scatter of the nodal pressures of a pair: how much they jump from node to node, against their smooth part. For
   reports. */
#include "contactimpl.h"
#include "mesh/meshdofs.h"

/* Fewest nodes that a scatter is measured from. Over fewer the pressure of a small contact itself bends too much. */
#define SCATTER_NODES 5

/* Pairs of nodes that lie next to each other in a face, by the face's type, ended by two equal ones. Corners of 6-node
   triangles carry no force, so that the middle nodes are neighbours too. */
static const int neighbours[ELEMENT_TYPES][13][2] = {
  [ELEMENT_EDGE2] = {{0, 1}},
  [ELEMENT_EDGE3] = {{0, 2}, {2, 1}},
  [ELEMENT_TRI3]  = {{0, 1}, {1, 2}, {2, 0}},
  [ELEMENT_TRI6]  = {{0, 3}, {3, 1}, {1, 4}, {4, 2}, {2, 5}, {5, 0}, {3, 4}, {4, 5}, {5, 3}},
  [ELEMENT_QUAD4] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}},
  [ELEMENT_QUAD9] = {{0, 4}, {4, 1}, {1, 5}, {5, 2}, {2, 6}, {6, 3}, {3, 7}, {7, 0}, {8, 4}, {8, 5}, {8, 6}, {8, 7}}};

/* A value at each local node of the mesh, and whether there is one */
typedef struct {
  PetscReal value, valid;
} NodeValue;

/* What a node gathers from its neighbours */
typedef struct {
  PetscReal sum, count, blocked; /* blocked: neighbours that have area and no valid value */
} NodeSums;

enum { NODE_VALUES = sizeof(NodeValue) / sizeof(PetscReal), NODE_SUMS = sizeof(NodeSums) / sizeof(PetscReal) };

/* Marks the nodes on free edges of the slave, where pressures may end steeply. */
static PetscErrorCode MarkEnds(const ContactPair *pair, PetscReal *end)
{
  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < pair->slave->n_faces; f++) {
    const Facet   *face  = &pair->slave->faces[f];
    const Element *e     = ElementGet(face->type);
    const int      edges = e->dim == 1 ? 2 : e->edges;

    for (int k = 0; k < edges; k++) {
      if (!(face->free_edges >> k & 1)) continue;
      end[face->nodes[e->dim == 1 ? k : e->edge_corners[k][0]]] = 1;
      end[face->nodes[e->dim == 1 ? k : e->edge_corners[k][1]]] = 1;
      if (e->dim == 2 && e->order == 2) end[face->nodes[e->corners + k]] = 1;
    }
  }
  PetscCall(MeshSumNodes(pair->mesh, 1, end));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces each value by half of what it differs from the mean of its neighbours. Values that alternate stay, smooth
   ones vanish. A value with a neighbour that has none becomes invalid. present: nodes with area; sums: room. */
static PetscErrorCode TakeJumps(const ContactPair *pair, const PetscReal *present, NodeSums *sums, NodeValue *values)
{
  const PetscInt n = pair->mesh->n_nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(sums, n));
  for (PetscInt f = 0; f < pair->slave->n_faces; f++) {
    const Facet *face    = &pair->slave->faces[f];
    const int(*pairs)[2] = neighbours[face->type];

    for (int k = 0; pairs[k][0] != pairs[k][1]; k++) {
      for (int side = 0; side < 2; side++) {
        const int a = face->nodes[pairs[k][side]], b = face->nodes[pairs[k][1 - side]];

        if (present[b] == 0) continue;
        sums[a].sum += values[b].valid > 0 ? values[b].value : 0;
        sums[a].count += values[b].valid > 0;
        sums[a].blocked += values[b].valid == 0;
      }
    }
  }
  PetscCall(MeshSumNodes(pair->mesh, NODE_SUMS, (PetscReal *)sums));
  for (PetscInt i = 0; i < n; i++) {
    if (sums[i].blocked > 0 || sums[i].count == 0) values[i].valid = 0;
    values[i].value = values[i].valid > 0 ? 0.5 * (values[i].value - sums[i].sum / sums[i].count) : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Area-weighted sums over this rank's terms that still have a value: jumps and smooth parts, squared; the number of
   terms. */
static void SumScatter(const ContactPair *pair, const NodeValue *jumps, PetscReal sum[3])
{
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const NodeValue *jump = &jumps[pair->node[c]];

    if (jump->valid == 0) continue;
    sum[0] += pair->whole[c] * PetscSqr(jump->value);
    sum[1] += pair->whole[c] * PetscSqr(pair->pressure[c] - jump->value);
    sum[2] += 1;
  }
}

/*@
  ContactPairScatter - measures how much the nodal pressures of a pair jump from node to node: the root of the mean
  square of the jumps over that of the smooth part, weighted by area.

  Collective

  Input Parameters:
+ contact - the contact
. p       - number of the pair
- u       - local displacements of the present state, u[n_nodes*dim] (length)

  Output Parameter:
. scatter - the same on all ranks; NaN where the contact is too small to tell

  Note:
  The jump is what two passes of the difference from the neighbours' mean leave, so that pressures that alternate count
  whole and a polynomial of degree 3 over even nodes does not count. Nodes near the end of the contact and of the slave
  surface are left out.
@*/
PetscErrorCode ContactPairScatter(Contact contact, int p, const PetscReal *u, PetscReal *scatter)
{
  const ContactPair *pair = &contact->pairs[p];
  const PetscInt     n    = contact->mesh->n_nodes;
  ContactNodes       nodes;
  PetscReal         *present, *end, sum[3] = {0, 0, 0};
  NodeValue         *values;
  NodeSums          *sums;

  PetscFunctionBeginUser;
  PetscCall(ContactGetNodes(contact, p, u, &nodes));
  PetscCall(PetscCalloc4(n, &present, n, &end, n, &values, n, &sums));
  PetscCall(MarkEnds(pair, end));
  for (PetscInt c = 0; c < nodes.n; c++) {
    present[nodes.node[c]] = 1;
    values[nodes.node[c]]  = (NodeValue){nodes.pressure[c], nodes.force[c] > 0};
  }
  PetscCall(MeshSumNodes(contact->mesh, 1, present));
  PetscCall(MeshSumNodes(contact->mesh, NODE_VALUES, (PetscReal *)values));
  for (PetscInt i = 0; i < n; i++)
    if (end[i] > 0) values[i].valid = 0;
  for (int pass = 0; pass < 2; pass++) PetscCall(TakeJumps(pair, present, sums, values));
  SumScatter(pair, values, sum);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPIU_REAL, MPI_SUM, contact->mesh->comm));
  *scatter = sum[2] >= SCATTER_NODES && sum[1] > 0 ? PetscSqrtReal(sum[0] / sum[1]) : NAN;
  PetscCall(PetscFree4(present, end, values, sums));
  PetscFunctionReturn(PETSC_SUCCESS);
}
