/* Linked into builds with SANITIZE=1 only: what the leak sanitiser has to know of a program that stands on MPI and may end by a refusal. */
#define _DEFAULT_SOURCE /* on_exit() */
#include <stdlib.h>
#include "base/refusal.h"

/* Libraries that a program loads stay loaded to its end, so that it can be told whose memory is whose: Open MPI's plugins are many, and gone before that. */
int dlclose(void *library)
{
  (void)library;
  return 0;
}

static int Refused;

static void NoteStatus(int status, void *context)
{
  (void)context;
  Refused = status == EXIT_WRONG_INPUT;
}

/* Runs before main(), so that NoteStatus() runs before the sanitiser looks, which was there first. */
static void __attribute__((constructor)) Watch(void)
{
  on_exit(NoteStatus, NULL);
}

/* Asked by the leak sanitiser: a refusal ends the program as it stands, and frees nothing. */
int __lsan_is_turned_off(void);
int __lsan_is_turned_off(void)
{
  return Refused;
}
