// The cases that come with Bedload are in order.

#include <gtest/gtest.h>

#include <filesystem>

#include "bedload/case/read.hpp"

namespace bedload::test {
namespace {

TEST(ShippedCases, AllRead) {
  int cases = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(BL_SOURCE_DIR "/cases")) {
    const auto& path = entry.path();
    if (path.extension() != ".toml" || path.stem().string().starts_with("expect")) continue;
    std::vector<std::string> warnings;
    EXPECT_NO_THROW(read_case(path, {}, warnings)) << path;
    ++cases;
  }
  EXPECT_GT(cases, 0);
}

}  // namespace
}  // namespace bedload::test
