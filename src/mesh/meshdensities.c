/* The parameters of a scene's .geo that refine its mesh, see meshdensities.h. */
#include "mesh/meshdensities.h"
#include "geofiles.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The value that the scene gives a parameter; *known: it gives one. */
static PetscReal SceneValue(Scene scene, const char *name, PetscBool *known)
{
  *known = PETSC_FALSE;
  for (int i = 0; i < scene->n_parameters; i++) {
    if (strcmp(scene->parameters[i].key, name)) continue;
    *known = PETSC_TRUE;
    return (PetscReal)strtod(scene->parameters[i].value, NULL);
  }
  return 0;
}

/* Takes a parameter unless its value is 0: then it does not refine. */
static void Take(Scene scene, const char *name, PetscReal preset, DensityKind kind, int *n, MeshDensity *density)
{
  PetscBool       known;
  const PetscReal given = SceneValue(scene, name, &known), value = known ? given : preset;

  if (!(value > 0)) return;
  density[*n] = (MeshDensity){.value = value, .kind = kind};
  snprintf(density[(*n)++].name, sizeof(density->name), "%s", name);
}

/* The default of a parameter that the scene names without a value: what the .geo declares, if it is a density there. */
static PetscReal Preset(const GeoDensities *declared, const char *name)
{
  for (int i = 0; i < declared->n; i++)
    if (!strcmp(declared->density[i].name, name)) return declared->density[i].value;
  return 0;
}

static DensityKind FindKind(const char *word)
{
  int kind = 0;

  while (strcmp(DensityKinds[kind], word)) kind++;
  return (DensityKind)kind;
}

/* Lists the densities on the rank that reads the .geo. */
static PetscErrorCode List(Scene scene, const GeoDensities *declared, int *n, MeshDensity **density)
{
  const SceneAccuracy *accuracy = &scene->accuracy;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(PetscMax(declared->n, accuracy->n_densities), density));
  for (int i = 0; i < accuracy->n_densities; i++)
    Take(scene, accuracy->densities[i].key, Preset(declared, accuracy->densities[i].key),
         FindKind(accuracy->densities[i].value), n, *density);
  for (int i = 0; i < declared->n && !accuracy->n_densities; i++)
    Take(scene, declared->density[i].name, declared->density[i].value, declared->density[i].kind, n, *density);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshDensitiesFind - finds the parameters of a scene's .geo that refine its mesh.

  Collective

  Input Parameters:
+ comm  - all ranks; rank 0 reads the .geo
. scene - its mesh file is a .geo
- trust - PETSC_TRUE: the .geo may run programs and write files

  Output Parameters:
+ n          - their number
. density    - the parameters, free them with PetscFree()
- structured - the .geo divides curves by itself (Transfinite), so that its elements do not follow given sizes
@*/
PetscErrorCode MeshDensitiesFind(MPI_Comm comm, Scene scene, PetscBool trust, int *n, MeshDensity **density,
                                 PetscBool *structured)
{
  Complaint   complaint = {""};
  GeoFiles    files;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *n          = 0;
  *density    = NULL;
  *structured = PETSC_FALSE;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  if (!rank) {
    PetscCall(GeoFilesRead(scene, trust, &files, &complaint));
    PetscCall(List(scene, &files.densities, n, density));
    *structured = files.densities.structured;
    PetscCall(GeoFilesReset(&files));
  }
  PetscCall(ComplaintRefuse(comm, &complaint));
  PetscCallMPI(MPI_Bcast(n, 1, MPI_INT, 0, comm));
  PetscCallMPI(MPI_Bcast(structured, 1, MPIU_BOOL, 0, comm));
  if (rank) PetscCall(PetscCalloc1(*n, density));
  PetscCallMPI(MPI_Bcast(*density, *n * (int)sizeof(MeshDensity), MPI_BYTE, 0, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshDensityText - gives the value of a parameter that makes elements smaller.

  Not collective

  Input Parameters:
+ density - the parameter
- factor  - by which elements are to be smaller than with its present value

  Output Parameter:
. text - the value
@*/
void MeshDensityText(const MeshDensity *density, PetscReal factor, char text[MESH_DENSITY_TEXT])
{
  const double value = (double)density->value, f = (double)factor;

  switch (density->kind) {
  case DENSITY_COUNT: snprintf(text, MESH_DENSITY_TEXT, "%.0f", ceil(value * f - 1e-9)); break;
  case DENSITY_SIZE: snprintf(text, MESH_DENSITY_TEXT, "%.6g", value / f); break;
  default: snprintf(text, MESH_DENSITY_TEXT, "%.6g", value * f);
  }
}
