/* The directory of a run's results: whether a run may write into it, and what stands in it besides the results.

   A record of the scene, scene.yaml (the file's name, then the scene's text after -set), tells the next run whose
   results lie there. RunDirectoryCheckPath() and RunDirectoryCheck() or, for a restart, RunDirectoryCheckRestart()
   comes before anything is written or solved and refuses a directory that belongs to another scene. RunDirectoryMake()
   then makes the directory; RunDirectoryClear() removes what an earlier run left, RunDirectoryClearSummary() only what
   a restart writes anew, and RunDirectoryWriteRecord() writes the record. Knows the names of the files, not what is in
   them. */
#pragma once
#include "scene/scene.h"

PetscErrorCode RunDirectoryCheckPath(MPI_Comm, const char *directory);
PetscErrorCode RunDirectoryCheck(MPI_Comm, Scene, const char *directory, PetscBool overwrite);
PetscErrorCode RunDirectoryCheckRestart(MPI_Comm, Scene, const char *directory);
PetscErrorCode RunDirectoryMake(MPI_Comm, const char *directory);
void           RunDirectoryClear(const char *directory);
void           RunDirectoryClearSummary(const char *directory);
PetscErrorCode RunDirectoryWriteRecord(Scene, const char *directory);
