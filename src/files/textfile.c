/* Text files that are read and replaced as a whole, see textfile.h. */
#include "files/textfile.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/*@
  TextFileReplace - writes a text file under a temporary name and then gives it its own name.

  Not collective

  Input Parameters:
+ directory - where the file stands; it exists
. name      - of the file in the directory
- text      - its whole contents

  Note:
  For one rank. The temporary name is that of the file with ".tmp" behind it. Errors: PETSC_ERR_FILE_OPEN and
  PETSC_ERR_FILE_WRITE; a file that had the name before is then still intact.
@*/
PetscErrorCode TextFileReplace(const char *directory, const char *name, const char *text)
{
  char  path[TEXTFILE_PATH_SIZE], temporary[TEXTFILE_PATH_SIZE + 8];
  FILE *file;
  int   failed;

  PetscFunctionBeginUser;
  snprintf(path, sizeof(path), "%s/%s", directory, name);
  snprintf(temporary, sizeof(temporary), "%s.tmp", path);
  file = fopen(temporary, "w");
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "Cannot write %s: %s", temporary, strerror(errno));
  failed = fputs(text, file) < 0;
  failed = fclose(file) || failed;
  PetscCheck(!failed && !rename(temporary, path), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "Cannot write %s: %s", path,
             strerror(errno));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@
  TextFileRead - reads a whole text file.

  Not collective

  Input Parameters:
+ directory - where the file stands
- name      - of the file in the directory

  Note:
  For one rank. It returns the text, which the caller frees with free(), or NULL where there is no such file or nothing
  in it.
@*/
char *TextFileRead(const char *directory, const char *name)
{
  char   path[TEXTFILE_PATH_SIZE], *text = NULL;
  size_t room = 0;
  FILE  *file;

  snprintf(path, sizeof(path), "%s/%s", directory, name);
  file = fopen(path, "r");
  if (!file) return NULL;
  if (getdelim(&text, &room, '\0', file) < 0) {
    free(text);
    text = NULL;
  }
  fclose(file);
  return text;
}
