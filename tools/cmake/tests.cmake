# Tests. Suites named Slow... are labelled slow and left to mixed precision, the rest quick; on a GPU gpu-slow and
# gpu-quick. Slow ones begin first, so that none of them ends alone. On a CPU with AVX2 they run as compiled for it, as
# users' runs do, in half the time.
find_package(GTest REQUIRED)
include(CheckCXXSourceRuns)
include(GoogleTest)

# Asked each time that CMake runs, as src/device.cpp asks each time that the program runs. A build that moves to a CPU
# without AVX2 needs CMake again: ctest stops at the slow tests' program and says why.
set(slow_in_avx2 OFF)
if(BEDLOAD_CPU_DISPATCH AND "mixed" IN_LIST BEDLOAD_PRECISIONS)
  unset(BEDLOAD_AVX2_HERE CACHE)
  check_cxx_source_runs(
    "int main() { return __builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\") ? 0 : 1; }"
    BEDLOAD_AVX2_HERE)
  set(slow_in_avx2 ${BEDLOAD_AVX2_HERE})
endif()

# bedload_register(<executable> quick|slow [label prefix]): its quick or slow tests, which ctest calls
# <executable>.<suite>.<test>.
function(bedload_register target speed)
  set(filter "-Slow*:*/Slow*")
  set(properties TIMEOUT 300)
  # Two tests may run at once, and waiting threads that spin would starve each other.
  set(threads OMP_WAIT_POLICY=passive)
  if(BEDLOAD_SANITIZE OR BEDLOAD_COVERAGE)
    set(properties TIMEOUT 1800)
  endif()
  if(speed STREQUAL "slow")
    set(filter "Slow*:*/Slow*")
    set(properties TIMEOUT 1800 COST 100)
    set(threads OMP_NUM_THREADS=1)  # a fifth less to compute: their cases are small
  endif()
  gtest_discover_tests(
    ${target} TEST_FILTER "${filter}" TEST_PREFIX "${target}." TEST_LIST ${target}_${speed}
    DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${ARGN}${speed}" ${properties} ENVIRONMENT ${threads})
endfunction()

# bedload_precompile(<target>): reads what most tests include once, a quarter less to compile. Not with ccache, which
# would then keep nothing.
function(bedload_precompile target)
  if(NOT CCACHE)
    target_precompile_headers(
      ${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${CMAKE_SOURCE_DIR}/tests/support/precompiled.hpp>)
  endif()
endfunction()
set_source_files_properties(tests/support/skip_without_avx2.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)

# With the modules for plots: made by tools/install_dependencies.
find_program(BEDLOAD_PYTHON python PATHS ${CMAKE_SOURCE_DIR}/build/venv/bin NO_DEFAULT_PATH)

file(GLOB host_tests CONFIGURE_DEPENDS tests/case/*_test.cpp tests/convert/*_test.cpp tests/geometry/*_test.cpp
                                       tests/motion/*_test.cpp tests/output/*_test.cpp tests/program/*_test.cpp
                                       tests/viewer/*_test.cpp tests/viscometer/*_test.cpp)
if(host_tests)
  add_executable(bedload_host_tests ${host_tests})
  add_dependencies(bedload_host_tests bedload)
  target_compile_definitions(bedload_host_tests PRIVATE BL_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
                                                        BL_PROGRAM="$<TARGET_FILE:bedload>")
  if(BEDLOAD_PYTHON)
    target_compile_definitions(bedload_host_tests PRIVATE BEDLOAD_PYTHON="${BEDLOAD_PYTHON}")
  endif()
  target_compile_options(bedload_host_tests PRIVATE $<$<CONFIG:Release>:-O1>)  # in half the time
  target_link_libraries(bedload_host_tests PRIVATE bedload_program bedload_device PNG::PNG GTest::gtest_main)
  bedload_precompile(bedload_host_tests)
  bedload_register(bedload_host_tests quick)
  bedload_register(bedload_host_tests slow)
endif()

if(BEDLOAD_PYTHON)
  foreach(test tools includes)
    add_test(NAME ${test} COMMAND ${BEDLOAD_PYTHON} ${CMAKE_SOURCE_DIR}/tests/tools/${test}_test.py)
    set_tests_properties(${test} PROPERTIES LABELS quick TIMEOUT 300)
  endforeach()
  foreach(test schema docs)
    add_test(NAME ${test}
             COMMAND ${BEDLOAD_PYTHON} ${CMAKE_SOURCE_DIR}/tests/tools/${test}_test.py $<TARGET_FILE:bedload>)
    set_tests_properties(${test} PROPERTIES LABELS quick TIMEOUT 300)
  endforeach()
  # a few of the values; without --every all of them, in some ten minutes
  add_test(NAME hostile_values COMMAND ${BEDLOAD_PYTHON} ${CMAKE_SOURCE_DIR}/tests/attack/hostile_values.py
                                       $<TARGET_FILE:bedload> --every 97)
  set_tests_properties(hostile_values PROPERTIES LABELS quick TIMEOUT 300)
endif()

# The page of a live view; skipped where there is no Chromium.
if(BEDLOAD_PYTHON AND "mixed" IN_LIST BEDLOAD_PRECISIONS)
  add_test(NAME live_browser
           COMMAND ${BEDLOAD_PYTHON} ${CMAKE_SOURCE_DIR}/tests/program/live_browser_test.py $<TARGET_FILE:bedload>)
  set_tests_properties(live_browser PROPERTIES LABELS slow TIMEOUT 300 SKIP_RETURN_CODE 77)
endif()

# What is installed and packed.
if(BEDLOAD_PYTHON AND "mixed" IN_LIST BEDLOAD_PRECISIONS AND NOT BEDLOAD_SANITIZE AND NOT BEDLOAD_COVERAGE)
  add_test(NAME package
           COMMAND ${BEDLOAD_PYTHON} ${CMAKE_SOURCE_DIR}/tests/package/package_test.py ${CMAKE_BINARY_DIR})
  set_tests_properties(package PROPERTIES LABELS slow TIMEOUT 600)
endif()

# Small cases as a user runs them, against what they should come to.
if(BEDLOAD_PYTHON AND "mixed" IN_LIST BEDLOAD_PRECISIONS)
  foreach(case still_bed/case:expect hindered_settling/sand_080:expect_sand_080 sphere_settling/water:expect_water
               sphere_settling/glycerol:expect_glycerol dam_break_impact/case:expect oil_under_head/case:expect)
    string(REGEX MATCH "^(.*)/(.*):(.*)$" _ ${case})
    set(folder ${CMAKE_SOURCE_DIR}/cases/${CMAKE_MATCH_1})
    set(results ${CMAKE_BINARY_DIR}/cases/${CMAKE_MATCH_1}_${CMAKE_MATCH_2})
    add_test(NAME case.${CMAKE_MATCH_1}.${CMAKE_MATCH_2}
             COMMAND bash -c "'$<TARGET_FILE:bedload>' run '${folder}/${CMAKE_MATCH_2}.toml' --out '${results}' \
--overwrite --quiet && '${BEDLOAD_PYTHON}' '${CMAKE_SOURCE_DIR}/tools/compare.py' '${folder}/${CMAKE_MATCH_3}.toml' \
'${results}'")
    set_tests_properties(case.${CMAKE_MATCH_1}.${CMAKE_MATCH_2} PROPERTIES LABELS slow TIMEOUT 900 COST 100)
  endforeach()
endif()

file(GLOB_RECURSE BEDLOAD_SOLVER_TESTS CONFIGURE_DEPENDS
     tests/kernels/*_test.cpp tests/parallel/*_test.cpp tests/particles/*_test.cpp
     tests/neighbours/*_test.cpp tests/fluid/*_test.cpp tests/solids/*_test.cpp tests/walls/*_test.cpp
     tests/coupling/*_test.cpp tests/boundaries/*_test.cpp tests/lattice/*_test.cpp tests/time/*_test.cpp
     tests/physics/*_test.cpp)

# The physics is one source: mixed precision runs all tests, single and double those that numbers of another size or
# packed positions could fail.
file(GLOB_RECURSE BEDLOAD_PRECISION_TESTS CONFIGURE_DEPENDS
     tests/kernels/*_test.cpp tests/particles/*_test.cpp tests/neighbours/*_test.cpp tests/lattice/*_test.cpp)
foreach(test
        boundaries/edges         # places at the sides of the domain, packed too
        coupling/counted_grains  # density that counts grains
        coupling/exchange        # momenta of a two-way bed, sums against all pairs
        fluid/fluid_pairs        # forces that balance
        fluid/frozen_wall        # SDPD between frozen walls, against all fluid
        fluid/sdpd               # SDPD: what its pairs keep, viscosity, temperature, densities
        physics/coupled_flow     # grains in fluid: momenta, restart and repeat bit for bit
        physics/fluid_flow       # energy; repeat bit for bit
        physics/sdpd_flow        # SDPD: momentum, angular momentum, restart and threads bit for bit
        physics/wall_surface     # a dam break, a jet
        solids/impact            # a grain that strikes a floor, a gas of grains
        solids/solid_lists)      # contacts: restart and repeat bit for bit
  list(APPEND BEDLOAD_PRECISION_TESTS ${CMAKE_SOURCE_DIR}/tests/${test}_test.cpp)
endforeach()

# Which of them hold Slow suites, and which hold nothing else. Their text decides: it is read again when it changes.
set(slow_tests "")
set(only_slow_tests "")
set_property(DIRECTORY ${CMAKE_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${BEDLOAD_SOLVER_TESTS})
foreach(test IN LISTS BEDLOAD_SOLVER_TESTS)
  file(STRINGS ${test} slow REGEX "^(TYPED_)?TEST(_[FP])?\\(Slow" LIMIT_COUNT 1)
  file(STRINGS ${test} quick REGEX "^(TYPED_)?TEST(_[FP])?\\(([^S]|S[^l]|Sl[^o]|Slo[^w])" LIMIT_COUNT 1)
  if(slow)
    list(APPEND slow_tests ${test})
    if(NOT quick)
      list(APPEND only_slow_tests ${test})
    endif()
  endif()
endforeach()

# bedload_variant_tests(<variant> [label prefix]): the solver's tests, built for one variant.
function(bedload_variant_tests variant)
  set(tests ${BEDLOAD_SOLVER_TESTS})
  if(NOT variant MATCHES "mixed")
    set(tests ${BEDLOAD_PRECISION_TESTS})
  endif()
  set(slow_elsewhere OFF)
  if(slow_in_avx2 AND variant STREQUAL "mixed_cpu")
    set(slow_elsewhere ON)
    list(REMOVE_ITEM tests ${only_slow_tests})
  endif()
  # compares the documents with what the solver does
  set_source_files_properties(${CMAKE_SOURCE_DIR}/tests/time/stages_test.cpp
                              PROPERTIES COMPILE_DEFINITIONS BL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  add_executable(bedload_tests_${variant} ${tests})
  if(NOT variant MATCHES "cuda")
    target_compile_options(bedload_tests_${variant} PRIVATE $<$<CONFIG:Release>:-O1>)  # a quarter less time
    bedload_precompile(bedload_tests_${variant})
  endif()
  target_link_libraries(bedload_tests_${variant} PRIVATE bedload_${variant} bedload_host GTest::gtest_main)
  bedload_register(bedload_tests_${variant} quick ${ARGN})
  if(variant MATCHES "mixed" AND NOT slow_elsewhere)
    bedload_register(bedload_tests_${variant} slow ${ARGN})
  endif()
endfunction()

# bedload_staged_run(<variant>): what bedload_stage_tests sees of one variant.
function(bedload_staged_run variant)
  add_library(bedload_staged_run_${variant} STATIC ${CMAKE_SOURCE_DIR}/tests/support/staged_run.cpp)
  target_link_libraries(bedload_staged_run_${variant} PRIVATE bedload_${variant})
endfunction()

foreach(precision IN LISTS BEDLOAD_PRECISIONS)
  bedload_variant_tests(${precision}_cpu)
endforeach()

# AVX2: the slow tests; the quick ones beside them and those whose loops take packs, as one test, skipped where the CPU
# has none; and what would let its instructions out.
if(BEDLOAD_CPU_DISPATCH)
  set(avx2_tests ${BEDLOAD_PRECISION_TESTS})
  list(FILTER avx2_tests INCLUDE REGEX "/tests/(neighbours|coupling|fluid|physics/coupled)")
  if(slow_in_avx2)
    list(APPEND avx2_tests ${slow_tests})
    list(REMOVE_DUPLICATES avx2_tests)
  endif()
  foreach(precision IN LISTS BEDLOAD_PRECISIONS)
    add_test(NAME sealed.${precision}_cpu_avx2
             COMMAND sh -c "test $('${CMAKE_NM}' --defined-only --extern-only \"$1\" | wc -l) = 1 && \
! '${CMAKE_OBJDUMP}' -h \"$1\" | grep -E ' [.](init_array|ctors)'" sh ${CMAKE_BINARY_DIR}/bedload_${precision}_cpu_avx2.o)
    set_tests_properties(sealed.${precision}_cpu_avx2 PROPERTIES LABELS quick)
  endforeach()
  if("mixed" IN_LIST BEDLOAD_PRECISIONS)
    set_source_files_properties(tests/support/skip_without_avx2.cpp PROPERTIES COMPILE_OPTIONS -mno-avx)
    add_executable(bedload_tests_mixed_cpu_avx2 ${avx2_tests} tests/support/skip_without_avx2.cpp)
    target_compile_options(bedload_tests_mixed_cpu_avx2 PRIVATE $<$<CONFIG:Release>:-O1>)
    target_link_libraries(bedload_tests_mixed_cpu_avx2 PRIVATE bedload_mixed_cpu_avx2 bedload_host GTest::gtest_main)
    bedload_precompile(bedload_tests_mixed_cpu_avx2)
    add_test(NAME bedload_tests_mixed_cpu_avx2 COMMAND bedload_tests_mixed_cpu_avx2 --gtest_filter=-Slow*:*/Slow*)
    set_tests_properties(bedload_tests_mixed_cpu_avx2 PROPERTIES LABELS quick TIMEOUT 300 SKIP_RETURN_CODE 77
                         ENVIRONMENT OMP_WAIT_POLICY=passive)
    if(slow_in_avx2)
      bedload_register(bedload_tests_mixed_cpu_avx2 slow)
    endif()
  endif()
endif()
if(BEDLOAD_CUDA)
  add_subdirectory(tools/cmake/cuda_tests)
endif()

# Stage by stage, build against build: threads, AVX2 and GPU against the CPU. One program holds them all.
# LINK_ONLY: their definitions are not its own.
set(staged_runs "")
add_executable(bedload_stage_tests tests/backends/stages_test.cpp)
foreach(precision IN LISTS BEDLOAD_PRECISIONS)
  foreach(backend cpu cpu_avx2 cuda)
    set(variant ${precision}_${backend})
    if(NOT TARGET bedload_${variant})
      continue()
    endif()
    if(NOT backend STREQUAL "cuda")
      bedload_staged_run(${variant})
    endif()
    string(APPEND staged_runs "BL_USE(${precision}, ${backend}) ")
    target_link_libraries(bedload_stage_tests PRIVATE $<LINK_ONLY:bedload_staged_run_${variant}>)
  endforeach()
endforeach()
# after them: of AVX2 all is here before the sealed build of it is asked for
target_link_libraries(bedload_stage_tests PRIVATE bedload_host bedload_device OpenMP::OpenMP_CXX GTest::gtest_main)
target_compile_definitions(bedload_stage_tests PRIVATE "BL_STAGED_RUNS=${staged_runs}")
if(BEDLOAD_CPU_DISPATCH)
  target_sources(bedload_stage_tests PRIVATE tests/support/skip_without_avx2.cpp)
  set_source_files_properties(tests/support/skip_without_avx2.cpp PROPERTIES COMPILE_OPTIONS -mno-avx)
endif()
bedload_register(bedload_stage_tests quick)
