/* Reader for gmsh's file format 4.1, text and binary. The file is read section by section through a window. */
#define _GNU_SOURCE 1 /* for memmem() */
#include "gmshfile.h"
#include "base/exchange.h"
#include "base/integerset.h"
#include "gmshportions.h"
#include "tagranges.h"
#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A line of comments that starts so is for the user. */
#define NOTE "note: "

enum {
  GMSH_POINT   = 15, /* gmsh's type number of a point */
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

/* Bytes of the file that are in memory at a time, and those that a number or a line needs at most. Of longer lines the
   rest is skipped. */
enum { WINDOW = 1 << 18, WINDOW_ROOM = 1024 };

/* An entity of the geometry and the signed tags of the physical groups that contain it. */
typedef struct {
  int dim, tag, n, *physical;
} Entity;

/* A place in the file, for messages */
typedef struct {
  size_t byte, line;
} Place;

/* A cursor over the file. After the first mistake every read returns 0, so that loops end. */
typedef struct {
  const char *file;
  FILE       *stream;
  size_t      size;    /* of the file */
  char       *data;    /* the window, followed by a zero */
  size_t      end, at; /* bytes in the window, and the next one */
  Place       start;   /* of the window */
  PetscBool   binary;
  char        section[64];
  Complaint  *complaint;
  GmshMesh   *mesh;
  PetscInt    n_entities, found; /* found: the last one that was looked for */
  Entity     *entities;
  PetscBool   has_nodes;
  Portions   *portions; /* where nodes and elements go */
} Reader;

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

/* Single values */

static PetscBool ReaderFailed(const Reader *r)
{
  return r->complaint->text[0] ? PETSC_TRUE : PETSC_FALSE;
}

/* Where the cursor is. */
static Place ReaderPlace(const Reader *r)
{
  Place place = {r->start.byte + r->at, r->start.line};

  for (size_t i = 0; i < r->at; i++) place.line += r->data[i] == '\n';
  return place;
}

/* Complains that the file is truncated or damaged at a place. */
static void ReaderDamagedAt(Reader *r, Place place)
{
  if (r->binary)
    Complain(r->complaint, "%s: the file is truncated or damaged in section %s (byte %zu of %zu)", r->file, r->section,
             place.byte, r->size);
  else
    Complain(r->complaint, "%s:%zu: the file is truncated or damaged in section %s", r->file, place.line, r->section);
}

/* Complains that the file is truncated or damaged at the cursor. */
static void ReaderDamaged(Reader *r)
{
  if (!ReaderFailed(r)) ReaderDamagedAt(r, ReaderPlace(r));
}

/* Bytes of the file that are not read yet. */
static size_t ReaderLeft(const Reader *r)
{
  return r->size - r->start.byte - r->at;
}

/* Moves the window on, so that it begins at the cursor. */
static void ReaderMove(Reader *r)
{
  size_t wanted, got;

  r->start = ReaderPlace(r);
  r->end -= r->at;
  memmove(r->data, r->data + r->at, r->end);
  r->at  = 0;
  wanted = PetscMin(WINDOW - r->end, r->size - r->start.byte - r->end);
  got    = fread(r->data + r->end, 1, wanted, r->stream);
  r->end += got;
  r->data[r->end] = '\0';
  if (got < wanted) r->size = r->start.byte + r->end; /* the file has become shorter */
}

/* Sees to it that the next bytes are in the window, as far as the file has them. */
static void ReaderNeed(Reader *r, size_t bytes)
{
  if (r->end - r->at < bytes && r->start.byte + r->end < r->size) ReaderMove(r);
}

static void SkipSpace(Reader *r)
{
  do {
    ReaderNeed(r, WINDOW_ROOM);
    while (r->at < r->end && isspace((unsigned char)r->data[r->at])) r->at++;
  } while (r->at == r->end && ReaderLeft(r));
}

/* Reads a number that a space follows: an integer, or a real one where integer is NULL. */
static void ReadNumber(Reader *r, long long *integer, double *real)
{
  Place       place = {0, 0};
  const char *text;
  char       *end;

  ReaderNeed(r, WINDOW_ROOM);
  if (strspn(r->data + r->at, " \t\r\n") >= WINDOW_ROOM / 2) {
    place = ReaderPlace(r);
    SkipSpace(r);
    ReaderNeed(r, WINDOW_ROOM);
  }
  text = r->data + r->at;
  if (integer)
    *integer = strtoll(text, &end, 10);
  else
    *real = strtod(text, &end);
  if (end == text || !isspace((unsigned char)*end))
    ReaderDamagedAt(r, place.line ? place : ReaderPlace(r));
  else
    r->at += (size_t)(end - text);
}

static void ReadBytes(Reader *r, void *value, size_t size)
{
  memset(value, 0, size);
  if (ReaderFailed(r)) return;
  ReaderNeed(r, size);
  if (r->end - r->at < size)
    ReaderDamaged(r);
  else {
    memcpy(value, r->data + r->at, size);
    r->at += size;
  }
}

static long long ReadTextInteger(Reader *r)
{
  long long value = 0;

  if (!ReaderFailed(r)) ReadNumber(r, &value, NULL);
  return value;
}

static int ReadInt(Reader *r)
{
  int value;

  if (!r->binary) return (int)ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

static long long ReadSize(Reader *r)
{
  int64_t value;

  if (!r->binary) return ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

/* Reads the number of items that follow. Each item takes at least one byte, so that a damaged count cannot ask for more
   memory than the size of the file. */
static PetscInt ReadCount(Reader *r)
{
  long long value = ReadSize(r);

  if (value < 0 || (size_t)value > ReaderLeft(r) || value > PETSC_MAX_INT) {
    ReaderDamaged(r);
    return 0;
  }
  return (PetscInt)value;
}

static PetscInt ReadTag(Reader *r)
{
  long long value = ReadSize(r);

  if (value >= 0 && value <= PETSC_MAX_INT) return (PetscInt)value;
  Complain(r->complaint, "%s: tag %lld does not fit into this build's index type", r->file, value);
  return 0; /* 0, so that differences of tags remain valid numbers */
}

static double ReadDouble(Reader *r)
{
  double value = 0;

  if (r->binary)
    ReadBytes(r, &value, sizeof(value));
  else if (!ReaderFailed(r))
    ReadNumber(r, NULL, &value);
  return value;
}

/* Reads the rest of the line, without the end of line. */
static void ReadLine(Reader *r, char *line, size_t size)
{
  size_t length;

  ReaderNeed(r, WINDOW_ROOM);
  length = strcspn(r->data + r->at, "\r\n");
  snprintf(line, size, "%.*s", (int)PetscMin(length, size - 1), r->data + r->at);
  for (r->at += length; r->at == r->end && ReaderLeft(r); r->at += length) {
    ReaderMove(r);
    length = strcspn(r->data, "\r\n");
  }
  ReaderNeed(r, WINDOW_ROOM);
  while (r->at < r->end && (r->data[r->at] == '\r' || r->data[r->at] == '\n')) {
    if (r->data[r->at++] == '\n') break;
  }
}

/* Sections */

static PetscErrorCode ReadFormat(Reader *r)
{
  char line[256], version[16] = "";
  int  binary = 0, size = 0, one = 1;

  PetscFunctionBeginUser;
  ReadLine(r, line, sizeof(line));
  if (sscanf(line, "%15s %d %d", version, &binary, &size) != 3)
    ReaderDamaged(r);
  else if (strcmp(version, "4.1")) {
    Complain(r->complaint,
             "%s: file format %s is not read, only gmsh's 4.1; convert it: gmsh %s -save -format msh41 -o NEW.msh",
             r->file, version, r->file);
  } else if (size != 8)
    Complain(r->complaint, "%s: written with data size %d, only 8 is read", r->file, size);
  if (!ReaderFailed(r) && binary) {
    r->binary = PETSC_TRUE;
    ReadBytes(r, &one, sizeof(one));
    if (one != 1)
      Complain(r->complaint,
               "%s: binary file of a machine with another byte order; write it as text: gmsh FILE.geo -format msh41 "
               "without -bin",
               r->file);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the names of physical groups, which are text in binary files too. */
static PetscErrorCode ReadPhysicalNames(Reader *r)
{
  PetscBool binary = r->binary;
  PetscInt  n;

  PetscFunctionBeginUser;
  r->binary = PETSC_FALSE;
  n         = ReadCount(r);
  PetscCall(PetscCalloc1(n, &r->mesh->physicals));
  for (PetscInt i = 0; i < n && !ReaderFailed(r); i++) {
    GmshPhysical *physical = &r->mesh->physicals[i];
    char          line[512];
    size_t        length;

    physical->dim = ReadInt(r);
    physical->tag = (PetscInt)ReadTextInteger(r);
    SkipSpace(r);
    ReadLine(r, line, sizeof(line));
    length = strlen(line);
    if (length < 3 || line[0] != '"' || line[length - 1] != '"')
      ReaderDamaged(r);
    else
      line[length - 1] = '\0';
    PetscCall(PetscStrallocpy(line + 1, &physical->name));
    r->mesh->n_physicals++;
  }
  r->binary = binary;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadEntities(Reader *r)
{
  PetscInt n[4], total = 0;

  PetscFunctionBeginUser;
  for (int dim = 0; dim < 4; dim++) {
    n[dim] = ReadCount(r);
    total += n[dim];
  }
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(total, &r->entities));
  for (int dim = 0; dim < 4; dim++) {
    for (PetscInt i = 0; i < n[dim] && !ReaderFailed(r); i++) {
      Entity *entity = &r->entities[r->n_entities++];

      entity->dim = dim;
      entity->tag = ReadInt(r);
      for (int k = 0; k < (dim ? 6 : 3); k++) (void)ReadDouble(r); /* coordinates of a point, or bounding box */
      entity->n = (int)ReadCount(r);
      PetscCall(PetscMalloc1(entity->n, &entity->physical));
      for (int k = 0; k < entity->n; k++) entity->physical[k] = ReadInt(r);
      if (!dim) continue;
      for (PetscInt k = ReadCount(r); k > 0; k--) (void)ReadInt(r); /* bounding entities */
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadNodes(Reader *r)
{
  PetscInt blocks = ReadCount(r), n = ReadCount(r), done = 0;

  PetscFunctionBeginUser;
  (void)ReadSize(r); /* smallest and largest tag */
  (void)ReadSize(r);
  PetscCall(PortionsNodes(r->portions, n));
  for (PetscInt b = 0; b < blocks && !ReaderFailed(r); b++) {
    int      dim        = ReadInt(r);
    int      parametric = (ReadInt(r), ReadInt(r)); /* skips the entity's tag */
    PetscInt in_block   = ReadCount(r);

    if (in_block > n - done || dim < 0 || dim > 3) ReaderDamaged(r);
    for (PetscInt i = 0; i < in_block && !ReaderFailed(r); i++)
      PetscCall(PortionsTag(r->portions, done + i, ReadTag(r)));
    for (PetscInt i = 0; i < in_block && !ReaderFailed(r); i++) {
      PetscReal x[3];

      for (int k = 0; k < 3; k++) x[k] = ReadDouble(r);
      for (int k = 0; parametric && k < dim; k++) (void)ReadDouble(r); /* parametric coordinates on the entity */
      PetscCall(PortionsPlace(r->portions, done + i, x));
    }
    done += in_block;
  }
  if (done != n) ReaderDamaged(r);
  r->has_nodes = n > 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void RefuseElement(Reader *r, int type, int dim, int entity)
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

static int PhysicalIndex(const GmshMesh *mesh, int dim, PetscInt tag)
{
  for (int i = 0; i < mesh->n_physicals; i++)
    if (mesh->physicals[i].dim == dim && mesh->physicals[i].tag == tag) return i;
  return -1;
}

/* Adds a group that has no name in the file; its number becomes its name. */
static PetscErrorCode AddPhysical(GmshMesh *mesh, int dim, PetscInt tag, int *index)
{
  char name[24];

  PetscFunctionBeginUser;
  snprintf(name, sizeof(name), "%" PetscInt_FMT, tag);
  *index = mesh->n_physicals++;
  PetscCall(PetscRealloc((size_t)mesh->n_physicals * sizeof(*mesh->physicals), &mesh->physicals));
  mesh->physicals[*index] = (GmshPhysical){.dim = dim, .tag = tag};
  PetscCall(PetscStrallocpy(name, &mesh->physicals[*index].name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds an entity; NULL: there is none. Blocks mostly follow the order of the entities, so that the next one is mostly
   right. */
static const Entity *FindEntity(Reader *r, int dim, int tag)
{
  for (PetscInt i = 0; i < r->n_entities; i++) {
    const PetscInt at = (r->found + i) % r->n_entities;

    if (r->entities[at].dim != dim || r->entities[at].tag != tag) continue;
    r->found = at;
    return &r->entities[at];
  }
  return NULL;
}

/* Finds the groups of the entity on which a block lies. */
static PetscErrorCode BlockPhysicals(Reader *r, int dim, int tag, GmshBlock *block)
{
  const Entity *entity = FindEntity(r, dim, tag);

  PetscFunctionBeginUser;
  if (!entity || !entity->n) PetscFunctionReturn(PETSC_SUCCESS);
  block->n_physicals = entity->n;
  PetscCall(PetscMalloc2(entity->n, &block->physical, entity->n, &block->sign));
  for (int i = 0; i < entity->n; i++) {
    const PetscInt physical = PetscAbsInt(entity->physical[i]);

    block->physical[i] = PhysicalIndex(r->mesh, dim, physical);
    block->sign[i]     = entity->physical[i] < 0 ? -1 : 1;
    if (block->physical[i] < 0) PetscCall(AddPhysical(r->mesh, dim, physical, &block->physical[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BlockFree(GmshBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(block->tag));
  PetscCall(PetscFree(block->connectivity));
  PetscCall(PetscFree2(block->physical, block->sign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the tags and nodes of a block's elements. */
static PetscErrorCode ReadBlockElements(Reader *r, GmshBlock *block)
{
  PetscInt nodes[ELEMENT_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(PortionsBlock(r->portions, block->nodes, block->n_all));
  for (PetscInt i = 0; i < block->n_all && !ReaderFailed(r); i++) {
    const PetscInt tag = ReadTag(r);

    if (!i) block->first_tag = tag;
    for (int k = 0; k < block->nodes && !ReaderFailed(r); k++) nodes[k] = ReadTag(r);
    if (!ReaderFailed(r)) PetscCall(PortionsElement(r->portions, tag, nodes));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadBlock(Reader *r)
{
  GmshMesh *mesh   = r->mesh;
  GmshBlock block  = {.dim = ReadInt(r)};
  int       entity = ReadInt(r), type = ReadInt(r);

  PetscFunctionBeginUser;
  block.n_all   = ReadCount(r);
  block.element = ElementFromGmsh(type);
  block.nodes   = block.element ? block.element->nodes : 1;
  if (!block.element && type != GMSH_POINT) RefuseElement(r, type, block.dim, entity);
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ReadBlockElements(r, &block));
  PetscCall(BlockPhysicals(r, block.dim, entity, &block));
  PetscCall(PetscRealloc((size_t)(mesh->n_blocks + 1) * sizeof(*mesh->blocks), &mesh->blocks));
  mesh->blocks[mesh->n_blocks++] = block;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadElements(Reader *r)
{
  PetscInt  blocks = ReadCount(r);
  long long n;

  PetscFunctionBeginUser;
  if (!r->has_nodes) ReaderDamaged(r); /* the section of nodes must come first */
  n = ReadSize(r);
  for (int i = 0; i < 2; i++) (void)ReadSize(r); /* smallest and largest tag */
  PetscCall(PortionsElements(r->portions, (PetscInt)PetscMin(n, PETSC_MAX_INT)));
  for (PetscInt b = 0; b < blocks && !ReaderFailed(r); b++) PetscCall(ReadBlock(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The whole file */

/* Moves behind $EndSECTION. With anywhere, a section that is not read is skipped; without it, $EndSECTION must come
   next. */
static void ReadClosing(Reader *r, PetscBool anywhere)
{
  char        closing[72];
  const char *end;
  Place       place;

  snprintf(closing, sizeof(closing), "$End%s", r->section + 1);
  SkipSpace(r);
  ReaderNeed(r, WINDOW_ROOM);
  place = ReaderPlace(r);
  while (!(end = memmem(r->data + r->at, anywhere ? r->end - r->at : PetscMin(r->end - r->at, strlen(closing)), closing,
                        strlen(closing))) &&
         anywhere && r->start.byte + r->end < r->size) {
    r->at = r->end - strlen(closing);
    ReaderMove(r);
  }
  if (!end)
    ReaderDamagedAt(r, place);
  else
    r->at = (size_t)(end - r->data) + strlen(closing);
}

/* Keeps the notes among the comments of the file. */
static PetscErrorCode ReadComments(Reader *r)
{
  const size_t start = strlen(NOTE);
  char         line[512];

  PetscFunctionBeginUser;
  for (ReaderNeed(r, WINDOW_ROOM); r->at < r->end && r->data[r->at] != '$'; ReaderNeed(r, WINDOW_ROOM)) {
    const size_t used = r->mesh->notes ? strlen(r->mesh->notes) : 0;

    ReadLine(r, line, sizeof(line));
    if (strncmp(line, NOTE, start)) continue;
    PetscCall(PetscRealloc(used + strlen(line) + 2, &r->mesh->notes));
    snprintf(r->mesh->notes + used, strlen(line) + 2, "%s\n", line + start);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const struct {
  const char *name;
  PetscErrorCode (*read)(Reader *);
} Sections[] = {{"$MeshFormat", ReadFormat}, {"$PhysicalNames", ReadPhysicalNames}, {"$Entities", ReadEntities},
                {"$Nodes", ReadNodes},       {"$Elements", ReadElements},           {"$Comments", ReadComments}};
/* One bit for each section, by its place in Sections. */
enum { SEEN_FORMAT = 1, SEEN_NAMES = 2, SEEN_NODES = 8, SEEN_ELEMENTS = 16 };

static PetscErrorCode ReadSection(Reader *r, unsigned *seen)
{
  int known = -1;

  PetscFunctionBeginUser;
  ReadLine(r, r->section, sizeof(r->section));
  r->section[strcspn(r->section, " \t")] = '\0';
  for (int i = 0; i < (int)(sizeof(Sections) / sizeof(*Sections)); i++)
    if (!strcmp(r->section, Sections[i].name)) known = i;
  if (!strcmp(r->section, "$PartitionedEntities"))
    Complain(r->complaint, "%s: the mesh is partitioned already; write it without partitions, ranks are given out here",
             r->file);
  if ((known != 0) != (*seen & SEEN_FORMAT))
    Complain(r->complaint, "%s: this is no gmsh mesh file (.msh, format 4.1)", r->file);
  if (ReaderFailed(r)) PetscFunctionReturn(PETSC_SUCCESS);
  if (known >= 0) {
    if (*seen & (1u << known)) ReaderDamaged(r); /* the section occurs twice */
    *seen |= 1u << known;
    if (!ReaderFailed(r)) PetscCall(Sections[known].read(r));
  }
  if (!ReaderFailed(r)) ReadClosing(r, known < 0 ? PETSC_TRUE : PETSC_FALSE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int ComparePhysicals(const void *a, const void *b)
{
  const GmshPhysical *p = a, *q = b;

  if (p->dim != q->dim) return p->dim > q->dim ? -1 : 1;
  return p->tag < q->tag ? -1 : p->tag > q->tag;
}

/* Sorts the groups by descending dimension, then by tag, and updates the groups of the blocks. */
static PetscErrorCode SortPhysicals(GmshMesh *mesh)
{
  GmshPhysical *old;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(mesh->n_physicals, &old));
  PetscCall(PetscArraycpy(old, mesh->physicals, mesh->n_physicals));
  qsort(mesh->physicals, (size_t)mesh->n_physicals, sizeof(*mesh->physicals), ComparePhysicals);
  for (int b = 0; b < mesh->n_blocks; b++) {
    for (int i = 0; i < mesh->blocks[b].n_physicals; i++) {
      const GmshPhysical *physical = &old[mesh->blocks[b].physical[i]];

      mesh->blocks[b].physical[i] = PhysicalIndex(mesh, physical->dim, physical->tag);
    }
  }
  PetscCall(PetscFree(old));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Checks that the file contains all that a mesh needs. */
static void CheckContents(Reader *r, unsigned seen)
{
  if (!(seen & SEEN_NODES)) Complain(r->complaint, "%s: the file has no nodes", r->file);
  if (!(seen & SEEN_ELEMENTS)) Complain(r->complaint, "%s: the file has no elements", r->file);
  if (!(seen & SEEN_NAMES))
    Complain(
      r->complaint,
      "%s: the file has no physical names; name volumes and surfaces in gmsh: Physical Volume(\"NAME\") = {...};",
      r->file);
}

static PetscErrorCode ReaderOpen(Reader *r)
{
  struct stat status;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(WINDOW + 1, &r->data));
  r->data[0]    = '\0';
  r->start.line = 1;
  r->stream     = fopen(r->file, "rb");
  if (r->stream && !fstat(fileno(r->stream), &status) && S_ISREG(status.st_mode))
    r->size = (size_t)status.st_size;
  else
    Complain(r->complaint, "%s: there is no such file, or it cannot be read", r->file);
  if (!r->size) Complain(r->complaint, "%s: the file is empty", r->file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Reads the file on the first rank: groups, blocks without elements, and the portions of all ranks. */
static PetscErrorCode ReadFile(const char *file, Portions *portions, GmshMesh *mesh, Complaint *complaint)
{
  Reader   r    = {.file = file, .complaint = complaint, .mesh = mesh, .portions = portions};
  unsigned seen = 0;

  PetscFunctionBeginUser;
  PetscCall(ReaderOpen(&r));
  for (SkipSpace(&r); ReaderLeft(&r) && !ReaderFailed(&r); SkipSpace(&r)) PetscCall(ReadSection(&r, &seen));
  if (r.stream) fclose(r.stream);
  PetscCall(PortionsEnd(portions));
  CheckContents(&r, seen);
  if (!ReaderFailed(&r)) PetscCall(SortPhysicals(mesh));
  for (PetscInt i = 0; i < r.n_entities; i++) PetscCall(PetscFree(r.entities[i].physical));
  PetscCall(PetscFree(r.entities));
  PetscCall(PetscFree(r.data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Nodes and elements of all ranks */

/* Entries of what is told of a block. The indices of its groups and their signs follow. */
enum { BLOCK_DIM, BLOCK_TYPE, BLOCK_NODES, BLOCK_ALL, BLOCK_FIRST_TAG, BLOCK_PHYSICALS, BLOCK_HEADER };

/* Writes down what is told of the blocks. Returns the number of entries. */
static PetscInt LoadBlocks(const GmshMesh *mesh, PetscInt *told)
{
  PetscInt n = 0;

  for (int b = 0; b < mesh->n_blocks; b++) {
    const GmshBlock *block = &mesh->blocks[b];

    if (told) {
      told[n + BLOCK_DIM]       = block->dim;
      told[n + BLOCK_TYPE]      = block->element ? block->element->gmsh : GMSH_POINT;
      told[n + BLOCK_NODES]     = block->nodes;
      told[n + BLOCK_ALL]       = block->n_all;
      told[n + BLOCK_FIRST_TAG] = block->first_tag;
      told[n + BLOCK_PHYSICALS] = block->n_physicals;
      for (int i = 0; i < block->n_physicals; i++) {
        told[n + BLOCK_HEADER + 2 * i]     = block->physical[i];
        told[n + BLOCK_HEADER + 2 * i + 1] = block->sign[i];
      }
    }
    n += BLOCK_HEADER + 2 * block->n_physicals;
  }
  return n;
}

/* Makes blocks without elements of what was told. */
static PetscErrorCode MakeBlocks(const PetscInt *told, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_blocks, &mesh->blocks));
  for (int b = 0; b < mesh->n_blocks; b++, told += BLOCK_HEADER + 2 * told[BLOCK_PHYSICALS]) {
    GmshBlock *block = &mesh->blocks[b];

    *block = (GmshBlock){.dim         = (int)told[BLOCK_DIM],
                         .element     = ElementFromGmsh((int)told[BLOCK_TYPE]),
                         .nodes       = (int)told[BLOCK_NODES],
                         .n_all       = told[BLOCK_ALL],
                         .first_tag   = told[BLOCK_FIRST_TAG],
                         .n_physicals = (int)told[BLOCK_PHYSICALS]};
    PetscCall(PetscMalloc2(block->n_physicals, &block->physical, block->n_physicals, &block->sign));
    for (int i = 0; i < block->n_physicals; i++) {
      block->physical[i] = (int)told[BLOCK_HEADER + 2 * i];
      block->sign[i]     = (int)told[BLOCK_HEADER + 2 * i + 1];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Tells all ranks of the blocks. */
static PetscErrorCode ShareBlocks(MPI_Comm comm, GmshMesh *mesh)
{
  PetscMPIInt rank, count;
  PetscInt    n[3] = {mesh->n_physicals, mesh->n_blocks, LoadBlocks(mesh, NULL)}, *told;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Bcast(n, 3, MPIU_INT, 0, comm));
  mesh->n_physicals = (int)n[0];
  mesh->n_blocks    = (int)n[1];
  PetscCall(PetscMPIIntCast(n[2], &count));
  PetscCall(PetscMalloc1(count, &told));
  if (!rank) LoadBlocks(mesh, told);
  PetscCallMPI(MPI_Bcast(told, count, MPIU_INT, 0, comm));
  if (rank) PetscCall(MakeBlocks(told, mesh));
  PetscCall(PetscFree(told));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A node on its way to the rank of its tag */
typedef struct {
  PetscInt  tag;
  PetscReal x[3];
} TravelNode;

static void PackNode(const void *context, PetscInt i, void *packed)
{
  const Portions *portions = context;
  TravelNode     *node     = packed;

  node->tag = portions->node_tag[i];
  for (int k = 0; k < 3; k++) node->x[k] = portions->coords[3 * i + k];
}

/* Gives the nodes to the ranks by ascending tag, because their order in the file is arbitrary. */
static PetscErrorCode SortNodes(MPI_Comm comm, const char *file, Portions *portions, GmshMesh *mesh,
                                Complaint *complaint)
{
  PetscMPIInt size, *to;
  PetscInt   *first, *order, *tags;
  TravelNode *nodes;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(portions->n_tags, &to));
  PetscCall(TagRangesChoose(comm, portions->n_tags, portions->node_tag, &first));
  for (PetscInt i = 0; i < portions->n_tags; i++) to[i] = TagRangesRank(size, first, portions->node_tag[i]);
  PetscCall(PetscFree(first));
  PetscCall(ExchangeRecords(comm, sizeof(TravelNode), portions->n_tags, to, PackNode, portions, &mesh->n_nodes,
                            (void **)&nodes));
  PetscCall(PetscFree(to));
  PetscCall(PetscFree(portions->node_tag));
  PetscCall(PetscFree(portions->coords));
  PetscCall(PetscMalloc2(mesh->n_nodes, &order, mesh->n_nodes, &tags));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    order[i] = i;
    tags[i]  = nodes[i].tag;
  }
  PetscCall(PetscSortIntWithPermutation(mesh->n_nodes, tags, order));
  PetscCall(PetscMalloc2(mesh->n_nodes, &mesh->node_tag, 3 * mesh->n_nodes, &mesh->coords));
  for (PetscInt i = 0; i < mesh->n_nodes; i++) {
    mesh->node_tag[i] = tags[order[i]];
    for (int k = 0; k < 3; k++) mesh->coords[3 * i + k] = nodes[order[i]].x[k];
    if (i && mesh->node_tag[i] == mesh->node_tag[i - 1])
      Complain(complaint, "%s: node %" PetscInt_FMT " occurs twice", file, mesh->node_tag[i]);
  }
  PetscCall(PetscFree(nodes));
  PetscCall(PetscFree2(order, tags));
  PetscCall(PetscMalloc1(size + 1, &mesh->node_start));
  mesh->node_start[0] = 0;
  PetscCallMPI(MPI_Allgather(&mesh->n_nodes, 1, MPIU_INT, mesh->node_start + 1, 1, MPIU_INT, comm));
  for (PetscMPIInt r = 0; r < size; r++) mesh->node_start[r + 1] += mesh->node_start[r];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gives the blocks this rank's elements. Their nodes are tags yet. */
static PetscErrorCode TakeElements(Portions *portions, GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < portions->n_blocks; b++) {
    PortionBlock *portion = &portions->blocks[b];

    mesh->blocks[b].n            = portion->n;
    mesh->blocks[b].tag          = portion->tag;
    mesh->blocks[b].connectivity = portion->connectivity;
    portion->tag = portion->connectivity = NULL;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Lists the tags of the nodes of this rank's elements. */
static PetscErrorCode ListTags(const GmshMesh *mesh, IntegerSet *tags)
{
  PetscInt        *size;
  const PetscInt **list;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(mesh->n_blocks, &size, mesh->n_blocks, &list));
  for (int b = 0; b < mesh->n_blocks; b++) {
    size[b] = mesh->blocks[b].n * mesh->blocks[b].nodes;
    list[b] = mesh->blocks[b].connectivity;
  }
  PetscCall(IntegerSetCreate(mesh->n_blocks, size, list, tags));
  PetscCall(PetscFree2(size, list));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void PackInteger(const void *context, PetscInt i, void *packed)
{
  *(PetscInt *)packed = ((const PetscInt *)context)[i];
}

/* Says to which rank a question about each of the tags goes, which ascend: the last one whose first tag is not larger.
 */
static PetscErrorCode ChooseAsked(MPI_Comm comm, const GmshMesh *mesh, PetscInt n, const PetscInt tags[],
                                  PetscMPIInt to[])
{
  PetscMPIInt size, asked = 0;
  PetscInt   *first, mine = mesh->n_nodes ? mesh->node_tag[0] : PETSC_MAX_INT;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &size));
  PetscCall(PetscMalloc1(size, &first));
  PetscCallMPI(MPI_Allgather(&mine, 1, MPIU_INT, first, 1, MPIU_INT, comm));
  for (PetscInt i = 0; i < n; i++) {
    for (PetscMPIInt r = asked + 1; r < size; r++)
      if (first[r] <= tags[i]) asked = r;
    to[i] = asked;
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Finds the places of nodes by their tags, which ascend; -1: there is no such node. Marks them as used. */
static PetscErrorCode FindNodes(MPI_Comm comm, const GmshMesh *mesh, PetscInt n, const PetscInt tags[],
                                PetscInt **places, char used[])
{
  PetscMPIInt rank, *to, *from;
  PetscInt    n_asked, n_answers, *asked;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscMalloc1(n, &to));
  PetscCall(ChooseAsked(comm, mesh, n, tags, to));
  PetscCall(ExchangeSources(comm, n, to, &from));
  PetscCall(ExchangeRecords(comm, sizeof(PetscInt), n, to, PackInteger, tags, &n_asked, (void **)&asked));
  for (PetscInt i = 0; i < n_asked; i++) {
    PetscInt place;

    PetscCall(PetscFindInt(asked[i], mesh->n_nodes, mesh->node_tag, &place));
    asked[i] = place < 0 ? -1 : mesh->node_start[rank] + place;
    if (place >= 0) used[place] = 1;
  }
  PetscCall(ExchangeRecords(comm, sizeof(PetscInt), n_asked, from, PackInteger, asked, &n_answers, (void **)places));
  PetscCall(PetscFree(asked));
  PetscCall(PetscFree(from));
  PetscCall(PetscFree(to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Replaces the tags of the elements' nodes by their places, and looks for nodes that are not there or not used. */
static PetscErrorCode PlaceNodes(MPI_Comm comm, const char *file, GmshMesh *mesh, Complaint *missing, Complaint *unused)
{
  IntegerSet tags;
  PetscInt  *places;
  char      *used;

  PetscFunctionBeginUser;
  PetscCall(ListTags(mesh, &tags));
  PetscCall(PetscCalloc1(mesh->n_nodes, &used));
  PetscCall(FindNodes(comm, mesh, tags.n, tags.value, &places, used));
  for (int b = 0; b < mesh->n_blocks; b++) {
    const GmshBlock *block = &mesh->blocks[b];

    for (PetscInt k = 0; k < block->n * block->nodes; k++) {
      const PetscInt tag = block->connectivity[k];
      const PetscInt at  = IntegerSetPlace(&tags, tag);

      block->connectivity[k] = places[at];
      if (places[at] < 0)
        Complain(missing, "%s: element %" PetscInt_FMT " has node %" PetscInt_FMT ", which is not in the file", file,
                 block->tag[k / block->nodes], tag);
    }
  }
  for (PetscInt i = 0; i < mesh->n_nodes; i++)
    if (!used[i]) Complain(unused, "%s: node %" PetscInt_FMT " belongs to no element", file, mesh->node_tag[i]);
  PetscCall(IntegerSetDestroy(&tags));
  PetscCall(PetscFree(places));
  PetscCall(PetscFree(used));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves out the blocks that belong to no physical group. */
static PetscErrorCode DropBlocks(GmshMesh *mesh)
{
  int n = 0;

  PetscFunctionBeginUser;
  for (int b = 0; b < mesh->n_blocks; b++) {
    if (mesh->blocks[b].n_physicals)
      mesh->blocks[n++] = mesh->blocks[b];
    else
      PetscCall(BlockFree(&mesh->blocks[b]));
  }
  mesh->n_blocks = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Puts the portions of all ranks together. */
static PetscErrorCode JoinPortions(MPI_Comm comm, const char *file, Portions *portions, GmshMesh *mesh,
                                   Complaint *complaint)
{
  Complaint missing = {""};
  PetscBool failed;

  PetscFunctionBeginUser;
  PetscCall(ComplaintAnywhere(comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShareBlocks(comm, mesh));
  PetscCall(SortNodes(comm, file, portions, mesh, complaint));
  PetscCall(TakeElements(portions, mesh));
  PetscCall(ComplaintAnywhere(comm, complaint, &failed));
  if (failed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PlaceNodes(comm, file, mesh, &missing, complaint));
  PetscCall(ComplaintAnywhere(comm, &missing, &failed));
  if (failed) *complaint = missing;
  PetscCall(DropBlocks(mesh));
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
  PetscCall(JoinPortions(comm, file, &portions, mesh, complaint));
  PetscCall(PortionsReset(&portions));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshFreeElements - frees this rank's elements of a block.

  Not collective

  Input Parameter:
. block - has none afterwards
@*/
PetscErrorCode GmshFreeElements(GmshBlock *block)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(block->tag));
  PetscCall(PetscFree(block->connectivity));
  block->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshFreeBlocks - frees all blocks.

  Not collective

  Input Parameter:
. mesh - its nodes and groups stay
@*/
PetscErrorCode GmshFreeBlocks(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  for (int b = 0; b < mesh->n_blocks; b++) PetscCall(BlockFree(&mesh->blocks[b]));
  PetscCall(PetscFree(mesh->blocks));
  mesh->n_blocks = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  GmshReset - frees what GmshRead() made.

  Not collective

  Input Parameter:
. mesh - emptied
@*/
PetscErrorCode GmshReset(GmshMesh *mesh)
{
  PetscFunctionBeginUser;
  PetscCall(GmshFreeBlocks(mesh));
  for (int i = 0; mesh->physicals && i < mesh->n_physicals; i++) PetscCall(PetscFree(mesh->physicals[i].name));
  PetscCall(PetscFree(mesh->physicals));
  PetscCall(PetscFree(mesh->notes));
  PetscCall(PetscFree2(mesh->node_tag, mesh->coords));
  PetscCall(PetscFree(mesh->node_start));
  *mesh = (GmshMesh){0};
  PetscFunctionReturn(PETSC_SUCCESS);
}
