/* Calls of UMAT routines in shared libraries, see umat.h. */
#include "kernels/umat.h"
#include "kernels/material.h"
#include "kernels/vonmises.h"
#include "lameconstants.h"
#include <dlfcn.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
  NAME_LENGTH  = 80,      /* of CMNAME */
  CRASH_STATUS = 2,       /* exit status of a run that failed */
  CRASH_STACK  = 1 << 16, /* bytes for the handler, which must run after an overflow of the stack, too */
  SIGNALS      = 5
};
/* A step that should be this part of its length at most is taken back. Routines set PNEWDT to 1 and less. */
static const double step_kept = 1 - 1e-9;

typedef void UmatRoutine(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                         double *rpl, double *ddsddt, double *drplde, double *drpldt, double *stran, double *dstran,
                         double *time, double *dtime, double *temp, double *dtemp, double *predef, double *dpred,
                         char *cmname, int *ndi, int *nshr, int *ntens, int *nstatv, double *props, int *nprops,
                         double *coords, double *drot, double *pnewdt, double *celent, double *dfgrd0, double *dfgrd1,
                         int *noel, int *npt, int *layer, int *kspt, int *jstep, int *kinc, size_t cmname_length);

struct Umat {
  void        *library;
  UmatRoutine *routine;
  char        *path, name[NAME_LENGTH];
  int          n_constants, n_states, unsymmetric;
  double      *constants;
  double       told; /* time for which a number that is not finite has been told */
};

/* Abaqus's components 11 22 33 12 13 23 */
static const int index_of[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
static const int stored_at[6]   = {0, 1, 2, 3, 5, 4}; /* in xx yy zz xy yz xz */

/* What the handler of signals needs: it has no other access to the call */
static struct {
  volatile sig_atomic_t inside;
  const char           *path;
  int                   element, point, installed;
  struct sigaction      before[SIGNALS];
} crash;
static const int crash_signals[SIGNALS] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

static void TakeCrash(int number)
{
  char text[UMAT_MESSAGE];
  int  length;

  if (!crash.inside) { /* not ours: as without this handler */
    for (int k = 0; k < SIGNALS; k++) sigaction(crash_signals[k], &crash.before[k], NULL);
    raise(number);
    return;
  }
  length =
    snprintf(text, sizeof text, "burnish: %.120s: the routine umat crashed (signal %d) in element %d, point %d\n",
             crash.path, number, crash.element, crash.point);
  if (write(STDERR_FILENO, text, (size_t)length) < 0) _exit(CRASH_STATUS);
  _exit(CRASH_STATUS);
}

static void InstallHandler(void)
{
  static char      stack[CRASH_STACK];
  const stack_t    other = {.ss_sp = stack, .ss_size = sizeof stack};
  struct sigaction take  = {.sa_handler = TakeCrash, .sa_flags = SA_ONSTACK};

  if (crash.installed) return;
  crash.installed = 1;
  sigemptyset(&take.sa_mask);
  sigaltstack(&other, NULL);
  for (int k = 0; k < SIGNALS; k++) sigaction(crash_signals[k], &take, &crash.before[k]);
}

/*@
  UmatOpen - loads a library.

  Not collective

  Input Parameters:
+ path        - of the shared library
. name        - of the material: CMNAME
. n_constants - NPROPS
. constants   - PROPS; copied
- n_states    - NSTATV, at most UMAT_MAX_STATES

  Output Parameters:
+ umat    - free it with UmatClose(); NULL after an error
- message - why it cannot be loaded

  Note:
  It returns 0, or 1 after an error. The routine is umat_ or umat, as Fortran compilers name it.
@*/
int UmatOpen(const char *path, const char *name, int n_constants, const double *constants, int n_states, Umat **umat,
             char message[UMAT_MESSAGE])
{
  void        *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  UmatRoutine *routine = NULL;

  *umat = NULL;
  if (!library) {
    snprintf(message, UMAT_MESSAGE, "%s", dlerror());
    return 1;
  }
  *(void **)&routine = dlsym(library, "umat_");
  if (!routine) *(void **)&routine = dlsym(library, "umat");
  if (!routine) {
    snprintf(message, UMAT_MESSAGE, "%.200s has neither a routine umat_ nor umat", path);
    dlclose(library);
    return 1;
  }
  *umat              = calloc(1, sizeof **umat);
  (*umat)->library   = library;
  (*umat)->routine   = routine;
  (*umat)->path      = strdup(path);
  (*umat)->constants = calloc((size_t)n_constants + 1, sizeof(double));
  (*umat)->told      = -DBL_MAX;
  memset((*umat)->name, ' ', NAME_LENGTH);
  memcpy((*umat)->name, name, strlen(name) < NAME_LENGTH ? strlen(name) : NAME_LENGTH);
  for (int k = 0; k < n_constants; k++) (*umat)->constants[k] = constants[k];
  (*umat)->n_constants = n_constants;
  (*umat)->n_states    = n_states;
  InstallHandler();
  return 0;
}

/*@
  UmatClose - unloads a library.

  Not collective

  Input Parameter:
. umat - set to NULL; may be NULL already
@*/
void UmatClose(Umat **umat)
{
  if (!*umat) return;
  dlclose((*umat)->library);
  free((*umat)->path);
  free((*umat)->constants);
  free(*umat);
  *umat = NULL;
}

/*@
  UmatStates - counts the numbers of the state of a point.

  Not collective
@*/
int UmatStates(const Umat *umat)
{
  return UMAT_STATES + umat->n_states;
}

/*@
  UmatSetUnsymmetric - lets the whole of DDSDDE be used, not its symmetric part alone.

  Not collective
@*/
void UmatSetUnsymmetric(Umat *umat)
{
  umat->unsymmetric = 1;
}

/*@
  UmatIsUnsymmetric - tells whether UmatSetUnsymmetric() has been called.

  Not collective
@*/
int UmatIsUnsymmetric(const Umat *umat)
{
  return umat->unsymmetric;
}

static void Multiply(const double A[9], const double B[9], int transposed, double C[9])
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      C[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) C[3 * i + j] += A[3 * i + k] * (transposed ? B[3 * j + k] : B[3 * k + j]);
    }
  }
}

/* Computes the inverse of a tensor and returns its determinant. */
static double Invert(const double A[9], double inverse[9])
{
  double determinant = 0;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int i1 = 3 * ((i + 1) % 3), i2 = 3 * ((i + 2) % 3), j1 = (j + 1) % 3, j2 = (j + 2) % 3;

      inverse[3 * j + i] = A[i1 + j1] * A[i2 + j2] - A[i1 + j2] * A[i2 + j1];
    }
  }
  for (int j = 0; j < 3; j++) determinant += A[j] * inverse[3 * j];
  for (int k = 0; k < 9; k++) inverse[k] /= determinant;
  return determinant;
}

/* Turns a symmetric tensor by Q. */
static void Turn(const double Q[9], double T[9])
{
  double QT[9];

  Multiply(Q, T, 0, QT);
  Multiply(QT, Q, 1, T);
}

/* What a call hands over, in Abaqus's components. The arrays are as long as with NTENS = 6. */
typedef struct {
  double F[2][9], H[9]; /* at begin and end; H at the end */
  double stress[6], tangent[36], strain[6], increment[6], rotation[9], energy[3], statev[UMAT_MAX_STATES];
  double shorter;
} UmatData;

/* Computes increment of strain and rotation from the gradient of the increment of displacement, by the midpoint. */
static void SetIncrement(const UmatPlace *place, const double before[9], UmatData *x)
{
  double L[9], plus[9], minus[9], inverse[9];

  for (int k = 0; k < 9; k++) x->rotation[k] = k % 4 == 0;
  for (int k = 0; k < 9; k++) L[k] = x->H[k] - before[k];
  if (place->finite) {
    double middle[9], change[9];

    for (int k = 0; k < 9; k++) middle[k] = (x->F[0][k] + x->F[1][k]) / 2;
    memcpy(change, L, sizeof change);
    Invert(middle, inverse);
    Multiply(change, inverse, 0, L);
    for (int k = 0; k < 9; k++) {
      const double spin = (L[k] - L[3 * (k % 3) + k / 3]) / 4;

      plus[k]  = (k % 4 == 0) + spin;
      minus[k] = (k % 4 == 0) - spin;
    }
    Invert(minus, inverse);
    Multiply(inverse, plus, 0, x->rotation);
  }
  for (int c = 0; c < 6; c++) {
    const int i = index_of[c][0], j = index_of[c][1];

    x->increment[c] = (L[3 * i + j] + L[3 * j + i]) * (c < 3 ? 0.5 : 1);
  }
}

/* Turns components of a stress, or of a strain whose shears are doubled. */
static void TurnComponents(const double Q[9], double factor, double component[6])
{
  double T[9];

  for (int c = 0; c < 6; c++)
    T[3 * index_of[c][0] + index_of[c][1]] = T[3 * index_of[c][1] + index_of[c][0]] =
      component[c] / (c < 3 ? 1 : factor);
  Turn(Q, T);
  for (int c = 0; c < 6; c++) component[c] = T[3 * index_of[c][0] + index_of[c][1]] * (c < 3 ? 1 : factor);
}

static void Prepare(const Umat *umat, const UmatPlace *place, const double H[9], const double *state, int stride,
                    UmatData *x)
{
  double before[9];

  memset(x, 0, sizeof *x);
  for (int k = 0; k < 9; k++) {
    before[k]  = state[k * stride];
    x->H[k]    = H[k];
    x->F[0][k] = (k % 4 == 0) + (place->finite ? before[k] : 0);
    x->F[1][k] = (k % 4 == 0) + (place->finite ? H[k] : 0);
  }
  for (int c = 0; c < 6; c++) {
    x->stress[c] = state[(UMAT_STRESS + stored_at[c]) * stride];
    x->strain[c] = state[(UMAT_STRAIN + c) * stride];
  }
  for (int k = 0; k < 3; k++) x->energy[k] = state[(UMAT_ENERGY + k) * stride];
  for (int k = 0; k < umat->n_states; k++) x->statev[k] = state[(UMAT_STATES + k) * stride];
  SetIncrement(place, before, x);
  TurnComponents(x->rotation, 1, x->stress);
  TurnComponents(x->rotation, 2, x->strain);
  x->shorter = 1;
}

static void Call(const Umat *umat, const UmatPlace *place, UmatData *x)
{
  double rpl = 0, ddsddt[6] = {0}, drplde[6] = {0}, drpldt = 0, time[2] = {place->t - place->dt, place->t - place->dt},
         dtime = place->dt, none[2] = {0}, length = place->length, x_point[3], columns[3][9];
  int ndi = 3, nshr = place->tensor - 3, ntens = place->tensor, nstatv = umat->n_states, nprops = umat->n_constants,
      element = place->element, point = place->point, zero = 0, jstep[4] = {1, 0, 0, 0}, kinc = time[0] > 0 ? 2 : 1;
  char name[NAME_LENGTH];

  memcpy(name, umat->name, NAME_LENGTH);
  memcpy(x_point, place->x, sizeof x_point);
  for (int k = 0; k < 9; k++) { /* Fortran's order */
    columns[0][k] = x->F[0][3 * (k % 3) + k / 3];
    columns[1][k] = x->F[1][3 * (k % 3) + k / 3];
    columns[2][k] = x->rotation[3 * (k % 3) + k / 3];
  }
  crash.path    = umat->path;
  crash.element = element;
  crash.point   = point;
  crash.inside  = 1;
  umat->routine(x->stress, x->statev, x->tangent, &x->energy[0], &x->energy[1], &x->energy[2], &rpl, ddsddt, drplde,
                &drpldt, x->strain, x->increment, time, &dtime, &none[0], &none[1], none, none, name, &ndi, &nshr,
                &ntens, &nstatv, umat->constants, &nprops, x_point, columns[2], &x->shorter, &length, columns[0],
                columns[1], &element, &point, &zero, &zero, jstep, &kinc, NAME_LENGTH);
  crash.inside = 0;
}

/* Ends the process where the routine has written states that it was not given: its results would be wrong. */
static void CheckStates(const Umat *umat, const UmatPlace *place, const UmatData *x)
{
  for (int k = umat->n_states; k < UMAT_MAX_STATES; k++) {
    if (x->statev[k] == 0) continue;
    fprintf(stderr, "burnish: %s: the routine umat wrote state %d in element %d, point %d, but material.states is %d\n",
            umat->path, k + 1, place->element, place->point, umat->n_states);
    _exit(CRASH_STATUS);
  }
}

/* Returns how the call ended, and tells a number that is not finite once for each time. */
static UmatFault EndOfCall(Umat *umat, const UmatPlace *place, const UmatData *x)
{
  double sum = 0;

  for (int c = 0; c < place->tensor; c++) sum += x->stress[c];
  for (int c = 0; c < place->tensor * place->tensor; c++) sum += x->tangent[c];
  for (int k = 0; k < umat->n_states; k++) sum += x->statev[k];
  if (isfinite(sum)) return x->shorter < step_kept ? UMAT_SHORTER : UMAT_FINE;
  if (umat->told != place->t)
    fprintf(stderr,
            "burnish: %s: the routine umat gave a number that is not finite in element %d, point %d at t = %g\n",
            umat->path, place->element, place->point, place->t);
  umat->told = place->t;
  return UMAT_NOT_FINITE;
}

/* Component of DDSDDE */
static double Tangent(const UmatPlace *place, const UmatData *x, int i, int k, int j, int l)
{
  static const int component[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const int        a = component[i][k], b = component[j][l];

  if (a >= place->tensor || b >= place->tensor) return 0;
  return x->tangent[a + place->tensor * b];
}

/* Computes dP/dH from Jaumann's tangent and the Kirchhoff stress T: in space it is
   J C_ikjl + d_ij T_kl - 1/2 (d_ij T_kl + d_il T_kj + T_ij d_kl + T_il d_kj). A is its symmetric part. */
static void PiolaTangent(const UmatPlace *place, const UmatData *x, const double inverse[9], double J,
                         const double T[9], double A[MATERIAL_TANGENT_SIZE], double skew[UMAT_SKEW_SIZE])
{
  double a[3][3][3][3];

  for (int m = 0; m < 81; m++) {
    const int i = m / 27, k = m / 9 % 3, j = m / 3 % 3, l = m % 3;

    a[i][k][j][l] = J * Tangent(place, x, i, k, j, l);
    if (place->finite)
      a[i][k][j][l] +=
        (i == j) * T[3 * k + l] -
        ((i == j) * T[3 * k + l] + (i == l) * T[3 * k + j] + T[3 * i + j] * (k == l) + T[3 * i + l] * (k == j)) / 2;
  }
  for (int r = 0; r < 9; r++) {
    for (int s = r; s < 9; s++) {
      double upper = 0, lower = 0;

      for (int k = 0; k < 3; k++) {
        for (int l = 0; l < 3; l++) {
          upper += inverse[3 * (r % 3) + k] * inverse[3 * (s % 3) + l] * a[r / 3][k][s / 3][l];
          lower += inverse[3 * (s % 3) + k] * inverse[3 * (r % 3) + l] * a[s / 3][k][r / 3][l];
        }
      }
      A[MATERIAL_TANGENT_INDEX(r, s)] = (upper + lower) / 2;
      if (s > r) skew[UMAT_SKEW_INDEX(r, s)] = (upper - lower) / 2;
    }
  }
}

/* Writes the state at the end of the increment. */
static void Store(const Umat *umat, const UmatData *x, int stride, double *next)
{
  for (int k = 0; k < 9; k++) next[k * stride] = x->H[k];
  for (int c = 0; c < 6; c++) {
    next[(UMAT_STRESS + stored_at[c]) * stride] = x->stress[c];
    next[(UMAT_STRAIN + c) * stride]            = x->strain[c] + x->increment[c];
  }
  for (int k = 0; k < 3; k++) next[(UMAT_ENERGY + k) * stride] = x->energy[k];
  for (int k = 0; k < umat->n_states; k++) next[(UMAT_STATES + k) * stride] = x->statev[k];
}

/* Returns how far the equivalent Kirchhoff stress is above 2/3 of the slope with which it grows along its own
   direction, 0 where it is below, see volumehold.h. T: the stress */
static double Unheld(const UmatPlace *place, const UmatData *x, double J, const double T[9])
{
  const double mean   = (T[0] + T[4] + T[8]) / 3;
  double       square = 0, slope = 0, direction[9];

  for (int k = 0; k < 9; k++) {
    direction[k] = T[k] - (k % 4 == 0) * mean;
    square += direction[k] * direction[k];
  }
  if (square == 0) return 0;
  for (int r = 0; r < 9; r++)
    for (int s = 0; s < 9; s++)
      slope += direction[r] * J * Tangent(place, x, r / 3, r % 3, s / 3, s % 3) * direction[s];
  return fmax(0, sqrt(1.5 * square) - slope / square); /* 3/2 slope / square in tension */
}

/*@
  UmatPoint - computes stress and tangent of a point, and the state after the increment.

  Not collective

  Input Parameters:
+ umat   - the material
. place  - where the point is, and when
. H      - displacement gradient F - 1 at 3 i + I
. state  - accepted state [UmatStates()][stride]
- stride - from one number of a state to the next

  Output Parameters:
+ W    - SSE + SPD + SCD of the routine per reference volume
. P    - first Piola-Kirchhoff stress; with small strains the stress
. A    - symmetric part of the tangent dP_r/dH_s at MATERIAL_TANGENT_INDEX(r, s), or NULL
. skew - its skew part at UMAT_SKEW_INDEX(r, s), or NULL without A
. next - the state at H, or NULL; it may be the same array as state
- unheld - the modulus by which J is to be held within an element (volumehold.h), 0: none; or NULL

  Note:
  P, A and unheld are 0 where it does not return UMAT_FINE. The routine is not called where nothing has changed and no
  tangent is asked for; unheld is 0 then.
@*/
UmatFault UmatPoint(Umat *umat, const UmatPlace *place, const double H[9], const double *state, int stride, double *W,
                    double P[9], double A[], double skew[], double *next, double *unheld)
{
  UmatData  x;
  UmatFault fault = UMAT_FINE;
  double    inverse[9], J, T[9];
  int       same = place->dt <= 0 && !A;

  Prepare(umat, place, H, state, stride, &x);
  for (int k = 0; k < 9; k++) same = same && H[k] == state[k * stride];
  J = Invert(x.F[1], inverse);
  memset(P, 0, 9 * sizeof *P);
  if (A) memset(A, 0, MATERIAL_TANGENT_SIZE * sizeof *A);
  if (A) memset(skew, 0, UMAT_SKEW_SIZE * sizeof *skew);
  if (unheld) *unheld = 0;
  *W = 0;
  if (!(J > 0)) return UMAT_INVERTED;
  if (!same) {
    Call(umat, place, &x);
    CheckStates(umat, place, &x);
    if ((fault = EndOfCall(umat, place, &x))) return fault;
  }
  for (int c = 0; c < 6; c++) {
    const double stress = c < place->tensor ? J * x.stress[c] : 0;

    T[3 * index_of[c][0] + index_of[c][1]] = T[3 * index_of[c][1] + index_of[c][0]] = stress;
  }
  *W = x.energy[0] + x.energy[1] + x.energy[2];
  Multiply(T, inverse, 1, P);
  if (A) PiolaTangent(place, &x, inverse, J, T, A, skew);
  if (unheld && !same) *unheld = Unheld(place, &x, J, T);
  if (next) Store(umat, &x, stride, next);
  return UMAT_FINE;
}

/*@
  UmatFaultAt - joins a fault and the number of its point to one code, which is 0 without a fault.

  Not collective
@*/
int UmatFaultAt(UmatFault fault, int point)
{
  return fault ? (int)fault + UMAT_FAULTS * point : 0;
}

/*@
  UmatTell - puts a fault of a routine into words.

  Not collective

  Input Parameter:
. code - from UmatFaultAt()

  Output Parameter:
. point - where it was

  Note:
  It returns NULL where the routine is not to blame: without a fault, or where the element was turned inside out.
@*/
const char *UmatTell(int code, int *point)
{
  static const char *const words[UMAT_FAULTS] = {[UMAT_NOT_FINITE] = "gave a number that is not finite",
                                                 [UMAT_SHORTER]    = "asked for a shorter step (PNEWDT)"};

  *point = code / UMAT_FAULTS;
  return words[code % UMAT_FAULTS];
}

/* Without a routine, as for reports of the law: Hencky's law */
static void Evaluate(const Lanes H[9], const Lanes *dilatation, int n, const Lanes constants[], Lanes *W, Lanes P[9],
                     Lanes A[MATERIAL_TANGENT_SIZE])
{
  MaterialLaw_VonMises.evaluate(H, dilatation, n, constants, W, P, A);
}

const ElasticLaw MaterialLaw_Umat = {.evaluate  = Evaluate,
                                     .shear     = MaterialLameShear,
                                     .constants = 2,
                                     .isochoric = 1,
                                     .keys      = {"mu"},
                                     .required  = 1,
                                     .plastic   = 1};
