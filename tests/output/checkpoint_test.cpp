#include <gtest/gtest.h>
#include <unistd.h>

#include <random>

#include <fstream>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/h5.hpp"
#include "bedload/output/output.hpp"
#include "fake_simulation.hpp"
#include "full_disk.hpp"

namespace bedload::testing {
namespace {

/// What read_checkpoint says about a file it must refuse.
std::string refusal(const std::filesystem::path& path, const Config& config) {
  try {
    read_checkpoint(path, config);
  } catch (const FileError& e) {
    return e.what();
  }
  return "accepted";
}

void expect_says(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

class Checkpoint : public ::testing::Test {
 protected:
  SavedState state() {
    FakeSimulation s;
    for (int k = 0; k < 5; ++k) s.step();
    return s.save();
  }
  std::filesystem::path written() {
    const auto path = folder / "state.h5";
    write_state(path, state(), config);
    return path;
  }
  test::TemporaryFolder folder;
  Config config = fake_config();
};

TEST_F(Checkpoint, ReturnsEveryBit) {
  const auto before = state();
  const auto after = read_checkpoint(written(), config);
  ASSERT_EQ(after.stores.size(), before.stores.size());
  for (std::size_t s = 0; s < before.stores.size(); ++s) {
    EXPECT_EQ(after.stores[s].name, before.stores[s].name);
    EXPECT_EQ(after.stores[s].count, before.stores[s].count);
    ASSERT_EQ(after.stores[s].arrays.size(), before.stores[s].arrays.size());
    for (std::size_t k = 0; k < before.stores[s].arrays.size(); ++k) {
      const auto &a = before.stores[s].arrays[k], &b = after.stores[s].arrays[k];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.unit, a.unit);
      EXPECT_EQ(b.type, a.type);
      EXPECT_EQ(b.components, a.components);
      EXPECT_EQ(b.bytes, a.bytes);
    }
  }
  ASSERT_EQ(after.scalars.size(), before.scalars.size());
  for (std::size_t k = 0; k < before.scalars.size(); ++k) {
    EXPECT_EQ(after.scalars[k].name, before.scalars[k].name);
    EXPECT_EQ(after.scalars[k].unit, before.scalars[k].unit);
    EXPECT_EQ(after.scalars[k].value, before.scalars[k].value);
  }
}

TEST_F(Checkpoint, SameStateGivesSameBytes) {
  write_state(folder / "a.h5", state(), config);
  ::sleep(1);  // a stored time of writing would differ
  write_state(folder / "b.h5", state(), config);
  EXPECT_EQ(read_file(folder / "a.h5"), read_file(folder / "b.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.h5.part"));
}

TEST_F(Checkpoint, RefusesWhatIsNotOne) {
  expect_says(refusal(folder / "none.h5", config), "none.h5: cannot read: no such file");
  expect_says(refusal(folder.path(), config), "no such file");
  write_file(folder / "text.h5", "position = 1\n");
  expect_says(refusal(folder / "text.h5", config),
              "text.h5: cannot restart from this: it is not an HDF5 file");
  {
    h5::Handle other = h5::open_file(folder / "other.h5", h5::Mode::create);
    other.close();
  }
  expect_says(refusal(folder / "other.h5", config), "not a Bedload checkpoint");
}

TEST_F(Checkpoint, RefusesTruncatedFile) {
  const auto path = written();
  const auto size = std::filesystem::file_size(path);
  for (const double part : {0.99, 0.5, 0.1}) {
    std::filesystem::resize_file(path, std::uintmax_t(double(size) * part));
    expect_says(refusal(path, config), "no checksum at its end: it is truncated, of an older version");
  }
}

TEST_F(Checkpoint, RefusesAnyFlippedBit) {
  const auto path = written();
  const std::string whole = read_file(path);
  std::mt19937 rng(3);
  for (int n = 0; n < 500; ++n) {
    const std::size_t at = n < 16 ? whole.size() - 1 - n : rng() % whole.size();
    std::string damaged = whole;
    damaged[at] = char(damaged[at] ^ (1 << (rng() % 8)));
    write_file(path, damaged);
    const std::string why = refusal(path, config);
    EXPECT_TRUE(why.find("checksum") != why.npos || why.find("it is not an HDF5 file") != why.npos)
        << at << ": " << why;
  }
}

/// The highest bits of two words, which plain sums and products would let cancel.
TEST_F(Checkpoint, RefusesFlippedBitsThatCouldCancel) {
  const auto path = written();
  std::string damaged = read_file(path);
  for (const std::size_t word : {40, 90}) damaged[8 * word + 7] = char(damaged[8 * word + 7] ^ 0x80);
  write_file(path, damaged);
  expect_says(refusal(path, config), "it is damaged (wrong checksum)");
}

TEST_F(Checkpoint, RefusesAnotherCase) {
  const auto path = written();
  Config other = config;
  other.fluid.dx = 0.02;
  expect_says(refusal(path, other), "fluid.dx = 0.01, but this case has 0.02");
  other = config;
  other.wall.bodies.at(0).type = "frozen";
  expect_says(refusal(path, other), "its particles differ: it was written without wall.");
  other = config;
  other.fluid.model = FluidModel::sdpd;
  expect_says(refusal(path, other), "its particles differ: it was written without fluid.model = \"sdpd\"");
  other = config;
  other.grain.fills.emplace_back();
  expect_says(refusal(path, other), "its particles differ: it was written without grain.fill.0");
  other = config;
  other.fluid.fills.clear();
  expect_says(refusal(path, other), "its particles differ: it was written with fluid.fill.0");
  other = config;
  other.time.end = 99;
  other.fluid.mu = 2e-3;
  EXPECT_EQ(refusal(path, other), "accepted");
}

TEST_F(Checkpoint, RefusesAnotherPrecision) {
  const std::string all[] = {"single", "mixed", "double"};
  for (const std::string& wrote : all) {
    config.precision = wrote;
    const auto path = written();
    for (const std::string& reads : all) {
      config.precision = reads;
      expect_says(refusal(path, config),
                  reads == wrote ? "accepted" : "run.precision = " + wrote + ", but this case has " + reads);
    }
  }
}

TEST_F(Checkpoint, RefusesAnotherFormat) {
  const auto path = written();
  {
    h5::Handle file = h5::open_file(path, h5::Mode::append);
    h5::write_integer(file, "format", 9);
    file.close();
  }
  seal_file(path);
  expect_says(refusal(path, config), "it has checkpoint format 9, this version reads 8");
}

TEST_F(Checkpoint, FullDiskLeavesTheOldOne) {
  const auto path = written();
  const std::string before = read_file(path);
  SavedState large = state();
  large.stores[0].arrays.push_back(
      array_of("velocity", "m/s", Scalar::f64, 1, std::vector<double>(1 << 18, 1.5)));
  EXPECT_EXIT(exit_from_full_disk([&] { write_state(path, large, config); }), ::testing::ExitedWithCode(2),
              "state.h5: cannot write: File too large");
  EXPECT_EQ(read_file(path), before);
  EXPECT_FALSE(std::filesystem::exists(folder / "state.h5.part"));
}

TEST_F(Checkpoint, UnwritablePlaceIsNamed) {
  write_file(folder / "file", "");
  try {
    write_state(folder / "file" / "state.h5", state(), config);
    FAIL();
  } catch (const FileError& e) {
    expect_says(e.what(), "state.h5: cannot write: ");
  }
}

}  // namespace
}  // namespace bedload::testing
