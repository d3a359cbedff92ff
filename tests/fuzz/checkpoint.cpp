// Checkpoints and summaries. What begins as an HDF5 file is one, what begins with { is a summary; all else is
// taken as orders by which a sound checkpoint is changed and sealed again, so that what it holds comes to be
// read.

#include <fuzzer/FuzzedDataProvider.h>

#include <array>

#include "bedload/output/files.hpp"
#include "bedload/output/h5.hpp"
#include "bedload/output/output.hpp"
#include "fuzz.hpp"
#include "src/cli/commands.hpp"
#include "tests/output/fake_simulation.hpp"

namespace bedload::fuzz {
namespace {

constexpr const char* kObjects[] = {"/",
                                    "/case",
                                    "/setup",
                                    "/scalars",
                                    "/stores",
                                    "/stores/fluid",
                                    "/stores/fluid/position",
                                    "/stores/contacts",
                                    "/stores/contacts/pair",
                                    "/stores/bodies",
                                    "/stores/bodies/speed"};
constexpr const char* kAttributes[] = {"format", "precision", "time", "time:unit",
                                       "steps",  "count",     "unit", "fluid.dx"};

const std::string& sound_checkpoint() {
  static const std::string bytes = [] {
    const auto path = file_of("sound.h5", "");
    write_state(path, testing::FakeSimulation().save(), testing::fake_config());
    return read_file(path);
  }();
  return bytes;
}

h5::Handle type_from(FuzzedDataProvider& orders) {
  const std::array numbers{H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I64LE, H5T_STD_U8LE, H5T_STD_U32LE};
  const auto which = orders.ConsumeIntegralInRange<std::size_t>(0, numbers.size() + 1);
  if (which < numbers.size()) return h5::Handle(H5Tcopy(numbers[which]));
  h5::Handle text(H5Tcopy(H5T_C_S1));
  h5::check(H5Tset_size(
      text, which == numbers.size() ? orders.ConsumeIntegralInRange<std::size_t>(1, 40) : H5T_VARIABLE));
  return text;
}

/// Up to three extents; of an array, which is not written, some huge.
h5::Handle space_from(FuzzedDataProvider& orders, bool array) {
  std::array<hsize_t, 3> n{};
  const int rank = orders.ConsumeIntegralInRange(0, 3);
  for (hsize_t& extent : n) extent = orders.ConsumeIntegralInRange<hsize_t>(0, 6);
  if (array && orders.ConsumeProbability<float>() < 0.1f) n[0] = orders.ConsumeIntegral<hsize_t>() >> 1;
  return h5::Handle(rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, n.data(), nullptr));
}

void change(hid_t file, FuzzedDataProvider& orders) {
  const std::string object = orders.PickValueInArray(kObjects);
  const std::string attribute = orders.PickValueInArray(kAttributes);
  switch (orders.ConsumeIntegralInRange(0, 4)) {
    case 0:
      h5::check(H5Ldelete(file, object.c_str(), H5P_DEFAULT));
      break;
    case 1:
      h5::check(H5Adelete_by_name(file, object.c_str(), attribute.c_str(), H5P_DEFAULT));
      break;
    case 2: {
      H5Adelete_by_name(file, object.c_str(), attribute.c_str(), H5P_DEFAULT);
      const h5::Handle type = type_from(orders), space = space_from(orders, false);
      const h5::Handle made(H5Acreate_by_name(file, object.c_str(), attribute.c_str(), type, space,
                                              H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
      break;
    }
    case 3: {
      H5Ldelete(file, object.c_str(), H5P_DEFAULT);
      const h5::Handle type = type_from(orders), space = space_from(orders, true);
      const h5::Handle made(
          H5Dcreate2(file, object.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
      if (orders.ConsumeBool()) h5::write_text(made, "unit", "m");
      break;
    }
    default:
      H5Ldelete(file, object.c_str(), H5P_DEFAULT);
      h5::create_group(file, object);
  }
}

std::filesystem::path changed_checkpoint(FuzzedDataProvider& orders) {
  const auto path = file_of("changed.h5", sound_checkpoint());
  h5::Handle file = h5::open_file(path, h5::Mode::append);
  while (orders.remaining_bytes() > 0) {
    try {
      change(file, orders);
    } catch (const h5::Error&) {  // there is no such thing to change
    }
  }
  file.close();
  seal_file(path);
  return path;
}

void read_all(const std::filesystem::path& path) {
  attempt([&] { read_checkpoint(path, testing::fake_config()); });
  attempt([&] { checkpoint_setup(path); });
  attempt([&] { checkpoint_case(path); });
}

}  // namespace
}  // namespace bedload::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bedload;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.starts_with("\x89HDF")) {
    fuzz::read_all(fuzz::file_of("given.h5", bytes));
  } else if (bytes.starts_with("{")) {
    const auto summary = fuzz::file_of("summary.json", bytes);
    fuzz::attempt([&] { show_file(summary); });
  } else {
    FuzzedDataProvider orders(data, size);
    const auto path = fuzz::changed_checkpoint(orders);
    fuzz::read_all(path);
    fuzz::attempt([&] { show_file(path); });
  }
  return 0;
}
