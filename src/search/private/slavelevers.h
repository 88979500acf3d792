/* The levers of slave points, see SlavePoints. */
#pragma once
#include "search/slavepoints.h"

PetscErrorCode SlaveLeversOnFaces(SlavePoints);
PetscErrorCode SlaveLeversAroundNodes(SlavePoints, PetscInt n_records, const FaceRecord *);
PetscErrorCode SlaveLeversDestroy(SlavePoints);
