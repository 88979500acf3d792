/* Roles of slave and master that a run takes the other way round, because the mesh shows an edge of the master that
   stands on the slave.

   SceneMaySwapRoles() says whether the scene leaves the roles of a pair to the run, SceneSwapRoles() swaps them. */
#pragma once
#include "scene/scene.h"

PetscBool SceneMaySwapRoles(Scene, const SceneContact *);
void      SceneSwapRoles(Scene, SceneContact *);
