/* What a child process may no longer do, for a program that reads files of strangers.

   ConfineProcess() takes from the process that calls it, and from the program that it becomes, the right to start other
   programs and to write outside one folder. It uses seccomp and Landlock of Linux, and needs no privileges. A kernel or
   a processor that lacks one of them leaves that part out: the caller must not rely on it alone. */
#pragma once

void ConfineProcess(const char *folder);
