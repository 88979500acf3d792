/* A window over one of gmsh's files, from which numbers and lines are read. */
#define _GNU_SOURCE 1 /* for memmem() */
#include "gmshreader.h"
#include <ctype.h>
#include <stdint.h>
#include <string.h>
#include <stdlib.h>
#include <sys/stat.h>

/* Bytes of the file that are in memory at a time, and those that a number or a line needs at most. Of longer lines the
   rest is skipped. */
enum { WINDOW = 1 << 18, WINDOW_ROOM = 1024 };

/*@
  GmshReaderFailed - has there been a mistake?

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()
@*/
PetscBool GmshReaderFailed(const GmshReader *r)
{
  return r->complaint->text[0] ? PETSC_TRUE : PETSC_FALSE;
}

/* Where the cursor is. */
static GmshPlace ReaderPlace(const GmshReader *r)
{
  GmshPlace place = {r->start.byte + r->at, r->start.line};

  for (size_t i = 0; i < r->at; i++) place.line += r->data[i] == '\n';
  return place;
}

/* Complains that the file is truncated or damaged at a place. */
static void ReaderDamagedAt(GmshReader *r, GmshPlace place)
{
  if (r->binary)
    Complain(r->complaint, "%s: the file is truncated or damaged in section %s (byte %zu of %zu)", r->file, r->section,
             place.byte, r->size);
  else
    Complain(r->complaint, "%s:%zu: the file is truncated or damaged in section %s", r->file, place.line, r->section);
}

/*@
  GmshReaderDamaged - complains that the file is truncated or damaged at the cursor.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen(); an earlier complaint stays
@*/
void GmshReaderDamaged(GmshReader *r)
{
  if (!GmshReaderFailed(r)) ReaderDamagedAt(r, ReaderPlace(r));
}

/*@
  GmshReaderLeft - returns how many bytes of the file are not read yet.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()
@*/
size_t GmshReaderLeft(const GmshReader *r)
{
  return r->size - r->start.byte - r->at;
}

/* Moves the window on, so that it begins at the cursor. */
static void ReaderMove(GmshReader *r)
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
static void ReaderNeed(GmshReader *r, size_t bytes)
{
  if (r->end - r->at < bytes && r->start.byte + r->end < r->size) ReaderMove(r);
}

/*@
  GmshReaderSkipSpace - moves the cursor to the next character that is no white space.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()
@*/
void GmshReaderSkipSpace(GmshReader *r)
{
  do {
    ReaderNeed(r, WINDOW_ROOM);
    while (r->at < r->end && isspace((unsigned char)r->data[r->at])) r->at++;
  } while (r->at == r->end && GmshReaderLeft(r));
}

/* Reads a number that a space follows: an integer, or a real one where integer is NULL. */
static void ReadNumber(GmshReader *r, long long *integer, double *real)
{
  GmshPlace   place = {0, 0};
  const char *text;
  char       *end;

  ReaderNeed(r, WINDOW_ROOM);
  if (strspn(r->data + r->at, " \t\r\n") >= WINDOW_ROOM / 2) {
    place = ReaderPlace(r);
    GmshReaderSkipSpace(r);
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

static void ReadBytes(GmshReader *r, void *value, size_t size)
{
  memset(value, 0, size);
  if (GmshReaderFailed(r)) return;
  ReaderNeed(r, size);
  if (r->end - r->at < size)
    GmshReaderDamaged(r);
  else {
    memcpy(value, r->data + r->at, size);
    r->at += size;
  }
}

static long long ReadTextInteger(GmshReader *r)
{
  long long value = 0;

  if (!GmshReaderFailed(r)) ReadNumber(r, &value, NULL);
  return value;
}

/*@
  GmshReaderInt - reads an integer that has four bytes in a binary file.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()

  Note:
  Returns 0 after a mistake.
@*/
int GmshReaderInt(GmshReader *r)
{
  int value;

  if (!r->binary) return (int)ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

/*@
  GmshReaderSize - reads an integer that has eight bytes in a binary file.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()

  Note:
  Returns 0 after a mistake.
@*/
long long GmshReaderSize(GmshReader *r)
{
  int64_t value;

  if (!r->binary) return ReadTextInteger(r);
  ReadBytes(r, &value, sizeof(value));
  return value;
}

/*@
  GmshReaderCount - reads the number of items that follow.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()

  Note:
  Each item takes at least one byte, so that a damaged count cannot ask for more memory than the size of the file.
  Returns 0 after a mistake.
@*/
PetscInt GmshReaderCount(GmshReader *r)
{
  long long value = GmshReaderSize(r);

  if (value < 0 || (size_t)value > GmshReaderLeft(r) || value > PETSC_MAX_INT) {
    GmshReaderDamaged(r);
    return 0;
  }
  return (PetscInt)value;
}

/*@
  GmshReaderTag - reads the tag of a node or an element.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()

  Note:
  Returns 0 after a mistake, also for a tag that does not fit into an index.
@*/
PetscInt GmshReaderTag(GmshReader *r)
{
  long long value = GmshReaderSize(r);

  if (value >= 0 && value <= PETSC_MAX_INT) return (PetscInt)value;
  Complain(r->complaint, "%s: tag %lld does not fit into this build's index type", r->file, value);
  return 0; /* 0, so that differences of tags remain valid numbers */
}

/*@
  GmshReaderDouble - reads a real number.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()

  Note:
  Returns 0 after a mistake.
@*/
double GmshReaderDouble(GmshReader *r)
{
  double value = 0;

  if (r->binary)
    ReadBytes(r, &value, sizeof(value));
  else if (!GmshReaderFailed(r))
    ReadNumber(r, NULL, &value);
  return value;
}

/*@
  GmshReaderLine - reads the rest of the line.

  Not collective

  Input Parameters:
+ r    - from GmshReaderOpen()
- size - bytes of line

  Output Parameter:
. line - without the end of line, cut off where it is full
@*/
void GmshReaderLine(GmshReader *r, char *line, size_t size)
{
  size_t length;

  ReaderNeed(r, WINDOW_ROOM);
  length = strcspn(r->data + r->at, "\r\n");
  snprintf(line, size, "%.*s", (int)PetscMin(length, size - 1), r->data + r->at);
  for (r->at += length; r->at == r->end && GmshReaderLeft(r); r->at += length) {
    ReaderMove(r);
    length = strcspn(r->data, "\r\n");
  }
  ReaderNeed(r, WINDOW_ROOM);
  while (r->at < r->end && (r->data[r->at] == '\r' || r->data[r->at] == '\n')) {
    if (r->data[r->at++] == '\n') break;
  }
}

/*@
  GmshReaderPeek - returns the next character without reading it, EOF at the end of the file.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()
@*/
int GmshReaderPeek(GmshReader *r)
{
  ReaderNeed(r, WINDOW_ROOM);
  return r->at < r->end ? (unsigned char)r->data[r->at] : EOF;
}

/*@
  GmshReaderClosing - moves behind $EndSECTION.

  Not collective

  Input Parameters:
+ r        - its section is the one that ends
- anywhere - whether a section that is not read is skipped; otherwise $EndSECTION must come next
@*/
void GmshReaderClosing(GmshReader *r, PetscBool anywhere)
{
  char        closing[72];
  const char *end;
  GmshPlace   place;

  snprintf(closing, sizeof(closing), "$End%s", r->section + 1);
  GmshReaderSkipSpace(r);
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

/*@
  GmshReaderOpen - opens a file.

  Not collective

  Input Parameter:
. r - its file and complaint are set, all else is zero; to be closed with GmshReaderClose(), also after a
  complaint
@*/
PetscErrorCode GmshReaderOpen(GmshReader *r)
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

/*@
  GmshReaderClose - closes the file.

  Not collective

  Input Parameter:
. r - from GmshReaderOpen()
@*/
PetscErrorCode GmshReaderClose(GmshReader *r)
{
  PetscFunctionBeginUser;
  if (r->stream) fclose(r->stream);
  PetscCall(PetscFree(r->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}
