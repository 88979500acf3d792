/* Bodies that no support and no imposed displacement holds, by name: for messages about singular systems. */
#pragma once
#include "bodies/loads.h"

/* "'ring', 'shaft'"; empty: there is none. Collective. */
PetscErrorCode LooseBodies(Mesh, Scene, Loads, char *text, size_t size);
