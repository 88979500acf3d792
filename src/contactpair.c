#include "contactimpl.h"
#include "nodegeometry.h"
#include "penalty.h"
#include "refusal.h"

/* Slave nodes whose tributary area is below this share of the faces around them carry no force: corners of 6-node triangles and the axis node
   of second-order axisymmetric edges, whose areas are zero on flat faces and small, of either sign, on curved ones. Corners of 9-node faces
   have 1/36, all others more. */
#define CONTACT_SHARE_FLOOR 5e-3
/* A surface that turns more than this from its one reference plane cannot be written over it: cos 60 degrees. */
#define CONTACT_GLOBAL_COSINE 0.5
/* Touching start: a gap within this fraction of the face size is no gap, whatever the curvature. */
#define CONTACT_TOUCH 1e-6

/* The terms: owned slave nodes with area. */
static PetscErrorCode PairCreateTerms(Mesh mesh, Scene scene, ContactPair *pair)
{
  const MeshGroup *group = pair->slave->group;
  PetscReal       *area, *size, *turn, *share;
  PetscMPIInt      rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc4(mesh->n_nodes, &area, mesh->n_nodes, &size, mesh->n_nodes, &turn, mesh->n_nodes, &share));
  PetscCall(SurfaceNodeAreas(pair->slave, scene->geometry, NULL, area, NULL));
  PetscCall(SurfaceNodeSizes(pair->slave, scene->geometry, size, turn, share));
  PetscCall(PetscMalloc4(group->n_nodes, &pair->node, group->n_nodes, &pair->area, group->n_nodes, &pair->size, group->n_nodes, &pair->turn));
  for (PetscInt i = 0; i < group->n_nodes; i++) {
    const PetscInt node = group->nodes[i];

    if (mesh->node_owner[node] != rank || share[node] < CONTACT_SHARE_FLOOR) continue;
    pair->node[pair->n] = node;
    pair->area[pair->n] = area[node];
    pair->size[pair->n] = size[node];
    pair->turn[pair->n] = turn[node];
    pair->n++;
  }
  PetscCall(PetscMalloc2(pair->n + 1, &pair->term_ptr, pair->n, &pair->term_weight));
  for (PetscInt c = 0; c < pair->n; c++) {
    pair->term_ptr[c]    = c;
    pair->term_weight[c] = 1;
  }
  pair->term_ptr[pair->n] = pair->n;
  PetscCall(PetscCalloc5(pair->n, &pair->force, 3 * pair->n, &pair->vector, 3 * pair->n, &pair->normal, pair->n, &pair->pressure, pair->n, &pair->trial));
  PetscCall(PetscFree4(area, size, turn, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Support in spacings and exponent of the weight where the scene leaves them open, by dimension and degree: the smoothest fits whose guards
   hold on jittered meshes (3D: some 38 nodes; 2D: 9). */
static FitSettings PairFitSettings(Scene scene, const SceneContact *contact, const Smoother *smoother)
{
  FitSettings fit = {.degree = smoother->smooth ? contact->degree : 0, .support = contact->support, .exponent = contact->weight};

  if (fit.support == 0) fit.support = scene->dim == 2 && fit.degree == 4 ? 4.5 : 3.5;
  if (fit.exponent == 0) fit.exponent = scene->dim == 3 && fit.degree == 4 ? 3 : 6;
  fit.derivatives   = contact->diffuse_derivatives ? FIT_DIFFUSE : FIT_FULL;
  fit.global_frame  = contact->global_frame ? PETSC_TRUE : PETSC_FALSE;
  fit.feature_angle = contact->feature_angle * PETSC_PI / 180;
  return fit;
}

static PetscErrorCode PairCheckGlobalFrame(Mesh mesh, Scene scene, Loads loads, const ContactPair *pair)
{
  PetscReal normal[3], cosine, *zero;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * mesh->dim, &zero));
  PetscCall(SurfaceMeanNormal(pair->master, loads, zero, 0, normal, &cosine));
  PetscCall(PetscFree(zero));
  if (cosine < CONTACT_GLOBAL_COSINE) {
    PetscCall(RefuseInput(
      mesh->comm,
      "%s: the surface '%s' turns by %.0f degrees from its one reference plane; allowed: up to 60 degrees (frame: local has one plane for each slave point)",
      SceneWhere(scene, pair->scene->path, "frame"), pair->scene->master, (double)(PetscAcosReal(PetscMax(-1, cosine)) * 180 / PETSC_PI)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairCreate - surfaces, terms, state and search of one pair of the scene, without lists yet. Collective. Refuses what the mesh shows to be wrong. */
PetscErrorCode ContactPairCreate(Mesh mesh, Scene scene, Elasticity elasticity, Loads loads, const SceneContact *contact, ContactPair *pair)
{
  PetscReal penalty;

  PetscFunctionBeginUser;
  pair->mesh     = mesh;
  pair->scene    = contact;
  pair->facets   = SmootherFind("facet");
  pair->smoother = SmootherFind(contact->smoother == SMOOTHER_DIFFUSE ? "diffuse" : "facet");
  pair->fit      = PairFitSettings(scene, contact, pair->smoother);
  pair->law      = LawFind("penalty");
  if (contact->master && !strcmp(contact->slave, contact->master))
    PetscCall(RefuseInput(mesh->comm,
                          "%s: slave and master are both '%s'; allowed: two different surfaces (a surface in contact with itself is not available yet)",
                          SceneWhere(scene, contact->path, "master"), contact->master));
  if (MeshFindRigid(mesh, contact->slave))
    PetscCall(RefuseInput(mesh->comm, "%s: the slave '%s' is a rigid tool; allowed: a surface of a deformable body (make the tool the master)",
                          SceneWhere(scene, contact->path, "slave"), contact->slave));
  PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, "slave", contact->slave, &pair->slave));
  if (contact->master)
    PetscCall(SurfaceCreate(mesh, scene, elasticity, contact->path, "master", contact->master, &pair->master));
  else
    pair->fit.degree = 0;
  PetscCall(SurfaceImages(mesh, scene, contact, &pair->n_images, pair->images));
  if (pair->master) PetscCall(SurfaceFindFreeEdges(pair->master, pair->n_images, pair->images));
  if (pair->master && pair->fit.degree && pair->fit.global_frame) PetscCall(PairCheckGlobalFrame(mesh, scene, loads, pair));
  PetscCall(PairCreateTerms(mesh, scene, pair));
  pair->automatic = PenaltyAutomatic(pair->slave->stiffness, pair->master ? pair->master->stiffness : 0);
  penalty         = contact->penalty_scale * (contact->penalty_auto ? pair->automatic : contact->penalty);
  PetscCall(ContactStateCreate(pair->n, penalty, &pair->now));
  PetscCall(ContactStateCreate(pair->n, penalty, &pair->accepted));
  PetscCall(SearchCreate(mesh, scene, loads, pair->slave, pair->master, pair->n_images, pair->images, &pair->fit, pair->n, pair->node, &pair->search));
  PetscCall(PetscCalloc2(pair->n, &pair->factor, pair->n, &pair->seed));
  if (contact->adjust) PetscCall(PetscMalloc1(pair->n, &pair->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactPairDestroy - Collective. */
PetscErrorCode ContactPairDestroy(ContactPair *pair)
{
  PetscFunctionBeginUser;
  PetscCall(ListsDestroy(&pair->lists));
  PetscCall(SearchDestroy(&pair->search));
  PetscCall(SurfaceDestroy(&pair->slave));
  if (pair->master) PetscCall(SurfaceDestroy(&pair->master));
  PetscCall(ContactStateDestroy(&pair->now));
  PetscCall(ContactStateDestroy(&pair->accepted));
  PetscCall(PetscFree4(pair->node, pair->area, pair->size, pair->turn));
  PetscCall(PetscFree2(pair->term_ptr, pair->term_weight));
  PetscCall(PetscFree5(pair->force, pair->vector, pair->normal, pair->pressure, pair->trial));
  PetscCall(PetscFree2(pair->factor, pair->seed));
  PetscCall(PetscFree(pair->before));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What is left at t of the gap that the surfaces had before any load: all of an ignored overlap, a shrinking part of a ramped one. */
PetscReal ContactTermOffset(const ContactPair *pair, PetscInt c, PetscReal t)
{
  return pair->now.offset[c] * (pair->scene->initial_overlap == OVERLAP_RAMP ? 1 - t : 1);
}

/* Opening up to which a node counts as touching: what round-off and the facets' own sagitta leave between surfaces that touch. */
PetscReal ContactTouchTolerance(const ContactPair *pair, PetscInt c)
{
  const PetscReal h = pair->size[c], master = pair->master ? pair->master->mean_size : 0, radius = pair->scene->analytic.radius;
  const PetscReal kappa = pair->lists->kappa[c] + 2 * pair->turn[c] / h + (radius > 0 ? 1 / radius : 0);

  return CONTACT_TOUCH * h + kappa * (PetscSqr(h) + PetscSqr(master)) / 8;
}
