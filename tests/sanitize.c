/* Linked into builds with SANITIZE=1 only: what the leak sanitiser has to know about a program that uses MPI. */

/* Libraries that a program loads stay loaded until its end, so that the sanitiser can say whose memory is whose: Open
   MPI has many plugins, and it unloads them before that. */
int dlclose(void *library)
{
  (void)library;
  return 0;
}
