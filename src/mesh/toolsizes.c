/* Sizes of the elements of rigid tools in a view of gmsh, see meshsizes.h. */
#include "private/toolsizes.h"
#include "kernels/elementkernel.h"
#include <math.h>

/* A face of a tool is drawn as a cell around it, which reaches so far to both sides, in parts of its length: a curve
   leaves the face by its sagitta, which is less. */
#define TOOL_HEIGHT 0.25
/* The cell is so much larger than the face along it, for the ends of a curve. */
#define TOOL_LONGER 1.05

/* Unit normal of a face of corners x[n][3] in the plane or in space, and its length. Returns the length. */
static double FaceNormal(int dim, int n, double x[][3], double normal[3])
{
  double a[3], b[3] = {0, 0, 1}, size = 0;

  for (int i = 0; i < 3; i++) {
    a[i] = dim == 2 || n == 3 ? x[1][i] - x[0][i] : x[2][i] - x[0][i];
    if (dim == 3) b[i] = n == 3 ? x[2][i] - x[0][i] : x[3][i] - x[1][i];
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;

    normal[i] = a[j] * b[k] - a[k] * b[j];
    size += normal[i] * normal[i];
  }
  size = sqrt(size);
  for (int i = 0; i < 3 && size > 0; i++) normal[i] /= size;
  return dim == 2 ? size : sqrt(n == 3 ? size * 2 / sqrt(3) : size / 2);
}

/* Writes a face as a cell with one size. */
static void WriteFace(int dim, int n, double x[][3], double wanted, FILE *stream)
{
  double       normal[3], centre[3] = {0, 0, 0};
  const double length = FaceNormal(dim, n, x, normal), size = wanted > 0 ? fmin(wanted, length) : length;

  for (int k = 0; k < n; k++)
    for (int i = 0; i < 3; i++) centre[i] += x[k][i] / n;
  fprintf(stream, "S%c(", dim == 2 ? 'Q' : n == 3 ? 'I' : 'H');
  for (int k = 0; k < 2 * n; k++) {
    /* the second side of a plane strip goes back */
    const double *corner = x[dim == 2 && k >= n ? 2 * n - 1 - k : k % n];

    for (int i = 0; i < 3; i++)
      fprintf(stream, k + i ? ",%.12g" : "%.12g",
              centre[i] + TOOL_LONGER * (corner[i] - centre[i]) +
                (k < n ? -TOOL_HEIGHT : TOOL_HEIGHT) * length * normal[i]);
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
      const int n                    = ElementGet(tool->face_type[f])->corners;
      double    x[FACE_MAX_NODES][3] = {{0}};

      for (int k = 0; k < n; k++)
        for (int i = 0; i < mesh->dim; i++)
          x[k][i] = (double)(tool->coords[tool->face_nodes[tool->face_ptr[f] + k] * mesh->dim + i] + mesh->centre[i]);
      WriteFace(mesh->dim, n, x, (double)wanted[r], stream);
    }
  }
}
