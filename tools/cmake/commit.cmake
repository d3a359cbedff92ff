# Writes FILE, which names the commit that is built, if that has changed.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND git --no-optional-locks describe --always --dirty --exclude=* OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${FILE} CONTENT "#define BL_COMMIT \"@commit@\"\n" @ONLY)
