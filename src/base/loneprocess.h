/* A process that no launcher has started gets a short start of MPI. Plain C. */
#pragma once

void LoneProcessPrepare(void);
