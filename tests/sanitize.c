/* Support of the leak sanitiser for a program that uses MPI. This file is linked into builds with SANITIZE=1 only. */

/* Replaces dlclose(), so that every loaded library stays loaded until the end of the program. The sanitiser can then
   name the library that allocated a block. Open MPI has many plugins, and it would unload them earlier. */
int dlclose(void *library)
{
  (void)library;
  return 0;
}
