/* Pairs of the sharp edges of masters.

   Contact is measured at points of the slave, and an edge of the tool that stands between them is seen by none: it
   sinks in until some points are behind it, and these are pressed out along its sides. So points on the edges of the
   tool (ridgepoints.h) are the slave points of a second pair, node to surface, whose master is the slave of the first
   one. Its force is square to that surface, and search, smoothing, tangent, penalties and checkpoints are those of all
   pairs. The points have no unknowns, they are contact nodes of the tool (neighbourlists.h); a tool with unknowns gets
   its part from the nodes of the deformable side, see contacttool.c. A point counts where no side of its edge lies on
   the surface (EdgeShare() in flank.c). A right-angled edge, one side of which mostly lies on the surface, presses
   where it is deeper than ContactEdgesBelow() says. So do the nodes on such edges of deformable masters, which are the
   slave nodes of pairs like these. Both serve where SurfaceFollowsEdges(). Slave points of the first pair beside the
   edge keep their area: what the edge holds is not behind its sides, and where a dent is steep they bear it.

   The scene does not name these pairs, and nobody outside sees them: forces, moments and work on the tool, penetrations
   and penalties are those of the pair to which they belong. There are none with friction, with a fluid or with a single
   reference plane. */
#include "contactimpl.h"

/*@
  ContactIsRidge - says whether the slave of a pair is the sharp edges of the master of another one.

  Not collective

  Input Parameter:
. pair - the pair
@*/
PetscBool ContactIsRidge(const ContactPair *pair)
{
  return (PetscBool)(pair->scene == &pair->ridge_scene);
}

/*@
  ContactOnTool - says whether the slave points of a pair are points on the edges of a rigid tool, which are no nodes.

  Not collective

  Input Parameter:
. pair - the pair
@*/
PetscBool ContactOnTool(const ContactPair *pair)
{
  return (PetscBool)(pair->slave->ridge.n > 0);
}

/*@
  ContactTermTag - returns gmsh's tag of the node of a term, for messages; of a point on the edge of a tool that of an
  end of the edge.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term, of a node or of a side
@*/
PetscInt ContactTermTag(const ContactPair *pair, PetscInt c)
{
  return ContactOnTool(pair) ? pair->slave->ridge.point[pair->node[c]].tag : pair->mesh->node_tag[pair->node[c]];
}

/*@
  ContactTermPlace - gives the reference place of the node of a term, or of a point on the edge of a tool.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term, of a node or of a side

  Output Parameter:
. X - reference coordinates of the scene (length)
@*/
void ContactTermPlace(const ContactPair *pair, PetscInt c, PetscReal X[3])
{
  if (!ContactOnTool(pair)) {
    MeshNodePlace(pair->mesh, pair->node[c], X);
    return;
  }
  for (int d = 0; d < 3; d++) X[d] = pair->slave->ridge.point[pair->node[c]].X[d] + pair->mesh->centre[d];
}

/*@
  ContactRidgeFaces - marks the nodes of all faces near some points on edges of a tool.

  Collective

  Input Parameters:
+ pair - a pair whose slave is the sharp edges of a tool, with lists
- some - which of its terms

  Input/Output Parameter:
. mine - mine[nodes of the mesh]: at owned nodes of these faces a number above 0 is added
@*/
PetscErrorCode ContactRidgeFaces(const ContactPair *pair, const PetscBool some[], PetscReal *mine)
{
  const NeighbourLists lists = pair->lists;
  const int            dim   = pair->mesh->dim;
  PetscReal           *values, *nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &nodes));
  for (PetscInt c = 0; c < pair->n; c++) {
    for (PetscInt f = lists->facet_ptr[c]; some[c] && f < lists->facet_ptr[c + 1]; f++) {
      for (int a = 0; a < ElementGet(lists->facet[f].type)->nodes; a++) {
        const PetscInt p = lists->list_point[lists->list_ptr[c] + lists->facet[f].nodes[a]];

        values[lists->point_node[lists->point_ptr[p]] * dim] = 1;
      }
    }
  }
  PetscCall(NeighbourListsReduce(lists, values, nodes));
  for (PetscInt i = 0; i < pair->mesh->n_nodes; i++) mine[i] += nodes[i * dim];
  PetscCall(PetscFree2(values, nodes));
  PetscFunctionReturn(PETSC_SUCCESS);
}
