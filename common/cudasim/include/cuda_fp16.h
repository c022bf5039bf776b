#error "the CUDA simulator has no half precision: use float"
