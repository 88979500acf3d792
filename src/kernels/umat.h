/* Materials of users: a shared library with Abaqus's UMAT interface (Fortran's calling convention). Plain C.

   UmatOpen() loads a library, UmatPoint() calls its routine for one point. A crash inside the routine ends the process
   with exit status 2 and a line that names library, element and point. A number that is not finite is told in a line,
   and UmatPoint() returns a fault, as it does where the routine asks for a shorter step (PNEWDT below 1). UmatTell()
   puts a fault into words. A routine that writes more states than it has ends the process as a crash does.

   The routine gets, in finite strains, DFGRD0 and DFGRD1, the increment of strain and the rotation DROT of Hughes and
   Winget (International Journal for Numerical Methods in Engineering 15, 1980), and stress and strain turned by DROT.
   Its stress is Cauchy's, and DDSDDE is taken as the derivative of J times the stress by the strain in Jaumann's rate
   over J. In small strains both gradients are the unit tensor. Of DDSDDE the symmetric part is used, as in Abaqus
   without UNSYMM, unless UmatSetUnsymmetric() is called. KSTEP is 1. KINC is 1 in the first step and 2 in all others,
   so that routines which set up their states where both are 1 do so once. Temperature, fields, LAYER and KSPT are 0.

   State of a point: F - 1 at 3 i + I, stress (xx yy zz xy yz xz), strain in Abaqus's components, SSE, SPD and SCD, then
   STATEV. Elements that hold J within (volumehold.h) have UMAT_HOLD numbers more: those of PLASTIC_HOLD, then the
   largest modulus that UmatPoint() has told. Zero is the virgin state. */
#pragma once

enum {
  UMAT_STRESS     = 9,
  UMAT_STRAIN     = 15,
  UMAT_ENERGY     = 21,
  UMAT_STATES     = 24,
  UMAT_HOLD       = 3,
  UMAT_MAX_STATES = 100, /* STATEV of a point */
  UMAT_MESSAGE    = 300,
  UMAT_SKEW_SIZE  = 36 /* of the skew part of a tangent */
};

/* Place of the component r, s of a skew part, r < s */
#define UMAT_SKEW_INDEX(r, s) ((r) * (17 - (r)) / 2 + (s) - (r) - 1)

/* How a call ended: as it should, not made since F has no positive determinant, with a number that is not finite, or
   with the wish for a shorter step. */
typedef enum {
  UMAT_FINE,
  UMAT_INVERTED,
  UMAT_NOT_FINITE,
  UMAT_SHORTER,
  UMAT_FAULTS
} UmatFault;

typedef struct Umat Umat;

/* Where a point is and when. tensor is NTENS: 4 in the plane and around an axis, else 6. */
typedef struct {
  int    finite, tensor, element, point;
  double t, dt;  /* time at the end of the increment, and its length */
  double x[3];   /* COORDS */
  double length; /* CELENT */
} UmatPlace;

int  UmatOpen(const char *path, const char *name, int n_constants, const double *constants, int n_states, Umat **,
              char message[UMAT_MESSAGE]);
void UmatClose(Umat **);
int  UmatStates(const Umat *);
void UmatSetUnsymmetric(Umat *);
int  UmatIsUnsymmetric(const Umat *);
UmatFault   UmatPoint(Umat *, const UmatPlace *, const double H[9], const double *state, int stride, double *W,
                      double P[9], double A[], double skew[], double *next, double *unheld);
int         UmatFaultAt(UmatFault, int point);
const char *UmatTell(int code, int *point);
