/* Element kernels: energy, internal force and tangent of cells, total Lagrangian, and the loads on faces and cells.
   Plain C: no PETSc, no MPI, no allocation.

   ElementKernel() treats a batch of KERNEL_LANES elements of one type, law, geometry, kinematics and formulation. Its
   arrays are [node][dim][lane], so that the inner loops vectorise. A short batch repeats its last element.
   ElementAcceptState() takes the plastic state on to given displacements; ElementStatePoints() counts its points,
   ElementStates() the numbers of each, and ElementStateVolumes() gives their volumes. ElementKernelExists() tells
   whether there is a kernel for a case. ElementBatchStates() and ElementBatchNominal() evaluate a state. The other
   functions treat one cell or one face: ElementPointState(), ElementPointStress(), ElementStress() and
   ElementVolumeEnergy() evaluate a state, ElementQuality(), CellVolume() and CellLength() a shape, FaceLoadKernel() and
   BodyForceKernel() the loads, FaceAreaKernel() the areas of a face's nodes, FaceMassKernel() what springs on a face
   need.

   K may extrapolate the stress of its geometric part from an earlier state (stressreference.h), where
   ElementExtrapolates().

   ElementPressures(), ElementVolumeModuli(), ElementDilatation(), ElementFollow() and ElementYield() are for mixed
   elements, whose multipliers the caller holds. ElementNodes() counts nodes with those of pressures.

   Source of the forms: Bonet and Wood, "Nonlinear Continuum Mechanics for Finite Element Analysis". */
#pragma once
#include "kernels/element.h"
#include "kernels/formulation.h"
#include "kernels/material.h"
#include "kernels/stressreference.h"
#include "kernels/vonmises.h"

/* Number of elements in a batch. It must be a multiple of LANES, which is 8 at most. */
enum { KERNEL_LANES = 8 };
/* The largest number of pressures of a mixed element: a linear pressure in space */
enum { MIXED_PRESSURES = 4 };

/* The accepted state of the points of a plastic batch, and the time since then. ElementKernel() and
   ElementAcceptState() take all lanes, the functions that treat one cell take `lane` alone. */
typedef struct {
  const Hardening *hardening;
  Umat            *umat; /* in the place of hardening, or NULL */
  double           t, dt;
  double          *state; /* [ElementStatePoints()][ElementStates()][lanes] */
  int              lane;
  int              number[KERNEL_LANES]; /* of the elements, for umat */
  double           length[KERNEL_LANES]; /* CellLength() of the elements, for umat */
  double           origin[3];            /* of the coordinates X, for umat */
  int             *fault;                /* [lanes]: ElementKernel() writes UmatFaultAt() of each element; or NULL */
} PlasticBatch;

typedef struct {
  ElementType type;
  Geometry    geometry;
  Kinematics  kinematics;
  MaterialLaw law; /* in small kinematics MATERIAL_LINEAR or MATERIAL_VON_MISES */
  Formulation formulation;
  int         n_constants; /* of the law; 0: as many as MaterialGetLaw() says */
  /* of a plastic law, or NULL: its elastic part alone */
  const PlasticBatch *plastic;
  int    yields; /* of mixed elements: the energy is that of a soft volume about the multipliers, see ElementYield() */
  int    condensed; /* of mixed triangles and tetrahedra of second order: their pressures are not those of nodes */
  double length;    /* of mixed elements whose nodes have pressures: that which makes these unknowns lengths */
  int    component; /* of mixed elements whose nodes have pressures: the displacement that stands for them */
  int    thin;      /* 1: in plane stress; of geometry plane strain, formulations full and enhanced, without plasticity */
} KernelCase;

/* Parts of the modulus of the volume in a mixed element (stress). local acts at the points, projected on the mean that
   the pressure's shape functions see. kappa is the part of projected that acts without multipliers; where it is the
   whole, the multipliers remain 0. mu is the shear modulus. */
typedef struct {
  double local, projected, kappa, mu;
} VolumeModuli;

void   ElementKernel(const KernelCase *, const double *X, const double *u, const StressReference *,
                     const double *constants, const double *multiplier, double *W, double *f, double *K, double *J);
void   ElementAcceptState(const KernelCase *, const double *X, const double *u, const double *constants,
                          const double *multiplier);
int    ElementKernelExists(const KernelCase *);
int    ElementStates(const KernelCase *);
int    ElementStatePoints(const KernelCase *);
void   ElementStateVolumes(const KernelCase *, const double *X, double *volume);
int    ElementExtrapolates(const KernelCase *);
void   ElementPointState(const KernelCase *, const double *X, const double *u, const double *constants,
                         const double *multiplier, double *H, double *pressure);
void   ElementPointStress(const KernelCase *, const double *X, const double *u, const double *constants,
                          const double *multiplier, double *stress, double *volume);
void   ElementBatchStates(const KernelCase *, const double *X, const double *u, const double *constants,
                          const double *multiplier, double *H, double *pressure);
void   ElementBatchNominal(const KernelCase *, const double *X, const double *u, const double *constants,
                           const double *multiplier, double *H, double *pressure, double *P);
void   ElementStress(const KernelCase *, const double *X, const double *u, const double *constants,
                     const double *multiplier, double stress[6], double *volume);
int    ElementPressures(const KernelCase *);
int    ElementNodes(const KernelCase *);
void   ElementVolumeModuli(const KernelCase *, const double *constants, int stride, VolumeModuli *);
void   ElementFollow(const KernelCase *, const double *X, const double *u, const StressReference *,
                     const double *constants, const double *multiplier, double *next);
void   ElementYield(const KernelCase *, const double *X, const double *u, const StressReference *,
                    const double *constants, const double *multiplier, double *next);
void   ElementDilatation(const KernelCase *, const double *X, const double *u, const double *constants,
                         const double *multiplier, double *theta);
double ElementVolumeEnergy(const KernelCase *, const double *X, const double *u, const double *constants,
                           const double *multiplier);
void   ElementPointVolumes(ElementType, int dim, Geometry, const double *X, double *volume);
double ElementQuality(ElementType, int dim, const double *X);

/* The loads on a face. A dead pressure acts along the reference normal on the reference area. A follower pressure acts
   along the current normal on the current area. */
typedef enum { FACE_TRACTION, FACE_DEAD_PRESSURE, FACE_FOLLOWER_PRESSURE } FaceLoad;

void   FaceLoadKernel(ElementType face, int dim, Geometry, FaceLoad, const double *X, const double *u,
                      const double *value, int stride, double *f, double *K, double *energy);
void   BodyForceKernel(ElementType, int dim, Geometry, const double *X, const double *value, int stride, double *f);
void   FaceAreaKernel(ElementType face, int dim, Geometry, const double *X, double *area, double *normal);
void   FaceMassKernel(ElementType face, int dim, Geometry, const double *X, double *matrix);
double CellVolume(ElementType, int dim, Geometry, const double *X);
double CellLength(ElementType, int dim, const double *X);
void   CellVolumeGradient(ElementType, int dim, Geometry, const double *X, double *gradient);
