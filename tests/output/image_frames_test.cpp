// Frames of the nodes of a lattice.

#include <gtest/gtest.h>

#include "bedload/core/error.hpp"
#include "bedload/output/h5_table.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "fake_simulation.hpp"
#include "node_frames.hpp"

namespace bedload::testing {
namespace {

TEST(ImageFrames, AreReadAsTheyWereWritten) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  for (int k = 0; k < 4; ++k) frames.append(node_frame(k), 0.5 * k, k > 0);
  EXPECT_EQ(frames.times(), (std::vector<double>{0, 0.5, 1, 1.5}));
  for (std::size_t k = 0; k < 4; ++k) {
    const HostStore found = frames.read(k), wanted = node_frame(int(k));
    EXPECT_EQ(found.grid, wanted.grid);
    ASSERT_EQ(found.arrays.size(), wanted.arrays.size());
    for (const HostArray& a : wanted.arrays) {
      const HostArray* b = found.find(a.name);
      ASSERT_TRUE(b) << a.name;
      EXPECT_EQ(b->bytes, a.bytes) << a.name;
      EXPECT_EQ(b->unit, a.unit);
    }
  }
  frames.keep(2);
  EXPECT_EQ(frames.times(), (std::vector<double>{0, 0.5}));
  frames.append(node_frame(7), 3, true);
  EXPECT_EQ(frames.read(2).find("speed")->bytes, node_frame(7).find("speed")->bytes);
  frames.keep(0);
  EXPECT_FALSE(std::filesystem::exists(frames.path()));
}

TEST(ImageFrames, StoreOnceWhatDoesNotChange) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  for (int k = 0; k < 4; ++k) frames.append(node_frame(k), k, k > 0);
  const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
  const h5::Handle data = h5::open_group(file, "VTKHDF/PointData");
  EXPECT_EQ(h5::extent(h5::open_dataset(data, "speed")), (std::vector<hsize_t>{4, 2, 3, 5}));
  EXPECT_EQ(h5::extent(h5::open_dataset(data, "velocity")), (std::vector<hsize_t>{4, 2, 3, 5, 3}));
  EXPECT_EQ(h5::extent(h5::open_dataset(data, "solid")), (std::vector<hsize_t>{1, 2, 3, 5}));
}

TEST(ImageFrames, OfOtherPlacesOrParticlesAreRefused) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  frames.append(node_frame(0), 0);
  HostStore moved = node_frame(1), particles = FakeSimulation().snapshot("fluid");
  moved.grid->first.x += 0.1;
  for (const auto& [store, what] :
       {std::pair{moved, "its places are not those of this run"}, {particles, "it has frames of nodes"}})
    for (const bool write : {false, true}) try {
        write ? frames.append(store, 1, true) : frames.expect(store);
        ADD_FAILURE() << what;
      } catch (const FileError& error) {
        EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      }
  const FrameFile points(folder / "points.vtkhdf");
  points.append(particles, 0);
  EXPECT_THROW(points.append(node_frame(0), 1, true), FileError);
}

}  // namespace
}  // namespace bedload::testing
