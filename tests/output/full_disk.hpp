#pragma once
// Writing to a disk that is full.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "bedload/core/error.hpp"

namespace bedload::testing {

/// Runs `write` with a limit on the size of files, at which writes fail as on a full
/// disk; prints the FileError it throws and exits with 2, as the program does. For EXPECT_EXIT.
template <class Action>
[[noreturn]] void exit_from_full_disk(Action write) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit tight{1 << 16, 1 << 16};
  setrlimit(RLIMIT_FSIZE, &tight);
  try {
    write();
  } catch (const FileError& error) {
    std::fprintf(stderr, "%s\n", error.what());
#if defined(__SANITIZE_ADDRESS__)
    std::_Exit(2);  // HDF5 keeps the memory of a file that it could not close
#else
    std::exit(2);
#endif
  }
  std::_Exit(0);
}

}  // namespace bedload::testing
