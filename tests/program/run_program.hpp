#pragma once
// Runs the program as a user does.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace bedload::test {

struct Outcome {
  int code = -1;
  std::string out, err;
};

inline std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A folder of its own for each test, with a cache of its own; removed at the end.
class ProgramTest : public testing::Test {
 protected:
  /// Runs `bedload <arguments>` in the test's folder.
  Outcome bedload(const std::string& arguments) const { return shell(BL_PROGRAM " " + arguments); }

  Outcome shell(const std::string& command) const {
    const std::string all = "cd '" + dir_.string() +
                            "' && XDG_CACHE_HOME=cache OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive " + command +
                            " >out.txt 2>err.txt";
    const int status = std::system(all.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(dir_ / "out.txt"),
            content_of(dir_ / "err.txt")};
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }

  const TemporaryFolder folder_;
  const std::filesystem::path& dir_ = folder_.path();
};

}  // namespace bedload::test
