#error \
    "the CUDA simulator has no cooperative groups: use __syncthreads(), __syncwarp(mask) and the __shfl_..._sync functions"
