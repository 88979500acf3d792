#include "contactimpl.h"
#include "base/refusal.h"

/* Refuses a pair in which no master face looks towards any slave node: a surface turned inside out, or the wrong one.
 */
static PetscErrorCode PairCheckFacing(Contact contact, const ContactPair *pair)
{
  Mesh       mesh = contact->mesh;
  PetscReal *area, *normal;
  PetscBool  facing;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_nodes, &area, 3 * mesh->n_nodes, &normal));
  PetscCall(SurfaceNodeAreas(pair->slave, mesh->dim == 3 ? GEOMETRY_SOLID : GEOMETRY_PLANE_STRAIN, NULL, area, normal));
  PetscCall(SurfaceFaces(pair->master, pair->n, pair->node, normal, &facing));
  PetscCall(PetscFree2(area, normal));
  if (!facing) {
    PetscCall(RefuseInput(mesh->comm,
                          "%s: contact '%s': no face of '%s' faces '%s', their outward normals point the same way; "
                          "allowed: surfaces that look at each other "
                          "(turn a rigid tool's surface round in gmsh, ReverseMesh, or name the other side)",
                          SceneWhere(contact->scene, pair->scene->path, "master"), pair->scene->name,
                          pair->scene->master, pair->scene->slave));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ContactTakeOverlap - what the scene says of surfaces that overlap before any load: refuses (exit 1) the deepest
   overlap of each pair that is more than the facets' own sagitta explains, or keeps the overlaps as g_0.

   Collective; after ContactResidual() with forces, at the undeformed state. The message names pair, node and depth. */
PetscErrorCode ContactTakeOverlap(Contact contact)
{
  Mesh mesh = contact->mesh;

  PetscFunctionBeginUser;
  for (int p = 0; p < contact->n_pairs; p++) {
    ContactPair *pair  = &contact->pairs[p];
    PetscReal    worst = 0;
    PetscInt     at    = -1;
    struct {
      double gap;
      int    rank;
    } mine = {0, 0}, least;
    char complaint[512];

    if (pair->master) PetscCall(PairCheckFacing(contact, pair));
    for (PetscInt c = 0; c < pair->n; c++) {
      if (pair->scene->initial_overlap == OVERLAP_RAMP || pair->scene->initial_overlap == OVERLAP_IGNORE)
        pair->now.offset[c] = pair->now.gap[c] < 0 ? pair->now.gap[c] : 0;
      if (pair->scene->initial_overlap != OVERLAP_REFUSE) continue;
      if (!(pair->now.gap[c] < -ContactTouchTolerance(pair, c)) || pair->now.gap[c] >= worst) continue;
      worst = pair->now.gap[c];
      at    = c;
    }
    mine.gap = worst;
    PetscCallMPI(MPI_Comm_rank(mesh->comm, &mine.rank));
    PetscCallMPI(MPI_Allreduce(&mine, &least, 1, MPI_DOUBLE_INT, MPI_MINLOC, mesh->comm));
    if (at >= 0) {
      PetscCall(PetscSNPrintf(complaint, sizeof(complaint),
                              "%s: contact '%s': slave node %" PetscInt_FMT
                              " lies %g behind the master before any load; allowed: surfaces that touch or are apart, "
                              "or initial_overlap: resolve, ramp or ignore",
                              SceneWhere(contact->scene, pair->scene->path, "initial_overlap"), pair->scene->name,
                              mesh->node_tag[pair->node[at]], (double)-worst));
    }
    PetscCall(RefuseInputAnywhere(mesh->comm, at >= 0 && least.rank == mine.rank ? complaint : NULL));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
