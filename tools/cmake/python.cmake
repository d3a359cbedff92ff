# The module for Python: the package in src/python/bedload with it is what `pip install .` builds (pyproject.toml). In
# the build folder python/bedload is the whole package, for PYTHONPATH.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
execute_process(COMMAND ${Python_EXECUTABLE} -m nanobind --cmake_dir OUTPUT_STRIP_TRAILING_WHITESPACE
                OUTPUT_VARIABLE nanobind_ROOT COMMAND_ERROR_IS_FATAL ANY)
find_package(nanobind CONFIG REQUIRED)

set(package ${CMAKE_BINARY_DIR}/python/bedload)
file(GLOB module_sources CONFIGURE_DEPENDS src/python/bindings/*.cpp)
nanobind_add_module(bedload_python NB_STATIC EXCLUDE_FROM_ALL ${module_sources})
set_target_properties(bedload_python PROPERTIES OUTPUT_NAME _bedload LIBRARY_OUTPUT_DIRECTORY ${package})
target_link_libraries(bedload_python PRIVATE bedload_program bedload_device)
nanobind_add_stub(bedload_python_stub MODULE _bedload OUTPUT ${package}/_bedload.pyi PYTHON_PATH ${package}
                  DEPENDS bedload_python)
file(GLOB package_sources CONFIGURE_DEPENDS src/python/bedload/*)
file(MAKE_DIRECTORY ${package})
foreach(source IN LISTS package_sources)
  cmake_path(GET source FILENAME name)
  if(NOT name STREQUAL "__pycache__")
    file(CREATE_LINK ${source} ${package}/${name} SYMBOLIC)
  endif()
endforeach()

install(TARGETS bedload_python LIBRARY DESTINATION bedload COMPONENT python EXCLUDE_FROM_ALL)
install(FILES ${package}/_bedload.pyi DESTINATION bedload COMPONENT python EXCLUDE_FROM_ALL)
