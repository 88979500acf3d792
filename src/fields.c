#include "fields.h"
#include "results.h"
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#if !defined(H5_HAVE_PARALLEL)
  #error "results.h5 is written by all ranks: PETSc's HDF5 must be a parallel one"
#endif
_Static_assert(sizeof(PetscReal) == sizeof(double), "results.h5 holds doubles");

#define CallHDF5(call) PetscCheck((call) >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "HDF5 could not do %s", #call)

enum { PATH_SIZE = 512 };

/* The rows of one table: this rank's items go to the rows that this rank writes, a contiguous part of the table. */
typedef struct {
  PetscSF  sf; /* leaves: items; roots: rows */
  PetscInt total, first, n;
} Rows;

/* Cells of one body and type: a contiguous part of /mesh/cells_TYPE */
typedef struct {
  PetscInt first, n;
} CellBlock;

struct _n_Fields {
  Model      model;
  Scene      scene;
  char       directory[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN];
  PetscInt  *owned; /* local nodes that this rank owns */
  Rows       nodes;
  int        n_pairs;
  Rows      *pairs;  /* slave nodes, per contact pair */
  CellBlock *blocks; /* [body * ELEMENT_TYPES + type] */
  int        n_keys;
  PetscInt   cells[ELEMENT_TYPES]; /* rows of /mesh/cells_TYPE */
  PetscInt   n_written, room;
  PetscReal *t; /* of the written steps */
};

/* What a step may hold, as ParaView sees it: columns of /steps/0000/NAME */
enum { SHOW_DISPLACEMENT, SHOW_STRESS, SHOW_CONTACT };
typedef struct {
  const char *title, *dataset;
  int         kind, width, column; /* column -1: all of them, as a vector or a scalar */
} Shown;
/* Stress goes to ParaView by components: readers do not agree on the order of a symmetric tensor. */
static const Shown shown[] = {
  {"displacement", "displacement", SHOW_DISPLACEMENT, 3, -1},
  {"von_mises",    "von_mises",    SHOW_STRESS,       1, -1},
  {"stress_xx",    "stress",       SHOW_STRESS,       6, 0 },
  {"stress_yy",    "stress",       SHOW_STRESS,       6, 1 },
  {"stress_zz",    "stress",       SHOW_STRESS,       6, 2 },
  {"stress_xy",    "stress",       SHOW_STRESS,       6, 3 },
  {"stress_yz",    "stress",       SHOW_STRESS,       6, 4 },
  {"stress_xz",    "stress",       SHOW_STRESS,       6, 5 },
  {"gap",          "gap",          SHOW_CONTACT,      1, -1},
  {"penetration",  "penetration",  SHOW_CONTACT,      1, -1},
  {"penalty",      "penalty",      SHOW_CONTACT,      1, -1},
  {"pressure",     "pressure",     SHOW_CONTACT,      1, -1},
  {"normal",       "normal",       SHOW_CONTACT,      3, -1},
};

/* Contact values of one node: columns of the nodal array that FieldsWriteContact() forms */
enum { COLUMN_GAP, COLUMN_PENETRATION, COLUMN_PENALTY, COLUMN_PRESSURE, COLUMN_NORMAL, COLUMN_PRESENT = COLUMN_NORMAL + 3, COLUMNS };
static const struct {
  const char *name;
  int         column, width;
  PetscReal   absent; /* value off the slave surfaces */
} contact_fields[] = {
  {"gap",         COLUMN_GAP,         1, NAN},
  {"penetration", COLUMN_PENETRATION, 1, 0.0},
  {"penalty",     COLUMN_PENALTY,     1, NAN},
  {"pressure",    COLUMN_PRESSURE,    1, 0.0},
  {"normal",      COLUMN_NORMAL,      3, 0.0},
};
#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

static const char *const xdmf_topology[ELEMENT_TYPES] = {
  [ELEMENT_TRI3] = "Triangle",    [ELEMENT_TRI6] = "Triangle_6",      [ELEMENT_QUAD4] = "Quadrilateral", [ELEMENT_QUAD9] = "Quadrilateral_9",
  [ELEMENT_TET4] = "Tetrahedron", [ELEMENT_TET10] = "Tetrahedron_10", [ELEMENT_HEX8] = "Hexahedron",     [ELEMENT_HEX27] = "Hexahedron_27",
};

static PetscErrorCode RowsCreate(MPI_Comm comm, PetscInt total, PetscInt n, const PetscInt *row, Rows *rows)
{
  PetscLayout layout;

  PetscFunctionBeginUser;
  PetscCall(PetscLayoutCreate(comm, &layout));
  PetscCall(PetscLayoutSetSize(layout, total));
  PetscCall(PetscLayoutSetUp(layout));
  PetscCall(PetscLayoutGetLocalSize(layout, &rows->n));
  PetscCall(PetscLayoutGetRange(layout, &rows->first, NULL));
  rows->total = total;
  PetscCall(PetscSFCreate(comm, &rows->sf));
  PetscCall(PetscSFSetGraphLayout(rows->sf, layout, n, NULL, PETSC_COPY_VALUES, row));
  PetscCall(PetscLayoutDestroy(&layout));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Brings items (width values of a type each) to the ranks that write their rows. */
static PetscErrorCode RowsCollect(const Rows *rows, int width, MPI_Datatype type, const void *items, void *values)
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Type_contiguous(width, type, &unit));
  PetscCallMPI(MPI_Type_commit(&unit));
  PetscCall(PetscSFReduceBegin(rows->sf, unit, items, values, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(rows->sf, unit, items, values, MPI_REPLACE));
  PetscCallMPI(MPI_Type_free(&unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes the dataset `path` with the groups above it; every rank writes its part. values: [rows->n * width] */
static PetscErrorCode FileWriteRows(hid_t file, const char *path, const Rows *rows, int width, hid_t type, const void *values)
{
  const hsize_t size[2] = {(hsize_t)rows->total, (hsize_t)width}, first[2] = {(hsize_t)rows->first, 0}, n[2] = {(hsize_t)rows->n, (hsize_t)width};
  const int     rank = width > 1 ? 2 : 1;
  hid_t         space, memory, links, transfer, data;

  PetscFunctionBeginUser;
  CallHDF5(space = H5Screate_simple(rank, size, NULL));
  CallHDF5(memory = H5Screate_simple(rank, n, NULL));
  CallHDF5(H5Sselect_hyperslab(space, H5S_SELECT_SET, first, NULL, n, NULL));
  if (!rows->n) {
    CallHDF5(H5Sselect_none(space));
    CallHDF5(H5Sselect_none(memory));
  }
  CallHDF5(links = H5Pcreate(H5P_LINK_CREATE));
  CallHDF5(H5Pset_create_intermediate_group(links, 1));
  CallHDF5(data = H5Dcreate2(file, path, type, space, links, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(transfer = H5Pcreate(H5P_DATASET_XFER));
  CallHDF5(H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE));
  CallHDF5(H5Dwrite(data, type, memory, space, transfer, values));
  CallHDF5(H5Dclose(data));
  CallHDF5(H5Pclose(transfer));
  CallHDF5(H5Pclose(links));
  CallHDF5(H5Sclose(memory));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FileWriteReals(hid_t file, const char *path, const Rows *rows, int width, const PetscReal *items)
{
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n * width, &values));
  PetscCall(RowsCollect(rows, width, MPIU_REAL, items, values));
  PetscCall(FileWriteRows(file, path, rows, width, H5T_NATIVE_DOUBLE, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FileWriteIntegers(hid_t file, const char *path, const Rows *rows, int width, const int64_t *items)
{
  int64_t *values;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(rows->n * width, &values));
  PetscCall(RowsCollect(rows, width, MPI_INT64_T, items, values));
  PetscCall(FileWriteRows(file, path, rows, width, H5T_NATIVE_INT64, values));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FileWriteAttribute(hid_t object, const char *name, hid_t type, const void *value)
{
  hid_t space, attribute;

  PetscFunctionBeginUser;
  CallHDF5(space = H5Screate(H5S_SCALAR));
  CallHDF5(attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  CallHDF5(H5Awrite(attribute, type, value));
  CallHDF5(H5Aclose(attribute));
  CallHDF5(H5Sclose(space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool FieldsShows(Fields fields, int kind)
{
  switch (kind) {
  case SHOW_DISPLACEMENT: return fields->scene->output.displacement ? PETSC_TRUE : PETSC_FALSE;
  case SHOW_STRESS: return fields->scene->output.stress ? PETSC_TRUE : PETSC_FALSE;
  default: return fields->scene->output.contact && fields->model->contact ? PETSC_TRUE : PETSC_FALSE;
  }
}

/* The file is opened for one step at a time: a run that is killed between two steps leaves a closed file. */
static PetscErrorCode FieldsOpenFile(Fields fields, hid_t *file)
{
  hid_t access;

  PetscFunctionBeginUser;
  CallHDF5(access = H5Pcreate(H5P_FILE_ACCESS));
  CallHDF5(H5Pset_fapl_mpio(access, fields->model->mesh->comm, MPI_INFO_NULL));
  *file = fields->n_written ? H5Fopen(fields->file, H5F_ACC_RDWR, access) : H5Fcreate(fields->file, H5F_ACC_TRUNC, H5P_DEFAULT, access);
  PetscCheck(*file >= 0, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "HDF5 could not open %s for writing", fields->file);
  CallHDF5(H5Pclose(access));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteNodes(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *items;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_owned * 3, &items));
  for (PetscInt k = 0; k < mesh->n_owned; k++)
    for (int i = 0; i < mesh->dim; i++) items[k * 3 + i] = mesh->coords[fields->owned[k] * mesh->dim + i] + mesh->centre[i];
  PetscCall(FileWriteReals(file, "/mesh/nodes", &fields->nodes, 3, items));
  PetscCall(PetscFree(items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The row of every local cell in the table of its type, by body and then cell_id. All ranks count their part of the cell_ids by body and type. */
static PetscErrorCode FieldsNumberCells(Fields fields, PetscInt *row)
{
  const Mesh mesh = fields->model->mesh;
  PetscInt  *key, *keys, *rows, *count, *before;
  Rows       by_id;

  PetscFunctionBeginUser;
  PetscCall(RowsCreate(mesh->comm, mesh->n_cells_global, mesh->n_cells, mesh->cell_id, &by_id));
  PetscCall(PetscMalloc3(mesh->n_cells, &key, by_id.n, &keys, by_id.n, &rows));
  PetscCall(PetscCalloc2(fields->n_keys, &count, fields->n_keys, &before));
  for (PetscInt c = 0; c < mesh->n_cells; c++) key[c] = mesh->cell_body[c] * ELEMENT_TYPES + mesh->cell_type[c];
  PetscCall(RowsCollect(&by_id, 1, MPIU_INT, key, keys));
  for (PetscInt c = 0; c < by_id.n; c++) count[keys[c]]++;
  PetscCallMPI(MPI_Exscan(count, before, fields->n_keys, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, fields->n_keys, MPIU_INT, MPI_SUM, mesh->comm));
  for (int k = 0; k < fields->n_keys; k++) {
    PetscInt *cells = &fields->cells[k % ELEMENT_TYPES];

    fields->blocks[k] = (CellBlock){.first = *cells, .n = count[k]};
    *cells += count[k];
    before[k] += fields->blocks[k].first;
  }
  for (PetscInt c = 0; c < by_id.n; c++) rows[c] = before[keys[c]]++;
  PetscCall(PetscSFBcastBegin(by_id.sf, MPIU_INT, rows, row, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(by_id.sf, MPIU_INT, rows, row, MPI_REPLACE));
  PetscCall(PetscFree2(count, before));
  PetscCall(PetscFree3(key, keys, rows));
  PetscCall(PetscSFDestroy(&by_id.sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteCellsOfType(Fields fields, hid_t file, ElementType type, const PetscInt *cell_row)
{
  const Mesh     mesh    = fields->model->mesh;
  const Element *element = ElementGet(type);
  const int      nodes   = element->nodes;
  int64_t       *ids, *body;
  PetscInt      *row, n = 0;
  char           path[PATH_SIZE];
  Rows           rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(mesh->n_cells * nodes, &ids, mesh->n_cells, &body, mesh->n_cells, &row));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_type[c] != type) continue;
    for (int i = 0; i < nodes; i++) ids[n * nodes + i] = mesh->node_id[mesh->cell_nodes[mesh->cell_ptr[c] + element->xdmf_order[i]]];
    body[n]  = mesh->cell_body[c];
    row[n++] = cell_row[c];
  }
  PetscCall(RowsCreate(mesh->comm, fields->cells[type], n, row, &rows));
  PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/cells_%s", element->name));
  PetscCall(FileWriteIntegers(file, path, &rows, nodes, ids));
  PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/cells_%s_body", element->name));
  PetscCall(FileWriteIntegers(file, path, &rows, 1, body));
  PetscCall(PetscSFDestroy(&rows.sf));
  PetscCall(PetscFree3(ids, body, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteCells(Fields fields, hid_t file)
{
  PetscInt *row;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fields->model->mesh->n_cells, &row));
  PetscCall(FieldsNumberCells(fields, row));
  for (int type = 0; type < ELEMENT_TYPES; type++)
    if (fields->cells[type]) PetscCall(FieldsWriteCellsOfType(fields, file, (ElementType)type, row));
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rows of a pair's slave nodes, ascending by id. Every rank sees all ids: slave surfaces are small beside the mesh. */
static PetscErrorCode FieldsWriteSlaveNodes(Fields fields, hid_t file, int pair)
{
  const Mesh   mesh = fields->model->mesh;
  ContactNodes slaves;
  PetscInt    *row, *all;
  int64_t     *ids;
  PetscMPIInt  size, n, total = 0, *counts, *starts;
  char         path[PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(ContactGetNodes(fields->model->contact, pair, fields->model->u, &slaves));
  PetscCallMPI(MPI_Comm_size(mesh->comm, &size));
  PetscCall(PetscMPIIntCast(slaves.n, &n));
  PetscCall(PetscMalloc4(slaves.n, &row, slaves.n, &ids, size, &counts, size, &starts));
  for (PetscInt k = 0; k < slaves.n; k++) ids[k] = row[k] = mesh->node_id[slaves.node[k]];
  PetscCallMPI(MPI_Allgather(&n, 1, MPI_INT, counts, 1, MPI_INT, mesh->comm));
  for (PetscMPIInt r = 0; r < size; r++) {
    starts[r] = total;
    total += counts[r];
  }
  PetscCall(PetscMalloc1(total, &all));
  PetscCallMPI(MPI_Allgatherv(row, n, MPIU_INT, all, counts, starts, MPIU_INT, mesh->comm));
  PetscCall(PetscSortInt(total, all));
  for (PetscInt k = 0; k < slaves.n; k++) PetscCall(PetscFindInt(row[k], total, all, &row[k]));
  PetscCall(RowsCreate(mesh->comm, total, slaves.n, row, &fields->pairs[pair]));
  PetscCall(PetscSNPrintf(path, sizeof(path), "/contact/%s/nodes", ContactPairName(fields->model->contact, pair)));
  PetscCall(FileWriteIntegers(file, path, &fields->pairs[pair], 1, ids));
  PetscCall(PetscFree(all));
  PetscCall(PetscFree4(row, ids, counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything that does not change from step to step */
static PetscErrorCode FieldsWriteMesh(Fields fields, hid_t file)
{
  PetscFunctionBeginUser;
  PetscCall(FieldsWriteNodes(fields, file));
  PetscCall(FieldsWriteCells(fields, file));
  if (FieldsShows(fields, SHOW_CONTACT))
    for (int p = 0; p < fields->n_pairs; p++) PetscCall(FieldsWriteSlaveNodes(fields, file, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns first .. first+width-1 of a nodal array (stride columns, local nodes) as one dataset */
static PetscErrorCode FieldsWriteNodal(Fields fields, hid_t file, const char *name, const PetscReal *values, int stride, int first, int width)
{
  const PetscInt n = fields->model->mesh->n_owned;
  PetscReal     *items;
  char           path[PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * width, &items));
  for (PetscInt k = 0; k < n; k++)
    for (int i = 0; i < width; i++) items[k * width + i] = values[fields->owned[k] * stride + first + i];
  PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d/%s", (int)fields->n_written, name));
  PetscCall(FileWriteReals(file, path, &fields->nodes, width, items));
  PetscCall(PetscFree(items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteDisplacement(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *u;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * 3, &u));
  for (PetscInt n = 0; n < mesh->n_nodes; n++)
    for (int i = 0; i < mesh->dim; i++) u[n * 3 + i] = fields->model->u[n * mesh->dim + i];
  PetscCall(FieldsWriteNodal(fields, file, "displacement", u, 3, 0, 3));
  PetscCall(PetscFree(u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal VonMises(const PetscReal s[6])
{
  return PetscSqrtReal(0.5 * (PetscSqr(s[0] - s[1]) + PetscSqr(s[1] - s[2]) + PetscSqr(s[2] - s[0])) +
                       3.0 * (PetscSqr(s[3]) + PetscSqr(s[4]) + PetscSqr(s[5])));
}

static PetscErrorCode FieldsWriteStress(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *stress, *weight, *equivalent;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(mesh->n_nodes * 6, &stress, mesh->n_nodes, &weight, mesh->n_nodes, &equivalent));
  PetscCall(ElasticityNodalStress(fields->model->elasticity, fields->model->u, stress, weight));
  PetscCall(MeshSumNodes(mesh, 6, stress));
  PetscCall(MeshSumNodes(mesh, 1, weight));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    for (int i = 0; i < 6; i++) stress[n * 6 + i] /= weight[n];
    equivalent[n] = VonMises(&stress[n * 6]);
  }
  PetscCall(FieldsWriteNodal(fields, file, "stress", stress, 6, 0, 6));
  PetscCall(FieldsWriteNodal(fields, file, "von_mises", equivalent, 1, 0, 1));
  PetscCall(PetscFree3(stress, weight, equivalent));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One pair's tables; its values also go to the nodal array (COLUMNS per local node, owned nodes only). Where pairs share a slave node
   the larger pressure counts. */
static PetscErrorCode FieldsWritePair(Fields fields, hid_t file, int pair, PetscReal *nodal)
{
  ContactNodes slaves;
  PetscReal   *values, *items;
  char         path[PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(ContactGetNodes(fields->model->contact, pair, fields->model->u, &slaves));
  PetscCall(PetscMalloc2(slaves.n * COLUMNS, &values, slaves.n * 3, &items));
  for (PetscInt k = 0; k < slaves.n; k++) {
    PetscReal *value = &values[k * COLUMNS], *node = &nodal[slaves.node[k] * COLUMNS];

    value[COLUMN_GAP]         = slaves.gap[k];
    value[COLUMN_PENETRATION] = slaves.gap[k] < 0.0 ? -slaves.gap[k] : 0.0;
    value[COLUMN_PENALTY]     = slaves.penalty[k];
    value[COLUMN_PRESSURE]    = slaves.pressure[k];
    for (int i = 0; i < 3; i++) value[COLUMN_NORMAL + i] = slaves.normal[k * 3 + i];
    value[COLUMN_PRESENT] = 1.0;
    if (node[COLUMN_PRESENT] == 0.0 || value[COLUMN_PRESSURE] > node[COLUMN_PRESSURE]) PetscCall(PetscArraycpy(node, value, COLUMNS));
  }
  for (int f = 0; f < COUNT(contact_fields); f++) {
    const int width = contact_fields[f].width;

    for (PetscInt k = 0; k < slaves.n; k++)
      for (int i = 0; i < width; i++) items[k * width + i] = values[k * COLUMNS + contact_fields[f].column + i];
    PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d/contact/%s/%s", (int)fields->n_written, ContactPairName(fields->model->contact, pair),
                            contact_fields[f].name));
    PetscCall(FileWriteReals(file, path, &fields->pairs[pair], width, items));
  }
  PetscCall(PetscFree2(values, items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Corners of a slave surface's second-order triangles carry no area, so they have no contact values of their own: for the eye they get the
   mean of the mid-side nodes beside them. nodal: complete on every copy of a node. */
static PetscErrorCode FieldsFillCorners(Fields fields, int pair, const PetscReal *nodal, PetscReal *fill)
{
  const Mesh       mesh = fields->model->mesh;
  const MeshGroup *slave;
  PetscReal        face_size;
  PetscInt         nodes[FACE_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(ContactPairSurface(fields->model->contact, pair, &slave, &face_size));
  for (PetscInt f = 0; f < slave->n_faces; f++) {
    const Element *face = ElementGet(MeshFaceNodes(mesh, slave, f, nodes));

    for (int e = 0; e < (face->order == 2 ? face->edges : 0); e++) {
      const PetscReal *middle = &nodal[nodes[face->corners + e] * COLUMNS];

      for (int end = 0; end < 2; end++) {
        const PetscInt corner = nodes[face->edge_corners[e][end]];

        if (nodal[corner * COLUMNS + COLUMN_PRESENT] == 0.0)
          for (int i = 0; i < COLUMNS; i++) fill[corner * COLUMNS + i] += middle[i];
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteContact(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *nodal, *fill;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes * COLUMNS, &nodal, mesh->n_nodes * COLUMNS, &fill));
  for (int p = 0; p < fields->n_pairs; p++) PetscCall(FieldsWritePair(fields, file, p, nodal));
  PetscCall(MeshSumNodes(mesh, COLUMNS, nodal));
  for (int p = 0; p < fields->n_pairs; p++) PetscCall(FieldsFillCorners(fields, p, nodal, fill));
  PetscCall(MeshSumNodes(mesh, COLUMNS, fill));
  for (PetscInt n = 0; n < mesh->n_nodes; n++) {
    PetscReal      *value  = &nodal[n * COLUMNS];
    const PetscReal weight = fill[n * COLUMNS + COLUMN_PRESENT];

    if (value[COLUMN_PRESENT] > 0.0) continue;
    for (int f = 0; f < COUNT(contact_fields); f++)
      for (int i = contact_fields[f].column; i < contact_fields[f].column + contact_fields[f].width; i++)
        value[i] = weight > 0.0 ? fill[n * COLUMNS + i] / weight : contact_fields[f].absent;
  }
  for (int f = 0; f < COUNT(contact_fields); f++)
    PetscCall(FieldsWriteNodal(fields, file, contact_fields[f].name, nodal, COLUMNS, contact_fields[f].column, contact_fields[f].width));
  PetscCall(PetscFree2(nodal, fill));
  PetscFunctionReturn(PETSC_SUCCESS);
}

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

/* Rows first .. first+n-1 and columns column .. column+width-1 of a dataset of total x stride values */
static void XdmfPrintSlab(FILE *out, const char *type, PetscInt first, PetscInt n, int column, int width, PetscInt total, int stride, const char *path)
{
  fprintf(out, "<DataItem ItemType=\"HyperSlab\" Dimensions=\"%lld %d\">", (long long)n, width);
  fprintf(out, "<DataItem Dimensions=\"3 2\" Format=\"XML\">%lld %d 1 1 %lld %d</DataItem>", (long long)first, column, (long long)n, width);
  fprintf(out, "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"8\" Dimensions=\"%lld %d\">results.h5:%s</DataItem></DataItem>", type, (long long)total,
          stride, path);
}

static void XdmfPrintNodal(FILE *out, PetscInt n, int width, const char *path)
{
  fprintf(out, "<DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"%lld", (long long)n);
  if (width > 1) fprintf(out, " %d", width);
  fprintf(out, "\">results.h5:%s</DataItem>", path);
}

static void XdmfPrintAttribute(FILE *out, const Shown *show, PetscInt n, PetscInt step)
{
  char path[PATH_SIZE];

  snprintf(path, sizeof(path), "/steps/%04d/%s", (int)step, show->dataset);
  fprintf(out, "    <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"Node\">", show->title, show->column < 0 && show->width == 3 ? "Vector" : "Scalar");
  if (show->column < 0)
    XdmfPrintNodal(out, n, show->width, path);
  else
    XdmfPrintSlab(out, "Float", 0, n, show->column, 1, n, show->width, path);
  fprintf(out, "</Attribute>\n");
}

/* One body's cells of one type at one step */
static void XdmfPrintGrid(Fields fields, FILE *out, int key, PetscInt step)
{
  const CellBlock *block   = &fields->blocks[key];
  const int        type    = key % ELEMENT_TYPES;
  const Element   *element = ElementGet((ElementType)type);
  char             path[PATH_SIZE];

  fprintf(out, "   <Grid Name=\"");
  XdmfPrintText(out, fields->scene->bodies[key / ELEMENT_TYPES].name);
  fprintf(out, " %s\">\n    <Topology TopologyType=\"%s\" NumberOfElements=\"%lld\">", element->name, xdmf_topology[type], (long long)block->n);
  snprintf(path, sizeof(path), "/mesh/cells_%s", element->name);
  XdmfPrintSlab(out, "Int", block->first, block->n, 0, element->nodes, fields->cells[type], element->nodes, path);
  fprintf(out, "</Topology>\n    <Geometry GeometryType=\"XYZ\">");
  XdmfPrintNodal(out, fields->nodes.total, 3, "/mesh/nodes");
  fprintf(out, "</Geometry>\n");
  for (int i = 0; i < COUNT(shown); i++)
    if (FieldsShows(fields, shown[i].kind)) XdmfPrintAttribute(out, &shown[i], fields->nodes.total, step);
  fprintf(out, "   </Grid>\n");
}

/* Rank 0 writes the text for all steps so far. Not collective. */
static PetscErrorCode FieldsWriteXdmf(Fields fields)
{
  char  *text;
  size_t size;
  FILE  *out = open_memstream(&text, &size);

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for results.xdmf");
  fprintf(out, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n <Grid Name=\"");
  XdmfPrintText(out, fields->scene->name);
  fprintf(out, "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (PetscInt s = 0; s < fields->n_written; s++) {
    fprintf(out, "  <Grid Name=\"%04d\" GridType=\"Collection\" CollectionType=\"Spatial\">\n   <Time Value=\"%.15g\"/>\n", (int)s, (double)fields->t[s]);
    for (int k = 0; k < fields->n_keys; k++)
      if (fields->blocks[k].n) XdmfPrintGrid(fields, out, k, s);
    fprintf(out, "  </Grid>\n");
  }
  fprintf(out, " </Grid>\n</Domain>\n</Xdmf>\n");
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for results.xdmf");
  PetscCall(ResultsReplaceFile(fields->directory, "results.xdmf", text));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsRemember(Fields fields, PetscReal t)
{
  PetscFunctionBeginUser;
  if (fields->n_written == fields->room) {
    fields->room = 2 * fields->room + 16;
    PetscCall(PetscRealloc((size_t)fields->room * sizeof(PetscReal), &fields->t));
  }
  fields->t[fields->n_written++] = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  FieldsCreate - Prepares results.h5 and results.xdmf in a directory; no file is touched yet. Collective.

  Input: model (its elasticity, contact and displacements are read at each write), scene (output.fields chooses), directory (must exist at the first write).
*/
PetscErrorCode FieldsCreate(Model model, Scene scene, const char *directory, Fields *result)
{
  const Mesh  mesh = model->mesh;
  Fields      fields;
  PetscMPIInt rank;
  PetscInt   *id, n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&fields));
  fields->model = model;
  fields->scene = scene;
  PetscCall(PetscStrncpy(fields->directory, directory, sizeof(fields->directory)));
  PetscCall(PetscSNPrintf(fields->file, sizeof(fields->file), "%s/results.h5", directory));
  fields->n_keys = scene->n_bodies * ELEMENT_TYPES;
  PetscCall(PetscCalloc1(fields->n_keys, &fields->blocks));
  fields->n_pairs = model->contact ? ContactPairs(model->contact) : 0;
  PetscCall(PetscCalloc1(fields->n_pairs, &fields->pairs));
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(mesh->n_owned, &fields->owned));
  PetscCall(PetscMalloc1(mesh->n_owned, &id));
  for (PetscInt k = 0; k < mesh->n_nodes; k++) {
    if (mesh->node_owner[k] != rank) continue;
    fields->owned[n] = k;
    id[n++]          = mesh->node_id[k];
  }
  PetscCall(RowsCreate(mesh->comm, mesh->n_global, n, id, &fields->nodes));
  PetscCall(PetscFree(id));
  *result = fields;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* FieldsDestroy - Frees the fields; the files stay. Collective. */
PetscErrorCode FieldsDestroy(Fields *fields)
{
  PetscFunctionBeginUser;
  if (!*fields) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < (*fields)->n_pairs; p++) PetscCall(PetscSFDestroy(&(*fields)->pairs[p].sf));
  PetscCall(PetscSFDestroy(&(*fields)->nodes.sf));
  PetscCall(PetscFree((*fields)->owned));
  PetscCall(PetscFree((*fields)->pairs));
  PetscCall(PetscFree((*fields)->blocks));
  PetscCall(PetscFree((*fields)->t));
  PetscCall(PetscFree(*fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  FieldsWrite - Adds the model's present state to results.h5 and writes results.xdmf anew. Collective.

  Input: step (number of the accepted step), t (load parameter). Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
*/
PetscErrorCode FieldsWrite(Fields fields, PetscInt step, PetscReal t)
{
  const int64_t number = step;
  PetscMPIInt   rank;
  char          path[PATH_SIZE];
  hid_t         file, group;

  PetscFunctionBeginUser;
  PetscCall(FieldsOpenFile(fields, &file));
  if (!fields->n_written) {
    PetscCall(FieldsWriteMesh(fields, file));
    CallHDF5(group = H5Gcreate2(file, "/steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    CallHDF5(H5Gclose(group));
  }
  PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d", (int)fields->n_written));
  CallHDF5(group = H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(FileWriteAttribute(group, "t", H5T_NATIVE_DOUBLE, &t));
  PetscCall(FileWriteAttribute(group, "step", H5T_NATIVE_INT64, &number));
  CallHDF5(H5Gclose(group));
  if (FieldsShows(fields, SHOW_DISPLACEMENT)) PetscCall(FieldsWriteDisplacement(fields, file));
  if (FieldsShows(fields, SHOW_STRESS)) PetscCall(FieldsWriteStress(fields, file));
  if (FieldsShows(fields, SHOW_CONTACT)) PetscCall(FieldsWriteContact(fields, file));
  CallHDF5(H5Fclose(file));
  PetscCall(FieldsRemember(fields, t));
  PetscCallMPI(MPI_Comm_rank(fields->model->mesh->comm, &rank));
  if (rank == 0) PetscCall(FieldsWriteXdmf(fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}
