/* Which of our preconditioners a PCSHELL is: options may have put another in its place. */
#pragma once
#include "base/petsccompat.h"

/* The context of a shell preconditioner of that name; NULL: it is none, or another. Not collective. */
PetscErrorCode ShellFind(PC, const char *name, void *context);
