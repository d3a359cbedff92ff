// Shows the contents of a result file.

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bedload/core/error.hpp"
#include "bedload/output/h5.hpp"
#include "commands.hpp"
#include "prepare.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

/// Attribute `name` of an object as text.
std::string attribute_text(hid_t object, const std::string& name) {
  const h5::Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT));
  const h5::Handle type(H5Aget_type(attribute)), space(H5Aget_space(attribute));
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (H5Tget_class(type) == H5T_STRING && n == 1) return h5::read_text(object, name.c_str());
  if (n < 1 || n > 16) return fmt::format("{} values", n);
  std::string out;
  if (H5Tget_class(type) == H5T_INTEGER) {
    std::vector<std::int64_t> values(n);
    h5::check(H5Aread(attribute, H5T_NATIVE_INT64, values.data()));
    for (const auto v : values) out += fmt::format("{}{}", out.empty() ? "" : ", ", v);
  } else if (H5Tget_class(type) == H5T_FLOAT) {
    std::vector<double> values(n);
    h5::check(H5Aread(attribute, H5T_NATIVE_DOUBLE, values.data()));
    for (const auto v : values) out += fmt::format("{}{}", out.empty() ? "" : ", ", v);
  }
  return out;
}

std::string type_text(hid_t dataset) {
  const h5::Handle type(H5Dget_type(dataset));
  const auto bits = 8 * H5Tget_size(type);
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return fmt::format("float{}", bits);
    case H5T_INTEGER:
      return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", bits);
    default:
      return "text";
  }
}

/// First and last of a short list of numbers: times, offsets.
std::string ends_text(hid_t dataset, const std::vector<hsize_t>& extent) {
  const h5::Handle type(H5Dget_type(dataset));
  if (extent.size() != 1 || extent[0] == 0 || extent[0] > 100000 || H5Tget_class(type) != H5T_FLOAT)
    return "";
  std::vector<double> values(extent[0]);
  h5::check(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  return fmt::format("  {:.6g} .. {:.6g}", values.front(), values.back());
}

void show_dataset(hid_t parent, const std::string& name, int depth) {
  const h5::Handle dataset(H5Dopen2(parent, name.c_str(), H5P_DEFAULT));
  const auto extent = h5::extent(dataset);
  std::string shape;
  for (const hsize_t n : extent)
    shape += fmt::format("{}{}", shape.empty() ? "" : " x ", grouped(std::int64_t(n)));
  const std::string unit = h5::has_attribute(dataset, "unit") ? h5::read_text(dataset, "unit") : "";
  fmt::print("{:{}}{:<24} {:<8} {}{}{}\n", "", 2 * depth, name, type_text(dataset),
             shape.empty() ? "1" : shape, unit.empty() ? "" : "  " + unit, ends_text(dataset, extent));
}

void show_group(hid_t group, int depth) {
  for (const std::string& name : h5::attributes(group)) {
    if (name.ends_with(":unit")) continue;
    const std::string unit = name + ":unit";
    fmt::print("{:{}}{} = {}{}\n", "", 2 * depth, name, attribute_text(group, name),
               h5::has_attribute(group, unit.c_str()) ? " " + h5::read_text(group, unit.c_str()) : "");
  }
  for (const std::string& name : h5::members(group)) {
    H5O_info_t info;
    h5::check(H5Oget_info_by_name(group, name.c_str(), &info, H5P_DEFAULT));
    if (info.type == H5O_TYPE_DATASET) {
      show_dataset(group, name, depth);
    } else {
      fmt::print("{:{}}{}\n", "", 2 * depth, name);
      show_group(h5::open_group(group, name), depth + 1);
    }
  }
}

/// {"value": .., "unit": ..} is printed as one number.
void show_json(const nlohmann::ordered_json& value, const std::string& name, int depth) {
  const auto line = [&](const std::string& text) {
    fmt::print("{:{}}{:<24} {}\n", "", 2 * depth, name, text);
  };
  if (value.is_object() && value.contains("value") && value.contains("unit") && value["unit"].is_string()) {
    const std::string unit = value["unit"].get<std::string>();
    line(value["value"].dump() + (unit == "-" ? "" : " " + unit));
  } else if (value.is_structured()) {
    if (!name.empty()) fmt::print("{:{}}{}\n", "", 2 * depth, name);
    const int inner = name.empty() ? depth : depth + 1;
    if (value.is_object())
      for (const auto& [key, member] : value.items()) show_json(member, key, inner);
    else
      for (const auto& item : value)
        fmt::print("{:{}}{}\n", "", 2 * inner, item.is_string() ? item.get<std::string>() : item.dump());
  } else {
    line(value.is_string() ? value.get<std::string>() : value.dump());
  }
}

}  // namespace

int show_file(const fs::path& file) {
  if (fs::is_directory(file))
    throw FileError(file.string() + ": cannot read: it is a folder; name a file in it");
  if (!fs::is_regular_file(file)) throw FileError(file.string() + ": cannot read: no such file");
  if (h5::is_hdf5(file)) {
    try {
      fmt::print("{}, {}\n", file.string(), bytes_text(fs::file_size(file)));
      show_group(h5::open_file(file, h5::Mode::read), 0);
    } catch (const h5::Error& error) {
      throw FileError(file.string() + ": cannot read: " + error.what());
    }
    return 0;
  }
  std::ifstream in(file);
  constexpr int deepest = 100;
  const auto shallow = [](int depth, nlohmann::ordered_json::parse_event_t, nlohmann::ordered_json&) {
    return depth <= deepest;
  };
  const auto summary = nlohmann::ordered_json::parse(in, shallow, false);
  if (summary.is_discarded() || !summary.is_object())
    throw FileError(file.string() + ": not a checkpoint, .vtkhdf file or summary.json");
  show_json(summary, "", 0);
  return 0;
}

}  // namespace bedload
