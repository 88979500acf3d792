/* Text files that stand in a directory as a whole or not at all. TextFileReplace() writes the text under a temporary
   name and renames it, so that a reader never sees a part of it and a killed run leaves the file that was there before.
   TextFileRead() reads such a file back. Both are for one rank; they know names and characters, not what they mean. */
#pragma once
#include "base/petsccompat.h"

/* Room for the path of one of our files: a directory and a name of at most 30 characters. */
enum { TEXTFILE_PATH_SIZE = PETSC_MAX_PATH_LEN + 32 };

PetscErrorCode TextFileReplace(const char *directory, const char *name, const char *text);
char          *TextFileRead(const char *directory, const char *name);
