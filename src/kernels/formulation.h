/* The choices that decide which kernel a body's cells need: geometry, kinematics and element formulation. Plain C. The
   scene names them (scene.h), KernelCase (elementkernel.h) carries them to the kernels. */
#pragma once

typedef enum { GEOMETRY_SOLID, GEOMETRY_PLANE_STRAIN, GEOMETRY_AXISYMMETRIC } Geometry;
typedef enum { KINEMATICS_SMALL, KINEMATICS_FINITE } Kinematics;
typedef enum { FORMULATION_FULL, FORMULATION_ENHANCED, FORMULATION_FBAR, FORMULATIONS } Formulation;

extern const char *const Formulations[]; /* their words in a scene, NULL-terminated */
