/* The texts through which ParaView and meshio read results.vtkhdf, see xdmf.h. */
#include "xdmf.h"
#include "files/textfile.h"
#include <stdio.h>
#include <stdlib.h>

static const char *const topology[ELEMENT_TYPES] = {
  [ELEMENT_TRI3]  = "Triangle",
  [ELEMENT_TRI6]  = "Triangle_6",
  [ELEMENT_QUAD4] = "Quadrilateral",
  [ELEMENT_QUAD9] = "Quadrilateral_9",
  [ELEMENT_TET4]  = "Tetrahedron",
  [ELEMENT_TET10] = "Tetrahedron_10",
  [ELEMENT_HEX8]  = "Hexahedron",
  [ELEMENT_HEX27] = "Hexahedron_27",
  [ELEMENT_EDGE2] = "Polyline\" NodesPerElement=\"2",
  [ELEMENT_EDGE3] = "Edge_3",
};

static const char *const attribute_type[] = {[1] = "Scalar", [3] = "Vector"}; /* by width */

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
  fprintf(out, "\">results.vtkhdf:");
  XdmfPrintText(out, path);
  fprintf(out, "</DataItem>");
}

/* Prints an array of `width` columns at the nodes. */
static void XdmfPrintAttribute(FILE *out, const char *name, int width, PetscInt n, const char *path)
{
  fprintf(out, "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", name, attribute_type[width]);
  XdmfPrintDataset(out, "Float", n, width, path);
  fprintf(out, "</Attribute>\n");
}

/* Prints a nodal array of the bodies. A tensor goes as six scalars, because readers do not agree on the order of its
   components, and some take it for one tuple. */
static void XdmfPrintArray(FILE *out, const FieldsArray *array, PetscInt n, PetscInt step)
{
  char name[DATASET_PATH_SIZE], path[DATASET_PATH_SIZE];

  for (int i = 0; i < (array->width == 6 ? 6 : 1); i++) {
    snprintf(name, sizeof(name), "%s%s%s", array->name, array->width == 6 ? "_" : "",
             array->width == 6 ? TensorComponents[i] : "");
    snprintf(path, sizeof(path), "/steps/%04d/%.400s", (int)step, name);
    XdmfPrintAttribute(out, name, array->width == 6 ? 1 : array->width, n, path);
  }
}

/* Prints one block of cells at one step. */
static void XdmfPrintGrid(const FieldsIndex *index, FILE *out, int b, PetscInt step)
{
  const FieldsBlock *block   = &index->blocks[b];
  const Element     *element = ElementGet(block->type);
  char               path[DATASET_PATH_SIZE];

  fprintf(out, "   <Grid Name=\"");
  XdmfPrintText(out, block->name);
  fprintf(out, " %s\">\n    <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\">", element->name,
          topology[block->type], (long long)block->n);
  if (block->tool)
    snprintf(path, sizeof(path), "/tools/%s/cells", block->name);
  else
    snprintf(path, sizeof(path), "/mesh/block_%d", b);
  XdmfPrintDataset(out, "Int", block->n, element->nodes, path);
  fprintf(out, "</Topology>\n    <Geometry GeometryType=\"XYZ\">");
  snprintf(path, sizeof(path), block->tool ? "/tools/%s/nodes" : "/mesh/nodes", block->name);
  XdmfPrintDataset(out, "Float", block->nodes, 3, path);
  fprintf(out, "</Geometry>\n");
  snprintf(path, sizeof(path), "/steps/%04d/tools/%s/displacement", (int)step, block->name);
  if (block->tool) XdmfPrintAttribute(out, "displacement", 3, block->nodes, path);
  for (int i = 0; i < index->n_arrays && !block->tool; i++)
    if (index->shows[step] & 1 << index->arrays[i].kind) XdmfPrintArray(out, &index->arrays[i], index->nodes, step);
  fprintf(out, "   </Grid>\n");
}

/* Prints one step as a collection of blocks. */
static void XdmfPrintBlocks(const FieldsIndex *index, FILE *out, PetscInt step)
{
  fprintf(out, "  <Grid Name=\"%04d\" GridType=\"Collection\" CollectionType=\"Spatial\">\n", (int)step);
  fprintf(out, "   <Time Value=\"%.15g\"/>\n", (double)index->t[step]);
  for (int b = 0; b < index->n_blocks; b++) XdmfPrintGrid(index, out, b, step);
  fprintf(out, "  </Grid>\n");
}

/* Prints the cells of all bodies: a table of their own where they are of one type, and /mesh/cells_mixed else. */
static void XdmfPrintCells(const FieldsIndex *index, FILE *out)
{
  const ElementType type = FieldsOneType(index);
  PetscInt          n = 0, entries = 0;
  char              path[DATASET_PATH_SIZE];

  for (int b = 0; b < index->n_blocks && !index->blocks[b].tool; b++) {
    n += index->blocks[b].n;
    entries += index->blocks[b].n * (1 + ElementGet(index->blocks[b].type)->nodes);
  }
  fprintf(out, "   <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\">",
          type < ELEMENT_TYPES ? topology[type] : "Mixed", (long long)n);
  if (type < ELEMENT_TYPES) {
    snprintf(path, sizeof(path), "/mesh/cells_%s", ElementGet(type)->name);
    XdmfPrintDataset(out, "Int", n, ElementGet(type)->nodes, path);
  } else {
    XdmfPrintDataset(out, "Int", entries, 1, "/mesh/cells_mixed");
  }
  fprintf(out, "</Topology>\n");
}

/* Prints one step as one grid of all bodies. */
static void XdmfPrintBodies(const FieldsIndex *index, FILE *out, PetscInt step)
{
  fprintf(out, "  <Grid Name=\"%04d\" GridType=\"Uniform\">\n   <Time Value=\"%.15g\"/>\n", (int)step,
          (double)index->t[step]);
  XdmfPrintCells(index, out);
  fprintf(out, "   <Geometry GeometryType=\"XYZ\">");
  XdmfPrintDataset(out, "Float", index->nodes, 3, "/mesh/nodes");
  fprintf(out, "</Geometry>\n");
  for (int i = 0; i < index->n_arrays; i++)
    if (index->shows[step] & 1 << index->arrays[i].kind) XdmfPrintArray(out, &index->arrays[i], index->nodes, step);
  fprintf(out, "  </Grid>\n");
}

/* Writes a file anew, for all steps. */
static PetscErrorCode XdmfWriteFile(const FieldsIndex *index, const char *directory, const char *name,
                                    void (*print_step)(const FieldsIndex *, FILE *, PetscInt))
{
  char  *text;
  size_t size;
  FILE  *out = open_memstream(&text, &size);

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %s", name);
  fprintf(out, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n <Grid Name=\"");
  XdmfPrintText(out, index->name);
  fprintf(out, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt s = 0; s < index->n_steps; s++) print_step(index, out, s);
  fprintf(out, " </Grid>\n</Domain>\n</Xdmf>\n");
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for %s", name);
  PetscCall(TextFileReplace(directory, name, text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  XdmfWrite - writes results.xdmf and bodies.xdmf anew, for all steps that results.vtkhdf holds.

  Not collective

  Input Parameters:
+ index     - what results.vtkhdf holds
- directory - of the results; exists

  Note:
  For one rank. results.xdmf has a block for each body, tool and type of elements, bodies.xdmf has all bodies as one
grid, which is what meshio reads. Errors: those of TextFileReplace(), and PETSC_ERR_MEM.
@*/
PetscErrorCode XdmfWrite(const FieldsIndex *index, const char *directory)
{
  PetscFunctionBeginUser;
  PetscCall(XdmfWriteFile(index, directory, "results.xdmf", XdmfPrintBlocks));
  PetscCall(XdmfWriteFile(index, directory, "bodies.xdmf", XdmfPrintBodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}
