// Memory of solvers beside the fields.

#include "bedload/particles/scratch.hpp"

#include <gtest/gtest.h>

namespace BL_SOLVER {
namespace {

struct Solver {
  bool second;
  Scratch each = {};
  ScratchArray<double> first_array{each};
  ScratchArray<std::uint32_t> second_array{each, second};
};

TEST(Scratch, TakesWhatItCounts) {
  for (const bool second : {false, true}) {
    Solver solver{second};
    const std::size_t size = second ? 12 : 8, before = bytes_held();
    EXPECT_EQ(solver.each.entry_bytes(), size);
    EXPECT_EQ(bytes_held(), before);
    solver.each.resize(100);
    EXPECT_EQ(bytes_held() - before, 100 * size);
    EXPECT_EQ(solver.first_array.size(), 100u);
    EXPECT_EQ(solver.second_array.size(), second ? 100u : 0u);
    solver.each.resize(50);
    EXPECT_EQ(solver.first_array.size(), 50u);
    EXPECT_EQ(solver.each.entry_bytes(), size);
  }
}

}  // namespace
}  // namespace BL_SOLVER
