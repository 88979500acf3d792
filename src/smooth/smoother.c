/* The table of smoothers: the built-in ones of base/choices.h, and those that a program registers. */
#include <string.h>
#include "smooth/smoother.h"

const Smoother *Smoothers[SMOOTHER_MAX + 1]     = {SMOOTHERS(CHOICE_POINTER)};
const char     *SmootherNames[SMOOTHER_MAX + 1] = {SMOOTHERS(CHOICE_NAME)};
char            SmootherWords[SMOOTHER_WORDS]   = SMOOTHERS(CHOICE_BAR);

/*@
  SmootherRegister - adds a smoother to the table, so that scenes can choose it by name.

  Not collective

  Input Parameters:
+ name     - the word in the scene: letters, digits and underscores; it is not copied
- smoother - its needs and its evaluation; it is not copied

  Note:
  Returns 1 when the smoother was added. Returns 0 when the name is empty, taken or holds other characters, or when
  SMOOTHER_MAX or SMOOTHER_WORDS leaves no room. It must be called before the scene is read, with the same smoothers in
  the same order on all ranks. Plain C.
@*/
int SmootherRegister(const char *name, const Smoother *smoother)
{
  const size_t length = strlen(name), used = strlen(SmootherWords), bar = sizeof " | " - 1;
  int          n = 0;

  for (; SmootherNames[n]; n++)
    if (!strcmp(SmootherNames[n], name)) return 0;
  if (n == SMOOTHER_MAX || used + bar + length + 1 > SMOOTHER_WORDS) return 0;
  if (!length || strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") != length) return 0;
  memcpy(&SmootherWords[used], " | ", bar);
  memcpy(&SmootherWords[used + bar], name, length + 1);
  SmootherNames[n] = name;
  Smoothers[n]     = smoother;
  return 1;
}
