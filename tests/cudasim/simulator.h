// The simulator's own interface, for tests that also compile with nvcc: there it does not exist.
#pragma once
#include <cuda_runtime.h>

#ifdef __CUDASIM__
#include "common/cudasim/cudasim.h"
#endif
