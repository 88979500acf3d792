/* The states of a run in results.vtkhdf, see fields.h. */
#include "fields.h"
#include "files/fileimage.h"
#include "files/hdf5table.h"
#include "kernels/pointstrain.h"
#include "scene/stepcolumns.h"
#include "toolshapes.h"
#include "vtkhdf.h"
#include "xdmf.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

/* The file of the states */
#define FIELDS_FILE "results.vtkhdf"

struct _n_Fields {
  Model       model;
  Scene       scene;
  char        directory[PETSC_MAX_PATH_LEN], file[PETSC_MAX_PATH_LEN];
  PetscInt   *owned; /* local nodes that this rank owns */
  Hdf5Table   nodes;
  int         n_pairs;
  Hdf5Table  *pairs;                /* slave nodes, per contact pair */
  PetscInt    cells[ELEMENT_TYPES]; /* rows of /mesh/cells_TYPE */
  PetscInt    n_written, room;
  PetscReal  *t;     /* of the written steps */
  PetscInt   *shows; /* what they hold: bits by kind; a restart may change it */
  FieldsIndex index; /* what they hold, for the views of the file */
  ToolShapes  tools;
  char       *image; /* rank 0: image of the file, between loading and FieldsResume() */
};

/* What output.fields may ask for, and what ParaView sees of it */
enum {
  SHOW_DISPLACEMENT,
  SHOW_STRESS,
  SHOW_CONTACT,
  SHOW_SOLID_PRESSURE,
  SHOW_PLASTIC,
  SHOW_FRICTION,
  SHOW_PRINCIPAL,
  SHOW_STRAIN,
  SHOW_KINDS
};
static const FieldsArray shown[] = {
  {"displacement", 3, SHOW_DISPLACEMENT},
  {"von_mises", 1, SHOW_STRESS},
  {"stress", 6, SHOW_STRESS},
  {"plastic_strain", 1, SHOW_PLASTIC},
  {"plastic_strain_tensor", 6, SHOW_PLASTIC},
  {"gap", 1, SHOW_CONTACT},
  {"penetration", 1, SHOW_CONTACT},
  {"penalty", 1, SHOW_CONTACT},
  {"pressure", 1, SHOW_CONTACT},
  {"normal", 3, SHOW_CONTACT},
  {"traction", 3, SHOW_FRICTION},
  {"slip", 1, SHOW_FRICTION},
  {"friction", 1, SHOW_FRICTION},
  {"solid_pressure", 1, SHOW_SOLID_PRESSURE},
  {"contact_traction", 3, SHOW_CONTACT},
  {"status", 1, SHOW_CONTACT},
  {"principal_stress", 3, SHOW_PRINCIPAL},
  {"principal_direction_1", 3, SHOW_PRINCIPAL},
  {"principal_direction_2", 3, SHOW_PRINCIPAL},
  {"principal_direction_3", 3, SHOW_PRINCIPAL},
  {"strain", 6, SHOW_STRAIN},
  {"energy_density", 1, SHOW_STRAIN},
};

/* Contact values of one node: columns of the nodal array that FieldsWriteContact() forms */
enum {
  COLUMN_GAP,
  COLUMN_PENETRATION,
  COLUMN_PENALTY,
  COLUMN_PRESSURE,
  COLUMN_NORMAL,
  COLUMN_WHOLE  = COLUMN_NORMAL + 3,
  COLUMN_STATUS = COLUMN_WHOLE + 3,
  COLUMN_TRACTION,
  COLUMN_SLIP = COLUMN_TRACTION + 3,
  COLUMN_FRICTION,
  COLUMN_PRESENT,
  COLUMNS
};
static const struct {
  const char *name;
  int         column, width;
  PetscReal   absent; /* value off the slave surfaces */
} contact_fields[] = {
  {"gap", COLUMN_GAP, 1, NAN},         {"penetration", COLUMN_PENETRATION, 1, 0.0},
  {"penalty", COLUMN_PENALTY, 1, NAN}, {"pressure", COLUMN_PRESSURE, 1, 0.0},
  {"normal", COLUMN_NORMAL, 3, 0.0},   {"contact_traction", COLUMN_WHOLE, 3, 0.0},
  {"status", COLUMN_STATUS, 1, 0.0},   {"traction", COLUMN_TRACTION, 3, 0.0},
  {"slip", COLUMN_SLIP, 1, 0.0},       {"friction", COLUMN_FRICTION, 1, 0.0},
};
/* The last ones of these, which only scenes with friction have */
enum { FRICTION_FIELDS = 3 };
#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

static PetscBool FieldsShows(Fields fields, int kind)
{
  switch (kind) {
  case SHOW_DISPLACEMENT: return fields->scene->output.displacement ? PETSC_TRUE : PETSC_FALSE;
  case SHOW_STRESS: return fields->scene->output.stress ? PETSC_TRUE : PETSC_FALSE;
  case SHOW_PLASTIC: return fields->scene->output.stress && SceneIsPlastic(fields->scene) ? PETSC_TRUE : PETSC_FALSE;
  case SHOW_PRINCIPAL: return (PetscBool)fields->scene->output.principal;
  case SHOW_STRAIN: return (PetscBool)fields->scene->output.strain;
  case SHOW_FRICTION: return (PetscBool)(fields->scene->output.contact && ContactHasFriction(fields->model->contact));
  case SHOW_SOLID_PRESSURE:
    return (PetscBool)(fields->scene->output.stress &&
                       ProblemHasFormulation(fields->model->problem, FORMULATION_MIXED));
  default: return fields->scene->output.contact && fields->model->contact ? PETSC_TRUE : PETSC_FALSE;
  }
}

/* Opens the file for one step. A run that is killed between two steps then leaves a closed file. */
static PetscErrorCode FieldsOpenFile(Fields fields, hid_t *file)
{
  PetscFunctionBeginUser;
  if (fields->n_written)
    PetscCall(Hdf5TableOpenFile(fields->model->mesh->comm, fields->file, H5F_ACC_RDWR, file));
  else
    PetscCall(Hdf5TableCreateFile(fields->model->mesh->comm, fields->file, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteNodes(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *items;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_body_owned * 3, &items));
  for (PetscInt k = 0; k < mesh->n_body_owned; k++)
    for (int i = 0; i < mesh->dim; i++)
      items[k * 3 + i] = mesh->coords[fields->owned[k] * mesh->dim + i] + mesh->centre[i];
  PetscCall(Hdf5TableWriteReals(file, "/mesh/nodes", &fields->nodes, 3, items));
  PetscCall(PetscFree(items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the rigid tools to the list of what the file holds. */
static void FieldsListTools(Fields fields)
{
  FieldsIndex *index = &fields->index;

  for (int s = 0; s < fields->tools.n; s++) {
    const ToolShape *shape = &fields->tools.shape[s];

    index->blocks[index->n_blocks++] = (FieldsBlock){.name   = shape->name,
                                                     .number = shape->number,
                                                     .tool   = PETSC_TRUE,
                                                     .type   = shape->type,
                                                     .n      = shape->n_cells,
                                                     .nodes  = shape->n_nodes};
  }
}

/* Gives the row of every local cell in the table of its type, by body and then cell_id. Each rank counts its part of
   the cell_ids by body and type. */
static PetscErrorCode FieldsNumberCells(Fields fields, PetscInt *row)
{
  const Mesh   mesh   = fields->model->mesh;
  const int    n_keys = fields->scene->n_bodies * ELEMENT_TYPES;
  FieldsIndex *index  = &fields->index;
  PetscInt    *key, *keys, *rows, *count, *before;
  Hdf5Table    by_id;

  PetscFunctionBeginUser;
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_cells_global, mesh->n_cells, mesh->cell_id, &by_id));
  PetscCall(PetscMalloc3(mesh->n_cells, &key, by_id.n, &keys, by_id.n, &rows));
  PetscCall(PetscCalloc2(n_keys, &count, n_keys, &before));
  for (PetscInt c = 0; c < mesh->n_cells; c++) key[c] = mesh->cell_body[c] * ELEMENT_TYPES + mesh->cell_type[c];
  PetscCall(Hdf5TableCollect(&by_id, 1, MPIU_INT, key, keys));
  for (PetscInt c = 0; c < by_id.n; c++) count[keys[c]]++;
  PetscCallMPI(MPI_Exscan(count, before, n_keys, MPIU_INT, MPI_SUM, mesh->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, n_keys, MPIU_INT, MPI_SUM, mesh->comm));
  for (int k = 0; k < n_keys; k++) {
    const ElementType type  = (ElementType)(k % ELEMENT_TYPES);
    PetscInt         *cells = &fields->cells[type];

    if (count[k])
      index->blocks[index->n_blocks++] = (FieldsBlock){.name   = fields->scene->bodies[k / ELEMENT_TYPES].name,
                                                       .number = k / ELEMENT_TYPES,
                                                       .type   = type,
                                                       .first  = *cells,
                                                       .n      = count[k],
                                                       .nodes  = mesh->n_body_global};
    before[k] += *cells;
    *cells += count[k];
  }
  for (PetscInt c = 0; c < by_id.n; c++) rows[c] = before[keys[c]]++;
  PetscCall(PetscSFBcastBegin(by_id.sf, MPIU_INT, rows, row, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(by_id.sf, MPIU_INT, rows, row, MPI_REPLACE));
  FieldsListTools(fields);
  PetscCall(PetscFree2(count, before));
  PetscCall(PetscFree3(key, keys, rows));
  PetscCall(Hdf5TableDestroy(&by_id));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes rows first to first + total - 1 of the cells of a type: a table of their nodes at `path` and, unless
   body_path is NULL, one of their bodies there. */
static PetscErrorCode FieldsWriteCellTable(Fields fields, hid_t file, ElementType type, const PetscInt *cell_row,
                                           PetscInt first, PetscInt total, const char *path, const char *body_path)
{
  const Mesh     mesh    = fields->model->mesh;
  const Element *element = ElementGet(type);
  const int      nodes   = element->nodes;
  int64_t       *ids, *body;
  PetscInt      *row, n = 0;
  Hdf5Table      rows;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(mesh->n_cells * nodes, &ids, mesh->n_cells, &body, mesh->n_cells, &row));
  for (PetscInt c = 0; c < mesh->n_cells; c++) {
    if (mesh->cell_type[c] != type || cell_row[c] < first || cell_row[c] >= first + total) continue;
    for (int i = 0; i < nodes; i++)
      ids[n * nodes + i] = mesh->node_id[mesh->cell_nodes[mesh->cell_ptr[c] + element->xdmf_order[i]]];
    body[n]  = mesh->cell_body[c];
    row[n++] = cell_row[c] - first;
  }
  PetscCall(Hdf5TableCreate(mesh->comm, total, n, row, &rows));
  PetscCall(Hdf5TableWriteIntegers(file, path, &rows, nodes, ids));
  if (body_path) PetscCall(Hdf5TableWriteIntegers(file, body_path, &rows, 1, body));
  PetscCall(Hdf5TableDestroy(&rows));
  PetscCall(PetscFree3(ids, body, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteCells(Fields fields, hid_t file)
{
  const FieldsIndex *index = &fields->index;
  PetscInt          *row;
  char               path[DATASET_PATH_SIZE], body_path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fields->model->mesh->n_cells, &row));
  PetscCall(FieldsNumberCells(fields, row));
  for (int type = 0; type < ELEMENT_TYPES; type++) {
    if (!fields->cells[type]) continue;
    PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/cells_%s", ElementGet((ElementType)type)->name));
    PetscCall(PetscSNPrintf(body_path, sizeof(body_path), "%s_body", path));
    PetscCall(FieldsWriteCellTable(fields, file, (ElementType)type, row, 0, fields->cells[type], path, body_path));
  }
  for (int b = 0; b < index->n_blocks && !index->blocks[b].tool; b++) {
    PetscCall(PetscSNPrintf(path, sizeof(path), "/mesh/block_%d", b));
    PetscCall(FieldsWriteCellTable(fields, file, index->blocks[b].type, row, index->blocks[b].first, index->blocks[b].n,
                                   path, NULL));
  }
  PetscCall(PetscFree(row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Numbers the rows of the pairs' slave nodes, ascending by id. */
static PetscErrorCode FieldsListSlaveNodes(Fields fields)
{
  const Mesh   mesh = fields->model->mesh;
  ContactNodes slaves;
  PetscInt    *ids;

  PetscFunctionBeginUser;
  for (int p = 0; p < fields->n_pairs; p++) {
    if (fields->pairs[p].sf) continue;
    PetscCall(ContactGetNodes(fields->model->contact, p, fields->model->u, &slaves));
    PetscCall(PetscMalloc1(slaves.n, &ids));
    for (PetscInt k = 0; k < slaves.n; k++) ids[k] = mesh->node_id[slaves.node[k]];
    PetscCall(Hdf5TableCreateByKey(mesh->comm, slaves.n, ids, &fields->pairs[p]));
    PetscCall(PetscFree(ids));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteSlaveNodes(Fields fields, hid_t file)
{
  ContactNodes slaves;
  int64_t     *ids;
  char         path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(FieldsListSlaveNodes(fields));
  for (int p = 0; p < fields->n_pairs; p++) {
    PetscCall(ContactGetNodes(fields->model->contact, p, fields->model->u, &slaves));
    PetscCall(PetscMalloc1(slaves.n, &ids));
    for (PetscInt k = 0; k < slaves.n; k++) ids[k] = fields->model->mesh->node_id[slaves.node[k]];
    PetscCall(PetscSNPrintf(path, sizeof(path), "/contact/%s/nodes", ContactPairName(fields->model->contact, p)));
    PetscCall(Hdf5TableWriteIntegers(file, path, &fields->pairs[p], 1, ids));
    PetscCall(PetscFree(ids));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes a table that rank 0 has as a whole. */
static PetscErrorCode FieldsWriteWhole(Fields fields, hid_t file, const char *path, PetscInt n, int width, hid_t type,
                                       const void *values)
{
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(fields->model->mesh->comm, &rank));
  PetscCall(Hdf5TableWrite(file, path, (hsize_t)n, 0, rank ? 0 : (hsize_t)n, width, type, values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the meshes of the rigid tools. In `grid_cells` their nodes are counted behind all nodes that come before. */
static PetscErrorCode FieldsWriteTools(Fields fields, hid_t file)
{
  int64_t before = fields->model->mesh->n_body_global;
  char    path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  for (int s = 0; s < fields->tools.n; s++) {
    const ToolShape *shape = &fields->tools.shape[s];
    const int        nodes = ElementGet(shape->type)->nodes;
    int64_t         *cells;

    PetscCall(PetscMalloc1(shape->n_cells * nodes, &cells));
    for (PetscInt i = 0; i < shape->n_cells * nodes; i++) cells[i] = shape->cells[i] + before;
    PetscCall(PetscSNPrintf(path, sizeof(path), "/tools/%s/nodes", shape->name));
    PetscCall(FieldsWriteWhole(fields, file, path, shape->n_nodes, 3, H5T_NATIVE_DOUBLE, shape->nodes));
    PetscCall(PetscSNPrintf(path, sizeof(path), "/tools/%s/cells", shape->name));
    PetscCall(FieldsWriteWhole(fields, file, path, shape->n_cells, nodes, H5T_NATIVE_INT64, shape->cells));
    PetscCall(PetscSNPrintf(path, sizeof(path), "/tools/%s/grid_cells", shape->name));
    PetscCall(FieldsWriteWhole(fields, file, path, shape->n_cells, nodes, H5T_NATIVE_INT64, cells));
    PetscCall(PetscFree(cells));
    before += shape->n_nodes;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes how far the tools have moved. */
static PetscErrorCode FieldsWriteToolPlaces(Fields fields, hid_t file, PetscReal t)
{
  char       path[DATASET_PATH_SIZE];
  PetscReal *displacement;

  PetscFunctionBeginUser;
  for (int s = 0; s < fields->tools.n; s++) {
    const ToolShape *shape = &fields->tools.shape[s];

    PetscCall(PetscMalloc1(shape->n_nodes * 3, &displacement));
    ToolShapePlace(shape, t, displacement);
    PetscCall(
      PetscSNPrintf(path, sizeof(path), "/steps/%04d/tools/%s/displacement", (int)fields->n_written, shape->name));
    PetscCall(FieldsWriteWhole(fields, file, path, shape->n_nodes, 3, H5T_NATIVE_DOUBLE, displacement));
    PetscCall(PetscFree(displacement));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes everything that does not change from step to step. */
static PetscErrorCode FieldsWriteMesh(Fields fields, hid_t file)
{
  PetscFunctionBeginUser;
  PetscCall(FieldsWriteNodes(fields, file));
  PetscCall(FieldsWriteCells(fields, file));
  PetscCall(FieldsWriteTools(fields, file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes columns first to first + width - 1 of a nodal array (of local nodes, `stride` columns) as one dataset. */
static PetscErrorCode FieldsWriteNodal(Fields fields, hid_t file, const char *name, const PetscReal *values, int stride,
                                       int first, int width)
{
  const PetscInt n = fields->model->mesh->n_body_owned;
  PetscReal     *items;
  char           path[DATASET_PATH_SIZE];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * width, &items));
  for (PetscInt k = 0; k < n; k++)
    for (int i = 0; i < width; i++) items[k * width + i] = values[fields->owned[k] * stride + first + i];
  PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d/%s", (int)fields->n_written, name));
  PetscCall(Hdf5TableWriteReals(file, path, &fields->nodes, width, items));
  PetscCall(PetscFree(items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteDisplacement(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *u;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * 3, &u));
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++)
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

/* Writes principal values and directions of the stresses at the nodes. */
static PetscErrorCode FieldsWritePrincipal(Fields fields, hid_t file, const PetscReal *stress)
{
  const Mesh mesh = fields->model->mesh;
  enum { WIDTH = 12 };
  PetscReal *values;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * WIDTH, &values));
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++) {
    PetscReal axis[3][3];

    PrincipalValues(&stress[n * 6], &values[n * WIDTH], axis);
    for (int k = 0; k < 9; k++) values[n * WIDTH + 3 + k] = axis[k / 3][k % 3];
  }
  PetscCall(FieldsWriteNodal(fields, file, "principal_stress", values, WIDTH, 0, 3));
  PetscCall(FieldsWriteNodal(fields, file, "principal_direction_1", values, WIDTH, 3, 3));
  PetscCall(FieldsWriteNodal(fields, file, "principal_direction_2", values, WIDTH, 6, 3));
  PetscCall(FieldsWriteNodal(fields, file, "principal_direction_3", values, WIDTH, 9, 3));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Makes nodal values of shares of cells: adds them up over the ranks and divides them by the weights. */
static PetscErrorCode AverageNodes(Mesh mesh, int width, PetscReal *values, PetscReal *weight)
{
  PetscFunctionBeginUser;
  PetscCall(MeshSumNodes(mesh, width, values));
  PetscCall(MeshSumNodes(mesh, 1, weight));
  for (PetscInt k = 0; k < mesh->n_body_nodes * width; k++) values[k] /= weight[k / width];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteStrain(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *strain, *weight;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes * STRAIN_FIELDS, &strain, mesh->n_nodes, &weight));
  PetscCall(ElasticityNodalStrain(fields->model->problem->elasticity, fields->model->u, strain, weight));
  PetscCall(AverageNodes(mesh, STRAIN_FIELDS, strain, weight));
  PetscCall(FieldsWriteNodal(fields, file, "strain", strain, STRAIN_FIELDS, 0, 6));
  PetscCall(FieldsWriteNodal(fields, file, "energy_density", strain, STRAIN_FIELDS, 6, 1));
  PetscCall(PetscFree2(strain, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes stresses and what follows from them, as far as they are asked for. */
static PetscErrorCode FieldsWriteStress(Fields fields, hid_t file)
{
  const Mesh      mesh  = fields->model->mesh;
  const PetscBool plain = FieldsShows(fields, SHOW_STRESS);
  PetscReal      *stress, *weight, *equivalent, *pressure;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(mesh->n_nodes * 6, &stress, mesh->n_nodes, &weight, mesh->n_nodes, &equivalent, mesh->n_nodes,
                         &pressure));
  PetscCall(ElasticityNodalStress(fields->model->problem->elasticity, fields->model->u, stress, weight));
  PetscCall(AverageNodes(mesh, 6, stress, weight));
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++) {
    equivalent[n] = VonMises(&stress[n * 6]);
    pressure[n]   = -(stress[n * 6] + stress[n * 6 + 1] + stress[n * 6 + 2]) / 3;
  }
  if (plain) PetscCall(FieldsWriteNodal(fields, file, "stress", stress, 6, 0, 6));
  if (plain) PetscCall(FieldsWriteNodal(fields, file, "von_mises", equivalent, 1, 0, 1));
  if (FieldsShows(fields, SHOW_PRINCIPAL)) PetscCall(FieldsWritePrincipal(fields, file, stress));
  if (FieldsShows(fields, SHOW_SOLID_PRESSURE))
    PetscCall(FieldsWriteNodal(fields, file, "solid_pressure", pressure, 1, 0, 1));
  PetscCall(PetscFree4(stress, weight, equivalent, pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWritePlasticStrain(Fields fields, hid_t file)
{
  const Mesh mesh = fields->model->mesh;
  PetscReal *strain, *weight;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(mesh->n_nodes * PLASTIC_FIELDS, &strain, mesh->n_nodes, &weight));
  PetscCall(ElasticityNodalPlasticStrain(fields->model->problem->elasticity, strain, weight));
  PetscCall(AverageNodes(mesh, PLASTIC_FIELDS, strain, weight));
  PetscCall(FieldsWriteNodal(fields, file, "plastic_strain", strain, PLASTIC_FIELDS, 0, 1));
  PetscCall(FieldsWriteNodal(fields, file, "plastic_strain_tensor", strain, PLASTIC_FIELDS, 1, 6));
  PetscCall(PetscFree2(strain, weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Writes the place of an analytic master at this step, as no mesh shows it. */
static PetscErrorCode FieldsWriteMaster(Fields fields, hid_t file, int pair)
{
  static const char *const names[] =
    {[ANALYTIC_PLANE] = "plane", [ANALYTIC_CYLINDER] = "cylinder", [ANALYTIC_SPHERE] = "sphere"};
  const SceneContact    *contact = &fields->scene->contacts[pair];
  const AnalyticSurface *master  = &contact->analytic;
  const double           t       = (double)fields->model->t;
  double                 values[7]; /* point, then axis or normal, then radius */
  int                    n = 3;
  char                   path[DATASET_PATH_SIZE];
  hid_t                  group;

  PetscFunctionBeginUser;
  if (contact->master) PetscFunctionReturn(PETSC_SUCCESS);
  MotionPlace(&contact->motion, t, contact->motion.point, values);
  if (master->shape != ANALYTIC_SPHERE) {
    MotionTurn(&contact->motion, t, master->axis, &values[n]);
    n += 3;
  }
  if (master->shape != ANALYTIC_PLANE) values[n++] = master->radius;
  PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d/contact/%s", (int)fields->n_written, contact->name));
  CallHDF5(group = H5Gopen2(file, path, H5P_DEFAULT));
  PetscCall(Hdf5WriteAttribute(group, names[master->shape], H5T_NATIVE_DOUBLE, n, values));
  CallHDF5(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The number of contact fields that the scene has. */
static int ContactFields(Fields fields)
{
  return COUNT(contact_fields) - (FieldsShows(fields, SHOW_FRICTION) ? 0 : FRICTION_FIELDS);
}

/* Writes the tables of one pair. Its values also go to the nodal array (COLUMNS per local node, owned nodes only),
   where the larger pressure counts if pairs share a slave node. */
static PetscErrorCode FieldsWritePair(Fields fields, hid_t file, int pair, PetscReal *nodal)
{
  ContactNodes slaves;
  PetscReal   *values, *items;
  char         path[DATASET_PATH_SIZE];

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
    for (int i = 0; i < 3; i++) value[COLUMN_TRACTION + i] = slaves.traction ? slaves.traction[k * 3 + i] : 0.0;
    value[COLUMN_SLIP]     = slaves.slid ? slaves.slid[k] : 0.0;
    value[COLUMN_FRICTION] = slaves.friction ? slaves.friction[k] : 0.0;
    value[COLUMN_PRESENT]  = 1.0;
    for (int i = 0; i < 3; i++)
      value[COLUMN_WHOLE + i] = slaves.pressure[k] * slaves.normal[k * 3 + i] + value[COLUMN_TRACTION + i];
    value[COLUMN_STATUS] = slaves.friction ? slaves.friction[k] : slaves.pressure[k] > 0.0 ? 2.0 : 0.0;
    if (node[COLUMN_PRESENT] == 0.0 || value[COLUMN_PRESSURE] > node[COLUMN_PRESSURE])
      PetscCall(PetscArraycpy(node, value, COLUMNS));
  }
  for (int f = 0; f < ContactFields(fields); f++) {
    const int width = contact_fields[f].width;

    for (PetscInt k = 0; k < slaves.n; k++)
      for (int i = 0; i < width; i++) items[k * width + i] = values[k * COLUMNS + contact_fields[f].column + i];
    PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d/contact/%s/%s", (int)fields->n_written,
                            ContactPairName(fields->model->contact, pair), contact_fields[f].name));
    PetscCall(Hdf5TableWriteReals(file, path, &fields->pairs[pair], width, items));
  }
  PetscCall(PetscFree2(values, items));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fills in the corners of a slave surface's second-order triangles. They carry no area and so have no contact values
   of their own. For display they get the mean of the mid-side nodes beside them. nodal is complete on every copy of a
   node. */
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
  for (int p = 0; p < fields->n_pairs; p++) {
    PetscCall(FieldsWritePair(fields, file, p, nodal));
    PetscCall(FieldsWriteMaster(fields, file, p));
  }
  PetscCall(MeshSumNodes(mesh, COLUMNS, nodal));
  for (int p = 0; p < fields->n_pairs; p++) PetscCall(FieldsFillCorners(fields, p, nodal, fill));
  PetscCall(MeshSumNodes(mesh, COLUMNS, fill));
  for (PetscInt n = 0; n < mesh->n_body_nodes; n++) {
    PetscReal      *value  = &nodal[n * COLUMNS];
    const PetscReal weight = fill[n * COLUMNS + COLUMN_PRESENT];

    if (value[COLUMN_PRESENT] > 0.0) continue;
    for (int f = 0; f < ContactFields(fields); f++)
      for (int i = contact_fields[f].column; i < contact_fields[f].column + contact_fields[f].width; i++)
        value[i] = weight > 0.0 ? fill[n * COLUMNS + i] / weight : contact_fields[f].absent;
  }
  for (int f = 0; f < ContactFields(fields); f++)
    PetscCall(FieldsWriteNodal(fields, file, contact_fields[f].name, nodal, COLUMNS, contact_fields[f].column,
                               contact_fields[f].width));
  PetscCall(PetscFree2(nodal, fill));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Returns the kinds that a step written now holds, as bits. */
static PetscInt FieldsShown(Fields fields)
{
  PetscInt shows = 0;

  for (int kind = 0; kind < SHOW_KINDS; kind++) shows |= FieldsShows(fields, kind) ? 1 << kind : 0;
  return shows;
}

/* Tells whether some written step holds contact fields. */
static PetscBool FieldsHoldContact(Fields fields)
{
  for (PetscInt s = 0; s < fields->n_written; s++)
    if (fields->shows[s] & 1 << SHOW_CONTACT) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode FieldsRemember(Fields fields, PetscReal t)
{
  PetscFunctionBeginUser;
  if (fields->n_written == fields->room) {
    fields->room = 2 * fields->room + 16;
    PetscCall(PetscRealloc((size_t)fields->room * sizeof(PetscReal), &fields->t));
    PetscCall(PetscRealloc((size_t)fields->room * sizeof(PetscInt), &fields->shows));
  }
  fields->shows[fields->n_written] = FieldsShown(fields);
  fields->t[fields->n_written++]   = t;
  fields->index.t                  = fields->t;
  fields->index.shows              = fields->shows;
  fields->index.n_steps            = fields->n_written;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Prepares what the views of the file will show. Cells are numbered when the file is made. */
static PetscErrorCode FieldsPrepareIndex(Fields fields)
{
  FieldsIndex *index = &fields->index;

  PetscFunctionBeginUser;
  index->name  = fields->scene->name;
  index->nodes = fields->model->mesh->n_body_global;
  PetscCall(ToolShapesCreate(fields->model->mesh, fields->scene, &fields->tools));
  PetscCall(PetscCalloc1(fields->scene->n_bodies * ELEMENT_TYPES + fields->tools.n, &index->blocks));
  index->n_arrays = COUNT(shown);
  index->arrays   = shown;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FieldsCreate - prepares results.vtkhdf and results.xdmf in a directory; no file is touched yet.

  Collective

  Input Parameters:
+ model     - its elasticity, contact and displacements are read at each write
. scene     - output.fields chooses what is written
- directory - must exist at the first write

  Output Parameter:
. result - free it with FieldsDestroy()
@*/
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
  PetscCall(PetscSNPrintf(fields->file, sizeof(fields->file), "%s/" FIELDS_FILE, directory));
  fields->n_pairs = model->contact ? ContactPairs(model->contact) : 0;
  PetscCall(PetscCalloc1(fields->n_pairs, &fields->pairs));
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  PetscCall(PetscMalloc1(mesh->n_body_owned, &fields->owned));
  PetscCall(PetscMalloc1(mesh->n_body_owned, &id));
  for (PetscInt k = 0; k < mesh->n_body_nodes; k++) {
    if (mesh->node_owner[k] != rank) continue;
    fields->owned[n] = k;
    id[n++]          = mesh->node_id[k];
  }
  PetscCall(Hdf5TableCreate(mesh->comm, mesh->n_body_global, n, id, &fields->nodes));
  PetscCall(PetscFree(id));
  PetscCall(FieldsPrepareIndex(fields));
  *result = fields;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FieldsDestroy - frees the fields; the files stay.

  Collective

  Input Parameter:
. fields - set to NULL
@*/
PetscErrorCode FieldsDestroy(Fields *fields)
{
  PetscFunctionBeginUser;
  if (!*fields) PetscFunctionReturn(PETSC_SUCCESS);
  for (int p = 0; p < (*fields)->n_pairs; p++) PetscCall(Hdf5TableDestroy(&(*fields)->pairs[p]));
  PetscCall(Hdf5TableDestroy(&(*fields)->nodes));
  PetscCall(PetscFree((*fields)->image));
  PetscCall(PetscFree((*fields)->owned));
  PetscCall(PetscFree((*fields)->pairs));
  PetscCall(PetscFree((*fields)->index.blocks));
  PetscCall(ToolShapesDestroy(&(*fields)->tools));
  PetscCall(PetscFree((*fields)->t));
  PetscCall(PetscFree((*fields)->shows));
  PetscCall(PetscFree(*fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives results.vtkhdf the second name by which readers of HDF5 know it. A copy of the directory may hold an old file
   of that name in the place of the link. A file system without links does without the name. */
static PetscErrorCode FieldsLink(Fields fields)
{
  char    link[PETSC_MAX_PATH_LEN], target[PETSC_MAX_PATH_LEN];
  ssize_t n;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(link, sizeof(link), "%s/results.h5", fields->directory));
  n = readlink(link, target, sizeof(target));
  if (n == (ssize_t)strlen(FIELDS_FILE) && !strncmp(target, FIELDS_FILE, (size_t)n)) PetscFunctionReturn(PETSC_SUCCESS);
  unlink(link);
  if (symlink(FIELDS_FILE, link)) errno = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FieldsWriteViews(Fields fields)
{
  PetscFunctionBeginUser;
  PetscCall(XdmfWrite(&fields->index, fields->directory));
  PetscCall(FieldsLink(fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FieldsWrite - adds the model's present state to results.vtkhdf and writes results.xdmf anew.

  Collective

  Input Parameters:
+ fields - the fields
. step   - number of the accepted step
- t      - load parameter

  Note:
  Errors: PETSC_ERR_FILE_OPEN, PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode FieldsWrite(Fields fields, PetscInt step, PetscReal t)
{
  const int64_t number = step;
  PetscMPIInt   rank;
  char          path[DATASET_PATH_SIZE];
  hid_t         file, group;

  PetscFunctionBeginUser;
  PetscCall(FieldsOpenFile(fields, &file));
  if (!fields->n_written) {
    PetscCall(FieldsWriteMesh(fields, file));
    CallHDF5(group = H5Gcreate2(file, "/steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    CallHDF5(H5Gclose(group));
  }
  if (FieldsShows(fields, SHOW_CONTACT) && !FieldsHoldContact(fields)) PetscCall(FieldsWriteSlaveNodes(fields, file));
  PetscCall(PetscSNPrintf(path, sizeof(path), "/steps/%04d", (int)fields->n_written));
  CallHDF5(group = H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  PetscCall(Hdf5WriteAttribute(group, "t", H5T_NATIVE_DOUBLE, 1, &t));
  PetscCall(Hdf5WriteAttribute(group, "step", H5T_NATIVE_INT64, 1, &number));
  if (SceneStepAt(fields->scene, t)) PetscCall(Hdf5WriteText(group, STEP_COLUMN_DURING, SceneStepAt(fields->scene, t)));
  CallHDF5(H5Gclose(group));
  if (FieldsShows(fields, SHOW_DISPLACEMENT)) PetscCall(FieldsWriteDisplacement(fields, file));
  if (FieldsShows(fields, SHOW_STRESS) || FieldsShows(fields, SHOW_PRINCIPAL))
    PetscCall(FieldsWriteStress(fields, file));
  if (FieldsShows(fields, SHOW_STRAIN)) PetscCall(FieldsWriteStrain(fields, file));
  if (FieldsShows(fields, SHOW_PLASTIC)) PetscCall(FieldsWritePlasticStrain(fields, file));
  if (FieldsShows(fields, SHOW_CONTACT)) PetscCall(FieldsWriteContact(fields, file));
  PetscCall(FieldsWriteToolPlaces(fields, file, t));
  CallHDF5(H5Fclose(file));
  PetscCall(FieldsRemember(fields, t));
  PetscCallMPI(MPI_Comm_rank(fields->model->mesh->comm, &rank));
  if (rank == 0) PetscCall(VtkHdfUpdate(&fields->index, fields->file));
  if (rank == 0) PetscCall(FieldsWriteViews(fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FieldsArchive - saves or takes over which states are written, with an image of the file that holds them.

  Collective

  Input Parameters:
+ fields  - the fields
- archive - the checkpoint

  Note:
  Loading touches no file: FieldsResume() does.
@*/
PetscErrorCode FieldsArchive(Fields fields, Archive archive)
{
  PetscInt    n     = fields->n_written;
  PetscInt64  size  = 0;
  char       *image = NULL;
  FILE       *stream;
  size_t      length;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(fields->model->mesh->comm, &rank));
  PetscCall(ArchiveIntegers(archive, "results/written", 1, &n));
  for (PetscInt s = fields->n_written; s < n; s++) PetscCall(FieldsRemember(fields, 0));
  PetscCall(ArchiveReals(archive, "results/t", n, fields->t));
  PetscCall(ArchiveIntegers(archive, "results/shows", n, fields->shows));
  if (!n) PetscFunctionReturn(PETSC_SUCCESS);
  if (!ArchiveLoads(archive)) {
    if (rank == 0) PetscCall(FileImageTake(fields->file, &image, &size));
    PetscCall(ArchiveBytes(archive, "results/image", &size, &image));
    PetscCall(PetscFree(image));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  stream = open_memstream(&image, &length);
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for a part of results.vtkhdf");
  PetscCall(ArchiveExtract(archive, "results/image", stream));
  PetscCheck(!fclose(stream), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for a part of results.vtkhdf");
  PetscCall(PetscMalloc1(length, &fields->image));
  PetscCall(PetscArraycpy(fields->image, image, length));
  free(image);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  FieldsResume - takes results.vtkhdf and results.xdmf back to the states of the loaded checkpoint.

  Collective

  Input Parameter:
. fields - the fields, after FieldsArchive() has loaded them

  Output Parameter:
. lost - the file is gone; a new one begins with the next state

  Note:
  What was written after the checkpoint, whole or in part, is removed. Errors: PETSC_ERR_FILE_WRITE.
@*/
PetscErrorCode FieldsResume(Fields fields, PetscBool *lost)
{
  const Mesh  mesh = fields->model->mesh;
  PetscBool   back = PETSC_TRUE;
  int         all;
  PetscInt   *row;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  *lost = PETSC_FALSE;
  if (!fields->n_written) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Comm_rank(mesh->comm, &rank));
  if (rank == 0) PetscCall(FileImagePutBack(fields->file, fields->image, &back));
  all = back;
  PetscCallMPI(MPI_Bcast(&all, 1, MPI_INT, 0, mesh->comm));
  if (!all) {
    *lost             = PETSC_TRUE;
    fields->n_written = 0;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(mesh->n_cells, &row));
  PetscCall(FieldsNumberCells(fields, row)); /* for the blocks that the text shows */
  PetscCall(PetscFree(row));
  PetscCall(FieldsListSlaveNodes(fields));
  if (rank == 0) PetscCall(FieldsWriteViews(fields));
  PetscFunctionReturn(PETSC_SUCCESS);
}
