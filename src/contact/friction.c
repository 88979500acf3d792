/* Friction of a pair: anchors, slip, tractions and forces. */
#include "contactimpl.h"
#include "base/vectors.h"
#include "mesh/mesh.h"

/* A foot that is outside of its reference face by less than this is on it: rounding. Feet on two faces whose distances
   differ by less than this part of a face are one place on their common edge. */
#define FRICTION_ON_FACE 1e-9
/* A face lies within this many radii of the ball around its nodes. On faces of second order the absolute values of the
   shape functions add up to 5/3 at most, in triangles, and to 25/16 in quadrilaterals. */
#define FRICTION_BALL 1.7
/* Cosine of the angle, 10 degrees, by which the slip of a node may turn within a step: the step is straight, and its
   end gives the direction of all of it. */
#define FRICTION_TURN 0.984807753012208
/* A term that was accepted in contact and is open now, by more than its depth over this, has only touched with a depth
   of round-off. New lists open terms with little pressure too, by up to some times their depth: these were in contact.
 */
#define FRICTION_TOUCH 1e-6
/* A penalty of what sticks below this part of the automatic one comes from pressures that are round-off, as of bodies
   that touch without a load. */
#define FRICTION_SLIGHT 1e-6

/* Allocates the friction of a pair, without anchors. The penalty of what sticks is the automatic one, without the
   factor that the pressure's has: on a pinched pipe Newton's method takes 90 iterations with it, and with ten times as
   much it fails where many nodes change between sticking and slipping. */
PetscErrorCode FrictionCreate(ContactPair *pair)
{
  const PetscInt q = pair->slaves->n, n = pair->n;
  Friction       f;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&f));
  pair->friction = f;
  f->automatic = pair->scene->stick_penalty > 0 ? pair->scene->stick_penalty : PetscMin(pair->initial, pair->automatic);
  f->stiffness = f->automatic;
  PetscCall(PetscCalloc6(q, &f->face, 2 * q, &f->xi, 3 * q, &f->off, 3 * q, &f->place, q, &f->at, 3 * q, &f->force));
  PetscCall(PetscCalloc5(q, &f->foot, q, &f->facet, q, &f->known, q, &f->first, q, &f->lever));
  PetscCall(PetscCalloc1(pair->slaves->lever_ptr ? pair->slaves->lever_ptr[q] : 0, &f->lever_node));
  PetscCall(PetscCalloc7(n, &f->anchored, 2 * n, &f->kept, 2 * n, &f->heading, n, &f->began, n, &f->pressed, n,
                         &f->axis, n, &f->guide));
  PetscCall(PetscCalloc1(2 * n, &f->grip));
  PetscCall(PetscCalloc2(q, &f->taken, 3 * q, &f->held));
  PetscCall(PetscCalloc5(3 * n, &f->nodal, n, &f->elastic, 3 * n, &f->traction, n, &f->status, n, &f->footless));
  for (PetscInt i = 0; i < q; i++) f->face[i] = f->facet[i] = f->at[i] = f->first[i] = -1;
  SearchKeepFaces(pair->search);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Frees the friction of a pair. */
PetscErrorCode FrictionDestroy(Friction *friction)
{
  Friction f = *friction;

  PetscFunctionBeginUser;
  if (!f) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree6(f->face, f->xi, f->off, f->place, f->at, f->force));
  PetscCall(PetscFree5(f->foot, f->facet, f->known, f->first, f->lever));
  PetscCall(PetscFree(f->lever_node));
  PetscCall(PetscFree7(f->anchored, f->kept, f->heading, f->began, f->pressed, f->axis, f->guide));
  PetscCall(PetscFree(f->grip));
  PetscCall(PetscFree5(f->nodal, f->elastic, f->traction, f->status, f->footless));
  PetscCall(PetscFree(f->turns));
  PetscCall(PetscFree2(f->taken, f->held));
  PetscCall(PetscFree(*friction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forgets what belongs to the last projection, because points have moved or lists are new, and finds the anchors' faces
   and the levers' nodes in the lists in force. */
PetscErrorCode FrictionForget(const ContactPair *pair)
{
  const SlavePoints slaves = pair->slaves;
  Friction          f      = pair->friction;

  PetscFunctionBeginUser;
  f->turns_used = 0;
  for (PetscInt k = 0; slaves->lever_ptr && k < slaves->lever_ptr[slaves->n]; k++)
    PetscCall(PetscFindInt(slaves->nodes[slaves->lever_node[k]].id, pair->lists->n_deformable, pair->lists->node_id,
                           &f->lever_node[k]));
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    f->known[q] = PETSC_FALSE;
    f->first[q] = -1;
    f->at[q]    = pair->master && f->face[q] >= 0 ? NeighbourListsFindFace(pair->lists, f->face[q]) : -1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of the face of slave point q with their shares, without offsets and live maps. Returns their number. */
PetscInt FrictionOwnNodes(const ContactPair *pair, PetscInt q, const PetscInt **node, const PetscReal **S)
{
  const SlavePoints slaves = pair->slaves;

  *node = &pair->lists->slave_node[pair->lists->slave_ptr[q]];
  *S    = &slaves->S[slaves->ptr[q]];
  return slaves->ptr[q + 1] - slaves->ptr[q];
}

/* The node of a point of a face, and how the point's components follow the node's. */
void FrictionNodeSign(const ContactPair *pair, PetscInt point, PetscInt *node, PetscReal sign[3])
{
  const NeighbourLists lists = pair->lists;
  const PetscInt       entry = lists->point_ptr[point];
  const SurfaceImage *image = &pair->images[lists->point_image[point]], *side = &pair->images[lists->point_side[entry]];

  *node = lists->point_node[entry];
  for (int d = 0; d < 3; d++) sign[d] = image->sign[d] * side->sign[d];
}

/* Place of slave point q on the face itself: reference coordinates and displacement. */
static void PlainPlace(const ContactPair *pair, PetscInt q, PetscReal X[3], PetscReal u[3])
{
  const NeighbourLists lists = pair->lists;
  const PetscInt      *node;
  const PetscReal     *S;
  const PetscInt       n = FrictionOwnNodes(pair, q, &node, &S);

  for (int d = 0; d < 3; d++) X[d] = u[d] = 0;
  for (PetscInt a = 0; a < n; a++) {
    for (int d = 0; d < lists->dim; d++) {
      X[d] += S[a] * lists->X[node[a] * lists->dim + d];
      u[d] += S[a] * lists->u[node[a] * lists->dim + d];
    }
  }
}

/* Point `node` of the facet on which slave point q has its foot. */
PetscInt FrictionFootPoint(const ContactPair *pair, PetscInt q, int node)
{
  const NeighbourLists lists = pair->lists;
  const Facet         *facet = &lists->facet[lists->facet_ptr[q] + pair->friction->facet[q]];

  return lists->list_point[lists->list_ptr[q] + facet->nodes[node]];
}

/* Is a line through the origin too far from a face to hit it? Shape functions of second order, which may be negative,
   lead out of the ball around the nodes, but not far. */
static PetscBool LineMisses(int dim, int nodes, const PetscReal *x, const PetscReal normal[3])
{
  PetscReal centre[3] = {0}, along = 0, square = 0, radius2 = 0, off2 = 0;

  for (int a = 0; a < nodes; a++)
    for (int d = 0; d < dim; d++) centre[d] += x[a * dim + d] / nodes;
  for (int a = 0; a < nodes; a++) {
    PetscReal distance2 = 0;

    for (int d = 0; d < dim; d++) distance2 += PetscSqr(x[a * dim + d] - centre[d]);
    radius2 = PetscMax(radius2, distance2);
  }
  for (int d = 0; d < dim; d++) {
    along += centre[d] * normal[d];
    square += PetscSqr(normal[d]);
    off2 += PetscSqr(centre[d]);
  }
  return (PetscBool)(off2 - PetscSqr(along) / square > PetscSqr(FRICTION_BALL) * radius2);
}

/* Finds the foot of slave point q on a facet of its list. on_face: only one on the face itself counts. */
static PetscBool FootOnFacet(const ContactPair *pair, PetscInt q, int number, const PetscReal normal[3],
                             PetscBool on_face, FrictionFoot *foot)
{
  const NeighbourLists lists = pair->lists;
  const Facet         *facet = &lists->facet[lists->facet_ptr[q] + number];
  const int            dim   = lists->dim;
  PetscReal            X[3], u[3], x[FACE_MAX_NODES * 3];

  PlainPlace(pair, q, X, u);
  for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
    const PetscInt p = lists->list_point[lists->list_ptr[q] + facet->nodes[a]];

    for (int d = 0; d < dim; d++)
      x[a * dim + d] = (lists->point_X[p * dim + d] - X[d]) + (lists->point_u[p * dim + d] - u[d]);
  }
  if (on_face && LineMisses(dim, ElementGet(facet->type)->nodes, x, normal)) return PETSC_FALSE;
  return FrictionFootFind(dim, facet->type, x, normal, foot) ? PETSC_TRUE : PETSC_FALSE;
}

/* Length of the diagonal of a facet of the list of slave point q, in its reference shape. */
static PetscReal DiagonalOfFacet(const ContactPair *pair, PetscInt q, int number)
{
  const NeighbourLists lists  = pair->lists;
  const Facet         *facet  = &lists->facet[lists->facet_ptr[q] + number];
  PetscReal            square = 0;

  for (int d = 0; d < lists->dim; d++) {
    PetscReal low = PETSC_MAX_REAL, high = PETSC_MIN_REAL;

    for (int a = 0; a < ElementGet(facet->type)->nodes; a++) {
      const PetscReal X = lists->point_X[lists->list_point[lists->list_ptr[q] + facet->nodes[a]] * lists->dim + d];

      low  = PetscMin(low, X);
      high = PetscMax(high, X);
    }
    square += PetscSqr(high - low);
  }
  return PetscSqrtReal(square);
}

/* Says whether facet i, with a foot at a distance, serves slave point q better than the facet that serves it now at
   another distance. Both are as far outside. On a common edge the one with the lower tag serves, on any number of
   ranks: the point of a plane of symmetry has a face on either side. */
static PetscBool ServesBetter(const ContactPair *pair, PetscInt q, int i, PetscReal distance, PetscReal other)
{
  const NeighbourLists lists = pair->lists;
  const Facet         *facet = &lists->facet[lists->facet_ptr[q]];
  const PetscReal      tie   = FRICTION_ON_FACE * DiagonalOfFacet(pair, q, i);

  if (PetscAbsReal(distance - other) <= tie) return (PetscBool)(facet[i].tag < facet[pair->friction->facet[q]].tag);
  return (PetscBool)(PetscAbsReal(distance) < PetscAbsReal(other));
}

/* Finds the foot of slave point q over the facets of its list: the one that the line hits, or else comes nearest to.
   The nearest facet is looked at first: once the line hits one, most others need no foot. */
static PetscBool FindFoot(const ContactPair *pair, PetscInt q, const PetscReal normal[3])
{
  const NeighbourLists lists = pair->lists;
  Friction             f     = pair->friction;
  const int            n = (int)(lists->facet_ptr[q + 1] - lists->facet_ptr[q]), nearest = n ? lists->nearest[q] : -1;
  PetscReal            least = PETSC_MAX_REAL;

  if (f->facet[q] >= 0 && FootOnFacet(pair, q, f->facet[q], normal, PETSC_FALSE, &f->foot[q]) &&
      f->foot[q].outside <= FRICTION_ON_FACE)
    return PETSC_TRUE;
  f->facet[q] = -1;
  for (int k = nearest < 0 ? 0 : -1; k < n; k++) {
    const int    i = k < 0 ? nearest : k;
    FrictionFoot foot;
    PetscReal    outside;

    if (k == nearest || !FootOnFacet(pair, q, i, normal, (PetscBool)(least <= FRICTION_ON_FACE), &foot)) continue;
    outside = PetscMax(foot.outside, FRICTION_ON_FACE);
    if (outside > least) continue;
    if (outside == least && !ServesBetter(pair, q, i, foot.distance, f->foot[q].distance)) continue;
    least       = outside;
    f->facet[q] = i;
    f->foot[q]  = foot;
  }
  return f->facet[q] >= 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* The nodes of the lever of slave point q, with two slopes for each. Returns their number. */
PetscInt FrictionLeverNodes(const ContactPair *pair, PetscInt q, const PetscInt **node, const PetscReal **slope)
{
  const SlavePoints slaves = pair->slaves;
  const PetscInt    first  = slaves->lever_ptr[q];

  *node  = &pair->friction->lever_node[first];
  *slope = &slaves->lever_slope[2 * first];
  return slaves->lever_ptr[q + 1] - first;
}

/* Makes the lever of slave point q. Where its tangents span nothing, because a face has collapsed, it has no forces. */
static void MakeLever(const ContactPair *pair, PetscInt q, const PetscReal normal[3])
{
  const NeighbourLists lists         = pair->lists;
  const int            dim           = lists->dim;
  PetscReal            tangent[2][3] = {{0, 0, 0}, {0, 0, 0}};
  const PetscInt      *node;
  const PetscReal     *slope;
  const PetscInt       n = FrictionLeverNodes(pair, q, &node, &slope);

  for (PetscInt k = 1; k < n; k++) { /* the sum of the slopes is 0, so that the first node may be the origin */
    for (int d = 0; d < dim; d++) {
      const PetscReal x = (lists->X[node[k] * dim + d] - lists->X[node[0] * dim + d]) +
                          (lists->u[node[k] * dim + d] - lists->u[node[0] * dim + d]);

      for (int a = 0; a < dim - 1; a++) tangent[a][d] += slope[2 * k + a] * x;
    }
  }
  if (!FrictionLeverMake(dim, normal, tangent, &pair->friction->lever[q])) pair->friction->lever[q].tangents = 0;
}

/* Finds the foot of slave point q at the last projection along its own part of the first variation, and makes its
   lever. */
static PetscBool MakeFoot(const ContactPair *pair, PetscInt q, const PetscReal *own)
{
  PetscReal normal[3] = {0, 0, 0};

  for (int d = 0; d < pair->mesh->dim; d++) normal[d] = own[d];
  pair->friction->known[q] = PETSC_TRUE;
  if (!FindFoot(pair, q, normal)) return PETSC_FALSE;
  MakeLever(pair, q, normal);
  return PETSC_TRUE;
}

/* Gets the foot of slave point q at the last projection. */
PetscErrorCode FrictionPointFoot(const ContactPair *pair, PetscInt q, const FrictionFoot **foot, PetscBool *found)
{
  Friction f = pair->friction;

  PetscFunctionBeginUser;
  PetscCall(ContactVariationsNeed(pair, q));
  *foot  = &f->foot[q];
  *found = (PetscBool)(pair->master && pair->variations->first[q] < pair->variations->end[q]);
  if (*found && !f->known[q])
    *found = MakeFoot(pair, q, &pair->variations->own[q * pair->mesh->dim]);
  else if (*found)
    *found = (PetscBool)(f->facet[q] >= 0);
  f->known[q] = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The place in an analytic tool, at its first position, of what is at x now. */
static void ToolPlace(const ContactPair *pair, PetscReal t, const PetscReal x[3], PetscReal place[3])
{
  const Motion *motion = &pair->scene->motion;
  PetscReal     point[3];

  MotionPlace(motion, t, motion->point, point);
  for (int i = 0; i < 3; i++) {
    PetscReal unit[3] = {i == 0, i == 1, i == 2}, turned[3];

    MotionTurn(motion, t, unit, turned);
    place[i] = motion->point[i];
    for (int d = 0; d < 3; d++) place[i] += turned[d] * (x[d] - point[d]);
  }
}

/* The frame of the face on which slave point q is anchored, at its anchor. */
void FrictionAnchorFrame(const ContactPair *pair, PetscInt q, FrictionFrame *frame)
{
  const NeighbourLists lists = pair->lists;
  const Facet         *face  = &lists->face[pair->friction->at[q]];
  const int            dim   = lists->dim;
  PetscReal            N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2], tangent[2][3] = {{0, 0, 0}, {0, 0, dim == 2}};

  ElementShape(face->type, &pair->friction->xi[2 * q], N, dN, NULL);
  for (int k = 0; k < ElementGet(face->type)->nodes; k++)
    for (int a = 0; a < dim - 1; a++)
      for (int d = 0; d < dim; d++)
        tangent[a][d] +=
          dN[k * (dim - 1) + a] * (lists->point_X[face->nodes[k] * dim + d] + lists->point_u[face->nodes[k] * dim + d]);
  FrictionFrameMake(tangent, frame);
}

/* The distance from the anchor of slave point q to the point. */
static void AnchorDistance(const ContactPair *pair, PetscInt q, PetscReal t, PetscReal v[3])
{
  const NeighbourLists lists = pair->lists;
  const Friction       f     = pair->friction;
  const int            dim   = lists->dim;
  PetscReal            X[3], u[3], N[FACE_MAX_NODES], x[3];

  PlainPlace(pair, q, X, u);
  if (pair->master) {
    const Facet *face = &lists->face[f->at[q]];

    ElementShape(face->type, &f->xi[2 * q], N, NULL, NULL);
    for (int k = 0; k < ElementGet(face->type)->nodes; k++) {
      for (int d = 0; d < dim; d++) {
        X[d] -= N[k] * lists->point_X[face->nodes[k] * dim + d];
        u[d] -= N[k] * lists->point_u[face->nodes[k] * dim + d];
      }
    }
  } else {
    MotionPlace(&pair->scene->motion, t, &f->place[3 * q], x);
    for (int d = 0; d < dim; d++) X[d] -= x[d] - pair->mesh->centre[d];
  }
  for (int d = 0; d < 3; d++) v[d] = d < dim ? X[d] + u[d] : 0;
}

/* Adds scale times the slip of slave point q: its distance to its anchor, less what turns with the master's face. */
static void AddSlip(const ContactPair *pair, PetscInt q, PetscReal t, PetscReal scale, PetscReal slip[3])
{
  PetscReal     v[3], off[3] = {0, 0, 0};
  FrictionFrame frame;

  AnchorDistance(pair, q, t, v);
  if (pair->master) {
    FrictionAnchorFrame(pair, q, &frame);
    FrictionFrameCarry(&frame, &pair->friction->off[3 * q], off);
  }
  for (int d = 0; d < 3; d++) slip[d] += scale * (v[d] - off[d]);
}

/* Finds the place of the master at which slave point q is anchored: that below it. face[q] < 0: there is none. */
static PetscErrorCode AnchorFind(ContactPair *pair, PetscInt q)
{
  Friction  f = pair->friction;
  PetscReal own[3];
  PetscBool found;

  PetscFunctionBeginUser;
  f->face[q] = f->at[q] = -1;
  if (pair->factor[q] == 0 || PetscIsNanReal(pair->point_gap[q])) PetscFunctionReturn(PETSC_SUCCESS);
  if (!pair->master) {
    f->face[q] = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  f->facet[q] = -1; /* the anchor does not depend on where the foot has been before */
  PetscCall(ContactVariationsOwnPart(pair, q, own, &found));
  if (!found || !MakeFoot(pair, q, own)) PetscFunctionReturn(PETSC_SUCCESS);
  f->face[q] = pair->lists->facet[pair->lists->facet_ptr[q] + f->facet[q]].tag;
  f->at[q]   = NeighbourListsFindFace(pair->lists, f->face[q]);
  for (int a = 0; a < 2; a++) f->xi[2 * q + a] = f->foot[q].xi[a];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Slave point q slips from where the points of the lists are now. */
static void AnchorTake(ContactPair *pair, PetscInt q, PetscReal t)
{
  Friction      f = pair->friction;
  FrictionFrame frame;
  PetscReal     v[3], X[3], u[3];

  if (f->face[q] < 0) return;
  if (!pair->master) {
    PlainPlace(pair, q, X, u);
    for (int d = 0; d < 3; d++) X[d] += u[d] + (d < pair->mesh->dim ? pair->mesh->centre[d] : 0);
    ToolPlace(pair, t, X, &f->place[3 * q]);
    return;
  }
  AnchorDistance(pair, q, t, v);
  FrictionAnchorFrame(pair, q, &frame);
  FrictionFrameTake(&frame, v, &f->off[3 * q]);
}

/* Anchors slave point q where it is. */
static PetscErrorCode AnchorPoint(ContactPair *pair, PetscInt q, PetscReal t)
{
  PetscFunctionBeginUser;
  PetscCall(AnchorFind(pair, q));
  AnchorTake(pair, q, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The direction that turns with the master at the anchor of slave point q: a tangent of the face, or an axis of the
   tool. */
static void Along(const ContactPair *pair, PetscInt q, int axis, PetscReal t, PetscReal along[3])
{
  const NeighbourLists lists   = pair->lists;
  const Friction       f       = pair->friction;
  const int            dim     = lists->dim;
  PetscReal            unit[3] = {axis == 0, axis == 1, axis == 2}, N[FACE_MAX_NODES], dN[FACE_MAX_NODES * 2];
  const Facet         *face;

  for (int d = 0; d < 3; d++) along[d] = 0;
  if (!pair->master) {
    MotionTurn(&pair->scene->motion, t, unit, along);
    return;
  }
  face = &lists->face[f->at[q]];
  ElementShape(face->type, &f->xi[2 * q], N, dN, NULL);
  for (int k = 0; k < ElementGet(face->type)->nodes; k++)
    for (int d = 0; d < dim; d++)
      along[d] +=
        dN[k * (dim - 1)] * (lists->point_X[face->nodes[k] * dim + d] + lists->point_u[face->nodes[k] * dim + d]);
}

/* Says whether entry k of the terms' lists of slave points counts in the gap of its term. */
PetscBool FrictionTermTakes(const ContactPair *pair, PetscInt k)
{
  const PetscInt q = pair->term_point[k];

  return (PetscBool)(pair->term_weight[k] * pair->factor[q] != 0 && !PetscIsNanReal(pair->point_gap[q]));
}

/* The slave point whose anchor gives the tangents of a term. It stays in a step, as what is kept has its components
   along them; only where its face is not in the lists any more another point serves. -1: no point has an anchor. */
PetscInt FrictionTermGuide(const ContactPair *pair, PetscInt c)
{
  const Friction f     = pair->friction;
  const PetscInt guide = f->guide[c];

  if (guide >= 0 && (!pair->master || f->at[guide] >= 0)) return guide;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    if (FrictionTermTakes(pair, k) && f->face[pair->term_point[k]] >= 0) return pair->term_point[k];
  return -1;
}

/* Fills normal, slip and along of a term. Points without an anchor have not slipped. *found: a point has an anchor. */
static PetscErrorCode TermSlip(const ContactPair *pair, PetscInt c, PetscReal t, FrictionInput *in, PetscBool *found)
{
  const int dim   = pair->mesh->dim;
  PetscReal area  = 0;
  PetscInt  guide = FrictionTermGuide(pair, c), anchored = 0;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (int d = 0; d < 3; d++) in->normal[d] = in->slip[d] = 0;
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++)
    if (FrictionTermTakes(pair, k)) area += pair->term_weight[k] * pair->factor[pair->term_point[k]];
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
    const PetscInt  q     = pair->term_point[k];
    const PetscReal share = pair->term_weight[k] * pair->factor[q] / area;

    if (!FrictionTermTakes(pair, k)) continue;
    PetscCall(ContactVariationsNeed(pair, q));
    for (int d = 0; d < dim; d++) in->normal[d] += share * pair->variations->own[q * dim + d];
    if (pair->friction->face[q] < 0) continue;
    PetscCheck(!pair->master || pair->friction->at[q] >= 0, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "the lists lack the face on which friction is anchored");
    AddSlip(pair, q, t, share, in->slip);
    anchored++;
  }
  if (!anchored) PetscFunctionReturn(PETSC_SUCCESS);
  Along(pair, guide, pair->friction->axis[c], t, in->along);
  *found = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The axis of an analytic tool that is least along a normal. */
static int LeastAlong(const ContactPair *pair, PetscReal t, const PetscReal normal[3])
{
  PetscReal least = PETSC_MAX_REAL;
  int       best  = 0;

  for (int i = 0; i < pair->mesh->dim; i++) {
    PetscReal unit[3] = {i == 0, i == 1, i == 2}, turned[3], along = 0;

    MotionTurn(&pair->scene->motion, t, unit, turned);
    for (int d = 0; d < 3; d++) along += turned[d] * normal[d];
    if (PetscAbsReal(along) >= least) continue;
    least = PetscAbsReal(along);
    best  = i;
  }
  return best;
}

/* The components of an accepted traction or multiplier along the tangents of its term. New lists may have turned the
   normal a little: the traction turns with it and keeps its length. */
static void AcceptedComponents(const FrictionInput *in, const PetscReal traction[3], PetscReal component[2])
{
  PetscReal length = 0, left;

  FrictionComponents(in->normal, in->along, traction, component);
  left = PetscSqrtReal(PetscSqr(component[0]) + PetscSqr(component[1]));
  for (int d = 0; d < 3; d++) length += PetscSqr(traction[d]);
  for (int k = 0; k < 2 && left > 0; k++) component[k] *= PetscSqrtReal(length) / left;
}

/* Keeps what the accepted traction of a term says besides its present slip. */
static void KeepTraction(ContactPair *pair, PetscInt c, PetscReal t, FrictionInput *in)
{
  Friction  f = pair->friction;
  PetscReal traction[2], slip[2];

  if (!pair->master) {
    f->axis[c] = LeastAlong(pair, t, in->normal);
    Along(pair, pair->term_point[pair->term_ptr[c]], f->axis[c], t, in->along);
  }
  AcceptedComponents(in, &pair->accepted.traction[3 * c], traction);
  AcceptedComponents(in, &pair->accepted.grip[3 * c], &f->grip[2 * c]);
  FrictionComponents(in->normal, in->along, in->slip, slip);
  for (int k = 0; k < 2; k++) {
    f->kept[2 * c + k]    = (traction[k] - f->grip[2 * c + k]) / f->stiffness - slip[k];
    f->heading[2 * c + k] = pair->accepted.slips[c] ? traction[k] : 0;
  }
}

/* How far a term is open where its step begins, 0 where it is in contact. A term that only touches, after a body has
   been moved into contact for instance, is open if it is so now: whether rounding lets it touch depends on the number
   of ranks. */
static PetscReal TermOpening(const ContactPair *pair, PetscInt c, const LawState *state)
{
  const ContactState *accepted = &pair->accepted;
  const PetscReal     opening  = ContactTermGap(pair, pair->factor, pair->point_gap, c, NULL) - LawOnsetGap(state);
  const PetscReal     depth    = LawOnsetGap(state) - accepted->gap[c];
  const PetscBool     closed   = (PetscBool)(accepted->status[c] != CONTACT_OPEN && depth >= FRICTION_TOUCH * opening);

  return opening > 0 && !closed ? opening : 0;
}

/* Begins the step of a term. */
static PetscErrorCode BeginTerm(ContactPair *pair, PetscInt c, PetscReal t)
{
  Friction       f     = pair->friction;
  const LawState state = ContactTermState(pair, c, t, ContactTermMost(pair, c));
  FrictionInput  in    = {.stiffness = 0};

  PetscFunctionBeginUser;
  f->began[c] = 0;
  f->guide[c] = -1;
  f->guide[c] = FrictionTermGuide(pair, c);
  PetscCall(TermSlip(pair, c, t, &in, &f->anchored[c]));
  if (!f->anchored[c]) PetscFunctionReturn(PETSC_SUCCESS);
  f->began[c] = TermOpening(pair, c, &state);
  KeepTraction(pair, c, t, &in);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficient of friction at a term, and its slope over the pressure. */
static PetscReal TermCoefficient(const ContactPair *pair, PetscInt c, PetscReal t, PetscReal pressure, PetscReal *slope)
{
  const SceneContact *scene = pair->scene;
  PetscReal           X[3], mu = scene->mu;

  if (scene->mu_expression) {
    MeshNodePlace(pair->mesh, pair->node[c], X);
    mu = PetscMax(0, ExpressionValue(scene->mu_expression, X, t));
  }
  if (scene->mu_history.n) mu *= HistoryValue(&scene->mu_history, t);
  *slope = scene->mu_pressure.n ? mu * HistorySlope(&scene->mu_pressure, pressure) : 0;
  return scene->mu_pressure.n ? mu * HistoryValue(&scene->mu_pressure, pressure) : mu;
}

/* What a fluid carries of a term in the contact's place without being between the surfaces (force per area). */
static PetscReal TermFluid(const ContactPair *pair, PetscInt c)
{
  return pair->carried_dry ? pair->carried_dry[c] : 0;
}

/*@
  FrictionTermActs - says whether friction may act at a term: it presses, or is dry where a fluid's load lies.

  Not collective

  Input Parameters:
+ pair      - the pair, with friction
. c         - the term
- stiffness - its own across the surfaces (force per length and area); 0: it does not press
@*/
PetscBool FrictionTermActs(const ContactPair *pair, PetscInt c, PetscReal stiffness)
{
  return (PetscBool)(stiffness > 0 || TermFluid(pair, c) > 0);
}

/* Fills the law of a term but for its slip, at a pressure. */
static void TermMaterial(const ContactPair *pair, PetscInt c, PetscReal t, PetscReal pressure, FrictionInput *in)
{
  *in = (FrictionInput){.cohesion  = pair->scene->cohesion,
                        .limit     = pair->scene->tau_max,
                        .stiffness = pair->friction->stiffness,
                        .pressure  = pressure,
                        .fluid     = TermFluid(pair, c)};

  in->coefficient = TermCoefficient(pair, c, t, pressure + in->fluid, &in->steepness);
}

/* Sets the penalty of what sticks for the step: the automatic one with the factor of the state, or, where the scene
   names the elastic slip at which nodes begin to slip, one with which each of them can bear its bound at the accepted
   pressures, where the step begins and where it goes to: mu may follow the load. The tractions are state and no slips,
   so that the penalty may change from step to step. */
static PetscErrorCode SetStiffness(ContactPair *pair, PetscReal t, PetscReal t_next)
{
  const PetscReal slip = pair->scene->stick_slip;
  PetscReal       most = 0;

  PetscFunctionBeginUser;
  pair->friction->stiffness = pair->friction->automatic * pair->now.stick;
  if (slip == 0) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt c = 0; c < pair->n; c++) {
    LawValue  value;
    PetscReal area;

    ContactTermLaw(pair, c, t, &value, NULL, &area);
    if (!(value.pressure + TermFluid(pair, c) > 0)) continue;
    for (int end = 0; end < 2; end++) {
      FrictionInput in;

      TermMaterial(pair, c, end ? t_next : t, value.pressure, &in);
      most = PetscMax(most, FrictionBound(&in, value.pressure) / (slip * pair->size[c]));
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPIU_REAL, MPIU_MAX, pair->mesh->comm));
  pair->friction->stiffness = most > FRICTION_SLIGHT * pair->friction->automatic ? most : pair->friction->automatic;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionBegin - begins a step: anchors all slave points where they are in the accepted state.

  Collective

  Input Parameters:
+ pair   - the pair, projected with its lists at the accepted displacements
. t      - load parameter of the accepted state
- t_next - load parameter to which the step goes
@*/
PetscErrorCode FrictionBegin(ContactPair *pair, PetscReal t, PetscReal t_next)
{
  PetscFunctionBeginUser;
  PetscCall(SetStiffness(pair, t, t_next));
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) PetscCall(AnchorPoint(pair, q, t));
  for (PetscInt c = 0; c < pair->n; c++) PetscCall(BeginTerm(pair, c, t));
  FrictionTravelBegin(pair, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a term presses. */
static PetscBool TermPresses(const ContactPair *pair, PetscInt c, PetscReal t)
{
  LawValue  value;
  PetscReal area;

  ContactTermLaw(pair, c, t, &value, NULL, &area);
  return FrictionTermActs(pair, c, value.stiffness);
}

/* Finds anchors for the slave points of pressed terms that have none. Returns how many it has found. */
static PetscErrorCode FindLate(ContactPair *pair, PetscReal t, PetscInt late[], PetscInt *n)
{
  const Friction f = pair->friction;

  PetscFunctionBeginUser;
  *n = 0;
  for (PetscInt c = 0; c < pair->n; c++) {
    if (!TermPresses(pair, c, t)) continue;
    for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1]; k++) {
      const PetscInt q = pair->term_point[k];

      if (!FrictionTermTakes(pair, k) || f->face[q] >= 0) continue;
      PetscCall(AnchorFind(pair, q));
      if (f->face[q] >= 0) late[(*n)++] = q;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far a term was open over the place of its anchors when the step began, in the planes of contact at hand. */
static PetscReal LateOpening(const ContactPair *pair, PetscInt c, const FrictionInput *in)
{
  PetscReal opening = 0, area = 0;

  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && pair->master; k++) {
    const PetscInt q = pair->term_point[k];
    FrictionFrame  frame;
    PetscReal      v[3];

    if (!FrictionTermTakes(pair, k) || pair->friction->face[q] < 0) continue;
    FrictionAnchorFrame(pair, q, &frame);
    FrictionFrameCarry(&frame, &pair->friction->off[3 * q], v);
    area += pair->term_weight[k] * pair->factor[q];
    for (int d = 0; d < 3; d++) opening += pair->term_weight[k] * pair->factor[q] * v[d] * in->normal[d];
  }
  return area > 0 ? PetscMax(0, opening / area) : 0;
}

/* Begins the step of terms that press and have anchors only now. *made: there are such terms. */
static PetscErrorCode BeginLate(ContactPair *pair, PetscReal t, PetscBool *made)
{
  const Friction f = pair->friction;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n; c++) { /* terms share points */
    FrictionInput in = {.stiffness = 0};

    if (f->anchored[c] || !TermPresses(pair, c, t)) continue;
    f->guide[c] = FrictionTermGuide(pair, c);
    PetscCall(TermSlip(pair, c, t, &in, &f->anchored[c]));
    if (!f->anchored[c]) continue;
    f->began[c] = LateOpening(pair, c, &in);
    for (int d = 0; d < 3; d++) in.slip[d] = 0; /* the slip since the step began counts */
    KeepTraction(pair, c, t, &in);
    *made = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionAnchorLate - anchors slave points of pressed terms that had no master near when the step began.

  Collective

  Input Parameters:
+ pair    - the pair, projected at u and t
. u       - local displacements (length), ghosts included
. t       - load parameter
. u_begun - local displacements at which the step began (length)
- t_begun - its load parameter

  Output Parameter:
. made - there are such points on this rank; the step must be solved on

  Note:
  They are anchored at the place of the master where they are now, and slip from where they were over it when the step
  began, as the points do that had a master near. So their friction does not depend on the iterate that finds them.
@*/
PetscErrorCode FrictionAnchorLate(ContactPair *pair, const PetscReal *u, PetscReal t, const PetscReal *u_begun,
                                  PetscReal t_begun, PetscBool *made)
{
  PetscInt *late, n, any;
  PetscBool moved;

  PetscFunctionBeginUser;
  *made = PETSC_FALSE;
  PetscCall(PetscMalloc1(pair->lists->n_slaves, &late));
  PetscCall(FindLate(pair, t, late, &n));
  PetscCallMPI(MPI_Allreduce(&n, &any, 1, MPIU_INT, MPI_MAX, pair->mesh->comm));
  if (any) {
    PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u_begun, t_begun, &moved));
    for (PetscInt i = 0; i < n; i++) AnchorTake(pair, late[i], t_begun);
    PetscCall(NeighbourListsUpdate(pair->search, pair->lists, u, t, &moved));
  }
  PetscCall(PetscFree(late));
  *made = (PetscBool)(n > 0);
  PetscCall(BeginLate(pair, t, made));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Evaluates the law of a term. In a linear step what sticks goes on sticking and what slips goes on slipping, as what
   is in contact stays so. A term that only touches sticks, because it may be what holds a body; it presses nothing, and
   the law would take it for one that has not touched yet. One that new lists have opened is expected to press as it
   did when the step began. */
static void TermEvaluate(const ContactPair *pair, PetscInt c, PetscReal area, FrictionInput *in, FrictionTraction *out)
{
  in->state = FRICTION_DECIDES;
  if (pair->holding) in->state = pair->now.slips[c] ? FRICTION_SLIPS : FRICTION_STICKS;
  if (pair->holding) in->expected = area > 0 ? pair->friction->pressed[c] / area : 0;
  if (pair->holding && !(in->pressure > 0)) in->began = 0;
  FrictionEvaluate(in, out);
}

/* What the law is to be asked of a term that need not be in contact. *found: it has anchors. */
PetscErrorCode FrictionTermAsk(const ContactPair *pair, PetscInt c, PetscReal t, FrictionInput *in, PetscBool *found)
{
  const Friction f = pair->friction;
  LawValue       value;
  PetscReal      area;

  PetscFunctionBeginUser;
  *found = f->anchored[c];
  if (!*found) PetscFunctionReturn(PETSC_SUCCESS);
  ContactTermLaw(pair, c, t, &value, NULL, &area);
  TermMaterial(pair, c, t, value.pressure, in);
  for (int k = 0; k < 2; k++) {
    in->kept[k] = f->kept[2 * c + k];
    in->grip[k] = f->grip[2 * c + k];
  }
  in->rate  = value.stiffness;
  in->began = f->began[c];
  PetscCall(TermSlip(pair, c, t, in, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionTerm - evaluates friction at a term.

  Not collective

  Input Parameters:
+ pair - the pair, projected, after FrictionBegin()
. c    - the term
- t    - load parameter

  Output Parameters:
+ in   - what the law was asked
. out  - what it says
- acts - PETSC_FALSE: there is no friction at the term, and the other two are not set
@*/
PetscErrorCode FrictionTerm(const ContactPair *pair, PetscInt c, PetscReal t, FrictionInput *in, FrictionTraction *out,
                            PetscBool *acts)
{
  LawValue  value;
  PetscReal area;

  PetscFunctionBeginUser;
  ContactTermLaw(pair, c, t, &value, NULL, &area);
  *acts = FrictionTermActs(pair, c, value.stiffness);
  if (*acts) PetscCall(FrictionTermAsk(pair, c, t, in, acts));
  if (*acts) TermEvaluate(pair, c, area, in, out);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds a force F on slave point q, its reaction on the master and its lever's to the values of the contact nodes. */
PetscErrorCode FrictionPointForces(const ContactPair *pair, PetscInt q, const PetscReal F[3], PetscReal *values)
{
  const int           dim = pair->mesh->dim;
  const PetscReal    *S, *slope;
  const PetscInt     *node;
  const PetscInt      n = FrictionOwnNodes(pair, q, &node, &S);
  PetscInt            n_lever;
  const FrictionFoot *foot;
  PetscBool           found;

  PetscFunctionBeginUser;
  if (F[0] == 0 && F[1] == 0 && F[2] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FrictionPointFoot(pair, q, &foot, &found));
  if (pair->master && !found) PetscFunctionReturn(PETSC_SUCCESS); /* what has no reaction is no force */
  for (PetscInt a = 0; a < n; a++)
    for (int d = 0; d < dim; d++) values[node[a] * dim + d] += S[a] * F[d];
  if (!found) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < foot->nodes; k++) {
    PetscReal sign[3];
    PetscInt  at;

    FrictionNodeSign(pair, FrictionFootPoint(pair, q, k), &at, sign);
    for (int d = 0; d < dim; d++) values[at * dim + d] -= sign[d] * foot->N[k] * F[d];
  }
  n_lever = FrictionLeverNodes(pair, q, &node, &slope);
  for (PetscInt k = 0; k < n_lever; k++) {
    PetscReal force[3][3];

    FrictionLeverForces(&pair->friction->lever[q], foot, &slope[2 * k], force);
    for (int d = 0; d < dim; d++)
      values[node[k] * dim + d] += force[d][0] * F[0] + force[d][1] * F[1] + force[d][2] * F[2];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the moment about the origin of the force on the master at the foot of slave point q, which is -F on the slave:
   the force on the slave's face and its lever have the same moment with the other sign. */
static PetscErrorCode AddMoment(const ContactPair *pair, PetscInt q, const PetscReal F[3], PetscReal moment[3])
{
  const FrictionFoot *foot;
  PetscReal           x[3], u[3], part[3];
  PetscBool           found;

  PetscFunctionBeginUser;
  if (F[0] == 0 && F[1] == 0 && F[2] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FrictionPointFoot(pair, q, &foot, &found));
  if (pair->master && !found) PetscFunctionReturn(PETSC_SUCCESS);
  PlainPlace(pair, q, x, u);
  for (int d = 0; d < pair->mesh->dim; d++)
    x[d] += u[d] + pair->mesh->centre[d] - (found ? foot->distance * foot->normal[d] : 0);
  Cross(x, F, part);
  for (int d = 0; d < 3; d++) moment[d] += part[d];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FrictionNodalForces - adds up the forces of friction on slave nodes.

  Collective

  Input Parameters:
+ pair  - the pair
- force - 3 for each slave point

  Output Parameter:
. on_node - 3 for each term

  Note:
  Where terms share their points, the hat functions distribute the points' forces, also to terms of other ranks.
@*/
PetscErrorCode FrictionNodalForces(const ContactPair *pair, const PetscReal *force, PetscReal *on_node)
{
  const int            dim   = pair->mesh->dim;
  const NeighbourLists lists = pair->lists;
  PetscReal           *values, *nodal;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(lists->n_nodes * dim, &values, pair->mesh->n_nodes * dim, &nodal));
  for (PetscInt i = 0; i < lists->n_near; i++) {
    const PetscInt q = lists->near[i];

    for (PetscInt k = pair->slaves->ptr[q], node = lists->slave_ptr[q]; k < pair->slaves->ptr[q + 1]; k++, node++)
      for (int d = 0; d < dim; d++)
        values[lists->slave_node[node] * dim + d] -= pair->slaves->hat[k] * force[3 * q + d];
  }
  PetscCall(NeighbourListsReduce(lists, values, nodal));
  for (PetscInt c = 0; c < pair->n_nodes; c++)
    for (int d = 0; d < dim; d++) on_node[3 * c + d] = nodal[pair->node[c] * dim + d];
  PetscCall(PetscFree2(values, nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether a term slips in another direction than when the step began. In the plane it can only slip to and fro,
   which a step follows. */
static PetscBool HasTurned(const ContactPair *pair, PetscInt c, const FrictionInput *in, const FrictionTraction *out)
{
  const PetscReal *before = &pair->friction->heading[2 * c];
  PetscReal        now[2], product, lengths;

  if (pair->mesh->dim < 3 || out->state != FRICTION_SLIPS) return PETSC_FALSE;
  FrictionComponents(in->normal, in->along, out->traction, now);
  product = before[0] * now[0] + before[1] * now[1];
  lengths =
    PetscSqrtReal(PetscSqr(before[0]) + PetscSqr(before[1])) * PetscSqrtReal(PetscSqr(now[0]) + PetscSqr(now[1]));
  return (PetscBool)(lengths > 0 && product < FRICTION_TURN * lengths);
}

/* Says whether a pressed term has a slave point from which no line along its normal meets the master, or that was never
   anchored: friction is less there than it should be. */
static PetscErrorCode TermLacksFeet(const ContactPair *pair, PetscInt c, PetscReal t, PetscBool *lacks)
{
  PetscFunctionBeginUser;
  *lacks = PETSC_FALSE;
  if (!TermPresses(pair, c, t)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = pair->term_ptr[c]; k < pair->term_ptr[c + 1] && !*lacks; k++) {
    const PetscInt      q = pair->term_point[k];
    const FrictionFoot *foot;
    PetscBool           found = PETSC_TRUE;

    if (!FrictionTermTakes(pair, k)) continue;
    if (pair->master) PetscCall(FrictionPointFoot(pair, q, &foot, &found));
    *lacks = (PetscBool)(!found || pair->friction->face[q] < 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The multiplier of a term at the last projection (force per area). in: of FrictionTermAsk(); NULL: no friction acts.
 */
static void TermGrip(const ContactPair *pair, const FrictionInput *in, PetscReal grip[3])
{
  static const PetscReal unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  PetscReal              part[2];

  for (int d = 0; d < 3; d++) grip[d] = 0;
  if (!in || !pair->scene->augment) return;
  for (int d = 0; d < 3; d++) {
    FrictionComponents(in->normal, in->along, unit[d], part);
    for (int k = 0; k < 2; k++) grip[d] += in->grip[k] * part[k];
  }
}

/*@
  FrictionResidual - computes the tractions of a pair, which become its present state, and adds their forces.

  Not collective

  Input Parameters:
+ pair - the pair, projected
- t    - load parameter

  Input/Output Parameter:
. values - forces over the contact nodes, subtracted as external ones are
@*/
PetscErrorCode FrictionResidual(ContactPair *pair, PetscReal t, PetscReal *values)
{
  ContactState *now = &pair->now, *accepted = &pair->accepted;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(pair->friction->force, 3 * pair->lists->n_slaves));
  PetscCall(PetscArrayzero(pair->friction->moment, 3));
  now->dissipated = accepted->dissipated;
  now->turned     = accepted->turned;
  for (PetscInt c = 0; c < pair->n; c++) {
    FrictionInput    in;
    FrictionTraction out  = {.state = FRICTION_STICKS};
    PetscReal        area = 0, energy;
    PetscBool        acts, leaves;

    PetscCall(FrictionTerm(pair, c, t, &in, &out, &acts));
    PetscCall(TermLacksFeet(pair, c, t, &pair->friction->footless[c]));
    for (PetscInt k = pair->term_ptr[c]; acts && k < pair->term_ptr[c + 1]; k++) {
      const PetscInt  q      = pair->term_point[k];
      const PetscReal weight = pair->term_weight[k] * pair->factor[q];

      if (!FrictionTermTakes(pair, k)) continue;
      area += weight;
      for (int d = 0; d < 3; d++) pair->friction->force[3 * q + d] += weight * out.traction[d];
    }
    for (int d = 0; d < 3; d++) now->traction[3 * c + d] = acts ? out.traction[d] : 0;
    TermGrip(pair, acts ? &in : NULL, &now->grip[3 * c]);
    pair->friction->elastic[c] = acts ? out.elastic : 0;
    now->slips[c]              = (PetscBool)(acts && out.state == FRICTION_SLIPS);
    now->slid[c]               = accepted->slid[c] + (acts ? out.slipped : 0);
    leaves                     = (PetscBool)(!acts && FrictionTermLeaves(pair, c));
    if (leaves) PetscCall(FrictionTermAsk(pair, c, t, &in, &leaves));
    energy = acts || leaves ? FrictionTermEnergy(pair, c, &in, acts ? &out : NULL, area) : 0;
    now->dissipated += energy;
    if (acts && HasTurned(pair, c, &in, &out)) now->turned += energy;
  }
  for (PetscInt q = 0; q < pair->lists->n_slaves; q++) {
    const PetscReal *F = &pair->friction->force[3 * q];

    for (int d = 0; d < pair->mesh->dim; d++) pair->total[d] -= F[d];
    PetscCall(FrictionPointForces(pair, q, F, values));
    PetscCall(AddMoment(pair, q, F, pair->friction->moment));
  }
  PetscCall(FrictionNodalForces(pair, pair->friction->force, pair->friction->nodal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills what slave nodes show of friction. area: present tributary areas of the mesh's nodes. */
PetscErrorCode FrictionShow(const ContactPair *pair, const PetscReal *area, ContactNodes *nodes)
{
  const Friction f = pair->friction;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < pair->n_nodes; c++) {
    const PetscInt term = ContactNodeTerm(pair, &pair->now, c);

    for (int d = 0; d < 3; d++) f->traction[3 * c + d] = f->nodal[3 * c + d] / area[pair->node[c]];
    f->status[c] = pair->now.status[term] == CONTACT_OPEN ? 0 : pair->now.slips[term] ? 2 : 1;
  }
  nodes->traction = f->traction;
  nodes->slid     = pair->now.slid;
  nodes->friction = f->status;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairFriction - says what friction does in a pair in the present state.

  Collective

  Input Parameters:
+ contact - the contact
- p       - number of the pair

  Output Parameter:
. friction - the same on all ranks; zeros without friction
@*/
PetscErrorCode ContactPairFriction(Contact contact, int p, ContactFriction *friction)
{
  const ContactPair *pair    = &contact->pairs[p];
  const Friction     f       = pair->friction;
  PetscReal          sum[13] = {0}, most[2] = {0};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; f && c < pair->n; c++) {
    for (int d = 0; d < 3; d++) sum[d] += f->nodal[3 * c + d];
    if (pair->now.status[c] == CONTACT_OPEN) continue;
    sum[pair->now.slips[c] ? 4 : 3]++;
    sum[12] += f->footless[c];
    sum[pair->now.slips[c] ? 5 : 7] += pair->area[c];
    most[0] = PetscMax(most[0], f->elastic[c]);
    most[1] = PetscMax(most[1], pair->now.slid[c]);
  }
  sum[6] = pair->now.dissipated;
  sum[8] = pair->now.turned;
  for (int d = 0; f && d < 3; d++) sum[9 + d] = f->moment[d];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 13, MPIU_REAL, MPIU_SUM, contact->mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPIU_MAX, contact->mesh->comm));
  *friction = (ContactFriction){.force         = {sum[0], sum[1], sum[2]},
                                .moment        = {sum[9], sum[10], sum[11]},
                                .sticking      = (PetscInt)sum[3],
                                .slipping      = (PetscInt)sum[4],
                                .footless      = (PetscInt)sum[12],
                                .slipped_area  = sum[5],
                                .dissipated    = sum[6],
                                .sticking_area = sum[7],
                                .turned        = sum[8],
                                .travel        = pair->now.travel,
                                .elastic       = most[0],
                                .slid          = most[1]};
  PetscFunctionReturn(PETSC_SUCCESS);
}
