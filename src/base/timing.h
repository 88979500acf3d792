/* Wall seconds of a run by purpose, for summary.json. -log_view of PETSc tells more.

   TimingReset() begins a run. TimingBegin() and TimingEnd() stand around the work for one purpose and may be nested:
   while an inner purpose runs, the clock of the outer one stops, so that no second counts twice (the search within the
   set-up is search, not set-up). TimingSeconds() gives the sum.

   The clocks belong to the process as a whole, like those of PETSc's log, because every part of the program uses them.
 */
#pragma once

typedef enum {
  TIMING_SETUP,
  TIMING_SEARCH,
  TIMING_FIT,
  TIMING_ASSEMBLY_ELASTIC,
  TIMING_ASSEMBLY_CONTACT,
  TIMING_SOLVE,
  TIMING_CERTIFICATE,
  TIMING_OUTPUT,
  TIMING_KINDS
} TimingKind;
extern const char *const TimingNames[];

void   TimingReset(void);
void   TimingBegin(TimingKind);
void   TimingEnd(TimingKind);
double TimingSeconds(TimingKind);
