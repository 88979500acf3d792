/* Pairs: surfaces, terms, slave points, offsets and search of each, and what the scene says of it. */
#include "contactimpl.h"
#include "search/surfaceends.h"
#include "search/nodegeometry.h"
#include "search/ridgepoints.h"
#include "search/toolside.h"
#include "penaltyrule.h"
#include "base/refusal.h"

/* Slave nodes whose tributary area is below this share of the faces around them carry no force. These are the corners
   of 6-node triangles and the axis node of second-order axisymmetric edges. Their areas are zero on flat faces, and
   small and of either sign on curved ones. Corners of 9-node faces have 1/36, all others have more. */
#define CONTACT_SHARE_FLOOR 5e-3

/* A surface that turns by more than this angle from its one reference plane cannot be written over that plane: cosine
   of 60 degrees. */
#define CONTACT_GLOBAL_COSINE 0.5

/* In surface to surface, a slave whose faces are at least this many times coarser than the master's takes a finer
   quadrature, as its points would skip facets. The figure is below 2, so that round-off does not decide on a mesh of
   half the size. */
#define CONTACT_COARSE 1.9

/* In surface to surface, a node with less than this share of the mean hat area has no term. This is an axis node,
   where the radius vanishes. */
#define CONTACT_HAT_FLOOR 1e-8

/* Mean heights of the elements below the faces around the nodes of the slave (length), by local node. */
static PetscErrorCode NodeHeights(Mesh mesh, ContactSurface slave, PetscReal *height)
{
  PetscReal *faces;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes, &faces));
  PetscCall(PetscArrayzero(height, mesh->n_nodes));
  for (PetscInt f = 0; f < slave->n_faces; f++) {
    for (int a = 0; a < ElementGet(slave->faces[f].type)->nodes; a++) {
      height[slave->faces[f].nodes[a]] += slave->face_height[f];
      faces[slave->faces[f].nodes[a]]++;
    }
  }
  PetscCall(MeshSumNodes(mesh, 1, height));
  PetscCall(MeshSumNodes(mesh, 1, faces));
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (faces[i] > 0) height[i] /= faces[i];
  PetscCall(PetscFree(faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Friction against a master with faces needs levers. */
static PetscBool HasLevers(const ContactPair *pair)
{
  return (PetscBool)(pair->scene->friction && pair->master);
}

/* Makes slave points that are the nodes of the terms. */
static PetscErrorCode PairCreateNodePoints(Mesh mesh, ContactPair *pair)
{
  PetscReal *of_nodes, *height;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &of_nodes, pair->n, &height));
  PetscCall(NodeHeights(mesh, pair->slave, of_nodes));
  for (PetscInt c = 0; c < pair->n; c++) height[c] = of_nodes[pair->node[c]];
  PetscCall(
    SlavePointsCreateNodes(pair->slave, pair->n, pair->node, pair->size, height, HasLevers(pair), &pair->slaves));
  PetscCall(PetscFree2(of_nodes, height));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Have slave and master faces of one body, or of bodies that share nodes? */
static PetscErrorCode PairIsOneBody(Mesh mesh, Scene scene, const ContactPair *pair, PetscBool *one)
{
  const ContactSurface side[] = {pair->slave, pair->master};
  int                 *has;

  PetscFunctionBeginUser;
  PetscCall(MeshGroupsMeet(mesh, side[0]->group, side[1]->group, one));
  PetscCall(PetscCalloc1(2 * scene->n_bodies, &has));
  for (int i = 0; i < 2; i++)
    for (PetscInt f = 0; side[i]->group && f < side[i]->n_faces; f++)
      has[i * scene->n_bodies + mesh->cell_body[side[i]->group->face_cell[f]]] = 1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, has, 2 * scene->n_bodies, MPI_INT, MPI_LOR, mesh->comm));
  for (int b = 0; b < scene->n_bodies; b++) *one = (PetscBool)(*one || (has[b] && has[scene->n_bodies + b]));
  PetscCall(PetscFree(has));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has each point on the edges of a tool carry a term. */
static PetscErrorCode PairChooseRidge(ContactPair *pair)
{
  const SlavePoints slaves = pair->slaves;

  PetscFunctionBeginUser;
  pair->n = pair->n_nodes = pair->n_sides = slaves->n;
  PetscCall(PetscMalloc4(pair->n, &pair->node, pair->n, &pair->area, pair->n, &pair->size, pair->n, &pair->turn));
  for (PetscInt c = 0; c < pair->n; c++) {
    pair->node[c] = slaves->nodes[c].id;
    pair->area[c] = pair->slave->ridge.point[pair->node[c]].area;
    pair->size[c] = slaves->size[c];
    pair->turn[c] = 0;
  }
  PetscCall(ContactEdgesBelow(pair));
  PetscCall(ContactCornersAdd(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has each node of this rank on a sharp edge of the slave carry a term. length[nodes of the mesh]: of these edges. */
static PetscErrorCode PairChooseEdges(Mesh mesh, const PetscReal *length, ContactPair *pair)
{
  const MeshGroup *group = pair->slave->group;
  PetscMPIInt      rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc4(group->n_nodes, &pair->node, group->n_nodes, &pair->area, group->n_nodes, &pair->size,
                         group->n_nodes, &pair->turn));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    const PetscInt node = group->nodes[i];

    if (mesh->node_owner[node] != rank || !(length[node] > 0)) continue;
    pair->node[pair->n] = node;
    pair->area[pair->n] = length[node] * pair->master->mean_size;
    pair->size[pair->n] = pair->master->mean_size;
    pair->turn[pair->n] = 0;
    pair->n++;
  }
  pair->n_nodes = pair->n_sides = pair->n;
  PetscCall(ContactEdgesBelow(pair));
  PetscCall(ContactCornersAdd(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chooses the slave nodes that carry a term: those with area that this rank owns. Faces with terms follow. */
static PetscErrorCode PairChooseNodes(Mesh mesh, Scene scene, ContactPair *pair)
{
  const MeshGroup *group = pair->slave->group;
  const PetscBool  hats  = pair->formulation.surface;
  const PetscInt   faces = pair->slaves ? pair->slaves->n_faces : 0,
                 room = group->n_nodes + (1 + 3 * FACE_MAX_NODES) * faces; /* for terms of sides, ends and faces, too */
  PetscReal  *area, *size, *turn, *share, sum[2] = {0, 0};
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc4(mesh->n_nodes, &area, mesh->n_nodes, &size, mesh->n_nodes, &turn, mesh->n_nodes, &share));
  PetscCall(SurfaceNodeSizes(pair->slave, scene->geometry, pair->n_images, pair->images, size, turn, share));
  if (hats)
    PetscCall(SlavePointsHatAreas(pair->slaves, scene->geometry, NULL, area));
  else
    PetscCall(SurfaceNodeAreas(pair->slave, scene->geometry, NULL, area));
  PetscCall(PetscMalloc4(room, &pair->node, room, &pair->area, room, &pair->size, room, &pair->turn));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    if (mesh->node_owner[group->nodes[i]] != rank) continue;
    sum[0] += area[group->nodes[i]];
    sum[1] += 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, mesh->comm));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    const PetscInt node = group->nodes[i];

    if (mesh->node_owner[node] != rank ||
        (hats ? area[node] < CONTACT_HAT_FLOOR * sum[0] / sum[1] : share[node] < CONTACT_SHARE_FLOOR))
      continue;
    pair->node[pair->n] = node;
    pair->area[pair->n] = pair->scene->share * area[node];
    pair->size[pair->n] = size[node];
    pair->turn[pair->n] = turn[node];
    pair->n++;
  }
  pair->n_nodes = pair->n;
  PetscCall(ContactCornersAdd(pair));
  pair->n_sides = pair->n;
  if (pair->formulation.faces) PetscCall(ContactFacesAdd(pair, turn));
  PetscCall(PetscFree4(area, size, turn, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the slave points of each term with their areas in it, w_q psi_c(xi_q), and makes room for what terms and
   points hold. */
static PetscErrorCode PairCreateTerms(Mesh mesh, ContactPair *pair)
{
  SlavePoints     slaves = pair->slaves;
  const PetscReal share  = ContactFacesShare(pair);
  PetscInt       *term, *of, n = 0; /* of: term of each node of each point */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(slaves->n_nodes, &term)); /* of each node that the points are made of; -1: none */
  for (PetscInt i = 0; i < slaves->n_nodes; i++) term[i] = -1;
  for (PetscInt c = 0; c < pair->n_nodes; c++)
    term[NodeKeysFind(slaves->n_nodes, slaves->nodes, ContactTermId(pair, c))] = c;
  PetscCall(PetscMalloc1(slaves->ptr[slaves->n], &of));
  for (PetscInt k = 0; k < slaves->ptr[slaves->n]; k++) of[k] = slaves->hat[k] == 0 ? -1 : term[slaves->node[k]];
  PetscCall(PetscFree(term));
  ContactCornersTake(pair, of);
  PetscCall(PetscCalloc1(pair->n + 2, &pair->term_ptr));
  for (PetscInt k = 0; k < slaves->ptr[slaves->n]; k++) {
    if (of[k] < 0) continue;
    pair->term_ptr[of[k] + 2]++;
    n++;
  }
  for (PetscInt k = 0; pair->at_end && k < slaves->ptr[slaves->n]; k++) {
    if (pair->at_end[k] < 0) continue;
    pair->term_ptr[pair->at_end[k] + 2]++;
    n++;
  }
  for (PetscInt c = pair->n_sides; c < pair->n; c++) {
    const PetscInt f = pair->face[c - pair->n_sides];

    pair->term_ptr[c + 2] = slaves->first[f + 1] - slaves->first[f];
    n += pair->term_ptr[c + 2];
  }
  PetscCall(PetscMalloc2(n, &pair->term_point, n, &pair->term_weight));
  for (PetscInt c = 0; c <= pair->n; c++) pair->term_ptr[c + 1] += pair->term_ptr[c];
  for (PetscInt q = 0; q < slaves->n; q++) {
    for (PetscInt k = slaves->ptr[q]; k < slaves->ptr[q + 1]; k++) {
      const PetscInt c = of[k];
      PetscInt       at;

      if (c < 0) continue;
      at                   = pair->term_ptr[c + 1]++; /* after the loop it is the start of the next term */
      pair->term_point[at] = q;
      pair->term_weight[at] =
        pair->formulation.surface ? share * pair->scene->share * slaves->weight[q] * slaves->hat[k] : pair->area[c];
    }
  }
  ContactEndsPoints(pair);
  ContactFacesPoints(pair);
  PetscCall(PetscFree(of));
  PetscCall(PetscCalloc5(pair->n, &pair->force, 3 * pair->n, &pair->normal, pair->n, &pair->pressure, pair->n,
                         &pair->stiffness, pair->n, &pair->stiffness_before));
  PetscCall(PetscCalloc2(pair->n_nodes, &pair->shown_gap, 3 * pair->n_nodes, &pair->shown_normal));
  PetscCall(PetscCalloc6(slaves->n, &pair->factor, slaves->n, &pair->next_factor, slaves->n, &pair->seed, slaves->n,
                         &pair->point_gap, 3 * slaves->n, &pair->point_normal, slaves->n, &pair->point_force));
  PetscCall(PetscCalloc4(slaves->n, &pair->factor_before, slaves->n, &pair->factor_change, slaves->n, &pair->factor_low,
                         slaves->n, &pair->factor_high));
  PetscCall(PetscCalloc2(slaves->n, &pair->first_rung, slaves->n, &pair->fallen));
  PetscCall(
    PetscCalloc3(3 * slaves->n, &pair->frame_before, 3 * slaves->n, &pair->frame_kept, slaves->n, &pair->turned_back));
  PetscCall(ContactVariationsCreate(mesh->dim, slaves->n, &pair->variations));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How fine the slave's quadrature is. Axisymmetric slaves have a finer rule, as the radius is one more factor. Nodes
   next to the axis have so little area that what the rule misses of their forces shows twice in their pressures. What
   it misses does not fall with the mesh, so pairs that meet the axis have the finest rule. */
static int PairRule(Scene scene, const ContactPair *pair)
{
  PetscBool at_axis = PETSC_FALSE;

  if (!pair->master) return FACE_RULE_PLAIN;
  for (int i = 0; i < pair->n_images; i++) at_axis = (PetscBool)(at_axis || SurfaceImageBeyondAxis(&pair->images[i]));
  if (scene->geometry == GEOMETRY_AXISYMMETRIC) return at_axis ? FACE_RULE_FINEST : FACE_RULE_FINER;
  /* With friction too: half as many points leave twice the noise in tractions that stick. In space the order above it
     leaves two thirds of the rest: on jittered bricks at most 3.0 % instead of 4.2 %. */
  if (pair->scene->friction) return scene->geometry == GEOMETRY_SOLID ? FACE_RULE_FINEST : FACE_RULE_FINER;
  return pair->slave->mean_size >= CONTACT_COARSE * pair->master->mean_size ? FACE_RULE_FINER : FACE_RULE_PLAIN;
}

/* Creates slave points, terms and offsets, as the formulation asks for. */
static PetscErrorCode PairCreatePoints(Mesh mesh, Scene scene, Loads loads, ContactPair *pair)
{
  const int finer = PairRule(scene, pair);

  PetscFunctionBeginUser;
  if (ContactOnTool(pair)) {
    PetscCall(SlavePointsCreateRidge(pair->slave, loads, &pair->slaves));
    PetscCall(PairChooseRidge(pair));
  } else if (ContactIsRidge(pair)) {
    PetscCall(PairChooseEdges(mesh, pair->edge_length, pair));
    PetscCall(PairCreateNodePoints(mesh, pair));
  } else if (pair->formulation.surface) {
    PetscCall(ContactEndsFind(pair, scene));
    PetscCall(SlavePointsCreateQuadrature(pair->slave, scene->geometry, finer, HasLevers(pair), &pair->slaves));
    PetscCall(PairChooseNodes(mesh, scene, pair));
    PetscCall(OffsetsCreate(mesh, scene, loads, pair->slave, pair->n_images, pair->images, pair->fit.feature_angle,
                            finer, pair->formulation.offsets, &pair->slave_offsets));
    if (pair->master)
      PetscCall(OffsetsCreate(mesh, scene, loads, pair->master, pair->n_images, pair->images, pair->fit.feature_angle,
                              0, pair->formulation.offsets, &pair->master_offsets));
  } else {
    PetscCall(PairChooseNodes(mesh, scene, pair));
    PetscCall(PairCreateNodePoints(mesh, pair));
  }
  PetscCall(PairCreateTerms(mesh, pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Settings of the fit. Where the scene leaves support and exponent of the weight open, they follow from dimension and
   degree. With nodes as fit points the support is in spacings, and the figures give the smoothest fits whose guards
   hold on jittered meshes (3D: some 40 nodes, 2D: 9 nodes). In 3D, values between 3.5 and 3.65 suit 3 rings of nodes,
   4 rings, and spheres with three-valent nodes at the same time. With quadrature points the support is in face sizes,
   and holds some 113 of them in 3D. */
static FitSettings PairFitSettings(Scene scene, const ContactPair *pair, int order)
{
  const SceneContact *contact = pair->scene;
  FitSettings         fit     = {.degree = contact->degree, .support = contact->support, .exponent = contact->weight};

  fit.fitted   = (PetscBool)(pair->smoother->fitted && contact->master);
  fit.integral = (PetscBool)(fit.fitted && pair->formulation.surface);
  fit.revolved = (PetscBool)(fit.integral && scene->geometry == GEOMETRY_AXISYMMETRIC);
  if (fit.integral) {
    if (fit.support == 0) fit.support = order == 1 ? 3 : fit.revolved ? 2 : scene->dim == 2 ? 1.75 : 2.25;
    if (fit.exponent == 0) fit.exponent = 3;
    fit.support *= order; /* spacings in a face size */
  }
  if (fit.support == 0) fit.support = fit.degree < 4 ? 3.5 : scene->dim == 2 ? 4.5 : 3.6;
  if (fit.exponent == 0) fit.exponent = scene->dim == 3 && fit.degree == 4 ? 3.5 : 6;
  fit.derivatives   = contact->diffuse_derivatives ? FIT_DIFFUSE : FIT_FULL;
  fit.global_frame  = contact->global_frame ? PETSC_TRUE : PETSC_FALSE;
  fit.feature_angle = SceneSharpAngle(contact);
  fit.far           = (PetscBool)(contact->initial_overlap == OVERLAP_ADD);
  return fit;
}

/* Fills what the formulation means. This is the one place that asks the scene for it. */
static void PairSetFormulation(Scene scene, int order, ContactPair *pair)
{
  pair->formulation.surface = (PetscBool)(pair->scene->formulation == CONTACT_SURFACE_TO_SURFACE);
  pair->formulation.faces   = ContactFacesServe(pair, scene, order);
  pair->formulation.offsets = !pair->smoother->fitted    ? OFFSETS_NONE
                              : pair->scene->live_offset ? OFFSETS_LIVE
                                                         : OFFSETS_HELD;
  pair->formulation.lags    = (PetscBool)(pair->formulation.surface && pair->formulation.offsets != OFFSETS_LIVE);
}

/* Refuses one reference plane for a master that turns too far from it. */
static PetscErrorCode PairCheckGlobalFrame(Mesh mesh, Scene scene, Loads loads, const ContactPair *pair)
{
  PetscReal normal[3], cosine, *zero;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &zero));
  PetscCall(SurfaceMeanNormal(pair->master, loads, pair->n_images, pair->images, zero, 0, normal, &cosine));
  PetscCall(PetscFree(zero));
  if (cosine < CONTACT_GLOBAL_COSINE) {
    PetscCall(RefuseInput(mesh->comm,
                          "%s: the surface '%s' turns by %.0f degrees from its one reference plane; allowed: up to 60 "
                          "degrees (frame: local has one plane for each slave point)",
                          SceneWhere(scene, pair->scene->path, "frame"), pair->scene->master,
                          (double)(PetscAcosReal(PetscMax(-1, cosine)) * 180 / PETSC_PI)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Turns the normals of a meshed rigid master as the scene says. */
static PetscErrorCode PairTurnMaster(Scene scene, Loads loads, const ContactPair *pair)
{
  const SceneContact *contact = pair->scene;
  PetscBool           decided = PETSC_TRUE;

  PetscFunctionBeginUser;
  if (!pair->master || !pair->master->rigid) {
    if (contact->master_normal == MASTER_NORMAL_FLIP)
      PetscCall(RefuseInput(pair->mesh->comm,
                            "%s: is flip, but the master is %s; allowed: flip where the master is a meshed rigid tool",
                            SceneWhere(scene, contact->path, "master_normal"),
                            pair->master ? "a surface of a body, whose normals point out of it"
                                         : "an analytic surface, whose own keys say where its outside is"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (contact->master_normal == MASTER_NORMAL_FLIP) {
    ToolSideFlip(pair->master);
    pair->master->turned = pair->master->n_faces;
  }
  if (contact->master_normal == MASTER_NORMAL_AUTO)
    PetscCall(ToolSideFind(pair->master, pair->slave, loads, &pair->master->turned, &decided));
  if (!decided)
    PetscCall(RefuseInput(pair->mesh->comm,
                          "%s: contact '%s': the start of '%s' does not show on which side of the rigid '%s' it is; "
                          "allowed: master_normal: keep (the side to which the normals of the mesh point) or flip (the "
                          "other one), or a start on one side",
                          SceneWhere(scene, contact->path, "master"), contact->name, contact->slave, contact->master));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the images as which the surfaces of the pair go on at their corners and ends, on which no fit depends. */
static PetscErrorCode PairMirrors(Mesh mesh, Scene scene, ContactPair *pair)
{
  PetscFunctionBeginUser;
  pair->n_mirrors = pair->n_images;
  PetscCall(PetscArraycpy(pair->mirrors, pair->images, SURFACE_MAX_IMAGES));
  if (pair->scene->find_symmetry)
    PetscCall(
      SurfaceImagesFromSupports(mesh, scene, pair->slave, pair->master, PETSC_FALSE, &pair->n_mirrors, pair->mirrors));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the mixing of a pair's multipliers: pressures, and two components of each traction. */
static PetscErrorCode PairCreateMixing(ContactPair *pair)
{
  const PetscInt n = pair->n, all = pair->friction ? 3 * n : n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(all, &pair->weight));
  for (PetscInt i = 0; i < all; i++) pair->weight[i] = pair->area[i < n ? i : (i - n) / 2];
  PetscCall(AndersonCreate(pair->mesh->comm, all, pair->weight, &pair->mixing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Creates points, terms, state and search of a pair, whose surfaces and images are known. */
static PetscErrorCode PairComplete(Mesh mesh, Scene scene, Loads loads, ContactPair *pair)
{
  const SceneContact  *contact    = pair->scene;
  const ContactSurface deformable = ContactOnTool(pair) ? pair->master : pair->slave;
  const PetscBool      friction   = (PetscBool)contact->friction;
  PetscReal            penalty;

  PetscFunctionBeginUser;
  if (pair->master) PetscCall(SurfaceFindFreeEdges(pair->master, pair->n_images, pair->images));
  if (pair->fit.fitted && pair->fit.global_frame) PetscCall(PairCheckGlobalFrame(mesh, scene, loads, pair));
  PetscCall(PairCreatePoints(mesh, scene, loads, pair));
  PetscCall(SurfaceFindFreeEdges(pair->slave, pair->n_images, pair->images));
  pair->automatic =
    PenaltyAutomatic(deformable->stiffness, pair->master && !ContactOnTool(pair) ? pair->master->stiffness : 0);
  pair->most = pair->predicted_most = PETSC_MAX_REAL;
  penalty       = contact->penalty_scale * (contact->penalty_auto ? pair->automatic : contact->penalty);
  pair->initial = penalty;
  PetscCall(ContactStateCreate(pair->n, penalty, friction, &pair->now));
  PetscCall(ContactStateCreate(pair->n, penalty, friction, &pair->accepted));
  PetscCall(SearchCreate(mesh, scene, loads, pair->master, pair->slave->max_size, pair->n_images, pair->images,
                         &pair->fit, pair->slaves, pair->master_offsets ? OffsetsGet(pair->master_offsets) : NULL,
                         pair->master_offsets ? OffsetsMaps(pair->master_offsets) : NULL, &pair->search));
  SearchSetTool(pair->search, pair->tool);
  SearchSetRungs(pair->search, pair->first_rung);
  SearchSetFrames(pair->search, pair->frame_kept);
  PetscCall(
    PetscCalloc4(pair->n, &pair->held, pair->n, &pair->predicted, pair->n, &pair->expected, pair->n, &pair->arrived));
  PetscCall(PetscCalloc1(pair->n, &pair->balanced));
  PetscCall(PetscMalloc1(pair->n, &pair->foreseen));
  for (PetscInt c = 0; c < pair->n; c++) pair->foreseen[c] = NAN;
  if (friction) PetscCall(FrictionCreate(pair));
  if (contact->adjust) PetscCall(PetscMalloc1(pair->n, &pair->before));
  if (contact->augment) PetscCall(PairCreateMixing(pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairCreate - creates surfaces, terms, state and search of one pair of the scene, without lists.

  Collective

  Input Parameters:
+ mesh       - the mesh, borrowed
. scene      - the scene, borrowed
. elasticity - the bodies, for the automatic penalty
. loads      - prescribed motions, borrowed
. piece      - connected piece of the mesh of each local node; NULL where the scene lists no surfaces
- contact    - what the scene says of the pair, borrowed

  Output Parameter:
. pair - the pair; all members must be zero before the call

  Note:
  Refuses what the mesh shows to be wrong.
@*/
PetscErrorCode ContactPairCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, const PetscInt piece[],
                                 const SceneContact *contact, ContactPair *pair)
{
  PetscFunctionBeginUser;
  pair->mesh     = mesh;
  pair->scene    = contact;
  pair->tool     = ToolOfPair(mesh, scene, (int)(contact - scene->contacts));
  pair->facets   = &Smoother_Facet;
  pair->smoother = Smoothers[contact->smoother];
  pair->law      = Laws[contact->law];
  pair->geometry = scene->geometry;
  PairSetFormulation(scene, mesh->order, pair);
  pair->fit = PairFitSettings(scene, pair, mesh->order);
  if (MeshFindRigid(mesh, contact->slave))
    PetscCall(RefuseInput(
      mesh->comm,
      "%s: the slave '%s' is a rigid tool; allowed: a surface of a deformable body (make the tool the master)",
      SceneWhere(scene, contact->path, "slave"), contact->slave));
  PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, contact->listed ? "surfaces" : "slave",
                          contact->slave, &pair->slave));
  if (contact->master)
    PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, contact->listed ? "surfaces" : "master",
                            contact->master, &pair->master));
  if (contact->listed && pair->master) PetscCall(PairIsOneBody(mesh, scene, pair, &pair->one_body));
  if (pair->one_body) PetscCall(SurfaceTakePieces(pair->slave, piece));
  if (pair->one_body) PetscCall(SurfaceTakePieces(pair->master, piece));
  PetscCall(PairTurnMaster(scene, loads, pair));
  PetscCall(SurfaceImages(mesh, scene, contact, pair->slave, pair->master, &pair->n_images, pair->images));
  if (contact->find_symmetry && (pair->smoother->fitted || contact->listed)) /* a body may meet its own image */
    PetscCall(
      SurfaceImagesFromSupports(mesh, scene, pair->slave, pair->master, PETSC_TRUE, &pair->n_images, pair->images));
  PetscCall(PairMirrors(mesh, scene, pair));
  PetscCall(PairComplete(mesh, scene, loads, pair));
  if (contact->listed) SearchAllSides(pair->search, pair->one_body);
  if (contact->share < 1) PetscCall(MeshCreateLocal(mesh, mesh->dim, &pair->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the scene would say of a pair whose slave is the sharp edges of the master of another one. */
static SceneContact RidgeScene(const SceneContact *of)
{
  SceneContact ridge = *of;

  ridge.slave       = of->master;
  ridge.master      = of->slave;
  ridge.formulation = CONTACT_NODE_TO_SURFACE;
  ridge.share       = 1;
  ridge.friction    = 0;
  return ridge;
}

/* Gives a pair of the sharp edges of the master of another one what it has from that. */
static void PairBeginRidge(Contact contact, int of, ContactPair *pair)
{
  const ContactPair *first = &contact->pairs[of];

  pair->tool_pair   = of;
  pair->ridge_scene = RidgeScene(first->scene);
  pair->mesh        = contact->mesh;
  pair->scene       = &pair->ridge_scene;
  pair->facets      = &Smoother_Facet;
  pair->smoother    = Smoothers[pair->ridge_scene.smoother];
  pair->law         = first->law;
  pair->geometry    = contact->scene->geometry;
}

/*@
  ContactPairCreateRidge - creates a pair of the sharp edges of a tool and the slave of the tool's pair, without lists.

  Collective

  Input Parameters:
+ contact    - the contact, with that pair
. elasticity - the bodies, for the automatic penalty
- of         - number of the pair, whose master is a meshed rigid tool

  Output Parameter:
. pair - the pair; all members must be zero before the call; it has no slave where the tool has no such edge
@*/
PetscErrorCode ContactPairCreateRidge(Contact contact, Elasticity elasticity, int of, ContactPair *pair)
{
  const Mesh         mesh  = contact->mesh;
  const Scene        scene = contact->scene;
  const ContactPair *tool  = &contact->pairs[of];

  PetscFunctionBeginUser;
  PetscCall(
    RidgeSurfaceCreate(tool->master, tool->slave, scene->geometry, tool->n_mirrors, tool->mirrors, &pair->slave));
  if (!pair->slave) PetscFunctionReturn(PETSC_SUCCESS);
  PairBeginRidge(contact, of, pair);
  pair->tool = tool->tool;
  /* Tools with unknowns take their part of a gap from motions of slave and tool as one body, in which frames of fits on
     the slave do not turn. */
  if (pair->tool) pair->smoother = pair->facets;
  pair->n_images  = tool->n_images;
  pair->n_mirrors = tool->n_mirrors;
  PetscCall(PetscArraycpy(pair->images, tool->images, SURFACE_MAX_IMAGES));
  PetscCall(PetscArraycpy(pair->mirrors, tool->mirrors, SURFACE_MAX_IMAGES));
  PairSetFormulation(scene, mesh->order, pair);
  pair->fit = PairFitSettings(scene, pair, mesh->order);
  PetscCall(
    SurfaceCreate(mesh, scene, elasticity, pair->ridge_scene.path, "slave", pair->ridge_scene.master, &pair->master));
  PetscCall(PairComplete(mesh, scene, contact->loads, pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairCreateEdges - creates a pair of the sharp edges of a deformable master and the slave of its pair, without
  lists.

  Collective

  Input Parameters:
+ contact    - the contact, with that pair
. elasticity - the bodies, for the automatic penalty
- of         - number of the pair

  Output Parameter:
. pair - the pair; all members must be zero before the call; it has no slave where the master has no such edge
@*/
PetscErrorCode ContactPairCreateEdges(Contact contact, Elasticity elasticity, int of, ContactPair *pair)
{
  const Mesh         mesh  = contact->mesh;
  const Scene        scene = contact->scene;
  const ContactPair *first = &contact->pairs[of];
  PetscInt           n;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_nodes, &pair->edge_length));
  PetscCall(SurfaceEdgeLengths(first->master, SURFACE_SQUARE, first->n_mirrors, first->mirrors, pair->edge_length, &n));
  if (!n) {
    PetscCall(PetscFree(pair->edge_length));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PairBeginRidge(contact, of, pair);
  PairSetFormulation(scene, mesh->order, pair);
  pair->fit = PairFitSettings(scene, pair, mesh->order);
  PetscCall(
    SurfaceCreate(mesh, scene, elasticity, pair->ridge_scene.path, "master", pair->ridge_scene.slave, &pair->slave));
  PetscCall(
    SurfaceCreate(mesh, scene, elasticity, pair->ridge_scene.path, "slave", pair->ridge_scene.master, &pair->master));
  PetscCall(SurfaceImages(mesh, scene, pair->scene, pair->slave, pair->master, &pair->n_images, pair->images));
  if (pair->scene->find_symmetry && pair->smoother->fitted)
    PetscCall(
      SurfaceImagesFromSupports(mesh, scene, pair->slave, pair->master, PETSC_TRUE, &pair->n_images, pair->images));
  PetscCall(PairMirrors(mesh, scene, pair));
  PetscCall(PairComplete(mesh, scene, contact->loads, pair));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairDestroy - frees what a pair holds.

  Collective

  Input Parameter:
. pair - the pair; the structure itself belongs to the caller
@*/
PetscErrorCode ContactPairDestroy(ContactPair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(NeighbourListsDestroy(&pair->lists));
  PetscCall(NeighbourListsDestroy(&pair->next));
  PetscCall(SearchDestroy(&pair->search));
  PetscCall(NodeDepthsDestroy(&pair->depths));
  PetscCall(OffsetsDestroy(&pair->slave_offsets));
  PetscCall(OffsetsDestroy(&pair->master_offsets));
  PetscCall(SlavePointsDestroy(&pair->slaves));
  PetscCall(SurfaceDestroy(&pair->slave));
  if (pair->master) PetscCall(SurfaceDestroy(&pair->master));
  PetscCall(ContactStateDestroy(&pair->now));
  PetscCall(ContactStateDestroy(&pair->accepted));
  PetscCall(PetscFree4(pair->node, pair->area, pair->size, pair->turn));
  PetscCall(PetscFree2(pair->first_side, pair->whole));
  PetscCall(PetscFree2(pair->shown_gap, pair->shown_normal));
  PetscCall(PetscFree(pair->corner));
  PetscCall(PetscFree(pair->at_end));
  PetscCall(PetscFree(pair->below));
  PetscCall(PetscFree(pair->edge_length));
  PetscCall(PetscFree(pair->face));
  PetscCall(PetscFree(pair->term_ptr));
  PetscCall(PetscFree2(pair->term_point, pair->term_weight));
  PetscCall(PetscFree5(pair->force, pair->normal, pair->pressure, pair->stiffness, pair->stiffness_before));
  PetscCall(
    PetscFree6(pair->factor, pair->next_factor, pair->seed, pair->point_gap, pair->point_normal, pair->point_force));
  PetscCall(PetscFree2(pair->first_rung, pair->fallen));
  PetscCall(PetscFree3(pair->frame_before, pair->frame_kept, pair->turned_back));
  PetscCall(PetscFree4(pair->factor_before, pair->factor_change, pair->factor_low, pair->factor_high));
  PetscCall(ContactVariationsDestroy(&pair->variations));
  PetscCall(PetscFree(pair->before));
  PetscCall(AndersonDestroy(&pair->mixing));
  PetscCall(PetscFree(pair->weight));
  PetscCall(PetscFree4(pair->held, pair->predicted, pair->expected, pair->arrived));
  PetscCall(PetscFree(pair->balanced));
  PetscCall(PetscFree(pair->foreseen));
  PetscCall(FrictionDestroy(&pair->friction));
  PetscCall(PetscFree(pair->carried));
  PetscCall(PetscFree(pair->carried_dry));
  PetscCall(PetscFree(pair->marks));
  PetscCall(PetscFree(pair->reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  ContactPairs - returns the number of pairs of the scene, 0 for NULL.

  Not collective

  Input Parameter:
. contact - the contact, or NULL
@*/
int ContactPairs(Contact contact)
{
  return contact ? contact->n_scene : 0;
}

/*@
  ContactPairName - returns the scene's name of a pair.

  Not collective

  Input Parameters:
+ contact - the contact
- pair    - number of the pair
@*/
const char *ContactPairName(Contact contact, int pair)
{
  return contact->pairs[pair].scene->name;
}

/*@
  ContactPairScene - returns what the scene says of a pair.

  Not collective

  Input Parameters:
+ contact - the contact
- pair    - number of the pair
@*/
const SceneContact *ContactPairScene(Contact contact, int pair)
{
  return contact->pairs[pair].scene;
}

/*@
  ContactFindPair - returns the number of the pair of a name, or -1.

  Not collective

  Input Parameters:
+ contact - the contact
- name    - the scene's name
@*/
int ContactFindPair(Contact contact, const char *name)
{
  for (int p = 0; p < ContactPairs(contact); p++)
    if (!strcmp(contact->pairs[p].scene->name, name)) return p;
  return -1;
}

/*@
  ContactPairPartner - returns the number of the pair that treats the same two surfaces from the other side; -1 if there
  is none. A surface that meets itself is its own partner.

  Not collective

  Input Parameters:
+ contact - the contact
- pair    - number of the pair
@*/
int ContactPairPartner(Contact contact, int pair)
{
  const SceneContact *of = contact->pairs[pair].scene;

  for (int p = 0; p < contact->n_scene && of->share < 1; p++) {
    const SceneContact *other = contact->pairs[p].scene;

    if (other->share < 1 && !strcmp(other->path, of->path) && !strcmp(other->slave, of->master) &&
        !strcmp(other->master, of->slave))
      return p;
  }
  return -1;
}

/*@
  ContactOffsetsLag - says whether some pair holds its offsets in a solve, so that lists made afresh may find them old.

  Not collective, the same on all ranks

  Input Parameter:
. contact - the contact
@*/
PetscBool ContactOffsetsLag(Contact contact)
{
  PetscBool lag = PETSC_FALSE;

  for (int p = 0; p < contact->n_pairs; p++) lag = (PetscBool)(lag || contact->pairs[p].formulation.lags);
  return lag;
}

/*@
  ContactFitAll - lets all slave points be fitted that have a master, also those that are too far away for contact.

  Not collective

  Input Parameter:
. contact - the contact, before its lists are made

  Note:
  It is for a report on the surfaces. A run fits what may come into contact.
@*/
void ContactFitAll(Contact contact)
{
  for (int p = 0; p < contact->n_pairs; p++) contact->pairs[p].fit.far = PETSC_TRUE;
}

/*@
  ContactHasFriction - says whether some pair has friction, so that forces have no potential and the tangent is not
  symmetric.

  Not collective

  Input Parameter:
. contact - the contact, or NULL
@*/
PetscBool ContactHasFriction(Contact contact)
{
  for (int p = 0; p < ContactPairs(contact); p++)
    if (contact->pairs[p].friction) return PETSC_TRUE;
  return PETSC_FALSE;
}

/*@
  ContactComm - returns the communicator of the contact.

  Not collective

  Input Parameter:
. contact - the contact; NULL gives MPI_COMM_NULL
@*/
MPI_Comm ContactComm(Contact contact)
{
  return contact ? contact->mesh->comm : MPI_COMM_NULL;
}

/*@
  ContactPairIsSurface - says whether a pair is surface to surface, so that forces reach its slave nodes by hat
  functions over their faces.

  Not collective

  Input Parameters:
+ contact - the contact
- pair    - number of the pair
@*/
PetscBool ContactPairIsSurface(Contact contact, int pair)
{
  return contact->pairs[pair].formulation.surface;
}
