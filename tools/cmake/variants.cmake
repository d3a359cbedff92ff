# The solver library is compiled once per precision and backend from the same files, for the CPU also with AVX2 and FMA.
# Each build lives in its own inline namespace (BL_VARIANT), so that one program holds them all and chooses at run time.
#
# precision  pair arithmetic  fluid positions in memory
# single     float            packed: float, relative to the cell
# mixed      float            double
# double     double           double

file(GLOB BEDLOAD_SOLVER_SOURCES CONFIGURE_DEPENDS
     ${CMAKE_SOURCE_DIR}/src/particles/*.cpp ${CMAKE_SOURCE_DIR}/src/neighbours/*.cpp
     ${CMAKE_SOURCE_DIR}/src/fluid/*.cpp ${CMAKE_SOURCE_DIR}/src/solids/*.cpp
     ${CMAKE_SOURCE_DIR}/src/coupling/*.cpp ${CMAKE_SOURCE_DIR}/src/walls/*.cpp
     ${CMAKE_SOURCE_DIR}/src/boundaries/*.cpp ${CMAKE_SOURCE_DIR}/src/domain/*.cpp
     ${CMAKE_SOURCE_DIR}/src/lattice/*.cpp
     ${CMAKE_SOURCE_DIR}/src/time/*.cpp ${CMAKE_SOURCE_DIR}/src/measure/*.cpp)

if(BEDLOAD_FIRST_LOOK)
  list(REMOVE_ITEM BEDLOAD_SOLVER_SOURCES ${CMAKE_SOURCE_DIR}/src/fluid/sdpd_solver.cpp)
endif()

# bedload_variant(single|mixed|double cpu|cpu_avx2|cuda): the static library bedload_<precision>_<backend>.
# A cuda variant is made in a directory in which the sources' LANGUAGE is CUDA.
function(bedload_variant precision backend)
  set(variant ${precision}_${backend})
  set(real float)
  set(packed 0)
  if(precision STREQUAL "double")
    set(real double)
  elseif(precision STREQUAL "single")
    set(packed 1)
  endif()

  add_library(bedload_${variant} STATIC ${BEDLOAD_SOLVER_SOURCES})
  target_compile_definitions(bedload_${variant} PUBLIC BL_VARIANT=${variant} BL_REAL=${real}
                                                       BL_PACKED_POSITIONS=${packed})
  # LINK_ONLY: a solver file must compile without the host's libraries.
  target_link_libraries(bedload_${variant} PUBLIC bedload_headers PRIVATE $<LINK_ONLY:$<TARGET_NAME:bedload_host>>)
  if(backend STREQUAL "cuda")
    target_compile_definitions(bedload_${variant} PUBLIC BL_CUDA=1)
    target_compile_options(bedload_${variant} PUBLIC --expt-relaxed-constexpr $<$<BOOL:${BEDLOAD_LINE_INFO}>:-lineinfo>)
    if(NOT precision STREQUAL "double")  # to 2 ulp, denormals as zero: half of the instructions
      target_compile_options(bedload_${variant} PUBLIC -ftz=true -prec-div=false -prec-sqrt=false)
    endif()
    target_link_libraries(bedload_${variant} PRIVATE CUDA::cudart_static)
  else()
    target_compile_definitions(
      bedload_${variant} PUBLIC BL_CUDA=0 THRUST_DEVICE_SYSTEM=THRUST_DEVICE_SYSTEM_OMP)
    target_compile_options(bedload_${variant} PUBLIC -fno-math-errno)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # one copy of the loop over packs: a third less to compile, as fast
      target_compile_options(bedload_${variant} PRIVATE -fno-split-loops)
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
      # GCC 12's SLP vectoriser drops the rounding in double(float(x))
      target_compile_options(bedload_${variant} PUBLIC -fno-tree-slp-vectorize)
    endif()
    if(backend STREQUAL "cpu_avx2")
      target_compile_options(bedload_${variant} PUBLIC -mavx2 -mfma)
      if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # objcopy leaves unique symbols to be seen
        target_compile_options(bedload_${variant} PRIVATE -fno-gnu-unique)
      endif()
    endif()
    target_link_libraries(bedload_${variant} PUBLIC OpenMP::OpenMP_CXX)
  endif()
endfunction()

# bedload_seal(<variant>): the static library bedload_<variant>_sealed, the same as one object of which make_coupled
# alone is seen from outside. Else the linker could take a function of a common header, compiled for AVX2, for the whole
# program, which would then stop on CPUs without it.
function(bedload_seal variant)
  set(object ${CMAKE_BINARY_DIR}/bedload_${variant}.o)
  add_custom_command(
    OUTPUT ${object} DEPENDS bedload_${variant}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation --whole-archive $<TARGET_FILE:bedload_${variant}> -o ${object}
    COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol=_ZN7bedload*12make_coupledERKNS_6ConfigERKNS_5SetupEPNS_4LinkE
            ${object} VERBATIM)
  add_library(bedload_${variant}_sealed STATIC ${object})
  set_target_properties(bedload_${variant}_sealed PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(bedload_${variant}_sealed PRIVATE $<LINK_ONLY:$<TARGET_NAME:bedload_host>> OpenMP::OpenMP_CXX)
endfunction()
