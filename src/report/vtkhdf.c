/* The VTKHDF part of results.vtkhdf, see vtkhdf.h. */
#include "vtkhdf.h"
#include "files/hdf5table.h"
#include <math.h>
#include <string.h>

/* The arrays are made for so many steps at first, and for four times as many whenever these are full. Steps that are
   not there yet cost nothing. */
#define FIRST_STEPS 16
#define MORE_STEPS  4
/* Values of generated arrays that are written at once */
#define PIECE 65536
/* Rows of a chunk of the tables that grow with the steps */
#define STEPS_CHUNK 64

static const unsigned char CellTypes[ELEMENT_TYPES] = {
  [ELEMENT_EDGE2] = 3,  [ELEMENT_EDGE3] = 21, [ELEMENT_TRI3] = 5,   [ELEMENT_TRI6] = 22, [ELEMENT_QUAD4] = 9,
  [ELEMENT_QUAD9] = 28, [ELEMENT_TET4] = 10,  [ELEMENT_TET10] = 24, [ELEMENT_HEX8] = 12, [ELEMENT_HEX27] = 29,
};

/* The numbers by which XDMF knows the types of elements */
static const unsigned char XdmfTypes[ELEMENT_TYPES] = {
  [ELEMENT_TRI3] = 4, [ELEMENT_TRI6] = 36,  [ELEMENT_QUAD4] = 5, [ELEMENT_QUAD9] = 35,
  [ELEMENT_TET4] = 6, [ELEMENT_TET10] = 38, [ELEMENT_HEX8] = 9,  [ELEMENT_HEX27] = 50,
};

/* The tables with one row for each step. Those with two dimensions have one column. */
static const struct {
  const char *name;
  int         dimensions;
  int64_t     value;
} StepTables[] = {{"NumberOfParts", 1, 1}, {"PartOffsets", 1, 0},           {"PointOffsets", 1, 0},
                  {"CellOffsets", 2, 0},   {"ConnectivityIdOffsets", 2, 0}, {"CellDataOffsets/body", 1, 0}};

typedef struct {
  const FieldsIndex *index;
  hid_t              file, vtk;          /* the file and its group /VTKHDF */
  hsize_t            points, cells, ids; /* of the whole grid */
  hsize_t            room;               /* steps that the arrays are made for */
} Part;

/* Links with the groups above them */
static PetscErrorCode LinkProperties(hid_t *links)
{
  PetscFunctionBeginUser;
  CallHDF5(*links = H5Pcreate(H5P_LINK_CREATE));
  CallHDF5(H5Pset_create_intermediate_group(*links, 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells whether a path exists; each group on the way must be asked for. */
static PetscBool Exists(hid_t place, const char *path)
{
  char part[DATASET_PATH_SIZE];

  for (size_t i = 1; i < sizeof(part); i++) {
    if (path[i] != '/' && path[i]) continue;
    snprintf(part, i + 1, "%s", path);
    if (H5Lexists(place, part, H5P_DEFAULT) <= 0) return PETSC_FALSE;
    if (!path[i]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Measures the grid. */
static void Measure(Part *part)
{
  part->points = (hsize_t)part->index->nodes;
  for (int b = 0; b < part->index->n_blocks; b++) {
    const FieldsBlock *block = &part->index->blocks[b];

    if (block->tool) part->points += (hsize_t)block->nodes;
    part->cells += (hsize_t)block->n;
    part->ids += (hsize_t)(block->n * ElementGet(block->type)->nodes);
  }
}

/* Makes a dataset of one dimension and writes `n` values of `type`. */
static PetscErrorCode WriteValues(hid_t group, const char *name, hid_t type, hsize_t n, const void *values)
{
  hid_t space, data;

  PetscFunctionBeginUser;
  CallHDF5(space = H5Screate_simple(1, &n, NULL));
  CallHDF5(data = H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  CallHDF5(H5Dclose(data));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes, for all cells of a block, an arithmetic series into a table. */
static PetscErrorCode WriteSeries(hid_t data, hsize_t first, hsize_t n, int64_t start, int64_t step)
{
  int64_t *values;
  hid_t    space, memory;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PIECE, &values));
  CallHDF5(space = H5Dget_space(data));
  for (hsize_t at = 0; at < n; at += PIECE) {
    const hsize_t place = first + at, count = PetscMin((hsize_t)PIECE, n - at);

    for (hsize_t i = 0; i < count; i++) values[i] = start + step * (int64_t)(at + i);
    CallHDF5(memory = H5Screate_simple(1, &count, NULL));
    CallHDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, &place, NULL, &count, NULL));
    CallHDF5(H5Dwrite(data, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, values));
    CallHDF5(H5Sclose(memory));
  }
  CallHDF5(H5Sclose(space));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes an integer table of one dimension that WriteSeries() fills. */
static PetscErrorCode CreateTable(hid_t place, const char *path, hid_t type, hsize_t n, hid_t *data)
{
  hid_t space, links;

  PetscFunctionBeginUser;
  PetscCall(LinkProperties(&links));
  CallHDF5(space = H5Screate_simple(1, &n, NULL));
  CallHDF5(*data = H5Dcreate2(place, path, type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Sclose(space));
  CallHDF5(H5Pclose(links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Types, beginnings and bodies of all cells */
static PetscErrorCode WriteCells(Part *part)
{
  hid_t   types, offsets, bodies;
  hsize_t at  = 0;
  int64_t ids = 0;

  PetscFunctionBeginUser;
  PetscCall(CreateTable(part->vtk, "Types", H5T_NATIVE_UCHAR, part->cells, &types));
  PetscCall(CreateTable(part->vtk, "Offsets", H5T_NATIVE_INT64, part->cells + 1, &offsets));
  PetscCall(CreateTable(part->vtk, "CellData/body", H5T_NATIVE_INT32, part->cells, &bodies));
  for (int b = 0; b < part->index->n_blocks; b++) {
    const FieldsBlock *block = &part->index->blocks[b];
    const hsize_t      n     = (hsize_t)block->n;
    const int          nodes = ElementGet(block->type)->nodes;

    PetscCall(WriteSeries(types, at, n, CellTypes[block->type], 0));
    PetscCall(WriteSeries(bodies, at, n, block->number, 0));
    PetscCall(WriteSeries(offsets, at, n, ids, nodes));
    at += n;
    ids += (int64_t)n * nodes;
  }
  PetscCall(WriteSeries(offsets, at, 1, ids, 0));
  CallHDF5(H5Dclose(types));
  CallHDF5(H5Dclose(offsets));
  CallHDF5(H5Dclose(bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A dataset that is put together from others of the file. Rows are added one source after the other. */
typedef struct {
  hid_t   properties, space, type;
  int     width;
  hsize_t at; /* the next row */
} Virtual;

static PetscErrorCode VirtualBegin(Virtual *all, hid_t type, hsize_t rows, int width)
{
  const hsize_t size[2] = {rows, (hsize_t)width};
  const double  nothing = NAN;

  PetscFunctionBeginUser;
  *all = (Virtual){.type = type, .width = width};
  CallHDF5(all->properties = H5Pcreate(H5P_DATASET_CREATE));
  CallHDF5(all->space = H5Screate_simple(width > 1 ? 2 : 1, size, NULL));
  if (H5Tget_class(type) == H5T_FLOAT) CallHDF5(H5Pset_fill_value(all->properties, H5T_NATIVE_DOUBLE, &nothing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Takes the next rows from a dataset of `columns` columns; all of them, or the one with the number `column`. */
static PetscErrorCode VirtualAdd(Virtual *all, const char *path, hsize_t rows, int columns, int column)
{
  const hsize_t size[2] = {rows, (hsize_t)columns}, start[2] = {0, (hsize_t)column}, one[2] = {rows, 1};
  const hsize_t to[2] = {all->at, 0}, count[2] = {rows, (hsize_t)all->width};
  hid_t         source;

  PetscFunctionBeginUser;
  CallHDF5(source = H5Screate_simple(columns > 1 ? 2 : 1, size, NULL));
  if (column >= 0) CallHDF5(H5Sselect_hyperslab(source, H5S_SELECT_SET, start, NULL, one, NULL));
  CallHDF5(H5Sselect_hyperslab(all->space, H5S_SELECT_SET, to, NULL, count, NULL));
  CallHDF5(H5Pset_virtual(all->properties, all->space, ".", path, source));
  CallHDF5(H5Sclose(source));
  all->at += rows;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode VirtualEnd(Virtual *all, hid_t place, const char *path)
{
  hid_t links, data;

  PetscFunctionBeginUser;
  PetscCall(LinkProperties(&links));
  CallHDF5(H5Sselect_all(all->space));
  CallHDF5(data = H5Dcreate2(place, path, all->type, all->space, links, all->properties, H5P_DEFAULT));
  CallHDF5(H5Dclose(data));
  CallHDF5(H5Pclose(links));
  CallHDF5(H5Sclose(all->space));
  CallHDF5(H5Pclose(all->properties));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of all bodies, then of each tool */
static PetscErrorCode LinkPoints(Part *part)
{
  Virtual all;
  char    path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(VirtualBegin(&all, H5T_NATIVE_DOUBLE, part->points, 3));
  PetscCall(VirtualAdd(&all, "/mesh/nodes", (hsize_t)part->index->nodes, 3, -1));
  for (int b = 0; b < part->index->n_blocks; b++) {
    const FieldsBlock *block = &part->index->blocks[b];

    if (!block->tool) continue;
    PetscCall(PetscSNPrintf(path, sizeof(path), "/tools/%s/nodes", block->name));
    PetscCall(VirtualAdd(&all, path, (hsize_t)block->nodes, 3, -1));
  }
  PetscCall(VirtualEnd(&all, part->vtk, "Points"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes of all cells. Those of a tool are counted behind the nodes that come before: /tools/NAME/grid_cells. */
static PetscErrorCode LinkConnectivity(Part *part)
{
  Virtual all;
  char    path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(VirtualBegin(&all, H5T_NATIVE_INT64, part->ids, 1));
  for (int b = 0; b < part->index->n_blocks; b++) {
    const FieldsBlock *block   = &part->index->blocks[b];
    const hsize_t      size[2] = {(hsize_t)block->n, (hsize_t)ElementGet(block->type)->nodes};
    const hsize_t      n       = size[0] * size[1];
    hid_t              source;

    if (block->tool)
      PetscCall(PetscSNPrintf(path, sizeof(path), "/tools/%s/grid_cells", block->name));
    else
      PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/block_%d", b));
    CallHDF5(source = H5Screate_simple(2, size, NULL));
    CallHDF5(H5Sselect_hyperslab(all.space, H5S_SELECT_SET, &all.at, NULL, &n, NULL));
    CallHDF5(H5Pset_virtual(all.properties, all.space, ".", path, source));
    CallHDF5(H5Sclose(source));
    all.at += n;
  }
  PetscCall(VirtualEnd(&all, part->vtk, "Connectivity"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Entries of a virtual dataset of one dimension are a column of another dataset: the first one is `skip` behind the
   next row, the others `stride` apart. */
static PetscErrorCode VirtualSpread(Virtual *all, const char *path, hsize_t rows, int columns, int column, int skip,
                                    int stride)
{
  const hsize_t size[2] = {rows, (hsize_t)columns}, start[2] = {0, (hsize_t)column}, one[2] = {rows, 1};
  const hsize_t to = all->at + (hsize_t)skip, step = (hsize_t)stride;
  hid_t         source;

  PetscFunctionBeginUser;
  CallHDF5(source = H5Screate_simple(columns > 1 ? 2 : 1, size, NULL));
  CallHDF5(H5Sselect_hyperslab(source, H5S_SELECT_SET, start, NULL, one, NULL));
  CallHDF5(H5Sselect_hyperslab(all->space, H5S_SELECT_SET, &to, &step, &rows, NULL));
  CallHDF5(H5Pset_virtual(all->properties, all->space, ".", path, source));
  CallHDF5(H5Sclose(source));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells of bodies of several types as XDMF has them in one table, /mesh/cells_mixed: of each cell the number of its
   type, of /mesh/xdmf_types_b for block b, and its nodes. */
static PetscErrorCode LinkMixedCells(Part *part)
{
  hsize_t entries = 0;
  Virtual all;
  hid_t   types;
  char    path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  for (int b = 0; b < part->index->n_blocks && !part->index->blocks[b].tool; b++)
    entries += (hsize_t)(part->index->blocks[b].n * (1 + ElementGet(part->index->blocks[b].type)->nodes));
  PetscCall(VirtualBegin(&all, H5T_NATIVE_INT64, entries, 1));
  for (int b = 0; b < part->index->n_blocks && !part->index->blocks[b].tool; b++) {
    const FieldsBlock *block = &part->index->blocks[b];
    const hsize_t      n     = (hsize_t)block->n;
    const int          nodes = ElementGet(block->type)->nodes;

    PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/xdmf_types_%d", b));
    PetscCall(CreateTable(part->file, path, H5T_NATIVE_INT64, n, &types));
    PetscCall(WriteSeries(types, 0, n, XdmfTypes[block->type], 0));
    CallHDF5(H5Dclose(types));
    PetscCall(VirtualSpread(&all, path, n, 1, 0, 0, nodes + 1));
    PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/block_%d", b));
    for (int i = 0; i < nodes; i++) PetscCall(VirtualSpread(&all, path, n, nodes, i, i + 1, nodes + 1));
    all.at += n * (hsize_t)(nodes + 1);
  }
  PetscCall(VirtualEnd(&all, part->file, "/mesh/cells_mixed"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A table that grows by a row with each step */
static PetscErrorCode CreateStepTable(hid_t steps, const char *path, hid_t type, int dimensions)
{
  const hsize_t size[2] = {0, 1}, most[2] = {H5S_UNLIMITED, 1}, chunk[2] = {STEPS_CHUNK, 1};
  hid_t         space, properties, links, data;

  PetscFunctionBeginUser;
  PetscCall(LinkProperties(&links));
  CallHDF5(space = H5Screate_simple(dimensions, size, most));
  CallHDF5(properties = H5Pcreate(H5P_DATASET_CREATE));
  CallHDF5(H5Pset_chunk(properties, dimensions, chunk));
  CallHDF5(data = H5Dcreate2(steps, path, type, space, links, properties, H5P_DEFAULT));
  CallHDF5(H5Dclose(data));
  CallHDF5(H5Pclose(properties));
  CallHDF5(H5Sclose(space));
  CallHDF5(H5Pclose(links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes everything that does not depend on the steps. */
static PetscErrorCode CreatePart(Part *part)
{
  static const char kind[]     = "UnstructuredGrid";
  const int64_t     version[2] = {2, 0}, counts[3] = {(int64_t)part->points, (int64_t)part->cells, (int64_t)part->ids};
  hid_t             steps;

  PetscFunctionBeginUser;
  CallHDF5(part->vtk = H5Gcreate2(part->file, "/VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(Hdf5WriteAttribute(part->vtk, "Version", H5T_NATIVE_INT64, 2, version));
  PetscCall(Hdf5WriteText(part->vtk, "Type", kind));
  PetscCall(WriteValues(part->vtk, "NumberOfPoints", H5T_NATIVE_INT64, 1, &counts[0]));
  PetscCall(WriteValues(part->vtk, "NumberOfCells", H5T_NATIVE_INT64, 1, &counts[1]));
  PetscCall(WriteValues(part->vtk, "NumberOfConnectivityIds", H5T_NATIVE_INT64, 1, &counts[2]));
  PetscCall(LinkPoints(part));
  PetscCall(LinkConnectivity(part));
  PetscCall(WriteCells(part));
  if (FieldsOneType(part->index) == ELEMENT_TYPES) PetscCall(LinkMixedCells(part));
  CallHDF5(steps = H5Gcreate2(part->vtk, "Steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(CreateStepTable(steps, "Values", H5T_NATIVE_DOUBLE, 1));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(StepTables); k++)
    PetscCall(CreateStepTable(steps, StepTables[k].name, H5T_NATIVE_INT64, StepTables[k].dimensions));
  CallHDF5(H5Gclose(steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives a dataset of the last step the name under which the arrays look for it. */
static PetscErrorCode LinkStep(Part *part, const char *in_step, const char *by_field)
{
  const int step = (int)part->index->n_steps - 1;
  char      from[DATASET_PATH_SIZE], to[DATASET_PATH_SIZE];
  hid_t     links;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(from, sizeof(from), "/steps/%04d/%s", step, in_step));
  PetscCall(PetscSNPrintf(to, sizeof(to), "/by_field/%s/%04d", by_field, step));
  PetscCall(LinkProperties(&links));
  CallHDF5(H5Lcreate_hard(part->file, from, part->file, to, links, H5P_DEFAULT));
  CallHDF5(H5Pclose(links));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the six columns of a tensor of the last step datasets of their own. */
static PetscErrorCode SplitTensor(Part *part, const char *name)
{
  char    from[DATASET_PATH_SIZE], to[DATASET_PATH_SIZE];
  Virtual one;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(from, sizeof(from), "/steps/%04d/%s", (int)part->index->n_steps - 1, name));
  for (int i = 0; i < 6; i++) {
    PetscCall(PetscSNPrintf(to, sizeof(to), "%s_%s", from, TensorComponents[i]));
    PetscCall(VirtualBegin(&one, H5T_NATIVE_DOUBLE, (hsize_t)part->index->nodes, 1));
    PetscCall(VirtualAdd(&one, from, (hsize_t)part->index->nodes, 6, i));
    PetscCall(VirtualEnd(&one, part->file, to));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode LinkLastStep(Part *part)
{
  const FieldsIndex *index = part->index;
  char               name[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  for (int a = 0; a < index->n_arrays; a++) {
    if (!(index->shows[index->n_steps - 1] & 1 << index->arrays[a].kind)) continue;
    PetscCall(LinkStep(part, index->arrays[a].name, index->arrays[a].name));
    if (index->arrays[a].width == 6) PetscCall(SplitTensor(part, index->arrays[a].name));
  }
  for (int b = 0; b < index->n_blocks; b++) {
    if (!index->blocks[b].tool) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "tools/%s/displacement", index->blocks[b].name));
    PetscCall(LinkStep(part, name, name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes an array of the grid over all steps that there is room for: a whole nodal array, or one of its columns. */
static PetscErrorCode CreateArray(Part *part, const FieldsArray *array, int column)
{
  const PetscBool tools = !strcmp(array->name, "displacement") ? PETSC_TRUE : PETSC_FALSE;
  char            path[DATASET_PATH_SIZE], name[DATASET_PATH_SIZE];
  Virtual         all;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "PointData/%s%s%s", array->name, column < 0 ? "" : "_",
                          column < 0 ? "" : TensorComponents[column]));
  if (Exists(part->vtk, name)) CallHDF5(H5Ldelete(part->vtk, name, H5P_DEFAULT));
  PetscCall(VirtualBegin(&all, H5T_NATIVE_DOUBLE, part->room * part->points, column < 0 ? array->width : 1));
  for (hsize_t s = 0; s < part->room; s++) {
    all.at = s * part->points;
    PetscCall(PetscSNPrintf(path, sizeof(path), "/by_field/%s/%04d", array->name, (int)s));
    PetscCall(VirtualAdd(&all, path, (hsize_t)part->index->nodes, array->width, column));
    for (int b = 0; tools && b < part->index->n_blocks; b++) {
      const FieldsBlock *block = &part->index->blocks[b];

      if (!block->tool) continue;
      PetscCall(PetscSNPrintf(path, sizeof(path), "/by_field/tools/%s/displacement/%04d", block->name, (int)s));
      PetscCall(VirtualAdd(&all, path, (hsize_t)block->nodes, 3, -1));
    }
  }
  PetscCall(VirtualEnd(&all, part->vtk, name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the arrays that some step shows and that are not there, and all anew when there is no room left. */
static PetscErrorCode CreateArrays(Part *part, PetscBool anew)
{
  const FieldsIndex *index = part->index;
  PetscInt           shows = 0;
  char               name[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < index->n_steps; s++) shows |= index->shows[s];
  for (int a = 0; a < index->n_arrays; a++) {
    if (!(shows & 1 << index->arrays[a].kind)) continue;
    PetscCall(PetscSNPrintf(name, sizeof(name), "PointData/%s", index->arrays[a].name));
    if (!anew && Exists(part->vtk, name)) continue;
    PetscCall(CreateArray(part, &index->arrays[a], -1));
    for (int i = 0; i < (index->arrays[a].width == 6 ? 6 : 0); i++) PetscCall(CreateArray(part, &index->arrays[a], i));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes room for the last step in the arrays. */
static PetscErrorCode MakeRoom(Part *part)
{
  const hsize_t steps = (hsize_t)part->index->n_steps;
  int64_t       room  = 0;
  hid_t         attribute;

  PetscFunctionBeginUser;
  if (H5Aexists(part->vtk, "room") > 0) {
    CallHDF5(attribute = H5Aopen(part->vtk, "room", H5P_DEFAULT));
    CallHDF5(H5Aread(attribute, H5T_NATIVE_INT64, &room));
    CallHDF5(H5Aclose(attribute));
  }
  part->room = (hsize_t)room;
  if (steps > part->room) {
    part->room = FIRST_STEPS;
    while (part->room < steps) part->room *= MORE_STEPS;
    room = (int64_t)part->room;
    PetscCall(Hdf5WriteAttribute(part->vtk, "room", H5T_NATIVE_INT64, 1, &room));
    PetscCall(CreateArrays(part, PETSC_TRUE));
  } else {
    PetscCall(CreateArrays(part, PETSC_FALSE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sets the rows of a table of steps that are not there yet, each to first + row * step. */
static PetscErrorCode ExtendTable(hid_t steps, const char *path, hsize_t rows, int64_t value, int64_t per_row)
{
  const hsize_t size[2] = {rows, 1}, count[2] = {1, 1};
  hsize_t       now[2] = {0, 1}, start[2] = {0, 0};
  hid_t         data, space, memory;
  int           dimensions;

  PetscFunctionBeginUser;
  CallHDF5(data = H5Dopen2(steps, path, H5P_DEFAULT));
  CallHDF5(space = H5Dget_space(data));
  dimensions = H5Sget_simple_extent_dims(space, now, NULL);
  CallHDF5(H5Sclose(space));
  CallHDF5(H5Dset_extent(data, size));
  CallHDF5(space = H5Dget_space(data));
  CallHDF5(memory = H5Screate_simple(dimensions, count, NULL));
  for (start[0] = now[0]; start[0] < rows; start[0]++) {
    const int64_t entry = value + per_row * (int64_t)start[0];

    CallHDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL));
    CallHDF5(H5Dwrite(data, H5T_NATIVE_INT64, memory, space, H5P_DEFAULT, &entry));
  }
  CallHDF5(H5Sclose(memory));
  CallHDF5(H5Sclose(space));
  CallHDF5(H5Dclose(data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends the offset of each nodal array, for VTK to find the step's rows. */
static PetscErrorCode ExtendOffsets(Part *part, hid_t steps, hsize_t rows)
{
  hid_t      arrays;
  H5G_info_t info;
  char       name[DATASET_PATH_SIZE], path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  if (!Exists(part->vtk, "PointData")) PetscFunctionReturn(PETSC_SUCCESS); /* the scene asks for no field */
  CallHDF5(arrays = H5Gopen2(part->vtk, "PointData", H5P_DEFAULT));
  CallHDF5(H5Gget_info(arrays, &info));
  for (hsize_t k = 0; k < info.nlinks; k++) {
    CallHDF5(H5Lget_name_by_idx(arrays, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof(name), H5P_DEFAULT));
    PetscCall(PetscSNPrintf(path, sizeof(path), "PointDataOffsets/%s", name));
    if (!Exists(steps, path)) PetscCall(CreateStepTable(steps, path, H5T_NATIVE_INT64, 1));
    PetscCall(ExtendTable(steps, path, rows, 0, (int64_t)part->points));
  }
  CallHDF5(H5Gclose(arrays));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Appends load parameters of the steps that the table does not have yet. */
static PetscErrorCode ExtendValues(const FieldsIndex *index, hid_t steps, hsize_t rows)
{
  const double *t = index->t;
  hid_t         data;

  PetscFunctionBeginUser;
  CallHDF5(data = H5Dopen2(steps, "Values", H5P_DEFAULT));
  CallHDF5(H5Dset_extent(data, &rows));
  CallHDF5(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t));
  CallHDF5(H5Dclose(data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the last step to the tables of steps. Its count comes last: a step is there once it is counted. */
static PetscErrorCode CountStep(Part *part)
{
  const int64_t count = part->index->n_steps;
  const hsize_t rows  = (hsize_t)count;
  hid_t         steps;

  PetscFunctionBeginUser;
  CallHDF5(steps = H5Gopen2(part->vtk, "Steps", H5P_DEFAULT));
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(StepTables); k++)
    PetscCall(ExtendTable(steps, StepTables[k].name, rows, StepTables[k].value, 0));
  PetscCall(ExtendOffsets(part, steps, rows));
  PetscCall(ExtendValues(part->index, steps, rows));
  PetscCall(Hdf5WriteAttribute(steps, "NSteps", H5T_NATIVE_INT64, 1, &count));
  CallHDF5(H5Gclose(steps));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  VtkHdfUpdate - adds the last step of results.vtkhdf to the part that VTK reads.

  Not collective

  Input Parameters:
+ index - what the file holds, with the last step
- name  - the file, which must be closed

  Note:
  For one rank. Call it once after each step. Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode VtkHdfUpdate(const FieldsIndex *index, const char *name)
{
  Part part = {.index = index};

  PetscFunctionBeginUser;
  part.file = H5Fopen(name, H5F_ACC_RDWR, H5P_DEFAULT);
  PetscCheck(part.file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "HDF5 could not open %s", name);
  Measure(&part);
  if (Exists(part.file, "/VTKHDF"))
    CallHDF5(part.vtk = H5Gopen2(part.file, "/VTKHDF", H5P_DEFAULT));
  else
    PetscCall(CreatePart(&part));
  PetscCall(LinkLastStep(&part));
  PetscCall(MakeRoom(&part));
  PetscCall(CountStep(&part));
  CallHDF5(H5Gclose(part.vtk));
  CallHDF5(H5Fclose(part.file));
  PetscFunctionReturn(PETSC_SUCCESS);
}
