/* Checks of the cells' quality and formulations, and the report on bodies, surfaces and partition. */
#include "mesh/meshquality.h"
#include "base/complaint.h"
#include "kernels/elementkernel.h"
#include "mesh/mesh.h"
#include <string.h>

/* Quality */

/* Computes the quality of a cell and whether it is inverted. A cell is inverted if its Jacobian changes sign, or has
   the wrong sign everywhere, so that its volume is negative. */
static PetscBool CellInverted(Mesh mesh, PetscInt c, double *quality)
{
  double X[ELEMENT_MAX_NODES * 3];

  MeshCellCoordinates(mesh, c, X);
  *quality = ElementQuality(mesh->cell_type[c], mesh->dim, X);
  return !(*quality > 0) || !(CellVolume(mesh->cell_type[c], mesh->dim, GEOMETRY_PLANE_STRAIN, X) > 0) ? PETSC_TRUE
                                                                                                       : PETSC_FALSE;
}

/*@
  MeshCheckQuality - refuses inverted cells.

  Collective

  Input Parameters:
+ mesh  - the mesh
- scene - for the names of its bodies

  Note:
  The refusal names the inverted cell of lowest tag, its body, its smallest Jacobian determinant over the mean, and the
  number of inverted cells.
@*/
PetscErrorCode MeshCheckQuality(Mesh mesh, Scene scene)
{
  Complaint complaint = {""};
  double    quality, its_quality = 0;
  /* first: the inverted cell of lowest tag on this rank */
  PetscInt first = -1, tag = PETSC_MAX_INT, lowest, count = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (!CellInverted(mesh, c, &quality)) continue;
    count++;
    if (mesh->cell_tag[c] > tag) continue;
    first       = c;
    tag         = mesh->cell_tag[c];
    its_quality = quality;
  }
  PetscCallMPI(MPI_Allreduce(&tag, &lowest, 1, MPIU_INT, MPI_MIN, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPIU_INT, MPI_SUM, mesh->comm));
  if (first >= 0 && tag == lowest) {
    Complain(
      &complaint,
      "%s: cell %" PetscInt_FMT
      " of body '%s' is inverted (smallest over mean Jacobian determinant %g); inverted cells in all: %" PetscInt_FMT
      "; turn the entity round in gmsh, or mesh more finely where it is curved",
      SceneWhere(scene, "mesh", "file"), tag, scene->bodies[mesh->cell_body[first]].name, its_quality, count);
  }
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Says whether there is a kernel of the body's formulation for a cell. */
static PetscBool HasFormulation(Mesh mesh, Scene scene, PetscInt c)
{
  const KernelCase kernel = {.type        = mesh->cell_type[c],
                             .geometry    = scene->geometry,
                             .formulation = scene->bodies[mesh->cell_body[c]].formulation};

  return (PetscBool)ElementKernelExists(&kernel);
}

/* From this Poisson's ratio on, elements of first order with full integration lock: at 0.49 the bulk modulus is fifty
   times the shear modulus. */
#define LOCKING_NU 0.49

/* Finds the bodies with cells of first order and full integration that lock: by the scene, or because there are no
   others of their shape. */
static PetscErrorCode FindLocking(Mesh mesh, Scene scene)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    SceneBody *body = &scene->bodies[mesh->cell_body[c]];

    if ((body->formulation == FORMULATION_FULL || !HasFormulation(mesh, scene, c)) &&
        ElementGet(mesh->cell_type[c])->order == 1 &&
        (MaterialGetLaw(body->material.law)->plastic || (body->material.nu >= LOCKING_NU && !scene->plane_stress)))
      body->locks = 1;
  }
  for (int b = 0; b < scene->n_bodies; b++)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &scene->bodies[b].locks, 1, MPI_INT, MPI_MAX, mesh->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  MeshCheckFormulations - refuses cells for which the formulation that the user named for their body has no kernel, and
  a solver that is not for them.

  Collective

  Input Parameters:
+ mesh  - the mesh
- scene - its bodies, of which locks is set

  Note:
  The refusal names the cell's tag, its body and its element.
@*/
PetscErrorCode MeshCheckFormulations(Mesh mesh, Scene scene)
{
  Complaint complaint = {""};

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    const SceneBody *body = &scene->bodies[mesh->cell_body[c]];

    if (HasFormulation(mesh, scene, c) || body->chosen) continue;
    Complain(&complaint,
             "%s: %s is for quad4 and hex8 only; cell %" PetscInt_FMT
             " of body '%s' is %s, which needs formulation: full",
             SceneWhere(scene, body->path, "formulation"), Formulations[body->formulation], mesh->cell_tag[c],
             body->name, ElementGet(mesh->cell_type[c])->name);
  }
  if (mesh->has_pressures && scene->solver.type == SOLVER_ITERATIVE)
    Complain(&complaint,
             "%s: iterative is not for mixed tri3 and tet4, whose tangents are of a saddle; allowed: direct, or "
             "mesh.order: 2",
             SceneWhere(scene, "solver", "type"));
  PetscCall(ComplaintRefuse(mesh->comm, &complaint));
  PetscCall(FindLocking(mesh, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Report */

/* A line of the report, for a body, a surface or a rigid tool, with the values of all ranks together. */
typedef struct {
  const char *name;
  char        cells[MESH_TEXT]; /* body: for example "240 hex27" */
  double      count;            /* body and tool: nodes; surface: faces */
  double      measure;          /* volume or area */
  double      mean, least;      /* body: quality */
  PetscInt    worst;            /* tag of the cell of least quality */
} ReportRow;

/* Lists the cells by type, as in "240 hex27, 12 tet10". */
static void ListCells(const PetscReal cells[ELEMENT_TYPES], char list[MESH_TEXT])
{
  size_t used = 0;

  list[0] = '\0';
  for (int type = 0; type < ELEMENT_TYPES && used < MESH_TEXT; type++)
    if (cells[type] > 0)
      used += (size_t)snprintf(list + used, MESH_TEXT - used, "%s%.0f %s", used ? ", " : "", cells[type],
                               ElementGet((ElementType)type)->name);
}

/* Counts the nodes of a group that this rank owns. */
static PetscErrorCode CountNodes(Mesh mesh, const MeshGroup *group, PetscReal *count)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  *count = 0;
  for (PetscInt i = 0; i < group->n_nodes; i++) *count += mesh->node_owner[group->nodes[i]] == rank;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeasureBody(Mesh mesh, Scene scene, int b, ReportRow *row)
{
  enum { NODES = ELEMENT_TYPES, VOLUME, QUALITY, CELLS, SUMS };
  PetscReal sums[SUMS] = {0}; /* the first entries are cells by type */
  PetscReal least      = PETSC_MAX_REAL, here;
  PetscInt  worst      = PETSC_MAX_INT;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    double X[ELEMENT_MAX_NODES * 3], quality;

    if (mesh->cell_body[c] != b) continue;
    (void)CellInverted(mesh, c, &quality);
    MeshCellCoordinates(mesh, c, X);
    sums[mesh->cell_type[c]]++;
    sums[CELLS]++;
    sums[VOLUME] += CellVolume(mesh->cell_type[c], mesh->dim, scene->geometry, X);
    sums[QUALITY] += quality;
    if (quality < least || (quality == least && mesh->cell_tag[c] < worst)) worst = mesh->cell_tag[c];
    least = PetscMin(least, quality);
  }
  PetscCall(CountNodes(mesh, &mesh->groups[MeshFindGroup(mesh, mesh->dim, scene->bodies[b].name)], &sums[NODES]));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, SUMS, MPIU_REAL, MPIU_SUM, mesh->comm));
  here = least;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPIU_REAL, MPIU_MIN, mesh->comm));
  if (here > least) worst = PETSC_MAX_INT;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPIU_INT, MPI_MIN, mesh->comm));
  *row = (ReportRow){.name    = scene->bodies[b].name,
                     .count   = sums[NODES],
                     .measure = sums[VOLUME],
                     .mean    = sums[QUALITY] / sums[CELLS],
                     .least   = least,
                     .worst   = worst};
  ListCells(sums, row->cells);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MeasureSurface(Mesh mesh, Scene scene, const MeshGroup *group, ReportRow *row)
{
  PetscReal sums[2] = {(PetscReal)group->n_faces, 0}; /* faces, area */

  PetscFunctionBeginUser;
  for (PetscInt f = 0; f < group->n_faces; f++) {
    PetscInt          nodes[FACE_MAX_NODES];
    const ElementType type = MeshFaceNodes(mesh, group, f, nodes);
    const int         n    = ElementGet(type)->nodes;
    double            X[FACE_MAX_NODES * 3], area[FACE_MAX_NODES] = {0};

    MeshGatherNodes(mesh, n, nodes, mesh->coords, X);
    FaceAreaKernel(type, mesh->dim, scene->geometry, X, area, NULL);
    for (int a = 0; a < n; a++) sums[1] += area[a];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPIU_REAL, MPIU_SUM, mesh->comm));
  *row = (ReportRow){.name = group->name, .count = sums[0], .measure = sums[1]};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Computes the rows of the bodies and of the surfaces on them. bodies has room for all bodies of the scene, surfaces
   for all groups. */
static PetscErrorCode Measure(Mesh mesh, Scene scene, int *n_bodies, ReportRow bodies[], int *n_surfaces,
                              ReportRow surfaces[])
{
  PetscFunctionBeginUser;
  *n_bodies = *n_surfaces = 0;
  for (int b = 0; b < scene->n_bodies; b++)
    if (!scene->bodies[b].rigid) PetscCall(MeasureBody(mesh, scene, b, &bodies[(*n_bodies)++]));
  for (int g = 0; g < mesh->n_groups; g++)
    if (mesh->groups[g].dim == mesh->dim - 1 && mesh->groups[g].attached)
      PetscCall(MeasureSurface(mesh, scene, &mesh->groups[g], &surfaces[(*n_surfaces)++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the width of a column that must also hold the text. */
static int Width(int width, const char *text)
{
  return PetscMax(width, (int)strlen(text));
}

/* Prints the report with stdio, because PetscFPrintf() writes whole numbers with a decimal point. */
static void PrintReport(Mesh mesh, int n_bodies, const ReportRow bodies[], int n_surfaces, const ReportRow surfaces[],
                        FILE *stream)
{
  int name = Width(0, "rigid tool");

  for (int b = 0; b < n_bodies; b++) name = Width(name, bodies[b].name);
  for (int s = 0; s < n_surfaces; s++) name = Width(name, surfaces[s].name);
  for (int r = 0; r < mesh->n_rigid; r++) name = Width(name, mesh->rigid[r].name);
  fprintf(stream, "mesh     %" PetscInt_FMT " cells of order %d, %" PetscInt_FMT " nodes, diagonal %g\n",
          mesh->n_cells_global, mesh->order, mesh->n_body_global, (double)mesh->size);
  for (const char *line = mesh->notes; line && *line; line += strcspn(line, "\n") + 1)
    fprintf(stream, "         %.*s\n", (int)strcspn(line, "\n"), line);
  fprintf(stream, "         %-*s %9s %11s  %7s %7s %9s  %s\n", name, "body", "nodes", "volume", "quality", "least",
          "in cell", "cells");
  for (int b = 0; b < n_bodies; b++)
    fprintf(stream, "         %-*s %9.0f %11g  %7.3f %7.3f %9" PetscInt_FMT "  %s\n", name, bodies[b].name,
            bodies[b].count, bodies[b].measure, bodies[b].mean, bodies[b].least, bodies[b].worst, bodies[b].cells);
  if (n_surfaces) fprintf(stream, "         %-*s %9s %11s\n", name, "surface", "faces", "area");
  for (int s = 0; s < n_surfaces; s++)
    fprintf(stream, "         %-*s %9.0f %11g\n", name, surfaces[s].name, surfaces[s].count, surfaces[s].measure);
  if (mesh->n_rigid) fprintf(stream, "         %-*s %9s %11s\n", name, "rigid tool", "faces", "nodes");
  for (int r = 0; r < mesh->n_rigid; r++)
    fprintf(stream, "         %-*s %9" PetscInt_FMT " %11" PetscInt_FMT "\n", name, mesh->rigid[r].name,
            mesh->rigid[r].n_faces, mesh->rigid[r].n_nodes);
  if (strcmp(mesh->partition.tool, "none")) {
    fprintf(stream, "parts    %s: edge cut %" PetscInt_FMT ", largest over mean %.2f (cells in contact %.2f)\n",
            mesh->partition.tool, mesh->partition.edge_cut, (double)mesh->partition.imbalance_cells,
            (double)mesh->partition.imbalance_contact);
  }
}

/*@
  MeshReport - prints a table of bodies, surfaces, rigid tools and the partition.

  Collective

  Input Parameters:
+ mesh   - the mesh
. scene  - for its bodies
- stream - output on rank 0, which prints

  Note:
  The quality of a body is the mean and the least scaled Jacobian, see ElementQuality(); 1 is a parallelepiped. In
  axisymmetric problems areas and volumes are over 360 degrees. A surface between cells counts once.
@*/
PetscErrorCode MeshReport(Mesh mesh, Scene scene, FILE *stream)
{
  ReportRow  *bodies, *surfaces;
  int         n_bodies, n_surfaces;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc2(scene->n_bodies, &bodies, mesh->n_groups, &surfaces));
  PetscCall(Measure(mesh, scene, &n_bodies, bodies, &n_surfaces, surfaces));
  if (!rank) PrintReport(mesh, n_bodies, bodies, n_surfaces, surfaces, stream);
  PetscCall(PetscFree2(bodies, surfaces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
