/* Terms of ends, which stand beside those of nodes in surface to surface contact.

   A slave may end, or turn at a sharp edge, and meet the master with this end first: the front of a strip in a die, a
   block that lands on its edge. The mean gap over the faces behind the end is open until the end is up to a third of a
   face deep in the master. So faces with an end have a quadrature rule with points on it, and these points have terms
   of their own: one for the points on the end around a node, in space one more for those at a corner of the end. They
   press only where the end is deeper than faces may cross, so that they do nothing where contact is resolved, and
   forces under a constant pressure are those without them. */
#include "contactimpl.h"
#include "search/surfaceends.h"
#include "base/vectors.h"

/* On how many ends of its face a point lies at a corner; on an edge in space it lies on 1. */
enum { CORNER_ENDS = 2 };

/* Depth at which the term of an end begins to press, in the slave's or the master's faces, whichever are smaller: half
   of what the certificate allows. A term that presses from the first touch on holds the end harder than its coarse
   faces can follow: a hole that is expanded by a cone comes out 3.2 % too wide, and not 1.8 %. */
#define END_DEPTH 0.05

/* Stiffnesses of surfaces that differ by less than this part are alike: they are sums over the faces of all ranks. */
#define SIDES_ALIKE 1e-6

/* Does the master of a pair keep its shape at the slave's edges, being rigid or no softer than the slave? */
static PetscBool MasterKeepsShape(const ContactPair *pair)
{
  return (PetscBool)(!pair->master || pair->master->rigid ||
                     pair->master->stiffness >= (1 - SIDES_ALIKE) * pair->slave->stiffness);
}

/*@
  ContactSidesAngle - returns the angle of the edges from which on their sides have terms of their own (radians); PI: no
  sides have any.

  Not collective

  Input Parameter:
. pair - the pair

  Note:
  In node to surface contact a node is one point. A rigid master, or one as stiff as the slave, keeps its own shape,
  with its own corners. A softer one bends around the slave's edges: both sides of a blunt edge then see the same part
  of it, and one mean over both holds the edge less stiffly. At right-angled edges of second order one mean would press
  the master away from the one side to bring the edge out of it, and a stamp on a rubber pad
  (tests/jobs/stamp_on_pad.yaml) takes 12 steps, 6 failed ones and 446 iterations, not 6, none and 110. See
  SurfaceFollowsEdges().
@*/
PetscReal ContactSidesAngle(const ContactPair *pair)
{
  if (!pair->formulation.surface) return PETSC_PI;
  if (MasterKeepsShape(pair)) return pair->fit.feature_angle;
  return SurfaceFollowsEdges(pair->mesh, pair->geometry) ? PetscMax(SURFACE_SQUARE, pair->fit.feature_angle) : PETSC_PI;
}

/*@
  ContactSideAdd - adds a term without area beside that of a node, and returns its number.

  Not collective

  Input Parameters:
+ pair - the pair, with room behind its terms
- c    - the node's own term
@*/
PetscInt ContactSideAdd(ContactPair *pair, PetscInt c)
{
  const PetscInt term = pair->n++;

  pair->node[term] = pair->node[c];
  pair->area[term] = 0;
  pair->size[term] = pair->size[c];
  pair->turn[term] = pair->turn[c];
  return term;
}

/*@
  ContactEndsFind - finds the ends of a pair's slave, so that its offsets heed them.

  Collective

  Input Parameters:
+ pair  - the pair, before its slave points are made
- scene - the scene

  Note:
  They serve where the master keeps its shape and bodies yield. Elastic bodies are not crushed at their edges, and
  such terms cost failed steps: with friction a cone clutch fails 2 of 9, and three loose plates, listed, do not get to
  the end. What a fluid between surfaces reaches is told by the means of nodes, and changes with them. On planes of
  symmetry faces go on, whether the pair has images beyond them or not.
@*/
PetscErrorCode ContactEndsFind(ContactPair *pair, Scene scene)
{
  PetscFunctionBeginUser;
  if (!pair->formulation.surface || !MasterKeepsShape(pair) || !SceneIsPlastic(scene) || SceneHasFluid(scene))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SurfaceFindEnds(pair->slave, pair->fit.feature_angle, pair->n_mirrors, pair->mirrors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactEndsBegin - makes room for the terms of ends at the nodes of slave points.

  Not collective

  Input Parameter:
. pair - the pair; nothing is done where its slave has no ends
@*/
PetscErrorCode ContactEndsBegin(ContactPair *pair)
{
  const SlavePoints slaves = pair->slaves;
  PetscBool         some   = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < slaves->n_faces; f++) some = (PetscBool)(some || slaves->ends[f]);
  if (!some) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(slaves->ptr[slaves->n], &pair->at_end));
  for (PetscInt k = 0; k < slaves->ptr[slaves->n]; k++) pair->at_end[k] = -1;
  PetscCall(PetscCalloc1(pair->n_nodes + 3 * FACE_MAX_NODES * slaves->n_faces, &pair->below));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On how many ends of its face does point q lie? */
static int EndsAt(const SlavePoints slaves, PetscInt face, PetscInt q)
{
  const int at =
    FaceRuleOf(slaves->faces[face].type, slaves->finer, slaves->ends[face])->edges[q - slaves->first[face]] &
    slaves->ends[face];
  int ends = 0;

  for (int bits = at; bits; bits >>= 1) ends += bits & 1;
  return PetscMin(ends, CORNER_ENDS);
}

/* Term of the side of a face at a node. */
static PetscInt SideTerm(const ContactPair *pair, PetscInt c, const ContactCornerFace *face)
{
  const PetscInt side = pair->corner[face->face * FACE_MAX_NODES + face->at];

  return side >= 0 ? side : c;
}

/* Lists a face's points on `ends` ends for the term of a node, which is added for the first of them, and returns the
   term. -1: there is none. */
static PetscInt TakePoints(ContactPair *pair, PetscInt c, const ContactCornerFace *face, int ends, PetscInt term)
{
  const SlavePoints slaves = pair->slaves;

  for (PetscInt q = slaves->first[face->face]; q < slaves->first[face->face + 1]; q++) {
    const PetscInt  k    = slaves->ptr[q] + face->at;
    const PetscReal area = pair->scene->share * slaves->weight[q] * slaves->hat[k];

    if (EndsAt(slaves, face->face, q) != ends || area <= 0) continue;
    if (term < 0) term = ContactSideAdd(pair, c);
    pair->at_end[k] = term;
    pair->area[term] += area;
    pair->below[term] = END_DEPTH * PetscMin(pair->size[c], pair->master ? pair->master->mean_size : PETSC_MAX_REAL);
  }
  return term;
}

/*@
  ContactEndsAdd - adds the terms of ends at a node, for each side of a sharp edge there.

  Not collective

  Input Parameters:
+ pair - the pair, after ContactEndsBegin(), with the terms of the node's sides
. c    - the node's own term
. n    - number of faces around the node
- face - these faces

  Work:
. made - made[n] is room
@*/
void ContactEndsAdd(ContactPair *pair, PetscInt c, PetscInt n, const ContactCornerFace face[], PetscInt made[])
{
  for (int ends = 1; pair->at_end && ends <= CORNER_ENDS; ends++) {
    for (PetscInt i = 0; i < n; i++) {
      made[i] = -1;
      for (PetscInt j = 0; j < i && made[i] < 0; j++)
        if (SideTerm(pair, c, &face[i]) == SideTerm(pair, c, &face[j])) made[i] = made[j];
      if (pair->slaves->ends[face[i].face]) made[i] = TakePoints(pair, c, &face[i], ends, made[i]);
    }
  }
}

/*@
  ContactEndsPoints - lists the slave points of the terms of ends, with their areas in them.

  Not collective

  Input Parameter:
. pair - the pair; term_ptr[c + 1] is where the points of each of these terms begin, on return where they end
@*/
void ContactEndsPoints(ContactPair *pair)
{
  const SlavePoints slaves = pair->slaves;

  for (PetscInt q = 0; pair->at_end && q < slaves->n; q++) {
    for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++) {
      PetscInt at;

      if (pair->at_end[k] < 0) continue;
      at                    = pair->term_ptr[pair->at_end[k] + 1]++;
      pair->term_point[at]  = q;
      pair->term_weight[at] = pair->scene->share * slaves->weight[q] * slaves->hat[k];
    }
  }
}

/*@
  ContactEndDepth - returns the depth below which a term begins to press (length); 0 for all terms but those of ends.

  Not collective

  Input Parameters:
+ pair - the pair
- c    - the term
@*/
PetscReal ContactEndDepth(const ContactPair *pair, PetscInt c)
{
  return pair->below && c < pair->n_sides ? pair->below[c] : 0;
}

/* Is the edge of a term sharper than a right angle? Nodes of deformable masters have no such edge that is known. */
static PetscBool IsWedge(const ContactPair *pair, PetscInt c)
{
  const PetscReal *sides = ContactOnTool(pair) ? pair->slave->ridge.point[pair->node[c]].sides : NULL;

  return (PetscBool)(sides && Dot(sides, &sides[3]) < VECTORS_WEDGE);
}

/*@
  ContactEdgesBelow - has the terms of a pair of a master's right-angled edges press where an edge is deeper than faces
  may cross.

  Not collective

  Input Parameter:
. pair - the pair, with its terms

  Note:
  A side of such an edge mostly lies on the slave, whose own points hold it. Where faces are fine enough for the edge,
  its terms do nothing.
@*/
PetscErrorCode ContactEdgesBelow(ContactPair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(pair->n, &pair->below));
  for (PetscInt c = 0; c < pair->n; c++) pair->below[c] = IsWedge(pair, c) ? 0 : END_DEPTH * pair->size[c];
  PetscFunctionReturn(PETSC_SUCCESS);
}
