# Fuzz targets (tools/fuzz): the readers of files, given what libFuzzer makes up. The solver is no part of them.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "BEDLOAD_FUZZ needs Clang, which brings libFuzzer; the preset fuzz names it")
endif()
find_package(GTest REQUIRED)  # the support of tests includes it
foreach(library host program)
  target_compile_options(bedload_${library} PRIVATE -fsanitize=fuzzer-no-link)
endforeach()

# What cases name as beside them.
file(GLOB files cases/*/*.csv cases/*/*.stl cases/*/*.asc)
file(COPY ${files} DESTINATION ${CMAKE_BINARY_DIR}/files)

add_executable(fuzz_seeds tests/fuzz/seeds.cpp)
target_compile_definitions(fuzz_seeds PRIVATE BL_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
target_link_libraries(fuzz_seeds PRIVATE bedload_host bedload_device GTest::gtest)
target_link_options(fuzz_seeds PRIVATE -fsanitize=fuzzer-no-link)
add_custom_target(fuzz DEPENDS fuzz_seeds)
foreach(target case convert table mesh checkpoint)
  add_executable(fuzz_${target} tests/fuzz/${target}.cpp)
  target_compile_definitions(fuzz_${target} PRIVATE BL_FUZZ_FILES="${CMAKE_BINARY_DIR}/files")
  target_link_libraries(fuzz_${target} PRIVATE bedload_program bedload_device)
  target_compile_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
  target_link_options(fuzz_${target} PRIVATE -fsanitize=fuzzer)
  add_dependencies(fuzz fuzz_${target})
endforeach()
