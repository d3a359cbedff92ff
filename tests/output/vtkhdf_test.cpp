#include "bedload/output/vtkhdf.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "bedload/output/h5_table.hpp"
#include "fake_simulation.hpp"
#include "full_disk.hpp"
#include "node_frames.hpp"

namespace bedload::testing {
namespace {

std::int64_t rows(hid_t root, const std::string& name) {
  return std::int64_t(h5::extent(h5::open_dataset(root, name)).at(0));
}

/// Frames of one store at steps 0, 4, 8, 12, 16; the fluid loses a particle in between.
void write_frames(const FrameFile& file, const std::string& store) {
  FakeSimulation s;
  for (int k = 0; k < 5; ++k) {
    file.append(s.snapshot(store), s.time());
    file.write_xdmf();
    for (int n = 0; n < 4; ++n) s.step();
  }
}

TEST(FrameFile, HoldsTheLayoutOfTemporalPolyData) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  write_frames(frames, "fluid");
  const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
  const h5::Handle root = h5::open_group(file, "VTKHDF");
  EXPECT_EQ(h5::read_text(root, "Type"), "PolyData");
  const h5::Handle steps = h5::open_group(root, "Steps");
  EXPECT_EQ(h5::read_integer(steps, "NSteps"), 5);
  EXPECT_EQ(h5::read_integers(steps, "PointOffsets", 5), (std::vector<std::int64_t>{0, 7, 14, 21, 27}));
  EXPECT_EQ(h5::read_integers(steps, "PartOffsets", 5), (std::vector<std::int64_t>{0, 0, 0, 1, 1}));
  EXPECT_EQ(h5::read_integers(root, "NumberOfPoints", 2), (std::vector<std::int64_t>{7, 6}));
  EXPECT_EQ(rows(root, "NumberOfPoints"), 2);
  EXPECT_EQ(rows(root, "Vertices/Connectivity"), 13);
  EXPECT_EQ(rows(root, "Vertices/Offsets"), 15);
  EXPECT_EQ(rows(root, "Strips/Offsets"), 2);
  EXPECT_EQ(h5::extent(h5::open_dataset(steps, "CellOffsets")), (std::vector<hsize_t>{5, 4}));
  EXPECT_EQ(h5::scalar_of(h5::open_dataset(root, "Points")), Scalar::f32);
  EXPECT_EQ(h5::read_text(h5::open_dataset(root, "Points"), "unit"), "m");
  EXPECT_EQ(h5::read_text(h5::open_dataset(root, "PointData/spin"), "unit"), "rad/s");
  EXPECT_EQ(h5::members(h5::open_group(root, "PointData")),
            (std::vector<std::string>{"speed", "spin", "id"}));
  // Last frame, particle 5, z: 0.125 - 0.48 * 5.
  std::vector<float> points(6 * 3);
  h5::read_rows(h5::open_dataset(root, "Points"), H5T_NATIVE_FLOAT, 27, 6, points.data());
  EXPECT_FLOAT_EQ(points.back(), 0.125f - 0.48f * 5);
}

/// What stands in the .xdmf file is where the frame's rows are in the other: start, stride, count.
TEST(FrameFile, XdmfNamesTheRowsOfEachFrame) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  write_frames(frames, "fluid");
  const std::string text = read_text(frames.xdmf_path());
  const auto count = [&](const std::string& what) {
    int n = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += what.size()) ++n;
    return n;
  };
  EXPECT_EQ(count("<Grid Name=\"fluid\" GridType=\"Uniform\">"), 5);
  EXPECT_EQ(count("NumberOfElements=\"7\""), 3);
  EXPECT_EQ(count("NumberOfElements=\"6\""), 2);
  for (const double time : frames.times()) EXPECT_EQ(count(fmt::format("<Time Value=\"{}\"/>", time)), 1);
  const int starts[] = {0, 7, 14, 21, 27}, counts[] = {7, 7, 7, 6, 6};
  const auto numbers = [&](int start, int rows) {
    return count(fmt::format("<DataItem Dimensions=\"3 1\" Format=\"XML\">{} 1 {}</DataItem>", start, rows));
  };
  for (int k = 0; k < 5; ++k) {  // of the points and "spin", then of "speed"
    EXPECT_EQ(count(fmt::format(">{} 0 1 1 {} 3</DataItem>", starts[k], counts[k])), 2) << k;
    EXPECT_EQ(numbers(starts[k], counts[k]), k == 0 ? 1 + 3 : 1) << k;
  }
  EXPECT_EQ(numbers(7, 6), 2) << "the ids, stored once for three frames and once for two";
  EXPECT_EQ(count("Dimensions=\"33 3\" NumberType=\"Float\" Precision=\"4\">fluid.vtkhdf:/VTKHDF/Points<"),
            5);
  EXPECT_EQ(count("<Attribute Name=\"spin\" AttributeType=\"Vector\" Center=\"Node\">"), 5);
  EXPECT_EQ(count("<Attribute Name=\"speed\" AttributeType=\"Scalar\" Center=\"Node\">"), 5);
  EXPECT_EQ(count("NumberType=\"UInt\" Precision=\"4\">fluid.vtkhdf:/VTKHDF/PointData/id<"), 5);
  EXPECT_EQ(count("<Information Name=\"unit\" Value=\"rad/s\"/>"), 5);
}

TEST(FrameFile, StoresWhatRestsOnce) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "walls.vtkhdf");
  write_frames(frames, "walls");
  const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
  const h5::Handle root = h5::open_group(file, "VTKHDF");
  EXPECT_EQ(frames.times().size(), 5u);
  EXPECT_EQ(rows(root, "Points"), 4);
  EXPECT_EQ(rows(root, "PointData/speed"), 4);
  EXPECT_EQ(rows(root, "Vertices/Connectivity"), 4);
}

TEST(FrameFile, KeepsDoublesInADoubleRun) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "grains.vtkhdf", true, 4);
  write_frames(frames, "grains");
  const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
  const h5::Handle points = h5::open_dataset(file, "VTKHDF/Points");
  ASSERT_EQ(h5::scalar_of(points), Scalar::f64);
  std::vector<double> x(3 * 3);
  h5::read_rows(points, H5T_NATIVE_DOUBLE, 3, 3, x.data());
  EXPECT_EQ(x[3], 1 + 4 * FakeSimulation::kDt);
}

TEST(FrameFile, DroppedFramesLeaveNoTrace) {
  const test::TemporaryFolder folder;
  const FrameFile whole(folder / "whole.vtkhdf"), cut(folder / "cut.vtkhdf");
  write_frames(whole, "fluid");
  write_frames(cut, "fluid");
  for (const std::size_t kept : {3u, 1u, 0u}) {
    cut.keep(kept);
    EXPECT_EQ(cut.times().size(), kept);
    FakeSimulation s;
    for (std::size_t k = 0; k < 5; ++k) {
      if (k >= kept) cut.append(s.snapshot("fluid"), s.time());
      for (int n = 0; n < 4; ++n) s.step();
    }
    const h5::Handle a = h5::open_file(whole.path(), h5::Mode::read);
    const h5::Handle b = h5::open_file(cut.path(), h5::Mode::read);
    for (const char* name :
         {"NumberOfPoints", "Points", "Vertices/Connectivity", "Vertices/Offsets", "Lines/Offsets",
          "Steps/Values", "Steps/PointOffsets", "Steps/PointDataOffsets/id", "PointData/id"})
      EXPECT_EQ(rows(b, std::string("VTKHDF/") + name), rows(a, std::string("VTKHDF/") + name)) << name;
    EXPECT_EQ(cut.times(), whole.times());
  }
}

/// Also when the last ones were cut off and written anew.
TEST(FrameFile, HoldsLinesOfAChangingNumber) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "contacts.vtkhdf", true), cut(folder / "cut.vtkhdf", true);
  for (int k = 0; k < 4; ++k) frames.append(line_frame(k), k), cut.append(line_frame(k), k);
  cut.keep(2);
  for (int k = 2; k < 4; ++k) cut.append(line_frame(k), k);
  for (const FrameFile* file : {&frames, &cut})
    for (int k = 0; k < 4; ++k) {
      const HostStore found = file->read(std::size_t(k)), wanted = line_frame(k);
      EXPECT_TRUE(found.lines);
      ASSERT_EQ(found.count, wanted.count) << k;
      for (const HostArray& a : wanted.arrays) {
        ASSERT_NE(found.find(a.name), nullptr) << a.name;
        EXPECT_EQ(found.find(a.name)->components, a.components);
        EXPECT_TRUE(found.find(a.name)->bytes == a.bytes) << a.name << k;
      }
    }
  const h5::Handle a = h5::open_file(frames.path(), h5::Mode::read),
                   b = h5::open_file(cut.path(), h5::Mode::read);
  for (const char* name : {"NumberOfPoints", "Points", "Lines/Connectivity", "Lines/Offsets", "CellData/id"})
    EXPECT_EQ(rows(b, std::string("VTKHDF/") + name), rows(a, std::string("VTKHDF/") + name)) << name;
  EXPECT_EQ(rows(a, "VTKHDF/Lines/Connectivity"), 2 * (3 + 0 + 1 + 5)) << "with one that no frame shows";
  EXPECT_EQ(rows(a, "VTKHDF/CellData/id"), 3 + 5) << "the same in the last two frames";
  FakeSimulation s;
  EXPECT_THROW(frames.append(s.snapshot("fluid"), 5), FileError);
}

HostStore without(HostStore store, const std::string& name) {
  std::erase_if(store.arrays, [&](const HostArray& a) { return a.name == name; });
  return store;
}

TEST(FrameFile, ArraysThatOnlySomeFramesHaveAreAbsentInTheOthers) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  FakeSimulation s;
  const auto append = [&](const HostStore& store) {
    frames.expect(store);
    frames.append(store, s.time());
    frames.write_xdmf();
    for (int n = 0; n < 6; ++n) s.step();
  };
  append(without(s.snapshot("fluid"), "speed"));
  append(without(s.snapshot("fluid"), "speed"));
  const HostStore all = s.snapshot("fluid");  // with one particle less
  append(all);
  append(without(without(s.snapshot("fluid"), "spin"), "id"));
  append(without(without(s.snapshot("fluid"), "spin"), "id"));

  const auto is_absent = [&](std::size_t frame, const std::string& name) {
    const HostStore store = frames.read(frame);
    const HostArray* a = store.find(name);
    EXPECT_NE(a, nullptr) << name;
    EXPECT_EQ(a->count(), store.count) << name;
    for (std::size_t k = 0; k < a->count() * std::size_t(a->components); ++k)
      if (!(a->type == Scalar::u32   ? a->as<std::uint32_t>()[k] == 0
            : a->type == Scalar::f32 ? std::isnan(a->as<float>()[k])
                                     : std::isnan(a->as<double>()[k])))
        return false;
    return true;
  };
  for (std::size_t frame = 0; frame < 5; ++frame) {
    EXPECT_EQ(frames.read(frame).count, frame < 2 ? 7u : 6u);
    EXPECT_EQ(is_absent(frame, "speed"), frame < 2) << frame;
    EXPECT_EQ(is_absent(frame, "spin"), frame > 2) << frame;
    EXPECT_EQ(is_absent(frame, "id"), frame > 2) << frame;
  }
  EXPECT_EQ(frames.read(2).find("speed")->bytes, all.find("speed")->bytes);
  const auto stored = [&](const char* name) {
    const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
    return rows(file, std::string("VTKHDF/PointData/") + name);
  };
  EXPECT_EQ(stored("speed"), 7 + 3 * 6) << "frames share what is absent";
  EXPECT_EQ(stored("id"), 7 + 6 + 6);
  frames.keep(1);
  EXPECT_EQ(stored("speed"), 7);
  EXPECT_TRUE(is_absent(0, "speed"));
}

TEST(FrameFile, LargeArraysAreStoredAgainOnlyIfAnEntryChanged) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "walls.vtkhdf");
  constexpr std::size_t n = 150000;  // three chunks, of which the last is not full
  HostStore store{"walls", n, {}};
  std::vector<float> x(3 * n), p(n);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = float(k);
  store.arrays.push_back(array_of("position", "m", Scalar::f32, 3, x));
  store.arrays.push_back(array_of("pressure", "Pa", Scalar::f32, 1, p));
  const auto stored = [&](const char* name) {
    const h5::Handle file = h5::open_file(frames.path(), h5::Mode::read);
    return rows(file, std::string("VTKHDF/") + name) / std::int64_t(n);
  };
  for (int k = 0; k < 4; ++k) {
    frames.append(store, k, k > 0);
    EXPECT_EQ(stored("Points"), 1);
    EXPECT_EQ(stored("PointData/pressure"), k < 2 ? 1 : k);
    if (k > 0) store.arrays[1].as<float>()[k == 1 ? n - 1 : 100000] = float(k);
  }
  EXPECT_EQ(frames.read(3).find("pressure")->as<float>()[100000], 2);
  EXPECT_EQ(frames.read(2).find("pressure")->as<float>()[100000], 0);
  EXPECT_EQ(frames.read(2).find("pressure")->as<float>()[n - 1], 1);
}

TEST(FrameFile, ArraysOfAnotherKindAreRefused) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  FakeSimulation s;
  frames.append(s.snapshot("fluid"), 0);
  HostStore other = s.snapshot("fluid");
  other.arrays[1] = array_of("speed", "m/s", Scalar::f64, 1, std::vector<double>(other.count, 1));
  for (const bool write : {false, true}) try {
      write ? frames.append(other, 1) : frames.expect(other);
      ADD_FAILURE() << "an array of doubles follows one of floats";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("array 'speed' has a number type"), std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find("give the restart another --out"), std::string::npos);
    }
}

TEST(FrameFile, FailedWriteNamesFileAndReason) {
  const test::TemporaryFolder folder;
  const FrameFile frames(folder / "fluid.vtkhdf");
  HostStore store{"fluid", 1 << 16, {}};
  store.arrays.push_back(array_of("position", "m", Scalar::f64, 3, std::vector<double>(3 << 16, 0.5)));
  EXPECT_EXIT(exit_from_full_disk([&] { frames.append(store, 0); }), ::testing::ExitedWithCode(2),
              "fluid.vtkhdf: cannot write: File too large");
}

TEST(FrameFile, VtkReadsEveryFrame) {
#ifdef BEDLOAD_PYTHON
  const char* python = BEDLOAD_PYTHON;
#else
  const char* python = std::getenv("BEDLOAD_PYTHON");
#endif
  if (!python || !*python) GTEST_SKIP() << "needs a Python with vtk (BEDLOAD_PYTHON)";
  const test::TemporaryFolder folder;
  for (const char* store : {"fluid", "grains", "walls"})
    write_frames(FrameFile(folder / (std::string(store) + ".vtkhdf"), std::string(store) == "grains"), store);
  const FrameFile fluid(folder / "restarted_fluid.vtkhdf");  // truncated and gone on with
  write_frames(fluid, "fluid");
  fluid.keep(3);
  FakeSimulation s;
  for (int k = 0; k < 5; ++k) {
    if (k >= 3) fluid.append(s.snapshot("fluid"), s.time());
    for (int n = 0; n < 4; ++n) s.step();
  }
  fluid.write_xdmf();
  const FrameFile nodes(folder / "nodes.vtkhdf");
  for (int k = 0; k < 3; ++k) nodes.append(node_frame(k), 0.5 * k);
  nodes.write_xdmf();
  const FrameFile lines(folder / "contacts.vtkhdf");
  for (int k = 0; k < 4; ++k) lines.append(line_frame(k), 0.5 * k);
  lines.write_xdmf();
  HostStore none = s.snapshot("walls");  // a store that empties, and fills again
  const FrameFile emptied(folder / "emptied.vtkhdf");
  emptied.append(none, 0);
  none.count = 0;
  for (auto& a : none.arrays) a.bytes.clear();
  emptied.append(none, 1);
  emptied.append(s.snapshot("walls"), 2);
  const auto script = std::filesystem::path(__FILE__).parent_path() / "read_vtkhdf.py";
  EXPECT_EQ(
      std::system(("'" + std::string(python) + "' '" + script.string() + "' '" + folder.path().string() + "'")
                      .c_str()),
      0);
}

}  // namespace
}  // namespace bedload::testing
