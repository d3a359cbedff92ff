// The .xdmf file next to a frame file, for programs without VTKHDF.

#include <fmt/format.h>

#include <iterator>

#include "bedload/output/files.hpp"
#include "bedload/output/h5_table.hpp"
#include "bedload/output/vtkhdf.hpp"
#include "src/output/image_frames.hpp"

namespace bedload {
namespace {

using h5::Handle;

/// One array of the file and the row at which each frame of it starts.
struct Source {
  std::string name, path, number, unit;
  hsize_t rows = 0, columns = 1;
  std::vector<std::int64_t> starts;
};

std::string number_type(Scalar type) {
  const bool real = type == Scalar::f32 || type == Scalar::f64;
  return fmt::format(R"(NumberType="{}" Precision="{}")", real ? "Float" : "UInt", size_of(type));
}

Source source_of(hid_t parent, const std::string& name, const std::string& path,
                 std::vector<std::int64_t> starts) {
  const Handle table = h5::open_dataset(parent, name);
  const auto n = h5::extent(table);
  return {name,
          path,
          number_type(h5::scalar_of(table)),
          h5::has_attribute(table, "unit") ? h5::read_text(table, "unit") : "-",
          n[0],
          n.size() > 1 ? n[1] : 1,
          std::move(starts)};
}

const char* kind_of(hsize_t columns) {
  switch (columns) {
    case 1:
      return "Scalar";
    case 3:
      return "Vector";
    case 6:
      return "Tensor6";
    case 9:
      return "Tensor";
    default:
      return "Matrix";
  }
}

std::string slab(const std::string& file, const Source& s, std::size_t frame, std::int64_t count) {
  const bool flat = s.columns == 1;
  const auto shape = [&](auto rows) {
    return flat ? fmt::format("{}", rows) : fmt::format("{} {}", rows, s.columns);
  };
  const std::string region = flat ? fmt::format("{} 1 {}", s.starts[frame], count)
                                  : fmt::format("{} 0 1 1 {} {}", s.starts[frame], count, s.columns);
  return fmt::format(
      "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\" {}>\n"
      "          <DataItem Dimensions=\"3 {}\" Format=\"XML\">{}</DataItem>\n"
      "          <DataItem Format=\"HDF\" Dimensions=\"{}\" {}>{}:/VTKHDF/{}</DataItem>\n"
      "        </DataItem>\n",
      shape(count), s.number, flat ? 1 : 2, region, shape(s.rows), s.number, file, s.path);
}

/// The frames of an image.
std::string image_text(hid_t root, const std::string& file, const std::string& name,
                       const std::vector<double>& at) {
  const HostGrid grid = image::grid_of(root);
  const Handle data = h5::open_group(root, "PointData");
  const Handle offsets = h5::open_group(root, "Steps/PointDataOffsets");
  const std::string size = fmt::format("{} {} {}", grid.count[2], grid.count[1], grid.count[0]);
  struct Array {
    Source source;
    hsize_t components;
  };
  std::vector<Array> arrays;
  for (const auto& array : h5::members(data)) {
    const auto n = h5::extent(h5::open_dataset(data, array));
    arrays.push_back(
        {source_of(data, array, "PointData/" + array, h5::read_integers(offsets, array, at.size())),
         n.size() > 4 ? n[4] : 1});
  }
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t k = 0; k < at.size(); ++k) {
    fmt::format_to(out, "    <Grid Name=\"{}\" GridType=\"Uniform\">\n      <Time Value=\"{}\"/>\n", name,
                   at[k]);
    fmt::format_to(out, "      <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"{}\"/>\n", size);
    fmt::format_to(
        out,
        "      <Geometry GeometryType=\"ORIGIN_DXDYDZ\">\n"
        "        <DataItem Dimensions=\"3\" Format=\"XML\">{} {} {}</DataItem>\n"
        "        <DataItem Dimensions=\"3\" Format=\"XML\">{} {} {}</DataItem>\n      </Geometry>\n",
        grid.first.z, grid.first.y, grid.first.x, grid.spacing, grid.spacing, grid.spacing);
    for (const auto& [a, components] : arrays) {
      const bool scalar = components == 1;
      const std::string vector = scalar ? "" : fmt::format(" {}", components), zero = scalar ? "" : " 0",
                        one = scalar ? "" : " 1";
      fmt::format_to(
          out,
          "      <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n"
          "        <DataItem ItemType=\"HyperSlab\" Dimensions=\"{}{}\" {}>\n"
          "          <DataItem Dimensions=\"3 {}\" Format=\"XML\">{} 0 0 0{} 1 1 1 1{} 1 {}{}</DataItem>\n"
          "          <DataItem Format=\"HDF\" Dimensions=\"{} {}{}\" {}>{}:/VTKHDF/{}</DataItem>\n"
          "        </DataItem>\n"
          "        <Information Name=\"unit\" Value=\"{}\"/>\n      </Attribute>\n",
          a.name, kind_of(components), size, vector, a.number, scalar ? 4 : 5, a.starts[k], zero, one, size,
          vector, a.rows, size, vector, a.number, file, a.path, a.unit);
    }
    text += "    </Grid>\n";
  }
  return text;
}

}  // namespace

void FrameFile::write_xdmf() const {
  std::vector<double> at;
  std::vector<std::int64_t> counts;  // of points
  Source points, ends;               // ends: the two points of each line
  std::vector<Source> arrays;
  std::string images;
  const auto read = [&] {
    const Handle file = h5::open_file(path_, h5::Mode::read);
    const Handle root = h5::open_group(file, "VTKHDF");
    if (image::is_image(root)) {
      images = image_text(root, path_.filename().string(), path_.stem().string(), at);
      return;
    }
    const Handle steps = h5::open_group(root, "Steps");
    const bool lines = h5::has_member(root, "CellData");
    const std::string group = lines ? "CellData" : "PointData";
    const Handle offsets = h5::open_group(steps, group + "Offsets");
    const Handle data = h5::open_group(root, group);
    const auto parts = h5::read_integers(steps, "PartOffsets", at.size());
    const auto sizes =
        h5::read_integers(root, "NumberOfPoints", hsize_t(parts.empty() ? 0 : parts.back() + 1));
    for (const auto part : parts) counts.push_back(sizes[part]);
    points = source_of(root, "Points", "Points", h5::read_integers(steps, "PointOffsets", at.size()));
    for (const auto& name : h5::members(data))
      arrays.push_back(
          source_of(data, name, group + "/" + name, h5::read_integers(offsets, name, at.size())));
    if (!lines) return;
    ends = source_of(h5::open_group(root, "Lines"), "Connectivity", "Lines/Connectivity", {});
    std::vector<std::int64_t> starts(4 * at.size());  // of four topologies, lines are the second
    h5::read_rows(h5::open_dataset(steps, "ConnectivityIdOffsets"), H5T_NATIVE_INT64, 0, at.size(),
                  starts.data());
    for (std::size_t k = 0; k < at.size(); ++k) ends.starts.push_back(starts[4 * k + 1]);
  };
  at = times();
  if (at.empty()) return;
  h5::with_file_errors(path_, "read", read);

  const std::string file = path_.filename().string();
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
      "  <Grid Name=\"frames\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  const auto out = std::back_inserter(text);
  text += images;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    fmt::format_to(out, "    <Grid Name=\"{}\" GridType=\"Uniform\">\n      <Time Value=\"{}\"/>\n",
                   path_.stem().string(), at[k]);
    const std::int64_t entries = ends.starts.empty() ? counts[k] : counts[k] / 2;
    if (ends.starts.empty())
      fmt::format_to(out, "      <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\"/>\n", entries);
    else
      fmt::format_to(
          out,
          "      <Topology TopologyType=\"Polyline\" NodesPerElement=\"2\" NumberOfElements=\"{}\">\n"
          "{}      </Topology>\n",
          entries, slab(file, ends, k, counts[k]));
    fmt::format_to(out, "      <Geometry GeometryType=\"XYZ\">\n{}      </Geometry>\n",
                   slab(file, points, k, counts[k]));
    for (const auto& a : arrays)
      fmt::format_to(out,
                     "      <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">\n{}"
                     "        <Information Name=\"unit\" Value=\"{}\"/>\n      </Attribute>\n",
                     a.name, kind_of(a.columns), ends.starts.empty() ? "Node" : "Cell",
                     slab(file, a, k, entries), a.unit);
    text += "    </Grid>\n";
  }
  text += "  </Grid>\n</Domain>\n</Xdmf>\n";
  write_file(xdmf_path(), text);
}

}  // namespace bedload
