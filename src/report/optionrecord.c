/* PETSc's options as texts "-name value", compared between the parts of a run. */
#define _GNU_SOURCE /* open_memstream() */
#include "optionrecord.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

/*@
  OptionRecordCreate - notes the PETSc options that hold now.

  Not collective

  Output Parameter:
. record - to be freed with OptionRecordDestroy()
@*/
PetscErrorCode OptionRecordCreate(OptionRecord *record)
{
  PetscFunctionBeginUser;
  *record = (OptionRecord){0};
  PetscCall(PetscOptionsGetAll(NULL, &record->now));
  PetscCall(PetscStrallocpy("", &record->changes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OptionRecordDestroy - frees a record.

  Not collective

  Input Parameter:
. record - from OptionRecordCreate()
@*/
PetscErrorCode OptionRecordDestroy(OptionRecord *record)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(record->now));
  PetscCall(PetscFree(record->changes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cuts the first option "-name value" off a text and returns it, NULL at the end. A value may begin with a minus and a
   digit, a name begins with a minus and a letter. */
static char *CutOption(char **text)
{
  char *option = *text + strspn(*text, " "), *end = option;

  if (!*option) return NULL;
  for (end++; *end && !(end[-1] == ' ' && *end == '-' && isalpha((unsigned char)end[1]));) end++;
  *text = end;
  for (char *last = end - 1; last > option && *last == ' '; last--) *last = '\0';
  return option;
}

/* Copies the option of the same name out of a text. Returns whether there is one. */
static PetscErrorCode FindOption(const char *text, const char *option, char **found)
{
  const size_t n = strcspn(option, " ");
  char        *copy, *rest, *other;

  PetscFunctionBeginUser;
  *found = NULL;
  PetscCall(PetscStrallocpy(text, &copy));
  rest = copy;
  while (!*found && (other = CutOption(&rest)))
    if (strcspn(other, " ") == n && !strncmp(option, other, n)) PetscCall(PetscStrallocpy(other, found));
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The value of an option, for a message */
static const char *ValueOf(const char *option)
{
  const char *blank = strchr(option, ' ');

  return blank ? blank + 1 : "no value";
}

/* Writes a line for each option of `text` that `other` does not have; with values, for each that has another value
   there too. */
static PetscErrorCode PrintDifferences(const char *text, const char *other, PetscInt step, const char *absent,
                                       PetscBool values, FILE *stream)
{
  char *copy, *rest, *option, *found;

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(text, &copy));
  rest = copy;
  while ((option = CutOption(&rest))) {
    PetscCall(FindOption(other, option, &found));
    if (!found)
      fprintf(stream, "after step %" PetscInt_FMT ": %s %s\n", step, option, absent);
    else if (values && strcmp(option, found))
      fprintf(stream, "after step %" PetscInt_FMT ": %s instead of %s\n", step, option, ValueOf(found));
    PetscCall(PetscFree(found));
  }
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the differences between the options before a restart and those that hold now. */
static PetscErrorCode AddChanges(OptionRecord *record, const char *before, PetscInt step)
{
  char  *lines = NULL;
  size_t size;
  FILE  *stream = open_memstream(&lines, &size);

  PetscFunctionBeginUser;
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for the options");
  fputs(record->changes, stream);
  PetscCall(PrintDifferences(record->now, before, step, "is new", PETSC_TRUE, stream));
  PetscCall(PrintDifferences(before, record->now, step, "is no longer set", PETSC_FALSE, stream));
  PetscCheck(!fclose(stream), PETSC_COMM_SELF, PETSC_ERR_MEM, "No memory for the options");
  record->latest = strlen(record->changes);
  PetscCall(PetscFree(record->changes));
  PetscCall(PetscStrallocpy(lines, &record->changes));
  free(lines);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OptionRecordArchive - saves the options, or notes how they differ from the loaded ones.

  Collective

  Input Parameters:
+ record  - its options stay those that hold now
. step    - number of the loaded step, for the text
- archive - the archive
@*/
PetscErrorCode OptionRecordArchive(OptionRecord *record, PetscInt step, Archive archive)
{
  char *options = record->now, *changes = record->changes;

  PetscFunctionBeginUser;
  PetscCall(ArchiveText(archive, "options/petsc", &options));
  PetscCall(ArchiveText(archive, "options/changes", &changes));
  if (!ArchiveLoads(archive)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree(record->changes));
  record->changes = changes;
  PetscCall(AddChanges(record, options, step));
  PetscCall(PetscFree(options));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  OptionRecordPrint - prints a line for each option that the last restart changed.

  Not collective

  Input Parameters:
+ record - the record
- stream - where to
@*/
void OptionRecordPrint(const OptionRecord *record, FILE *stream)
{
  for (const char *line = record->changes + record->latest; *line; line += strcspn(line, "\n") + 1)
    fprintf(stream, "options  changed %.*s\n", (int)strcspn(line, "\n"), line);
}
