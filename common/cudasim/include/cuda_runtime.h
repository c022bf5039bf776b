/// @file
/// The CUDA simulator's stand-in for the CUDA Toolkit's header of this name: CUDA C++ for a plain C++17
/// compiler. Real names, real return codes, for the part of CUDA that the course uses; anything else does not
/// compile. How it works: common/cudasim/README.md.
#pragma once

#define __CUDASIM__ 1

// What nvcc includes by itself, and kernels therefore use without asking.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "cudasim/keywords.h"

#include "cudasim/vector_types.h"

#include "cudasim/thread_index.h"

#include "cudasim/errors.h"

#include "cudasim/device.h"
#include "cudasim/device_memory.h"
#include "cudasim/streams_and_events.h"

#include "cudasim/atomics.h"
#include "cudasim/bits.h"
#include "cudasim/block_sync.h"
#include "cudasim/fast_math.h"
#include "cudasim/min_max.h"
#include "cudasim/shared_memory.h"
#include "cudasim/warp.h"

#include "cudasim/launch.h"

#include "cudasim/unsupported.h"
