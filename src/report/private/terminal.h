/* What a run says while it goes on: first lines, a line for each accepted step, last lines, and warnings.

   TerminalBegin() prints the first lines and warns of what is already known then. TerminalStep() comes after each
   accepted step, TerminalEnd() once when the run ends. Progress goes to stdout of rank 0 and is left out by -quiet;
   warnings and the cause of a failure go to stderr of rank 0 in any case. Writes no file and changes nothing. */
#pragma once
#include "optionrecord.h"
#include "runfigures.h"

typedef struct _n_Terminal *Terminal;

/* What TerminalEnd() says of the run besides its figures */
typedef struct {
  const RunFigures *figures;
  const PetscReal  *probes;   /* final values, NaN where there is none */
  PetscBool         met;      /* some contact has pressed in this run, or there is no step to speak of */
  const PetscReal  *apart;    /* of each contact pair that never met: its nearest distance at the end, else -1 */
  PetscReal         deepest;  /* largest penetration of the run, in face sizes */
  PetscReal         standing; /* largest depth of a master node in a slave in the written states, in face sizes */
} TerminalLast;

PetscErrorCode TerminalCreate(Model, Probes, Scene, const char *directory, PetscBool quiet, Terminal *);
PetscErrorCode TerminalDestroy(Terminal *);
PetscErrorCode TerminalBegin(Terminal, PetscInt restarts, PetscInt last_step, const OptionRecord *);
void           TerminalWarnLost(Terminal, const char *name, PetscInt last_step);
void           TerminalStep(Terminal, const StepRecord *, PetscReal spent);
PetscErrorCode TerminalEnd(Terminal, const TerminalLast *);
