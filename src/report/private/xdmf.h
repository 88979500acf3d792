/* results.xdmf and bodies.xdmf: the texts through which ParaView and meshio read results.vtkhdf. XdmfWrite() writes them
   anew for all steps. */
#pragma once
#include "fieldsindex.h"

PetscErrorCode XdmfWrite(const FieldsIndex *, const char *directory);
