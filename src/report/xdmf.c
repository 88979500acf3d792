/* The text through which ParaView reads results.h5, see xdmf.h. */
#include "xdmf.h"
#include "files/textfile.h"
#include <stdio.h>
#include <stdlib.h>

enum { DATASET_PATH_SIZE = 512 /* characters of a path in results.h5 */ };

static const char *const topology[ELEMENT_TYPES] = {
  [ELEMENT_TRI3] = "Triangle",         [ELEMENT_TRI6] = "Triangle_6",     [ELEMENT_QUAD4] = "Quadrilateral",
  [ELEMENT_QUAD9] = "Quadrilateral_9", [ELEMENT_TET4] = "Tetrahedron",    [ELEMENT_TET10] = "Tetrahedron_10",
  [ELEMENT_HEX8] = "Hexahedron",       [ELEMENT_HEX27] = "Hexahedron_27",
};

static const char *const attribute_type[] = {[1] = "Scalar", [3] = "Vector", [6] = "Matrix"}; /* by width */

static void XdmfPrintText(FILE *out, const char *text)
{
  for (; *text; text++) {
    switch (*text) {
    case '&': fputs("&amp;", out); break;
    case '<': fputs("&lt;", out); break;
    case '"': fputs("&quot;", out); break;
    default: fputc(*text, out);
    }
  }
}

/* Prints a reference to a whole dataset of n x width values. ParaView's readers do not agree on how to take a part of
   one. */
static void XdmfPrintDataset(FILE *out, const char *type, PetscInt n, int width, const char *path)
{
  fprintf(out, "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" Dimensions=\"%lld", type, (long long)n);
  if (width > 1) fprintf(out, " %d", width);
  fprintf(out, "\">results.h5:%s</DataItem>", path);
}

/* Prints a nodal array. Six components go as a matrix, because ParaView's readers do not agree on the order of a
   symmetric tensor. ParaView names the columns of such a matrix XX YY ZZ XY YZ XZ, which is our order. */
static void XdmfPrintAttribute(FILE *out, const XdmfArray *array, PetscInt n, PetscInt step)
{
  char path[DATASET_PATH_SIZE];

  snprintf(path, sizeof(path), "/steps/%04d/%s", (int)step, array->name);
  fprintf(out, "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", array->name,
          attribute_type[array->width]);
  XdmfPrintDataset(out, "Float", n, array->width, path);
  fprintf(out, "</Attribute>\n");
}

/* Prints one block of cells at one step. */
static void XdmfPrintGrid(const Xdmf *xdmf, FILE *out, int b, PetscInt step)
{
  const XdmfBlock *block   = &xdmf->blocks[b];
  const Element   *element = ElementGet(block->type);
  char             path[DATASET_PATH_SIZE];

  fprintf(out, "   <Grid Name=\"");
  XdmfPrintText(out, block->body);
  fprintf(out, " %s\">\n    <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\">", element->name,
          topology[block->type], (long long)block->n);
  snprintf(path, sizeof(path), "/mesh/block_%d", b);
  XdmfPrintDataset(out, "Int", block->n, element->nodes, path);
  fprintf(out, "</Topology>\n    <Geometry GeometryType=\"XYZ\">");
  XdmfPrintDataset(out, "Float", xdmf->nodes, 3, "/mesh/nodes");
  fprintf(out, "</Geometry>\n");
  for (int i = 0; i < xdmf->n_arrays; i++)
    if (xdmf->shows[step] & 1 << xdmf->arrays[i].kind) XdmfPrintAttribute(out, &xdmf->arrays[i], xdmf->nodes, step);
  fprintf(out, "   </Grid>\n");
}

/*@
  XdmfWrite - writes results.xdmf anew, for all steps that results.h5 holds.

  Not collective

  Input Parameters:
+ xdmf      - what it shows
- directory - of the results; exists

  Note:
  For one rank. Errors: those of TextFileReplace(), and PETSC_ERR_MEM.
@*/
PetscErrorCode XdmfWrite(const Xdmf *xdmf, const char *directory)
{
  char  *text;
  size_t size;
  FILE  *out = open_memstream(&text, &size);

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for results.xdmf");
  fprintf(out, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n <Grid Name=\"");
  XdmfPrintText(out, xdmf->name);
  fprintf(out, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt s = 0; s < xdmf->n_steps; s++) {
    fprintf(out,
            "  <Grid Name=\"%04d\" GridType=\"Collection\" CollectionType=\"Spatial\">\n   <Time Value=\"%.15g\"/>\n",
            (int)s, (double)xdmf->t[s]);
    for (int b = 0; b < xdmf->n_blocks; b++) XdmfPrintGrid(xdmf, out, b, s);
    fprintf(out, "  </Grid>\n");
  }
  fprintf(out, " </Grid>\n</Domain>\n</Xdmf>\n");
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for results.xdmf");
  PetscCall(TextFileReplace(directory, "results.xdmf", text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}
