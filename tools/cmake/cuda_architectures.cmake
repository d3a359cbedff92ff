# Without CMAKE_CUDA_ARCHITECTURES: code for every generation since Turing, and PTX of the newest for
# those to come. Say CMAKE_CUDA_ARCHITECTURES=native to build for the GPU of this machine alone.
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
  set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 86-real 89-real 90-real 100-real 120)
endif()
