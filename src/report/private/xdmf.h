/* results.xdmf: the text through which ParaView reads results.vtkhdf. XdmfWrite() writes it anew for all steps. */
#pragma once
#include "fieldsindex.h"

PetscErrorCode XdmfWrite(const FieldsIndex *, const char *directory);
