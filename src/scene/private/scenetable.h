/* Tables of a scene that stand in files of their own: {csv: FILE, column: 2} in the place of a list of pairs.

   SceneReadTables() puts the numbers of the files into the document, before the schema is checked. The text of the
   scene has them from then on, so that a restart needs no such file, and results of another table are those of another
   scene.
 */
#pragma once
#include "document.h"

PetscErrorCode SceneReadTables(Document *, const char *file);
