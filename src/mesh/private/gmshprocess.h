/* gmsh as a program of its own: GmshExecute() runs it without a shell, GmshVersion() says which one it is. For one
   rank. */
#pragma once
#include <petscsys.h>

/* The exit status for a program that is not there, the same as the shell's. */
#define GMSH_NO_PROGRAM 127
/* This plus the number of a signal is the exit status for a gmsh that the signal has ended, the same as the shell's. */
#define GMSH_KILLED 128

PetscErrorCode GmshExecute(char *const arguments[], const char *confined, char **output, int *status);
PetscErrorCode GmshVersion(const char *directory, char **version);
