/* Reader for gmsh's file format 4.1, text and binary. The file is read section by section. */
#include "gmshfile.h"
#include "gmshreader.h"
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* A line of comments that starts so is for the user. */
#define NOTE "note: "

enum {
  GMSH_QUAD8   = 16, /* gmsh's type numbers of the serendipity elements */
  GMSH_HEX20   = 17,
  GMSH_POLYGON = 34 /* elements from this number on have no fixed shape */
};

static const char *const RefusedElements[] = {[6]          = "6-node prism",
                                              [7]          = "5-node pyramid",
                                              [13]         = "18-node prism",
                                              [14]         = "14-node pyramid",
                                              [GMSH_QUAD8] = "8-node quadrangle",
                                              [GMSH_HEX20] = "20-node hexahedron",
                                              [18]         = "15-node prism",
                                              [19]         = "13-node pyramid"};

/* An entity of the geometry and the signed tags of the physical groups that contain it. part: its partition, 0: none or
   several */
typedef struct {
  int dim, tag, part, n, *physical;
} Entity;

/* The file, and what is known of its contents so far */
typedef struct {
  GmshReader reader;
  GmshMesh  *mesh;
  PetscInt   n_entities, found; /* found: the last one that was looked for */
  Entity    *entities;
  PetscInt   n_parts;    /* partitions */
  PetscBool *found_part; /* for each of them, whether it has elements that are not on its border alone */
  PetscBool  has_nodes;
  Portions  *portions; /* where nodes and elements go */
} Contents;

/*@
  GmshFileLoad - loads a whole .geo file, or another small one, into memory.

  Not collective

  Input Parameter:
. file - path

  Output Parameters:
+ data - bytes of the file, followed by a zero, to be freed with PetscFree(); NULL: there is no such file, or it cannot
  be read
- size - number of bytes without the zero
@*/
PetscErrorCode GmshFileLoad(const char *file, char **data, size_t *size)
{
  FILE       *stream = fopen(file, "rb");
  long        length = -1;
  struct stat status;

  PetscFunctionBeginUser;
  *data = NULL;
  *size = 0;
  if (!stream) PetscFunctionReturn(PETSC_SUCCESS);
  if (!fstat(fileno(stream), &status) && S_ISREG(status.st_mode) && !fseek(stream, 0, SEEK_END)) length = ftell(stream);
  if (length >= 0) {
    rewind(stream);
    PetscCall(PetscMalloc1((size_t)length + 1, data));
    *size          = fread(*data, 1, (size_t)length, stream);
    (*data)[*size] = '\0';
  }
  fclose(stream);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sections */

static PetscErrorCode ReadFormat(Contents *f)
{
  GmshReader *r = &f->reader;
  char        line[256], version[16] = "";
  int         binary = 0, size = 0, one = 1;

  PetscFunctionBeginUser;
  GmshReaderLine(r, line, sizeof(line));
  if (sscanf(line, "%15s %d %d", version, &binary, &size) != 3)
    GmshReaderDamaged(r);
  else if (strcmp(version, "4.1")) {
    Complain(r->complaint,
             "%s: file format %s is not read, only gmsh's 4.1; convert it: gmsh %s -save -format msh41 -o NEW.msh",
             r->file, version, r->file);
  } else if (size != 8)
    Complain(r->complaint, "%s: written with data size %d, only 8 is read", r->file, size);
  if (!GmshReaderFailed(r) && binary) {
    r->binary = PETSC_TRUE;
    one       = GmshReaderInt(r);
    if (one != 1)
      Complain(r->complaint,
               "%s: binary file of a machine with another byte order; write it as text: gmsh FILE.geo -format msh41 "
               "without -bin",
               r->file);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the names of physical groups, which are text in binary files too. */
static PetscErrorCode ReadPhysicalNames(Contents *f)
{
  GmshReader *r      = &f->reader;
  PetscBool   binary = r->binary;
  PetscInt    n;

  PetscFunctionBeginUser;
  r->binary = PETSC_FALSE;
  n         = GmshReaderCount(r);
  PetscCall(PetscCalloc1(n, &f->mesh->physicals));
  for (PetscInt i = 0; i < n && !GmshReaderFailed(r); i++) {
    GmshPhysical *physical = &f->mesh->physicals[i];
    char          line[512];
    size_t        length;

    physical->dim = GmshReaderInt(r);
    physical->tag = (PetscInt)GmshReaderSize(r);
    GmshReaderSkipSpace(r);
    GmshReaderLine(r, line, sizeof(line));
    length = strlen(line);
    if (length < 3 || line[0] != '"' || line[length - 1] != '"')
      GmshReaderDamaged(r);
    else
      line[length - 1] = '\0';
    PetscCall(PetscStrallocpy(line + 1, &physical->name));
    f->mesh->n_physicals++;
  }
  r->binary = binary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads how many entities of each dimension follow and makes room for them. */
static PetscErrorCode ReadEntityCounts(Contents *f, PetscInt n[4])
{
  PetscInt total = f->n_entities;

  PetscFunctionBeginUser;
  for (int dim = 0; dim < 4; dim++) {
    n[dim] = GmshReaderCount(&f->reader);
    total += n[dim];
  }
  if (GmshReaderFailed(&f->reader)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc((size_t)total * sizeof(*f->entities), &f->entities));
  PetscCall(PetscArrayzero(f->entities + f->n_entities, total - f->n_entities));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads what follows an entity's tag, or its partitions: its place, groups and bounding entities. */
static PetscErrorCode ReadEntityRest(GmshReader *r, Entity *entity)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < (entity->dim ? 6 : 3); k++) (void)GmshReaderDouble(r); /* coordinates, or bounding box */
  entity->n = (int)GmshReaderCount(r);
  PetscCall(PetscMalloc1(entity->n, &entity->physical));
  for (int k = 0; k < entity->n; k++) entity->physical[k] = GmshReaderInt(r);
  for (PetscInt k = entity->dim ? GmshReaderCount(r) : 0; k > 0; k--) (void)GmshReaderInt(r); /* bounding entities */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadEntities(Contents *f)
{
  GmshReader *r = &f->reader;
  PetscInt    n[4];

  PetscFunctionBeginUser;
  PetscCall(ReadEntityCounts(f, n));
  for (int dim = 0; dim < 4; dim++) {
    for (PetscInt i = 0; i < n[dim] && !GmshReaderFailed(r); i++) {
      Entity *entity = &f->entities[f->n_entities++];

      entity->dim = dim;
      entity->tag = GmshReaderInt(r);
      PetscCall(ReadEntityRest(r, entity));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads an entity of a partitioned mesh. One that lies between partitions gets no groups, which are those of what it
   divides. */
static PetscErrorCode ReadPartitionedEntity(GmshReader *r, int dim, Entity *entity)
{
  PetscInt n_parts;
  int      parent;

  PetscFunctionBeginUser;
  entity->dim = dim;
  entity->tag = GmshReaderInt(r);
  parent      = GmshReaderInt(r);
  (void)GmshReaderInt(r); /* tag of the parent */
  n_parts = GmshReaderCount(r);
  for (PetscInt k = 0; k < n_parts; k++) entity->part = GmshReaderInt(r);
  if (n_parts != 1) entity->part = 0;
  PetscCall(ReadEntityRest(r, entity));
  if (parent != dim) entity->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the entities of a partitioned mesh, on which all its elements are. */
static PetscErrorCode ReadPartitioned(Contents *f)
{
  GmshReader *r = &f->reader;
  PetscInt    n[4], n_ghosts;

  PetscFunctionBeginUser;
  f->n_parts = GmshReaderCount(r);
  n_ghosts   = GmshReaderCount(r);
  for (PetscInt i = 0; i < 2 * n_ghosts; i++) (void)GmshReaderInt(r); /* entities of ghosts and their partitions */
  PetscCall(PetscCalloc1(f->n_parts, &f->found_part));
  PetscCall(ReadEntityCounts(f, n));
  for (int dim = 0; dim < 4; dim++)
    for (PetscInt i = 0; i < n[dim] && !GmshReaderFailed(r); i++)
      PetscCall(ReadPartitionedEntity(r, dim, &f->entities[f->n_entities++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNodes(Contents *f)
{
  GmshReader *r      = &f->reader;
  PetscInt    blocks = GmshReaderCount(r), n = GmshReaderCount(r), done = 0;

  PetscFunctionBeginUser;
  (void)GmshReaderSize(r); /* smallest and largest tag */
  (void)GmshReaderSize(r);
  PetscCall(PortionsNodes(f->portions, n));
  for (PetscInt b = 0; b < blocks && !GmshReaderFailed(r); b++) {
    int      dim        = GmshReaderInt(r);
    int      parametric = (GmshReaderInt(r), GmshReaderInt(r)); /* skips the entity's tag */
    PetscInt in_block   = GmshReaderCount(r);

    if (in_block > n - done || dim < 0 || dim > 3) GmshReaderDamaged(r);
    for (PetscInt i = 0; i < in_block && !GmshReaderFailed(r); i++)
      PetscCall(PortionsTag(f->portions, done + i, GmshReaderTag(r)));
    for (PetscInt i = 0; i < in_block && !GmshReaderFailed(r); i++) {
      PetscReal x[3];

      for (int k = 0; k < 3; k++) x[k] = GmshReaderDouble(r);
      for (int k = 0; parametric && k < dim; k++) (void)GmshReaderDouble(r); /* parametric coordinates on the entity */
      PetscCall(PortionsPlace(f->portions, done + i, x));
    }
    done += in_block;
  }
  if (done != n) GmshReaderDamaged(r);
  f->has_nodes = n > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void RefuseElement(GmshReader *r, int type, int dim, int entity)
{
  const char *known =
    type >= 0 && type < (int)(sizeof(RefusedElements) / sizeof(*RefusedElements)) ? RefusedElements[type] : NULL;
  char name[64];

  if (known)
    snprintf(name, sizeof(name), "%s", known);
  else
    snprintf(name, sizeof(name), "gmsh's type %d%s", type,
             type > GMSH_POINT && type < GMSH_POLYGON ? ", of order 3 or higher" : "");
  if (type == GMSH_QUAD8 || type == GMSH_HEX20) {
    Complain(r->complaint,
             "%s: serendipity elements (%s) are not available; mesh with: gmsh FILE.geo -order 2 -setnumber "
             "Mesh.SecondOrderIncomplete 0",
             r->file, name);
  } else {
    Complain(r->complaint,
             "%s: elements on entity %d of dimension %d are not available (%s); there are tri3, tri6, quad4, quad9, "
             "tet4, tet10, hex8, hex27",
             r->file, entity, dim, name);
  }
}

/* Finds an entity; NULL: there is none. Blocks mostly follow the order of the entities, so that the next one is mostly
   right. */
static const Entity *FindEntity(Contents *f, int dim, int tag)
{
  for (PetscInt i = 0; i < f->n_entities; i++) {
    const PetscInt at = (f->found + i) % f->n_entities;

    if (f->entities[at].dim != dim || f->entities[at].tag != tag) continue;
    f->found = at;
    return &f->entities[at];
  }
  return NULL;
}

/* Says that a partition has elements. */
static void FindPart(Contents *f, int dim, int tag)
{
  const Entity *entity = FindEntity(f, dim, tag);

  if (entity && entity->part > 0 && entity->part <= f->n_parts) f->found_part[entity->part - 1] = PETSC_TRUE;
}

/* Finds the groups of the entity on which a block lies. */
static PetscErrorCode BlockPhysicals(Contents *f, int dim, int tag, GmshBlock *block)
{
  const Entity *entity = FindEntity(f, dim, tag);

  PetscFunctionBeginUser;
  if (!entity || !entity->n) PetscFunctionReturn(PETSC_SUCCESS);
  block->n_physicals = entity->n;
  PetscCall(PetscMalloc2(entity->n, &block->physical, entity->n, &block->sign));
  for (int i = 0; i < entity->n; i++) {
    const PetscInt physical = PetscAbsInt(entity->physical[i]);

    block->physical[i] = GmshPhysicalIndex(f->mesh, dim, physical);
    block->sign[i]     = entity->physical[i] < 0 ? -1 : 1;
    if (block->physical[i] < 0) PetscCall(GmshAddPhysical(f->mesh, dim, physical, &block->physical[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the tags and nodes of a block's elements. */
static PetscErrorCode ReadBlockElements(Contents *f, GmshBlock *block)
{
  GmshReader *r = &f->reader;
  PetscInt    nodes[ELEMENT_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(PortionsBlock(f->portions, block->nodes, block->n_all));
  for (PetscInt i = 0; i < block->n_all && !GmshReaderFailed(r); i++) {
    const PetscInt tag = GmshReaderTag(r);

    if (!i) block->first_tag = tag;
    for (int k = 0; k < block->nodes && !GmshReaderFailed(r); k++) nodes[k] = GmshReaderTag(r);
    if (!GmshReaderFailed(r)) PetscCall(PortionsElement(f->portions, tag, nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBlock(Contents *f)
{
  GmshReader *r      = &f->reader;
  GmshMesh   *mesh   = f->mesh;
  GmshBlock   block  = {.dim = GmshReaderInt(r)};
  int         entity = GmshReaderInt(r), type = GmshReaderInt(r);

  PetscFunctionBeginUser;
  block.n_all   = GmshReaderCount(r);
  block.element = ElementFromGmsh(type);
  block.nodes   = block.element ? block.element->nodes : 1;
  if (!block.element && type != GMSH_POINT) RefuseElement(r, type, block.dim, entity);
  if (GmshReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadBlockElements(f, &block));
  FindPart(f, block.dim, entity);
  PetscCall(BlockPhysicals(f, block.dim, entity, &block));
  PetscCall(PetscRealloc((size_t)(mesh->n_blocks + 1) * sizeof(*mesh->blocks), &mesh->blocks));
  mesh->blocks[mesh->n_blocks++] = block;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadElements(Contents *f)
{
  GmshReader *r      = &f->reader;
  PetscInt    blocks = GmshReaderCount(r);
  long long   n;

  PetscFunctionBeginUser;
  if (!f->has_nodes) GmshReaderDamaged(r); /* the section of nodes must come first */
  n = GmshReaderSize(r);
  for (int i = 0; i < 2; i++) (void)GmshReaderSize(r); /* smallest and largest tag */
  PetscCall(PortionsElements(f->portions, (PetscInt)PetscMin(n, PETSC_MAX_INT)));
  for (PetscInt b = 0; b < blocks && !GmshReaderFailed(r); b++) PetscCall(ReadBlock(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The whole file */

/* Keeps the notes among the comments of the file. */
static PetscErrorCode ReadComments(Contents *f)
{
  GmshReader  *r     = &f->reader;
  const size_t start = strlen(NOTE);
  char         line[512];

  PetscFunctionBeginUser;
  for (int next; (next = GmshReaderPeek(r)) != EOF && next != '$';) {
    const size_t used = f->mesh->notes ? strlen(f->mesh->notes) : 0;

    GmshReaderLine(r, line, sizeof(line));
    if (strncmp(line, NOTE, start)) continue;
    PetscCall(PetscRealloc(used + strlen(line) + 2, &f->mesh->notes));
    snprintf(f->mesh->notes + used, strlen(line) + 2, "%s\n", line + start);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const struct {
  const char *name;
  PetscErrorCode (*read)(Contents *);
} Sections[] = {{"$MeshFormat", ReadFormat},
                {"$PhysicalNames", ReadPhysicalNames},
                {"$Entities", ReadEntities},
                {"$Nodes", ReadNodes},
                {"$Elements", ReadElements},
                {"$Comments", ReadComments},
                {"$PartitionedEntities", ReadPartitioned}};
/* One bit for each section, by its place in Sections. */
enum { SEEN_FORMAT = 1, SEEN_NAMES = 2, SEEN_NODES = 8, SEEN_ELEMENTS = 16 };

static PetscErrorCode ReadSection(Contents *f, unsigned *seen)
{
  GmshReader *r     = &f->reader;
  int         known = -1;

  PetscFunctionBeginUser;
  GmshReaderLine(r, r->section, sizeof(r->section));
  r->section[strcspn(r->section, " \t")] = '\0';
  for (int i = 0; i < (int)(sizeof(Sections) / sizeof(*Sections)); i++)
    if (!strcmp(r->section, Sections[i].name)) known = i;
  if ((known != 0) != (*seen & SEEN_FORMAT))
    Complain(r->complaint, "%s: this is no gmsh mesh file (.msh, format 4.1)", r->file);
  if (GmshReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  if (known >= 0) {
    if (*seen & (1u << known)) GmshReaderDamaged(r); /* the section occurs twice */
    *seen |= 1u << known;
    if (!GmshReaderFailed(r)) PetscCall(Sections[known].read(f));
  }
  if (!GmshReaderFailed(r)) GmshReaderClosing(r, known < 0 ? PETSC_TRUE : PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that no partition is in another file. */
static void CheckParts(const Contents *f)
{
  for (PetscInt i = 0; i < f->n_parts; i++)
    if (!f->found_part[i])
      Complain(f->reader.complaint,
               "%s: partition %" PetscInt_FMT " of %" PetscInt_FMT
               " is not in the file, as with gmsh's option -part_split; allowed: one file with all partitions, or none",
               f->reader.file, i + 1, f->n_parts);
}

/* Checks that the file contains all that a mesh needs. */
static void CheckContents(GmshReader *r, unsigned seen)
{
  if (!(seen & SEEN_NODES)) Complain(r->complaint, "%s: the file has no nodes", r->file);
  if (!(seen & SEEN_ELEMENTS)) Complain(r->complaint, "%s: the file has no elements", r->file);
  if (!(seen & SEEN_NAMES))
    Complain(
      r->complaint,
      "%s: the file has no physical names; name volumes and surfaces in gmsh: Physical Volume(\"NAME\") = {...};",
      r->file);
}

/* Reads the file on the first rank: groups, blocks without elements, and the portions of all ranks. */
static PetscErrorCode ReadFile(const char *file, Portions *portions, GmshMesh *mesh, Complaint *complaint)
{
  Contents    f    = {.reader = {.file = file, .complaint = complaint}, .mesh = mesh, .portions = portions};
  GmshReader *r    = &f.reader;
  unsigned    seen = 0;

  PetscFunctionBeginUser;
  PetscCall(GmshReaderOpen(r));
  for (GmshReaderSkipSpace(r); GmshReaderLeft(r) && !GmshReaderFailed(r); GmshReaderSkipSpace(r))
    PetscCall(ReadSection(&f, &seen));
  PetscCall(GmshReaderClose(r));
  PetscCall(PortionsEnd(portions));
  CheckContents(r, seen);
  CheckParts(&f);
  if (!GmshReaderFailed(r)) PetscCall(GmshSortPhysicals(mesh));
  for (PetscInt i = 0; i < f.n_entities; i++) PetscCall(PetscFree(f.entities[i].physical));
  PetscCall(PetscFree(f.entities));
  PetscCall(PetscFree(f.found_part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshRead - reads a gmsh file of format 4.1, text or binary.

  Collective

  Input Parameters:
+ comm - the ranks that share the mesh
- file - path, read by the first rank

  Output Parameters:
+ mesh      - nodes by ascending tag, elements of the physical groups, and groups; to be freed with GmshReset(), also
  after a mistake
- complaint - says what is wrong with the file, if anything, on some ranks

  Note:
  No rank holds all nodes or elements. The complaint names a missing or truncated file, another format, missing physical
  names, elements that are not available, or nodes without elements. The format is described in the gmsh reference
  manual, "MSH file format, version 4.1".
@*/
PetscErrorCode GmshRead(MPI_Comm comm, const char *file, GmshMesh *mesh, Complaint *complaint)
{
  Portions portions;

  PetscFunctionBeginUser;
  *mesh = (GmshMesh){0};
  PetscCall(PortionsCreate(comm, &portions));
  if (portions.rank)
    PetscCall(PortionsReceive(&portions));
  else
    PetscCall(ReadFile(file, &portions, mesh, complaint));
  PetscCall(GmshJoin(comm, file, &portions, mesh, complaint));
  PetscCall(PortionsReset(&portions));
  PetscFunctionReturn(PETSC_SUCCESS);
}
