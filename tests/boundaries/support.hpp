#pragma once
// Whole simulations of cases given as text.

#include <gtest/gtest.h>

#include <string>

#include "bedload/case/read.hpp"
#include "tests/support/run.hpp"

namespace BL_SOLVER {

inline Config config_of(const std::string& text) {
  std::vector<std::string> warnings;
  return read_case_text(text, "case.toml", {}, warnings);
}
inline std::unique_ptr<Simulation> started(const std::string& text) { return started(config_of(text)); }

inline double reading(Simulation& s, const std::string& name) { return reading(s.diagnostics(), name); }

inline std::vector<Id> ids_of(const HostStore& store) {
  const auto* id = store.find("id")->as<std::uint32_t>();
  return {id, id + store.count};
}

/// Goes on with a copy made from what `s` saves; both must agree to the last bit after `steps`.
inline void expect_restart_is_bit_equal(Simulation& s, const Config& config, int steps) {
  const SavedState state = s.save();
  auto copy = make_coupled(config, Setup{});
  copy->load(state);
  EXPECT_EQ(bits(s), bits(*copy));
  for (int k = 0; k < steps; ++k) {
    s.step();
    copy->step();
  }
  EXPECT_EQ(bits(s), bits(*copy));
}

}  // namespace BL_SOLVER
