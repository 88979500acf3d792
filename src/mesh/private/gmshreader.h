/* A cursor over one of gmsh's mesh files, text or binary, of which a window is in memory. GmshReaderOpen() opens the
   file, GmshReaderClose() closes it. After the first mistake every read returns 0, so that loops end. */
#pragma once
#include "base/complaint.h"
#include <stdio.h>

/* A place in the file, for messages */
typedef struct {
  size_t byte, line;
} GmshPlace;

typedef struct {
  const char *file;
  FILE       *stream;
  size_t      size;    /* of the file */
  char       *data;    /* the window, followed by a zero */
  size_t      end, at; /* bytes in the window, and the next one */
  GmshPlace   start;   /* of the window */
  PetscBool   binary;
  char        section[64];
  Complaint  *complaint;
} GmshReader;

PetscErrorCode GmshReaderOpen(GmshReader *);
PetscErrorCode GmshReaderClose(GmshReader *);
PetscBool      GmshReaderFailed(const GmshReader *);
void           GmshReaderDamaged(GmshReader *);
size_t         GmshReaderLeft(const GmshReader *);
void           GmshReaderSkipSpace(GmshReader *);
int            GmshReaderPeek(GmshReader *);
int            GmshReaderInt(GmshReader *);
long long      GmshReaderSize(GmshReader *);
PetscInt       GmshReaderCount(GmshReader *);
PetscInt       GmshReaderTag(GmshReader *);
double         GmshReaderDouble(GmshReader *);
void           GmshReaderLine(GmshReader *, char *line, size_t size);
void           GmshReaderClosing(GmshReader *, PetscBool anywhere);
