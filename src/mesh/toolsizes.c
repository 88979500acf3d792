/* Sizes of the elements of rigid tools in a view of gmsh, see meshsizes.h. */
#include "private/toolsizes.h"
#include "kernels/elementkernel.h"
#include <math.h>

/* A face of a tool is drawn as a cell around it, which reaches so far to both sides, in parts of its length: a curve
   leaves the face by its sagitta, which is less. */
#define TOOL_HEIGHT 0.25
/* The cell is so much larger than the face along it, for the ends of a curve. */
#define TOOL_LONGER 1.05

/* Most corners of a face */
enum { CORNERS = 4 };

/* Unit normal of a face of n corners x[n*dim]. Returns the length of an edge of the regular face of its area. */
static double FaceSize(int dim, int n, const double *x, double normal[3])
{
  const Geometry flat          = dim == 2 ? GEOMETRY_PLANE_STRAIN : GEOMETRY_SOLID;
  double         area[CORNERS] = {0}, normals[CORNERS * 3] = {0}, total = 0, length = 0;

  FaceAreaKernel(ElementCornerType(dim - 1, n), dim, flat, x, area, normals);
  for (int d = 0; d < 3; d++) normal[d] = 0;
  for (int k = 0; k < n; k++) {
    total += area[k];
    for (int d = 0; d < dim; d++) normal[d] += normals[k * dim + d];
  }
  for (int d = 0; d < dim; d++) length += normal[d] * normal[d];
  for (int d = 0; d < dim && length > 0; d++) normal[d] /= sqrt(length);
  return ElementRegularSize(dim - 1, n, total);
}

/* Writes a face as a cell with one size. */
static void WriteFace(int dim, int n, const double *x, double wanted, FILE *stream)
{
  double       normal[3], centre[3] = {0, 0, 0};
  const double length = FaceSize(dim, n, x, normal), size = wanted > 0 ? fmin(wanted, length) : length;

  for (int k = 0; k < n; k++)
    for (int d = 0; d < dim; d++) centre[d] += x[k * dim + d] / n;
  fprintf(stream, "S%c(", dim == 2 ? 'Q' : n == 3 ? 'I' : 'H');
  for (int k = 0; k < 2 * n; k++) {
    /* the second side of a plane strip goes back */
    const double *corner = &x[(dim == 2 && k >= n ? 2 * n - 1 - k : k % n) * dim];
    const double  height = (k < n ? -TOOL_HEIGHT : TOOL_HEIGHT) * length;

    for (int d = 0; d < 3; d++)
      fprintf(stream, k + d ? ",%.12g" : "%.12g",
              d < dim ? centre[d] + TOOL_LONGER * (corner[d] - centre[d]) + height * normal[d] : 0.0);
  }
  fprintf(stream, "){");
  for (int k = 0; k < 2 * n; k++) fprintf(stream, k ? ",%.6g" : "%.6g", size);
  fprintf(stream, "};\n");
}

/*@
  ToolSizesWrite - writes the sizes of the elements of rigid tools into a view of gmsh.

  Not collective

  Input Parameters:
+ mesh   - the mesh
. wanted - wanted[mesh->n_rigid], sizes (length); larger elements than the present ones are not asked for; 0: as now
- stream - the open file
@*/
void ToolSizesWrite(Mesh mesh, const PetscReal *wanted, FILE *stream)
{
  for (int r = 0; r < mesh->n_rigid; r++) {
    const MeshRigid *tool = &mesh->rigid[r];

    for (PetscInt f = 0; f < tool->n_faces; f++) {
      const int       dim = mesh->dim, n = ElementGet(tool->face_type[f])->corners;
      const PetscInt *nodes = &tool->face_nodes[tool->face_ptr[f]];
      double          x[CORNERS * 3];

      for (int k = 0; k < n; k++)
        for (int d = 0; d < dim; d++) x[k * dim + d] = (double)(tool->coords[nodes[k] * dim + d] + mesh->centre[d]);
      WriteFace(dim, n, x, (double)wanted[r], stream);
    }
  }
}
