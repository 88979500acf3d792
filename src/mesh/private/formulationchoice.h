/* Formulations of bodies and of contact pairs for which the scene leaves the choice and the shape of the cells decides.
 */
#pragma once
#include "slicemesh.h"

PetscErrorCode FormulationsChoose(Scene, const SliceMesh *, Mesh);
PetscErrorCode ContactFormulationsChoose(Scene, const SliceMesh *, Mesh);
void           FormulationsCrowded(SceneBody *);
