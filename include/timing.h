/* Wall seconds by purpose, for summary.json; -log_view tells more. Begin and End do not nest. */
#pragma once

typedef enum {
  TIMING_SETUP,
  TIMING_SEARCH,
  TIMING_FIT,
  TIMING_ASSEMBLY_ELASTIC,
  TIMING_ASSEMBLY_CONTACT,
  TIMING_SOLVE,
  TIMING_OUTPUT,
  TIMING_KINDS
} TimingKind;
extern const char *const TimingNames[];

void   TimingBegin(TimingKind);
void   TimingEnd(TimingKind);
double TimingSeconds(TimingKind);
