/* The choices that decide which kernel the cells of a body need: geometry, kinematics and element formulation. Plain C.
   The user names them in the scene (scene.h). They reach the kernels in a KernelCase (elementkernel.h). */
#pragma once

typedef enum { GEOMETRY_SOLID, GEOMETRY_PLANE_STRAIN, GEOMETRY_AXISYMMETRIC } Geometry;
typedef enum { KINEMATICS_SMALL, KINEMATICS_FINITE } Kinematics;
typedef enum { FORMULATION_FULL, FORMULATION_ENHANCED, FORMULATION_FBAR, FORMULATION_MIXED, FORMULATIONS } Formulation;

extern const char *const Formulations[]; /* words of the formulations in a scene, NULL-terminated */
