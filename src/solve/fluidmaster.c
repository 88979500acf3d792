/* Fluids on masters that deform: the fluid presses on both sides of the gap that it fills. On the slave contact and
   fluid are weighed term by term. On the master there are no terms, but the reactions of those of the slave: where they
   press less than the fluid, its load makes up for the rest. */
#include "base/refusal.h"
#include "fluidimpl.h"
#include "kernels/elementkernel.h"

/* Shares of the load that change by less than this between two solves are the same. It is far below what a face leaves
   open where the front crosses it. */
#define FLUID_SHARE 1e-3
/* Nodes whose area, as a vector, is below this part of their share of the faces around have none, as corners of
   second-order triangles: neither loads nor reactions say anything of them. */
#define FLUID_NO_AREA 0.01

/* The master surface of a pair if it deforms, else NULL. */
static const MeshGroup *Deforming(Contact contact, int p)
{
  ContactSides sides;

  ContactPairSides(contact, p, &sides);
  return sides.master && !sides.master->rigid ? sides.master->group : NULL;
}

/* Finds the pairs whose masters are on the surface and deform. */
PetscErrorCode FluidFindMasters(Fluids fluids, Fluid *fluid)
{
  const Contact contact = fluids->contact;
  char         *flag;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fluid->surface->graph.n, &flag));
  for (int p = 0; p < ContactPairs(contact); p++) {
    const MeshGroup *master = Deforming(contact, p);
    PetscInt         n      = 0;

    if (master) PetscCall(SurfaceGraphGroup(fluid->surface, master, flag, &n));
    fluid->reacts[p] = (PetscBool)(n > 0);
    fluid->master    = (PetscBool)(fluid->master || n > 0);
  }
  PetscCall(PetscFree(flag));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses the pressure of a fluid on a slave that is not that of the same fluid on the master. */
static PetscErrorCode CheckSame(Fluids fluids, const Fluid *slave, const Fluid *master, const char *pair)
{
  PetscFunctionBeginUser;
  for (int k = 0; k <= FLUID_SAMPLES; k++) {
    const PetscReal t = (PetscReal)k / FLUID_SAMPLES;
    PetscReal       one, other;

    PetscCall(LoadsPressure(fluids->loads, slave->number, t, &one));
    PetscCall(LoadsPressure(fluids->loads, master->number, t, &other));
    if (PetscAbsReal(one - other) <= FLUID_SAME * PetscMax(one, other)) continue;
    PetscCall(RefuseInput(fluids->mesh->comm,
                          "%s: is %g at t = %g, but on '%s', on the other side of contact '%s', it is %g; allowed with "
                          "where: open: the same pressure and history on both sides",
                          SceneWhere(fluids->scene, master->load->path, "pressure"), (double)other, (double)t,
                          slave->load->region, pair, (double)one));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses a fluid that presses on one side of a contact whose sides both deform. */
static PetscErrorCode CheckSides(Fluids fluids, const Fluid *fluid, int p)
{
  const SceneContact *scene = ContactPairScene(fluids->contact, p);
  PetscBool           slave = PETSC_FALSE, master = PETSC_FALSE;

  PetscFunctionBeginUser;
  for (int i = 0; i < fluids->n; i++) {
    const Fluid *other = &fluids->fluid[i];

    slave  = (PetscBool)(slave || other->pair[p]);
    master = (PetscBool)(master || other->reacts[p]);
    if (fluid->pair[p] && other->reacts[p]) PetscCall(CheckSame(fluids, fluid, other, scene->name));
  }
  if (slave && master) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
    RefuseInput(fluids->mesh->comm,
                "%s: the fluid presses on '%s' alone, but the %s '%s' of contact '%s' deforms; allowed: another "
                "load with where: open and this pressure on '%s', or on a surface that has it",
                SceneWhere(fluids->scene, fluid->load->path, "where"), fluid->load->region, slave ? "master" : "slave",
                slave ? scene->master : scene->slave, scene->name, slave ? scene->master : scene->slave));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Refuses what the other sides of a fluid's contacts cannot serve. Says whether one of them deforms. */
PetscErrorCode FluidCheckMasters(Fluids fluids, Fluid *fluid)
{
  PetscFunctionBeginUser;
  for (int p = 0; p < ContactPairs(fluids->contact); p++) {
    if (fluid->pair[p] && ContactPairToolMoves(fluids->contact, p))
      PetscCall(RefuseInput(fluids->mesh->comm,
                            "%s: the master of contact '%s' is a tool that forces move, and the fluid on '%s' would "
                            "press on it too; allowed with where: open: a tool whose motion is given",
                            SceneWhere(fluids->scene, fluid->load->path, "where"),
                            ContactPairScene(fluids->contact, p)->name, fluid->load->region));
    if (!fluid->reacts[p] && !(fluid->pair[p] && Deforming(fluids->contact, p))) continue;
    fluid->deforms = PETSC_TRUE;
    PetscCall(CheckSides(fluids, fluid, p));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The areas of the surface's nodes as vectors, and their shares of the faces around: 4 numbers for each local node. */
static PetscErrorCode AreaVectors(Fluids fluids, const Fluid *fluid, const PetscReal *u, PetscReal *area)
{
  const Mesh mesh = fluids->mesh;
  const int  dim  = mesh->dim;
  PetscInt   nodes[FACE_MAX_NODES];
  PetscReal  x[3 * FACE_MAX_NODES];

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < fluid->group->n_faces; f++) {
    const ElementType type                 = FluidFacePlaces(fluids, fluid, f, u, nodes, x);
    const int         n                    = ElementGet(type)->nodes;
    PetscReal         part[FACE_MAX_NODES] = {0}, normal[3 * FACE_MAX_NODES] = {0}, all = 0;

    FaceAreaKernel(type, dim, fluids->scene->geometry, x, part, normal);
    for (int a = 0; a < n; a++) all += part[a];
    for (int a = 0; a < n; a++) {
      for (int d = 0; d < dim; d++) area[4 * nodes[a] + d] += normal[a * dim + d];
      area[4 * nodes[a] + 3] += all / n;
    }
  }
  PetscCall(MeshSumNodes(mesh, 4, area));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds what the reactions of dry places press at the nodes, in the displacements of the last residual. */
PetscErrorCode FluidMeasureReactions(Fluids fluids, Fluid *fluid, const PetscReal *u)
{
  const SurfaceGraph s   = fluid->surface;
  const int          dim = fluids->mesh->dim;
  PetscReal         *area, *press, *reaction;

  PetscFunctionBeginUser;
  if (!fluid->master) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(4 * fluids->mesh->n_nodes, &area, fluids->mesh->n_nodes, &press, fluids->mesh->n_nodes * dim,
                         &reaction));
  PetscCall(AreaVectors(fluids, fluid, fluids->scene->kinematics == KINEMATICS_SMALL ? NULL : u, area));
  for (int p = 0; p < ContactPairs(fluids->contact); p++)
    if (fluid->reacts[p]) PetscCall(ContactDryReactions(fluids->contact, p, reaction));
  for (int i = 0; i < s->graph.n; i++) {
    const PetscInt   node   = s->local[i];
    const PetscReal *vector = &area[4 * node];
    PetscReal        square = 0;

    if (!s->own[i]) continue;
    for (int d = 0; d < dim; d++) square += PetscSqr(vector[d]);
    if (square < PetscSqr(FLUID_NO_AREA * vector[3])) continue;
    for (int d = 0; d < dim; d++) press[node] -= reaction[node * dim + d] * vector[d] / square;
  }
  PetscCall(SurfaceGraphGather(s, press, fluid->now.react));
  PetscCall(PetscFree3(area, press, reaction));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of its load that the fluid has at a node of the surface where it lies: what the reactions of dry places
   leave of its pressure. */
PetscReal FluidShare(const Fluid *fluid, int i)
{
  return fluid->pressure > 0 ? PetscMax(0, 1 - fluid->now.react[i] / fluid->pressure) : 1;
}

/* Says whether the load has another part of it at a node where it lies. */
PetscBool FluidShareChanges(const Fluid *fluid, int i)
{
  return (PetscBool)(fluid->laid[i] && PetscAbsReal(FluidShare(fluid, i) - fluid->share[i]) > FLUID_SHARE);
}
