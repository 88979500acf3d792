/* Formulations of bodies and of contact pairs for which the scene leaves the choice and the shape of the cells decides.
 */
#pragma once
#include "rootmesh.h"

PetscErrorCode FormulationsChoose(Scene, const RootMesh *, Mesh);
PetscErrorCode ContactFormulationsChoose(Scene, const RootMesh *, Mesh);
void           FormulationsCrowded(SceneBody *);
