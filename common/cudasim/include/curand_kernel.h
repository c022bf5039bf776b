#error "the CUDA simulator has no cuRAND: use Random123's philox, which runs on the host and in kernels alike"
