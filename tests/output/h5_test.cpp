// Attributes that others wrote, or that were damaged.

#include "bedload/output/h5.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace bedload {
namespace {

class Attributes : public testing::Test {
 protected:
  test::TemporaryFolder folder;
  h5::Handle file = h5::open_file(folder.path() / "a.h5", h5::Mode::create);

  void write(const char* name, hid_t type, hsize_t count, const void* values) {
    const h5::Handle space(H5Screate_simple(1, &count, nullptr));
    const h5::Handle a(H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
    h5::check(H5Awrite(a, type, values));
  }
};

TEST_F(Attributes, HoldOneValue) {
  const double numbers[] = {1, 2, 3};
  write("time", H5T_NATIVE_DOUBLE, 3, numbers);
  write("one", H5T_NATIVE_DOUBLE, 1, numbers);
  EXPECT_EQ(h5::read_number(file, "one"), 1);
  for (const auto& read :
       {+[](hid_t f) { h5::read_number(f, "time"); }, +[](hid_t f) { h5::read_integer(f, "time"); },
        +[](hid_t f) { h5::read_text(f, "time"); }}) {
    try {
      read(file);
      FAIL();
    } catch (const h5::Error& error) {
      EXPECT_STREQ(error.what(), "attribute 'time' must hold one value");
    }
  }
  EXPECT_THROW(h5::read_text(file, "one"), h5::Error);
}

TEST_F(Attributes, AreTextsOfFixedOrAnyLength) {
  h5::write_text(file, "ours", "Pa s");
  const h5::Handle type(H5Tcopy(H5T_C_S1));
  h5::check(H5Tset_size(type, H5T_VARIABLE));
  const char* text = "metres per second";
  write("theirs", type, 1, &text);
  EXPECT_EQ(h5::read_text(file, "ours"), "Pa s");
  EXPECT_EQ(h5::read_text(file, "theirs"), text);
}

TEST_F(Attributes, OfAnArrayThatIsLargerThanWhatIsStoredAreNotBelieved) {
  const hsize_t n[2] = {hsize_t(1) << 50, 4};
  const h5::Handle space(H5Screate_simple(2, n, nullptr));
  const h5::Handle creation(H5Pcreate(H5P_DATASET_CREATE));
  h5::check(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_LATE));
  const h5::Handle table(
      H5Dcreate2(file, "huge", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
  EXPECT_EQ(h5::extent(table).at(0), n[0]);
  EXPECT_THROW(h5::stored_extent(table), h5::Error);
}

TEST(FileErrors, TellOfArraysThatCannotBe) {
  try {
    h5::with_file_errors("a.h5", "read",
                         [] { return std::string(std::string().max_size() + 1, 'x').size(); });
    FAIL();
  } catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "a.h5: cannot read: it claims an array larger than memory");
  }
}

}  // namespace
}  // namespace bedload
